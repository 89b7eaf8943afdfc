"""Sobol's indices: which parameters make numbers vary."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, NamedTuple, Sequence, Tuple, Union

from . import _grashof, _optional, _text
from .errors import Refused
from .records import Named

if TYPE_CHECKING:
    import numpy as np
    import pandas

    from .gathered import SweepTable
    from .results import Results

__all__ = ["Index", "Sensitivity"]

#: The least chance that a point has in a parameter; the greatest is as far from 1.
LEAST = 2.0**-33
#: Deviations below this part of the mean are round-off.
ROUND_OFF = 1e-12


class Index(NamedTuple):
    """What a parameter has to do with a number, as shares of its variance."""

    #: Of the parameter alone.
    first: float
    #: Half the width of the interval that has ``first`` with the confidence that was asked for.
    first_confidence: float
    #: Of the parameter with all that it does together with others.
    total: float
    #: Half the width of the interval of ``total``.
    total_confidence: float


class Sensitivity:
    """Sobol's indices of the scalars of a study over its parameters.

    >>> s["mean_power"]["l3"].total
    """

    def __init__(self, indices: Dict[str, Dict[str, Index]], results: Union[Results, SweepTable]) -> None:
        self._indices: Dict[str, Dict[str, Index]] = Named("scalar", indices)
        #: The runs.
        self.results = results

    def __getitem__(self, scalar: str) -> Dict[str, Index]:
        """The indices of a scalar, by parameters; NaN where a run has no value, or all have the same to 12 digits."""
        return self._indices[scalar]

    def __iter__(self) -> Any:
        return iter(self._indices)

    def __len__(self) -> int:
        """Number of scalars."""
        return len(self._indices)

    def __repr__(self) -> str:
        def line(name: str, index: Index) -> str:
            return f"  {name}: {index.first:.3f} ± {index.first_confidence:.3f}, total {index.total:.3f} ± {index.total_confidence:.3f}"

        lines = [[scalar, *(line(*each) for each in indices.items())] for scalar, indices in self._indices.items()]
        return "\n".join(sum(lines, [f"<shares of the variance over {len(self.results)} runs>"]))

    def to_pandas(self) -> pandas.DataFrame:
        """A frame with a row for each scalar and parameter."""
        library = _optional.package("pandas", "frames are made")
        rows = {(scalar, name): index._asdict() for scalar, of in self._indices.items() for name, index in of.items()}
        made: pandas.DataFrame = library.DataFrame.from_dict(rows, orient="index")
        made.index = library.MultiIndex.from_tuples(list(rows), names=["scalar", "parameter"])
        return made


def points(core: _grashof.Model, study: str, over: Sequence[Tuple[str, str]], samples: int, seed: int) -> Any:
    """The points at which a study is to be run: n × parameters."""
    import numpy as np

    if samples < 1 or samples & (samples - 1):
        raise Refused(f"{samples} is no power of two", code="refused", help="give a number of `samples` as 512 or 1024")
    sample = _salib("sample")
    chances = sample.sample(_problem([name for name, _ in over]), samples, calc_second_order=False, seed=seed)
    drawn = core.prepare(study, over, (1, seed), 1)
    return drawn.at_chances(np.clip(np.ascontiguousarray(chances, dtype=np.float64), LEAST, 1 - LEAST))


def indices(results: Union[Results, SweepTable], names: Sequence[str], seed: int, confidence: float) -> Sensitivity:
    """The indices from runs at :func:`points`."""
    import numpy as np

    analyze = _salib("analyze")
    none = Index(np.nan, np.nan, np.nan, np.nan)

    def of(values: Any) -> Dict[str, Index]:
        if not np.all(np.isfinite(values)) or np.std(values) <= ROUND_OFF * abs(np.mean(values)):
            return dict.fromkeys(names, none)
        found: Mapping[str, Any] = analyze.analyze(
            _problem(names), np.array(values), calc_second_order=False, conf_level=confidence, seed=seed
        )
        columns = zip(*(found[key] for key in ("S1", "S1_conf", "ST", "ST_conf")))
        return {name: Index(*map(float, each)) for name, each in zip(names, columns)}

    lost = sum(reason != "" for reason in results.reasons)
    if lost:
        warnings.warn(f"{lost} of {len(results)} runs have no whole result, and no index is known of what they lack: see `results.reasons`", stacklevel=3)
    return Sensitivity({name: of(results[name]) for name in results.columns if name not in names}, results)


def _problem(names: Sequence[str]) -> Dict[str, Any]:
    """The unit cube, as SALib describes it."""
    listed: List[str] = list(names)
    return {"num_vars": len(listed), "names": listed, "bounds": [[0.0, 1.0]] * len(listed)}


def _salib(part: str) -> Any:
    """Saltelli's design, or its analysis."""
    return _optional.package(f"SALib.{part}.sobol", "Sobol's indices are computed")
