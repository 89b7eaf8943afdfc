#!/usr/bin/env python3
"""Integrates hand-written equations of those mechanisms whose published result is loose, and writes refs/ID.hand.csv.

usage: hand_equations.py [ID...]
Needs nothing but Python. Each motion is integrated by extrapolation (Gragg, Bulirsch and Stoer: modified midpoint rule, Neville's
table in h^2, as in Hairer, Norsett, Wanner, Solving ODEs I, II.9) to no visible error, once at each of two step sizes; the
largest difference of the two is written into the first line. No code is shared with the program."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SEQUENCE = [2, 4, 6, 8, 10, 12, 14, 16]


def extrapolated(f, t, y, h):
    """The state after h: modified midpoint rule with 2, 4, .. substeps, extrapolated to none."""
    table = []
    for k, n in enumerate(SEQUENCE):
        s = h / n
        a, b = y, [u + s * d for u, d in zip(y, f(t, y))]
        for i in range(1, n):
            a, b = b, [u + 2 * s * d for u, d in zip(a, f(t + i * s, b))]
        row = [b]
        for j in range(1, k + 1):
            q = (n / SEQUENCE[k - j]) ** 2 - 1
            row.append([u + (u - v) / q for u, v in zip(row[j - 1], table[k - 1][j - 1])])
        table.append(row)
    return table[-1][-1]


def motion(f, y, times, parts):
    """States at the given times, each interval in `parts` steps."""
    states, t = [list(y)], times[0]
    for end in times[1:]:
        h = (end - t) / parts
        for i in range(parts):
            y = extrapolated(f, t + i * h, y, h)
        t = end
        states.append(list(y))
    return states


def double_pendulum():
    """Two boxes; a, b: angle of the first and of the second relative to the first. The second's origin is its tip."""
    g, length, width = 9.80665, 0.5, 0.06
    m = 7700 * length * width ** 2
    inertia, c = m * (length ** 2 + width ** 2) / 12, length / 2

    def f(t, y):
        a, b, u, v = y
        cb, sb, w = math.cos(b), math.sin(b), u + v
        # absolute angles a and a + b: M [u', w'] = right
        m11 = inertia + m * c * c + m * length ** 2
        m12 = m * length * c * cb
        m22 = inertia + m * c * c
        r1 = m * length * c * sb * w * w - g * m * (c + length) * math.cos(a) - 0.1 * u
        r2 = -m * length * c * sb * u * u - g * m * c * math.cos(a + b)
        det = m11 * m22 - m12 * m12
        du, dw = (r1 * m22 - r2 * m12) / det, (m11 * r2 - m12 * r1) / det
        return [u, v, du, dw - du]

    # the tip is at (0.7, 0.3): the law of cosines, elbow down
    x, z = 0.7, 0.3
    b = math.acos((x * x + z * z) / (2 * length ** 2) - 1)
    a = math.atan2(z, x) - b / 2
    return f, [a, b, 0.0, 0.0], [0.05 * k for k in range(101)], 16, lambda y: {
        'revolute1.phi': y[0], 'revolute2.phi': y[1], 'revolute1.w': y[2], 'revolute2.w': y[3]}


def orbits():
    """Four masses of 1 kg around a centre of mu = 1; a spring of 10 N/m and no length between the third and the fourth."""
    def pull(p):
        r = math.sqrt(sum(x * x for x in p)) ** 3
        return [-x / r for x in p]

    def f(t, y):
        places = [y[3 * i:3 * i + 3] for i in range(4)]
        a = [pull(p) for p in places]
        for k in range(3):
            s = 10 * (places[3][k] - places[2][k])
            a[2][k] += s
            a[3][k] -= s
        return y[12:] + [x for v in a for x in v]

    start = [0, .6, 0, .6, .6, 0, 0, .8, 0, .3, .8, 0] + [1, 0, 0, .6, 0, 0, .6, 0, 0, .6, 0, 0]

    def names(y):
        return {f'body{i + 1}.{w}_0[{k + 1}]': y[12 * j + 3 * i + k] for i in range(4) for j, w in enumerate('rv') for k in range(3)}
    return f, [float(x) for x in start], [0.02 * k for k in range(101)], 12, names


