"""Lists of points, and Sobol's indices."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from common import CRANK_ROCKER, PENDULUM

import grashof

#: Ishigami's function of three parameters, as a scalar of a model that needs none of them.
ISHIGAMI = PENDULUM.replace("push: 0 N m", "push: 0 N m, x1: 0, x2: 0, x3: 0").replace(
    "largest: max(abs(P.fy))", "ishigami: sin(x1) + 7*sin(x2)^2 + 0.1*x3^4*sin(x1), still: 1"
).replace("until: 2 s, every: 10 ms", "until: 1 ms, every: 1 ms")


def test_a_list_of_points_has_a_run_for_each() -> None:
    model = grashof.load(CRANK_ROCKER)
    points = np.array([[0.15, 0.5], [0.151, 0.55], [0.149, 0.6]])
    sweep = model.sweep("one-turn", over={("l1", "l3"): points, "load_max": [0, 3000]})
    assert sweep.columns[:3] == ["l1", "l3", "load_max"] and len(sweep) == 6
    assert np.array_equal(np.column_stack([sweep["l1"], sweep["l3"]]), np.repeat(points, 2, axis=0))
    assert sweep["mean_power"][3] == model.run("one-turn", l1=0.151, l3=0.55, load_max=3000).scalars["mean_power"]
    alone = model.sweep("one-turn", over={("l3",): [["50 cm"], [0.6]]})
    assert alone["l3"].tolist() == [0.5, 0.6]
    with pytest.raises(grashof.ModelError) as wrong:
        model.sweep("one-turn", over={("l1", "l3"): [[0.15, 0.5], [0.15]]})
    assert wrong.value.code == "uneven-points"
    with pytest.raises(grashof.ModelError) as twice:
        model.sweep("one-turn", over={("l1", "l3"): points, "l1": [0.1]})
    assert twice.value.code == "swept-twice"


def test_indices_are_those_of_the_closed_form() -> None:
    turn = grashof.uniform(-np.pi, np.pi)
    found = grashof.parse(ISHIGAMI).sensitivity("swing", over={"x1": turn, "x2": turn, "x3": turn}, samples=1024, seed=2)
    a, b = 7.0, 0.1
    variance = a**2 / 8 + b * np.pi**4 / 5 + b**2 * np.pi**8 / 18 + 0.5
    first = np.array([0.5 * (1 + b * np.pi**4 / 5) ** 2, a**2 / 8, 0.0]) / variance
    third = 8 * b**2 * np.pi**8 / 225 / variance
    total = first + np.array([third, 0.0, third])
    indices = found["ishigami"]
    assert len(found.results) == 5 * 1024 and list(found) == ["ishigami", "still"] and len(found) == 2
    for k, name in enumerate(["x1", "x2", "x3"]):
        assert indices[name].first == pytest.approx(first[k], abs=0.03)
        assert indices[name].total == pytest.approx(total[k], abs=0.03)
        assert 0 <= indices[name].first_confidence < 0.2 and 0 < indices[name].total_confidence < 0.2
    assert np.isnan(found["still"]["x1"].total)
    frame = found.to_pandas()
    assert frame.loc[("ishigami", "x2"), "first"] == indices["x2"].first and list(frame.index.names) == ["scalar", "parameter"]
    assert "ishigami" in repr(found)
    with pytest.raises(grashof.UnknownName):
        found["none"]


def test_points_are_mapped_by_the_distributions_of_the_model() -> None:
    model = grashof.parse(ISHIGAMI)
    over = {"x1": grashof.normal(1, 2), "x2": grashof.uniform("push/(1 N m)", 3)}
    found = model.sensitivity("swing", over=over, samples=256, values={"push": 2.0})
    x1, x2 = found.results["x1"], found.results["x2"]
    assert np.mean(x1) == pytest.approx(1, abs=0.05) and np.std(x1) == pytest.approx(2, abs=0.1)
    assert 2 <= np.min(x2) and np.max(x2) <= 3


def test_what_cannot_be_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    model = grashof.parse(ISHIGAMI)
    with pytest.raises(grashof.Refused, match="power of two"):
        model.sensitivity("swing", over={"x1": grashof.normal(0, 1)}, samples=100)
    with pytest.raises(grashof.Error):
        model.sensitivity("swing", over={"x1": [1, 2], "x2": grashof.normal(0, 1)}, samples=4)  # type: ignore[dict-item]
    monkeypatch.setitem(sys.modules, "SALib.sample.sobol", None)
    with pytest.raises(grashof.Refused, match="pip install SALib"):
        model.sensitivity("swing", over={"x1": grashof.normal(0, 1)}, samples=4)


def test_runs_without_a_result_are_told() -> None:
    pytest.importorskip("SALib")
    model = grashof.load(CRANK_ROCKER)
    with pytest.warns(UserWarning, match="have no whole result"):
        found = model.sensitivity("one-turn", over={"l3": grashof.uniform("0.1 m", "0.2 m")}, samples=16)
    assert np.isnan(found["mean_power"]["l3"].total)
