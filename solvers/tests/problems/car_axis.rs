//! The car axis of the Test Set for IVP Solvers (Mazzia & Magherini 2008): index 3 with a rheonomic row; dimensionless.
//!
//! Point masses m at the ends pl, pr of a rigid massless axle of length 1; springs of stiffness 1 and rest length ½ from the
//! origin to pl and from the road point b(t) to pr; gravity 1. With b = (√(1 − β²), β), β = 0.1 sin 10t:
//!
//! ```text
//! Φ₁ = −pl·b(t),  Φ₂ = 1 − |pl − pr|²
//! m pl″ = spring + λ₁ b + 2 λ₂ (pl − pr) − (0, m),   m pr″ = spring − 2 λ₂ (pl − pr) − (0, m)
//! ```
//!
//! The rows have the sign that gives the multipliers of the Test Set.

use super::base::{Base, Problem, clear, diagonal, scaled};
use grashof_solvers::{At, Dims, Effect, Pattern, Stage, State, System, Tangent, Terms};

/// Mass of each end, M ε²/2 with M = 10, ε = 0.01.
const MASS: f64 = 5e-4;
/// Rest length of the springs; their stiffness is 1.
const REST: f64 = 0.5;

/// b, ḃ and b̈ at t.
fn road(t: f64) -> [[f64; 2]; 3] {
    let (amplitude, omega) = (0.1, 10.0);
    let (s, c) = (omega * t).sin_cos();
    let (y, y1, y2) = (amplitude * s, amplitude * omega * c, -amplitude * omega * omega * s);
    // x² + y² = 1, twice differentiated
    let x = (1.0 - y * y).sqrt();
    let x1 = -y * y1 / x;
    let x2 = -(x1 * x1 + y1 * y1 + y * y2) / x;
    [[x, y], [x1, y1], [x2, y2]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Length of a spring and its force on the point at `p` from its anchor.
fn spring(p: [f64; 2]) -> (f64, [f64; 2]) {
    let length = dot(p, p).sqrt();
    let pull = -(length - REST) / length;
    (length, [pull * p[0], pull * p[1]])
}

/// Entry (i, j) of minus the derivative of that force: (1 − l₀/l) δᵢⱼ + l₀ pᵢ pⱼ/l³.
fn stiffness(p: [f64; 2], i: usize, j: usize) -> f64 {
    let length = dot(p, p).sqrt();
    let unit = if i == j { 1.0 - REST / length } else { 0.0 };
    unit + REST * p[i] * p[j] / length.powi(3)
}

/// The points pl and pr, or their velocities.
fn ends(x: &[f64]) -> ([f64; 2], [f64; 2]) {
    ([x[0], x[1]], [x[2], x[3]])
}

/// q = (pl, pr).
#[derive(Clone, Debug)]
pub(crate) struct CarAxis {
    base: Base,
}

impl CarAxis {
    /// Positions at t = 3; reference `car_axis.json`, 20 digits.
    pub(crate) const Q_3: [f64; 4] = [0.049_345_578_427_524_09, 0.496_989_460_230_008_1, 1.041_742_524_885_426_1, 0.373_911_027_265_365_83];
    /// Velocities at t = 3; same source.
    pub(crate) const V_3: [f64; 4] =
        [-0.077_058_368_403_592_08, 0.007_446_866_592_068_416, 0.017_556_815_753_541_737, 0.770_341_043_779_601_1];
    /// Multipliers at t = 3; same source.
    pub(crate) const LAMBDA_3: [f64; 2] = [-0.004_736_886_590_853_326, -0.001_104_680_331_259_565_8];

    /// The problem of the Test Set.
    pub(crate) fn new() -> Self {
        let dims = Dims { q: 4, v: 4, holonomic: 2, work: 1, ..Dims::default() };
        scaled(Self { base: Base::new(dims) }, |p| &mut p.base, &[1; 4])
    }
}

impl System for CarAxis {
    stored!();
    vectors!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        let ((pl, pr), (vl, vr)) = (ends(at.q), ends(at.v));
        let [b, b1, b2] = road(at.t);
        let (d, d1) = (minus(pl, pr), minus(vl, vr));
        diagonal(&mut out.mass, [MASS; 4]);
        out.phi.copy_from_slice(&[-dot(pl, b), 1.0 - dot(d, d)]);
        out.g.values_mut().copy_from_slice(&[-b[0], -b[1], 0.0, 0.0, -2.0 * d[0], -2.0 * d[1], 2.0 * d[0], 2.0 * d[1]]);
        if stage >= Stage::Velocity {
            out.nu.copy_from_slice(&[dot(pl, b1), 0.0]);
            out.gamma.copy_from_slice(&[2.0 * dot(vl, b1) + dot(pl, b2), 2.0 * dot(d1, d1)]);
        }
        if stage >= Stage::Dynamics {
            let (left, right) = (spring(pl).1, spring(minus(pr, b)).1);
            out.force.copy_from_slice(&[left[0], left[1] - MASS, right[0], right[1] - MASS]);
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], lambda: &[f64], out: &mut Tangent) {
        clear(out);
        let (pl, pr) = ends(at.q);
        let pr = minus(pr, road(at.t)[0]);
        for i in 0..2 {
            for j in 0..2 {
                out.k.values_mut()[4 * i + j] = stiffness(pl, i, j);
                out.k.values_mut()[4 * (i + 2) + j + 2] = stiffness(pr, i, j);
            }
        }
        for i in 0..4 {
            out.k.values_mut()[5 * i] -= 2.0 * lambda[1];
            out.k.values_mut()[4 * i + (i + 2) % 4] += 2.0 * lambda[1];
        }
    }

    /// Of the moving road point and of the moving guide: ∂V/∂t − λᵀν.
    fn power(&mut self, at: At<'_>, _: &[f64], lambda: &[f64], w: &mut [f64]) {
        let (pl, pr) = ends(at.q);
        let [b, b1, _] = road(at.t);
        w[0] = dot(spring(minus(pr, b)).1, b1) - lambda[0] * dot(pl, b1);
    }
}

impl Problem for CarAxis {
    /// As the Test Set has it, with λ = 0 there; the multipliers that belong to it follow from the equations.
    fn start(&self) -> State {
        State { q: vec![0.0, 0.5, 1.0, 0.5], v: vec![-0.5, 0.0, -0.5, 0.0], ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        let (pl, pr) = ends(&state.q);
        let stretch = |p: [f64; 2]| (spring(p).0 - REST).powi(2);
        let kinetic: f64 = state.v.iter().map(|v| 0.5 * MASS * v * v).sum();
        kinetic + MASS * (pl[1] + pr[1]) + 0.5 * (stretch(pl) + stretch(minus(pr, road(state.t)[0])))
    }
}
