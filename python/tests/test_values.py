"""Values as they come from Python: quantities, frames, ranges, and those that cannot be."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Callable

import numpy as np
import pytest
from common import CRANK_ROCKER, run_program

import grashof

STUDY = "one-turn"


@pytest.fixture(scope="module")
def model() -> grashof.LoadedModel:
    return grashof.load(CRANK_ROCKER)


@pytest.mark.parametrize("system", ["mks", "imperial", "cgs"])
def test_quantities_keep_their_dimension_in_any_registry(model: grashof.LoadedModel, system: str) -> None:
    pint = pytest.importorskip("pint")
    unit: Any = pint.UnitRegistry(system=system)
    assert model.set(l3=unit("60 cm")).parameters["l3"] == model.set(l3="60 cm").parameters["l3"]
    assert model.set(load_max=unit("2 kN")).parameters["load_max"] == 2000
    assert model.set(speed=unit("120 rpm")).parameters["speed"] == pytest.approx(4 * np.pi, rel=1e-15)
    swept = model.sweep(STUDY, over={"l3": np.array([50, 55]) * unit.cm})
    assert swept["l3"].tolist() == [0.5, 0.55]
    calls: list[Callable[[], object]] = [
        lambda: model.set(l3=unit("600 g")),
        lambda: model.run(STUDY, l3=unit("600 g")),
        lambda: model.sweep(STUDY, over={"l3": np.array([500, 550]) * unit.gram}),
        lambda: model.sweep(STUDY, over={"l3": grashof.normal(0.55 * unit.kg, 1 * unit.g)}, samples=2),
        lambda: model.set(l3=unit("300 kelvin")),
    ]
    for wrong in calls:
        with pytest.raises(grashof.ModelError) as raised:
            wrong()
        assert raised.value.code == "wrong-dimension"


def test_quantities_stand_in_mechanisms_in_code() -> None:
    pint = pytest.importorskip("pint")
    unit: Any = pint.UnitRegistry()
    built = grashof.Model(name="pendulum", space="planar", gravity=np.array([0, -9.81]) * unit("m/s^2"))
    built.parameters["length"] = unit("50 cm")
    built.bodies["rod"] = {"bar": {"length": "length", "mass": unit("2 kg")}}
    built.joints["P"] = {"revolute": ["ground", "rod.start"]}
    built.start["P.angle"] = unit("-90 deg")
    built.studies["rest"] = {"statics": {"from": "start"}, "scalars": {"pull": "last(P.fy)"}}
    assert built.check() == []
    assert abs(built.run("rest").scalars["pull"]) == pytest.approx(2 * 9.81, rel=1e-12)


def test_points_go_by_their_names(model: grashof.LoadedModel) -> None:
    pandas = pytest.importorskip("pandas")
    rows = [{"l1": 0.14, "l3": 0.5}, {"l3": 0.6, "l1": 0.15}]
    frame = pandas.DataFrame(rows)[["l3", "l1"]]
    overs: list[Any] = [{("l1", "l3"): rows}, {("l1", "l3"): frame}, {("l3", "l1"): frame}, frame]
    for over in overs:
        swept = model.sweep(STUDY, over=over)
        assert (swept["l1"].tolist(), swept["l3"].tolist()) == ([0.14, 0.15], [0.5, 0.6])
    wrong: list[Any] = [{("l1", "l3"): frame[["l3"]]}, {("l1", "l3"): [{"l1": 0.14, "l2": 0.5}]}, {"l3": {"l1": 3}}]
    for over in wrong:
        with pytest.raises(grashof.ModelError):
            model.sweep(STUDY, over=over)
    for over in ({1: [0.5]}, [0.5], {("l1", "l3"): {"l1": [0.14], "l3": [0.5]}}):
        with pytest.raises(TypeError):
            model.sweep(STUDY, over=over)


def test_ranges_have_the_keys_of_a_file(model: grashof.LoadedModel) -> None:
    over = {"l3": {"from": "50 cm", "to": 0.6, "count": 3}, "load_max": {"from": 10, "to": 1000, "count": 3, "log": True}}
    swept = model.sweep(STUDY, over=over)
    assert np.allclose(swept["l3"][::3], [0.5, 0.55, 0.6], rtol=1e-15) and np.allclose(swept["load_max"][:3], [10, 100, 1000])
    drawn = [
        model.sweep(STUDY, over={"l3": spread}, samples=4)["l3"].tolist()
        for spread in ({"normal": ["55 cm", "1 mm"]}, grashof.normal("55 cm", "1 mm"))
    ]
    assert drawn[0] == drawn[1]


def test_a_parameter_that_a_study_varies_is_not_set(model: grashof.LoadedModel) -> None:
    calls: list[Callable[[], object]] = [
        lambda: model.run("lengths", l3=0.5),
        lambda: model.solve("operating-point", speed=20.0),
        lambda: model.sweep(STUDY, over={"l3": [0.5]}, values={"l3": 0.6}),
        lambda: model.set(l3=0.6).sweep(STUDY, over={"l3": [0.5]}),
    ]
    for asked in calls:
        with pytest.raises(grashof.Refused, match="varies it"):
            asked()


def test_what_a_file_expects_is_judged_as_by_the_program(model: grashof.LoadedModel, tmp_path: Path) -> None:
    assert model.run(STUDY).expectations
    calls: list[tuple[grashof.Results, list[str]]] = [
        (model.run(STUDY), []),
        (model.run(STUDY, l3="60 cm"), ["--set", "l3=60 cm"]),
        (model.variant("unloaded").run(STUDY), ["--variant", "unloaded"]),
    ]
    for results, flags in calls:
        run_program("run", str(CRANK_ROCKER), "--study", STUDY, "--no-report", "--no-plots", "--force", "-q", "-o", str(tmp_path), *flags)
        assert json.loads(results.to_json()) == json.loads((tmp_path / f"{STUDY}.json").read_text())


DRAWN = {"l3": grashof.normal("55 cm", "1 mm")}


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"over": DRAWN, "samples": 0}, ValueError),
        ({"over": DRAWN, "samples": 2.0}, TypeError),
        ({"over": DRAWN, "samples": 2, "seed": -1}, ValueError),
        ({"over": DRAWN, "samples": 2, "seed": 2**70}, ValueError),
        ({"over": {"l3": [0.5]}, "workers": 0}, ValueError),
        ({"over": {"l3": [0.5]}, "workers": "dask"}, TypeError),
    ],
)
def test_arguments_of_sweeps_are_looked_at(model: grashof.LoadedModel, options: dict[str, Any], error: type[Exception]) -> None:
    with pytest.raises(error):
        model.sweep(STUDY, **options)


def test_other_arguments_are_looked_at(model: grashof.LoadedModel) -> None:
    with pytest.raises(grashof.Refused):
        model.sensitivity(STUDY, {}, samples=4)
    with pytest.raises(grashof.Refused):
        model.sensitivity(STUDY, DRAWN, samples=8, confidence=2)
    with pytest.raises(grashof.UnknownName):
        model.study("one-tur")