def star():
    """Six masses of 1 kg at 1 m on three axes, mu = 5: a body of 6 kg whose inertia is 4 kg m^2 about every axis."""
    tips = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]

    def matrix(q):
        w, x, y, z = q
        return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]

    def f(t, s):
        p, q, v, o = s[:3], s[3:7], s[7:10], s[10:]
        n = math.sqrt(sum(x * x for x in q))
        r = matrix([x / n for x in q])
        force, moment = [0.0] * 3, [0.0] * 3
        for tip in tips:
            arm = [sum(r[i][k] * tip[k] for k in range(3)) for i in range(3)]
            at = [arm[i] + p[i] for i in range(3)]
            d = sum(x * x for x in at) ** 1.5
            pull = [-5 * x / d for x in at]
            force = [a + b for a, b in zip(force, pull)]
            moment = [moment[i] + arm[(i + 1) % 3] * pull[(i + 2) % 3] - arm[(i + 2) % 3] * pull[(i + 1) % 3] for i in range(3)]
        # spin in the frame at rest; the inertia is that of a ball, so nothing gyroscopic
        w, x, y, z = q
        a, b, c = o
        dq = [-(a * x + b * y + c * z) / 2, (a * w + b * z - c * y) / 2, (b * w + c * x - a * z) / 2, (c * w + a * y - b * x) / 2]
        return v + dq + [k / 6 for k in force] + [k / 4 for k in moment]

    def names(s):
        n = math.sqrt(sum(x * x for x in s[3:7]))
        r = matrix([x / n for x in s[3:7]])
        own = [sum(r[i][k] * s[10 + i] for i in range(3)) for k in range(3)]
        p3 = [r[i][1] for i in range(3)]
        out = {}
        for k in range(3):
            out[f'freeMotion.r_rel_a[{k + 1}]'] = s[k]
            out[f'freeMotion.v_rel_a[{k + 1}]'] = s[7 + k]
            out[f'referenceSystem.pointMass1.w_a[{k + 1}]'] = own[k]
            out[f'referenceSystem.pointMass6.frame_a.r_0[{k + 1}]'] = s[k] - r[k][2]
        out['referenceSystem.pointMass3.v_0[1]'] = s[7] + s[11] * p3[2] - s[12] * p3[1]
        return out
    return f, [2., 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 0], [0.03 * k for k in range(101)], 4, names


def slider_crank():
    """Crank 0.1 m 0.2 kg, rod 0.3 m 0.2 kg, slider 0.4 kg, 0.1 N m on the crank: M(a) a'' + M'(a)/2 a'^2 = 0.1."""
    r, l, m = 0.1, 0.3, 0.2

    def f(t, y):
        a, w = y
        s, c = math.sin(a), math.cos(a)
        sb = -r * s / l                      # the rod's angle b: r sin a + l sin b = 0
        cb = math.sqrt(1 - sb * sb)
        b1 = -r * c / (l * cb)               # db/da and its slope
        b2 = (r * s + l * sb * b1 * b1) / (l * cb)
        x1, x2 = -r * s - l * sb * b1, -r * c - l * cb * b1 * b1 - l * sb * b2
        gx1, gx2 = -r * s - l / 2 * sb * b1, -r * c - l / 2 * (cb * b1 * b1 + sb * b2)
        gy1, gy2 = r * c + l / 2 * cb * b1, -r * s + l / 2 * (-sb * b1 * b1 + cb * b2)
        mass = m * r * r / 3 + m * (gx1 ** 2 + gy1 ** 2) + m * l * l / 12 * b1 * b1 + 0.4 * x1 ** 2
        half = m * (gx1 * gx2 + gy1 * gy2) + m * l * l / 12 * b1 * b2 + 0.4 * x1 * x2
        return [w, (0.1 - half * w * w) / mass]
    return f, [0.0, 0.0], [0.03 * k for k in range(101)], 64, lambda y: {'theta': y[0], 'theta_t': y[1]}


