"""Drake (Tedrake and the Drake team 2019), from PyPI.

Open trees: the continuous plant under RungeKutta3, Radau3 and implicit Euler with error control. Loops: Drake has none in continuous
plants, so they are ball constraints of the discrete plant (SAP solver), with fixed steps.
"""

import time

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.plant import DiscreteContactApproximation, MultibodyPlant
from pydrake.multibody.tree import FixedOffsetFrame, LinearSpringDamper, PrismaticJoint, RevoluteJoint, SpatialInertia, UnitInertia
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig


def plant_of(problem, step):
    plant = MultibodyPlant(step)
    if step > 0:
        plant.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)
    plant.mutable_gravity_field().set_gravity_vector(problem.gravity)
    bodies, joints = [], []
    world = plant.world_body()

    def of(i):
        return bodies[i] if i >= 0 else world
    for i, b in enumerate(problem.bodies):
        com = np.array(b.com, dtype=float)
        about = np.diag(b.inertia) / b.mass + com @ com * np.eye(3) - np.outer(com, com)
        unit = UnitInertia(about[0, 0], about[1, 1], about[2, 2], about[0, 1], about[0, 2], about[1, 2])
        bodies.append(plant.AddRigidBody(f"b{i}", SpatialInertia(b.mass, com, unit)))
        kind = PrismaticJoint if b.kind == "slide" else RevoluteJoint
        parent = of(b.parent)
        frame = plant.AddFrame(fixed(parent, b.at, f"f{i}"))
        joints.append(plant.AddJoint(kind(f"j{i}", frame, bodies[i].body_frame(), np.array(b.axis, dtype=float), damping=b.damping)))
    for s in problem.springs:
        plant.AddForceElement(LinearSpringDamper(of(s.a), np.array(s.at_a, dtype=float), of(s.b), np.array(s.at_b, dtype=float), s.length, s.stiffness,
                                                 s.damping))
    for loop in problem.loops:
        places = [(loop.at_a, loop.at_b)]
        if not problem.plane:
            places.append(tuple(tuple(p + x for p, x in zip(at, loop.axis)) for at in places[0]))
        for a, b in places:
            plant.AddBallConstraint(of(loop.a), np.array(a, dtype=float), of(loop.b), np.array(b, dtype=float))
    plant.Finalize()
    return plant, bodies, joints


def fixed(body, at, name):
    return FixedOffsetFrame(name, body.body_frame(), RigidTransform(np.array(at, dtype=float)))


def started(problem, step):
    plant, bodies, joints = plant_of(problem, step)
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, [b.q for b in problem.bodies])
    plant.SetVelocities(context, [b.v for b in problem.bodies])
    plant.get_applied_generalized_force_input_port().FixValue(context, np.array([b.torque for b in problem.bodies]))
    return plant, bodies, context


def run(problem, setting):
    name, size = setting
    plant, bodies, context = started(problem, size if name == "discrete" else 0.0)
    simulator = Simulator(plant, context)
    if name != "discrete":
        ApplySimulatorConfig(SimulatorConfig(integration_scheme=name, accuracy=size, max_step_size=problem.end / 10, use_error_control=True), simulator)
    simulator.Initialize()
    begin = time.process_time()
    simulator.AdvanceTo(problem.end)
    spent = time.process_time() - begin
    context = simulator.get_context()
    q, v = plant.GetPositions(context), plant.GetVelocities(context)
    out = []
    for kind, body, *rest in problem.measures:
        if kind == "point":
            place, coordinate = rest
            at = plant.EvalBodyPoseInWorld(context, bodies[body]).multiply(np.array(place, dtype=float))
            out.append(float(at[coordinate]))
        else:
            out.append(float((q if kind == "q" else v)[body]))
    return spent, out


def families(problem):
    if problem.loops:
        return {"discrete, SAP": [("discrete", problem.end / n) for n in (1000, 4000, 16000, 64000)]}
    return {name: [(name, 10.0**-k) for k in range(3, 12)] for name in ("runge_kutta3", "radau3")}


def cost(problem, repeats=5):
    """Seconds of model building, of a discrete step and of an evaluation (of open trees)."""
    begin = time.process_time()
    plant, _, context = started(problem, 0.0 if not problem.loops else 1e-3)
    built = time.process_time() - begin
    if problem.loops:
        simulator = Simulator(plant, context)
        simulator.Initialize()
        begin = time.process_time()
        simulator.AdvanceTo(0.005)
        return built, (time.process_time() - begin) / 5, None
    best = []
    for _ in range(repeats):
        context.SetTime(context.get_time() + 1e-9)
        plant.SetPositions(context, plant.GetPositions(context))
        begin = time.process_time()
        plant.EvalTimeDerivatives(context)
        best.append(time.process_time() - begin)
    return built, None, min(best)
