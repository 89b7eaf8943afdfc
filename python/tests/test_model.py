"""Models: reading, setting, and what is wrong with them."""

from __future__ import annotations

import pathlib

import numpy as np
import pytest
from common import CRANK_ROCKER, MODELS, PENDULUM

import grashof


def test_a_model_has_its_names() -> None:
    model = grashof.load(str(CRANK_ROCKER))
    assert model.studies[:2] == ["one-turn", "one-turn-unloaded"]
    assert "motor" in model.variants
    assert model.parameters["l3"] == 0.55
    assert model.units["l3"] == "m"
    assert model.check() == []
    assert "crank-rocker" in model.text


def test_set_gives_a_new_model() -> None:
    model = grashof.load(CRANK_ROCKER)
    other = model.set(l3="60 cm", l1=0.125)
    assert (other.parameters["l3"], other.parameters["l1"]) == (0.6, 0.125)
    assert model.parameters["l3"] == 0.55
    assert other.set({"l3": np.float64(0.5)}).parameters["l3"] == 0.5
    with pytest.raises(TypeError):
        model.set(l3=[1.0])


def test_a_variant_gives_a_new_model() -> None:
    model = grashof.load(CRANK_ROCKER)
    loaded = model.study("one-turn").run()
    unloaded = model.variant("unloaded").run("one-turn")
    assert loaded.scalars["mean_power"] > 1000
    assert abs(unloaded.scalars["mean_power"]) < 1e-6


def test_a_mapping_is_a_file(tmp_path: pathlib.Path) -> None:
    mapping = {
        "grashof": 1,
        "name": "pendulum",
        "space": "planar",
        "gravity": [0, "-9.81 m/s^2"],
        "parameters": {"length": np.float64(0.7)},
        "bodies": {"rod": {"bar": {"length": "length*1 m", "mass": "2 kg"}}},
        "joints": {"P": {"revolute": ("ground", "rod.start")}},
        "start": {"P.angle": "-30 deg", "P.omega": 0},
        "studies": {"swing": {"dynamics": {"until": "1 s"}, "columns": ["time", "P.angle", "P.fy"]}},
    }
    text = """
grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { length: 0.7 }
bodies: { rod: { bar: { length: length*1 m, mass: 2 kg } } }
joints: { P: { revolute: [ground, rod.start] } }
start: { P.angle: -30 deg, P.omega: 0 }
studies: { swing: { dynamics: { until: 1 s }, columns: [time, P.angle, P.fy] } }
"""
    path = tmp_path / "pendulum.yaml"
    path.write_text(text)
    code = grashof.Model(**{key: value for key, value in mapping.items() if key not in ("grashof", "bodies")})
    code.bodies["rod"] = {"bar": {"length": "length*1 m", "mass": "2 kg"}}
    code.save(tmp_path / "code.yaml")
    runs = [
        grashof.load(source).run("swing")
        for source in (mapping, path, code, tmp_path / "code.yaml")
    ]
    for run in runs:
        assert np.array_equal(run.table, runs[0].table)


def test_faults_have_places() -> None:
    with pytest.raises(grashof.ModelError) as caught:
        grashof.parse(PENDULUM.replace("revolute", "revolut")).run("swing")
    error = caught.value
    assert error.code == "unknown-key"
    assert error.place == "joints.P.revolut"
    assert "revolute" in error.help
    fault = error.faults[0]
    assert (fault.line, fault.severity, fault.place) == (8, "error", "joints.P.revolut")
    assert "joints: { P: { revolut" in str(error)
    assert isinstance(error, grashof.Error)


def test_a_mechanism_in_code_is_checked_by_the_library() -> None:
    code = grashof.Model(name="bad", space="planar")
    code.bodeis["rod"] = {"bar": {"length": "1 m", "mass": "2 kg"}}
    faults = code.load().check()
    assert any(fault.code == "unknown-key" and fault.place == "bodeis" for fault in faults)


def test_what_cannot_be_read_is_said() -> None:
    with pytest.raises(grashof.ModelError) as caught:
        grashof.load(MODELS / "nobody.yaml")
    assert caught.value.code == "unreadable"
    assert "nobody.yaml" in str(caught.value)
    with pytest.raises(grashof.ModelError):
        grashof.parse("grashof: [")


def test_names_that_there_are_not() -> None:
    model = grashof.load(CRANK_ROCKER)
    with pytest.raises(grashof.UnknownName) as caught:
        model.run("one-tern")
    assert "`one-turn`" in caught.value.help
    with pytest.raises(grashof.UnknownName):
        model.set(nobody=1.0)
    with pytest.raises(grashof.UnknownName):
        model.variant("nobody")
    with pytest.raises(KeyError):
        model.run("one-turn")["nobody"]
    with pytest.raises(grashof.UnknownName):
        model.run("one-turn").scalars["nobody"]


def test_a_study_that_does_not_begin() -> None:
    with pytest.raises(grashof.StudyError) as caught:
        grashof.load(CRANK_ROCKER).run("one-turn", l2="10 cm")
    assert caught.value.faults
    assert caught.value.code


def test_robots_are_included() -> None:
    model = grashof.load(MODELS / "arm.yaml")
    assert model.dynamics().nv > 0
