"""Functions of Python in the expressions of a model."""

from __future__ import annotations

import os
import pathlib
import pickle
import signal
import threading
import time
from typing import Callable, List

import numpy as np
import pytest

import grashof
from common import PENDULUM


def drag(rate: float) -> float:
    return -0.3 * rate * abs(rate)


def drag_slope(rate: float) -> float:
    return -0.6 * abs(rate)


def nothing(rate: float) -> None:
    return None


def hidden_rest(angle: float) -> float:
    return rest(angle, angle < -1.0)


def rest(angle: float, beyond: bool) -> float:
    return -500.0 * (angle + 1.0) if beyond else 0.0


WITH = PENDULUM.replace("torque: push", "torque: push + air(P.omega)")
INSIDE = PENDULUM.replace("torque: push", "torque: push - 0.3*P.omega*abs(P.omega)*(1 N m s^2)")
AIR = grashof.Function(drag, unit="N m", switches={})


def test_a_load_by_a_function_is_that_of_the_file(tmp_path: pathlib.Path) -> None:
    model = grashof.parse(WITH, {"air": AIR})
    ours, theirs = model.run("swing"), grashof.parse(INSIDE).run("swing")
    # the switch of abs has rows of its own there
    assert abs(ours["P.angle"][-1] - theirs["P.angle"][-1]) < 1e-6
    # of the same text the program says what is missing
    path = tmp_path / "with.yaml"
    path.write_text(WITH)
    assert grashof.load(path, {"air": AIR}).run("swing").scalars == ours.scalars
    with pytest.raises(grashof.ModelError, match="a function or a table"):
        grashof.load(path).run("swing")


def test_switches_are_located_or_told() -> None:
    text = PENDULUM.replace("torque: push", "torque: pad(P.angle)")
    inside = PENDULUM.replace("torque: push", "'torque': 'if(P.angle < -1 rad, -500 N m/rad*(P.angle + 1 rad), 0)'")
    located = grashof.parse(text, {"pad": grashof.Function(rest, unit="N m", switches={"beyond": "angle < -1 rad"})}).run("swing")
    exact = grashof.parse(inside).run("swing")
    assert abs(located["P.angle"][-1] - exact["P.angle"][-1]) < 1e-9
    assert located.certificate["switches"] == exact.certificate["switches"]
    hidden = grashof.parse(text, {"pad": grashof.Function(hidden_rest, unit="N m")}).run("swing")
    told = [[finding.code for finding in run.findings] for run in (located, hidden)]
    assert "unresolved" not in told[0] and "unresolved" in told[1]


def test_what_a_function_raises_is_raised() -> None:
    def wrong(rate: float) -> float:
        if rate < -1.0:
            raise ZeroDivisionError("below -1")
        return 0.0

    model = grashof.parse(WITH, {"air": grashof.Function(wrong, unit="N m")})
    calls: List[Callable[[], object]] = [lambda: model.run("swing"), lambda: model.sweep("swing", {"length": [0.5, 1.0]})]
    for call in calls:
        with pytest.raises(ZeroDivisionError, match="below -1") as raised:
            call()
        assert raised.traceback[-1].name == "wrong"
    motion = model.stepper("swing")
    with pytest.raises(ZeroDivisionError):
        motion.advance(1.0)
    with pytest.raises(TypeError, match="`air` gave None"):
        model.with_functions(air=grashof.Function(nothing, unit="N m")).run("swing")
    # others than the one that raises are not touched
    assert grashof.parse(WITH, {"air": AIR}).run("swing").stopped is None


def test_derivatives_serve_implicit_schemes_and_vibrations() -> None:
    text = WITH.replace("dynamics: { until: 2 s, every: 10 ms }", "dynamics: { until: 2 s, every: 10 ms, integrator: radau5, tolerance: 1e-9 }")
    model = grashof.parse(text, {"air": AIR})
    slopes = model.with_functions(air=grashof.Function(drag, unit="N m", switches={}, slopes={"rate": drag_slope}))
    a, b = model.run("swing"), slopes.run("swing")
    np.testing.assert_allclose(a["P.angle"], b["P.angle"], atol=1e-7)
    spring = grashof.parse(PENDULUM.replace("torque: push", "torque: twist(P.angle)"), {"twist": grashof.Function(np.tanh, arguments=["angle"], unit="N m")})
    inside = grashof.parse(PENDULUM.replace("torque: push", "torque: tanh(P.angle)*1 N m"))
    pair = [m.modes(at="statics").lists["frequencies"] for m in (spring, inside)]
    np.testing.assert_allclose(pair[0], pair[1], rtol=1e-9)


def test_functions_go_where_their_model_goes() -> None:
    model = grashof.parse(WITH, {"air": AIR})
    packed = pickle.loads(pickle.dumps(model.set(length=0.8)))
    assert packed.run("swing").scalars == model.run("swing", length=0.8).scalars
    built = grashof.Model(name="free", space="planar", gravity="none", functions={"air": AIR})
    built.bodies["rod"] = {"bar": {"length": "1 m", "mass": "1 kg"}}
    built.joints["P"] = {"revolute": ["ground", "rod.start"]}
    built.loads["brake"] = {"joint": "P", "torque": "air(P.omega)"}
    built.start = {"P.omega": "1 rad/s"}
    built.studies["run"] = {"dynamics": {"until": "1 s"}, "columns": ["P.omega"]}
    # J ω' = −c ω²: ω = 1/(1 + c t/J)
    assert abs(built.load().run("run")["P.omega"][-1] - 1 / (1 + 0.3 * 3)) < 1e-6
    assert "functions" not in built.to_yaml()
    assert list(model.functions) == ["air"] and list(model.variant().functions) == ["air"]


def test_faults_of_functions() -> None:
    assert grashof.Function(np.sin).arguments == ["x"]
    with pytest.raises(TypeError, match="can be seen"):
        grashof.Function(lambda *all: 0.0)
    with pytest.raises(TypeError, match="last arguments"):
        grashof.Function(drag, switches={"late": "rate > 1"})
    with pytest.raises(TypeError, match="no argument"):
        grashof.Function(drag, slopes={"speed": drag})
    with pytest.raises(grashof.Refused, match="is a function"):
        grashof.parse(WITH, {"sin": drag})
    with pytest.raises(grashof.ModelError, match="length .m."):
        grashof.parse(WITH, {"air": grashof.Function(drag, unit="m")}).run("swing")


def test_many_threads_and_an_interrupt() -> None:
    def slow(rate: float) -> float:
        time.sleep(0.001)
        return 0.0

    # a process in the background of a shell may have been told to ignore it
    signal.signal(signal.SIGINT, signal.default_int_handler)
    model = grashof.parse(WITH.replace("until: 2 s", "until: 1000 s"), {"air": grashof.Function(slow, unit="N m", switches={})})
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    begin = time.monotonic()
    with pytest.raises(grashof.Interrupted):
        model.run("swing")
    assert time.monotonic() - begin < 5.0
    quick = grashof.parse(WITH, {"air": AIR})
    one = quick.sweep("swing", {"length": np.linspace(0.5, 1.0, 8)}, workers=1)
    many = quick.sweep("swing", {"length": np.linspace(0.5, 1.0, 8)}, workers=4)
    np.testing.assert_array_equal(one["largest"], many["largest"])
