//! What the mechanics asks of a number.

use std::fmt::Debug;
use std::ops::{AddAssign, MulAssign, Neg, SubAssign};

/// A real number or something that behaves like one (dual numbers and intervals now; lanes and tracing are possible).
///
/// The supertraits are what nalgebra's matrix arithmetic asks for (`Num` brings zero, one and the four operations).
pub trait Scalar:
    Copy + Debug + Default + PartialEq + Neg<Output = Self> + num_traits::Num + AddAssign + SubAssign + MulAssign + Send + Sync + 'static
{
    /// Whether numbers carry derivatives.
    const DERIVATIVES: bool;
    /// The number `x` with zero derivatives.
    fn constant(x: f64) -> Self;
    /// The real part.
    fn value(self) -> f64;
    /// √x.
    fn sqrt(self) -> Self;
    /// (sin x, cos x), x in rad.
    fn sin_cos(self) -> (Self, Self);
    /// tan x.
    fn tan(self) -> Self;
    /// asin x.
    fn asin(self) -> Self;
    /// acos x.
    fn acos(self) -> Self;
    /// atan x.
    fn atan(self) -> Self;
    /// Angle of the point (x, y) = (`x`, `self`), in (−π, π].
    fn atan2(self, x: Self) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Logarithm to the base 10.
    fn log10(self) -> Self;
    /// sinh x.
    fn sinh(self) -> Self;
    /// cosh x.
    fn cosh(self) -> Self;
    /// tanh x.
    fn tanh(self) -> Self;
    /// x to a constant power.
    fn powf(self, n: f64) -> Self;
    /// x to an integer power.
    fn powi(self, n: i32) -> Self;
    /// x to a power that varies.
    fn pow(self, n: Self) -> Self;
    /// x where `other` is finite, not a number where it is not; derivatives are those of x.
    fn where_finite(self, other: Self) -> Self;
    /// x · k for a plain number k.
    fn scale(self, k: f64) -> Self {
        self * Self::constant(k)
    }
}

impl Scalar for f64 {
    const DERIVATIVES: bool = false;
    #[inline(always)]
    fn constant(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    fn tan(self) -> Self {
        f64::tan(self)
    }
    fn asin(self) -> Self {
        f64::asin(self)
    }
    fn acos(self) -> Self {
        f64::acos(self)
    }
    fn atan(self) -> Self {
        f64::atan(self)
    }
    fn atan2(self, x: Self) -> Self {
        f64::atan2(self, x)
    }
    fn exp(self) -> Self {
        f64::exp(self)
    }
    fn ln(self) -> Self {
        f64::ln(self)
    }
    fn log10(self) -> Self {
        f64::log10(self)
    }
    fn sinh(self) -> Self {
        f64::sinh(self)
    }
    fn cosh(self) -> Self {
        f64::cosh(self)
    }
    fn tanh(self) -> Self {
        f64::tanh(self)
    }
    fn powf(self, n: f64) -> Self {
        f64::powf(self, n)
    }
    fn powi(self, n: i32) -> Self {
        f64::powi(self, n)
    }
    fn pow(self, n: Self) -> Self {
        f64::powf(self, n)
    }
    #[inline(always)]
    fn where_finite(self, other: Self) -> Self {
        self + 0.0 * other
    }
    #[inline(always)]
    fn scale(self, k: f64) -> Self {
        self * k
    }
}
