"""Signals and threads."""

from __future__ import annotations

import _thread
import os
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Callable

import numpy as np
import pytest
from common import CRANK_ROCKER, MODELS, PENDULUM

import grashof

LONG = PENDULUM.replace("until: 2 s, every: 10 ms", "until: 100000 s, tolerance: 1e-12")


def interrupted(run: Callable[[], object]) -> float:
    """How long a computation goes on behind Ctrl-C, s."""
    at: list[float] = []

    def press() -> None:
        at.append(time.monotonic())
        _thread.interrupt_main()

    timer = threading.Timer(0.3, press)
    timer.start()
    with pytest.raises(KeyboardInterrupt) as caught:
        run()
    end = time.monotonic()
    assert isinstance(caught.value, grashof.Interrupted)
    timer.join()
    return end - at[0]


def test_ctrl_c_ends_a_run() -> None:
    assert interrupted(lambda: grashof.parse(LONG).run("swing")) < 0.1


def test_ctrl_c_ends_a_sweep() -> None:
    model = grashof.load(CRANK_ROCKER)
    assert interrupted(lambda: model.sweep("one-turn", over={"l3": np.linspace(0.4, 0.7, 3000)})) < 0.1


def test_ctrl_c_ends_a_batch() -> None:
    d = grashof.load(MODELS / "stewart_platform.yaml").dynamics()
    q, v = d.start()
    states, velocities, times = np.tile(q, (80_000, 1)), np.tile(v, (80_000, 1)), np.zeros(80_000)
    assert interrupted(lambda: d.accelerations(times, states, velocities)) < 0.1


def test_ctrl_c_ends_poses() -> None:
    d = grashof.load(CRANK_ROCKER).dynamics()
    states = np.tile(d.start()[0], (3_000_000, 1))
    assert interrupted(lambda: d.pose("rocker", states)) < 0.15


def test_a_fork_has_threads_of_its_own() -> None:
    if not hasattr(os, "fork"):
        pytest.skip("this system has no fork")
    d = grashof.load(CRANK_ROCKER).dynamics()
    q, _ = d.start()
    motion = grashof.parse(PENDULUM).stepper("swing")
    mass = d.mass(q)
    motion.advance(0.01)
    child = os.fork()
    if child == 0:
        same = np.array_equal(d.mass(q), mass)
        try:
            motion.advance(0.01)
        except grashof.Refused:
            os._exit(0 if same else 1)
        os._exit(2)
    end = time.monotonic() + 20
    done, status = 0, 0
    while not done and time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        time.sleep(0.01)
    if not done:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    assert done and os.waitstatus_to_exitcode(status) == 0


def test_ctrl_c_ends_a_step() -> None:
    motion = grashof.parse(LONG).stepper("swing")
    assert interrupted(lambda: motion.advance(1e5)) < 0.1
    # it goes on from where it was ended
    at = motion.time
    motion.advance(0.01)
    assert motion.time >= at


def test_other_threads_run_meanwhile() -> None:
    model = grashof.parse(PENDULUM)
    want = model.run("swing").table

    def run(_: int) -> bool:
        return np.array_equal(model.run("swing").table, want)

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(run, range(16)))


def test_the_lock_of_the_interpreter_is_free() -> None:
    d = grashof.load(CRANK_ROCKER).dynamics()
    q, v = d.start()
    states = np.tile(q, (60000, 1))
    counted = 0
    ended = threading.Event()

    def work() -> None:
        d.accelerations(0.0, states, v)
        ended.set()

    worker = threading.Thread(target=work)
    worker.start()
    while not ended.wait(0.001):
        counted += 1
    worker.join()
    assert counted > 3
