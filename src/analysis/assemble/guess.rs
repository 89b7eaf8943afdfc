//! What guesses and exact values of `start` ask of a position.

use super::{CONVERGED, Held, Shake, System, norm};
use crate::analysis::least_squares::shortest;
use crate::geometry::Space;
use crate::mechanism::{Asked, Measured};

/// Part by which another closing must come nearer to the guesses to count.
const NEARER: f64 = 1e-3;

impl<G: Space<S = f64>> System<'_, G> {
    /// Residual and Jacobian of start values at position level, exact ones alone or all.
    pub(super) fn asked(&self, exact_only: bool, r: &mut Vec<f64>, jacobian: &mut Vec<f64>) {
        let (m, w) = (self.dynamics.mechanism, &self.dynamics.work);
        for start in m.starts.iter().filter(|s| !(exact_only && s.guess)) {
            let Asked::Gauge { gauge, order: 0 } = start.asked else { continue };
            let scale = self.gauge_scale(gauge);
            r.push((w.readings[gauge].x - start.value) * scale);
            let first = jacobian.len();
            jacobian.resize(first + m.nv, 0.0);
            m.gauges[gauge].project(&w.readings[gauge], &w.columns, |k, x| jacobian[first + k] = x * scale);
        }
    }

    /// Lengths are measured by the size of the mechanism, angles by themselves.
    fn gauge_scale(&self, gauge: usize) -> f64 {
        match self.dynamics.mechanism.gauges[gauge].measured {
            Measured::Slide { .. } | Measured::Distance { .. } => 1.0 / self.size,
            Measured::Coordinate { along, .. } if !along.turns => 1.0 / self.size,
            _ => 1.0,
        }
    }

    /// Pulls the drawn position towards all asked values.
    pub(super) fn guess(&mut self, q: &mut [f64], metric: &[f64]) {
        for _ in 0..30 {
            self.evaluate(q);
            let (mut r, mut jacobian) = (Vec::new(), Vec::new());
            self.asked(false, &mut r, &mut jacobian);
            if norm(&r) < CONVERGED {
                break;
            }
            r.iter_mut().for_each(|r| *r = -*r);
            let delta = self.bounded(shortest(&jacobian, &r, metric, 1e-12));
            self.dynamics.mechanism.retract(q, &delta);
        }
    }

    /// The position that closes from where guesses held like exact values leave it, if it comes nearer to the guesses than `other`
    /// or there is no other.
    pub(super) fn by_guesses(&mut self, from: &[f64], other: Option<&Vec<f64>>, metric: &[f64]) -> Option<Vec<f64>> {
        if !self.dynamics.mechanism.starts.iter().any(|s| s.guess && matches!(s.asked, Asked::Gauge { order: 0, .. })) {
            return None;
        }
        let modes = self.modes.clone();
        let mut q = from.to_vec();
        self.held = Held::All;
        if !self.close(&mut q, metric) {
            // a drawn position in which a link points straight away from its place has no direction to go
            let mut trial = from.to_vec();
            self.dynamics.mechanism.retract(&mut trial, &Shake(2).displacement(self.dynamics.mechanism.nv, 0.2));
            if self.close(&mut trial, metric) {
                q = trial;
            }
        }
        self.held = Held::Exact;
        let nearer = self.close(&mut q, metric)
            && self.faces()
            && match other {
                Some(other) => {
                    let (mine, bound) = (self.miss(&q), self.miss(other));
                    self.evaluate(&q);
                    mine < (1.0 - NEARER) * bound - CONVERGED
                }
                None => true,
            };
        if !nearer {
            self.modes = modes;
            if let Some(other) = other {
                self.evaluate(other);
            }
        }
        nearer.then_some(q)
    }

    /// How far a position is from all asked values.
    fn miss(&mut self, q: &[f64]) -> f64 {
        self.evaluate(q);
        let (mut r, mut jacobian) = (Vec::new(), Vec::new());
        self.asked(false, &mut r, &mut jacobian);
        norm(&r)
    }
}
