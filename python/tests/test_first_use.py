"""What is said to somebody who gives what cannot be."""

from __future__ import annotations

import pathlib
import sys
from typing import Any, Callable, Dict, Tuple

import numpy as np
import pytest
from common import CRANK_ROCKER, PENDULUM

import grashof


@pytest.mark.parametrize("number", [float("nan"), np.inf, np.float64("-inf"), np.array(np.nan)])
def test_numbers_that_are_not_finite_are_refused(number: Any) -> None:
    model = grashof.parse(PENDULUM)
    calls: Dict[str, Callable[[], object]] = {
        "length": lambda: model.set(length=number),
        "push": lambda: model.sweep("swing", over={"push": [0.0, number]}),
        "deviation": lambda: grashof.normal(1.0, number),
    }
    for name, call in calls.items():
        with pytest.raises(ValueError, match=f"`{name}`.*no finite number"):
            call()
    with pytest.raises(ValueError, match="not finite"):
        grashof.load({"parameters": {"length": float("nan")}})


def test_an_array_without_axes_is_a_number() -> None:
    model = grashof.parse(PENDULUM)
    assert model.set(length=np.array(0.5)).parameters["length"] == 0.5
    assert model.sweep("swing", over={"length": np.array(0.5)})["length"].tolist() == [0.5]


def test_no_values_and_points_of_the_wrong_length() -> None:
    model = grashof.parse(PENDULUM)
    empty: Tuple[Any, ...] = ([], np.array([]))
    for nothing in empty:
        with pytest.raises(ValueError, match="no values for `length`"):
            model.sweep("swing", over={"length": nothing})
    for points in ([0.5, 1.0], [[0.5], [1.0]], [[0.5, 1.0, 2.0]]):
        with pytest.raises(grashof.ModelError, match="a row for each point, with 2 values: of `length`, `push`") as uneven:
            model.sweep("swing", over={("length", "push"): points})
        assert uneven.value.code == "uneven-points"
    with pytest.raises(TypeError, match="`length`"):
        model.sweep("swing", over={"length": [True]})
    assert len(model.sweep("swing", over={"length": (x for x in (0.5, 1.0))})) == 2


def test_one_tolerance_and_one_integrator() -> None:
    model = grashof.parse(PENDULUM)
    assert [(row.integrator, row.size) for row in model.compare("swing", "dop853", 1e-6).rows] == [("dop853", 1e-6)]
    for wrong in ([], -1.0, [float("nan")]):
        with pytest.raises(ValueError, match="`tolerances`"):
            model.compare("swing", "dop853", wrong)


def test_a_text_of_several_lines_is_no_path() -> None:
    assert grashof.load(PENDULUM).studies == ["swing"]
    with pytest.raises(grashof.ModelError, match="cannot read `name: x`"):
        grashof.load("name: x")


def test_what_is_not_checked_by_loading_is_told_by_check() -> None:
    empty = grashof.load({})
    assert empty.check() and empty.studies == []
    assert grashof.Model(name="x").load().check()
    for told in (grashof.load.__doc__, grashof.Model.__doc__, grashof.Model.load.__doc__):
        assert told and "check" in told


def test_errors_speak_of_calls() -> None:
    model = grashof.parse(PENDULUM)
    with pytest.raises(grashof.UnknownName) as caught:
        model.run("swing", Length="80 mm")
    told = str(caught.value)
    assert "--> values:1:1" in told and "| Length=80 mm" in told and "`length`" in caught.value.help
    with pytest.raises(grashof.UnknownName) as caught:
        model.variant("fre")
    assert "--> variant:1:1" in str(caught.value)
    with pytest.raises(grashof.ModelError) as wrong:
        model.sweep("swing", over={"length": grashof.normal(1, 0.1)})
    assert wrong.value.help == "add `samples=200`" and "--> over:1:8" in str(wrong.value)
    with pytest.raises(grashof.ModelError) as wrong:
        model.sweep("swing", over={"length": [1.0, 2.0]}, samples=5)
    assert wrong.value.help == "leave `samples=5` out"
    with pytest.raises(grashof.ModelError) as wrong:
        model.sweep("swing", over={"length": "1..2"})
    for error in (caught.value, wrong.value):
        assert "command line" not in str(error) and "--o" not in str(error) and "--s" not in str(error) and "--v" not in str(error)


def test_errors_of_mechanisms_in_code_have_their_place() -> None:
    code = grashof.Model(name="pendulum", space="planar", gravity="none", studies={"swing": {"dynamics": {"until": "1 s"}}})
    code.bodies["rod"] = {"bar": {"length": "1 m", "mass": "2 kg"}}
    code.joints["P"] = {"revolute": ["grund", "rod.start"]}
    with pytest.raises(grashof.ModelError) as caught:
        code.load().run("swing")
    assert caught.value.place == "joints.P.revolute[0]"
    assert ": joints.P.revolute[0]" in str(caught.value)
    model, name = grashof.load(CRANK_ROCKER).with_study("slow", {"inverse": {"over": "1 turn", "sampls": 36}})
    with pytest.raises(grashof.ModelError) as caught:
        model.run(name)
    assert "studies.slow.inverse.sampls" in str(caught.value)


def test_the_nearest_name_is_told() -> None:
    model = grashof.parse(PENDULUM)
    results = model.run("swing")
    calls: Dict[str, Callable[[], object]] = {
        "did you mean `swing`?": lambda: model.run("swnig"),
        "did you mean `P.omega`?": lambda: results["P.omga"],
        "did you mean `largest`?": lambda: results.scalars["largets"],
        "did you mean `P.angle`?": lambda: model.sweep("swing", over={"length": [1.0]}).plot("P.angel"),
    }
    for help, call in calls.items():
        with pytest.raises(grashof.UnknownName) as caught:
            call()
        assert caught.value.help.startswith(help) and help in str(caught.value)


@pytest.mark.parametrize("name", ["pandas", "xarray", "matplotlib.pyplot", "pint", "control", "scipy.signal"])
def test_packages_that_are_missing_are_named(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    results = grashof.parse(PENDULUM).run("swing")
    linear = grashof.parse(PENDULUM).linearize(at="start", columns=["P.angle"]).linear
    assert linear is not None
    calls: Dict[str, Callable[[], object]] = {
        "pandas": results.to_pandas,
        "xarray": results.to_xarray,
        "matplotlib.pyplot": results.plot,
        "pint": lambda: results.to_pint("P.fy"),
        "control": linear.to_control,
        "scipy.signal": linear.to_scipy,
    }
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(grashof.Refused) as caught:
        calls[name]()
    assert caught.value.code == "no-package" and caught.value.help == f"pip install {name.split('.')[0]}"


def test_the_page_lists_all_packages() -> None:
    page = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "python.md").read_text(encoding="utf-8")
    for package in ("pandas", "matplotlib", "xarray", "pint", "pyarrow", "control", "scipy", "SALib", "ray"):
        assert f"| `{package}` |" in page
