"""Figures by Matplotlib, which look as those of the program."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

from . import _optional
from .errors import Refused, StudyError

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure

    from .results import Results

#: Curves of a legend at most.
MOST_NAMED = 12
#: Panels of one figure at most; curves of more units share one.
MOST_PANELS = 3
#: Widths of lines in the program's figures, pixels, and here, points.
STROKE, LINE = 3.0, 1.5
INK, GREY, GRID = "#222222", "#787878", "#e1e1e1"
RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def plot(results: Results, names: Sequence[str], over: Optional[str]) -> matplotlib.figure.Figure:
    """Figures of a study, or one of columns."""
    _tell_failed(results)
    plt = _optional.package("matplotlib.pyplot", "figures are drawn")
    figures = results._core.figures(list(names), over)
    if not figures:
        help = f"name columns: {', '.join(results.columns)}"
        raise Refused(f"study `{results.study}` has no figures; {help}", code="refused", help=help)
    rows = [(figure, unit, curves) for figure in figures for unit, curves in _panels(figure)]
    drawn: matplotlib.figure.Figure
    drawn, axes = plt.subplots(len(rows), 1, squeeze=False, figsize=(8.0, 1.8 + 3.0 * len(rows)), layout="constrained")
    above: Any = None
    for place, ((figure, unit, curves), ax) in enumerate(zip(rows, axes[:, 0])):
        first = place == 0 or rows[place - 1][0] is not figure
        _draw(ax, figure, unit, curves, title=first)
        if not ax.get_ylabel() and curves:
            # more names than there is room for
            ax.set_ylabel(_axis(results.quantities.get(curves[0][0], ""), unit or ""), color=INK)
        if not first:
            # panels of one figure have one horizontal axis
            ax.sharex(above)
            above.tick_params(labelbottom=False)
            above.set_xlabel("")
        above = ax
    return drawn


def _tell_failed(results: Results) -> None:
    """Warns of runs of a sweep that are not whole; raises :class:`StudyError` if none of them has anything to show."""
    failed = [index for index, reason in enumerate(results.reasons) if reason]
    if not failed:
        return
    first = f"{results.runs.label(failed[0])}: {results.reasons[failed[0]].splitlines()[0]}"
    if next(results.runs.whole(), None) is None:
        raise StudyError(f"none of the {len(results.runs)} runs of study `{results.study}` began; the first, {first}", code="run-stopped")
    verb = "is" if len(failed) == 1 else "are"
    # of the line that asks for the figure
    warnings.warn(f"{len(failed)} of {len(results.runs)} runs {verb} not whole; the first, {first}", stacklevel=4)


def _panels(figure: Dict[str, Any]) -> List[Tuple[Optional[str], List[Any]]]:
    """The curves of each unit, or all of them where these are too many."""
    units: Dict[str, List[Any]] = {}
    curves = [(*curve, style) for curve, style in zip(figure["curves"], figure["styles"])]
    for curve in curves:
        units.setdefault(curve[1], []).append(curve)
    return list(units.items()) if 0 < len(units) <= MOST_PANELS else [(None, curves)]


def _draw(ax: matplotlib.axes.Axes, figure: Dict[str, Any], unit: Optional[str], curves: List[Any], title: bool) -> None:
    for label, own, points, (color, dash, dots) in curves:
        shown = f"{label} in {pretty(own)}" if unit is None and own else label
        style: Any = "none" if dots else (0, [length / STROKE for length in dash]) if dash else "-"
        x, y = _parted(points).T
        marker = "." if dots else None
        ax.plot(x, y, label=shown, color=[c / 255 for c in color], linestyle=style, linewidth=LINE, marker=marker)
    for at in figure["breaks"]:
        ax.axvline(at, color=GREY, linewidth=0.6, linestyle=(0, (4, 4)))
    names = [curve[0] for curve in curves]
    name = figure["y"][0] or (", ".join(names) if len(names) <= 3 else "")
    if name:
        ax.set_ylabel(_axis(name, unit or ""), color=INK)
    ax.set_xlabel(_axis(*figure["x"]), color=INK)
    if title:
        ax.set_title(figure["title"], loc="left", color=INK, fontsize="medium")
    if len(curves) > MOST_NAMED:
        note = f"{len(curves)} curves, from {pretty(curves[0][0])} to {pretty(curves[-1][0])}"
        # on the curves, which may be anywhere
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 1.0}
        ax.annotate(note, (1.0, 1.0), (-4, -4), "axes fraction", "offset points", ha="right", va="top", color=INK, fontsize="small", bbox=box)
    elif len(curves) > 1:
        ax.legend(frameon=False)
    if figure["equal"]:
        ax.set_aspect("equal", adjustable="datalim")
    ax.grid(True, color=GRID, linewidth=0.8)
    ax.set_axisbelow(True)
    for side in ax.spines.values():
        side.set_color(GREY)
    ax.tick_params(colors=INK)


def _parted(points: Any) -> Any:
    """The points with a gap between the two sides of a jump: two at one place, where x else runs one way."""
    steps = np.diff(points[:, 0])
    if np.all(steps >= 0) or np.all(steps <= 0):
        return np.insert(points, np.flatnonzero(steps == 0) + 1, np.nan, axis=0)
    return points


def _axis(name: str, unit: str) -> str:
    """What an axis says: ``torque in N m``."""
    return f"{name} in {pretty(unit)}".strip() if unit else name


def pretty(unit: str) -> str:
    """``kg m^2`` as kg m²."""
    head, *powers = unit.split("^")
    for power in powers:
        digits = len(power) - len(power.lstrip("-0123456789"))
        head += power[:digits].translate(RAISED) + power[digits:]
    return head
