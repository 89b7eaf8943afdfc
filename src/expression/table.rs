//! Functions given by points: straight or cubic pieces, each piece a mode.

use super::spline;
use crate::scalar::{Interval, Scalar};
use std::fmt;

/// How a table runs between its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Between {
    /// Straight lines.
    #[default]
    Linear,
    /// Cubic spline with two continuous derivatives: not-a-knot at the ends, periodic for a periodic table.
    Cubic,
}

/// How a table goes on outside of its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Beyond {
    /// Keeps the value of the nearest end.
    #[default]
    Constant,
    /// Keeps the slope of the nearest end.
    Linear,
    /// Has no value (not a number).
    Error,
    /// Repeats; the first and the last value are equal.
    Periodic,
}

/// Why points make no table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableError {
    /// Fewer than two points.
    TooFew(usize),
    /// The x of this point (counted from 0) is not larger than the one before it.
    NotRising(usize),
    /// This point (counted from 0) is not finite.
    NotFinite(usize),
    /// A periodic table whose first and last values differ.
    EndsDiffer(f64, f64),
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew(n) => write!(f, "{n} points; a table needs at least two"),
            Self::NotRising(i) => write!(f, "the x of point {} is not larger than the one before it", i + 1),
            Self::NotFinite(i) => write!(f, "point {} is not finite", i + 1),
            Self::EndsDiffer(a, b) => write!(f, "a periodic table ends with the value it begins with; {a} and {b} differ"),
        }
    }
}

impl std::error::Error for TableError {}

/// A function given by points (x, y), x strictly rising.
///
/// Segment k = 0 … n−1 lies between points k and k+1 and holds its left end; the last one holds both. −1 lies below, n
/// above. A periodic table goes on counting: segment k + n·j is segment k shifted by j periods.
#[derive(Clone, Debug, PartialEq)]
pub struct LookupTable {
    /// Arguments of the points.
    pub x: Vec<f64>,
    /// Values at the points.
    pub y: Vec<f64>,
    /// How it runs between them.
    pub between: Between,
    /// How it goes on outside.
    pub beyond: Beyond,
    /// Per segment c₀ … c₃ of y = c₀ + c₁ s + c₂ s² + c₃ s³, s = x − xₖ; then two more segments: below and above.
    pieces: Vec<[f64; 4]>,
}

impl LookupTable {
    /// The table through `points`.
    ///
    /// # Errors
    /// If there are less than two points, if x does not rise, if a number is not finite, if a periodic table does not close.
    pub fn new(points: &[(f64, f64)], between: Between, beyond: Beyond) -> Result<Self, TableError> {
        if points.len() < 2 {
            return Err(TableError::TooFew(points.len()));
        }
        if let Some(i) = points.iter().position(|(x, y)| !x.is_finite() || !y.is_finite()) {
            return Err(TableError::NotFinite(i));
        }
        if let Some(i) = points.windows(2).position(|pair| pair[1].0 <= pair[0].0) {
            return Err(TableError::NotRising(i + 1));
        }
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let (first, last) = (y[0], y[y.len() - 1]);
        // equal up to the rounding of a sine at the ends of a turn
        let scale = y.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        if beyond == Beyond::Periodic && (first - last).abs() > 1e-12 * scale {
            return Err(TableError::EndsDiffer(first, last));
        }
        let mut pieces = match between {
            Between::Linear => spline::lines(&x, &y),
            Between::Cubic => spline::cubics(&x, &y, beyond == Beyond::Periodic),
        };
        let n = pieces.len();
        let end = pieces[n - 1];
        let s = x[n] - x[n - 1];
        let slope_above = end[1] + s * (2.0 * end[2] + s * 3.0 * end[3]);
        let outside = |value: f64, slope: f64| match beyond {
            Beyond::Constant | Beyond::Periodic => [value, 0.0, 0.0, 0.0],
            Beyond::Linear => [value, slope, 0.0, 0.0],
            Beyond::Error => [f64::NAN, 0.0, 0.0, 0.0],
        };
        let below = outside(first, pieces[0][1]);
        pieces.push(below);
        pieces.push(outside(last, slope_above));
        Ok(Self { x, y, between, beyond, pieces })
    }

    /// Number of segments between the points.
    #[must_use]
    pub fn segments(&self) -> usize {
        self.x.len() - 1
    }

    /// x of the last point minus x of the first.
    #[must_use]
    pub fn span(&self) -> f64 {
        self.x[self.x.len() - 1] - self.x[0]
    }

