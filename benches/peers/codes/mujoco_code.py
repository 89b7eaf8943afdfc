"""MuJoCo (Todorov, Erez and Tassa 2012), from PyPI: soft constraints, fixed steps.

Tried: from 1000 to 2 million steps with RK4 and the integrator implicit in velocity; loops by `connect` of sites on a tree of joints, with
the standard softness that its manual allows (time constant of two steps) and with stiffness 1/h^2 and damping 2/h given directly; and, in
the plane, free bodies that are all connected; hardest impedance, Newton's solver to 1e-14.
"""

import math
import time

import mujoco
import numpy as np


def spec_of(problem, step, integrator, kind, jacobian):
    spec = mujoco.MjSpec()
    spec.compiler.autolimits = False
    option = spec.option
    option.timestep, option.gravity = step, problem.gravity
    option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    option.jacobian = getattr(mujoco.mjtJacobian, f"mjJAC_{jacobian.upper()}")
    option.solver, option.tolerance, option.iterations = mujoco.mjtSolver.mjSOL_NEWTON, 1e-14, 100
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    bodies = []

    def of(i):
        return bodies[i] if i >= 0 else spec.worldbody
    slide, hinge = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
    solref = [-1 / step**2, -2 / step] if kind == "direct" else [2 * step, 1]
    ties = 0

    def connect(a, at_a, b, at_b):
        nonlocal ties
        of(a).add_site(name=f"a{ties}", pos=at_a)
        of(b).add_site(name=f"b{ties}", pos=at_b)
        spec.add_equality(type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE, name1=f"a{ties}", name2=f"b{ties}",
                          solref=solref, solimp=[0.9999, 0.9999, 0.001, 0.5, 2])
        ties += 1
    for i, b in enumerate(problem.bodies):
        inertia = {"mass": b.mass, "ipos": b.com, "inertia": b.inertia, "explicitinertial": True}
        body = spec.worldbody.add_body(**inertia) if kind == "free" else of(b.parent).add_body(pos=b.at, **inertia)
        bodies.append(body)
        if kind == "free":
            for axis in ([1, 0, 0], [0, 1, 0]):
                body.add_joint(type=slide, axis=axis)
        body.add_joint(type=slide if b.kind == "slide" else hinge, axis=b.axis, damping=b.damping)
        if kind == "free":
            connect(b.parent, b.at, i, (0, 0, 0))
    for loop in problem.loops:
        connect(loop.a, loop.at_a, loop.b, loop.at_b)
        if not problem.plane:
            connect(loop.a, [p + x for p, x in zip(loop.at_a, loop.axis)], loop.b, [p + x for p, x in zip(loop.at_b, loop.axis)])
    for k, s in enumerate(problem.springs):
        of(s.a).add_site(name=f"s{k}", pos=s.at_a)
        of(s.b).add_site(name=f"t{k}", pos=s.at_b)
        tendon = spec.add_tendon(name=f"w{k}", stiffness=s.stiffness, damping=s.damping, springlength=[s.length, s.length])
        tendon.wrap_site(f"s{k}")
        tendon.wrap_site(f"t{k}")
    return spec


def made(problem, step, integrator, kind, jacobian="auto"):
    model = spec_of(problem, step, integrator, kind, jacobian).compile()
    data = mujoco.MjData(model)
    if kind == "free":
        for i, ((at, angle), (speed, rate)) in enumerate(placed(problem)):
            data.qpos[3 * i:3 * i + 3] = [at.real, at.imag, angle]
            data.qvel[3 * i:3 * i + 3] = [speed.real, speed.imag, rate]
            data.qfrc_applied[3 * i + 2] = problem.bodies[i].torque
    else:
        data.qpos[:] = [b.q for b in problem.bodies]
        data.qvel[:] = [b.v for b in problem.bodies]
        data.qfrc_applied[:] = [b.torque for b in problem.bodies]
    return model, data


def placed(problem):
    """Of each body of the plane its origin as a complex number and its angle, and their rates."""
    out = []
    for b in problem.bodies:
        (at, angle), (speed, rate) = out[b.parent] if b.parent >= 0 else ((0j, 0.0), (0j, 0.0))
        arm = complex(*b.at[:2]) * complex(math.cos(angle), math.sin(angle))
        out.append(((at + arm, angle + b.q), (speed + 1j * rate * arm, rate + b.v)))
    return out


def measured(problem, model, data):
    mujoco.mj_forward(model, data)
    out = []
    for kind, body, *rest in problem.measures:
        if kind == "point":
            place, coordinate = rest
            at = data.xpos[body + 1] + data.xmat[body + 1].reshape(3, 3) @ np.array(place)
            out.append(float(at[coordinate]))
        else:
            values = data.qpos if kind == "q" else data.qvel
            # a free body of the plane has three coordinates; those that are measured are on the ground
            out.append(float(values[body] if model.nv == len(problem.bodies) else values[3 * body + 2]))
    return out


def run(problem, setting):
    steps, integrator, kind = setting
    model, data = made(problem, problem.end / steps, integrator, kind)
    begin = time.process_time()
    mujoco.mj_step(model, data, nstep=steps)
    spent = time.process_time() - begin
    return spent, measured(problem, model, data)


def families(problem):
    """Lists of settings from coarse to fine."""
    counts = [1000, 2000, 5000, 10000, 20000, 50000, 100000, 200000, 500000, 1000000, 2000000]
    kinds = {"RK4": ("RK4", "tree"), "implicit": ("implicit", "tree")}
    if problem.loops:
        kinds["RK4, direct stiffness"] = ("RK4", "direct")
    if problem.loops and problem.plane:
        kinds["RK4, free bodies"] = ("RK4", "free")
    return {name: [(n, *kind) for n in counts] for name, kind in kinds.items()}


def cost(problem, repeats=20):
    """Seconds of model building, of a step and of an evaluation."""
    begin = time.process_time()
    model, data = made(problem, 1e-3, "Euler", "tree", "sparse")
    mujoco.mj_forward(model, data)
    built = time.process_time() - begin
    best = []
    for act in (lambda: mujoco.mj_step(model, data), lambda: mujoco.mj_forward(model, data)):
        times = []
        for _ in range(repeats):
            begin = time.process_time()
            act()
            times.append(time.process_time() - begin)
        best.append(min(times))
    return built, best[0], best[1]
