//! Rotations in space as vectors along their axes, rad, and how these change.
//!
//! For R(ε) = R exp(ε δ~) and θ the rotation vector of R, dθ/dε = J⁻¹(θ) δ with
//! J⁻¹ = E + ½ θ~ + (1 − ½φ cot ½φ)/φ² θ~², φ = |θ| (Chirikjian, Stochastic Models, Information Theory, and Lie Groups 2 (2012),
//! section 10.6: the right Jacobian).

use crate::geometry::{Motion, Space};
use crate::mechanism::Orientation;
use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// A rotation as a matrix.
pub(super) fn matrix<G: Space<S = f64>>(r: G::Rotation) -> Matrix3<f64> {
    Matrix3::from_fn(|i, k| G::entry(r, i, k))
}

/// A rotation matrix as a quaternion of length 1.
pub(super) fn quaternion(r: &Matrix3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*r))
}

/// Rotation vector θ, |θ| ≤ π.
pub(super) fn vector(r: &Matrix3<f64>) -> Vector3<f64> {
    quaternion(r).scaled_axis()
}

/// J⁻¹(θ).
pub(super) fn slope(theta: &Vector3<f64>) -> Matrix3<f64> {
    let (phi, cross) = (theta.norm(), theta.cross_matrix());
    let k = if phi < 1e-3 { 1.0 / 12.0 } else { (1.0 - 0.5 * phi / (0.5 * phi).tan()) / (phi * phi) };
    Matrix3::identity() + cross * 0.5 + cross * cross * k
}

/// Angular velocity of a twist.
pub(super) fn spin<G: Space<S = f64>>(twist: &Motion<G>) -> Vector3<f64> {
    Vector3::from_fn(|i, _| G::spin_component(twist.w, i))
}

/// A rotation seen from one that is asked for: its angle about the asked axis, as near to `angle` as whole turns allow, and by how much
/// it turns beside that axis, rad. The rotation is the asked one if they are `angle` and 0.
pub(super) fn orientation<G: Space<S = f64>>(asked: &Orientation, angle: f64, found: G::Rotation) -> (f64, f64) {
    let unit = quaternion(&matrix::<G>(found));
    let axis = Unit::new_unchecked(Vector3::from(asked.axis));
    let about = 2.0 * unit.imag().dot(&axis).atan2(unit.w);
    let beside = (UnitQuaternion::from_axis_angle(&axis, about).inverse() * unit).angle();
    (about + TAU * ((angle - about) / TAU).round(), beside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slope_is_that_of_the_rotation_vector() {
        for theta in [[0.0, 0.0, 0.0], [1e-5, 2e-5, -1e-5], [0.3, -0.2, 0.9], [2.0, 1.5, -1.0], [0.0, 3.1, 0.0]] {
            let theta = Vector3::from(theta);
            let at = |d: &Vector3<f64>| vector((Rotation3::new(theta) * Rotation3::new(*d)).matrix());
            for k in 0..3 {
                let mut d = Vector3::zeros();
                d[k] = 1e-5;
                let found = (at(&d) - at(&-d)) / 2e-5;
                let right = slope(&theta).column(k).into_owned();
                assert!((found - right).norm() < 1e-8, "{theta}: {found} {right}");
            }
        }
    }
}
