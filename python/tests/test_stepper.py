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


def test_inputs_are_values_as_those_of_a_file() -> None:
    pint = pytest.importorskip("pint")
    speeds: list[float] = []
    for push in (4000.0, "4 kN m", pint.UnitRegistry()("4 kN m"), "length*4 kN"):
        motion = grashof.parse(PENDULUM).stepper("swing")
        motion.set_input("push", push)
        motion.advance(0.1)
        speeds.append(motion["P.omega"])
    assert speeds == [speeds[0]] * 4
    motion = grashof.parse(PENDULUM).stepper("swing")
    for wrong in ("4 kg", "4 kM"):
        with pytest.raises(grashof.ModelError):
            motion.set_input("push", wrong)


def test_a_motion_goes_forward() -> None:
    motion = grashof.parse(PENDULUM).stepper("swing")
    for by in (float("nan"), -1.0, float("inf")):
        with pytest.raises(grashof.Refused):
            motion.advance(by)
    with pytest.raises(grashof.Refused):
        motion.advance_to(float("nan"))
    assert motion.time == 0.0


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


def test_events_happen_and_end_a_motion() -> None:
    events = "events: { low: { when: P.angle + 90 deg }, end: { when: P.angle + 140 deg, crossing: falling, action: stop } }\n"
    motion = grashof.parse(PENDULUM + events).stepper("swing")
    assert not motion.ended
    while not motion.ended:
        motion.advance(0.05)
    assert [name for _, name in motion.events] == ["low", "end"]
    assert motion.events[-1][0] == motion.time
    assert motion["P.angle"] == pytest.approx(np.radians(-140.0), abs=1e-9)
    with pytest.raises(grashof.Refused, match="by the event `end`"):
        motion.advance(0.05)


LIFT = """
grashof: 1
name: lift
space: planar
gravity: [0, -10 m/s^2]
parameters: { push: 0 N }
bodies: { box: { mass: 1 kg } }
joints: { S: { slider: [ground, box.origin], axis: [0, 1], limits: { from: 0 m, restitution: 0 } } }
loads: { up: { joint: S, force: push } }
start: { S.position: 0.2 m }
studies: { fall: { dynamics: { until: 9 s }, columns: [S.position, S.velocity] } }
"""


def test_what_rests_on_a_stop_is_lifted_by_an_input() -> None:
    motion = grashof.parse(LIFT).stepper("fall")
    motion.advance_to(1.0)
    assert motion["S.velocity"] == 0.0
    motion.set_input("push", 9.0)
    motion.advance_to(2.0)
    assert motion["S.position"] == pytest.approx(0.0, abs=1e-15)
    motion.set_input("push", 12.0)
    motion.advance_to(3.0)
    assert motion["S.position"] == pytest.approx(1.0, rel=1e-9)
    motion.set_input("push", 0.0)
    motion.advance_to(4.0)
    assert motion["S.position"] == pytest.approx(0.0, abs=1e-12)
