"""Sweeps and searches."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from common import CRANK_ROCKER

import grashof


def test_a_sweep_has_a_row_a_run() -> None:
    model = grashof.load(CRANK_ROCKER)
    lengths = np.linspace(0.4, 0.7, 4)
    sweep = model.sweep("one-turn", over={"l3": lengths, "load_max": [0, 3000]})
    assert sweep.columns[:2] == ["l3", "load_max"]
    assert np.array_equal(sweep["l3"], np.repeat(lengths, 2))
    assert len(sweep) == len(sweep.runs) == 8
    assert sweep.reasons == [""] * 8
    alone = model.run("one-turn", l3=float(lengths[1]), load_max=3000)
    assert np.array_equal(sweep.runs[3]["drive.torque"], alone["drive.torque"])
    assert sweep["mean_power"][3] == alone.scalars["mean_power"]
    assert sweep.runs.label(3) == "l3 = 0.5 m, load_max = 3000 N"
    # in the units of the values, where they have them
    written = model.sweep("one-turn", over={"l3": ["50 cm", "60 cm"]})
    assert written.runs.label(1) == "l3 = 60 cm"
    assert sweep.runs[-1].parameters["load_max"] == 3000
    assert len(sweep.runs[2:4]) == 2
    frame = sweep.to_pandas()
    assert list(frame["reason"]) == [""] * 8 and frame.index.name == "run"
    assert sweep.to_xarray()["mean_power"].dims == ("run",)


def test_values_are_drawn_from_distributions() -> None:
    model = grashof.load(CRANK_ROCKER)
    over = {"l3": grashof.normal("55 cm", "1 mm"), "load_max": grashof.uniform(2900, 3100)}
    sweep = model.sweep("one-turn", over=over, samples=32, seed=3)
    assert len(sweep) == 32
    power = sweep.statistics["mean_power"]
    assert power.runs == 32 and power.least < power.percentiles[50] < power.most
    assert power.mean == pytest.approx(np.mean(sweep["mean_power"]), rel=1e-12)
    assert power.deviation == pytest.approx(np.std(sweep["mean_power"], ddof=1), rel=1e-12)
    assert power.percentiles[95] == pytest.approx(np.percentile(sweep["mean_power"], 95), rel=1e-12)
    assert set(power.parts) == set(over) and power.parts["load_max"].share > 0.5
    again = model.study("one-turn").sweep(over, samples=32, seed=3)
    assert np.array_equal(again.table, sweep.table)
    with pytest.raises(grashof.ModelError) as wrong:
        model.sweep("one-turn", over=over)
    assert wrong.value.code == "missing-samples"


def test_what_round_off_alone_makes_vary_has_no_shares() -> None:
    model = grashof.load(CRANK_ROCKER)
    over: dict[str, Any] = {"l3": grashof.normal("55 cm", "1 mm"), "load_max": grashof.uniform(2900, 3100)}
    model, name = model.with_study("weight", {"inverse": {"over": "1 turn", "samples": 36}, "scalars": {"weight": "1 + 1e-15*sin(1e5*l3/(1 m))"}})
    weight = model.sweep(name, over=over, samples=32).statistics["weight"]
    assert 0 <= weight.deviation < 1e-12 and weight.parts == {}


def test_workers_do_not_change_bits() -> None:
    model = grashof.load(CRANK_ROCKER)
    sweeps = [model.sweep("one-turn", over={"l3": "0.5..0.6:3"}, workers=workers) for workers in (1, 2)]
    assert np.array_equal(sweeps[0].table, sweeps[1].table)
    assert model.study("one-turn").sweep({"l3": ["50 cm", 0.6]}, workers=1)["l3"].tolist() == [0.5, 0.6]


def test_a_run_that_does_not_begin_says_why() -> None:
    sweep = grashof.load(CRANK_ROCKER).sweep("one-turn", over={"l2": [1.0, 0.05]})
    assert sweep.reasons[0] == "" and sweep.reasons[1]
    with pytest.raises(grashof.StudyError):
        sweep.runs[1]
    assert len(list(sweep.runs.whole())) == 1
    with pytest.raises(IndexError):
        sweep.runs[2]


def test_solve() -> None:
    results = grashof.load(CRANK_ROCKER).solve("operating-point")
    assert results.solution is not None
    assert results.solution.parameter == "speed" and abs(results.solution.found - results.solution.target) < 1e-6
    with pytest.raises(grashof.Refused):
        grashof.load(CRANK_ROCKER).solve("one-turn")


def test_compare() -> None:
    compared = grashof.load(CRANK_ROCKER).compare("start-up-exact", ["dop853", "radau5"], [1e-6, 1e-8])
    assert [(row.integrator, row.size) for row in compared.rows] == [
        ("dop853", 1e-6), ("dop853", 1e-8), ("radau5", 1e-6), ("radau5", 1e-8),
    ]
    assert all(row.error < 1e-3 for row in compared.rows)
    assert list(compared.to_pandas()["tolerance"]) == [1e-6, 1e-8, 1e-6, 1e-8]
    frame = compared.to_pandas()
    assert (frame.attrs["units"]["time"], frame.attrs["units"]["energy"], frame.attrs["units"]["error"]) == ("s", "J", "")
    table = repr(compared).splitlines()
    assert table[1].split() == ["integrator", "tolerance", "time", "[s]", "error", "energy", "[J]", "reason"]
    assert table[2].split()[:2] == ["dop853", "1e-06"] and len(table) == 6
    with pytest.raises(TypeError):
        grashof.load(CRANK_ROCKER).compare("start-up-exact", ["dop853"])
