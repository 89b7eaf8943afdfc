//! Dual numbers x + Σ dᵢ εᵢ, εᵢ εⱼ = 0: a function of them gives its value and its exact derivatives along N directions
//! (forward differentiation; Griewank & Walther, *Evaluating Derivatives*, 2nd ed. 2008, chapter 3).

use super::Scalar;
use num_traits::{Num, One, Zero};
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Rem, Sub, SubAssign};

/// A number with derivatives along `N` directions.
#[derive(Clone, Copy, Debug)]
pub struct Dual<const N: usize> {
    /// The value.
    pub x: f64,
    /// The derivatives.
    pub d: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// The number `x` whose derivative along direction `i` is 1.
    #[must_use]
    pub fn variable(x: f64, i: usize) -> Self {
        let mut d = [0.0; N];
        d[i] = 1.0;
        Self { x, d }
    }

    /// f(x) with f' given: the chain rule.
    #[inline]
    fn chain(self, f: f64, slope: f64) -> Self {
        Self { x: f, d: self.d.map(|d| slope * d) }
    }

    /// value, p d₁ + q d₂: the chain rule of two arguments.
    #[inline]
    fn combine(x: f64, p: f64, a: Self, q: f64, b: Self) -> Self {
        let mut d = [0.0; N];
        for (i, d) in d.iter_mut().enumerate() {
            *d = p * a.d[i] + q * b.d[i];
        }
        Self { x, d }
    }
}

impl<const N: usize> Default for Dual<N> {
    fn default() -> Self {
        Self::constant(0.0)
    }
}

