#!/usr/bin/env python3
"""Random trees of bodies move as in MuJoCo (Todorov, Erez and Tassa 2012), which is taken from PyPI.

    with_mujoco.py --grashof PROGRAM [--cases N] [--seed N]

Every body lies on the ground's frame as drawn, on a hinge, a slide or a ball joint, with viscous damping half of the time. The
centres of mass of all bodies agree to 1e-8 m at four instants. MuJoCo's scheme of Runge and Kutta has a fixed step, whose error
at 0.1 ms is far below that.
"""

import argparse
import csv
import pathlib
import random
import subprocess
import sys
import tempfile

import mujoco

AGREEMENT = 1e-8
STEP, INSTANTS = 1e-4, [0.1, 0.2, 0.3, 0.4]
KINDS = {"hinge": "revolute", "slide": "slider", "ball": "spherical"}


def chance(dice):
    """Bodies, each by its parent and its joint, and the gravity."""
    def vector(size=1.0):
        return [round(dice.uniform(-size, size), 3) for _ in range(3)]
    bodies = []
    for i in range(dice.randint(2, 6)):
        kind = dice.choice(["hinge", "hinge", "slide", "ball"])
        place = vector()
        bodies.append({
            "parent": i if dice.random() < 0.7 else dice.randint(0, i), "kind": kind, "place": place,
            "axis": [x + 1.2 for x in vector()], "com": [p + o + 0.3 for p, o in zip(place, vector(0.5))],
            "mass": round(dice.uniform(0.5, 3), 3), "inertia": [round(dice.uniform(0.3, 0.5), 3) for _ in range(3)],
            "rate": 0.0 if kind == "ball" else round(dice.uniform(-1, 1), 3),
            "damping": round(dice.uniform(0.1, 1), 3) if kind != "ball" and dice.random() < 0.5 else 0.0,
        })
    return bodies, [*vector(2)[:2], -9.0]


def mjcf(bodies, gravity):
    def text(v):
        return " ".join(repr(x) for x in v)

    def body(i):
        b = bodies[i]
        axis = "" if b["kind"] == "ball" else f' axis="{text(b["axis"])}" damping="{b["damping"]!r}"'
        inside = "".join(body(k) for k, c in enumerate(bodies) if c["parent"] == i + 1)
        return (f'<body name="b{i + 1}"><joint name="j{i + 1}" type="{b["kind"]}" pos="{text(b["place"])}"{axis}/>'
                f'<inertial pos="{text(b["com"])}" mass="{b["mass"]!r}" diaginertia="{text(b["inertia"])}"/>{inside}</body>')
    roots = "".join(body(k) for k, c in enumerate(bodies) if c["parent"] == 0)
    return (f'<mujoco><option timestep="{STEP!r}" gravity="{text(gravity)}" integrator="RK4"><flag contact="disable"/></option>'
            f'<worldbody>{roots}</worldbody></mujoco>')


def yaml(bodies, gravity):
    points = [[] for _ in range(len(bodies) + 1)]
    joints, start, shown = [], [], []
    for i, b in enumerate(bodies, 1):
        for body in (b["parent"], i):
            points[body].append(f"j{i}: {b['place']}")
        ends = f"[{'ground' if b['parent'] == 0 else 'b' + str(b['parent'])}.j{i}, b{i}.j{i}]"
        more = "" if b["kind"] == "ball" else f", axis: {b['axis']}" + (f", damping: {b['damping']!r}" if b["damping"] else "")
        joints.append(f"  j{i}: {{ {KINDS[b['kind']]}: {ends}{more} }}")
        if b["kind"] != "ball":
            place, rate = ("angle", "omega") if b["kind"] == "hinge" else ("position", "velocity")
            start.append(f"j{i}.{place}: 0, j{i}.{rate}: {b['rate']!r}")
        shown.append(f"b{i}.com")
    listed = "\n".join(
        f"  b{i}: {{ mass: {b['mass']!r}, inertia: {b['inertia']}, com: {b['com']}, points: {{ {', '.join(points[i])} }} }}"
        for i, b in enumerate(bodies, 1))
    return (f"grashof: 1\nname: chance\nspace: spatial\ngravity: {gravity}\nground: {{ {', '.join(points[0])} }}\nbodies:\n{listed}\njoints:\n"
            + "\n".join(joints) + f"\nstart: {{ {', '.join(start)} }}\nstudies:\n  move:\n"
            f"    dynamics: {{ until: {INSTANTS[-1]} s, every: {INSTANTS[0]} s, tolerance: 1e-11 }}\n    columns: [time, {', '.join(shown)}]\n")


def moved(bodies, gravity):
    """Centres of mass at the instants, by MuJoCo."""
    model = mujoco.MjModel.from_xml_string(mjcf(bodies, gravity))
    data = mujoco.MjData(model)
    for i, b in enumerate(bodies, 1):
        if b["kind"] != "ball":
            data.qvel[model.joint(f"j{i}").dofadr[0]] = b["rate"]
    rows = []
    for instant in INSTANTS:
        while data.time < instant - STEP / 2:
            mujoco.mj_step(model, data)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        rows.append([x for i in range(len(bodies)) for x in data.body(f"b{i + 1}").xipos])
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--grashof", required=True)
    parser.add_argument("--cases", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    dice, worst, findings = random.Random(given.seed), 0.0, 0
    with tempfile.TemporaryDirectory() as directory:
        model = pathlib.Path(directory, "chance.yaml")
        for case in range(given.cases):
            bodies, gravity = chance(dice)
            model.write_text(yaml(bodies, gravity))
            done = subprocess.run([given.grashof, "run", str(model), "--no-plots", "-o", directory], capture_output=True, text=True)
            if done.returncode:
                sys.exit(f"mujoco: case {case} of seed {given.seed} does not run\n{done.stderr}\n{model.read_text()}")
            with open(pathlib.Path(directory, "move.csv")) as file:
                rows = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
            for instant, right in zip(INSTANTS, moved(bodies, gravity)):
                found = next(row[1:] for row in rows if abs(row[0] - instant) < 1e-9)
                off = max(abs(a - b) for a, b in zip(found, right, strict=True))
                worst = max(worst, off)
                if off > AGREEMENT:
                    findings += 1
                    print(f"mujoco: case {case} of seed {given.seed}: off by {off:.1e} m at {instant} s\n{model.read_text()}")
                    break
    print(f"mujoco: {given.cases} trees, largest difference {worst:.1e} m, {findings} findings (MuJoCo {mujoco.__version__})")
    sys.exit(findings > 0)


main()
