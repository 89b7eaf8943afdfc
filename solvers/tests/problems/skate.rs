//! A skate on a slope of 30°: the velocity of the blade's point stays along the blade, a nonholonomic row.
//!
//! x down the slope, y across, blade at the angle θ: Ψ v = −sin θ ẋ + cos θ ẏ = 0. With the spin ω, which stays constant,
//! x = g sin 30°/(2ω²) sin² ωt, y = g sin 30°/(2ω²)(ωt − sin(2ωt)/2): a cycloid, no descent in the mean (reference
//! `knife_edge.json`).

use super::base::{Base, Problem, clear, diagonal, scaled};
use grashof_solvers::{At, Dims, Effect, Pattern, Stage, State, System, Tangent, Terms};

/// g sin 30° (m/s²); the mass is 1 kg.
const PULL: f64 = 9.81 * 0.5;
/// Inertia about the blade's point (kg·m²); without influence.
const INERTIA: f64 = 0.1;
/// θ̇ (rad/s).
const SPIN: f64 = 2.0;

/// q = (x, y, θ).
#[derive(Clone, Debug)]
pub(crate) struct Skate {
    base: Base,
}

impl Skate {
    /// t, x, y; reference `knife_edge.json`, 18 digits.
    pub(crate) const OUTPUTS: [[f64; 3]; 3] = [
        [0.5, 0.434_137_514_578_983_34, 0.334_368_507_588_752],
        [1.0, 0.506_945_122_521_001_1, 1.458_257_264_967_836_7],
        [5.0, 0.181_459_842_925_332_02, 5.851_375_221_573_812],
    ];

    /// At rest at the origin, pointing down, spinning.
    pub(crate) fn new() -> Self {
        let dims = Dims { q: 3, v: 3, nonholonomic: 1, ..Dims::default() };
        scaled(Self { base: Base::new(dims) }, |p| &mut p.base, &[1, 1, 0])
    }

    /// x, y, θ at t.
    pub(crate) fn exact(t: f64) -> [f64; 3] {
        let (scale, angle) = (PULL / (2.0 * SPIN * SPIN), SPIN * t);
        [scale * angle.sin().powi(2), scale * (angle - 0.5 * (2.0 * angle).sin()), angle]
    }
}

impl System for Skate {
    stored!();
    vectors!();
    conservative!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        let (s, c) = at.q[2].sin_cos();
        diagonal(&mut out.mass, [1.0, 1.0, INERTIA]);
        out.g.values_mut().copy_from_slice(&[-s, c, 0.0]);
        if stage >= Stage::Velocity {
            out.nu[0] = 0.0;
            out.gamma[0] = at.v[2] * (c * at.v[0] + s * at.v[1]);
        }
        if stage >= Stage::Dynamics {
            out.force.copy_from_slice(&[PULL, 0.0, 0.0]);
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], lambda: &[f64], out: &mut Tangent) {
        clear(out);
        let (s, c) = at.q[2].sin_cos();
        out.k.values_mut()[2] = -c * lambda[0];
        out.k.values_mut()[5] = -s * lambda[0];
    }
}

impl Problem for Skate {
    fn start(&self) -> State {
        State { v: vec![0.0, 0.0, SPIN], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        let v = &state.v;
        0.5 * (v[0] * v[0] + v[1] * v[1] + INERTIA * v[2] * v[2]) - PULL * state.q[0]
    }
}
