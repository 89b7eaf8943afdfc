//! What is known around a change point of a driven motion: the polynomial through places around it, or a straight line.

/// Places of a polynomial.
pub(super) const PLACES: usize = 10;

/// A value has a pole at a change point if, times its distance from that, a polynomial misses it by no more than this part.
const POLAR: f64 = 1e-3;

/// A value that the polynomial through all places but one misses there by more than this part of its size is round-off.
const ROUGH: f64 = 0.1;

/// A change point on the way.
pub(crate) struct Passage {
    /// Progress there.
    pub(crate) at: f64,
    /// Progress in which the motion moves by 1 rad or size.
    pub(super) pace: f64,
    /// Whether constraints are singular there, and not only nearly so.
    pub(super) singular: bool,
    /// What is known around it in given modes; nothing where no polynomial serves.
    pub(super) known: Vec<(Vec<i32>, Option<Around>)>,
}

/// What is known around a change point.
pub(crate) struct Around {
    /// Distance between places, in progress.
    pub(super) spacing: f64,
    /// Numbers of the places, in distances from the change point.
    pub(super) offsets: [f64; PLACES],
    /// Values at the places (PLACES × values).
    pub(super) values: Vec<f64>,
    /// Values that are straight lines near the change point, and theirs on both sides at `reach`.
    pub(super) lines: Vec<(usize, [f64; 2])>,
    /// How far lines reach, in distances between places.
    pub(super) reach: f64,
    /// Whether that is because they grow without bound; else they are not known.
    pub(super) grow: bool,
}

impl Around {
    /// A value of the polynomial at x distances from the change point.
    pub(super) fn polynomial(&self, weights: &[f64; PLACES], value: usize) -> f64 {
        weights.iter().zip(self.of(value)).map(|(w, y)| w * y).sum()
    }

    /// A value at all places.
    pub(super) fn of(&self, value: usize) -> impl Iterator<Item = f64> + Clone + '_ {
        let count = self.values.len() / PLACES;
        self.values[value..].iter().step_by(count).copied()
    }

    /// Whether a value that is `y` at x grows towards the change point as a pole does: times x, |x| or x² it is a polynomial.
    pub(super) fn has_pole(&self, value: usize, x: f64, y: f64) -> bool {
        let weights = weights(&self.offsets, x);
        [|x: f64| x, f64::abs, |x| x * x].iter().any(|factor| {
            let finite = self.offsets.iter().zip(self.of(value)).map(|(o, y)| factor(*o) * y);
            let size = finite.clone().fold(0.0, |m: f64, p| m.max(p.abs()));
            let found: f64 = weights.iter().zip(finite).map(|(w, p)| w * p).sum();
            (factor(x) * y - found).abs() <= POLAR * size
        })
    }

    /// Whether a value is not smooth at the places themselves: it is round-off.
    pub(super) fn is_rough(&self, value: usize) -> bool {
        let size = self.of(value).fold(0.0, |m: f64, y| m.max(y.abs()));
        (1..PLACES - 1).step_by(2).any(|left_out| {
            let others = |k: &usize| *k != left_out;
            let offsets: [f64; PLACES - 1] = pick((0..PLACES).filter(others).map(|k| self.offsets[k]));
            let known = (0..PLACES).zip(self.of(value)).filter(|(k, _)| others(k)).map(|(_, y)| y);
            let found: f64 = weights(&offsets, self.offsets[left_out]).iter().zip(known).map(|(w, y)| w * y).sum();
            let there = self.of(value).nth(left_out).unwrap_or(0.0);
            (there - found).abs() >= ROUGH * size
        })
    }

    /// Puts what is known at x distances from the change point in the place of `out`, the values from `first` on; those that have a
    /// pole stay as they are beyond its line.
    pub(super) fn put(&self, x: f64, first: usize, out: &mut [f64]) {
        let weights = weights(&self.offsets, x);
        for (value, out) in (first..).zip(out) {
            match self.lines.iter().find(|(line, _)| *line == value) {
                None => *out = self.polynomial(&weights, value),
                Some((_, [before, after])) if x.abs() < self.reach => *out = before + 0.5 * (x / self.reach + 1.0) * (after - before),
                Some(_) => {}
            }
        }
    }
}

/// Lagrange's weights of places at x.
pub(super) fn weights<const N: usize>(places: &[f64; N], x: f64) -> [f64; N] {
    std::array::from_fn(|k| {
        let others = places.iter().enumerate().filter(|(i, _)| *i != k);
        others.map(|(_, o)| (x - o) / (places[k] - o)).product()
    })
}

fn pick<const N: usize>(mut from: impl Iterator<Item = f64>) -> [f64; N] {
    std::array::from_fn(|_| from.next().unwrap_or(0.0))
}
