"""The table of a sweep in a file, for sweeps that are larger than memory."""

from __future__ import annotations

import os
import shutil
from functools import cached_property
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Optional

from . import _grashof, _text
from .records import Named, Statistics, statistics_of, unknown

if TYPE_CHECKING:
    import numpy as np
    import pandas
    import xarray
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["SweepTable"]


class SweepTable:
    """What a sweep on many machines has come to: a row a run, as :class:`Results` of a sweep have it, in the file ``path``.

    Columns are read when they are asked for. All numbers are SI.
    """

    def __init__(self, path: str, study: str, sweep: _grashof.Sweep) -> None:
        #: The file, an Apache Parquet file.
        self.path = path
        #: Name of the study.
        self.study = study
        self._sweep = sweep
        self._table = _grashof.Table(path)

    def __repr__(self) -> str:
        return f"<{len(self)} runs of study {self.study} in {self.path}>"

    @property
    def parameters(self) -> List[str]:
        """Names of the parameters that run through values."""
        return self._sweep.parameters

    @property
    def columns(self) -> List[str]:
        """Names of the columns: the parameters, then the scalars."""
        return [name for name, _, _ in self._table.columns]

    @property
    def units(self) -> Dict[str, str]:
        """The SI unit of each column; empty for a number."""
        return {name: unit for name, unit, _ in self._table.columns}

    @property
    def quantities(self) -> Dict[str, str]:
        """What each column measures, in words; empty if that has no name."""
        return {name: quantity for name, _, quantity in self._table.columns}

    def __getitem__(self, name: str) -> Array:
        """The values of a column, SI; NaN where there is none."""
        if name not in self:
            raise unknown("column", name, self.columns)
        return self._table.column(name)

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        """Number of runs."""
        return self._table.rows

    @property
    def independent_name(self) -> str:
        """``run``: a sweep has no other independent variable than the number of the run."""
        return "run"

    @property
    def independent(self) -> Array:
        """The numbers of the runs, from 0 on."""
        import numpy as np

        return np.arange(len(self), dtype=np.float64)

    @property
    def table(self) -> Array:
        """All columns as one array, runs × columns."""
        import numpy as np

        return np.column_stack([self[name] for name in self.columns])

    @property
    def reasons(self) -> List[str]:
        """Why each run has no whole result; empty where it has."""
        return self._table.reasons()

    @cached_property
    def statistics(self) -> Dict[str, Statistics]:
        """Of a sweep whose values are drawn: how each number of its table is distributed over the runs."""
        return Named("number", {each["name"]: statistics_of(each) for each in self._sweep.statistics(self._table)})

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a frame, a row a run, with the reason where one is not whole."""
        from .adapters import frame

        return frame(self, False)

    def to_xarray(self) -> xarray.Dataset:
        """The table as a data set over the runs, with units and quantities as attributes."""
        from .adapters import dataset

        return dataset(self)

    def to_pint(self, name: Optional[str] = None, registry: Any = None) -> Any:
        """A column with its unit, a quantity of pint, or without a name all columns by their names."""
        from .adapters import quantity

        return quantity(self, name, registry)

    def to_parquet(self, path: _text.Path) -> None:
        """Copies the file."""
        shutil.copyfile(self.path, os.fspath(path))
