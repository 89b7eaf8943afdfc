"""Equilibria, vibrations, linear systems."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from common import CRANK_ROCKER, PENDULUM

import grashof


def test_equilibria_of_a_model_without_a_study_of_them() -> None:
    results = grashof.parse(PENDULUM).statics()
    assert results.kind == "statics"


def test_vibrations() -> None:
    results = grashof.parse(PENDULUM).modes(at="statics")
    # a rod of 1 m about its end: w^2 = 3 g / (2 l)
    assert results.lists["eigenvalues"][0] == pytest.approx(1.5 * 9.81)
    assert list(results.shapes[0]) == ["P.angle"]
    assert grashof.load(CRANK_ROCKER).modes("modes").lists["eigenvalues"].shape == (3,)
    with pytest.raises(grashof.Refused):
        grashof.load(CRANK_ROCKER).modes("lengths")
    with pytest.raises(grashof.ModelError) as caught:
        grashof.parse(PENDULUM).modes(sideways=True)
    assert caught.value.code == "unknown-key"


def test_a_linear_system() -> None:
    results = grashof.parse(PENDULUM).linearize(at="statics", inputs=["push"], columns=["P.angle"])
    linear = results.linear
    assert linear is not None
    inertia = 2.0 / 3.0
    assert np.allclose(linear.A, [[0.0, 1.0], [-1.5 * 9.81, 0.0]])
    assert np.allclose(linear.B, [[0.0], [1 / inertia]])
    assert np.allclose(linear.C, [[1, 0]]) and np.allclose(linear.D, [[0]])
    assert np.allclose(linear.mass, [[inertia]])
    assert (linear.inputs, linear.outputs) == (["push"], ["P.angle"])
    shown = repr(linear)
    assert "2 states, 1 inputs, 1 outputs" in shown and "states x: P.angle, P.omega" in shown and "inputs u: push" in shown
    assert "A 2 × 2, B 2 × 1, C 1 × 2, D 1 × 1" in shown
    assert all(f"``{name}``" in str(grashof.Linear.__doc__) for name in ("states", "inputs", "outputs", "A", "mass", "rates"))
    scipy: Any = linear.to_scipy()
    assert np.array_equal(np.asarray(scipy.A), linear.A)
    control: Any = linear.to_control()
    assert np.array_equal(np.asarray(control.A), linear.A)
    assert list(control.input_labels) == ["push"]


def test_a_study_is_added() -> None:
    model, name = grashof.parse(PENDULUM).with_study("swing", {"dynamics": {"until": "10 ms"}, "columns": ["P.angle"]})
    assert name == "swing-2" and name in model.studies
    assert model.run(name).independent[-1] == 0.01


def test_modes_have_no_independent_variable() -> None:
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    modes = grashof.load(CRANK_ROCKER).run("modes")
    assert list(modes.to_pandas().index) == list(modes.to_xarray()["row"]) == list(range(len(modes)))
    with pytest.raises(grashof.UnknownName):
        modes.lists["freq"]
