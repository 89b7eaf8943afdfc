"""What the tests share."""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODELS = ROOT / "models"
CRANK_ROCKER = MODELS / "crank_rocker.yaml"

PENDULUM = """
grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { length: 1 m, push: 0 N m }
bodies: { rod: { bar: { length: length, mass: 2 kg } } }
joints: { P: { revolute: [ground, rod.start] } }
loads: { torque: { joint: P, torque: push } }
start: { P.angle: -30 deg, P.omega: 0 }
studies:
  swing:
    dynamics: { until: 2 s, every: 10 ms }
    columns: [time, P.angle, P.omega, P.fy]
    scalars: { largest: max(abs(P.fy)) }
    plot: { forces: [P.fy, P.fx] }
"""


def program() -> str:
    """The program `grashof`, or the test is skipped."""
    built = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug" / "grashof"
    found = os.environ.get("GRASHOF") or (str(built) if built.exists() else shutil.which("grashof"))
    if found is None:
        pytest.skip("the program `grashof` is not built")
    return found


def run_program(*arguments: str) -> str:
    """What the program prints."""
    done = subprocess.run([program(), *arguments], check=True, capture_output=True, text=True)
    return done.stdout
