"""Sweeps on Ray, measured: memory of the program that calls, efficiency by processor, and a machine that is lost on the way.

    python benches/cluster.py [--runs 100000] [--nodes 2] [--each 10]

A cluster of machines with a processor each is made on this one. The runs are motions of a double pendulum
of so many milliseconds. Efficiency is what a processor of the cluster does beside a process that computes the same rows with one thread
and without Ray: alone, and with one such process on every processor at once, which take turns where two processors are one core.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import pathlib
import subprocess
import sys
import tempfile
import time

os.environ.update(RAY_USAGE_STATS_ENABLED="0", RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO="0")

import numpy as np
import ray
from ray.cluster_utils import Cluster

import grashof
from grashof._text import axes
from grashof.cluster import Task, compute

PENDULUM = """
grashof: 1
name: double pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { length: 1 m, until: 1 s }
bodies:
  upper: { bar: { length: length, mass: 1 kg } }
  lower: { bar: { length: 0.7 m, mass: 0.8 kg } }
joints:
  P: { revolute: [ground, upper.start] }
  Q: { revolute: [upper.end, lower.start] }
start: { P.angle: 60 deg, Q.angle: -30 deg, P.omega: 0, Q.omega: 1 rad/s }
studies:
  swing:
    dynamics: { until: until, every: until/20, tolerance: 1e-9 }
    columns: [P.angle, Q.angle]
    scalars: { widest: max(abs(P.angle)), behind: max(Q.angle) }
"""


def lengths(runs: int) -> dict[str, np.ndarray]:
    return {"length": np.linspace(0.5, 1.5, runs)}


def alone(model: grashof.LoadedModel, runs: int) -> float:
    """What a run takes in this process with one thread, s: the rows of the table, as Parquet."""
    task = Task("", grashof.__version__, model._core.pack(), {}, "swing", axes(lengths(runs)), None)
    return compute(task._replace(fingerprint=str(time.perf_counter())), 0, runs)[1] / runs


def side_by_side(model: grashof.LoadedModel, runs: int, processes: int) -> float:
    """What a run takes where so many processes compute at once, s."""
    with multiprocessing.get_context("spawn").Pool(processes) as pool:
        pool.starmap(alone, [(model, 20)] * processes, chunksize=1)
        return sum(pool.starmap(alone, [(model, runs)] * processes, chunksize=1)) / processes


def timed(model: grashof.LoadedModel, wanted: float) -> grashof.LoadedModel:
    """The model with motions so long that a run takes about so long."""
    until = 1.0
    for _ in range(4):
        each = alone(model.set(until=until), 100)
        if abs(each / wanted - 1) < 0.05:
            break
        until *= wanted / each
    return model.set(until=until)


def memory() -> int:
    """Memory of this process that is resident, bytes."""
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def measure(runs: int, nodes: int, each: float, lost: bool) -> None:
    """Computes a sweep in this process, which is new, and prints a row."""
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "include_dashboard": False})
    for _ in range(nodes):
        cluster.add_node(num_cpus=1)
    ray.init(address=cluster.address, log_to_driver=False, logging_level="ERROR")
    model = timed(grashof.parse(PENDULUM), each)
    one, many = alone(model, 500), side_by_side(model, 500, nodes)
    most = 0
    gone: list[object] = []

    def progress(done: int, count: int) -> None:
        nonlocal most
        most = max(most, memory())
        if lost and done > count // 2 and not gone:
            gone.append(cluster.remove_node(list(cluster.worker_nodes)[-1], allow_graceful=False))
            cluster.add_node(num_cpus=1)

    # workers are begun before the clock
    with tempfile.TemporaryDirectory() as place:
        model.sweep("swing", lengths(8 * nodes), workers="ray", into=pathlib.Path(place) / "warm")
        begin = time.perf_counter()
        table = model.sweep("swing", lengths(runs), workers="ray", into=pathlib.Path(place) / "runs", progress=progress)
        took = time.perf_counter() - begin
        whole = sum(reason == "" for reason in table.reasons)
    one, many = (one + alone(model, 500)) / 2, (many + side_by_side(model, 500, nodes)) / 2
    efficiencies = [each * runs / (took * nodes) for each in (one, many)]
    event = "one machine lost" if lost else "none lost"
    shown = f"{1e3 * one:.2f}, {1e3 * many:.2f} ms | {took:.0f} s | {efficiencies[0]:.2f}, {efficiencies[1]:.2f}"
    print(f"| {runs} | {event} | {whole} | {shown} | {most / 1e6:.0f} MB |", flush=True)
    ray.shutdown()
    cluster.shutdown()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=100_000)
    parser.add_argument("--nodes", type=int, default=2)
    parser.add_argument("--each", type=float, default=10.0, help="time of a run, ms")
    parser.add_argument("--one", action="store_true", help="one row, in this process")
    parser.add_argument("--lost", action="store_true", help="lose a machine on the way")
    asked = parser.parse_args()
    if asked.one:
        measure(asked.runs, asked.nodes, asked.each / 1000, asked.lost)
        return
    print("| runs | machines | whole | a run alone, side by side | time | efficiency beside each | memory of the caller |")
    print("|---|---|---|---|---|---|---|", flush=True)
    for runs, lost in [(1000, False), (asked.runs, True)]:
        words = ["--one", "--runs", str(runs), "--nodes", str(asked.nodes), "--each", str(asked.each), *(["--lost"] if lost else [])]
        subprocess.run([sys.executable, __file__, *words], check=True)


if __name__ == "__main__":
    main()
