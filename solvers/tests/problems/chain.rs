//! A chain of point masses on massless links: n points, n distance rows.
//!
//! Φᵢ = (|pᵢ − pᵢ₋₁|² − l²)/2 with p₋₁ the pivot at the origin; λᵢ l is the tension.

use super::base::{Base, Problem, add, clear, diagonal, scaled};
use grashof_solvers::{At, Dims, Effect, Pattern, Sparsity, Stage, State, System, Tangent, Terms};

/// Gravity (m/s²), in −y.
const GRAVITY: f64 = 9.81;

/// q = (x, y) of point after point, 1 kg each.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    base: Base,
    length: f64,
}

impl Chain {
    /// Angles from the downward vertical of `horizontal(10, 0.1)` at t = 0.5 s; reference `chain_10.json`, 20 digits.
    pub(crate) const TEN_ANGLES: [f64; 10] = [
        0.043_519_032_210_692_164,
        0.035_639_120_783_171_066,
        0.033_686_677_221_404_36,
        0.006_914_282_099_224_689,
        -0.003_160_809_806_760_076,
        -0.063_783_479_329_697_69,
        -0.075_971_209_589_181_07,
        -0.271_156_481_020_680_8,
        -0.309_218_679_227_077_1,
        -1.320_289_952_391_752_2,
    ];
    /// Tension (N) of its first and last link at t = 0.5 s; same source.
    pub(crate) const TEN_TENSIONS: [f64; 2] = [209.642_177_053_814_98, 46.513_116_518_264_866];
    /// Tip of `horizontal(2, 1.0)`, a double pendulum, at t = 2, 5 and 10 s; reference `double_pendulum.json`, 20 digits.
    pub(crate) const DOUBLE_TIPS: [[f64; 3]; 3] = [
        [2.0, -1.434_124_817_464_276_7, -1.129_870_195_647_158],
        [5.0, -1.550_778_469_470_442_8, -1.075_912_734_812_652_5],
        [10.0, -1.040_765_783_246_170_5, -1.707_347_662_469_327_5],
    ];

    /// `n` links of the given length (m), along +x at rest.
    pub(crate) fn horizontal(n: usize, length: f64) -> Self {
        let dims = Dims { q: 2 * n, v: 2 * n, holonomic: n, ..Dims::default() };
        let mut base = Base::new(dims);
        let neighbours = |i: usize| i.saturating_sub(1)..(i + 2).min(n);
        let rows = (0..n).flat_map(|i| (2 * i.saturating_sub(1)..2 * i + 2).map(move |j| (i, j)));
        base.pattern.g = Sparsity::new(n, 2 * n, rows);
        base.pattern.mass = Sparsity::new(2 * n, 2 * n, (0..2 * n).map(|i| (i, i)));
        let blocks = (0..n).flat_map(|i| neighbours(i).flat_map(move |j| [(2 * i, 2 * j), (2 * i + 1, 2 * j + 1)]));
        base.pattern.k = Sparsity::new(2 * n, 2 * n, blocks);
        base.pattern.c = Sparsity::empty(2 * n, 2 * n);
        base.pattern.r_lambda = Sparsity::empty(2 * n, n);
        scaled(Self { base, length }, |p| &mut p.base, &vec![1; 2 * n])
    }

    /// Angle of each link from the downward vertical.
    pub(crate) fn angles(&self, q: &[f64]) -> Vec<f64> {
        (0..q.len() / 2).map(|i| link(q, i)).map(|[x, y]| x.atan2(-y)).collect()
    }
}

/// pᵢ − pᵢ₋₁, or the same of the velocities.
fn link(x: &[f64], i: usize) -> [f64; 2] {
    if i == 0 { [x[0], x[1]] } else { [x[2 * i] - x[2 * i - 2], x[2 * i + 1] - x[2 * i - 1]] }
}

impl System for Chain {
    stored!();
    vectors!();
    conservative!();
    smooth!();

    fn terms(&mut self, at: At<'_>, stage: Stage, out: &mut Terms) {
        let n = at.q.len();
        diagonal(&mut out.mass, (0..n).map(|_| 1.0));
        out.g.values_mut().fill(0.0);
        for i in 0..n / 2 {
            let [x, y] = link(at.q, i);
            out.phi[i] = 0.5 * (x * x + y * y - self.length * self.length);
            for (k, x) in [x, y].into_iter().enumerate() {
                out.g.set(i, 2 * i + k, x);
                if i > 0 {
                    out.g.set(i, 2 * i - 2 + k, -x);
                }
            }
            if stage >= Stage::Velocity {
                let [vx, vy] = link(at.v, i);
                out.nu[i] = 0.0;
                out.gamma[i] = -(vx * vx + vy * vy);
            }
        }
        if stage >= Stage::Dynamics {
            out.force.chunks_exact_mut(2).for_each(|f| f.copy_from_slice(&[0.0, -GRAVITY]));
        }
    }

    fn tangent(&mut self, at: At<'_>, _: &[f64], lambda: &[f64], out: &mut Tangent) {
        clear(out);
        let n = at.q.len();
        for i in 0..n {
            let row = i / 2;
            add(&mut out.k, i, i, lambda[row]);
            if row > 0 {
                let before = i - 2;
                add(&mut out.k, before, before, lambda[row]);
                add(&mut out.k, i, before, -lambda[row]);
                add(&mut out.k, before, i, -lambda[row]);
            }
        }
    }
}

impl Problem for Chain {
    fn start(&self) -> State {
        let n = self.base.dims.holonomic;
        State { q: (1..=n).flat_map(|i| [i as f64 * self.length, 0.0]).collect(), ..State::new(self.base.dims) }
    }

    fn energy(&self, state: &State) -> f64 {
        let kinetic: f64 = state.v.iter().map(|v| 0.5 * v * v).sum();
        kinetic + state.q.iter().skip(1).step_by(2).map(|y| GRAVITY * y).sum::<f64>()
    }
}
