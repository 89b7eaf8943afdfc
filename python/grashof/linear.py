"""A linearised motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Mapping, Sequence

from . import _optional

if TYPE_CHECKING:
    import control
    import numpy as np
    import scipy.signal
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Linear"]


class Linear:
    """A linear system of small deviations from a state: ẋ = A x + B u, y = C x + D u, and M ü + C u̇ + K u = 0 of mechanics.

    ``states``, ``inputs``, ``outputs`` and ``coordinates`` are the names of x, u, y and of the independent coordinates; ``x``,
    ``rates``, ``u`` and ``y`` the values of x, ẋ, u and y in the state; ``A``, ``B``, ``C``, ``D``, ``mass``, ``damping`` and
    ``stiffness`` the matrices.
    """

    def __init__(self, facts: Mapping[str, Any]) -> None:
        import numpy as np

        #: Names of x.
        self.states: List[str] = facts["states"]
        #: Names of u.
        self.inputs: List[str] = facts["inputs"]
        #: Names of y.
        self.outputs: List[str] = facts["outputs"]
        #: Names of the independent coordinates.
        self.coordinates: List[str] = facts["coordinates"]
        self._matrices = {name: np.array(rows, dtype=np.float64) for name, rows in facts["matrices"]}
        x, rates, u, y = (np.array(values, dtype=np.float64) for values in facts["values"])
        #: Values of x in the state, SI.
        self.x: Array = x
        #: Values of ẋ in the state, SI; 0 in an equilibrium.
        self.rates: Array = rates
        #: Values of u in the state, SI.
        self.u: Array = u
        #: Values of y in the state, SI.
        self.y: Array = y

    def __repr__(self) -> str:
        sizes = f"{len(self.states)} states, {len(self.inputs)} inputs, {len(self.outputs)} outputs"
        parts = [("states x", self.states), ("inputs u", self.inputs), ("outputs y", self.outputs)]
        matrices = ", ".join(f"{name} {' × '.join(map(str, getattr(self, name).shape))}" for name in "ABCD")
        lines = [f"  {what}: {', '.join(names) or 'none'}" for what, names in parts]
        return "\n".join([f"<linear system with {sizes}>", *lines, f"  {matrices}"])

    def _matrix(self, name: str, rows: Sequence[str], columns: Sequence[str]) -> Array:
        return self._matrices[name].reshape(len(rows), len(columns))

    @property
    def A(self) -> Array:
        """A (states × states), SI."""
        return self._matrix("A", self.states, self.states)

    @property
    def B(self) -> Array:
        """B (states × inputs), SI."""
        return self._matrix("B", self.states, self.inputs)

    @property
    def C(self) -> Array:
        """C (outputs × states), SI."""
        return self._matrix("C", self.outputs, self.states)

    @property
    def D(self) -> Array:
        """D (outputs × inputs), SI."""
        return self._matrix("D", self.outputs, self.inputs)

    @property
    def mass(self) -> Array:
        """M on the independent coordinates: kg, kg m and kg m^2."""
        return self._matrix("mass", self.coordinates, self.coordinates)

    @property
    def damping(self) -> Array:
        """C of mechanics on the independent coordinates: forces by their rates, SI."""
        return self._matrix("damping", self.coordinates, self.coordinates)

    @property
    def stiffness(self) -> Array:
        """K on the independent coordinates: forces by displacements, SI."""
        return self._matrix("stiffness", self.coordinates, self.coordinates)

    def to_control(self) -> control.StateSpace:
        """As a system of python-control, with its names, in which points are not allowed: ``P_angle``."""
        library = _optional.package("control", "systems of python-control are made")
        named = {"states": self.states, "inputs": self.inputs, "outputs": self.outputs}
        plain = {what: [name.replace(".", "_") for name in names] for what, names in named.items()}
        made: control.StateSpace = library.ss(self.A, self.B, self.C, self.D, **plain)
        return made

    def to_scipy(self) -> scipy.signal.StateSpace:
        """As a system of SciPy."""
        library = _optional.package("scipy.signal", "systems of SciPy are made")
        made: scipy.signal.StateSpace = library.StateSpace(self.A, self.B, self.C, self.D)
        return made
