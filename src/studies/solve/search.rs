//! The first zero along [0, 1] of a function that is not defined everywhere, and that may jump.
//!
//! Ends, grids of 2, 4, ... [`MOST_INTERVALS`] equal intervals until two neighbours differ in sign, then the edges of where the
//! function is defined, approached by halving, then dips of the grid ([`root::first`]). A change of sign is closed by
//! Chandrupatla's method ([`root::root`]); where values are missing inside of a bracket it shrinks to the edge of the gap, from
//! either side. What changes its sign without coming near zero is a jump or a pole.

use crate::numerics::root;
use crate::numerics::root::Root;
use crate::par;

/// Most intervals of the grid.
const MOST_INTERVALS: usize = 64;
/// Halvings towards an edge of where the function is defined.
const HALVINGS: usize = 30;
/// Width of the last bracket.
const CLOSE: f64 = 1e-14;
/// A change of sign with both values above this part of the larger one at the bracket's ends is a jump.
const JUMP: f64 = 1e-3;

/// A value of the function; not a number where it has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub(super) at: f64,
    pub(super) value: f64,
}

/// A zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Zero {
    pub(super) at: f64,
    pub(super) value: f64,
    /// The last bracket, rising.
    pub(super) bracket: [f64; 2],
    /// The larger |value| at the ends of the first bracket.
    pub(super) scale: f64,
    /// Brackets of further changes of sign that were seen.
    pub(super) others: Vec<[f64; 2]>,
}

/// A search and what it has seen. `f` gives NaN where it has no value, and an error to end the search.
pub(super) struct Search<'f, E> {
    pub(super) f: &'f (dyn Fn(f64) -> Result<f64, E> + Sync),
    /// Threads for the grid; the result does not depend on them.
    pub(super) threads: usize,
    /// Values on the grid and towards edges, by place.
    pub(super) samples: Vec<Sample>,
    /// Jumps over zero.
    pub(super) jumps: Vec<Root>,
    /// Changes of sign over places without values.
    pub(super) gaps: Vec<[f64; 2]>,
}

impl<'f, E: Send> Search<'f, E> {
    pub(super) fn new(f: &'f (dyn Fn(f64) -> Result<f64, E> + Sync), threads: usize) -> Self {
        Self { f, threads, samples: Vec::new(), jumps: Vec::new(), gaps: Vec::new() }
    }

    /// The first zero, if the search finds one.
    pub(super) fn zero(&mut self) -> Result<Option<Zero>, E> {
        self.look(&[0.0, 1.0])?;
        if self.samples.iter().all(|sample| sample.value == 0.0) {
            // whether it is zero all along
            self.look(&[0.5])?;
        }
        let mut intervals = 1;
        loop {
            if let Some(zero) = self.closed()? {
                return Ok(Some(zero));
            }
            if intervals == MOST_INTERVALS {
                break;
            }
            let middles: Vec<f64> = (0..intervals).map(|i| (i as f64 + 0.5) / intervals as f64).collect();
            self.look(&middles)?;
            intervals *= 2;
        }
        if let Some(zero) = self.edges()? {
            return Ok(Some(zero));
        }
        // a dip is looked for where no sign changes
        if self.jumps.is_empty() && self.gaps.is_empty() { self.dips() } else { Ok(None) }
    }

    /// Takes values at some places.
    fn look(&mut self, places: &[f64]) -> Result<(), E> {
        let values = par::map(places.len(), self.threads, |i| (self.f)(places[i]), || {});
        for (at, value) in places.iter().zip(values) {
            self.samples.push(Sample { at: *at, value: value? });
        }
        self.samples.sort_by(|a, b| a.at.total_cmp(&b.at));
        Ok(())
    }

    /// The first zero that the samples show: a sample itself, or between two of them that differ in sign.
    fn closed(&mut self) -> Result<Option<Zero>, E> {
        let known: Vec<Sample> = self.samples.iter().copied().filter(|s| !s.value.is_nan()).collect();
        if let Some(first) = known.first().filter(|s| s.value == 0.0) {
            let further = known.windows(2).filter(|w| w[1].value == 0.0 || opposite(w[0], w[1]));
            let others = further.map(|w| if w[1].value == 0.0 { [w[1].at; 2] } else { [w[0].at, w[1].at] }).collect();
            return Ok(Some(Zero { at: first.at, value: 0.0, bracket: [first.at; 2], scale: 0.0, others }));
        }
        let brackets: Vec<[Sample; 2]> = known.windows(2).map(|w| [w[0], w[1]]).filter(|[a, b]| opposite(*a, *b)).collect();
        for (k, bracket) in brackets.iter().enumerate() {
            if self.refused(bracket) {
                continue;
            }
            if let Some(mut zero) = self.close(*bracket)? {
                zero.others = brackets[k + 1..].iter().map(|[a, b]| [a.at, b.at]).collect();
                return Ok(Some(zero));
            }
        }
        Ok(None)
    }

