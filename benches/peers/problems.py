"""The mechanisms of the comparison, described once for all codes: a tree of bodies on hinges and slides, loops, forces, a start.

Body frames are parallel to those of the ground where all coordinates are zero, and stand in the joint to the parent. SI units, rad.
References: IFToMM library of benchmark problems (A01 to A05), recomputed by extrapolation in 34 to 50 digit arithmetic on minimal
coordinates; A01 and A02 from their closed forms; the crank-rocker from its reduced equation in 80-bit arithmetic.
"""

import dataclasses
import math

G = 9.81


@dataclasses.dataclass
class Body:
    parent: int              # its number, -1 for the ground
    kind: str                # hinge or slide
    axis: tuple              # of the joint, in both frames
    at: tuple                # of the joint in the parent's frame
    mass: float
    com: tuple
    inertia: tuple           # Ixx, Iyy, Izz about the mass centre; products are zero
    q: float = 0.0
    v: float = 0.0
    damping: float = 0.0
    torque: float = 0.0


@dataclasses.dataclass
class Loop:
    a: int
    at_a: tuple
    b: int
    at_b: tuple
    axis: tuple = (0, 0, 1)  # of the hinge that closes the loop


@dataclasses.dataclass
class Spring:
    a: int
    at_a: tuple
    b: int
    at_b: tuple
    stiffness: float
    damping: float
    length: float


@dataclasses.dataclass
class Problem:
    name: str
    about: str
    plane: bool
    gravity: tuple
    end: float
    bodies: list
    loops: list
    springs: list
    measures: list           # ("q", body), ("v", body) or ("point", body, place, coordinate 0 to 2)
    reference: list          # of the measures at the end; empty where only the cost of a step is measured


Z = (0.0, 0.0, 1.0)


def flat(inertia):
    """Inertia of a body in the plane, of which only the last one counts."""
    return (0.01 * inertia, inertia, inertia)


def thin(mass, length):
    """Inertia of a thin rod along x; about itself it is not zero, as some codes want it, which no motion here sees."""
    return flat(mass * length**2 / 12)


def pendulum():
    # 1e-12: no code takes a body without inertia; that changes the motion by 1e-12
    rod = Body(-1, "hinge", Z, (0, 0, 0), 1.0, (1.0, 0, 0), (1e-12, 1e-12, 1e-12), q=-math.pi)
    x, y = -0.27508746257611690, -0.96141920509912500
    return Problem("pendulum", "IFToMM A01: 1 kg on 1 m, from level, 10 s", True, (0, -G, 0), 10.0, [rod], [], [],
                   [("point", 0, (1.0, 0, 0), 0), ("point", 0, (1.0, 0, 0), 1)], [x, y])


def crank_rocker():
    a = math.acos((1 + 0.85**2 - 0.55**2) / (2 * 0.85))
    b = math.pi - math.acos((0.55**2 + 0.85**2 - 1) / (2 * 0.55 * 0.85))
    com = (60 * 0.35 + 90 * 0.7) / 150
    inertia = 60 * 0.7**2 / 12 + 60 * (com - 0.35)**2 + 90 * (0.7 - com)**2
    bodies = [
        Body(-1, "hinge", Z, (0, 0, 0), 30.0, (0.075, 0, 0), thin(30, 0.15), damping=4.26, torque=200.0),
        Body(0, "hinge", Z, (0.15, 0, 0), 60.0, (0.5, 0, 0), thin(60, 1.0), q=a),
        Body(-1, "hinge", Z, (1.0, 0, 0), 150.0, (com, 0, 0), flat(inertia), q=b),
    ]
    loop = Loop(1, (1.0, 0, 0), 2, (0.55, 0, 0))
    return Problem("crank-rocker", "from rest, 200 N m on the crank, 4.26 N m s/rad, 5 s: 29 turns", True, (0, -G, 0), 5.0, bodies,
                   [loop], [], [("q", 0), ("v", 0)], [179.450848725376, 81.26636095048])


