"""What a study has come to."""

from __future__ import annotations

import json
import os
from functools import cached_property
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Optional, Sequence, Union, overload

from . import _grashof, _text
from .errors import Refused, StudyError
from .linear import Linear
from .page import Animation, Page
from .records import Checked, Event, Extremes, Finding, Named, Solution, Statistics, extremes_of, statistics_of, unknown

if TYPE_CHECKING:
    import matplotlib.figure
    import numpy as np
    import pandas
    import xarray
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Results", "Runs"]


class Results:
    """What a study has come to: columns by their names, and what is known of the motion. All numbers are SI.

    >>> results["B.fx"]                     # a view into the one table, which cannot be written to
    >>> results.units["B.fx"], results.extremes["B.fx"].max.value, results.scalars["mean_power"]
    """

    def __init__(self, core: _grashof.Results, model: _grashof.Model) -> None:
        self._core = core
        self._model = model

    @cached_property
    def _facts(self) -> Dict[str, Any]:
        return self._core.facts()

    @cached_property
    def _all_columns(self) -> List[Dict[str, Any]]:
        return [*self._facts["table"]["columns"], *self._facts["curves"]]

    @property
    def study(self) -> str:
        """Name of the study."""
        return str(self._facts["study"])

    @property
    def kind(self) -> str:
        """Kind of the study: ``kinematics``, ``inverse``, ``dynamics``, ``statics``, ``modes``, ..."""
        return str(self._facts["kind"])

    @property
    def stopped(self) -> Optional[str]:
        """Why it stopped on its way; ``None`` if it did not. What was computed up to there is kept."""
        stopped: Optional[str] = self._facts["stopped"]
        return stopped

    @property
    def columns(self) -> List[str]:
        """Names of the columns, in the order of the file; of a sweep the parameters, then the scalars."""
        return [column["name"] for column in self._facts["table"]["columns"]]

    @property
    def table(self) -> Array:
        """The columns as one array, rows × columns, SI; it cannot be written to."""
        return self._core.table.T

    @property
    def independent(self) -> Array:
        """The independent variable of each row, SI; two rows at the same place are the two sides of a switch."""
        independent: Array = self._core.independent[0]
        return independent

    @property
    def independent_name(self) -> str:
        """Name of the independent variable; empty if there is none."""
        return str(self._facts["independent"]["name"])

    @cached_property
    def units(self) -> Dict[str, str]:
        """The SI unit of each column, scalar and parameter; empty for a number."""
        named = [*self._facts["parameters"], *self._facts["scalars"], self._facts["independent"], *reversed(self._all_columns)]
        return {each["name"]: each["unit"] for each in named if each["name"]}

    @cached_property
    def quantities(self) -> Dict[str, str]:
        """What each column measures, in words: ``length``; empty if that has no name."""
        return {column["name"]: column["quantity"] for column in reversed(self._all_columns)}

    @cached_property
    def _index(self) -> Dict[str, int]:
        return {column["name"]: index for index, column in reversed(list(enumerate(self._all_columns)))}

    def __getitem__(self, name: str) -> Array:
        """The values of a column, SI; NaN where there is none."""
        index = self._index.get(name)
        if index is None:
            raise unknown("column", name, self.columns)
        table = self._core.table
        column: Array = table[index] if index < len(table) else self._core.curves[index - len(table)]
        return column

    def __contains__(self, name: object) -> bool:
        return name in self._index

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        """Number of rows."""
        return int(self._core.table.shape[1])

    @cached_property
    def scalars(self) -> Dict[str, float]:
        """Scalars, SI: those taken from other studies, those of the kind, those of the file."""
        return Named("scalar", {scalar["name"]: scalar["value"] for scalar in self._facts["scalars"]})

    @cached_property
    def parameters(self) -> Dict[str, float]:
        """Values of the parameters, SI, in file order."""
        return Named("parameter", {parameter["name"]: parameter["value"] for parameter in self._facts["parameters"]})

    @cached_property
    def extremes(self) -> Dict[str, Optional[Extremes]]:
        """Extremes of each column over the continuous motion, not over the rows; ``None`` where a column has no value."""
        return Named("column", {name: extremes and extremes_of(extremes) for name, extremes in self._facts["extremes"]})

    @cached_property
    def statistics(self) -> Dict[str, Statistics]:
        """Of a sweep whose values are drawn: how each number of its table is distributed over the runs."""
        return Named("number", {each["name"]: statistics_of(each) for each in self._facts["statistics"]})

    @property
    def lists(self) -> Dict[str, Array]:
        """Lists that the kind gives, as the ``eigenvalues`` of ``modes``; SI."""
        import numpy as np

        return Named("list", {each["name"]: np.array(each["values"], dtype=np.float64) for each in self._facts["lists"]})

    @property
    def shapes(self) -> List[Dict[str, float]]:
        """Shapes of modes: displacements by the names of the coordinates. Undamped ones have xᵀ M x = 1; of damped ones the
        largest amplitude is 1, and ``P.angle.phase`` is the phase of ``P.angle``, rad."""
        return [dict(shape) for shape in self._facts["shapes"]]

    @cached_property
    def linear(self) -> Optional[Linear]:
        """The linear system of a study ``linearize``; of others ``None``."""
        return Linear(self._facts["linear"]) if self._facts["linear"] else None

    @property
    def events(self) -> List[Event]:
        """Events of the model in the order in which they happened."""
        return [Event(event["name"], event["at"]) for event in self._facts["events"]]

    @property
    def findings(self) -> List[Finding]:
        """What a reader should know."""
        return [Finding(finding["code"], finding["message"], finding["path"]) for finding in self._facts["findings"]]

    @property
    def expectations(self) -> List[Checked]:
        """Expectations of the file, and whether they are met."""
        return [Checked(*(each[key] for key in Checked._fields)) for each in self._facts["expectations"]]

    @cached_property
    def certificate(self) -> Dict[str, Any]:
        """How far the results can be trusted: residuals, balances and counts, by the names of the JSON file."""
        certificate: Dict[str, Any] = json.loads(self._core.json())["certificate"]
        return certificate

    @property
    def solution(self) -> Optional[Solution]:
        """What a ``solve`` has found; ``None`` without one."""
        found = self._facts["solution"]
        if not found:
            return None
        return Solution(found["parameter"]["name"], found["parameter"]["value"], found["of"], found["found"], found["target"])

    @property
    def reasons(self) -> List[str]:
        """Of a sweep, why each run has no whole result, a text a run, empty where it has one; without a sweep an empty list."""
        return list(self._facts["table"]["reasons"] or ())

    @cached_property
    def runs(self) -> Runs:
        """The runs of a sweep."""
        return Runs(self)

    # nothing of them changes

    def __copy__(self) -> Results:
        return self

    def __deepcopy__(self, known: Any) -> Results:
        return self

    def __reduce__(self) -> Any:
        help = "send what is needed of them, as `results.to_pandas()` or `results.scalars`, or the model, and run it there"
        raise Refused(f"results stay in the process that has computed them; {help}", code="refused", help=help)

    def summary(self) -> str:
        """What was found, in words, as the program prints it."""
        return self._core.summary()

    def __repr__(self) -> str:
        return f"{self.study}\n{self.summary()}".rstrip()

    def _repr_html_(self) -> str:
        from .notebook import results_html

        return results_html(self)

    # to other programs

    def to_pandas(self, copy: bool = True) -> pandas.DataFrame:
        """The columns as a frame over the independent variable; of a sweep a row a run, with the reason where one is not whole.

        ``attrs["units"]`` has their units. Without ``copy`` the frame is a view into the table, which cannot be written to.
        """
        from .adapters import frame

        return frame(self, copy)

    def to_xarray(self) -> xarray.Dataset:
        """The columns as a data set over the independent variable, with units and quantities as attributes."""
        from .adapters import dataset

        return dataset(self)

    def to_pint(self, name: Optional[str] = None, registry: Any = None) -> Any:
        """A column with its unit, a quantity of pint, or without a name all columns by their names; of the registry that the application has
        set if none is given."""
        from .adapters import quantity

        return quantity(self, name, registry)

    @overload
    def to_csv(self, path: None = None) -> str: ...
    @overload
    def to_csv(self, path: _text.Path) -> None: ...
    def to_csv(self, path: Optional[_text.Path] = None) -> Optional[str]:
        """The CSV file of the table, as the program writes it; its text if no path is given."""
        return _written(self._core.csv(), path)

    @overload
    def to_json(self, path: None = None) -> str: ...
    @overload
    def to_json(self, path: _text.Path) -> None: ...
    def to_json(self, path: Optional[_text.Path] = None) -> Optional[str]:
        """The JSON file, as the program writes it: all but the table; its text if no path is given."""
        return _written(self._core.json(), path)

    def to_parquet(self, path: _text.Path) -> None:
        """Writes the table as an Apache Parquet file, as the program does."""
        with open(os.fspath(path), "wb") as file:
            file.write(self._core.parquet())

    # to be looked at

    def plot(self, *names: str, over: Optional[str] = None) -> matplotlib.figure.Figure:
        """A figure of the study by its name, or of columns; without names all figures of the study one below the other.

        Columns of different units stand in panels of their own. ``over`` is a column for the horizontal axis, in place of the
        independent variable; of a sweep it may be a swept parameter.

        Of a sweep columns have a curve for each run; numbers of whole runs have one for each combination of the other parameters over the
        first, or over that named by ``over``, and points alone where values are drawn or come from a list of points. Runs that are not
        whole are told by a warning; raises :class:`StudyError` if none began.
        """
        from .plotting import plot

        return plot(self, names, over)

    def report(self) -> Page:
        """The interactive page: figures, tables, findings, the mechanism in motion."""
        return Page(self._model.report([self._core]).decode())

    def animate(self, mode: int = 0, *, width: int = 800, rate: float = 30.0, speed: float = 1.0, duration: Optional[float] = None) -> Animation:
        """The mechanism in motion, or a mode of vibration by its number from 0.

        ``width`` is in pixels, ``rate`` in pictures a second, ``speed`` a multiple of the real one; ``duration``, s, shows all of it
        in this time.
        """
        return Animation(self._core.animation(mode, width, rate, speed, duration))


