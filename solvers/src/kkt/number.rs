//! The numbers that matrices are made of: real, and complex for the stages of implicit Runge-Kutta methods.

use nalgebra::Complex;
use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real or complex number in double precision.
pub trait Number:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + Sum
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;

    /// |Re z| + |Im z|: a magnitude without a root, between |z| and √2 |z|; not finite exactly where a part is not finite (or
    /// where the sum overflows).
    fn abs1(self) -> f64;

    /// 1/z.
    fn recip(self) -> Self;
}

impl Number for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    #[inline(always)]
    fn abs1(self) -> f64 {
        self.abs()
    }

    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }
}

impl Number for Complex<f64> {
    const ZERO: Self = Self { re: 0.0, im: 0.0 };
    const ONE: Self = Self { re: 1.0, im: 0.0 };

    #[inline(always)]
    fn abs1(self) -> f64 {
        self.re.abs() + self.im.abs()
    }

    /// By the ratio of the parts, so that |z|² cannot overflow: Smith, Commun. ACM 5 (1962) 435, algorithm 116.
    #[inline]
    fn recip(self) -> Self {
        if self.re.abs() >= self.im.abs() {
            let ratio = self.im / self.re;
            let x = 1.0 / (self.re + self.im * ratio);
            Self { re: x, im: -ratio * x }
        } else {
            let ratio = self.re / self.im;
            let x = 1.0 / (self.re * ratio + self.im);
            Self { re: ratio * x, im: -x }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reciprocals_of_any_size() {
        assert_eq!(Number::recip(4.0), 0.25);
        for z in [
            Complex::new(3.0, 4.0),
            Complex::new(-4.0, 3.0),
            Complex::new(0.0, -2.0),
            Complex::new(1e200, -3e200),
            Complex::new(2e-200, 1e-201),
        ] {
            assert!((Number::recip(z) * z - Complex::ONE).abs1() < 1e-15, "{z}");
        }
        assert!(!Number::recip(Complex::<f64>::ZERO).abs1().is_finite());
    }

    #[test]
    fn magnitudes_show_what_is_not_finite() {
        assert_eq!((Number::abs1(-3.0), Complex::new(-3.0, 4.0).abs1()), (3.0, 7.0));
        assert!(Complex::new(0.0, f64::NAN).abs1().is_nan());
        assert_eq!(Complex::new(0.0, f64::NEG_INFINITY).abs1(), f64::INFINITY);
    }
}