def andrews():
    beta, theta, gamma, phi = -0.062, 0.00021458685379951531889, 0.45527981210037022419, 0.22266837590302747339
    delta, omega, epsilon = 0.48736498114063279573, -0.22266837590302747339, 1.2305474391566007626

    bodies = [
        Body(-1, "hinge", Z, (0, 0, 0), 0.04325, (0.00092, 0, 0), flat(2.194e-6), q=beta, torque=0.033),
        Body(0, "hinge", Z, (0.007, 0, 0), 0.00365, (-0.0115, 0, 0), flat(4.410e-7), q=theta),
        Body(-1, "hinge", Z, (-0.03635, 0.03273, 0), 0.02373, (0.01043, -0.01874, 0), flat(5.255e-6), q=gamma),
        Body(-1, "hinge", Z, (-0.06934, -0.00227, 0), 0.07050, (0.02308, 0.00916, 0), flat(1.169e-5), q=delta),
        Body(3, "hinge", Z, (0.04, 0, 0), 0.00706, (0, 0.01421 - 0.02, 0), flat(5.667e-7), q=phi),
        Body(-1, "hinge", Z, (-0.06934, -0.00227, 0), 0.05498, (-0.00449, -0.01228, 0), flat(1.912e-5), q=epsilon),
        Body(5, "hinge", Z, (0, -0.04, 0), 0.00706, (-0.01421 + 0.02, 0, 0), flat(5.667e-7), q=omega),
    ]
    at_e = (0, -0.035, 0)
    loops = [Loop(1, (-0.028, 0, 0), 2, at_e), Loop(4, (0, -0.02, 0), 2, at_e), Loop(6, (0.02, 0, 0), 2, at_e)]
    spring = Spring(2, (0.02, -0.018, 0), -1, (0.014, 0.072, 0), 4530.0, 0.0, 0.07785)
    return Problem("Andrews", "IFToMM A03: 7 bodies, 3 loops, 0.05 s", True, (0, 0, 0), 0.05, bodies, loops, [spring],
                   [("q", 0), ("q", 2)], [33.815340721360173777, 0.11515852759155241838])


def four_bars(n, end=10.0, reference=()):
    bodies, loops, links = [], [], []
    for i in range(n + 1):
        links.append(len(bodies))
        bodies.append(Body(-1, "hinge", Z, (float(i), 0, 0), 1.0, (0.5, 0, 0), thin(1, 1), q=math.pi / 2, v=-1.0))
        if i > 0:
            bodies.append(Body(links[i - 1], "hinge", Z, (1.0, 0, 0), 1.0, (0.5, 0, 0), thin(1, 1), q=-math.pi / 2, v=1.0))
            loops.append(Loop(len(bodies) - 1, (1.0, 0, 0), links[i], (1.0, 0, 0)))
    tip = ("point", 0, (1.0, 0, 0))
    return Problem(f"{n} four-bar{'s' if n > 1 else ''}", f"IFToMM A02 with N = {n}, through flat positions, 10 s", True, (0, -G, 0), end,
                   bodies, loops, [], [(*tip, 0), (*tip, 1)], list(reference))


def falling_four_bars(n):
    """By the closed form phi = pi + 2 am(sqrt(1 + 4 w) t/2 - K(m) | m), w = (3 g/2)(3 N + 1)/(4 N + 1), m = 4 w/(1 + 4 w)."""
    import mpmath
    w = mpmath.mpf("1.5") * mpmath.mpf("9.81") * (3 * n + 1) / (4 * n + 1)
    m = 4 * w / (1 + 4 * w)
    u = mpmath.sqrt(1 + 4 * w) * 10 / 2 - mpmath.ellipk(m)
    # sin(am) = sn, cos(am) = cn; phi from upright: B0 = (sin phi, cos phi)
    sn, cn = mpmath.ellipfun("sn", u, m=m), mpmath.ellipfun("cn", u, m=m)
    return four_bars(n, reference=[float(-2 * sn * cn), float(-(cn**2 - sn**2))])


