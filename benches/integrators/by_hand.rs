//! The crank-rocker turned by a torque, written by hand as a system of one coordinate: (I(θ) + J) θ'' = M − γ θ' − ½ I' θ'² − V' + Q.
//!
//! Kinematics, inertia and loads are those of `closed_form::crank_rocker` per unit speed of the crank, without what an
//! integration does not need; `agrees` holds them against each other.

use crate::closed_form::crank_rocker::{CrankRocker, Load, Parameters};
use crate::closed_form::plane::{Vector, add, cross, dot, normal, scale, sub};
use grashof_solvers::{At, Dims, Effect, Pattern, Span, Stage, State, System, Tangent, Terms};

/// What turns the crank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Drive {
    /// A constant torque, N m; no tip load.
    Constant(f64),
    /// The motor of class KL 13 behind its gear, against the tip load.
    Geared,
}

/// Ratio of the gear, and inertia of the rotor at the motor, kg m².
const GEAR: f64 = 73.0 / 12.0;
const J_MOTOR: f64 = 0.37;
/// Points of the motor's curve: rpm and N m.
const CURVE: [[f64; 2]; 7] =
    [[0.0, 215.6], [214.0, 161.7], [1275.0, 284.2], [1460.0, 98.0], [1500.0, 0.0], [1540.0, -98.0], [1725.0, -284.2]];
/// Of the modes: the segment of the curve; whether the rocker is behind the load's angle; whether it moves back.
const SEGMENT: usize = 0;
const BEHIND: usize = 1;
const BACK: usize = 2;

/// Motion per unit speed of the crank, and what follows from it.
#[derive(Clone, Copy, Debug)]
struct Reduced {
    /// I, kg m²; ½ I'.
    inertia: f64,
    half_slope: f64,
    /// Derivative of the potential energy, N m.
    weight: f64,
    /// Rate of the rocker, counter-clockwise.
    rocker: f64,
    u3: Vector,
}

/// The system.
pub(crate) struct ByHand {
    p: Parameters,
    drive: Drive,
    viscous: f64,
    rotor: f64,
    radius: f64,
    /// Of the coupler about its middle, of the rocker about C, kg m²; first moment of the rocker, kg m.
    i2: f64,
    i3: f64,
    s3: f64,
    difference: f64,
    load_slope: f64,
    /// Speeds of the crank at the points of the curve, rad/s, and torques on it, N m.
    curve: Vec<[f64; 2]>,
    dims: Dims,
    pattern: Pattern,
    terms: Terms,
}

impl ByHand {
    pub(crate) fn new(drive: Drive) -> Self {
        let p = Parameters::default();
        let radius = p.l3 + p.l_tip;
        let switched = drive == Drive::Geared;
        let dims = Dims { q: 1, v: 1, modes: if switched { 3 } else { 0 }, roots: if switched { 4 } else { 0 }, ..Dims::default() };
        let rpm = std::f64::consts::TAU / 60.0;
        Self {
            p,
            drive,
            viscous: 4.26,
            rotor: if switched { GEAR * GEAR * J_MOTOR } else { 0.0 },
            radius,
            i2: p.m2 * p.l2 * p.l2 / 12.0,
            i3: (p.m3 / 3.0 + p.m_tip) * radius * radius,
            s3: (0.5 * p.m3 + p.m_tip) * radius,
            difference: p.l2 * p.l2 - p.l3 * p.l3,
            load_slope: p.load_max / (CrankRocker::new(p).phi3_min - p.load_angle),
            curve: CURVE.iter().map(|[n, m]| [n * rpm / GEAR, m * GEAR]).collect(),
            dims,
            pattern: Pattern::dense(dims),
            terms: Terms::new(dims, &Pattern::dense(dims)),
        }
    }

    pub(crate) fn start(&self) -> State {
        State::new(self.dims)
    }

    #[inline]
    fn reduced(&self, theta: f64) -> Reduced {
        let p = &self.p;
        let (sin, cos) = theta.sin_cos();
        let u1 = [cos, sin];
        // B lies x A-C + y n(A-C) from A
        let ac = [p.l - p.l1 * cos, -p.l1 * sin];
        let inverse = 1.0 / dot(ac, ac);
        let x = 0.5 + 0.5 * self.difference * inverse;
        let y = (p.l2 * p.l2 * inverse - x * x).sqrt();
        let ab = [x * ac[0] - y * ac[1], x * ac[1] + y * ac[0]];
        let (u2, u3) = (scale(ab, 1.0 / p.l2), scale(sub(ab, ac), 1.0 / p.l3));
        let inverse = 1.0 / cross(u2, u3);
        let (d13, d12, d23) = (dot(u1, u3), dot(u1, u2), dot(u2, u3));
        let w2 = -p.l1 * cross(u1, u3) * inverse / p.l2;
        let w3 = -p.l1 * cross(u1, u2) * inverse / p.l3;
        let (a2, a3) = (p.l2 * w2 * w2, p.l3 * w3 * w3);
        let alpha2 = (p.l1 * d13 + a2 * d23 - a3) * inverse / p.l2;
        let alpha3 = (p.l1 * d12 + a2 - a3 * d23) * inverse / p.l3;
        let (n1, n2) = (normal(u1), normal(u2));
        let half = 0.5 * p.l2;
        let v = add(scale(n1, p.l1), scale(n2, half * w2));
        let a = add(scale(u1, -p.l1), sub(scale(n2, half * alpha2), scale(u2, half * w2 * w2)));
        let inertia = p.m1 * p.l1 * p.l1 / 3.0 + p.m2 * dot(v, v) + self.i2 * w2 * w2 + self.i3 * w3 * w3;
        let half_slope = p.m2 * dot(v, a) + self.i2 * w2 * alpha2 + self.i3 * w3 * alpha3;
        let weight = p.g_earth * (0.5 * p.m1 * p.l1 * cos + p.m2 * v[1] + self.s3 * w3 * u3[0]);
        Reduced { inertia: inertia + self.rotor, half_slope, weight, rocker: w3, u3 }
    }

