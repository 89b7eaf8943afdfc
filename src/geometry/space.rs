//! The plane and space as one: what a group of rigid motions offers.

use crate::scalar::Scalar;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// What vectors, spins and tensors have in common: a linear space over `S`.
pub trait Linear<S>:
    Copy
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + Mul<S, Output = Self>
    + Send
    + Sync
    + 'static
{
}
impl<S, T> Linear<S> for T where
    T: Copy
        + Debug
        + Default
        + PartialEq
        + Add<Output = T>
        + Sub<Output = T>
        + Neg<Output = T>
        + AddAssign
        + Mul<S, Output = T>
        + Send
        + Sync
        + 'static
{
}

/// A Euclidean space with its rotations: the primitives from which twists, wrenches and inertias are built.
pub trait Space: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// The number type.
    type S: Scalar;
    /// The same space on another number type.
    type Lift<D: Scalar>: Space<S = D>;
    /// A position, velocity or force: 2 or 3 components.
    type Vector: Linear<Self::S>;
    /// An angular velocity or moment: 1 or 3 components.
    type Spin: Linear<Self::S>;
    /// A rotational inertia.
    type Tensor: Linear<Self::S>;
    /// A rotation.
    type Rotation: Copy + Debug + PartialEq + Send + Sync + 'static;

    /// Number of components of a vector: 2 or 3.
    const VECTOR: usize;
    /// Number of components of a spin: 1 or 3.
    const SPIN: usize;

    /// A vector from its first [`Self::VECTOR`] components (missing ones are 0).
    fn vector(x: &[f64]) -> Self::Vector;
    /// A vector from its components; the plane takes the first two.
    fn from_components(x: [Self::S; 3]) -> Self::Vector;
    /// Component of a vector; 0 beyond the last.
    fn component(v: Self::Vector, axis: usize) -> Self::S;
    /// The spin with the given world components (x, y, z); the plane keeps z.
    fn spin(x: [f64; 3]) -> Self::Spin;
    /// World component of a spin (0 x, 1 y, 2 z); the plane has z alone.
    fn spin_component(w: Self::Spin, axis: usize) -> Self::S;
    /// A tensor from Ixx, Iyy, Izz, Ixy, Ixz, Iyz (entries of the matrix: products of inertia carry their minus); the plane keeps Izz.
    fn tensor(i: [f64; 6]) -> Self::Tensor;

    /// a · b.
    fn dot(a: Self::Vector, b: Self::Vector) -> Self::S;
    /// a · b of spins.
    fn dot_spin(a: Self::Spin, b: Self::Spin) -> Self::S;
    /// ω × r: what a rotation does to a vector.
    fn turn(w: Self::Spin, r: Self::Vector) -> Self::Vector;
    /// r × f: the moment of a force.
    fn moment(r: Self::Vector, f: Self::Vector) -> Self::Spin;
    /// ω × m of spins; 0 in the plane.
    fn cross_spin(w: Self::Spin, m: Self::Spin) -> Self::Spin;
    /// I ω.
    fn apply(i: Self::Tensor, w: Self::Spin) -> Self::Spin;
    /// R I Rᵀ.
    fn carry(r: Self::Rotation, i: Self::Tensor) -> Self::Tensor;
    /// m (c² E − c cᵀ): what a mass at c adds about the origin (Steiner).
    fn steiner(m: Self::S, c: Self::Vector) -> Self::Tensor;

    /// No rotation.
    fn identity() -> Self::Rotation;
    /// R₁ R₂.
    fn multiply(a: Self::Rotation, b: Self::Rotation) -> Self::Rotation;
    /// R⁻¹ = Rᵀ.
    fn inverse(r: Self::Rotation) -> Self::Rotation;
    /// R v.
    fn rotate(r: Self::Rotation, v: Self::Vector) -> Self::Vector;
    /// R ω.
    fn rotate_spin(r: Self::Rotation, w: Self::Spin) -> Self::Spin;
    /// Rotation by the angle q, rad, about a unit axis.
    fn hinge(axis: Self::Spin, q: Self::S) -> Self::Rotation;
    /// Rotation of the quaternion (w, x, y, z) of any length but 0 (homogeneous of degree 0).
    fn quaternion(q: [Self::S; 4]) -> Self::Rotation;
    /// (E + ω~) R: a rotation turned by a vector so small that its square is below round-off, rad.
    fn nudge(r: Self::Rotation, w: Self::Spin) -> Self::Rotation;
    /// Angle of a rotation: unwrapped in the plane; 0 in space, where angles belong to joints.
    fn angle(r: Self::Rotation) -> Self::S;
    /// Entry (i, k) of the rotation as a 3×3 matrix.
    fn entry(r: Self::Rotation, i: usize, k: usize) -> Self::S;
    /// A rotation from a 3×3 matrix of numbers (row by row), for constants of a mechanism.
    fn rotation(matrix: &[[f64; 3]; 3], angle: f64) -> Self::Rotation;

    /// The same numbers on another scalar (derivatives zero): vectors.
    fn lift_vector<D: Scalar>(v: Self::Vector) -> <Self::Lift<D> as Space>::Vector {
        let x: [f64; 3] = std::array::from_fn(|i| if i < Self::VECTOR { Self::component(v, i).value() } else { 0.0 });
        Self::Lift::<D>::vector(&x[..Self::VECTOR])
    }
    /// The same for spins.
    fn lift_spin<D: Scalar>(w: Self::Spin) -> <Self::Lift<D> as Space>::Spin {
        Self::Lift::<D>::spin(std::array::from_fn(|i| Self::spin_component(w, i).value()))
    }
    /// The same for rotations.
    fn lift_rotation<D: Scalar>(r: Self::Rotation) -> <Self::Lift<D> as Space>::Rotation {
        let matrix = std::array::from_fn(|i| std::array::from_fn(|k| Self::entry(r, i, k).value()));
        Self::Lift::<D>::rotation(&matrix, Self::angle(r).value())
    }
    /// The same for tensors.
    fn lift_tensor<D: Scalar>(i: Self::Tensor) -> <Self::Lift<D> as Space>::Tensor;
}

/// Unit vector along a world axis.
#[must_use]
pub fn basis<G: Space>(axis: usize) -> G::Vector {
    let mut e = [0.0; 3];
    e[axis] = 1.0;
    G::vector(&e[..G::VECTOR])
}
