//! SE(3): space, rotations as matrices.

use super::Space;
use crate::scalar::Scalar;
use nalgebra::{Matrix3, Vector3};
use std::marker::PhantomData;

/// Space on the scalar `S`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spatial<S>(PhantomData<S>);

impl<S: Scalar> Space for Spatial<S> {
    type S = S;
    type Lift<D: Scalar> = Spatial<D>;
    type Vector = Vector3<S>;
    type Spin = Vector3<S>;
    type Tensor = Matrix3<S>;
    type Rotation = Matrix3<S>;
    const VECTOR: usize = 3;
    const SPIN: usize = 3;

    fn vector(x: &[f64]) -> Self::Vector {
        let at = |i: usize| S::constant(x.get(i).copied().unwrap_or(0.0));
        Vector3::new(at(0), at(1), at(2))
    }
    #[inline(always)]
    fn from_components(x: [S; 3]) -> Self::Vector {
        Vector3::from(x)
    }
    #[inline]
    fn component(v: Self::Vector, axis: usize) -> S {
        v[axis]
    }
    fn spin(x: [f64; 3]) -> Self::Spin {
        Self::vector(&x)
    }
    #[inline]
    fn spin_component(w: Self::Spin, axis: usize) -> S {
        w[axis]
    }
    fn tensor(i: [f64; 6]) -> Self::Tensor {
        let [xx, yy, zz, xy, xz, yz] = i.map(S::constant);
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
    #[inline(always)]
    fn dot(a: Self::Vector, b: Self::Vector) -> S {
        a.x * b.x + a.y * b.y + a.z * b.z
    }
    #[inline(always)]
    fn dot_spin(a: Self::Spin, b: Self::Spin) -> S {
        Self::dot(a, b)
    }
    #[inline(always)]
    fn turn(w: Self::Spin, r: Self::Vector) -> Self::Vector {
        Vector3::new(w.y * r.z - w.z * r.y, w.z * r.x - w.x * r.z, w.x * r.y - w.y * r.x)
    }
    #[inline(always)]
    fn moment(r: Self::Vector, f: Self::Vector) -> Self::Spin {
        Self::turn(r, f)
    }
    #[inline(always)]
    fn cross_spin(w: Self::Spin, m: Self::Spin) -> Self::Spin {
        Self::turn(w, m)
    }
    #[inline(always)]
    fn apply(i: Self::Tensor, w: Self::Spin) -> Self::Spin {
        i * w
    }
    #[inline(always)]
    fn carry(r: Self::Rotation, i: Self::Tensor) -> Self::Tensor {
        r * i * r.transpose()
    }
    fn steiner(m: S, c: Self::Vector) -> Self::Tensor {
        let (xx, yy, zz) = (m * c.x * c.x, m * c.y * c.y, m * c.z * c.z);
        let (xy, xz, yz) = (-(m * c.x * c.y), -(m * c.x * c.z), -(m * c.y * c.z));
        Matrix3::new(yy + zz, xy, xz, xy, xx + zz, yz, xz, yz, xx + yy)
    }
    fn identity() -> Self::Rotation {
        Matrix3::identity()
    }
    #[inline(always)]
    fn multiply(a: Self::Rotation, b: Self::Rotation) -> Self::Rotation {
        a * b
    }
    #[inline(always)]
    fn inverse(r: Self::Rotation) -> Self::Rotation {
        r.transpose()
    }
    #[inline(always)]
    fn rotate(r: Self::Rotation, v: Self::Vector) -> Self::Vector {
        r * v
    }
    #[inline(always)]
    fn rotate_spin(r: Self::Rotation, w: Self::Spin) -> Self::Spin {
        r * w
    }
    /// R = c E + s u~ + (1 − c) u uᵀ (Rodrigues).
    fn hinge(u: Self::Spin, q: S) -> Self::Rotation {
        let (s, c) = q.sin_cos();
        let k = S::one() - c;
        let (x, y, z) = (u.x, u.y, u.z);
        Matrix3::new(
            c + k * x * x,
            k * x * y - s * z,
            k * x * z + s * y,
            k * x * y + s * z,
            c + k * y * y,
            k * y * z - s * x,
            k * x * z - s * y,
            k * y * z + s * x,
            c + k * z * z,
        )
    }
    /// R of q/|q|, with 2/|q|² in place of 2: poses do not depend on the quaternion's length.
    fn quaternion(q: [S; 4]) -> Self::Rotation {
        let [w, x, y, z] = q;
        let two = S::constant(2.0) / (w * w + x * x + y * y + z * z);
        let one = S::one();
        Matrix3::new(
            one - two * (y * y + z * z),
            two * (x * y - w * z),
            two * (x * z + w * y),
            two * (x * y + w * z),
            one - two * (x * x + z * z),
            two * (y * z - w * x),
            two * (x * z - w * y),
            two * (y * z + w * x),
            one - two * (x * x + y * y),
        )
    }
    fn nudge(r: Self::Rotation, w: Self::Spin) -> Self::Rotation {
        let z = S::zero();
        r + Matrix3::new(z, -w.z, w.y, w.z, z, -w.x, -w.y, w.x, z) * r
    }
    fn angle(_: Self::Rotation) -> S {
        S::zero()
    }
    fn entry(r: Self::Rotation, i: usize, k: usize) -> S {
        r[(i, k)]
    }
    fn rotation(matrix: &[[f64; 3]; 3], _: f64) -> Self::Rotation {
        Matrix3::from_fn(|i, k| S::constant(matrix[i][k]))
    }
    fn lift_tensor<D: Scalar>(i: Self::Tensor) -> Matrix3<D> {
        i.map(|x| D::constant(x.value()))
    }
}
