"""A motion in time that is advanced from outside."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Dict, List, NamedTuple, Tuple

from . import _grashof, _text
from .errors import Refused
from .records import unknown

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["State", "Stepper"]


class State(NamedTuple):
    """The state of a motion."""

    #: Time, s.
    t: float
    #: Coordinates (nq), m and rad.
    q: NDArray[np.float64]
    #: Velocities (nv), m/s and rad/s.
    v: NDArray[np.float64]
    #: First-order states of the model (nz), SI.
    z: NDArray[np.float64]


class Stepper:
    """A motion in time that is advanced from outside, by the integrator of its study; parameters may be set on the way.

    >>> motion = m.stepper("start-up")
    >>> while motion.time < 1.0:
    ...     motion.set_input("torque", controller(motion["omega"]))
    ...     motion.advance(0.01)
    """

    def __init__(self, core: _grashof.Stepper, model: _grashof.Model) -> None:
        self._core = core
        self._model = model

    def __repr__(self) -> str:
        return f"<motion at t = {self.time:g} s>"

    def advance(self, by: float) -> None:
        """Goes on by a time, s, or to an event that ends the motion.

        Raises :class:`Refused` if the motion cannot go on, with the last good state, and for a negative time.
        """
        if not 0 <= by < math.inf:
            help = "give a time in s that is not negative"
            raise Refused(f"a motion does not go on by {by!r} s; {help}", code="refused", help=help)
        self.advance_to(self.time + by)

    def advance_to(self, t: float) -> None:
        """Goes on to a time, s, or to an event that ends the motion; a time in the past changes nothing."""
        if not math.isfinite(t):
            help = "give a time in s"
            raise Refused(f"a motion does not go on to {t!r}; {help}", code="refused", help=help)
        self._core.advance_to(t)

    def set_input(self, parameter: str, value: _text.Value) -> None:
        """Goes on with a parameter at another value, a number in SI, a text as in the file or a quantity of pint, from the present state, as
        behind an event that sets it."""
        self._core.set_input(parameter, self._number(parameter, value))

    def _number(self, parameter: str, value: _text.Value) -> float:
        """A value of a parameter, SI."""
        written = _text.value(value, parameter)
        if _text.is_number(value):
            return float(written)
        return next(x for name, x, _ in self._model.set([(parameter, written)]).parameters() if name == parameter)

    @property
    def time(self) -> float:
        """The present time, s."""
        return self._core.time

    @property
    def state(self) -> State:
        """The present state: time, coordinates, velocities and first-order states."""
        q, v, z = self._core.state()
        return State(self.time, q, v, z)

    @property
    def events(self) -> List[Tuple[float, str]]:
        """Times, s, and names of the events of the model so far."""
        return self._core.events

    @property
    def ended(self) -> bool:
        """Whether an event has ended the motion, which goes no further then."""
        return self._core.ended

    @property
    def columns(self) -> Dict[str, float]:
        """The columns of the study in the present state, SI."""
        return dict(zip(self._core.column_names, self._core.columns().tolist()))

    def __getitem__(self, name: str) -> float:
        """A column of the study in the present state, SI."""
        columns = self.columns
        if name not in columns:
            raise unknown("column", name, list(columns))
        return columns[name]
