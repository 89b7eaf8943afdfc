//! One root function over a part of a step: clear of zero, across it, or not resolved.
//!
//! The function is known at the nine Chebyshev-Lobatto nodes s_j = −cos(jπ/8) of the part, mapped on [−1, 1], and at one place
//! beside them. The polynomial of degree eight through the nodes, p = Σ c_k T_k, is in error by what its last coefficients are
//! and by what it misses at the tenth place (Trefethen, *Approximation Theory and Approximation Practice*, 2nd ed. 2019,
//! chapters 4 and 8). Where p is farther from zero than that, the sign of the function is known between its nodes, too; where it
//! is not, the part is to be made narrower, which takes the error down by the eighth power of the width.

use std::f64::consts::PI;

/// Degree of the polynomial.
const N: usize = 8;

/// Nodes of a part, its ends among them.
pub(super) const NODES: usize = N + 1;

/// The place beside the nodes, of no ratio with them: a function that vanishes at all nodes does not vanish there as well.
pub(super) const BESIDE: f64 = -0.184_537_29;

/// Widest gap between nodes, in parts of the width: s from 0 to sin(π/8).
pub(super) const GAP: f64 = 0.5 * 0.382_683_432_365_089_8;

/// Every other node, which are those of degree four, and the place beside the nodes; without the begin.
pub(super) const COARSE: [usize; 5] = [2, 4, 6, 8, NODES];

/// The other nodes.
pub(super) const BETWEEN: [usize; 4] = [1, 3, 5, 7];

/// Widest gap between every other node, in parts of the width.
pub(super) const COARSE_GAP: f64 = 0.5 * std::f64::consts::FRAC_1_SQRT_2;

/// Cells between the places at which the polynomial is looked at.
const FINE: usize = 32;

/// Safety of the estimated error.
const SAFETY: f64 = 4.0;

/// Round-off of values, relative to the largest.
const ROUNDING: f64 = 1e-13;

/// A polynomial as exact as this part of the largest value is told by its sign alone, and what dips below zero by less only touches it.
const EXACT: f64 = 1e-10;

/// What is known of a root function in a part; places are in [−1, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// Positive throughout, or in touch with zero.
    Clear,
    /// It leaves its positive side for the first time between two places; at the begin, if both are −1.
    Across {
        /// A place where it is positive.
        before: f64,
        /// A place where it is negative.
        after: f64,
    },
    /// Too coarse to tell.
    Open,
}

/// Tables of the polynomial.
#[derive(Clone, Debug)]
pub(super) struct Resolver {
    /// From values to coefficients: c = transform · g.
    transform: [[f64; NODES]; NODES],
    /// Places at which the polynomial is looked at, rising.
    places: [f64; FINE + 1],
    /// T_k there.
    fine: [[f64; NODES]; FINE + 1],
    /// T_k beside the nodes.
    beside: [f64; NODES],
}

impl Resolver {
    pub(super) fn new() -> Self {
        let half = |j: usize| if j == 0 || j == N { 0.5 } else { 1.0 };
        // T_k(−cos x) = (−1)^k cos kx
        let cosine = |k: usize, x: f64| if k.is_multiple_of(2) { (k as f64 * x).cos() } else { -(k as f64 * x).cos() };
        let angle = |i: usize, n: usize| i as f64 * PI / n as f64;
        let row = |x: f64| std::array::from_fn(|k| cosine(k, x));
        Self {
            transform: std::array::from_fn(|k| std::array::from_fn(|j| 2.0 / N as f64 * half(k) * half(j) * cosine(k, angle(j, N)))),
            places: std::array::from_fn(|i| -angle(i, FINE).cos()),
            fine: std::array::from_fn(|i| row(angle(i, FINE))),
            beside: row((-BESIDE).acos()),
        }
    }

    /// The nodes, rising.
    pub(super) fn node(j: usize) -> f64 {
        -(j as f64 * PI / N as f64).cos()
    }

