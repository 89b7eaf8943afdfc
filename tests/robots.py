#!/usr/bin/env python3
"""Robots of others: real URDF files are imported and thrown for a second, and their equations are those of Pinocchio.

    robots.py --grashof PROGRAM --terms PROGRAM [NAME ...]

The files come with the package `example-robot-data`, the reference is `pin` (Pinocchio: Carpentier et al. 2019), both from
PyPI. `--terms` is the example `terms` of this repository. With names, only those robots are looked at.

1. Every robot of FALLS imports; included by a model that throws it, it falls for a second, its energy balanced to 1e-6.
2. Every robot of REFUSED is refused for the reason given there.
3. For every robot of COMPARED the mass matrix M, the bias forces b at random q and v, and the efforts M a + b agree with
   Pinocchio to 1e-10 of their largest entries. Pinocchio knows neither friction nor joints that follow others here, so
   `<dynamics>` and `<mimic>` are taken out for both.
"""

import argparse
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

STATES = 5
AGREEMENT = 1e-10
ENERGY = 1e-6

FALLS = [
    "panda", "ur3_robot", "ur5_robot", "ur10_robot", "kinova", "xarm7", "z1", "so100", "finger_edu", "solo",
    "double_pendulum", "quadruped", "TwoDofs", "allegro_right_hand",
]

REFUSED = {
    "alex_psyonic_hands": "unknown-joint",  # fingers mimic joints that are not in the file
    "tiago": "impossible-inertia",  # antennas with a negative principal moment
}

COMPARED = [
    "panda", "ur5_robot", "xarm7", "kinova", "z1", "so100", "allegro_right_hand", "baxter", "a1", "g1_29dof_rev_1_0", "talos_reduced", "icub",
]


def find(root, name):
    found = sorted(root.rglob(f"{name}.urdf"))
    if not found:
        sys.exit(f"robots: example-robot-data has no `{name}.urdf`")
    return found[0]


def run(*command, **more):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, **more)


def imported(program, urdf, model):
    """The outcome of `grashof import`; the model is written where it succeeds."""
    done = run(program, "import", urdf, "--quiet")
    if done.returncode == 0:
        model.write_text(done.stdout)
    return done


def names_of(model, section):
    """The keys of a section of an imported model."""
    found = re.search(rf"^{section}:\n(.*?)^\S", model.read_text() + "\nend", re.S | re.M)
    return re.findall(r"^  ([A-Za-z]\w*):(.*)", found.group(1), re.M) if found else []


def falls(program, urdf, scratch):
    """Why a robot does not fall as it should, or none."""
    model = scratch / f"{urdf.stem}.yaml"
    done = imported(program, urdf, model)
    if done.returncode != 0:
        return f"is not imported:\n{done.stderr}"
    followers = {name.removesuffix("_mimic") for name, _ in names_of(model, "couplings")}
    start = {}
    for name, joint in names_of(model, "joints"):
        if name not in followers and "revolute:" in joint:
            start[f"{name}.omega"] = 1.0
        elif name not in followers and "prismatic:" in joint:
            start[f"{name}.velocity"] = 0.1
    # the same robot by `include`, thrown
    text = {
        "grashof": 1, "name": urdf.stem, "space": "spatial", "gravity": [0, 0, -9.81], "include": {"urdf": str(urdf)},
        "start": start, "studies": {"fall": {"dynamics": {"until": 1}, "columns": ["time", "energy"]}},
    }  # fmt: skip
    model.write_text(json.dumps(text))
    done = run(program, "run", model, "--no-plots", "-o", scratch / urdf.stem, timeout=600)
    if done.returncode != 0:
        return f"does not fall:\n{done.stderr}"
    certificate = json.loads((scratch / urdf.stem / "fall.json").read_text())["certificate"]
    drift, scale = certificate["energy_drift"], certificate["energy_scale"]
    print(f"  {urdf.stem}: {certificate['integrator']}, {certificate['steps']} steps, energy to {drift:.1e} of {scale:.1e} J")
    return None if scale > 0 and drift <= ENERGY * scale else f"loses {drift} of {scale} J"


def plain(text):
    """A URDF without friction and without joints that follow others."""
    for tag in ["dynamics", "mimic"]:
        text = re.sub(rf"<{tag}\b[^>]*/>", "", text)
        text = re.sub(rf"<{tag}\b.*?</{tag}>", "", text, flags=re.S)
    return text


