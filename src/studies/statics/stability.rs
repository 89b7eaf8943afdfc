//! Stability of an equilibrium: the eigenvalues of the tangent stiffness on the motions that the constraints leave.
//!
//! With forces that have an energy, H is symmetric and is its second derivative: the equilibrium is stable if all eigenvalues are
//! positive (Lagrange and Dirichlet), and each negative one is a motion that falls. The signs do not depend on the metric
//! (Sylvester). Without an energy (H not symmetric), with forces that depend on velocities, and with first-order states the poles of
//! the linearised motion decide ([`Stability::by_motion`]). Where these cannot be had, since nothing has mass, the real parts of the
//! eigenvalues of H do, as they do for slow, overdamped motion D ẏ = −H y; a flutter is not seen by them.

use super::pose::Pose;
use super::rest::Position;
use crate::dynamics::{Differentiable, Linearizer, Point};
use crate::geometry::Space;
use crate::kinematics::linear::Linear;
use crate::kinematics::partition::preferred;
use crate::numerics::eigenvalues::eigenvalues;
use nalgebra::linalg::{Schur, SymmetricEigen};
use nalgebra::{Complex, DMatrix, DVector};

/// Part of the stiffness that acts below which an eigenvalue is weak: it counts as zero unless forces follow it (`weak.rs`). An
/// equilibrium with a zero one is found to 1e-5 of its place only, since the force is flat there.
const ZERO: f64 = 1e-8;
/// Part of H that may be unsymmetric by round-off.
const SYMMETRIC: f64 = 1e-9;
/// Part of the fastest pole below which a pole, or the real part of one, is round-off, and part of a pole below which its real part is.
const ROUND_OFF: f64 = 1e-11;
const UNDAMPED: f64 = 1e-8;
/// Part of the fastest pole up to which two that are opposite to each other are a double zero, which is known to half of the digits, and
/// part of them by which they may fail to be opposite.
const DOUBLE: f64 = 1e-7;
const OPPOSITE: f64 = 1e-2;
/// Part of the stiffness that acts below which the square of a pole is round-off.
const SQUARE: f64 = 16.0 * f64::EPSILON;
/// Sweeps of an eigensolver.
const SWEEPS: usize = 10_000;

/// What the tangent stiffness says.
#[derive(Clone, Debug)]
pub(super) struct Stability {
    /// Real parts of the eigenvalues, rising, 1/s².
    pub(super) values: Vec<f64>,
    /// The motion of the lowest one, in the basis of the pose (n).
    pub(super) falls: DVector<f64>,
    /// Motions that fall.
    pub(super) negative: usize,
    /// Motions that nothing holds.
    pub(super) zero: usize,
    /// Weak eigenvalues with their motions in the basis of the pose (n): counted as zero as long as nothing tells more.
    pub(super) weak: Vec<(f64, DVector<f64>)>,
    /// Whether the forces have an energy, as far as can be seen here.
    pub(super) symmetric: bool,
    /// Whether it is that of the linearised motion.
    pub(super) of_motion: bool,
    /// Stiffness of the order of those that act.
    pub(super) scale: f64,
}

