"""The cart and pole as an environment of Gymnasium."""

from __future__ import annotations

import time
import warnings
from typing import Any

import gymnasium
import gymnasium_cart_pole as cart_pole
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env


def made(**keys: Any) -> Any:
    return gymnasium.make("grashof/CartPole-v0", **keys)


def test_the_checker_of_gymnasium_has_nothing_to_say() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(made(render_mode="rgb_array").unwrapped)


@pytest.mark.parametrize("seed", range(5))
def test_a_simple_controller_holds_the_pole(seed: int) -> None:
    env = made()
    assert cart_pole.episode(env, seed) == 500
    observation = env.unwrapped.step(np.zeros(1, dtype=np.float32))[0]
    assert np.abs(observation).max() < 0.01


def test_left_alone_it_falls_and_the_episode_ends() -> None:
    env = made()
    env.reset(options={"lean": 0.01})
    rows = [env.step(np.zeros(1, dtype=np.float32)) for _ in range(50)]
    leans = np.array([row[0][2] for row in rows])
    # small leans grow as cosh(p t)
    p = env.unwrapped.model.parameters["p"]
    expected = 0.01 * np.cosh(p * 0.02 * np.arange(1, 21))
    assert leans[:20] == pytest.approx(expected, rel=5e-3)
    ended = np.array([row[2] for row in rows])
    assert not ended[:20].any() and ended[-1] and rows[-1][1] == 0.0


def test_energy_is_what_the_force_has_given() -> None:
    env = made().unwrapped
    _, info = env.reset(options={"lean": 0.1})
    rng = np.random.default_rng(3)
    begin, work = info["energy"], 0.0
    for _ in range(500):
        before = env.motion["x"]
        info = env.step(rng.uniform(-0.5, 1, 1).astype(np.float32))[4]
        # the force is constant over a step
        work += info["push"] * (env.motion["x"] - before)
    assert info["time"] == pytest.approx(10.0)
    assert abs(work) > 1.0
    assert info["energy"] - begin == pytest.approx(work, rel=1e-6, abs=1e-6)


def test_equal_seeds_give_equal_episodes() -> None:
    def run(seed: int) -> Any:
        env = made()
        first, _ = env.reset(seed=seed)
        return [first, *(env.step(np.array([0.3], dtype=np.float32))[0] for _ in range(20))]

    assert np.array_equal(run(4), run(4))
    assert not np.array_equal(run(4), run(5))


def test_it_is_drawn() -> None:
    env = made(render_mode="rgb_array")
    env.reset(options={"lean": 0.3})
    picture = env.render()
    assert picture.shape == (300, 600, 3) and picture.dtype == np.uint8
    # the pole leans to the left of the cart
    pole = np.argwhere((np.abs(picture.astype(int) - [0xCC, 0x88, 0x44]) < 12).all(axis=2))
    top, foot = pole[np.argmin(pole[:, 0])], pole[np.argmax(pole[:, 0])]
    assert top[1] < foot[1] - 5 and foot[0] - top[0] > 40


def test_what_is_asked_too_early_is_refused() -> None:
    env = cart_pole.CartPole(render_mode="rgb_array")
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(np.zeros(1, dtype=np.float32))
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.render()


def test_a_step_takes_less_than_two_milliseconds_of_the_processor() -> None:
    env = made()
    env.reset(seed=0)

    def step_time() -> float:
        begin = time.process_time()
        for _ in range(20):
            env.step(np.zeros(1, dtype=np.float32))
        return (time.process_time() - begin) / 20

    env.unwrapped.largest_lean = np.inf
    assert min(step_time() for _ in range(10)) < 2e-3
