//! Work over a step: the integral of the powers by the weights of the scheme, or else along its continuous solution.
//!
//! Lobatto's rule with five nodes is exact to degree seven (Abramowitz & Stegun 25.4.32); Simpson's, over three of the same nodes, to
//! degree three. Where the two are apart by a part d, the first is off by about d^(9/5), the ratio of their orders. That is below the
//! tolerance where the step follows a motion; where drivers leave nothing to integrate a step may span whole turns, and is halved.
//! So is one whose weights are too coarse for the powers, as their own estimate of the error tells.

use super::{Integration, WORK_NODES, active};
use crate::engine::Why;
use crate::{Power, System};
use std::ops::Range;

/// Halvings of a step.
const MOST_HALVINGS: usize = 12;

/// Halvings that a run may make at its begin, and steps to a further one: powers that are noise are not worth many.
const FREE: usize = 500;
const STEPS_TO_A_HALVING: usize = 20;

/// Where a step that ends at a root has not reached it yet.
const NEAR_SIDE: f64 = 1.0 - 1e-9;

/// Tolerances, as a part of the work of a step, that the weights of a scheme may be off: the tolerance is that of a motion, whose errors
/// powers multiply.
const TOLERANCES: f64 = 10.0;

/// Part of the powers of all forces, those included that store energy, that is round-off of their differences.
const NOISE: f64 = 1e-13;

impl Integration {
    /// Adds ∫ power dt over the last step, which ends at a root or not: a root lies on its far side, where forces still follow the
    /// law of the near side, and energies no longer do.
    pub(super) fn balance(&mut self, system: &mut dyn System, at_root: bool) -> Result<(), Why> {
        let of = system.pattern().power;
        if !self.settings.balance || of == Power::Zero {
            return Ok(());
        }
        let h = self.node.state.t - self.last.state.t;
        let forces = self.engine.terms.force.iter().zip(&self.node.state.v);
        let noise = NOISE * forces.map(|(f, v)| (f * v).abs()).sum::<f64>();
        self.work.copy_from_slice(&self.last.state.work);
        if !at_root && h == self.length && self.by_weights(h, noise) {
            self.node.state.work.copy_from_slice(&self.work);
            return Ok(());
        }
        self.interpolate(system)?;
        let apart = 3.0 * if self.engine.is_fixed() { 1e-8 } else { self.engine.tolerance() }.powf(5.0 / 9.0);
        let inner = 0.5 - 0.5 * (3.0_f64 / 7.0).sqrt();
        let (end, side, middle) = (1.0 / 20.0, 49.0 / 180.0, 16.0 / 45.0);
        let (places, weights) = ([0.0, inner, 0.5, 1.0 - inner, if at_root { NEAR_SIDE } else { 1.0 }], [end, side, middle, side, end]);
        let count = self.work.len();
        let mut parts = [(0.0, 1.0); MOST_HALVINGS + 2];
        let mut left = 1;
        while left > 0 {
            left -= 1;
            let (from, width) = parts[left];
            for (node, place) in places.iter().enumerate() {
                self.powers(system, from + place * width, node * count..(node + 1) * count)?;
            }
            let at = |node: usize, k: usize| self.power[node * count + k];
            let (mut off, mut size): (f64, f64) = (0.0, 0.0);
            for k in 0..count {
                let lobatto: f64 = (0..WORK_NODES).map(|node| weights[node] * at(node, k)).sum();
                let simpson = (at(0, k) + 4.0 * at(2, k) + at(4, k)) / 6.0;
                off = off.max((lobatto - simpson).abs());
                size = size.max((0..WORK_NODES).map(|node| weights[node] * at(node, k).abs()).sum());
            }
            let affordable = self.halvings < FREE + self.engine.counts.steps / STEPS_TO_A_HALVING;
            if off > (apart * size).max(noise) && left < MOST_HALVINGS && affordable {
                self.halvings += 1;
                let half = 0.5 * width;
                (parts[left], parts[left + 1]) = ((from + half, half), (from, half));
                left += 2;
                continue;
            }
            for (node, weight) in weights.iter().enumerate() {
                let powers = &self.power[node * count..(node + 1) * count];
                self.work.iter_mut().zip(powers).for_each(|(w, p)| *w += weight * width * h * p);
            }
        }
        self.node.state.work.copy_from_slice(&self.work);
        Ok(())
    }

    /// Adds the work of a step of `h` (s) by the weights of the scheme, where they are fine enough.
    fn by_weights(&mut self, h: f64, noise: f64) -> bool {
        let scheme = active(&mut self.scheme, &mut self.bridge, self.bridging.is_some());
        let fine = match scheme.work(h, &mut self.work) {
            Some([error, size]) => error <= (TOLERANCES * self.engine.tolerance() * size).max(noise * h),
            None => return false,
        };
        if !fine {
            self.work.copy_from_slice(&self.last.state.work);
        }
        fine
    }

    /// Powers at the place θ of the last step, into a part of `power`.
    fn powers(&mut self, system: &mut dyn System, theta: f64, part: Range<usize>) -> Result<(), Why> {
        let (t, h) = (self.last.state.t, self.node.state.t - self.last.state.t);
        if theta == 0.0 {
            system.power(self.last.state.at(), &self.last.a, &self.last.lambda, &mut self.power[part]);
        } else if theta == 1.0 {
            system.power(self.node.state.at(), &self.node.a, &self.node.lambda, &mut self.power[part]);
        } else {
            self.trial.state.modes.copy_from_slice(&self.last.state.modes);
            self.trial.state.live.copy_from_slice(&self.last.state.live);
            self.dense.evaluate(t + theta * h, &mut self.trial.state);
            if system.pattern().power == Power::Reactions {
                self.engine.accelerate(system, &mut self.trial)?;
            }
            system.power(self.trial.state.at(), &self.trial.a, &self.trial.lambda, &mut self.power[part]);
        }
        Ok(())
    }
}
