"""What is looked at: figures, pages, animations."""

from __future__ import annotations

import pathlib

import matplotlib
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