def difference(found, expected):
    """Largest difference over the largest entry."""
    size = max(abs(x) for x in expected)
    return max(abs(x - y) for x, y in zip(found, expected, strict=True)) / size


def compared(program, terms, urdf, scratch):
    """Why a robot's equations are not those of Pinocchio, or none."""
    import numpy
    import pinocchio

    text = plain(urdf.read_text())
    bare, model = scratch / f"{urdf.stem}-bare.urdf", scratch / f"{urdf.stem}-bare.yaml"
    bare.write_text(text)
    done = imported(program, bare, model)
    if done.returncode != 0:
        return f"is not imported:\n{done.stderr}"
    other = pinocchio.buildModelFromXML(text)
    data = other.createData()
    # the first is the world
    joints = [(name, joint) for name, joint in zip(list(other.names)[1:], list(other.joints)[1:]) if joint.nv == 1]
    if len(joints) != other.nv:
        return "has joints with more than one coordinate"
    # names as `import` makes them
    ours = {name: re.sub(r"[^A-Za-z0-9]", "_", name) for name, _ in joints}
    written = {name for name, _ in names_of(model, "joints")}
    ours = {name: own if own in written else f"{own}_joint" for name, own in ours.items()}
    chance = random.Random(urdf.stem)
    states = [{key: {ours[name]: chance.uniform(-2, 2) for name, _ in joints} for key in "qva"} for _ in range(STATES)]
    done = run(terms, model, input="".join(json.dumps(state) + "\n" for state in states))
    if done.returncode != 0:
        return f"has no terms:\n{done.stderr}"
    worst = {"mass": 0.0, "bias": 0.0, "effort": 0.0}
    for state, line in zip(states, done.stdout.splitlines(), strict=True):
        answer = json.loads(line)
        q, v, a = pinocchio.neutral(other), numpy.zeros(other.nv), numpy.zeros(other.nv)
        for name, joint in joints:
            angle = state["q"][ours[name]]
            # a joint without limits is a point of the circle there
            q[joint.idx_q : joint.idx_q + joint.nq] = [angle] if joint.nq == 1 else [numpy.cos(angle), numpy.sin(angle)]
            v[joint.idx_v], a[joint.idx_v] = state["v"][ours[name]], state["a"][ours[name]]
        mass = pinocchio.crba(other, data, q)
        mass = numpy.triu(mass) + numpy.triu(mass, 1).T
        column = {ours[name]: joint.idx_v for name, joint in joints}
        order = [column[name] for name in answer["joints"]]
        expected = {
            "mass": mass[numpy.ix_(order, order)].ravel(),
            "bias": pinocchio.nonLinearEffects(other, data, q, v)[order],
            "effort": pinocchio.rnea(other, data, q, v, a)[order],
        }
        found = {**answer, "mass": [x for row in answer["mass"] for x in row]}
        for key, value in expected.items():
            worst[key] = max(worst[key], difference(found[key], value))
    print(f"  {urdf.stem}: {other.nv} joints, M to {worst['mass']:.1e}, b to {worst['bias']:.1e}, M a + b to {worst['effort']:.1e}")
    bad = {key: value for key, value in worst.items() if not value <= AGREEMENT}
    return f"differs from Pinocchio: {bad}" if bad else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grashof", required=True, type=pathlib.Path)
    parser.add_argument("--terms", required=True, type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    given = parser.parse_args()
    import pinocchio

    root = pathlib.Path(pinocchio.__file__).resolve().parents[4] / "share" / "example-robot-data" / "robots"
    wanted = lambda name: not given.names or name in given.names
    wrong = []
    with tempfile.TemporaryDirectory() as directory:
        scratch = pathlib.Path(directory)
        print("fall for a second")
        wrong += [(name, why) for name in FALLS if wanted(name) and (why := falls(given.grashof, find(root, name), scratch))]
        for name, code in REFUSED.items():
            if wanted(name):
                done = imported(given.grashof, find(root, name), scratch / "refused.yaml")
                if done.returncode != 2 or f"error[{code}]" not in done.stderr:
                    wrong.append((name, f"is not refused with `{code}`:\n{done.stderr}"))
        print("against Pinocchio")
        wrong += [(name, why) for name in COMPARED if wanted(name) and (why := compared(given.grashof, given.terms, find(root, name), scratch))]
    for name, why in wrong:
        print(f"robots: {name} {why}", file=sys.stderr)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
