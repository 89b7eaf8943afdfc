"""What is looked at: figures, pages, animations."""

from __future__ import annotations

import pathlib
import warnings
from typing import Any, Dict, List, Tuple

import matplotlib
import numpy as np
import pytest
from common import CRANK_ROCKER, PENDULUM
from matplotlib.colors import to_hex

import grashof

matplotlib.use("Agg")


def test_a_figure_of_the_study() -> None:
    results = grashof.load(CRANK_ROCKER).run("one-turn")
    figure = results.plot("torque")
    axes = figure.axes
    assert len(axes) == 1 and axes[0].get_ylabel() == "drive.torque in N m" and axes[0].get_xlabel() == "theta in deg"
    assert to_hex(axes[0].lines[0].get_color()) == "#0072b2"
    assert len(results.plot().axes) >= 5


def test_a_figure_of_columns() -> None:
    results = grashof.parse(PENDULUM).run("swing")
    axes = results.plot("P.angle", "P.omega", "P.fy").axes
    assert [ax.get_ylabel() for ax in axes] == ["P.angle in deg", "P.omega in rad/s", "P.fy in N"]
    assert axes[-1].get_xlabel() == "time in s"
    assert results.plot("P.omega", over="P.angle").axes[0].get_xlabel() == "P.angle in deg"
    with pytest.raises(grashof.UnknownName) as caught:
        results.plot("nobody")
    assert "P.omega" in caught.value.help


def test_a_figure_of_a_sweep() -> None:
    sweep = grashof.load(CRANK_ROCKER).sweep("one-turn", over={"l3": [0.5, 0.55, 0.6]})
    assert len(sweep.plot("drive.torque").axes[0].lines) >= 3
    assert sweep.plot("mean_power").axes[0].get_xlabel() == "l3 in m"
    assert sweep.plot("mean_power", over="l3").axes[0].get_ylabel() == "mean_power in W"


def lines(figure: Any) -> Dict[str, Tuple[List[float], List[float]]]:
    """The curves of a figure by their labels."""
    return {str(line.get_label()): (line.get_xdata().tolist(), line.get_ydata().tolist()) for ax in figure.axes for line in ax.lines}


def test_numbers_of_a_grid_have_a_curve_for_each_combination_of_the_other_parameters() -> None:
    model = grashof.load(CRANK_ROCKER)
    lengths, speeds = [0.5, 0.55, 0.6], ["200 rpm", "240 rpm"]
    grid = model.sweep("one-turn", over={"l3": lengths, "speed": speeds})
    power = grid["mean_power"].reshape(3, 2)
    found = lines(grid.plot("mean_power"))
    assert list(found) == ["speed = 200 rpm", "speed = 240 rpm"]
    assert found["speed = 200 rpm"] == (lengths, power[:, 0].tolist()) and found["speed = 240 rpm"] == (lengths, power[:, 1].tolist())
    figure = grid.plot("mean_power", over="speed")
    found = lines(figure)
    assert list(found) == [f"l3 = {length} m" for length in lengths]
    assert found["l3 = 0.55 m"][1] == power[1].tolist()
    assert figure.axes[0].get_ylabel() == "mean_power in W"
    assert all(line.get_linestyle() == "-" or line.get_linestyle() == "--" for line in figure.axes[0].lines)


def test_drawn_values_and_points_are_not_joined() -> None:
    model = grashof.load(CRANK_ROCKER)
    over: Dict[Any, Any] = {"l3": grashof.normal("55 cm", "1 mm"), "load_max": grashof.uniform(2900, 3100)}
    drawn = model.sweep("one-turn", over=over, samples=8)
    points = model.sweep("one-turn", over={("l1", "l3"): [[0.15, 0.5], [0.15, 0.55], [0.14, 0.6]]})
    for sweep in (drawn, points):
        line = sweep.plot("mean_power", over="l3").axes[0].lines[0]
        assert (line.get_linestyle(), line.get_marker()) == ("None", ".")
        assert np.array_equal(line.get_ydata(), sweep["mean_power"])


def test_many_curves_have_a_note_in_place_of_a_legend() -> None:
    sweep = grashof.parse(PENDULUM).sweep("swing", over={"length": np.linspace(0.5, 1.28, 40)})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = sweep.plot("P.fy")
        figure.draw_without_rendering()
    assert figure.axes[0].get_legend() is None
    assert figure.axes[0].texts[0].get_text() == "40 curves, from length = 0.5 m to length = 1.28 m"


def test_runs_that_fail_are_told() -> None:
    model = grashof.load(CRANK_ROCKER)
    partly = model.sweep("one-turn", over={"l2": [1.0, 0.05]})
    for name in ("drive.torque", "mean_power"):
        with pytest.warns(UserWarning, match="1 of 2 runs is not whole; the first, l2 = 0.05 m: ") as caught:
            partly.plot(name)
        assert len(caught) == 1 and caught[0].filename == __file__
    with pytest.raises(grashof.UnknownName) as unknown, pytest.warns(UserWarning):
        partly.plot("drive.torqe")
    assert unknown.value.help.startswith("did you mean `drive.torque`?")
    failed = model.sweep("one-turn", over={"l2": [0.04, 0.05]})
    with pytest.raises(grashof.StudyError, match="none of the 2 runs") as wrong:
        failed.plot("drive.torque")
    assert failed.reasons[0].splitlines()[0] in str(wrong.value)


def test_pages(tmp_path: pathlib.Path) -> None:
    model = grashof.parse(PENDULUM)
    results = model.run("swing")
    page = results.report()
    assert page.text.startswith("<!doctype html>") and "<iframe srcdoc=" in page._repr_html_()  # pyright: ignore[reportPrivateUsage]
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == page.text
    sweep = model.sweep("swing", over={"length": [0.5, 1.0]})
    assert len(model.report(results, sweep).text) > len(page.text)


def test_animations(tmp_path: pathlib.Path) -> None:
    animation = grashof.parse(PENDULUM).run("swing").animate(width=400)
    assert animation.svg.startswith("<svg") and "animate" in animation.svg
    animation.save(tmp_path / "swing.svg")
    with pytest.raises(grashof.Refused):
        grashof.parse(PENDULUM).statics().animate()


def test_a_notebook_shows_summary_and_figures() -> None:
    html = grashof.parse(PENDULUM).run("swing")._repr_html_()  # pyright: ignore[reportPrivateUsage]
    assert html.startswith("<pre>") and html.count("<img") == 1 and "largest" in html
