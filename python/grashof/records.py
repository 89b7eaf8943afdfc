"""Parts of results: numbers with names, and what is said of them."""

from __future__ import annotations

from typing import Any, Dict, Mapping, NamedTuple, Sequence

from . import _grashof
from .errors import UnknownName

__all__ = ["Checked", "Event", "Extreme", "Extremes", "Finding", "Part", "Solution", "Statistics"]


class Extreme(NamedTuple):
    """An extreme of a column over the continuous motion."""

    #: The value, SI.
    value: float
    #: The independent variable there, SI.
    at: float


class Extremes(NamedTuple):
    """The extremes of a column."""

    #: The least value.
    min: Extreme
    #: The largest value.
    max: Extreme


class Finding(NamedTuple):
    """Something worth knowing that is no error."""

    #: Its kind, a word to search for.
    code: str
    #: What it is.
    message: str
    #: Path of keys in the file.
    path: str


class Event(NamedTuple):
    """An event of the model that happened."""

    #: Name of the event.
    name: str
    #: When, s.
    at: float


class Checked(NamedTuple):
    """An expectation of the model file."""

    #: As written.
    text: str
    #: What was found, SI.
    found: float
    #: What the file expects, SI.
    wanted: float
    #: How far they may be apart, SI.
    tolerance: float
    #: Whether they are as near.
    met: bool


class Solution(NamedTuple):
    """A value of a parameter for which a scalar meets its target, SI."""

    #: Name of the parameter.
    parameter: str
    #: Its value.
    value: float
    #: Name of the scalar.
    of: str
    #: The scalar with this value.
    found: float
    #: What it should be.
    target: float


class Part(NamedTuple):
    """What a parameter with a distribution has to do with a number, by the plane of least squares through the runs."""

    #: Change of the number with the parameter, SI.
    slope: float
    #: Share of the variance; all together are 1 for a number that is linear in the parameters.
    share: float


class Statistics(NamedTuple):
    """How a number is distributed over runs whose values are drawn, SI."""

    #: Runs that have the number.
    runs: int
    #: Mean.
    mean: float
    #: Standard deviation of the sample.
    deviation: float
    #: Least value.
    least: float
    #: Largest value.
    most: float
    #: By percentage: 5, 25, 50, 75, 95.
    percentiles: Dict[int, float]
    #: By parameter; empty where there are too few runs, other parameters vary as well, or the deviation is round-off, below 1e-12 of
    #: the mean.
    parts: Dict[str, Part]


class Named(Dict[str, Any]):
    """What is known by names; says which there are where one is not."""

    def __init__(self, what: str, known: Dict[str, Any]) -> None:
        super().__init__(known)
        self._what = what

    def __missing__(self, name: str) -> Any:
        raise unknown(self._what, name, list(self))


def unknown(what: str, name: object, known: Sequence[str]) -> UnknownName:
    """There is nothing of a name."""
    parts = [each for each in known if each.startswith(f"{name}.")]
    there = f"there are its parts {', '.join(f'`{each}`' for each in parts)}" if parts else _grashof.there_are(str(name), list(known))
    return UnknownName(f"there is no {what} `{name}`; {there}", code="unknown", help=there)


def statistics_of(facts: Mapping[str, Any]) -> Statistics:
    """Statistics from what the library gives."""
    parts = {part["parameter"]: Part(part["slope"], part["share"]) for part in facts["parts"]}
    percentiles = dict(zip((5, 25, 50, 75, 95), facts["percentiles"]))
    least, most = facts["range"]
    return Statistics(facts["runs"], facts["mean"], facts["deviation"], least, most, percentiles, parts)


def extremes_of(facts: Mapping[str, Any]) -> Extremes:
    """Extremes from what the library gives."""
    low, high = (Extreme(facts[end]["value"], facts[end]["at"]) for end in ("min", "max"))
    return Extremes(low, high)
