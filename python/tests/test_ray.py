"""Sweeps on a Ray cluster, of which machines are lost."""

from __future__ import annotations

import importlib
import json
import os
import pathlib
import pickle
from typing import Any, Iterator, Set

import numpy as np
import pytest
from common import CRANK_ROCKER, PENDULUM

import grashof
from grashof import __main__ as command
from grashof import cluster, distributed
from grashof.parts import Parts

os.environ.update(RAY_USAGE_STATS_ENABLED="0", RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO="0", RAY_worker_niceness="0")
ray: Any = pytest.importorskip("ray")
pytestmark = pytest.mark.filterwarnings("ignore")

#: A thousand lengths of the pendulum, of which some are none.
LENGTHS = {"length": np.concatenate([np.linspace(0.3, 2.0, 990), np.linspace(-0.2, -0.1, 10)]), "push": [0.0]}
SHORT = PENDULUM.replace("until: 2 s, every: 10 ms", "until: 0.1 s, every: 10 ms")


@pytest.fixture(scope="module")
def nodes() -> Iterator[Any]:
    """A cluster of three machines with a processor each; the head computes nothing, so that any of them may go."""
    made: Any = importlib.import_module("ray.cluster_utils").Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "include_dashboard": False})
    for _ in range(3):
        made.add_node(num_cpus=1)
    ray.init(address=made.address, log_to_driver=False, logging_level="ERROR")
    yield made
    ray.shutdown()
    made.shutdown()


@pytest.fixture(scope="module")
def model() -> grashof.LoadedModel:
    return grashof.parse(SHORT)