    /// What the values `g` at the nodes and `beside` them say of the function.
    pub(super) fn judge(&self, g: &[f64; NODES], beside: f64) -> Verdict {
        let (low, high) = g.iter().fold((beside, beside), |(low, high), x| (low.min(*x), high.max(*x)));
        // far from zero by what it changes
        if is_far(low, high) || low == high && low >= 0.0 {
            return Verdict::Clear;
        }
        let largest = high.abs().max(low.abs());
        let series: [f64; NODES] = self.transform.map(|row| dot(&row, g));
        let missed = (dot(&self.beside, &series) - beside).abs();
        let error = SAFETY * (series[N - 1].abs() + series[N].abs() + missed) + ROUNDING * largest;
        if error.is_nan() {
            return Verdict::Open;
        }
        let p: [f64; FINE + 1] = std::array::from_fn(|i| dot(&self.fine[i], &series));
        let floor = EXACT * largest;
        let Some(positive) = first_positive(&p, error) else {
            return Self::never_positive(&p, &series, g, error, floor);
        };
        self.first_across(&p, &series, g, positive, [error, floor])
    }

    /// The verdict where the polynomial is nowhere above its error: across at once if it falls from zero, clear if it only touches.
    fn never_positive(p: &[f64; FINE + 1], series: &[f64; NODES], g: &[f64; NODES], error: f64, floor: f64) -> Verdict {
        // T_k'(−1) = (−1)^(k + 1) k²; a short time above zero at the begin shows in no value
        let slope: f64 = series.iter().enumerate().map(|(k, c)| if k.is_multiple_of(2) { -c } else { *c } * (k * k) as f64).sum();
        let falls = g[0] <= 0.0 && p[1] < p[0] && slope < 0.0;
        match g[0] {
            _ if falls && (error <= floor || p.iter().any(|p| *p < -error)) => Verdict::Across { before: -1.0, after: -1.0 },
            _ if error <= floor && p.iter().all(|p| *p >= -floor) => Verdict::Clear,
            _ => Verdict::Open,
        }
    }

    /// The verdict behind the place number `positive`, up to which the function is known to be above zero.
    fn first_across(
        &self,
        p: &[f64; FINE + 1],
        series: &[f64; NODES],
        g: &[f64; NODES],
        positive: usize,
        [error, floor]: [f64; 2],
    ) -> Verdict {
        let mut last = positive;
        for j in positive + 1..=FINE {
            let before = self.places[last];
            if p[j] < -error {
                return Verdict::Across { before, after: self.places[j] };
            }
            if p[j] > error {
                last = j;
            }
            if j == FINE || p[j] > p[j - 1] || p[j] > p[j + 1] {
                continue;
            }
            let (place, lowest) = self.lowest(p, series, j);
            let before = if place > self.places[last] { self.places[last] } else { before };
            if lowest > error {
                continue;
            }
            if lowest < -error || error <= floor && lowest < -floor {
                return Verdict::Across { before, after: place };
            }
            if error > floor {
                return Verdict::Open;
            }
        }
        // it falls towards the end, whose sign is known
        if g[N] < 0.0 { Verdict::Across { before: self.places[last], after: 1.0 } } else { Verdict::Clear }
    }

    /// Place and value of the lowest point of the polynomial between the neighbours of the place number `j`, which is lower than both:
    /// Newton's method from the parabola through the three, whose own lowest value is off by the fourth power of their distance.
    fn lowest(&self, p: &[f64; FINE + 1], series: &[f64; NODES], j: usize) -> (f64, f64) {
        let (x0, x1, x2) = (self.places[j - 1], self.places[j], self.places[j + 1]);
        let (left, right) = ((p[j] - p[j - 1]) / (x1 - x0), (p[j + 1] - p[j]) / (x2 - x1));
        let bend = (right - left) / (x2 - x0);
        if bend <= 0.0 {
            return (x1, p[j]);
        }
        // p = p₁ + slope (x − x₁) + bend (x − x₁)²
        let slope = left + bend * (x1 - x0);
        let mut x = (x1 - 0.5 * slope / bend).clamp(x0, x2);
        for _ in 0..4 {
            let [_, first, second] = derivatives(series, x);
            if second <= 0.0 {
                break;
            }
            x = (x - first / second).clamp(x0, x2);
        }
        let [value, ..] = derivatives(series, x);
        if value < p[j] { (x, value) } else { (x1, p[j]) }
    }
}

/// Σ c_k T_k(x) and its first two derivatives, by the recurrence of T_k.
fn derivatives(series: &[f64; NODES], x: f64) -> [f64; 3] {
    let (mut before, mut now) = ([1.0, 0.0, 0.0], [x, 1.0, 0.0]);
    let mut sum = [series[0] + series[1] * x, series[1], 0.0];
    for c in &series[2..] {
        let next = [2.0 * x * now[0] - before[0], 2.0 * now[0] + 2.0 * x * now[1] - before[1], 4.0 * now[1] + 2.0 * x * now[2] - before[2]];
        (before, now) = (now, next);
        sum.iter_mut().zip(now).for_each(|(sum, t)| *sum += c * t);
    }
    sum
}

