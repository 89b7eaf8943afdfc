//! SE(2): the plane. A rotation keeps its angle, so that angles of bodies are sums along the tree and never wrap.

use super::Space;
use crate::scalar::Scalar;
use nalgebra::Vector2;
use std::marker::PhantomData;

/// The plane z = 0 on the scalar `S`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Planar<S>(PhantomData<S>);

/// A rotation in the plane: cosine, sine and the unwrapped angle, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn<S> {
    /// cos of the angle.
    pub c: S,
    /// sin of the angle.
    pub s: S,
    /// The angle, summed and never wrapped, rad.
    pub angle: S,
}

impl<S: Scalar> Space for Planar<S> {
    type S = S;
    type Lift<D: Scalar> = Planar<D>;
    type Vector = Vector2<S>;
    type Spin = S;
    type Tensor = S;
    type Rotation = Turn<S>;
    const VECTOR: usize = 2;
    const SPIN: usize = 1;

    fn vector(x: &[f64]) -> Self::Vector {
        let at = |i: usize| S::constant(x.get(i).copied().unwrap_or(0.0));
        Vector2::new(at(0), at(1))
    }
    #[inline(always)]
    fn from_components(x: [S; 3]) -> Self::Vector {
        Vector2::new(x[0], x[1])
    }
    #[inline]
    fn component(v: Self::Vector, axis: usize) -> S {
        v.get(axis).copied().unwrap_or_default()
    }
    fn spin(x: [f64; 3]) -> S {
        S::constant(x[2])
    }
    #[inline]
    fn spin_component(w: S, axis: usize) -> S {
        if axis == 2 { w } else { S::default() }
    }
    fn tensor(i: [f64; 6]) -> S {
        S::constant(i[2])
    }
    #[inline(always)]
    fn dot(a: Self::Vector, b: Self::Vector) -> S {
        a.x * b.x + a.y * b.y
    }
    #[inline(always)]
    fn dot_spin(a: S, b: S) -> S {
        a * b
    }
    #[inline(always)]
    fn turn(w: S, r: Self::Vector) -> Self::Vector {
        Vector2::new(-(w * r.y), w * r.x)
    }
    #[inline(always)]
    fn moment(r: Self::Vector, f: Self::Vector) -> S {
        r.x * f.y - r.y * f.x
    }
    #[inline(always)]
    fn cross_spin(_: S, _: S) -> S {
        S::default()
    }
    #[inline(always)]
    fn apply(i: S, w: S) -> S {
        i * w
    }
    #[inline(always)]
    fn carry(_: Turn<S>, i: S) -> S {
        i
    }
    #[inline(always)]
    fn steiner(m: S, c: Self::Vector) -> S {
        m * (c.x * c.x + c.y * c.y)
    }
    fn identity() -> Turn<S> {
        Turn { c: S::one(), s: S::zero(), angle: S::zero() }
    }
    #[inline(always)]
    fn multiply(a: Turn<S>, b: Turn<S>) -> Turn<S> {
        Turn { c: a.c * b.c - a.s * b.s, s: a.s * b.c + a.c * b.s, angle: a.angle + b.angle }
    }
    #[inline]
    fn inverse(r: Turn<S>) -> Turn<S> {
        Turn { c: r.c, s: -r.s, angle: -r.angle }
    }
    #[inline(always)]
    fn rotate(r: Turn<S>, v: Self::Vector) -> Self::Vector {
        Vector2::new(r.c * v.x - r.s * v.y, r.s * v.x + r.c * v.y)
    }
    #[inline(always)]
    fn rotate_spin(_: Turn<S>, w: S) -> S {
        w
    }
    #[inline(always)]
    fn hinge(axis: S, q: S) -> Turn<S> {
        let angle = axis * q;
        let (s, c) = angle.sin_cos();
        Turn { c, s, angle }
    }
    fn quaternion(q: [S; 4]) -> Turn<S> {
        let half = q[3].atan2(q[0]);
        Self::hinge(S::one(), half + half)
    }
    #[inline(always)]
    fn nudge(r: Turn<S>, w: S) -> Turn<S> {
        Turn { c: r.c - r.s * w, s: r.s + r.c * w, angle: r.angle + w }
    }
    #[inline(always)]
    fn angle(r: Turn<S>) -> S {
        r.angle
    }
    fn entry(r: Turn<S>, i: usize, k: usize) -> S {
        match (i, k) {
            (0, 0) | (1, 1) => r.c,
            (0, 1) => -r.s,
            (1, 0) => r.s,
            (2, 2) => S::one(),
            _ => S::zero(),
        }
    }
    fn rotation(matrix: &[[f64; 3]; 3], angle: f64) -> Turn<S> {
        Turn { c: S::constant(matrix[0][0]), s: S::constant(matrix[1][0]), angle: S::constant(angle) }
    }
    fn lift_tensor<D: Scalar>(i: S) -> D {
        D::constant(i.value())
    }
}
