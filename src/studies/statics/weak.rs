//! Whether a stiffness far below the largest one is what it says, or round-off.
//!
//! Such an eigenvalue λ of the tangent stiffness may be what rounding has left of larger ones, or belong to a force that grows with a
//! higher power of the way, as that of a spring across a straight bar: there the place is known to some digits only, and λ with it. It
//! counts where forces beside the equilibrium follow it to both sides,
//!
//! ```text
//! f(δ)·y ≈ −λδ,   f(−δ)·y ≈ λδ,
//! ```
//!
//! y being its motion, of unit length in the metric, and δ so long a way along it that these forces are far above their round-off.

use super::pose::Pose;
use super::rest::Rest;
use super::sinking::{Sinking, Stand};
use crate::geometry::Space;
use grashof_solvers::System;
use nalgebra::DVector;

/// Forces beside the equilibrium, by what is unbalanced in it or lost to round-off.
const CLEAR: f64 = 1e3;
/// Least and longest way, rad or sizes of the mechanism: where all forces are 0 any way is above their round-off.
const LEAST: f64 = 1e-6;
const LONGEST: f64 = 1e-3;
/// Part of λδ by which a force may differ from it.
const FOLLOWS: f64 = 0.2;

/// Whether an eigenvalue λ is that of the forces; `unbalanced` is what the equilibrium leaves of forces of the size `grain`, both in the
/// inverse of the metric. `length` is that of a way along its motion, rad or sizes, and `force` the force along the motion behind a way.
fn is_followed(value: f64, unbalanced: f64, grain: f64, length: f64, mut force: impl FnMut(f64) -> Option<f64>) -> bool {
    let way = f64::max(CLEAR * unbalanced.max(f64::EPSILON * grain) / value.abs(), LEAST / length);
    if value == 0.0 || !(way > 0.0 && way * length <= LONGEST) {
        return false;
    }
    [way, -way].into_iter().all(|way| force(way).is_some_and(|force| (force + value * way).abs() <= FOLLOWS * (value * way).abs()))
}

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// Whether an eigenvalue of the tangent stiffness at an equilibrium, with its motion (n), is that of the forces beside it.
    pub(super) fn is_followed(&mut self, pose: &Pose, value: f64, motion: &DVector<f64>) -> bool {
        let x = &pose.basis * motion;
        let weighted = DVector::from_iterator(x.len(), x.iter().zip(&self.system.pattern().metric).map(|(x, d)| x * d));
        let length = self.measure(&x);
        let force = |way: f64| {
            let beside = self.moved(pose, (&x * way).as_slice()).ok()?;
            Some(beside.force.dot(&(beside.basis.transpose() * &weighted)))
        };
        is_followed(value, pose.force.norm(), pose.grain, length, force)
    }
}

impl<G> Sinking<'_, G>
where
    G: Space<S = f64>,
{
    /// The same of a mechanism of many bodies, with its motion (nv).
    pub(super) fn is_followed(&mut self, stand: &Stand, value: f64, motion: &[f64]) -> bool {
        let length = self.measure(motion);
        let force = |way: f64| {
            let beside = self.moved(stand, &motion.iter().map(|x| x * way).collect::<Vec<f64>>()).ok()?;
            Some(beside.net.iter().zip(motion).map(|(f, x)| f * x).sum())
        };
        is_followed(value, stand.force, stand.grain, length, force)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_soft_spring_is_followed_and_a_third_power_is_not() {
        let noise = 1e-12;
        let of = |value: f64, force: &dyn Fn(f64) -> f64| is_followed(value, noise, 1.0, 1.0, |way| Some(force(way)));
        assert!(of(1e-6, &|x| -1e-6 * x + noise));
        assert!(of(-1e-6, &|x| 1e-6 * x - noise));
        // found where the force is round-off
        let off = (noise / 4.0_f64).cbrt();
        assert!(!of(12.0 * off * off, &|x| -4.0 * (x + off).powi(3)));
        assert!(!of(1e-10, &|_| 0.0));
        assert!(!of(0.0, &|_| 0.0));
        // a start without any force
        assert!(is_followed(1e-9, 0.0, 0.0, 1.0, |way| Some(-1e-9 * way)));
    }
}