impl Stability {
    /// Of a pose with its tangent stiffness.
    pub(super) fn new(pose: &Pose, h: &DMatrix<f64>) -> Self {
        let n = h.nrows();
        let scale = pose.stiffness + h.amax();
        let symmetric = (h - h.transpose()).amax() <= SYMMETRIC * scale;
        let (values, weak, falls) = (Vec::new(), Vec::new(), DVector::zeros(n));
        let mut found = Self { values, falls, negative: 0, zero: 0, weak, symmetric, of_motion: false, scale };
        if n == 0 {
            return found;
        }
        let mean = (h + h.transpose()) * 0.5;
        if let Some(eigen) = SymmetricEigen::try_new(mean, f64::EPSILON, SWEEPS) {
            found.falls = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
            found.values = eigen.eigenvalues.as_slice().to_vec();
            let pairs = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter());
            let weak = pairs.filter(|(x, _)| symmetric && x.abs() <= ZERO * scale);
            found.weak = weak.map(|(x, motion)| (*x, motion.into_owned())).collect();
        }
        if !symmetric && let Some(schur) = Schur::try_new(h.clone(), f64::EPSILON, SWEEPS) {
            found.values = schur.complex_eigenvalues().iter().map(|x| x.re).collect();
        }
        found.values.sort_by(f64::total_cmp);
        found.negative = found.values.iter().filter(|x| **x < -ZERO * scale).count();
        found.zero = found.values.iter().filter(|x| x.abs() <= ZERO * scale).count();
        found
    }

    /// Counts a weak eigenvalue as what it says.
    pub(super) fn take_weak(&mut self, value: f64) {
        self.zero -= 1;
        self.negative += usize::from(value < 0.0);
    }

    /// Judges by the poles of the linearised motion what the stiffness alone does not tell: forces without an energy, and motions
    /// that grow although every position is held. Left as it is where nothing resists, or friction depends on the reactions.
    pub(super) fn by_motion<G>(&mut self, pose: &Pose, mechanism: &Differentiable<G>, metric: &[f64])
    where
        G: Space<S = f64>,
    {
        if !mechanism.pressings.is_empty() {
            return;
        }
        let zeros = vec![0.0; mechanism.nv];
        let Position { q, z, modes, lambda, .. } = &pose.position;
        let point = Point { t: 0.0, q, v: &zeros, z, a: &zeros, lambda, modes };
        let linear = Linear::new(mechanism, &mut Linearizer::new(mechanism), &point, metric);
        let Some(poles) = linear.and_then(|linear| linear.reduce(&preferred(mechanism))).ok().and_then(|r| eigenvalues(&r.a)) else {
            return;
        };
        // without states the square of a pole is a stiffness, which is round-off beside those that act
        let least = if self.symmetric && z.is_empty() { (SQUARE * self.scale).sqrt() } else { 0.0 };
        let (growing, still) = growing_and_still(&poles, least);
        // a state may hold what falls without it
        if self.symmetric && growing <= self.negative && z.is_empty() {
            return;
        }
        self.of_motion = true;
        self.negative = growing;
        self.zero = if self.symmetric { self.zero.min(still) } else { still };
    }

    /// Whether every motion is held.
    pub(super) fn is_stable(&self) -> bool {
        self.negative == 0 && self.zero == 0
    }

    /// The lowest eigenvalue; 0 without freedom.
    pub(super) fn lowest(&self) -> f64 {
        self.values.first().copied().unwrap_or(0.0)
    }
}

/// How many motions grow, one of each pair, and how many poles are zero, as all below `least` are.
fn growing_and_still(poles: &[Complex<f64>], least: f64) -> (usize, usize) {
    let fastest = poles.iter().fold(0.0, |m: f64, p| m.max(p.norm()));
    let still = |i: usize| {
        let p = poles[i];
        let opposite = |(j, q): (usize, &Complex<f64>)| i != j && (p + q).norm() <= OPPOSITE * p.norm();
        p.norm() <= f64::max(ROUND_OFF * fastest, least) || p.norm() <= DOUBLE * fastest && poles.iter().enumerate().any(opposite)
    };
    let grows = |i: usize| {
        let p = poles[i];
        p.im >= 0.0 && p.re > f64::max(ROUND_OFF * fastest, UNDAMPED * p.norm()) && !still(i)
    };
    ((0..poles.len()).filter(|i| grows(*i)).count(), (0..poles.len()).filter(|i| still(*i)).count())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_pole_is_no_zero_and_a_double_zero_is_no_growth() {
        let of = |poles: &[(f64, f64)]| growing_and_still(&poles.iter().map(|&(re, im)| Complex::new(re, im)).collect::<Vec<_>>(), 0.0);
        assert_eq!(of(&[(-2e4, 0.0), (1e-3, 0.0), (-1.0, 30.0), (-1.0, -30.0)]), (1, 0));
        assert_eq!(of(&[(-10.0, 223.0), (-10.0, -223.0), (-1e-5, 0.0)]), (0, 0));
        assert_eq!(of(&[(0.0, 100.0), (0.0, -100.0), (3e-7, 0.0), (-3e-7, 0.0)]), (0, 2));
        assert_eq!(of(&[(1e-9, 100.0), (1e-9, -100.0), (0.1, 2.0), (0.1, -2.0)]), (1, 0));
    }
}
