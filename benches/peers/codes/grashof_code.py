"""Grashof: its model files, written from the problems; the steps alone are timed by `benches/duel.rs`."""

import json
import subprocess


def text(v):
    return "[" + ", ".join(repr(float(x)) for x in v) + "]"


def model(problem):
    """The model file of a problem."""
    size = 2 if problem.plane else 3
    points = [[] for _ in range(len(problem.bodies) + 1)]
    joints, start, springs, columns, efforts = [], [], [], [], []

    def point(body, name, at):
        points[body + 1].append(f"{name}: {text(at[:size])}")
        return f"{'ground' if body < 0 else f'b{body}'}.{name}"
    for i, b in enumerate(problem.bodies):
        kind = "slider" if b.kind == "slide" else "revolute"
        axis = "" if problem.plane else f", axis: {text(b.axis)}"
        damping = f", damping: {b.damping!r}" if b.damping else ""
        joints.append(f"  j{i}: {{ {kind}: [{point(b.parent, f'j{i}', b.at)}, b{i}.origin]{axis}{damping} }}")
        place, rate = ("position", "velocity") if b.kind == "slide" else ("angle", "omega")
        start.append(f"j{i}.{place}: {b.q!r}, j{i}.{rate}: {b.v!r}")
        if b.torque:
            efforts.append(f"t{i}: {{ joint: j{i}, torque: {b.torque!r} }}")
    for k, c in enumerate(problem.loops):
        axis = "" if problem.plane else f", axis: {text(c.axis)}"
        joints.append(f"  c{k}: {{ revolute: [{point(c.a, f'ca{k}', c.at_a)}, {point(c.b, f'cb{k}', c.at_b)}]{axis} }}")
    for k, s in enumerate(problem.springs):
        ends = f"[{point(s.a, f'sa{k}', s.at_a)}, {point(s.b, f'sb{k}', s.at_b)}]"
        springs.append(f"s{k}: {{ between: {ends}, stiffness: {s.stiffness!r}, damping: {s.damping!r}, length: {s.length!r} }}")
    for kind, body, *rest in problem.measures:
        if kind == "point":
            place, coordinate = rest
            columns.append(point(body, f"m{len(columns)}", place) + "." + "xyz"[coordinate])
        else:
            slides = problem.bodies[body].kind == "slide"
            columns.append(f"j{body}." + {"q": "position" if slides else "angle", "v": "velocity" if slides else "omega"}[kind])
    bodies = []
    for i, b in enumerate(problem.bodies):
        inertia = repr(b.inertia[2]) if problem.plane else text(b.inertia)
        bodies.append(f"  b{i}: {{ mass: {b.mass!r}, inertia: {inertia}, com: {text(b.com[:size])}, points: {{ {', '.join(points[i + 1])} }} }}")
    lines = [f"grashof: 1\nname: {problem.name}\nspace: {'planar' if problem.plane else 'spatial'}\ngravity: {text(problem.gravity[:size])}",
             f"ground: {{ {', '.join(points[0])} }}\nbodies:", *bodies, "joints:", *joints]
    if springs:
        lines.append(f"springs: {{ {', '.join(springs)} }}")
    if efforts:
        lines.append(f"loads: {{ {', '.join(efforts)} }}")
    lines.append(f"start: {{ {', '.join(start)} }}\nstudies:\n  motion:\n    dynamics: {{ until: {problem.end!r} s }}\n    columns: [{', '.join(columns)}]\n")
    return "\n".join(lines)


def families(problem):
    names = ("bdf", "radau5") if problem.name == "governor" else ("dop853",)
    return {name: [f"{name}:{10.0**(-k / 2):.3g}" for k in range(6, 28)] for name in names}
