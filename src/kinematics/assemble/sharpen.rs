//! Positions next to a singular one that rounding keeps from it: where rows lose rank, a gap of 1e-12 leaves the way open by 1e-6.
//!
//! With l and u the left and right vectors of the small singular values of G, the singular position is where lᵀG u = 0 beside Φ = 0: by
//! Newton's method, ∂(lᵀG u)/∂q by differences. If that is as near as rounding explains, the start is meant to be it.

use super::close::{CONVERGED, System};
use super::metric::norm;
use crate::geometry::Space;
use crate::numerics::least_squares::shortest_beyond;
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
        let (mut r, mut jacobian) = (Vec::new(), Vec::new());
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
        let (rows, nv) = g.shape();
        if least_singular_value(&g) > SMALL[1] * g.norm() {
            return None;
        }
        let svd = Svd::new(&g.resize(rows.max(nv), nv, 0.0));
        let largest = svd.largest();
        let between: Vec<usize> = (0..nv).filter(|&k| svd.values[k] > SMALL[0] * largest && svd.values[k] < SMALL[1] * largest).collect();
        let below: Vec<usize> = (0..nv).filter(|&k| svd.values[k] < SMALL[1] * largest).collect();
        let l = DMatrix::from_fn(rows, between.len(), |i, k| svd.u[(i, between[k])]);
        let u = DMatrix::from_fn(nv, below.len(), |i, k| svd.v[(i, below[k])]);
        (!between.is_empty()).then_some((l, u))
    }

    /// Rows but those of drivers at a position, in rad and sizes and units of the metric.
    fn metric_rows(&mut self, q: &[f64]) -> DMatrix<f64> {
        self.evaluate(q);
        let rows = self.undriven();
        let (a, _) = self.scaled(&rows);
        let nv = self.metric.len();
        DMatrix::from_fn(rows.len(), nv, |i, k| a[i * nv + k] / self.metric[k].sqrt())
    }

    /// A step of Newton's method.
    fn towards(&mut self, q: &[f64], l: &DMatrix<f64>, u: &DMatrix<f64>) -> Option<Vec<f64>> {
        let nv = self.metric.len();
        let value = |system: &mut Self, q: &[f64]| l.transpose() * system.metric_rows(q) * u;
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
        let (mut r, mut jacobian) = (Vec::new(), Vec::new());
        self.hard(&mut r, &mut jacobian);
        for (i, x) in now.iter().enumerate() {
            r.push(*x);
            jacobian.extend(slopes.iter().map(|slope| slope.as_slice()[i]));
        }
        r.iter_mut().for_each(|r| *r = -*r);
        let step = shortest_beyond(1e-7, &jacobian, &r, &self.metric, 0.0);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }
}

/// A bound from below of the singular values of a matrix, σ ≥ 1/‖R⁻¹‖_F with A = Q R or Aᵀ = Q R: a small part of the work that the
/// values themselves take. 0 if R is singular.
fn least_singular_value(a: &DMatrix<f64>) -> f64 {
    let r = if a.nrows() < a.ncols() { a.transpose().qr().unpack_r() } else { a.clone().qr().unpack_r() };
    let n = r.ncols();
    if n == 0 || (0..n).any(|i| r[(i, i)] == 0.0) {
        return 0.0;
    }
    r.solve_upper_triangular(&DMatrix::identity(n, n)).map_or(0.0, |inverse| inverse.norm().recip())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_values_are_bounded_from_below() {
        for (rows, columns) in [(4, 7), (7, 4), (5, 5)] {
            let a = DMatrix::from_fn(rows, columns, |i, k| ((3 * i + 5 * k * k + i * k) as f64).sin());
            let least = Svd::new(&a).values.into_iter().fold(f64::INFINITY, f64::min);
            let bound = least_singular_value(&a);
            assert!(bound <= least && bound > 0.3 * least, "{bound} {least}");
        }
        assert_eq!(least_singular_value(&DMatrix::zeros(2, 3)), 0.0);
    }
}
