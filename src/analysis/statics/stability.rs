//! Stability of an equilibrium: the eigenvalues of the tangent stiffness on the motions that the constraints leave.
//!
//! With forces that have an energy, H is symmetric and is its second derivative: the equilibrium is stable if all eigenvalues are
//! positive (Lagrange and Dirichlet), and each negative one is a motion that falls. The signs do not depend on the metric
//! (Sylvester). Without an energy (H not symmetric) the real parts decide, as they do for slow, overdamped motion D ẏ = −H y; a
//! flutter is not seen by them.

use super::pose::Pose;
use nalgebra::linalg::{Schur, SymmetricEigen};
use nalgebra::{DMatrix, DVector};

/// Part of the stiffness that acts below which an eigenvalue counts as zero: an equilibrium with a zero one is found to 1e-5 of
/// its place only, since the force is flat there.
const ZERO: f64 = 1e-8;
/// Part of H that may be unsymmetric by round-off.
const SYMMETRIC: f64 = 1e-9;
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
    /// Whether the forces have an energy, as far as can be seen here.
    pub(super) symmetric: bool,
    /// Stiffness of the order of those that act.
    pub(super) scale: f64,
}

impl Stability {
    /// Of a pose with its tangent stiffness.
    pub(super) fn new(pose: &Pose, h: &DMatrix<f64>) -> Self {
        let n = h.nrows();
        let scale = pose.stiffness + h.amax();
        let symmetric = (h - h.transpose()).amax() <= SYMMETRIC * scale;
        let mut found = Self { values: Vec::new(), falls: DVector::zeros(n), negative: 0, zero: 0, symmetric, scale };
        if n == 0 {
            return found;
        }
        let mean = (h + h.transpose()) * 0.5;
        if let Some(eigen) = SymmetricEigen::try_new(mean, f64::EPSILON, SWEEPS) {
            found.falls = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
            found.values = eigen.eigenvalues.as_slice().to_vec();
        }
        if !symmetric && let Some(schur) = Schur::try_new(h.clone(), f64::EPSILON, SWEEPS) {
            found.values = schur.complex_eigenvalues().iter().map(|x| x.re).collect();
        }
        found.values.sort_by(f64::total_cmp);
        found.negative = found.values.iter().filter(|x| **x < -ZERO * scale).count();
        found.zero = found.values.iter().filter(|x| x.abs() <= ZERO * scale).count();
        found
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