    /// Whether a change of sign in a bracket was found to be no zero.
    fn refused(&self, [a, b]: &[Sample; 2]) -> bool {
        let inside = |x: f64| (a.at..=b.at).contains(&x);
        self.jumps.iter().any(|jump| inside(jump.before) && inside(jump.after))
            || self.gaps.iter().any(|gap| gap.iter().all(|x| inside(*x)))
    }

    /// The zero in a bracket; none if it is a jump or a gap, which is noted.
    fn close(&mut self, [a, b]: [Sample; 2]) -> Result<Option<Zero>, E> {
        let Some(mut root) = root::root(self.f, a.at, b.at, a.value, b.value, CLOSE)? else { return Ok(None) };
        if root.f_after.is_nan() && b.value == 0.0 {
            // zero from somewhere on: from where
            let level = |x: f64| Ok(if (self.f)(x)? == 0.0 { 1.0 } else { -1.0 });
            let found = root::root(level, b.at, root.after, 1.0, -1.0, CLOSE)?;
            let at = found.map_or(b.at, |edge| edge.before);
            return Ok(Some(Zero { at, value: 0.0, bracket: [root.before, at], scale: a.value.abs(), others: Vec::new() }));
        }
        if root.f_after.is_nan() {
            let back = root::root(self.f, b.at, root.after, b.value, f64::NAN, CLOSE)?;
            match back.filter(|back| !back.f_after.is_nan()) {
                Some(back) => root = back,
                None => {
                    self.gaps.push([root.before, back.map_or(b.at, |back| back.before)]);
                    return Ok(None);
                }
            }
        }
        Ok(self.accepted(root, a.value.abs().max(b.value.abs())))
    }

    fn accepted(&mut self, root: Root, scale: f64) -> Option<Zero> {
        let (at, value) = if root.place() == root.before { (root.before, root.f_before) } else { (root.after, root.f_after) };
        if value.abs() > JUMP * scale {
            self.jumps.push(root);
            return None;
        }
        let bracket = [root.before.min(root.after), root.before.max(root.after)];
        Some(Zero { at, value, bracket, scale, others: Vec::new() })
    }

    /// A zero between the last value known and the first place without one.
    fn edges(&mut self) -> Result<Option<Zero>, E> {
        let pairs: Vec<[Sample; 2]> = self.samples.windows(2).map(|w| [w[0], w[1]]).collect();
        for [a, b] in pairs {
            let (mut known, mut missing) = match (a.value.is_nan(), b.value.is_nan()) {
                (false, true) => (a, b),
                (true, false) => (b, a),
                _ => continue,
            };
            for _ in 0..HALVINGS {
                let at = 0.5 * (known.at + missing.at);
                let sample = Sample { at, value: (self.f)(at)? };
                if sample.value.is_nan() {
                    missing = sample;
                } else if opposite(known, sample) {
                    if let Some(zero) = self.close([known, sample])? {
                        return Ok(Some(zero));
                    }
                    break;
                } else {
                    known = sample;
                    self.samples.push(sample);
                }
            }
        }
        self.samples.sort_by(|a, b| a.at.total_cmp(&b.at));
        Ok(None)
    }

    /// A zero where the values dip through it and back between two samples.
    fn dips(&mut self) -> Result<Option<Zero>, E> {
        let samples = self.samples.clone();
        for known in samples.split(|s| s.value.is_nan()) {
            let (places, values): (Vec<f64>, Vec<f64>) = known.iter().map(|s| (s.at, s.value)).unzip();
            let found = root::first(self.f, &places, &values, CLOSE)?;
            if let Some((_, root)) = found.filter(|(_, root)| !root.f_after.is_nan()) {
                let scale = values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                if let Some(zero) = self.accepted(root, scale) {
                    return Ok(Some(zero));
                }
            }
        }
        Ok(None)
    }
}

