//! Norms of errors: what a step is judged by.
//!
//! They do not know where the origin is, nor how fast all bodies move together: errors of q count in sizes of the mechanism, errors of
//! v relative to the speeds that are left when bodies that may all be shifted together have their common velocity taken away. What
//! the rounding of far coordinates leaves in an error no step makes smaller: it bounds the tolerance from below.

use super::Engine;
use crate::State;

/// Round-off of coordinates in units of ε |q|: formulas over several steps add as much.
const ROUNDED: f64 = 4.0;

impl Engine {
    /// Norm of an error, 1 at the tolerance: root mean square of e_q/(tol·size_q), e_v/(tol·(size_v + |v|)), e_z/(tol·(size_z + |z|)).
    pub fn norm(&self, at: &State, e_q: &[f64], e_v: &[f64], e_z: &[f64]) -> f64 {
        let q: f64 = e_q.iter().zip(&self.size_q).map(|(e, s)| (e / s).powi(2)).sum();
        self.with_rates(at, q, e_q.len(), e_v, e_z) / self.tolerance().max(ROUNDED * self.rounding(&at.q))
    }

    /// Root mean square of a displacement (nv) and a change of velocity (nv) as Newton's method sees them, 1 at the tolerance.
    pub fn step_norm(&self, at: &State, d: &[f64], e_v: &[f64], e_z: &[f64]) -> f64 {
        let q: f64 = d.iter().zip(&self.size_v).map(|(e, s)| (e / s).powi(2)).sum();
        self.with_rates(at, q, d.len(), e_v, e_z) / self.tolerance()
    }

    /// Root mean square of a sum of squares `q` of `count` numbers and of errors of v and z in their units.
    fn with_rates(&self, at: &State, q: f64, count: usize, e_v: &[f64], e_z: &[f64]) -> f64 {
        let part = |k: usize, speed: f64| (e_v[k] / (self.size_v[k] + speed.abs())).powi(2);
        let mut v: f64 = at.v.iter().enumerate().map(|(k, v)| if self.shares[k] { 0.0 } else { part(k, *v) }).sum();
        self.shared(&at.v, |k, speed| v += part(k, speed));
        let z: f64 = e_z.iter().zip(&at.z).zip(&self.size_z).map(|((e, z), size)| (e / (size + z.abs())).powi(2)).sum();
        let count = count + e_v.len() + e_z.len();
        ((q + v + z) / count.max(1) as f64).sqrt()
    }

    /// Calls `put(k, speed)` for each velocity that shares in a common translation, with what is left of it without that.
    pub fn shared(&self, v: &[f64], mut put: impl FnMut(usize, f64)) {
        for common in &self.common {
            let mut sums = [0.0; 3];
            for (k, along) in common {
                sums.iter_mut().zip(along).for_each(|(sum, t)| *sum += t * v[*k]);
            }
            for (k, along) in common {
                put(*k, v[*k] - along.iter().zip(sums).map(|(t, sum)| t * sum).sum::<f64>());
            }
        }
    }

    /// Rounding ε |q| of the coordinates (nq) that are far from 0, in units of their sizes.
    pub fn rounding(&self, q: &[f64]) -> f64 {
        f64::EPSILON * q.iter().zip(&self.size_q).fold(0.0, |m, (q, s)| f64::max(m, q.abs() / s - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use crate::engine::shape::Shape;
    use crate::engine::{Control, Engine};
    use crate::{Dims, Pattern, State};

    /// Two bodies along x and y that move together, and a turn.
    fn engine() -> Engine {
        let dims = Dims { q: 5, v: 5, ..Dims::default() };
        let half = 0.5_f64.sqrt();
        let common = (0..4).map(|k| (k, [if k % 2 == 0 { half } else { 0.0 }, if k % 2 == 1 { half } else { 0.0 }, 0.0]));
        let pattern = Pattern { common: vec![common.collect()], ..Pattern::dense(dims) };
        Engine::new(&Shape { pattern, dims }, Control::Tolerance(1e-6))
    }

    #[test]
    fn a_common_velocity_and_a_common_place_change_no_norm() {
        let engine = engine();
        let dims = engine.dims;
        let still = State { v: vec![1.0, -2.0, 3.0, 0.5, 7.0], ..State::new(dims) };
        let mut moving = still.clone();
        for (k, (v, q)) in moving.v.iter_mut().zip(&mut moving.q).take(4).enumerate() {
            *v += [1000.0, -400.0][k % 2];
            *q += 1e6;
        }
        let (e_q, e_v) = ([1e-6, 2e-6, 0.0, -1e-6, 3e-7], [1e-5, -1e-5, 2e-5, 0.0, 4e-5]);
        let norm = |state: &State| [engine.norm(state, &e_q, &e_v, &[]), engine.step_norm(state, &e_q, &e_v, &[])];
        for (still, moving) in norm(&still).into_iter().zip(norm(&moving)) {
            assert!((still / moving - 1.0).abs() < 1e-12, "{still} {moving}");
        }
    }

    #[test]
    fn the_rounding_of_far_coordinates_counts_as_no_error() {
        let engine = engine();
        let far = State { q: vec![1e12, 0.0, 0.0, 0.0, 0.0], ..State::new(engine.dims) };
        let rounding = 1e12 * f64::EPSILON;
        assert!(engine.norm(&far, &[rounding, 0.0, 0.0, 0.0, 0.0], &[0.0; 5], &[]) < 0.1);
    }
}
