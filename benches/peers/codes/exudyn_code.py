"""Exudyn (Gerstmayr 2023), from PyPI: redundant coordinates, fixed steps.

Tried: generalized alpha with spectral radii 1 (with index 2 constraints; Newmark's trapezoidal rule) and 0.9, each from 1000 steps on;
bodies of the plane as such with revolute joints of the plane, else rigid bodies with Euler parameters and general joints, without output.
"""

import math
import time

import exudyn as exu
import numpy as np
from exudyn.utilities import (GenericJoint, MarkerBodyPosition, MarkerBodyRigid, MarkerNodeCoordinate, ObjectConnectorSpringDamper,
                              ObjectGround, ObjectJointRevolute2D, ObjectRigidBody2D, RigidBodyInertia)


def rotation(axis, angle):
    x = np.array(axis, dtype=float)
    cross = np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def placed(problem):
    """Of each body at the start the origin, the axes, the velocity of the origin and the angular velocity."""
    out = []
    for b in problem.bodies:
        p, r, u, w = out[b.parent] if b.parent >= 0 else (np.zeros(3), np.eye(3), np.zeros(3), np.zeros(3))
        at = p + r @ np.array(b.at)
        rate = u + np.cross(w, r @ np.array(b.at))
        axis = r @ np.array(b.axis, dtype=float)
        if b.kind == "slide":
            out.append((at + b.q * axis, r, rate + b.v * axis + np.cross(w, b.q * axis), w))
        else:
            out.append((at, r @ rotation(b.axis, b.q), rate, w + b.v * axis))
    return out


class Machine:
    def __init__(self, problem):
        self.problem = problem
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        self.ground = self.system.AddObject(ObjectGround())
        self.bodies = []
        for (p, r, u, w), b in zip(placed(problem), problem.bodies):
            com = r @ np.array(b.com)
            if problem.plane:
                # the body's frame stands in its mass centre
                angle = math.atan2(r[1, 0], r[0, 0])
                speed = u + np.cross(w, com)
                node = self.system.AddNode({"nodeType": "RigidBody2D", "referenceCoordinates": [*(p + com)[:2], angle],
                                            "initialVelocities": [*speed[:2], w[2]]})
                number = self.system.AddObject(ObjectRigidBody2D(nodeNumber=node, physicsMass=b.mass, physicsInertia=b.inertia[2]))
                weight = MarkerBodyPosition(bodyNumber=number, localPosition=[0, 0, 0])
                self.system.AddLoad(weight_of(self.system.AddMarker(weight), b.mass * np.array(problem.gravity)))
            else:
                central = np.diag(b.inertia)
                c = np.array(b.com)
                about = central + b.mass * (c @ c * np.eye(3) - np.outer(c, c))
                inertia = RigidBodyInertia(mass=b.mass, inertiaTensor=about, com=c)
                made = self.system.CreateRigidBody(inertia=inertia, referencePosition=list(p), referenceRotationMatrix=r,
                                                   initialVelocity=list(u), initialAngularVelocity=list(w), gravity=list(problem.gravity))
                number = made if isinstance(made, int) or not hasattr(made, "__getitem__") else made["bodyNumber"]
            self.bodies.append(number)
        for i, b in enumerate(problem.bodies):
            self.join(b.parent, i, b.at, (0, 0, 0), b.axis, b.kind)
            if b.torque or b.damping:
                self.drive(i, b)
        for loop in problem.loops:
            self.join(loop.a, loop.b, loop.at_a, loop.at_b, loop.axis, "hinge")
        for s in problem.springs:
            markers = [self.position(s.a, s.at_a), self.position(s.b, s.at_b)]
            self.system.AddObject(ObjectConnectorSpringDamper(markerNumbers=markers, referenceLength=s.length, stiffness=s.stiffness,
                                                              damping=s.damping))
        self.sensors = []
        self.system.Assemble()

    def local(self, body, at):
        at = np.array(at, dtype=float)
        return list(at - np.array(self.problem.bodies[body].com)) if body >= 0 and self.problem.plane else list(at)

    def position(self, body, at):
        number = self.ground if body < 0 else self.bodies[body]
        return self.system.AddMarker(MarkerBodyPosition(bodyNumber=number, localPosition=self.local(body, at)))

    def rigid(self, body, at):
        number = self.ground if body < 0 else self.bodies[body]
        return self.system.AddMarker(MarkerBodyRigid(bodyNumber=number, localPosition=self.local(body, at)))

    def join(self, a, b, at_a, at_b, axis, kind):
        if self.problem.plane:
            self.system.AddObject(ObjectJointRevolute2D(markerNumbers=[self.position(a, at_a), self.position(b, at_b)]))
            return
        # the joint's z is the axis
        z = np.array(axis, dtype=float)
        x = np.cross(z, [0.36, 0.48, 0.8])
        x /= np.linalg.norm(x)
        frame = np.array([x, np.cross(z, x), z]).T
        # the bodies' frames are parallel where all coordinates are zero, and so are the joint's
        free = [1, 1, 0, 1, 1, 1] if kind == "slide" else [1, 1, 1, 1, 1, 0]
        self.system.AddObject(GenericJoint(markerNumbers=[self.rigid(a, at_a), self.rigid(b, at_b)], constrainedAxes=free,
                                           rotationMarker0=frame, rotationMarker1=frame))

    def drive(self, i, body):
        if not self.problem.plane or body.parent >= 0:
            raise NotImplementedError("torques and dampers only between the ground and a body of the plane")
        node = self.system.GetObject(self.bodies[i])["nodeNumber"]
        marker = self.system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
        self.system.AddLoad({"loadType": "Coordinate", "markerNumber": marker, "load": body.torque})
        fixed = self.system.AddNode({"nodeType": "PointGround"})
        zero = self.system.AddMarker(MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0))
        self.system.AddObject({"objectType": "ConnectorCoordinateSpringDamper", "markerNumbers": [zero, marker], "damping": body.damping})

    def measured(self):
        out = []
        for kind, body, *rest in self.problem.measures:
            number = self.bodies[body]
            if kind == "point":
                place, coordinate = rest
                at = self.system.GetObjectOutputBody(number, exu.OutputVariableType.Position, self.local(body, place))
                out.append(float(at[coordinate]))
            elif self.problem.plane:
                what = exu.OutputVariableType.Coordinates if kind == "q" else exu.OutputVariableType.Coordinates_t
                node = self.system.GetObject(number)["nodeNumber"]
                value = self.system.GetNodeOutput(node, what)[2]
                if kind == "q":
                    # coordinates count from the reference
                    value += self.system.GetNode(node)["referenceCoordinates"][2]
                out.append(float(value))
            else:
                out.append(self.relative(kind, body))
        return out

    def relative(self, kind, i):
        """The coordinate of a joint of the governor, or its rate."""
        def axes(k):
            if k < 0:
                return np.eye(3)
            return np.array(self.system.GetObjectOutputBody(self.bodies[k], exu.OutputVariableType.RotationMatrix, [0, 0, 0])).reshape(3, 3)

        def at(k, place=(0, 0, 0)):
            return np.array(self.system.GetObjectOutputBody(self.bodies[k], exu.OutputVariableType.Position, list(place)))
        body = self.problem.bodies[i]
        axis = np.array(body.axis, dtype=float)
        if body.kind == "slide":
            return float(axis @ axes(body.parent).T @ (at(i) - at(body.parent, body.at)))
        if kind == "v":
            w = np.array(self.system.GetObjectOutputBody(self.bodies[i], exu.OutputVariableType.AngularVelocity, [0, 0, 0]))
            return float(axis @ w)
        r = axes(body.parent).T @ axes(i)
        turn = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
        return math.atan2(float(axis @ turn), float(np.trace(r)) - 1)