def universal_spherical_revolute():
    """A slider along x, a rod on a universal and a ball joint, a lever about x. With the lever's angle p everything is known:
    the ball's place, the slider's place by the rod's length, the rod's two angles by its direction."""
    g, own = 9.80665, (-1.0, 0.3, -0.1)
    c1 = (-0.4767312946227961, 0.14301938838683884, -0.04767312946227961)
    axis = (-0.09950371902099893, 0.0, 0.9950371902099893)
    side = (axis[2], 0.0, -axis[0])          # (axis, y) complete: y x axis

    def dot(a, b):
        return sum(x * y for x, y in zip(a, b))

    def cross(a, b):
        return [a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3)]

    def rod(direction):
        """The rod's turn: about y by u, then about the axis, which turns with it, by v: a matrix that takes `own` to direction."""
        # in the basis (side, y, axis) of the rod the second turn leaves the part along the axis alone
        o = [dot(own, side), own[1], dot(own, axis)]
        reach = math.hypot(o[0], o[1])
        # y is left alone by the first turn: direction.y is that of the turned vector
        lift = math.asin(direction[1] / reach)
        v = lift - math.atan2(o[1], o[0])
        v = min((v, math.pi - lift - math.atan2(o[1], o[0])), key=lambda x: abs(math.remainder(x, 2 * math.pi)))
        a = o[0] * math.cos(v) - o[1] * math.sin(v)     # along `side` before the first turn
        flat = [a * side[i] + o[2] * axis[i] for i in range(3)]
        u = math.atan2(direction[0], direction[2]) - math.atan2(flat[0], flat[2])

        def about_y(x):
            return [x[0] * math.cos(u) + x[2] * math.sin(u), x[1], -x[0] * math.sin(u) + x[2] * math.cos(u)]

        def turn(x):
            k = [dot(x, side), x[1], dot(x, axis)]
            p, q = k[0] * math.cos(v) - k[1] * math.sin(v), k[0] * math.sin(v) + k[1] * math.cos(v)
            return about_y([p * side[i] + (q if i == 1 else 0) + k[2] * axis[i] for i in range(3)])
        return turn, about_y(axis)

    def quantities(p):
        """Mass M(p), potential V(p), slider s(p) and its slope."""
        y, z = 0.5 * math.cos(p) - 0.1 * math.sin(p), 0.5 * math.sin(p) + 0.1 * math.cos(p)
        x = math.sqrt(1.1 - (y - 0.2) ** 2 - z * z)
        s1 = -((y - 0.2) * -z + z * y) / x
        ball = [-x, y - 0.2, z]                          # from the universal joint to the ball
        rate = [-s1, -z, y]
        turn, second = rod(ball)
        # the spin is u' y + v' second, and spin x ball = rate: two unknowns in least squares, which the third row confirms
        e1, e2 = cross([0, 1, 0], ball), cross(second, ball)
        a, b, c = dot(e1, e1), dot(e1, e2), dot(e2, e2)
        r1, r2 = dot(e1, rate), dot(e2, rate)
        det = a * c - b * b
        u1, v1 = (r1 * c - r2 * b) / det, (a * r2 - b * r1) / det
        spin = [v1 * second[0], u1 + v1 * second[1], v1 * second[2]]
        arm = turn(c1)
        velocity = [q + d for q, d in zip([s1, 0, 0], cross(spin, arm))]
        mass = 3.0237829290801765 * s1 * s1 + dot(velocity, velocity) + 0.1 * dot(spin, spin)
        cy, cz = 0.25 * math.cos(p) - 0.05 * math.sin(p), 0.25 * math.sin(p) + 0.05 * math.cos(p)
        mass += 2 * (cy * cy + cz * cz) + 0.33
        return mass, g * ((0.2 + arm[1]) + 2 * cy), x - 1, s1

    def f(t, y):
        p, w = y
        h = 0.004                                        # differences of sixth order
        mass = quantities(p)[0]
        slopes = [0.0, 0.0]
        for k, weight in ((1, 3 / 2), (2, -3 / 10), (3, 1 / 30)):
            plus, minus = quantities(p + k * h), quantities(p - k * h)
            slopes = [s + weight * (a - b) / (2 * h) for s, a, b in zip(slopes, plus, minus)]
        return [w, (-slopes[0] / 2 * w * w - slopes[1] - 0.1 * w) / mass]

    _, _, _, s1 = quantities(0.0)

    def names(y):
        _, _, s, s1 = quantities(y[0])
        return {'j2.s': s, 'j2.v': s1 * y[1]}
    return f, [0.0, -0.4 / s1], [0.02 * k for k in range(101)], 12, names


CASES = {'msl_DoublePendulumInitTip': double_pendulum, 'msl_PointGravityWithPointMasses': orbits,
         'msl_PointGravityWithPointMasses2': star, 'exu_slidercrank': slider_crank, 'mt_JointUSR': universal_spherical_revolute}


def main():
    for case in sys.argv[1:] or CASES:
        f, y, times, parts, names = CASES[case]()
        coarse = [names(s) for s in motion(f, y, times, parts)]
        fine = [names(s) for s in motion(f, y, times, parts + parts // 2)]
        off = max(abs(a[k] - b[k]) for a, b in zip(coarse, fine) for k in a)
        with open(f'{HERE}/refs/{case}.hand.csv', 'w') as out:
            out.write(f'# tests/external/hand_equations.py; two step sizes differ by {off:.1e}\n')
            out.write(','.join(['time', *fine[0]]) + '\n')
            for t, row in zip(times, fine):
                out.write(','.join(f'{x:.12g}' for x in [t, *row.values()]) + '\n')
        print(f'{case}: two step sizes differ by {off:.1e}')


main()