    /// Clockwise from the vertical.
    fn phi3(&self, r: &Reduced) -> f64 {
        r.u3[0].atan2(r.u3[1])
    }

    /// Torque of the drive on the crank at ω, on a segment of its curve: 0 before the first point, 7 behind the last.
    fn torque(&self, omega: f64, modes: &[i32]) -> f64 {
        if let Drive::Constant(torque) = self.drive {
            return torque;
        }
        let k = modes[SEGMENT].clamp(0, self.curve.len() as i32) as usize;
        match (k.checked_sub(1).map(|i| self.curve[i]), self.curve.get(k)) {
            (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (omega - x0) / (x1 - x0),
            (Some([_, y]), None) => y,
            (None, Some([_, y])) => *y,
            (None, None) => 0.0,
        }
    }

    /// Largest difference to the closed forms over a turn, of inertia, its slope and the weight's moment, relative.
    pub(crate) fn off_closed_form(&self) -> f64 {
        let hand = CrankRocker::new(Parameters { speed: 1.0, ..self.p });
        let one = |k: i32| {
            let theta = 0.1 * f64::from(k);
            let (r, m) = (self.reduced(theta), hand.motion(theta));
            let [inertia, slope] = hand.inertia(&m);
            let weight = hand.mass() * self.p.g_earth * hand.centre(&m)[1][1];
            let q = self.load(&r, &[0, 1, 1]) + hand.tip_force(&m, Load::On) * self.radius * -m.omega3;
            [r.inertia - self.rotor - inertia, 2.0 * r.half_slope - slope, r.weight - weight, 1e-3 * q]
                .map(f64::abs)
                .into_iter()
                .fold(0.0, f64::max)
        };
        (0..63).map(one).fold(0.0, f64::max)
    }

    /// Moment of the tip load on the crank.
    fn load(&self, r: &Reduced, modes: &[i32]) -> f64 {
        if modes[BEHIND] == 1 && modes[BACK] == 1 {
            -self.load_slope * (self.phi3(r) - self.p.load_angle) * self.radius * r.rocker
        } else {
            0.0
        }
    }
}

impl System for ByHand {
    fn dims(&self) -> Dims {
        self.dims
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        let r = self.reduced(at.q[0]);
        out.mass.values_mut()[0] = r.inertia;
        if stage == Stage::Dynamics {
            let omega = at.v[0];
            let load = if self.drive == Drive::Geared { self.load(&r, at.modes) } else { 0.0 };
            out.force[0] = self.torque(omega, at.modes) - self.viscous * omega - r.half_slope * omega * omega - r.weight + load;
        }
    }

    fn residual(&mut self, at: At<'_>, a: &[f64], _: &[f64], out: &mut [f64]) {
        let mut terms = std::mem::take(&mut self.terms);
        self.terms(at, Stage::Dynamics, &mut terms);
        out[0] = terms.mass.values()[0] * a[0] - terms.force[0];
        self.terms = terms;
    }

    fn tangent(&mut self, _: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        // explicit schemes alone are compared
        (out.k.values_mut()[0], out.c.values_mut()[0]) = (f64::NAN, f64::NAN);
    }

    fn rate(&self, _: f64, _: &[f64], v: &[f64], qdot: &mut [f64]) {
        qdot.copy_from_slice(v);
    }

    fn retract(&self, _: Span, q: &mut [f64], delta: &[f64]) {
        q[0] += delta[0];
    }

    fn displace(&self, _: Span, q: &mut [f64], u: &[f64]) {
        q[0] += u[0];
    }

    fn power(&mut self, _: At<'_>, _: &[f64], _: &[f64], _: &mut [f64]) {}

    fn modes(&mut self, at: At<'_>, modes: &mut [i32]) {
        if self.dims.modes == 0 {
            return;
        }
        let (r, omega) = (self.reduced(at.q[0]), at.v[0]);
        let side = |x: f64, was: i32| if x == 0.0 { was } else { i32::from(x < 0.0) };
        modes[SEGMENT] = self.curve.iter().filter(|[x, _]| omega > *x).count() as i32;
        modes[BEHIND] = side(self.phi3(&r) - self.p.load_angle, at.modes[BEHIND]);
        modes[BACK] = side(-r.rocker * omega, at.modes[BACK]);
    }

    fn roots(&mut self, at: At<'_>, _: &[f64], _: &[f64], g: &mut [f64]) {
        if self.dims.roots == 0 {
            return;
        }
        let (r, omega) = (self.reduced(at.q[0]), at.v[0]);
        let sign = |mode: usize| if at.modes[mode] == 1 { -1.0 } else { 1.0 };
        let k = at.modes[SEGMENT].max(0) as usize;
        g[0] = k.checked_sub(1).and_then(|i| self.curve.get(i)).map_or(1.0, |[x, _]| omega - x);
        g[1] = self.curve.get(k).map_or(1.0, |[x, _]| x - omega);
        g[2] = sign(BEHIND) * (self.phi3(&r) - self.p.load_angle);
        g[3] = sign(BACK) * -r.rocker * omega;
    }

    fn cross(&mut self, root: usize, state: &mut State, _: &mut [f64]) -> Effect {
        match root {
            0 => state.modes[SEGMENT] -= 1,
            1 => state.modes[SEGMENT] += 1,
            2 => state.modes[BEHIND] = 1 - state.modes[BEHIND],
            _ => state.modes[BACK] = 1 - state.modes[BACK],
        }
        Effect::Restart
    }
}
