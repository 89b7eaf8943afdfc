"""The equations of motion of a mechanism, evaluated in one state or in many at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, List, NamedTuple, Tuple

from . import _grashof
from .errors import Error, Refused

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["Dynamics", "Pose"]


class Pose(NamedTuple):
    """Where a body is, world axes; in the plane z is 0."""

    #: Place of its origin, m (..., 3).
    position: Array
    #: Its axes as columns (..., 3, 3).
    rotation: Array


class Dynamics:
    """The equations of motion of a mechanism that is assembled at its start, with nq coordinates q, nv velocities v and m rows of
    constraints::

        M(q) a + Gᵀλ = f(t, q, v),   Φ(t, q) = 0,   G v = ν,   G a = γ

    Velocities are the rates of coordinates but for joints that turn about a point: their four coordinates are a quaternion, their three
    velocities the angular velocity. SI units and radians.

    All functions take many states at once: arrays with any axes in front of that of the coordinates, by the rules of broadcasting.
    """

    def __init__(self, core: _grashof.Dynamics) -> None:
        self._core = core
        nq, nv, m = core.sizes
        #: Number of coordinates.
        self.nq: int = nq
        #: Number of velocities.
        self.nv: int = nv
        #: Number of rows of constraints.
        self.m: int = m

    def __repr__(self) -> str:
        return f"<mechanism with {self.nq} coordinates, {self.nv} velocities and {self.m} constraints>"

    @property
    def coordinates(self) -> List[str]:
        """Names of the coordinates behind the velocities (nv)."""
        return self._core.coordinates

    def start(self) -> Tuple[Array, Array]:
        """Coordinates (nq) and velocities (nv) of the start."""
        return self._core.start()

    def mass(self, q: ArrayLike) -> Array:
        """The mass matrix M (..., nv, nv), symmetric: kg, kg m and kg m^2."""
        return self._position("mass", 0.0, q, (self.nv, self.nv))

    def constraints(self, q: ArrayLike, t: ArrayLike = 0.0) -> Array:
        """Φ (..., m): what the constraints leave open, m and rad."""
        return self._position("constraints", t, q, (self.m,))

    def jacobian(self, q: ArrayLike, t: ArrayLike = 0.0) -> Array:
        """G (..., m, nv), the derivative of Φ along the velocities: numbers, m, and 1/m."""
        return self._position("jacobian", t, q, (self.m, self.nv))

    def _position(self, term: str, t: ArrayLike, q: ArrayLike, shape: Tuple[int, ...]) -> Array:
        lead, (time, at) = self._states(t, (q, self.nq, "coordinates"))
        return self._core.position(term, time, at).reshape(lead + shape)

    def force(self, q: ArrayLike, v: ArrayLike, t: ArrayLike = 0.0) -> Array:
        """f (..., nv), N and N m: all applied forces and those of Coriolis. What depends on reactions is not in it."""
        lead, (time, at, along) = self._states(t, (q, self.nq, "coordinates"), (v, self.nv, "velocities"))
        return _evaluated(self._core.force, time, at, along).reshape(lead + (self.nv,))

    def bias(self, q: ArrayLike, v: ArrayLike, t: ArrayLike = 0.0) -> Array:
        """b = −f (..., nv), N and N m, so that M a + b + Gᵀλ = 0 where nothing else acts."""
        return -self.force(q, v, t)

    def accelerations(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Array:
        """Accelerations a (..., nv), m/s^2 and rad/s^2. Friction that depends on reactions is left out."""
        return self.solve(t, q, v)[0]

    def solve(self, t: ArrayLike, q: ArrayLike, v: ArrayLike) -> Tuple[Array, Array]:
        """Accelerations a (..., nv), m/s^2 and rad/s^2, and multipliers λ (..., m), N and N m; the reactions of the constraints are
        −Gᵀλ."""
        lead, (time, at, along) = self._states(t, (q, self.nq, "coordinates"), (v, self.nv, "velocities"))
        both = _evaluated(self._core.accelerations, time, at, along)
        return both[:, : self.nv].reshape(lead + (self.nv,)), both[:, self.nv :].reshape(lead + (self.m,))

    def inverse(self, q: ArrayLike, v: ArrayLike, a: ArrayLike, multipliers: ArrayLike | None = None, t: ArrayLike = 0.0) -> Array:
        """Inverse dynamics (..., nv), N and N m: the forces along the velocities which, added to f, give accelerations ``a``:
        M a + Gᵀλ − f. Without multipliers λ is 0."""
        import numpy as np

        reactions: Any = np.zeros(self.m) if multipliers is None else multipliers
        lead, (time, at, along, wanted, lagrange) = self._states(
            t,
            (q, self.nq, "coordinates"),
            (v, self.nv, "velocities"),
            (a, self.nv, "accelerations"),
            (reactions, self.m, "multipliers"),
        )
        return _evaluated(self._core.inverse, time, (at, along), (wanted, lagrange)).reshape(lead + (self.nv,))

    def project(self, q: ArrayLike, v: ArrayLike | None = None, t: ArrayLike = 0.0) -> Tuple[Array, Array]:
        """The states on the constraints next to given ones: coordinates (..., nq) moved to Φ = 0 and velocities (..., nv) moved to
        G v = ν, each by the shortest way in the metric M. Without velocities those of rest are moved.

        Raises :class:`Refused` where the constraints cannot be closed from a state."""
        import numpy as np

        rates: Any = np.zeros(self.nv) if v is None else v
        lead, (time, at, along) = self._states(t, (q, self.nq, "coordinates"), (rates, self.nv, "velocities"))
        both = _evaluated(self._core.project, time, at, along)
        return both[:, : self.nq].reshape(lead + (self.nq,)), both[:, self.nq :].reshape(lead + (self.nv,))

    def pose(self, body: str, q: ArrayLike | None = None) -> Pose:
        """Where a body of the file is, for coordinates ``q`` (..., nq), or at the start."""
        lead, (_, at) = self._states(0.0, (self.start()[0] if q is None else q, self.nq, "coordinates"))
        placed = self._core.pose(body, at)
        return Pose(placed[:, :3].reshape(lead + (3,)), placed[:, 3:].reshape(lead + (3, 3)))

    def _states(self, t: ArrayLike, *parts: Tuple[ArrayLike, int, str]) -> Tuple[Tuple[int, ...], List[Any]]:
        """The common axes in front, and times and parts of the states with one row a state."""
        import numpy as np

        times = np.asarray(t, dtype=np.float64)
        arrays = [np.asarray(part, dtype=np.float64) for part, _, _ in parts]
        for array, (_, size, what) in zip(arrays, parts):
            if array.ndim == 0 or array.shape[-1] != size:
                found = f"there are {array.shape[-1]} {what}" if array.ndim else f"{array} is no array of {what}"
                message = f"{found}, and the mechanism has {size}"
                raise Refused(message, code="refused", help="see `start` and `coordinates`")
        if times.ndim == 0 and all(array.ndim == 1 for array in arrays):
            # one state, as solvers of differential equations ask for it
            return (), [times.reshape(1), *(np.ascontiguousarray(array)[np.newaxis] for array in arrays)]
        lead = np.broadcast_shapes(times.shape, *(array.shape[:-1] for array in arrays))
        count = int(np.prod(lead, dtype=np.int64))
        rows = [np.ascontiguousarray(np.broadcast_to(array, lead + array.shape[-1:])).reshape(count, array.shape[-1]) for array in arrays]
        return lead, [np.ascontiguousarray(np.broadcast_to(times, lead)).reshape(count), *rows]


def _evaluated(term: Callable[..., Array], times: Any, *parts: Any) -> Array:
    """A term in many states; where one has a number that is not finite, no other cause is told."""
    import numpy as np

    try:
        return term(times, *parts)
    except Error as why:
        arrays = [array for part in parts for array in (part if isinstance(part, tuple) else (part,))]
        finite = np.isfinite(times)
        for array in arrays:
            finite = finite & np.isfinite(array).all(axis=1)
        if finite.all():
            raise
        help = "look at where it comes from"
        message = f"state {int(np.argmin(finite))} of {len(finite)} has a number that is not finite; {help}"
        raise Refused(message, code="not-finite", help=help) from why