def bricard():
    long, thick = 1.01 / 12, 1 / 600

    def rod(parent, axis, at, way):
        inertia = tuple(thick if way[k] else long for k in range(3))
        return Body(parent, "hinge", axis, at, 1.0, tuple(0.5 * w for w in way), inertia)
    x, y, z = (1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0)
    bodies = [rod(-1, y, (0, 0, 0), (1, 0, 0)), rod(0, z, (1, 0, 0), (0, -1, 0)), rod(1, x, (0, -1, 0), (0, 0, 1)),
              rod(2, y, (0, 0, 1), (-1, 0, 0)), rod(3, z, (-1, 0, 0), (0, 1, 0))]
    loop = Loop(4, (0, 1.0, 0), -1, (0, 0, 1.0), axis=x)
    right = [0.99973098730383534651, -0.99999996382581727481, -0.00026897651224930459735]
    return Problem("Bricard", "IFToMM A04: a closed chain of six hinges with a redundant row, 10 s", False, (0, -G, 0), 10.0, bodies,
                   [loop], [], [("point", 1, (0, -1, 0), k) for k in range(3)], right)


def governor():
    rod, ball = 0.3, 5.0
    com = (rod * 0.5 + ball) / (rod + ball)
    cross = rod * 1.0001 / 12 + rod * (com - 0.5)**2 + ball * (1 - com)**2
    inertia = (rod * 2e-4 / 12, cross, cross)
    alpha, turn = math.radians(30), 2 * math.pi
    bodies = [
        Body(-1, "hinge", Z, (0, 0, 0), 0.3, (0, 0, 0.5), (0.3 * 1.0001 / 12, 0.3 * 1.0001 / 12, 0.3 * 2e-4 / 12), v=turn),
        Body(0, "slide", Z, (0, 0, 0), 3.0, (0, 0, 0), (0.005, 0.005, 0.005), q=0.5),
        Body(0, "hinge", (0, 1.0, 0), (0.05, 0, 1), rod + ball, (com, 0, 0), inertia, q=alpha),
        Body(0, "hinge", (0, -1.0, 0), (-0.05, 0, 1), rod + ball, (-com, 0, 0), inertia, q=alpha),
    ]
    springs = [Spring(2 + k, (0.5 * way, 0, 0), 1, (0.05 * way, 0, 0), 8e5, 4e4, 0.5) for k, way in enumerate((1, -1))]
    return Problem("governor", "IFToMM A05: stiff flyball governor, eigenvalues -8117 to +-7.3i 1/s, 10 s", False, (0, 0, -G), 10.0,
                   bodies, [], springs, [("q", 1), ("q", 2), ("v", 0)],
                   [0.61962291706136565882, 0.39007370184464508054, 5.5482036226549265825])


def chain(n):
    """Rods that fall from level."""
    bodies = [Body(i - 1, "hinge", Z, (0.1 if i else 0.0, 0, 0), 0.1, (0.05, 0, 0), thin(0.1, 0.1)) for i in range(n)]
    return Problem(f"chain of {n}", "thin rods of 0.1 m that fall from level", True, (0, -G, 0), 0.1, bodies, [], [], [("q", 0)], [])


def accuracy():
    """Problems with a reference."""
    return [pendulum(), crank_rocker(), andrews(), *(falling_four_bars(n) for n in (1, 10, 40)), bricard(), governor()]


def as_lines(problem):
    """The text that the drivers in C++ read: one part a line."""
    def numbers(*values):
        return " ".join(repr(float(x)) for x in values)
    lines = [f"plane {int(problem.plane)}", f"gravity {numbers(*problem.gravity)}", f"end {problem.end!r}"]
    for b in problem.bodies:
        lines.append(f"body {b.parent} {b.kind} {numbers(*b.axis, *b.at, b.mass, *b.com, *b.inertia, b.q, b.v, b.damping, b.torque)}")
    for c in problem.loops:
        lines.append(f"loop {c.a} {c.b} {numbers(*c.at_a, *c.at_b, *c.axis)}")
    for s in problem.springs:
        lines.append(f"spring {s.a} {s.b} {numbers(*s.at_a, *s.at_b, s.stiffness, s.damping, s.length)}")
    for kind, body, *rest in problem.measures:
        place, coordinate = rest if rest else ((0, 0, 0), 0)
        lines.append(f"measure {kind} {body} {coordinate} {numbers(*place)}")
    return "\n".join(lines) + "\n"