class Runs(Sequence[Results]):
    """The runs of a sweep, in the order of its rows."""

    def __init__(self, sweep: Results) -> None:
        self._sweep = sweep
        self._known: Dict[int, Any] = {}

    def __len__(self) -> int:
        return self._sweep._core.run_count

    def __repr__(self) -> str:
        return f"<{len(self)} runs of study {self._sweep.study}>"

    def _run(self, index: int) -> Any:
        if index not in self._known:
            label, core = self._sweep._core.run(index)
            self._known[index] = label, None if core is None else Results(core, self._sweep._model)
        return self._known[index]

    @overload
    def __getitem__(self, index: int) -> Results: ...
    @overload
    def __getitem__(self, index: slice) -> List[Results]: ...
    def __getitem__(self, index: Union[int, slice]) -> Union[Results, List[Results]]:
        """A run; raises :class:`StudyError` if it did not begin."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        place = index + len(self) if index < 0 else index
        if not 0 <= place < len(self):
            raise IndexError(f"there are {len(self)} runs")
        label, results = self._run(place)
        if results is None:
            raise StudyError(f"run {place} ({label}): {self._sweep.reasons[place]}", code="run-stopped")
        found: Results = results
        return found

    def label(self, index: int) -> str:
        """The swept values of a run, in the units in which they are written: ``l3 = 60 cm``."""
        return str(self._run(range(len(self))[index])[0])

    def whole(self) -> Iterator[Results]:
        """The runs that began."""
        return (results for _, results in map(self._run, range(len(self))) if results is not None)


def _written(text: str, path: Optional[_text.Path]) -> Optional[str]:
    if path is None:
        return text
    with open(os.fspath(path), "w", encoding="utf-8", newline="") as file:
        file.write(text)
    return None
