"""Results: the same numbers as the program's, as arrays and for other programs."""

from __future__ import annotations

import copy
import json
import pathlib
import pickle

import numpy as np
import pytest
from common import CRANK_ROCKER, MODELS, PENDULUM, run_program

import grashof


@pytest.mark.parametrize(
    ("file", "study"),
    [
        ("crank_rocker.yaml", "one-turn"),
        ("crank_rocker.yaml", "start-up-exact"),
        ("crank_rocker.yaml", "lengths"),
        ("crank_rocker.yaml", "operating-point"),
        ("crank_rocker.yaml", "modes"),
        ("double_pendulum.yaml", None),
        ("heavy_top.yaml", None),
        ("cart_pole.yaml", None),
    ],
)
def test_files_are_those_of_the_program(tmp_path: pathlib.Path, file: str, study: str | None) -> None:
    model = grashof.load(MODELS / file)
    name = study or model.studies[0]
    run_program("run", str(MODELS / file), "--study", name, "-o", str(tmp_path), "--no-plots", "--no-report")
    results = model.run(name)
    assert results.to_csv() == (tmp_path / f"{name}.csv").read_text()
    assert results.to_json() == (tmp_path / f"{name}.json").read_text()
    for number, run in enumerate(results.runs.whole(), 1):
        assert run.to_csv() == (tmp_path / f"{name}-{number:03}.csv").read_text()
    # the arrays have the bits of the file
    lines = results.to_csv().splitlines()[1:]
    if not results.reasons:
        rows = np.array([[float(x) if x else np.nan for x in line.split(",")] for line in lines])
        assert np.array_equal(rows, results.table, equal_nan=True)


def test_columns_are_views_into_one_table() -> None:
    results = grashof.parse(PENDULUM).run("swing")
    column = results["P.fy"]
    assert np.shares_memory(column, results.table)
    assert np.shares_memory(column, results["P.fy"])
    assert column.flags.c_contiguous and not column.flags.writeable
    with pytest.raises(ValueError):
        column[0] = 0.0
    assert results.columns == ["time", "P.angle", "P.omega", "P.fy"]
    assert results.table.shape == (201, 4) and len(results) == 201
    # a curve that only a figure shows
    assert results["P.fx"].shape == (201,)
    assert "P.fx" in results and "nobody" not in results
    kept = results.table
    del results
    assert np.isfinite(kept).all()


def test_what_is_known_of_a_motion() -> None:
    results = grashof.parse(PENDULUM).run("swing", length="60 cm")
    assert results.units["P.fy"] == "N" and results.quantities["P.omega"] == "angular speed"
    assert results.parameters == {"length": 0.6, "push": 0.0}
    extremes = results.extremes["P.fy"]
    assert extremes is not None
    assert results.scalars["largest"] == max(abs(extremes.min.value), abs(extremes.max.value))
    assert results.independent_name == "time" and results.independent[-1] == 2.0
    assert results.certificate["integrator"] and results.certificate["energy_drift"] < 1e-6
    assert results.stopped is None and results.events == [] and results.findings == []
    assert "largest" in results.summary() and "swing" in repr(results)
    assert json.loads(results.to_json())["scalars"]["largest"] == results.scalars["largest"]


def test_pandas_and_xarray() -> None:
    results = grashof.parse(PENDULUM).run("swing")
    frame = results.to_pandas()
    assert list(frame.columns) == results.columns and frame.index.name == "time"
    assert np.array_equal(frame.to_numpy(), results.table)
    assert frame.attrs["units"]["P.fy"] == "N"
    frame.loc[0.0, "P.fy"] = 1.0
    assert np.shares_memory(results.to_pandas(copy=False).to_numpy(), results.table)
    data = results.to_xarray()
    assert np.array_equal(data["P.fy"].values, results["P.fy"]) and data["P.fy"].attrs["units"] == "N"
    assert list(data.dims) == ["time"]


def test_every_unit_is_known_to_pint() -> None:
    results = grashof.load(CRANK_ROCKER).run("one-turn")
    for name in results.columns:
        quantity = results.to_pint(name)
        assert np.array_equal(quantity.magnitude, results[name])
    assert results.to_pint("drive.torque").check("[force] * [length]")
    import pint

    registry = pint.get_application_registry()
    assert grashof.load(CRANK_ROCKER).set(l3=registry.Quantity(60.0, "cm")).parameters["l3"] == 0.6


def test_parquet(tmp_path: pathlib.Path) -> None:
    import pandas

    results = grashof.parse(PENDULUM).run("swing")
    results.to_parquet(tmp_path / "swing.parquet")
    frame = pandas.read_parquet(tmp_path / "swing.parquet")
    assert np.array_equal(frame.to_numpy(), results.table)


def test_files_are_written(tmp_path: pathlib.Path) -> None:
    results = grashof.parse(PENDULUM).run("swing")
    results.to_csv(tmp_path / "a.csv")
    results.to_json(tmp_path / "a.json")
    assert (tmp_path / "a.csv").read_text() == results.to_csv()
    assert (tmp_path / "a.json").read_text() == results.to_json()


def test_events_and_expectations() -> None:
    text = PENDULUM + "    expect: { largest: { is: 0 N, within: 1 N } }\nevents: { low: { when: P.angle + 90 deg } }\n"
    results = grashof.parse(text).run("swing")
    assert [event.name for event in results.events][:1] == ["low"]
    assert [checked.met for checked in results.expectations] == [False]


def test_results_stay_in_their_process() -> None:
    results = grashof.load(CRANK_ROCKER).run("one-turn")
    with pytest.raises(grashof.Refused, match="to_pandas"):
        pickle.dumps(results)
    assert copy.copy(results) is results and copy.deepcopy([results])[0] is results


def test_parts_of_a_column_that_there_is_not_are_named() -> None:
    results = grashof.load(CRANK_ROCKER).run("one-turn")
    with pytest.raises(grashof.UnknownName, match=r"`B\.fx`"):
        results["B"]


def test_all_columns_have_their_units() -> None:
    pytest.importorskip("pint")
    results = grashof.load(CRANK_ROCKER).run("one-turn")
    quantities = results.to_pint()
    assert list(quantities) == results.columns
    assert quantities["drive.torque"].check("[force] * [length]")
