"""Parts of results: numbers with names, and what is said of them."""

from __future__ import annotations

from typing import Any, Dict, Mapping, NamedTuple, Sequence

from .errors import UnknownName

__all__ = ["Checked", "Event", "Extreme", "Extremes", "Finding", "Solution"]


class Extreme(NamedTuple):
    """An extreme of a column over the continuous motion."""

    #: The value, SI.
    value: float
    #: The independent variable there, SI.
    at: float


class Extremes(NamedTuple):
    """The extremes of a column."""

    min: Extreme
    max: Extreme


class Finding(NamedTuple):
    """Something worth knowing that is no error."""

    #: Its kind, a word to search for.
    code: str
    message: str
    #: Path of keys in the file.
    path: str


class Event(NamedTuple):
    """An event of the model that happened."""

    name: str
    #: When, s.
    at: float


class Checked(NamedTuple):
    """An expectation of the model file."""

    #: As written.
    text: str
    found: float
    wanted: float
    tolerance: float
    met: bool


class Solution(NamedTuple):
    """A value of a parameter for which a scalar meets its target, SI."""

    parameter: str
    value: float
    #: Name of the scalar.
    of: str
    found: float
    target: float


class Named(Dict[str, Any]):
    """What is known by names; says which there are where one is not."""

    def __init__(self, what: str, known: Dict[str, Any]) -> None:
        super().__init__(known)
        self._what = what

    def __missing__(self, name: str) -> Any:
        raise unknown(self._what, name, list(self))


def unknown(what: str, name: object, known: Sequence[str]) -> UnknownName:
    """There is nothing of a name."""
    listed = ", ".join(f"`{each}`" for each in known)
    there = f"there are {listed}" if known else "there is none"
    return UnknownName(f"there is no {what} `{name}`: {there}", code="unknown", help=there)


def extremes_of(facts: Mapping[str, Any]) -> Extremes:
    """Extremes from what the library gives."""
    low, high = (Extreme(facts[end]["value"], facts[end]["at"]) for end in ("min", "max"))
    return Extremes(low, high)
