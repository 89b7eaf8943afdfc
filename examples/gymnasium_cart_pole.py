"""A pole on a cart as an environment of Gymnasium, whose mechanics are those of a model file.

    python examples/gymnasium_cart_pole.py

lets a simple controller hold the pole for ten seconds, and says how many steps a second that makes. As an environment:

    import gymnasium
    import gymnasium_cart_pole               # registers it; this directory has to be on the path

    env = gymnasium.make("grashof/CartPole-v0", render_mode="rgb_array")

It needs the packages `grashof` and `gymnasium`, and Matplotlib for pictures.
"""

from __future__ import annotations

import pathlib
import time
from typing import TYPE_CHECKING, Any, Dict, Optional, SupportsFloat, Tuple

import gymnasium
import numpy as np

import grashof

if TYPE_CHECKING:
    from numpy.typing import NDArray

MODEL = pathlib.Path(__file__).resolve().parents[1] / "models" / "cart_pole.yaml"
#: What is observed, columns of the model: m, m/s, rad, rad/s.
OBSERVED = ("x", "X.velocity", "tilt", "P.omega")
#: The motion that is stepped. It is left to itself but for the force, which is the parameter `push`.
STUDY = {"dynamics": {"until": "10 s", "tolerance": 1e-7}, "columns": [*OBSERVED, "energy.total"]}


class CartPole(gymnasium.Env["NDArray[np.float32]", "NDArray[np.float32]"]):
    """A cart on a rail with a pole, held by a force on the cart that is set every fiftieth of a second.

    An action is the force as a part of `force`, from -1 to 1. An observation is place and velocity of the cart, and lean and rate of
    the pole, positive to the left: m, m/s, rad, rad/s. Each step in which the pole stays up is worth 1; an episode ends when the cart
    leaves the rail or the pole leans too far. It begins at rest with a small lean by chance; the option `lean`, rad, of `reset` sets it.
    """

    metadata: Dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 50}

    #: Largest force, N.
    force = 10.0
    #: Time from one action to the next, s.
    dt = 0.02
    #: Half the length of the rail, m.
    rail = 2.4
    #: Largest lean, rad.
    largest_lean = 0.35

    def __init__(self, render_mode: Optional[str] = None, model: Any = MODEL) -> None:
        self.render_mode = render_mode
        self.model, self.study = grashof.load(model).with_study("episode", STUDY)
        self.length = 2 * self.model.parameters["half"]
        # beyond what the force can do between the ends of the rail, and between the largest leans
        bound = np.array([2 * self.rail, 20.0, 2 * self.largest_lean, 20.0], dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-bound, bound)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)
        self.motion: Optional[grashof.Stepper] = None
        self._canvas: Optional[Canvas] = None

    def reset(self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None) -> Tuple[NDArray[np.float32], Dict[str, Any]]:
        """Begins an episode."""
        super().reset(seed=seed)
        lean = (options or {}).get("lean", self.np_random.uniform(-0.05, 0.05))
        self.motion = self.model.set(lean=float(lean)).stepper(self.study)
        return self._observed()

    def step(self, action: NDArray[np.float32]) -> Tuple[NDArray[np.float32], SupportsFloat, bool, bool, Dict[str, Any]]:
        """Goes on by a fiftieth of a second with one force."""
        if self.motion is None:
            raise gymnasium.error.ResetNeeded("call `reset` before `step`")
        push = self.force * float(np.clip(np.asarray(action).reshape(-1)[0], -1.0, 1.0))
        self.motion.set_input("push", push)
        self.motion.advance(self.dt)
        observation, info = self._observed()
        fallen = bool(abs(observation[0]) > self.rail or abs(observation[2]) > self.largest_lean)
        return observation, 0.0 if fallen else 1.0, fallen, False, {**info, "push": push}

    def _observed(self) -> Tuple[NDArray[np.float32], Dict[str, Any]]:
        assert self.motion is not None
        columns = self.motion.columns
        observation = np.array([columns[name] for name in OBSERVED], dtype=np.float32)
        return observation, {"time": self.motion.time, "energy": columns["energy.total"]}

    def render(self) -> Any:
        """The cart and the pole as a picture (height, width, 3)."""
        if self.render_mode is None:
            return None
        if self.motion is None:
            raise gymnasium.error.ResetNeeded("call `reset` before `render`")
        self._canvas = self._canvas or Canvas(self.rail, self.length)
        return self._canvas.draw(self.motion["x"], self.motion["tilt"])

    def close(self) -> None:
        """Gives up the motion and the picture."""
        self.motion = self._canvas = None


class Canvas:
    """A picture that is drawn by Matplotlib without a window."""

    #: Half the height of the cart, m.
    half_height = 0.08

    def __init__(self, rail: float, length: float) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from matplotlib.patches import Rectangle

        figure = Figure(figsize=(6.0, 3.0), dpi=100)
        self.agg: Any = FigureCanvasAgg(figure)
        axes: Any = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set(xlim=(-1.1 * rail, 1.1 * rail), ylim=(-0.4 * rail, 0.7 * rail), aspect="equal")
        axes.set_axis_off()
        axes.plot([-rail, rail], [-self.half_height] * 2, color="#787878", linewidth=2)
        self.cart = axes.add_patch(Rectangle((0.0, 0.0), 0.4, 2 * self.half_height, facecolor="#4477aa", edgecolor="#222222", zorder=3))
        (self.pole,) = axes.plot([0.0, 0.0], [0.0, length], color="#cc8844", linewidth=6, solid_capstyle="round", zorder=4)
        self.length = length

    def draw(self, x: float, lean: float) -> NDArray[np.uint8]:
        """The picture for a place of the cart, m, and a lean, rad."""
        self.cart.set_xy((x - 0.2, -self.half_height))
        self.pole.set_data([x, x - self.length * np.sin(lean)], [0.0, self.length * np.cos(lean)])
        self.agg.draw()
        return np.array(self.agg.buffer_rgba(), dtype=np.uint8)[:, :, :3].copy()


def made(**keys: Any) -> CartPole:
    """The environment, as `gymnasium.make` asks for it."""
    return CartPole(**keys)


gymnasium.register(id="grashof/CartPole-v0", entry_point=made, max_episode_steps=500)


def hold(observation: NDArray[np.float32]) -> NDArray[np.float32]:
    """A controller: a force by place, velocity, lean and rate, as a part of the largest one."""
    gains = np.array([-3.0, -4.5, 40.0, 7.5])
    force = -gains @ observation.astype(np.float64)
    return np.clip([force / CartPole.force], -1.0, 1.0).astype(np.float32)


def episode(env: gymnasium.Env[Any, Any], seed: int = 0) -> int:
    """How many steps the controller holds the pole."""
    observation, _ = env.reset(seed=seed)
    for count in range(1, 10_000):
        observation, _, terminated, truncated, _ = env.step(hold(observation))
        if terminated or truncated:
            return count
    raise RuntimeError("the episode has no end")


if __name__ == "__main__":
    begin = time.perf_counter()
    steps = episode(gymnasium.make("grashof/CartPole-v0"))
    print(f"{steps} steps, {steps / (time.perf_counter() - begin):.0f} a second")
