"""A motion that is advanced from outside."""

from __future__ import annotations

import numpy as np
import pytest
from common import CRANK_ROCKER, PENDULUM

import grashof


def test_steps_go_where_the_study_goes() -> None:
    model = grashof.load(CRANK_ROCKER)
    for study, tolerance in (("start-up", 1e-3), ("start-up-exact", 1e-6)):
        motion = model.stepper(study)
        results = model.run(study)
        for _ in range(10):
            motion.advance(0.02)
        assert motion.time == pytest.approx(0.2, abs=1e-12)
        row = int(np.argmin(np.abs(results["time"] - 0.2)))
        assert motion["omega"] == pytest.approx(results["omega"][row], rel=tolerance)
        assert motion.state.q.shape == (3,) or motion.state.q.size > 0


def test_an_input_acts_from_then_on() -> None:
    text = PENDULUM.replace("gravity: [0, -9.81 m/s^2]", "gravity: none")
    motion = grashof.parse(text).stepper("swing")
    motion.advance(0.5)
    assert motion["P.omega"] == pytest.approx(0.0, abs=1e-12)
    motion.set_input("push", 4.0)
    assert motion.time == 0.5
    motion.advance(0.5)
    # a rod of 2 kg and 1 m about its end: 4 N m / (2/3 kg m^2)
    assert motion["P.omega"] == pytest.approx(3.0, rel=1e-7)
    motion.set_input("push", 0.0)
    motion.advance_to(2.0)
    assert motion["P.omega"] == pytest.approx(3.0, rel=1e-7)
    assert motion.columns["time"] == motion.time == 2.0
    # a time in the past changes nothing
    motion.advance_to(1.0)
    assert motion.time == 2.0


def test_many_inputs() -> None:
    motion = grashof.parse(PENDULUM).stepper("swing")
    for step in range(300):
        motion.set_input("push", -2.0 * motion["P.omega"] + 1e-9 * step)
        motion.advance(0.01)
    assert abs(motion["P.omega"]) < 1.0


def test_what_cannot_be_stepped_is_refused() -> None:
    model = grashof.load(CRANK_ROCKER)
    with pytest.raises(grashof.Refused):
        model.stepper("one-turn")
    with pytest.raises(grashof.UnknownName):
        model.stepper("nobody")
    motion = model.stepper("start-up-exact")
    with pytest.raises(grashof.UnknownName):
        motion.set_input("nobody", 1.0)
    with pytest.raises(grashof.UnknownName):
        motion["nobody"]
    motion.advance(0.01)
    with pytest.raises(grashof.Refused):
        grashof.parse(PENDULUM + "events: { low: { when: P.angle + 90 deg } }\n").stepper("swing")
