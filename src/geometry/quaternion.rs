//! Unit quaternions of bodies, carried along the tree.
//!
//! A rotation has two of them, Q and −Q. That of a body is the product of those of its steps, with half angles, so that it is a
//! smooth function of the coordinates and never jumps, whatever the body turns through; which of the two is meant is a mode.

use super::Space;
use crate::scalar::Scalar;

/// A quaternion (w, x, y, z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion<S>(pub [S; 4]);

impl<S: Scalar> Quaternion<S> {
    /// No rotation.
    #[must_use]
    pub fn identity() -> Self {
        Self([1.0, 0.0, 0.0, 0.0].map(S::constant))
    }

    /// That of a constant rotation, its largest component positive (Shepperd 1978, "Quaternion from rotation matrix").
    #[must_use]
    pub fn of_rotation<G: Space<S = S>>(r: G::Rotation) -> Self {
        let m = |i: usize, k: usize| G::entry(r, i, k).value();
        let trace = m(0, 0) + m(1, 1) + m(2, 2);
        let largest = (0..3).fold(None, |best, k| match best {
            Some(best) if m(best, best) >= m(k, k) => Some(best),
            _ if m(k, k) > trace => Some(k),
            best => best,
        });
        let four = |x: f64| 2.0 * (1.0 + x).max(0.0).sqrt();
        let q = match largest {
            None => {
                let s = four(trace);
                [0.25 * s, (m(2, 1) - m(1, 2)) / s, (m(0, 2) - m(2, 0)) / s, (m(1, 0) - m(0, 1)) / s]
            }
            Some(i) => {
                let (k, l) = ((i + 1) % 3, (i + 2) % 3);
                let s = four(m(i, i) - m(k, k) - m(l, l));
                let mut q = [0.0; 4];
                q[0] = (m(l, k) - m(k, l)) / s;
                q[1 + i] = 0.25 * s;
                q[1 + k] = (m(k, i) + m(i, k)) / s;
                q[1 + l] = (m(l, i) + m(i, l)) / s;
                q
            }
        };
        Self(q.map(S::constant))
    }

    /// Rotation by the angle `q`, rad, about a unit axis.
    #[must_use]
    pub fn hinge<G: Space<S = S>>(axis: G::Spin, q: S) -> Self {
        let (s, c) = q.scale(0.5).sin_cos();
        let along = |k: usize| G::spin_component(axis, k) * s;
        Self([c, along(0), along(1), along(2)])
    }

    /// That of length 1.
    #[must_use]
    pub fn unit(q: [S; 4]) -> Self {
        let [w, x, y, z] = q;
        let k = S::constant(1.0) / (w * w + x * x + y * y + z * z).sqrt();
        Self(q.map(|x| x * k))
    }

    /// The inverse rotation.
    #[must_use]
    pub fn inverse(self) -> Self {
        let [w, x, y, z] = self.0;
        Self([w, -x, -y, -z])
    }

    /// Q₁ ∘ Q₂.
    #[must_use]
    pub fn multiply(self, other: Self) -> Self {
        let ([w, x, y, z], [a, b, c, d]) = (self.0, other.0);
        Self([w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c, w * c + y * a + z * b - x * d, w * d + z * a + x * c - y * b])
    }

    /// −Q if the mode `sign` is not 0.
    #[must_use]
    pub fn signed(self, sign: i32) -> Self {
        if sign == 0 { self } else { Self(self.0.map(|x| -x)) }
    }

    /// The mode of its sign where it is to be the quaternion with w ≥ 0; of a half turn that whose first other component is positive.
    #[must_use]
    pub fn sign(self) -> i32 {
        /// w below which a rotation counts as a half turn: an angle of 2e-9 rad beside it.
        const HALF_TURN: f64 = 1e-9;
        let first = self.0.iter().find(|x| x.value().abs() > HALF_TURN);
        i32::from(first.is_some_and(|x| x.value() < 0.0))
    }

    /// n with Q̇_k = n · ω for ω in world axes: the parts of ½ (0, ω) ∘ Q.
    #[must_use]
    pub fn slope(self, component: usize) -> [S; 3] {
        let [w, x, y, z] = self.0;
        let twice = match component {
            0 => [-x, -y, -z],
            1 => [w, z, -y],
            2 => [-z, w, x],
            _ => [y, -x, w],
        };
        twice.map(|x| x.scale(0.5))
    }
}
