"""What a comparison of integrators has come to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Tuple

if TYPE_CHECKING:
    import pandas

__all__ = ["Compared", "ComparedRun"]


class ComparedRun(NamedTuple):
    """What an integrator came to with steps of one size."""

    #: Name of the integrator.
    integrator: str
    #: Tolerance, or step in s.
    size: float
    #: From the first step to the last, s: the best of a few.
    time: float
    #: Steps, rejected ones, evaluations, factorisations.
    counts: Tuple[float, ...]
    #: Error at the end, relative to the sizes of the columns.
    error: float
    #: Largest |E − E(0) − work|, J.
    energy: float
    #: Largest residuals of the constraints: of positions, m or rad, and of velocities, m/s or rad/s.
    residuals: Tuple[float, ...]
    #: Why it failed; empty if it did not.
    reason: str


class Compared:
    """What a comparison of integrators has come to: a row for each integrator and size."""

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
        return f"<{len(self.rows)} runs of study {self.study}>"

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a frame of pandas."""
        import pandas

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
        return pandas.DataFrame(rows)
