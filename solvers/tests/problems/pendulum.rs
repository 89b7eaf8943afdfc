//! The simple pendulum: in Cartesian coordinates with one row, and in its angle without any.
//!
//! 1 kg on a massless rod of 1 m, released at rest from (−1, 0). IFToMM benchmark A01; closed form with the angle φ from the
//! downward vertical: sin(φ/2) = −sin(π/4) cd(√g t | 1/2), period 4 K(1/2)/√g, tension 3 m g cos φ.

use super::base::{Base, Problem, clear, diagonal, scaled};
use super::elliptic;
use grashof_solvers::{At, Dims, Effect, Pattern, Stage, State, System, Tangent, Terms};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

/// Gravity (m/s²).
const GRAVITY: f64 = 9.81;

/// Period (s); closed form to 18 digits, reference `iftomm_a01_pendulum.json`.
pub(crate) const PERIOD: f64 = 2.367_841_947_576_237_4;

/// φ (rad) and φ̇ (rad/s) at t.
fn motion(t: f64) -> (f64, f64) {
    let (root, m1) = (GRAVITY.sqrt(), 0.5);
    let [sn, cn, dn] = elliptic::jacobi(root * t, m1);
    let half = (-FRAC_1_SQRT_2 * cn / dn).asin();
    // d cd(u)/du = −(1 − m) sn/dn²
    (2.0 * half, 2.0 * FRAC_1_SQRT_2 * root * m1 * sn / (dn * dn) / half.cos())
}

/// q = (x, y), Φ = (x² + y² − 1)/2: index 3.
#[derive(Clone, Debug)]
pub(crate) struct Pendulum {
    base: Base,
}

impl Pendulum {
    /// The period (s).
    pub(crate) const PERIOD: f64 = PERIOD;

    /// x, y, vx, vy at t = 10 s; reference `iftomm_a01_pendulum.json`, 20 digits.
    pub(crate) const AT_10: [f64; 4] = [-0.275_087_462_576_116_9, -0.961_419_205_099_125, 4.175_598_100_951_729, -1.194_749_054_560_475_3];

    /// The pendulum of A01.
    pub(crate) fn new() -> Self {
        let dims = Dims { q: 2, v: 2, holonomic: 1, ..Dims::default() };
        scaled(Self { base: Base::new(dims) }, |p| &mut p.base, &[1, 1])
    }

    /// x, y, vx, vy at t by the closed form.
    pub(crate) fn exact(t: f64) -> [f64; 4] {
        let (phi, rate) = motion(t);
        let (s, c) = phi.sin_cos();
        [s, -c, c * rate, s * rate]
    }

    /// The multiplier at t: the tension (N), as the length is 1.
    pub(crate) fn exact_lambda(t: f64) -> f64 {
        3.0 * GRAVITY * motion(t).0.cos()
    }
}

impl System for Pendulum {
    stored!();
    vectors!();
    conservative!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        let (q, v) = (at.q, at.v);
        diagonal(&mut out.mass, [1.0, 1.0]);
        out.phi[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0);
        out.g.values_mut().copy_from_slice(q);
        if stage >= Stage::Velocity {
            out.nu[0] = 0.0;
            out.gamma[0] = -(v[0] * v[0] + v[1] * v[1]);
        }
        if stage >= Stage::Dynamics {
            out.force.copy_from_slice(&[0.0, -GRAVITY]);
        }
    }

    fn tangent(&mut self, _: At<'_>, _: &[f64], lambda: &[f64], out: &mut Tangent) {
        clear(out);
        diagonal(&mut out.k, [lambda[0]; 2]);
    }
}

impl Problem for Pendulum {
    fn start(&self) -> State {
        State { q: vec![-1.0, 0.0], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        0.5 * (state.v[0] * state.v[0] + state.v[1] * state.v[1]) + GRAVITY * state.q[1]
    }
}

/// q = φ: the same motion without a row.
#[derive(Clone, Debug)]
pub(crate) struct PendulumAngle {
    base: Base,
}

impl PendulumAngle {
    /// The pendulum of A01.
    pub(crate) fn new() -> Self {
        let dims = Dims { q: 1, v: 1, ..Dims::default() };
        scaled(Self { base: Base::new(dims) }, |p| &mut p.base, &[0])
    }

    /// φ and φ̇ at t by the closed form.
    pub(crate) fn exact(t: f64) -> [f64; 2] {
        let (phi, rate) = motion(t);
        [phi, rate]
    }
}

impl System for PendulumAngle {
    stored!();
    vectors!();
    conservative!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        out.mass.values_mut()[0] = 1.0;
        if stage >= Stage::Dynamics {
            out.force[0] = -GRAVITY * at.q[0].sin();
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], _: &[f64], out: &mut Tangent) {
        clear(out);
        out.k.values_mut()[0] = GRAVITY * at.q[0].cos();
    }
}

impl Problem for PendulumAngle {
    fn start(&self) -> State {
        State { q: vec![-FRAC_PI_2], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        0.5 * state.v[0] * state.v[0] - GRAVITY * state.q[0].cos()
    }
}