def weight_of(marker, force):
    return {"loadType": "ForceVector", "markerNumber": marker, "loadVector": list(force)}


def settings_of(problem, steps, radius):
    settings = exu.SimulationSettings()
    by = settings.timeIntegration
    by.endTime, by.numberOfSteps = problem.end, steps
    by.generalizedAlpha.useNewmark = radius == 1
    by.generalizedAlpha.useIndex2Constraints = radius == 1
    by.generalizedAlpha.spectralRadius = radius
    by.newton.useModifiedNewton = True
    by.newton.relativeTolerance = 1e-10
    by.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = problem.end
    settings.linearSolverType = exu.LinearSolverType.EigenSparse if len(problem.bodies) > 20 else exu.LinearSolverType.EXUdense
    # of a redundant row the one that moves nothing is ignored
    settings.linearSolverSettings.ignoreSingularJacobian = problem.name == "Bricard"
    return settings


def run(problem, setting):
    steps, radius = setting
    machine = Machine(problem)
    settings = settings_of(problem, steps, radius)
    begin = time.process_time()
    machine.system.SolveDynamic(settings, showHints=False)
    return time.process_time() - begin, machine.measured()


def families(problem):
    counts = [1000 * 2**k for k in range(0, 12)]
    return {"trapezoidal rule, index 2": [(n, 1) for n in counts], "generalized alpha, radius 0.9": [(n, 0.9) for n in counts]}


def cost(problem, repeats=1):
    """Seconds of model building, of a step; an evaluation is not to be had."""
    begin = time.process_time()
    machine = Machine(problem)
    built = time.process_time() - begin
    short = type(problem)(**{**problem.__dict__, "end": 0.02})
    begin = time.process_time()
    machine.system.SolveDynamic(settings_of(short, 20, 0.9), showHints=False)
    return built, (time.process_time() - begin) / 20, None
