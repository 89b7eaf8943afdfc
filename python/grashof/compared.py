"""What a comparison of integrators has come to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Tuple

from . import _optional

if TYPE_CHECKING:
    import pandas

__all__ = ["Compared", "ComparedRun"]


class ComparedRun(NamedTuple):
    """What an integrator came to with steps of one size; NaN where it did not get as far."""

    #: Name of the integrator.
    integrator: str
    #: Tolerance (a number), or the fixed step in s.
    size: float
    #: What the computation takes, from the first step to the last, s of the clock: the best of a few.
    time: float
    #: Steps, rejected steps, evaluations of the equations of motion, factorisations of matrices.
    counts: Tuple[float, ...]
    #: The largest |x − x*| / max(1, |x*|) over the columns x of the study at its end, in SI: relative for large columns, absolute for
    #: small ones. x* is of another family of integrators at a far tighter tolerance.
    error: float
    #: How much energy the integrator makes or loses, J: the largest |E − E(0) − work of all that drives and brakes| on the way.
    energy: float
    #: How far joints come apart: the largest residuals of the constraints, of positions, m or rad, and of velocities, m/s or rad/s.
    residuals: Tuple[float, ...]
    #: Why it failed; empty if it did not.
    reason: str


class Compared:
    """What a comparison of integrators has come to: a row for each integrator and size.

    ``rows`` are the rows, ``study`` the name of the study, ``fixed`` says whether the sizes are steps, and ``agree`` how well the two
    references agree from which errors are measured.

    >>> compared = m.compare("start-up", integrators=["dop853", "radau5"], tolerances=[1e-6, 1e-9])
    >>> compared.to_pandas()
    """

    def __init__(self, facts: Dict[str, Any]) -> None:
        #: Name of the study.
        self.study: str = facts["study"]
        #: Whether the sizes are those of fixed steps.
        self.fixed: bool = facts["fixed"]
        #: How well the two references agree, as an error; ``None`` if there is one alone.
        self.agree: float | None = facts["references"]["agree"]
        #: What each integrator came to with each size.
        self.rows: List[ComparedRun] = [
            ComparedRun(**{**row, "counts": tuple(row["counts"]), "residuals": tuple(row["residuals"])}) for row in facts["rows"]
        ]

    def __repr__(self) -> str:
        size = "step" if self.fixed else "tolerance"
        table: List[Tuple[str, ...]] = [("integrator", f"{size} {'[s]' if self.fixed else ''}".strip(), "time [s]", "error", "energy [J]", "reason")]
        for row in self.rows:
            numbers = [f"{row.size:.3g}", *(f"{x:.2e}" for x in (row.time, row.error, row.energy))]
            table.append((row.integrator, *("" if number == "nan" else number for number in numbers), row.reason))
        widths = [max(map(len, column)) for column in zip(*table)]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in table]
        return "\n".join([f"<{len(self.rows)} runs of study {self.study}>", *lines])

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a frame of pandas, with a column for each of the counts and residuals; ``attrs["units"]`` has the units."""
        library = _optional.package("pandas", "frames are made")
        count = ("steps", "rejected", "evaluations", "factorisations")
        residual = ("position_residual", "velocity_residual")
        rows = [
            {
                "integrator": row.integrator,
                "step" if self.fixed else "tolerance": row.size,
                "time": row.time,
                **dict(zip(count, row.counts)),
                "error": row.error,
                "energy": row.energy,
                **dict(zip(residual, row.residuals)),
                "reason": row.reason,
            }
            for row in self.rows
        ]
        made: pandas.DataFrame = library.DataFrame(rows)
        seconds = ("time", "step") if self.fixed else ("time",)
        made.attrs["units"] = {name: "s" if name in seconds else "J" if name == "energy" else "" for name in made.columns}
        return made