/// Whether the second value is zero or of the other sign.
fn opposite(a: Sample, b: Sample) -> bool {
    a.value != 0.0 && a.value.signum() * b.value <= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// The zero, how many values were taken, jumps and gaps.
    fn search(f: impl Fn(f64) -> f64 + Sync) -> (Option<Zero>, usize, Vec<Root>, Vec<[f64; 2]>) {
        let count = AtomicUsize::new(0);
        let counted = |x: f64| {
            count.fetch_add(1, Ordering::Relaxed);
            Ok::<f64, Infallible>(f(x))
        };
        let mut search = Search::new(&counted, 2);
        let zero = search.zero().unwrap();
        (zero, count.load(Ordering::Relaxed), search.jumps, search.gaps)
    }

    #[test]
    fn ends_of_other_sign_are_closed_to_round_off_in_few_values() {
        for sign in [1.0, -1.0] {
            let (zero, count, ..) = search(|x| sign * ((3.0 * x).exp() - 2.0));
            let zero = zero.unwrap();
            assert!((zero.at - 2f64.ln() / 3.0).abs() < 1e-14 && zero.value.abs() < 1e-14, "{zero:?}");
            assert!(count <= 13, "{count} values");
        }
    }

    #[test]
    fn noise_does_not_keep_a_zero_from_being_found() {
        let noise = |x: f64| 1e-9 * ((1e12 * x).sin() + (3e9 * x).cos());
        let (zero, count, ..) = search(|x| x * x - 0.3 + noise(x));
        assert!((zero.unwrap().at - 0.3f64.sqrt()).abs() < 4e-9);
        assert!(count < 60, "{count} values");
    }

    #[test]
    fn the_first_of_several_zeros_is_found_and_the_others_are_told() {
        let (zero, ..) = search(|x| (x - 0.2) * (x - 0.4) * (x - 0.6) * (x - 0.9));
        let zero = zero.unwrap();
        assert!((zero.at - 0.2).abs() < 1e-14);
        // quarters hold one zero each
        assert_eq!(zero.others, [[0.25, 0.5], [0.5, 0.75], [0.75, 1.0]], "{zero:?}");
        // an end that is a zero itself
        assert_eq!(search(|x| x * (x - 0.5)).0.unwrap().at, 0.0);
    }

    #[test]
    fn a_dip_between_the_values_of_the_finest_grid_is_found() {
        let (zero, ..) = search(|x| (x - 0.507) * (x - 0.507) - 1e-6);
        assert!((zero.unwrap().at - 0.506).abs() < 1e-12);
        assert_eq!(search(|x| (x - 0.507) * (x - 0.507) + 1e-6).0, None);
    }

    #[test]
    fn missing_values_narrow_the_bracket_from_their_side() {
        // one end, both ends, and so near to the zero that only halving comes between
        for (from, to) in [(0.3, 2.0), (-1.0, 0.9), (0.3, 0.9), (0.4999, 0.51), (0.2, 0.500_01)] {
            let (zero, ..) = search(|x| if x < from || x > to { f64::NAN } else { x.powi(3) - 0.125 });
            assert!((zero.unwrap().at - 0.5).abs() < 1e-14, "{from} {to}");
        }
        // in the middle, beside the zero, whichever side it lies on
        for (from, to) in [(0.2, 0.45), (0.55, 0.9)] {
            let (zero, ..) = search(|x| if x > from && x < to { f64::NAN } else { x - 0.5 });
            assert!((zero.unwrap().at - 0.5).abs() < 1e-14, "{from} {to}");
        }
        // over the zero
        let (zero, _, _, gaps) = search(|x| if x > 0.4 && x < 0.6 { f64::NAN } else { x - 0.5 });
        assert!(zero.is_none() && gaps.len() == 1, "{gaps:?}");
        assert!((gaps[0][0] - 0.4).abs() < 1e-13 && (gaps[0][1] - 0.6).abs() < 1e-13, "{gaps:?}");
    }

    #[test]
    fn jumps_and_poles_are_no_zeros() {
        let (zero, _, jumps, _) = search(|x| if x < 0.3 { -1.0 } else { 0.5 });
        assert!(zero.is_none() && (jumps[0].before - 0.3).abs() < 1e-13, "{jumps:?}");
        assert!(search(|x| 1.0 / (x - 0.3)).0.is_none());
        // a zero behind a jump
        let (zero, ..) = search(|x| if x < 0.3 { -1.0 } else { 0.8 - x });
        assert!((zero.unwrap().at - 0.8).abs() < 1e-14);
        // a step onto zero is met where it steps
        let (zero, ..) = search(|x| if x < 0.3 { -1.0 } else { 0.0 });
        assert!((zero.unwrap().at - 0.3).abs() < 1e-13);
        // the same behind a gap
        let (zero, ..) = search(|x| {
            if x < 0.3 {
                -1.0
            } else if x < 0.35 {
                f64::NAN
            } else {
                0.0
            }
        });
        assert!((zero.unwrap().at - 0.35).abs() < 1e-13);
    }
}
