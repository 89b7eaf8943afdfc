//! Vectors of the plane.

pub(crate) type Vector = [f64; 2];

#[inline]
pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

#[inline]
pub(crate) fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

#[inline]
pub(crate) fn scale(a: Vector, k: f64) -> Vector {
    [a[0] * k, a[1] * k]
}

#[inline]
pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// a × b, the component out of the plane.
#[inline]
pub(crate) fn cross(a: Vector, b: Vector) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// `a` turned by a quarter, counter-clockwise.
#[inline]
pub(crate) fn normal(a: Vector) -> Vector {
    [-a[1], a[0]]
}

#[inline]
pub(crate) fn size(a: Vector) -> f64 {
    dot(a, a).sqrt()
}