/// Whether values between `low` and `high` are farther from zero than they change.
pub(super) fn is_far(low: f64, high: f64) -> bool {
    low > 0.0 && low > 2.0 * (high - low)
}

/// The first place where the polynomial is above its error, if it rises until there: a function that begins at zero is not judged
/// before it has left it.
fn first_positive(p: &[f64; FINE + 1], error: f64) -> Option<usize> {
    let first = p.iter().position(|p| *p > error)?;
    p[..=first].is_sorted().then_some(first)
}

fn dot(a: &[f64; NODES], b: &[f64; NODES]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The verdict on a function of [0, w].
    fn judge(f: impl Fn(f64) -> f64, w: f64) -> Verdict {
        let at = |s: f64| f(0.5 * w * (1.0 + s));
        Resolver::new().judge(&std::array::from_fn(|j| at(Resolver::node(j))), at(BESIDE))
    }

    #[test]
    fn what_is_far_from_zero_is_clear_and_what_ends_below_is_across() {
        assert_eq!(judge(|_| 1.0, 1.0), Verdict::Clear);
        assert_eq!(judge(|_| 0.0, 1.0), Verdict::Clear);
        assert_eq!(judge(|t| 1.01 + t.sin(), 5.0), Verdict::Clear);
        let Verdict::Across { before, after } = judge(|t| 0.7 - t, 1.0) else { panic!("not across") };
        assert!(before < 0.4 && 0.4 < after, "{before} {after}");
    }

    #[test]
    fn a_dip_between_nodes_is_found_and_a_near_miss_is_not() {
        // zeros at 0.400 and 0.401 of the part
        let Verdict::Across { before, after } = judge(|t| (t - 0.4) * (t - 0.401), 1.0) else { panic!("not across") };
        assert!(before < -0.2 && (after + 0.199).abs() < 1e-3, "{before} {after}");
        assert_eq!(judge(|t| (t - 0.4) * (t - 0.4) + 1e-7, 1.0), Verdict::Clear);
        // below zero by 1e-9 only, on a curve that is no parabola
        for place in [0.1, 0.23, 0.31, 0.44] {
            let dips = judge(|t| 1.0 - 1e-9 - (t - place).cos(), 0.5);
            assert!(matches!(dips, Verdict::Across { .. }), "{place}: {dips:?}");
        }
    }

    #[test]
    fn what_oscillates_faster_than_the_nodes_is_open() {
        for w in [20.0, 100.0, 1e3, 1e4, 1e6] {
            assert_eq!(judge(|t| t.sin() + 0.3, w), Verdict::Open, "{w}");
            // zero at all nodes: only the place beside them shows it
            assert_eq!(judge(|t| 0.5 + (2.0 * t / w - 1.0).acos().mul_add(N as f64, 0.0).sin(), w), Verdict::Open, "{w}");
        }
    }

    #[test]
    fn a_begin_at_zero_is_left_before_it_is_judged() {
        // a ball that has bounced: up and down again
        let Verdict::Across { before, after } = judge(|t| t * (0.3 - t) - 1e-17, 1.0) else { panic!("not across") };
        assert!(before < -0.4 && after > -0.4, "{before} {after}");
        assert_eq!(judge(|t| t - 1e-17, 1.0), Verdict::Clear);
        // so short a flight that no place sees it, in a part that is too wide
        assert_eq!(judge(|t| t * (3e-4 - t) - 1e-17, 1.0), Verdict::Open);
        assert_ne!(judge(|t| t * (3e-4 - t) - 1e-17, 1e-2), Verdict::Open);
        assert_eq!(judge(|t| -1e-17 - t, 1.0), Verdict::Across { before: -1.0, after: -1.0 });
    }

    #[test]
    fn the_error_falls_by_the_eighth_power_of_the_width() {
        // grazes zero by 1e-6: open in a wide part, known in narrow ones
        let f = |t: f64| 1.0 + 1e-6 + (t + 2.0).sin();
        assert_eq!(judge(f, 6.0), Verdict::Open);
        assert_eq!(judge(f, 0.8), Verdict::Clear);
        assert_eq!(judge(|t| f(t + 2.0), 1.0), Verdict::Clear);
    }
}
