//! Linear systems with exact solutions: a stiff pair of masses, and a motor with an inductance as first-order state.

use super::base::{Base, Problem, clear, diagonal, scaled};
use grashof_solvers::{At, Dims, Effect, Pattern, Stage, State, System, Tangent, Terms};

/// y and ẏ at t of ÿ + 2α ẏ + ω² y = 0 from y₀, ẏ₀, α² ≠ ω².
fn damped(alpha: f64, square: f64, [y0, y1]: [f64; 2], t: f64) -> [f64; 2] {
    let discriminant = alpha * alpha - square;
    if discriminant > 0.0 {
        // the slow root as a quotient: the difference α − √(α² − ω²) cancels
        let fast = -alpha - discriminant.sqrt();
        let slow = square / fast;
        let (a, b) = ((y1 - fast * y0) / (slow - fast), (slow * y0 - y1) / (slow - fast));
        let (slow_part, fast_part) = (a * (slow * t).exp(), b * (fast * t).exp());
        [slow_part + fast_part, slow * slow_part + fast * fast_part]
    } else {
        let beta = (-discriminant).sqrt();
        let (s, c) = (beta * t).sin_cos();
        let decay = (-alpha * t).exp();
        let b = (y1 + alpha * y0) / beta;
        [decay * (y0 * c + b * s), decay * (y1 * c - (alpha * b + beta * y0) * s)]
    }
}

/// Two masses of 1 kg, each on a spring of 1 N/m to a wall, joined by a stiff damped spring.
///
/// The sum of the positions swings at 1 rad/s for ever; the difference has ω² = 1 + 2k and the damping 2d.
#[derive(Clone, Debug)]
pub(crate) struct StiffPair {
    base: Base,
    /// k (N/m).
    pub(crate) stiffness: f64,
    /// d (N·s/m).
    pub(crate) damping: f64,
}

impl StiffPair {
    /// Stiffness (N/m) and damping (N·s/m) of the spring between; 2k + 1 ≠ d².
    pub(crate) fn new(stiffness: f64, damping: f64) -> Self {
        let dims = Dims { q: 2, v: 2, work: 1, ..Dims::default() };
        scaled(Self { base: Base::new(dims), stiffness, damping }, |p| &mut p.base, &[1, 1])
    }

    /// x₁, x₂, v₁, v₂ at t.
    pub(crate) fn exact(&self, t: f64) -> [f64; 4] {
        let start = self.start().q;
        let (s, c) = t.sin_cos();
        let sum = start[0] + start[1];
        let [d, d1] = damped(self.damping, 1.0 + 2.0 * self.stiffness, [start[0] - start[1], 0.0], t);
        [0.5 * (sum * c + d), 0.5 * (sum * c - d), 0.5 * (d1 - sum * s), 0.5 * (-d1 - sum * s)]
    }
}

impl System for StiffPair {
    stored!();
    vectors!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        diagonal(&mut out.mass, [1.0, 1.0]);
        if stage >= Stage::Dynamics {
            let between = self.stiffness * (at.q[0] - at.q[1]) + self.damping * (at.v[0] - at.v[1]);
            out.force.copy_from_slice(&[-at.q[0] - between, -at.q[1] + between]);
        }
    }

    fn tangent(&mut self, _: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        let (k, d) = (self.stiffness, self.damping);
        out.k.values_mut().copy_from_slice(&[1.0 + k, -k, -k, 1.0 + k]);
        out.c.values_mut().copy_from_slice(&[d, -d, -d, d]);
    }

    /// Of the damper.
    fn power(&mut self, at: At<'_>, _: &[f64], _: &[f64], w: &mut [f64]) {
        w[0] = -self.damping * (at.v[0] - at.v[1]).powi(2);
    }
}

impl Problem for StiffPair {
    /// At rest, the stiff spring stretched by 0.01 m.
    fn start(&self) -> State {
        State { q: vec![1.0, 0.99], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        let squares: f64 = state.q.iter().chain(&state.v).map(|x| x * x).sum();
        0.5 * squares + 0.5 * self.stiffness * (state.q[0] - state.q[1]).powi(2)
    }
}

/// A motor that starts up without load: L i′ = U − R i − k ω, J ω′ = k i; q is the angle, z the current.
///
/// Eigenvalues −2.25 and −17.75 1/s.
#[derive(Clone, Debug)]
pub(crate) struct InductanceMotor {
    base: Base,
    /// U (V).
    pub(crate) voltage: f64,
    /// R (Ω).
    pub(crate) resistance: f64,
    /// L (H).
    pub(crate) inductance: f64,
    /// k (N·m/A).
    pub(crate) constant: f64,
    /// J (kg·m²).
    pub(crate) inertia: f64,
}

impl InductanceMotor {
    /// 12 V, 1 Ω, 50 mH, 0.2 N·m/A, 0.02 kg·m².
    pub(crate) fn new() -> Self {
        let dims = Dims { q: 1, v: 1, z: 1, work: 1, ..Dims::default() };
        let base = Base::new(dims);
        let motor = Self { base, voltage: 12.0, resistance: 1.0, inductance: 0.05, constant: 0.2, inertia: 0.02 };
        scaled(motor, |p| &mut p.base, &[0])
    }

    /// Angle, speed and current at t.
    ///
    /// ω″ + (R/L) ω′ + k²/(L J) (ω − U/k) = 0; the sum of both equations over time gives the angle.
    pub(crate) fn exact(&self, t: f64) -> [f64; 3] {
        let (k, last) = (self.constant, self.voltage / self.constant);
        let square = k * k / (self.inductance * self.inertia);
        let [y, y1] = damped(0.5 * self.resistance / self.inductance, square, [-last, 0.0], t);
        let (omega, current) = (last + y, self.inertia * y1 / k);
        let charge = self.inertia * omega / k;
        [(self.voltage * t - self.resistance * charge - self.inductance * current) / k, omega, current]
    }
}

impl System for InductanceMotor {
    stored!();
    vectors!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        out.mass.values_mut()[0] = self.inertia;
        if stage >= Stage::Dynamics {
            out.force[0] = self.constant * at.z[0];
            out.zdot[0] = (self.voltage - self.resistance * at.z[0] - self.constant * at.v[0]) / self.inductance;
        }
    }

    fn tangent(&mut self, _: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        out.r_z.values_mut()[0] = -self.constant;
        out.z_v.values_mut()[0] = -self.constant / self.inductance;
        out.z_z.values_mut()[0] = -self.resistance / self.inductance;
    }

    /// Of the supply less the heat.
    fn power(&mut self, at: At<'_>, _: &[f64], _: &[f64], w: &mut [f64]) {
        w[0] = (self.voltage - self.resistance * at.z[0]) * at.z[0];
    }
}

impl Problem for InductanceMotor {
    fn start(&self) -> State {
        State::new(self.base.dims)
    }

    fn energy(&self, state: &State) -> f64 {
        0.5 * (self.inertia * state.v[0] * state.v[0] + self.inductance * state.z[0] * state.z[0])
    }
}