/// Equal values; derivatives do not take part.
impl<const N: usize> PartialEq for Dual<N> {
    fn eq(&self, other: &Self) -> bool {
        self.x == other.x
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Self::combine(self.x + b.x, 1.0, self, 1.0, b)
    }
}
impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline]
    fn sub(self, b: Self) -> Self {
        Self::combine(self.x - b.x, 1.0, self, -1.0, b)
    }
}
impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline]
    fn mul(self, b: Self) -> Self {
        Self::combine(self.x * b.x, b.x, self, self.x, b)
    }
}
impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline]
    fn div(self, b: Self) -> Self {
        let x = self.x / b.x;
        Self::combine(x, 1.0 / b.x, self, -x / b.x, b)
    }
}
impl<const N: usize> Rem for Dual<N> {
    type Output = Self;
    fn rem(self, b: Self) -> Self {
        Self::combine(self.x % b.x, 1.0, self, -(self.x / b.x).trunc(), b)
    }
}
impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.chain(-self.x, -1.0)
    }
}
impl<const N: usize> AddAssign for Dual<N> {
    #[inline]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
impl<const N: usize> SubAssign for Dual<N> {
    #[inline]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
impl<const N: usize> MulAssign for Dual<N> {
    #[inline]
    fn mul_assign(&mut self, b: Self) {
        *self = *self * b;
    }
}

impl<const N: usize> Zero for Dual<N> {
    fn zero() -> Self {
        Self::constant(0.0)
    }
    fn is_zero(&self) -> bool {
        self.x == 0.0 && self.d.iter().all(|d| *d == 0.0)
    }
}
impl<const N: usize> One for Dual<N> {
    fn one() -> Self {
        Self::constant(1.0)
    }
}
impl<const N: usize> Num for Dual<N> {
    type FromStrRadixErr = num_traits::ParseFloatError;
    fn from_str_radix(text: &str, radix: u32) -> Result<Self, Self::FromStrRadixErr> {
        f64::from_str_radix(text, radix).map(Self::constant)
    }
}

impl<const N: usize> Scalar for Dual<N> {
    const DERIVATIVES: bool = true;
    #[inline]
    fn constant(x: f64) -> Self {
        Self { x, d: [0.0; N] }
    }
    #[inline]
    fn value(self) -> f64 {
        self.x
    }
    fn sqrt(self) -> Self {
        let r = self.x.sqrt();
        self.chain(r, 0.5 / r)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.x.sin_cos();
        (self.chain(s, c), self.chain(c, -s))
    }
    fn tan(self) -> Self {
        let t = self.x.tan();
        self.chain(t, 1.0 + t * t)
    }
    fn asin(self) -> Self {
        self.chain(self.x.asin(), 1.0 / (1.0 - self.x * self.x).sqrt())
    }
    fn acos(self) -> Self {
        self.chain(self.x.acos(), -1.0 / (1.0 - self.x * self.x).sqrt())
    }
    fn atan(self) -> Self {
        self.chain(self.x.atan(), 1.0 / (1.0 + self.x * self.x))
    }
    fn atan2(self, x: Self) -> Self {
        let r2 = self.x * self.x + x.x * x.x;
        Self::combine(self.x.atan2(x.x), x.x / r2, self, -self.x / r2, x)
    }
    fn exp(self) -> Self {
        let e = self.x.exp();
        self.chain(e, e)
    }
    fn ln(self) -> Self {
        self.chain(self.x.ln(), 1.0 / self.x)
    }
    fn log10(self) -> Self {
        self.chain(self.x.log10(), 1.0 / (self.x * std::f64::consts::LN_10))
    }
    fn sinh(self) -> Self {
        self.chain(self.x.sinh(), self.x.cosh())
    }
    fn cosh(self) -> Self {
        self.chain(self.x.cosh(), self.x.sinh())
    }
    fn tanh(self) -> Self {
        // 1 − tanh² would cancel where the slope is small
        let c = self.x.cosh();
        self.chain(self.x.tanh(), 1.0 / (c * c))
    }
    fn powf(self, n: f64) -> Self {
        self.chain(self.x.powf(n), n * self.x.powf(n - 1.0))
    }
    fn powi(self, n: i32) -> Self {
        self.chain(self.x.powi(n), f64::from(n) * self.x.powi(n - 1))
    }
    fn pow(self, n: Self) -> Self {
        let y = self.x.powf(n.x);
        // the limit of xⁿ ln x at 0 is 0
        let by_exponent = if y == 0.0 { 0.0 } else { y * self.x.ln() };
        Self::combine(y, n.x * self.x.powf(n.x - 1.0), self, by_exponent, n)
    }
    #[inline(always)]
    fn where_finite(self, other: Self) -> Self {
        Self { x: self.x.where_finite(other.x), d: self.d }
    }
    #[inline]
    fn scale(self, k: f64) -> Self {
        self.chain(self.x * k, k)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every function's derivative against a central difference of its value.
    #[test]
    fn derivatives_are_those_of_the_values() {
        let functions: [fn(Dual<1>) -> Dual<1>; 17] = [
            |x| x.sqrt(),
            |x| x.sin_cos().0,
            |x| x.sin_cos().1,
            |x| x.tan(),
            |x| x.asin(),
            |x| x.acos(),
            |x| x.atan(),
            |x| x.atan2(x * x + Dual::constant(0.3)),
            |x| x.exp() / (x + Dual::constant(2.0)),
            |x| x.ln() - x.powi(3) * x,
            |x| x.powf(1.7),
            |x| x.pow(x + Dual::constant(0.4)),
            |x| x.log10(),
            |x| x.sinh(),
            |x| x.cosh(),
            |x| x.tanh(),
            |x| (-x).scale(2.5) + x * x,
        ];
        let (x, h) = (0.37, 1e-6);
        for (i, f) in functions.iter().enumerate() {
            let exact = f(Dual::variable(x, 0)).d[0];
            let difference = (f(Dual::constant(x + h)).x - f(Dual::constant(x - h)).x) / (2.0 * h);
            assert!((exact - difference).abs() < 1e-8 * (1.0 + exact.abs()), "function {i}: {exact} {difference}");
        }
    }
}