    /// The segment that `x` lies in.
    #[must_use]
    pub fn segment(&self, x: f64) -> i32 {
        let n = self.segments();
        if self.beyond == Beyond::Periodic {
            let turns = ((x - self.x[0]) / self.span()).floor();
            // far out, where a turn is below the resolution of x, any segment is as good as another
            let turns = if turns.abs() * (n as f64) < 1e9 { turns } else { 0.0 };
            let k = self.inner(x - turns * self.span());
            return turns as i32 * n as i32 + k as i32;
        }
        if x < self.x[0] {
            -1
        } else if x > self.x[n] {
            n as i32
        } else {
            self.inner(x) as i32
        }
    }

    /// Segment of an x between the ends.
    fn inner(&self, x: f64) -> usize {
        self.x.partition_point(|knot| *knot <= x).saturating_sub(1).min(self.segments() - 1)
    }

    /// Index of a segment's piece and the x that its polynomial counts from.
    #[inline]
    fn piece(&self, segment: i32) -> (usize, f64) {
        let n = self.x.len() - 1;
        if self.beyond == Beyond::Periodic {
            let (turns, k) = (segment.div_euclid(n as i32), segment.rem_euclid(n as i32) as usize);
            return (k, self.x[k] + f64::from(turns) * self.span());
        }
        match segment {
            s if s < 0 => (n, self.x[0]),
            s if s as usize >= n => (n + 1, self.x[n]),
            s => (s as usize, self.x[s as usize]),
        }
    }

    /// Derivative of order `order` (0: the value) at `x`, by the formula of `segment`.
    #[inline]
    pub fn eval<S: Scalar>(&self, x: S, segment: i32, order: u8) -> S {
        let (k, from) = self.piece(segment);
        let [a, b, c, d] = self.pieces[k];
        let s = x - S::constant(from);
        // dⁿ/dsⁿ (a + b s + c s² + d s³)
        let [a, b, c, d] = match order {
            0 => [a, b, c, d],
            1 => [b, 2.0 * c, 3.0 * d, 0.0],
            2 => [2.0 * c, 6.0 * d, 0.0, 0.0],
            3 => [6.0 * d, 0.0, 0.0, 0.0],
            _ => [0.0; 4],
        };
        // not a number outside stays so in every derivative
        let hole = if self.beyond == Beyond::Error && k > self.x.len() - 2 { f64::NAN } else { 0.0 };
        if c == 0.0 && d == 0.0 {
            return s.scale(b) + S::constant(a + hole);
        }
        ((s.scale(d) + S::constant(c)) * s + S::constant(b)) * s + S::constant(a)
    }

    /// The value at `x`.
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
        self.eval(x, self.segment(x), 0)
    }

    /// How far `x` lies inside of `segment`: positive inside, negative outside, near an end the distance from it. Smooth: of a segment
    /// with two ends the product of the distances from both, by its length.
    #[must_use]
    pub fn inside(&self, x: f64, segment: i32) -> f64 {
        let [low, high] = self.from_ends(x, segment);
        if low.is_finite() && high.is_finite() { low * (high / (low + high)) } else { low.min(high) }
    }

    /// Distances of `x` from the lower and the upper end of `segment`: positive inside.
    #[must_use]
    pub fn from_ends(&self, x: f64, segment: i32) -> [f64; 2] {
        let (low, high) = self.ends(segment);
        [x - low, high - x]
    }

    /// Bounds of [`Self::inside`] for an interval.
    #[must_use]
    pub fn inside_of(&self, x: Interval, segment: i32) -> Interval {
        let (low, high) = self.ends(segment);
        let [low, high] = [low, high].map(Interval::constant);
        match (low.low.is_finite(), high.low.is_finite()) {
            (true, true) => (x - low) * ((high - x) / (high - low)),
            (true, false) => x - low,
            _ => high - x,
        }
    }

    /// The segment beyond the end of `segment` that is nearest to `x`.
    #[must_use]
    pub fn neighbour(&self, x: f64, segment: i32) -> i32 {
        let (low, high) = self.ends(segment);
        if x - low < high - x { segment.saturating_sub(1) } else { segment.saturating_add(1) }
    }

    /// Both ends of a segment; infinite for the outer ones.
    fn ends(&self, segment: i32) -> (f64, f64) {
        let n = self.segments();
        let (k, from) = self.piece(segment);
        match k {
            k if k == n => (f64::NEG_INFINITY, self.x[0]),
            k if k > n => (self.x[n], f64::INFINITY),
            k => (from, from + (self.x[k + 1] - self.x[k])),
        }
    }
}

#[cfg(test)]
#[path = "table_tests.rs"]
mod tests;
