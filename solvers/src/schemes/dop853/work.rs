//! Work over a step by the weights of the method.
//!
//! Work W with Ẇ = P(t, y, λ) is one more equation that no other depends on. Its stages are the powers at those of the step, where forces
//! stand evaluated already, so that it costs next to nothing, and its error estimates those of orders 5 and 3.

use super::coefficients::{B, B3, E5};
use crate::engine::Node;
use crate::schemes::explicit::rows;
use crate::settings::Settings;
use crate::{At, Power, System};

/// First of the stages that have a weight, but for stage 0, and the one behind the last.
const FIRST: usize = B[1].0;
const END: usize = B[B.len() - 1].0 + 1;

/// Powers at the stages of a step.
#[derive(Clone, Debug)]
pub(super) struct Work {
    /// Number of powers; 0 if nobody asks for work.
    count: usize,
    /// Powers of every stage, stage after stage.
    powers: Vec<f64>,
    /// Whether stage 0 is that of the present step, and whether the others are.
    begun: bool,
    whole: bool,
}

impl Work {
    /// Room for the powers of a system, if they are to be integrated.
    pub(super) fn new(settings: Settings, system: &dyn System) -> Self {
        let asked = settings.balance && system.pattern().power != Power::Zero;
        let count = if asked { system.dims().work } else { 0 };
        Self { count, powers: vec![0.0; END * count], begun: false, whole: false }
    }

    /// A step is tried from a node; stages that are `projected` lie off those of the method, and have no weights.
    pub(super) fn begin(&mut self, system: &mut dyn System, from: &Node, projected: bool) {
        self.whole = self.count > 0 && !projected;
        if self.whole && !self.begun {
            system.power(from.state.at(), &from.a, &from.lambda, &mut self.powers[..self.count]);
            self.begun = true;
        }
    }

    /// The next step begins elsewhere.
    pub(super) fn accept(&mut self) {
        self.begun = false;
    }

    /// Forgets the last step.
    pub(super) fn forget(&mut self) {
        (self.begun, self.whole) = (false, false);
    }

    /// Whether a stage is wanted.
    pub(super) fn wants(&self, stage: usize) -> bool {
        self.whole && (FIRST..END).contains(&stage)
    }

    /// Takes the powers of a stage, whose accelerations were evaluated last.
    pub(super) fn stage(&mut self, stage: usize, system: &mut dyn System, at: At<'_>, [a, lambda]: [&[f64]; 2]) {
        system.power(at, a, lambda, &mut self.powers[stage * self.count..][..self.count]);
    }

    /// Adds the work of a step of `h` (s) to `out`, and tells the largest error of a part of it and the size of what was added up, J;
    /// none if there is none.
    pub(super) fn add(&self, h: f64, out: &mut [f64]) -> Option<[f64; 2]> {
        if !self.whole {
            return None;
        }
        let n = self.count;
        let powers = rows(&B, &self.powers, n);
        let [first, eighth, last] = rows(&B3, &self.powers, n);
        let (mut error, mut size): (f64, f64) = (0.0, 0.0);
        for (i, out) in out.iter_mut().enumerate().take(n) {
            let (mut sum, mut five, mut magnitude) = (0.0, 0.0, 0.0);
            for ((power, (_, b)), (_, e)) in powers.iter().zip(&B).zip(&E5) {
                sum += b * power[i];
                five += e * power[i];
                magnitude += b.abs() * power[i].abs();
            }
            let three = sum - B3[0].1 * first[i] - B3[1].1 * eighth[i] - B3[2].1 * last[i];
            let root = (five * five + 0.01 * three * three).sqrt();
            error = error.max(if root > 0.0 { h * five * five / root } else { root });
            size = size.max(h * magnitude);
            *out += h * sum;
        }
        Some([error, size])
    }
}
