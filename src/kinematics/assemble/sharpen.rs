//! Positions next to a singular one that rounding keeps from it: where rows lose rank, a gap of 1e-12 leaves the way open by 1e-6.
//!
//! With l and u the left and right vectors of the small singular values of G, the singular position is where lᵀG u = 0 beside Φ = 0: by
//! Newton's method, ∂(lᵀG u)/∂q by differences. If that is as near as rounding explains, the start is meant to be it.

use super::close::{CONVERGED, System};
use super::metric::norm;
use crate::geometry::Space;
use crate::numerics::least_squares::{Redundant, Rows, are_above, scaled, step};
use grashof_solvers::svd::Svd;
use nalgebra::DMatrix;

/// Singular values between these belong to a position next to a singular one.
const SMALL: [f64; 2] = [1e-11, 1e-4];

/// A position farther away than this, rad or sizes, is another.
const NEAR: f64 = 1e-5;

/// Step of the differences, rad or sizes.
const STEP: f64 = 1e-4;

impl<G: Space<S = f64>> System<'_, G> {
    /// Moves a closed position into the singular one that it is next to, if constraints and exact values leave it so.
    pub(super) fn sharpen(&mut self, q: &mut Vec<f64>) {
        let from = q.clone();
        let mut small = self.small(q);
        if small.is_none() {
            return;
        }
        let mut way = 0.0;
        for _ in 0..8 {
            let Some((l, u)) = &small else { break };
            let Some(step) = self.towards(q, l, u) else { break };
            way += step.iter().zip(&self.metric).map(|(d, metric)| d * d * metric).sum::<f64>().sqrt();
            self.dynamics.mechanism.retract(q, &step);
            if way > NEAR {
                break;
            }
            small = self.small(q);
        }
        let (mut r, mut jacobian) = (Vec::new(), Rows::default());
        self.evaluate(q);
        self.hard(&mut r, &mut jacobian);
        if small.is_some() || way > NEAR || norm(&r) > CONVERGED {
            *q = from;
            self.evaluate(q);
        }
    }

    /// Left vectors of singular values that are small but no round-off, and right vectors of all that are small; none if there are none
    /// of the first.
    fn small(&mut self, q: &[f64]) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        let g = self.metric_rows(q);
        if are_above(&g, &self.metric, SMALL[1]) {
            return None;
        }
        // redundant rows have values of round-off; the others may be large
        let part = |of: &Rows| SMALL[1] * g.most(&self.metric) / of.most(&self.metric);
        let large = |found: Redundant| are_above(found.independent(), &self.metric, part(found.independent()));
        if Redundant::new(&g, &self.metric, SMALL[0]).is_some_and(large) {
            return None;
        }
        let g = scaled(&g, &self.metric);
        let (rows, nv) = g.shape();
        let svd = Svd::new(&g.resize(rows.max(nv), nv, 0.0));
        let largest = svd.largest();
        let between: Vec<usize> = (0..nv).filter(|&k| svd.values[k] > SMALL[0] * largest && svd.values[k] < SMALL[1] * largest).collect();
        let below: Vec<usize> = (0..nv).filter(|&k| svd.values[k] < SMALL[1] * largest).collect();
        let l = DMatrix::from_fn(rows, between.len(), |i, k| svd.u[(i, between[k])]);
        let u = DMatrix::from_fn(nv, below.len(), |i, k| svd.v[(i, below[k])]);
        (!between.is_empty()).then_some((l, u))
    }

    /// Rows but those of drivers at a position, in rad and sizes.
    fn metric_rows(&mut self, q: &[f64]) -> Rows {
        self.evaluate(q);
        self.scaled(&self.undriven()).0
    }

    /// A step of Newton's method.
    fn towards(&mut self, q: &[f64], l: &DMatrix<f64>, u: &DMatrix<f64>) -> Option<Vec<f64>> {
        let nv = self.metric.len();
        let value = |system: &mut Self, q: &[f64]| {
            let rows = system.metric_rows(q);
            l.transpose() * scaled(&rows, &system.metric) * u
        };
        let mut slopes = Vec::with_capacity(nv);
        for k in 0..nv {
            let mut sides = [1.0, -1.0].map(|side| {
                let mut way = vec![0.0; nv];
                way[k] = side * STEP / self.metric[k].sqrt();
                let mut at = q.to_vec();
                self.dynamics.mechanism.retract(&mut at, &way);
                value(self, &at)
            });
            let behind = std::mem::take(&mut sides[1]);
            slopes.push((std::mem::take(&mut sides[0]) - behind) * (0.5 * self.metric[k].sqrt() / STEP));
        }
        let now = value(self, q);
        let (mut r, mut jacobian) = (Vec::new(), Rows::default());
        self.hard(&mut r, &mut jacobian);
        for (i, x) in now.iter().enumerate() {
            r.push(*x);
            jacobian.push(slopes.iter().map(|slope| slope.as_slice()[i]).enumerate());
        }
        r.iter_mut().for_each(|r| *r = -*r);
        let step = step(1e-7, &jacobian, &r, &self.metric, 0.0);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }
}
