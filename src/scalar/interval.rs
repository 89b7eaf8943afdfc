//! Intervals [low, high]: a function of them holds all values that the function takes on them, round-off included (Moore,
//! Kearfott & Cloud, *Introduction to Interval Analysis*, 2009, chapters 2 and 5).
//!
//! Every result is rounded outwards by a unit in the last place, and by four where the function is one of the library's. A function
//! that is undefined on all of the interval is not a number; on a part of it, it has the values of the rest.

use super::Scalar;
use num_traits::{Num, One, Zero};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Rem, Sub, SubAssign};

/// All numbers from `low` to `high`; not a number where both are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// The least.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

/// Arguments of sines beyond this are known too badly to tell their part of a turn.
const FAR: f64 = 1e15;

impl Interval {
    /// All numbers.
    pub const ALL: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// No number.
    pub const NONE: Self = Self { low: f64::NAN, high: f64::NAN };

    /// The numbers between two, in either order.
    #[must_use]
    pub fn between(a: f64, b: f64) -> Self {
        Self { low: a.min(b), high: a.max(b) }
    }

    /// Whether it holds no number.
    #[must_use]
    pub fn is_none(self) -> bool {
        self.low.is_nan() || self.high.is_nan()
    }

    /// Whether it holds `x`.
    #[must_use]
    pub fn holds(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// The greatest absolute value.
    #[must_use]
    pub fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Rounded outwards by `units` in the last place.
    fn widened(low: f64, high: f64, units: usize) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::NONE;
        }
        let out = |x: f64, next: fn(f64) -> f64| (0..units).fold(x, |x, _| next(x));
        Self { low: out(low, f64::next_down), high: out(high, f64::next_up) }
    }

    /// A function that rises or falls throughout, from its values at both ends.
    fn monotone(self, f: impl Fn(f64) -> f64) -> Self {
        if self.is_none() {
            return Self::NONE;
        }
        let (a, b) = (f(self.low), f(self.high));
        Self::widened(a.min(b), a.max(b), 4)
    }

    /// A monotone function that is defined on `domain` alone, of the part that lies in it: an argument that is rounded outwards reaches
    /// beyond it where it touches the end.
    fn within(self, domain: Self, f: impl Fn(f64) -> f64) -> Self {
        if self.is_none() || self.high < domain.low || self.low > domain.high {
            return Self::NONE;
        }
        Self { low: self.low.max(domain.low), high: self.high.min(domain.high) }.monotone(f)
    }

    /// The hull of four values; what is no number among them leaves nothing known.
    fn hull(values: [f64; 4]) -> Self {
        if values.iter().any(|x| x.is_nan()) {
            return Self::ALL;
        }
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
        Self::widened(low, high, 1)
    }

    /// Whether a place of the form `first` + k `period` lies inside.
    fn meets(self, first: f64, period: f64) -> bool {
        // a place within rounding of an end counts
        let slack = 8.0 * f64::EPSILON * self.magnitude().max(period);
        let k = ((self.low - slack - first) / period).ceil();
        first + k * period <= self.high + slack
    }

    /// The cosine.
    fn cosine(self) -> Self {
        if self.is_none() {
            return Self::NONE;
        }
        if self.magnitude() > FAR || self.high - self.low >= TAU {
            return Self { low: -1.0, high: 1.0 };
        }
        let ends = self.monotone(f64::cos);
        let low = if self.meets(PI, TAU) { -1.0 } else { ends.low.max(-1.0) };
        let high = if self.meets(0.0, TAU) { 1.0 } else { ends.high.min(1.0) };
        Self { low, high }
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::widened(self.low + b.low, self.high + b.high, 1)
    }
}
impl Sub for Interval {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::widened(self.low - b.high, self.high - b.low, 1)
    }
}
impl Mul for Interval {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        if self.is_none() || b.is_none() {
            return Self::NONE;
        }
        Self::hull([self.low * b.low, self.low * b.high, self.high * b.low, self.high * b.high])
    }
}
impl Div for Interval {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        if self.is_none() || b.is_none() || (b.low == 0.0 && b.high == 0.0) {
            return Self::NONE;
        }
        if b.holds(0.0) {
            return Self::ALL;
        }
        Self::hull([self.low / b.low, self.low / b.high, self.high / b.low, self.high / b.high])
    }
}
impl Rem for Interval {
    type Output = Self;
    fn rem(self, b: Self) -> Self {
        if self.is_none() || b.is_none() {
            return Self::NONE;
        }
        let m = b.magnitude().min(self.magnitude());
        Self { low: if self.low < 0.0 { -m } else { 0.0 }, high: if self.high > 0.0 { m } else { 0.0 } }
    }
}
impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}
impl AddAssign for Interval {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
impl SubAssign for Interval {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
impl MulAssign for Interval {
    fn mul_assign(&mut self, b: Self) {
        *self = *self * b;
    }
}

impl Zero for Interval {
    fn zero() -> Self {
        Self::constant(0.0)
    }
    fn is_zero(&self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }
}
impl One for Interval {
    fn one() -> Self {
        Self::constant(1.0)
    }
}
impl Num for Interval {
    type FromStrRadixErr = num_traits::ParseFloatError;
    fn from_str_radix(text: &str, radix: u32) -> Result<Self, Self::FromStrRadixErr> {
        f64::from_str_radix(text, radix).map(Self::constant)
    }
}

impl Scalar for Interval {
    const DERIVATIVES: bool = false;
    fn constant(x: f64) -> Self {
        Self { low: x, high: x }
    }
    /// The middle; of all numbers 0.
    fn value(self) -> f64 {
        let finite = |x: f64| if x.is_infinite() { f64::MAX.copysign(x) } else { x };
        0.5 * finite(self.low) + 0.5 * finite(self.high)
    }
    fn sqrt(self) -> Self {
        self.within(Self { low: 0.0, high: f64::INFINITY }, f64::sqrt)
    }
    fn sin_cos(self) -> (Self, Self) {
        // sin x = cos(x − π/2), the difference rounded outwards
        ((self - Self::widened(FRAC_PI_2, FRAC_PI_2, 1)).cosine(), self.cosine())
    }
    fn tan(self) -> Self {
        if !self.is_none() && (self.magnitude() > FAR || self.meets(FRAC_PI_2, PI)) { Self::ALL } else { self.monotone(f64::tan) }
    }
    fn asin(self) -> Self {
        self.within(Self { low: -1.0, high: 1.0 }, f64::asin)
    }
    fn acos(self) -> Self {
        self.within(Self { low: -1.0, high: 1.0 }, f64::acos)
    }
    fn atan(self) -> Self {
        self.monotone(f64::atan)
    }
    fn atan2(self, x: Self) -> Self {
        if self.is_none() || x.is_none() {
            return Self::NONE;
        }
        // across the negative axis, the origin included, the angle jumps
        if self.holds(0.0) && x.low <= 0.0 {
            return Self::widened(-PI, PI, 1);
        }
        // else it is monotone along each edge
        let corners = [self.low.atan2(x.low), self.low.atan2(x.high), self.high.atan2(x.low), self.high.atan2(x.high)];
        let hull = Self::hull(corners);
        Self::widened(hull.low, hull.high, 4)
    }
    fn exp(self) -> Self {
        let exp = self.monotone(f64::exp);
        Self { low: exp.low.max(0.0), ..exp }
    }
    fn ln(self) -> Self {
        self.within(Self { low: 0.0, high: f64::INFINITY }, f64::ln)
    }
    fn log10(self) -> Self {
        self.within(Self { low: 0.0, high: f64::INFINITY }, f64::log10)
    }
    fn sinh(self) -> Self {
        self.monotone(f64::sinh)
    }
    fn cosh(self) -> Self {
        let ends = self.monotone(f64::cosh);
        Self { low: if self.holds(0.0) { 1.0 } else { ends.low.max(1.0) }, ..ends }
    }
    fn tanh(self) -> Self {
        self.monotone(f64::tanh)
    }
    fn powf(self, n: f64) -> Self {
        if n == n.trunc() && n.abs() < f64::from(i32::MAX) {
            return self.powi(n as i32);
        }
        self.within(Self { low: 0.0, high: f64::INFINITY }, |x| x.powf(n))
    }
    fn powi(self, n: i32) -> Self {
        if self.is_none() || (n < 0 && self.is_zero()) {
            return Self::NONE;
        }
        if n < 0 && self.holds(0.0) {
            return Self::ALL;
        }
        let ends = self.monotone(|x| x.powi(n));
        if n % 2 == 0 && n != 0 && self.holds(0.0) { Self { low: 0.0, ..ends } } else { ends }
    }
    fn pow(self, n: Self) -> Self {
        if self.is_none() || n.is_none() {
            return Self::NONE;
        }
        if n.low == n.high {
            return self.powf(n.low);
        }
        // of a negative number there are powers at whole exponents alone
        if self.low < 0.0 {
            return if self.high < 0.0 && n.low.ceil() > n.high { Self::NONE } else { Self::ALL };
        }
        (n * self.ln()).exp()
    }
    fn where_finite(self, other: Self) -> Self {
        if other.is_none() { Self::NONE } else { self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A generator of numbers in [−1, 1) that is the same everywhere.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    type OfTwo<S> = fn(S, S) -> S;

    fn functions<S: Scalar>() -> [OfTwo<S>; 24] {
        [
            |x, _| x.log10(),
            |x, _| x.sinh(),
            |x, _| x.cosh(),
            |x, _| x.tanh(),
            |x, y| x + y,
            |x, y| x - y,
            |x, y| x * y,
            |x, y| x / y,
            |x, _| x.sqrt(),
            |x, _| x.sin_cos().0,
            |x, _| x.sin_cos().1,
            |x, _| x.tan(),
            |x, _| x.asin(),
            |x, _| x.acos(),
            |x, _| x.atan(),
            |x, y| x.atan2(y),
            |x, _| x.exp(),
            |x, _| x.ln(),
            |x, _| x.powf(1.7),
            |x, y| x.pow(y),
            |x, y| x.where_finite(y.ln()),
            |x, _| x.powi(3),
            |x, _| x.powi(-2),
            |x, y| (x * x - y).sin_cos().0 * (x - y).powi(2),
        ]
    }

    /// Whatever is taken from the arguments, the value lies in the interval; and the interval is no wider than it has to be.
    #[test]
    fn intervals_hold_all_values() {
        let mut numbers = Numbers(7);
        for (i, (of_interval, of_number)) in functions::<Interval>().into_iter().zip(functions::<f64>()).enumerate() {
            for _ in 0..2000 {
                let size = 10f64.powf(2.0 * numbers.next());
                let [a, b] = [(); 2].map(|()| {
                    let x = size * numbers.next();
                    Interval::between(x, x + 10f64.powf(4.0 * numbers.next() - 3.0) * size)
                });
                let all = of_interval(a, b);
                for k in 0..=8 {
                    let along = f64::from(k) / 8.0;
                    let (x, y) = (a.low + along * (a.high - a.low), b.high + along * (b.low - b.high));
                    let (x, y) = (x.clamp(a.low, a.high), y.clamp(b.low, b.high));
                    let value = of_number(x, y);
                    assert!(value.is_nan() || all.holds(value), "function {i} of {x} and {y}: {value} is not in {all:?}");
                }
            }
        }
    }

    #[test]
    fn narrow_arguments_give_narrow_values() {
        for (i, f) in functions::<Interval>().into_iter().enumerate() {
            let (x, y) = (Interval::between(0.3, 0.3 + 1e-12), Interval::between(0.7, 0.7 + 1e-12));
            let value = f(x, y);
            assert!(value.high - value.low < 1e-10, "function {i}: {value:?}");
        }
    }

    #[test]
    fn what_is_nowhere_defined_is_no_number_and_what_is_partly_so_has_the_values_of_that_part() {
        assert!(Interval::between(-2.0, -1.0).sqrt().is_none());
        let root = Interval::between(-2.0, 1.0).sqrt();
        assert!(root.low <= 0.0 && root.low > -1e-300 && root.holds(1.0) && root.high < 1.0 + 1e-15, "{root:?}");
        let of_nothing = (Interval::zero() * Interval::one() + Interval::zero()).sqrt();
        assert!(of_nothing.holds(0.0) && of_nothing.high < 1e-150, "{of_nothing:?}");
        assert_eq!(Interval::between(-2.0, 0.0).ln().low, f64::NEG_INFINITY);
        assert!((Interval::between(-2.0, -1.0).ln() + Interval::one()).is_none());
        assert!((Interval::one() / Interval::zero()).is_none());
        assert!(Interval::between(-2.0, -1.0).pow(Interval::between(0.2, 0.8)).is_none());
        assert_eq!(Interval::between(-2.0, -1.0).pow(Interval::between(0.2, 1.8)), Interval::ALL);
        assert!(Interval::one().where_finite(Interval::between(-2.0, -1.0).sqrt()).is_none());
        assert_eq!(Interval::one().where_finite(Interval::ALL), Interval::one());
        assert_eq!(Interval::one() / Interval::between(-1.0, 1.0), Interval::ALL);
    }
}