@pytest.fixture(scope="module")
def whole(model: grashof.LoadedModel, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The file of one process."""
    path = tmp_path_factory.mktemp("whole") / "swing.parquet"
    model.sweep("swing", LENGTHS).to_parquet(path)
    return path.read_bytes()


def cut(monkeypatch: pytest.MonkeyPatch, runs: int) -> None:
    """Parts of so many runs, however long they take."""

    def size(pace: object, left: int, processors: int) -> int:
        return runs

    monkeypatch.setattr(distributed, "Pace", type("Fixed", (distributed.Pace,), {"size": size}))


def parts_of(directory: pathlib.Path) -> Set[str]:
    return {path.name for path in (directory / "parts").glob("*.parquet")}


def test_a_lost_node_costs_nothing_but_its_unfinished_parts(
    nodes: Any, model: grashof.LoadedModel, whole: bytes, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cut(monkeypatch, 25)
    lost: list[int] = []

    def progress(done: int, count: int) -> None:
        if done >= 300 and not lost:
            lost.append(done)
            nodes.remove_node(list(nodes.worker_nodes)[-1], allow_graceful=False)

    table = model.sweep("swing", LENGTHS, workers="ray", into=tmp_path, progress=progress)
    assert lost and len(table) == 1000
    assert pathlib.Path(table.path).read_bytes() == whole
    assert pathlib.Path(table.path).name == "swing-over-length+push.parquet" and not parts_of(tmp_path)
    nodes.add_node(num_cpus=1)


def test_an_interrupted_sweep_goes_on(
    nodes: Any, model: grashof.LoadedModel, whole: bytes, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cut(monkeypatch, 31)

    def interrupt(done: int, count: int) -> None:
        if done >= 200:
            raise KeyboardInterrupt

    with pytest.raises(grashof.Interrupted) as stopped:
        model.sweep("swing", LENGTHS, workers="ray", into=tmp_path, progress=interrupt)
    kept = parts_of(tmp_path)
    assert kept and "of 1000 runs are kept" in str(stopped.value) and not (tmp_path / "swing-over-length+push.parquet").exists()
    with pytest.raises(grashof.Refused, match="another sweep"):
        model.sweep("swing", {"length": [1.0, 2.0]}, workers="ray", into=tmp_path)
    with pytest.raises(grashof.Refused, match="another sweep"):
        grashof.parse(model.text.replace("2 kg", "3 kg")).sweep("swing", LENGTHS, workers="ray", into=tmp_path)
    # a part that was torn is computed again
    torn = tmp_path / "parts" / sorted(kept)[0]
    torn.write_bytes(torn.read_bytes()[:100])
    cut(monkeypatch, 47)
    seen: list[int] = []
    # what decides nothing may have changed
    remarked = grashof.parse("# a remark\n" + model.text)
    table = remarked.sweep("swing", LENGTHS, workers="ray", into=tmp_path, progress=lambda done, count: seen.append(done))
    assert 0 < seen[0] < 1000 and pathlib.Path(table.path).read_bytes() == whole
    # what is there is not computed again
    known = os.stat(table.path).st_mtime_ns
    assert os.stat(model.sweep("swing", LENGTHS, workers="ray", into=tmp_path).path).st_mtime_ns == known


def test_a_table_is_that_of_the_results(nodes: Any, model: grashof.LoadedModel, tmp_path: pathlib.Path) -> None:
    over = {"length": grashof.normal(1.0, 0.01), "push": grashof.uniform(0, 0.1)}
    results = model.sweep("swing", over, samples=64, seed=5)
    table = model.sweep("swing", over, samples=64, seed=5, workers="ray", into=tmp_path)
    assert table.columns == results.columns and table.reasons == results.reasons and list(table) == results.columns
    assert np.array_equal(table.table, results.table) and np.array_equal(table["largest"], results["largest"])
    assert table.units == {name: results.units[name] for name in results.columns} and table.quantities["length"] == "length"
    assert table.statistics == results.statistics
    assert table.to_pandas().equals(results.to_pandas()) and table.to_xarray().equals(results.to_xarray())
    assert "64 runs" in repr(table) and "largest" in table
    table.to_parquet(tmp_path / "copy.parquet")
    results.to_parquet(tmp_path / "own.parquet")
    assert (tmp_path / "copy.parquet").read_bytes() == (tmp_path / "own.parquet").read_bytes()
    with pytest.raises(grashof.UnknownName):
        table["none"]


def test_parts_grow_to_the_time_that_they_are_to_take(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(distributed, "WORK", 1.0)
    pace = distributed.Pace()
    assert pace.size(10**6, 8) == 1
    sizes: list[int] = []
    for _ in range(6):
        size = pace.size(10**6, 8)
        sizes.append(size)
        pace.learn(size, 0.01 * size)
    assert sizes == [1, 4, 16, 64, 100, 100]
    # all processors end together, and a part has a run at least
    assert pace.size(160, 8) == 10 and pace.size(3, 8) == 1
    pace.learn(1, 1000.0)
    assert pace.size(10**6, 8) == 1


def test_what_no_run_of_a_part_has_is_left_out_of_the_whole_alone(nodes: Any, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # where the rod stands on its head there are no vibrations
    vibrating = PENDULUM.replace("  swing:", "  vibrations:\n    modes: { at: start }\n  swing:").replace("-30 deg, P.omega: 0", "way")
    vibrating = vibrating.replace("push: 0 N m", "push: 0 N m, way: -90 deg")
    model = grashof.parse(vibrating)
    over = {"way": ["90 deg", "90 deg", "-90 deg", "90 deg", "-90 deg"]}
    cut(monkeypatch, 1)
    results = model.sweep("vibrations", over)
    table = model.sweep("vibrations", over, workers="ray", into=tmp_path)
    results.to_parquet(tmp_path / "own.parquet")
    assert pathlib.Path(table.path).read_bytes() == (tmp_path / "own.parquet").read_bytes()


def test_models_are_pickled_with_their_files(tmp_path: pathlib.Path, model: grashof.LoadedModel) -> None:
    robot = '<robot name="r"><link name="base"/><link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>' \
        '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>' \
        '<joint name="hinge" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint></robot>'
    (tmp_path / "robot.urdf").write_text(robot)
    text = "grashof: 1\nname: r\nspace: spatial\ngravity: [0, 0, -9.81 m/s^2]\ninclude: { urdf: robot.urdf }\nparameters: { until: 1 s }\n"
    text += "start: { hinge.angle: 0, hinge.omega: 0 }\nstudies: { fall: { dynamics: { until: until }, columns: [hinge.angle] } }\n"
    (tmp_path / "model.yaml").write_text(text)
    loaded = grashof.load(tmp_path / "model.yaml").set(until="0.5 s")
    loaded, name = loaded.with_study("short", {"dynamics": {"until": "0.2 s"}, "columns": ["hinge.angle"]})
    packed = pickle.dumps(loaded)
    (tmp_path / "robot.urdf").unlink()
    (tmp_path / "model.yaml").unlink()
    again = pickle.loads(packed)
    for study in ("fall", name):
        assert np.array_equal(again.run(study).table, loaded.run(study).table)
    assert pickle.dumps(again) == packed and again.parameters == {"until": 0.5}
    crank = grashof.load(CRANK_ROCKER).variant("unloaded")
    assert pickle.loads(pickle.dumps(crank)).parameters == crank.parameters
    assert pickle.loads(pickle.dumps(model.study("swing"))).run(push=1.0).scalars == model.run("swing", push=1.0).scalars


def test_what_a_directory_holds_is_not_overwritten(tmp_path: pathlib.Path) -> None:
    about = {"study": "swing"}
    first = Parts(tmp_path / "a", "swing", 3, about)
    with pytest.raises(grashof.Refused, match="is being computed"):
        Parts(tmp_path / "a", "swing", 3, about)
    assert first.missing() == [(0, 3)]
    first.close()
    assert json.loads((tmp_path / "a" / "sweep.json").read_text()) == {"study": "swing", "runs": 3}
    (tmp_path / "a" / "sweep.json").write_text("none")
    with pytest.raises(grashof.Refused, match="cannot be read"):
        Parts(tmp_path / "a", "swing", 3, about)
    (tmp_path / "swing.parquet").write_text("somebody's own")
    with pytest.raises(grashof.Refused, match="is there already"):
        Parts(tmp_path, "swing", 3, about)


def test_arguments_and_packages_that_are_missing(model: grashof.LoadedModel, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(TypeError):
        model.sweep("swing", LENGTHS, into=tmp_path)  # type: ignore[call-overload]
    with pytest.raises(TypeError):
        model.sweep("swing", LENGTHS, workers="ray")  # type: ignore[call-overload]
    monkeypatch.setitem(__import__("sys").modules, "ray", None)
    with pytest.raises(grashof.Refused, match="pip install ray"):
        cluster.ray()


def test_the_command_line(nodes: Any, tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "pendulum.yaml"
    path.write_text(SHORT)
    out = tmp_path / "out"
    words = ["sweep", str(path), "--ray", "auto", "--over", "length=1 m,2 m,-1 m", "--set", "push=1 N m", "-o", str(out)]
    assert command.main(words) == 0
    assert "3 runs, of which 1 have no whole result" in capsys.readouterr().out
    assert command.main([*words, "--study", "none"]) == 2
    assert command.main([*words, "--over", "length"]) == 2 and "has no `=`" in capsys.readouterr().err
    assert command.main([*words, "--over", "length=3 m"]) == 2 and "is swept already" in capsys.readouterr().err
    assert command.main([*words, "--set", "push=2 N m"]) == 2 and "holds another sweep" in capsys.readouterr().err
    assert command.main([*words[:5], "length=-1 m,-2 m", "-o", str(tmp_path / "none")]) == 3
