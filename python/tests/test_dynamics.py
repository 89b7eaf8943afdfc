"""The equations of motion by hand."""

from __future__ import annotations

import time

import numpy as np
import pytest
from common import CRANK_ROCKER, MODELS, PENDULUM

import grashof


@pytest.fixture(params=["crank_rocker.yaml", "double_pendulum.yaml", "heavy_top.yaml", "stewart_platform.yaml", "arm.yaml"])
def dynamics(request: pytest.FixtureRequest) -> grashof.Dynamics:
    return grashof.load(MODELS / str(request.param)).dynamics()


def test_a_batch_is_its_states(dynamics: grashof.Dynamics) -> None:
    d = dynamics
    q0, v0 = d.start()
    random = np.random.default_rng(1)
    q = q0 + 1e-3 * random.standard_normal((3, 2, d.nq))
    v = v0 + 0.1 * random.standard_normal((3, 2, d.nv))
    a = random.standard_normal((3, 2, d.nv))
    t = np.array([[0.0], [0.1], [0.2]])
    accelerations, multipliers = d.solve(t, q, v)
    assert accelerations.shape == (3, 2, d.nv) and multipliers.shape == (3, 2, d.m)
    for i in range(3):
        for j in range(2):
            at, along = q[i, j], v[i, j]
            assert np.array_equal(d.mass(q)[i, j], d.mass(at))
            assert np.array_equal(d.constraints(q, t)[i, j], d.constraints(at, t[i, 0]))
            assert np.array_equal(d.jacobian(q, t)[i, j], d.jacobian(at, t[i, 0]))
            assert np.array_equal(d.bias(q, v, t)[i, j], d.bias(at, along, t[i, 0]))
            assert np.array_equal(accelerations[i, j], d.accelerations(t[i, 0], at, along))
            assert np.array_equal(d.inverse(q, v, a, t=t)[i, j], d.inverse(at, along, a[i, j], t=t[i, 0]))


def test_they_are_one_system(dynamics: grashof.Dynamics) -> None:
    d = dynamics
    q, v = d.start()
    a, multipliers = d.solve(0.0, q, v)
    residual = d.mass(q) @ a + d.jacobian(q).T @ multipliers + d.bias(q, v)
    scale = np.abs(d.mass(q)).max() * (1 + np.abs(a).max()) + np.abs(d.bias(q, v)).max()
    assert np.abs(residual).max() < 1e-9 * scale
    assert np.allclose(d.inverse(q, v, a, multipliers), 0.0, atol=1e-9 * scale)
    assert np.abs(d.constraints(q)).max(initial=0.0) < 1e-9
    assert len(d.coordinates) == d.nv


def test_a_projection_is_the_shortest_way_to_the_constraints(dynamics: grashof.Dynamics) -> None:
    d = dynamics
    q0, v0 = d.start()
    random = np.random.default_rng(2)
    small = 1e-5
    q = q0 + small * random.standard_normal((4, d.nq))
    v = v0 + random.standard_normal((4, d.nv))
    at, along = d.project(q, v)
    assert np.abs(d.constraints(at)).max(initial=0.0) < 1e-13
    for i in range(4):
        mass, rows = d.mass(at[i]), d.jacobian(at[i])
        # what is left free: motions along all rows
        _, sizes, turned = np.linalg.svd(rows) if d.m else (0, np.zeros(0), np.eye(d.nv))
        free = turned[np.count_nonzero(sizes > 1e-9 * sizes.max(initial=1.0)) :]
        scale = np.abs(mass).max()
        assert np.abs(free @ mass @ (along[i] - v[i])).max(initial=0.0) < 1e-7 * scale
        if d.nq == d.nv:
            assert np.abs(free @ mass @ (at[i] - q[i])).max(initial=0.0) < 1e-2 * small * scale
        # drivers move on: rates that were consistent at the start stay so
        assert np.allclose(rows @ along[i], rows @ d.project(at[i], along[i])[1], atol=1e-12 * (1 + np.abs(along[i]).max()))
    again, _ = d.project(at)
    assert np.allclose(again, at, rtol=0, atol=1e-14 * (1 + np.abs(at).max()))


def test_a_state_that_is_none_is_not_projected() -> None:
    d = grashof.load(CRANK_ROCKER).dynamics()
    with pytest.raises(grashof.Refused, match="state 0 of 1 has a number that is not finite"):
        d.project(np.full(d.nq, np.nan))


def test_a_pose_is_that_of_the_body() -> None:
    d = grashof.parse(PENDULUM).dynamics()
    angles = np.linspace(-1.0, 1.0, 5)[:, np.newaxis]
    pose = d.pose("rod", angles)
    assert pose.position.shape == (5, 3) and pose.rotation.shape == (5, 3, 3)
    assert np.allclose(pose.rotation[:, 0, 0], np.cos(angles[:, 0]))
    assert np.allclose(pose.rotation[:, 1, 0], np.sin(angles[:, 0]))
    with pytest.raises(grashof.UnknownName):
        d.pose("nobody", angles)


def test_a_pose_is_that_of_the_start() -> None:
    d = grashof.load(CRANK_ROCKER).dynamics()
    assert np.array_equal(d.pose("rocker").position, d.pose("rocker", d.start()[0]).position)


def test_a_state_that_is_not_finite_is_named() -> None:
    d = grashof.load(CRANK_ROCKER).variant("motor").dynamics()
    q, v = d.start()
    states = np.tile(q, (5, 1))
    states[3] = np.nan
    with pytest.raises(grashof.Refused, match="state 3 of 5") as raised:
        d.accelerations(0.0, states, v)
    assert raised.value.code == "not-finite"


def test_sizes_are_held() -> None:
    d = grashof.parse(PENDULUM).dynamics()
    with pytest.raises(grashof.Refused):
        d.mass([0.0, 1.0])
    with pytest.raises(grashof.Refused):
        d.accelerations(0.0, [0.0], 1.0)
    assert d.mass(np.zeros((0, 1))).shape == (0, 1, 1)


def test_a_batch_costs_no_loop_of_python() -> None:
    d = grashof.load(CRANK_ROCKER).dynamics()
    q, v = d.start()
    states = np.tile(q, (4000, 1))
    best = min(_timed(lambda: d.accelerations(0.0, states, v)) for _ in range(3))
    single = min(_timed(lambda: d.accelerations(0.0, q, v)) for _ in range(20))
    # a state in a batch does without what a call makes first
    assert best / 4000 < single


def _timed(run: object) -> float:
    begin = time.perf_counter()
    assert callable(run)
    run()
    return time.perf_counter() - begin
