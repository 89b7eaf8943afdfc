//! Global extremes of all columns of a curve, on the continuous solution.
//!
//! Samples, and the polynomials of a resolved curve between them, tell where an extreme could be and how high it could be at most.
//! Where the polynomials tell the place of a peak, its height is the curve's value there, which an error of the place changes by
//! its square only; the highest peak is then refined, and where nothing is known between samples all that could be the highest are:
//! the curve is evaluated at twelve Chebyshev nodes between the neighbouring samples, and the derivative of the interpolant is
//! solved. The bracket is then made narrower until twelve nodes resolve the curve, or wider where round-off in the values, not
//! the polynomial, limits the place: noise ε in the values of y displaces the extreme by about 12 ε / (H |y″|), H the half-width
//! of the bracket. All columns are evaluated at once, so brackets of the same samples are shared.

use super::chebyshev;
use super::chebyshev::{Basis, NODES};
use super::continuous::Curve;
use super::panel;
use super::peaks;
use super::peaks::{Candidate, peaks};
use super::samples::Samples;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Places whose values differ by less than this part of the value are a tie: the first of them is reported.
pub const TIE: f64 = 1e-12;

/// Most brackets that are looked into for one extreme: enough for as many equal teeth. Fewer where more than every sixth sample is
/// a local extreme, which is noise and not motion.
const MOST_BRACKETS: usize = 64;
const MOST_NOISY: usize = 4;

/// A place error below this part of the range needs no wider bracket.
const PLACE: f64 = 1e-12;

/// An extreme so near to a sample (part of the range) that has the same value is at the sample.
const SNAP: f64 = 1e-10;

/// Each narrower bracket has this part of the width of the last; a wider one at most so many times.
const NARROWER: f64 = 0.25;
const MOST_WIDER: f64 = 16.0;

/// One extreme of a column.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extremum {
    /// The value there, as the curve gives it.
    pub value: f64,
    /// The place.
    pub at: f64,
    /// The piece it was evaluated on: tells the sides of a break apart.
    pub piece: usize,
}

/// The extremes of one column.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// The least value.
    pub min: Extremum,
    /// The greatest value.
    pub max: Extremum,
}

/// The extremes of each column of a curve over [from, to]; none for a column that is NaN at every sample.
///
/// `samples` must be fine enough to show every peak that matters by at least one raised sample; `breaks` is `from, switches …,
/// to`. One-sided values at breaks and both ends take part. Equal extremes give the first place, a dwell its first sample, a constant
/// column its first. NaN samples are skipped. Places are good to about 1e-10 of the range where a column is smooth and its
/// values carry round-off of 1e-13; values to round-off. Where the curve cannot be evaluated around a sample, the sample counts.
pub fn extrema<C: Curve>(curve: &mut C, samples: Samples<'_>, breaks: &[f64]) -> Vec<Option<Extremes>> {
    let columns = curve.columns();
    let mut search = Search {
        curve,
        samples,
        breaks,
        basis: Basis::new(),
        polynomials: panel::Basis::new(),
        first: HashMap::new(),
        nodes: vec![0.0; NODES * columns],
        out: vec![0.0; columns],
    };
    (0..columns)
        .map(|column| {
            let max = search.greatest(column, 1.0);
            let min = search.greatest(column, -1.0);
            min.zip(max).map(|(min, max)| Extremes { min, max })
        })
        .collect()
}

/// Part of one piece, (from, to).
#[derive(Clone, Copy)]
struct Bracket {
    from: f64,
    to: f64,
    piece: usize,
}

impl Bracket {
    fn half(&self) -> f64 {
        0.5 * (self.to - self.from)
    }

    fn at(&self, s: f64) -> f64 {
        0.5 * (self.from + self.to) + self.half() * s
    }

    /// The bracket around x, `factor` times as wide, inside of `limits`.
    fn around(&self, x: f64, factor: f64, limits: (f64, f64)) -> Self {
        let half = factor * self.half();
        Self { from: (x - half).max(limits.0), to: (x + half).min(limits.1), piece: self.piece }
    }
}

/// The greatest point of an interpolant.
struct Peak {
    at: f64,
    /// Estimated error of the place; infinite at an end of the bracket.
    error: f64,
    /// How much wider the bracket may be before twelve nodes do not resolve the curve; 1 or less: not at all.
    wider: f64,
    /// Whether a narrower bracket can tell nothing more.
    resolved: bool,
}

struct Search<'a, C: Curve> {
    curve: &'a mut C,
    samples: Samples<'a>,
    breaks: &'a [f64],
    basis: Basis,
    /// Of the polynomials between samples.
    polynomials: panel::Basis,
    /// Values at the nodes (NODES × columns) of the bracket around a sample, by its index.
    first: HashMap<usize, Vec<f64>>,
    /// The same for any other bracket.
    nodes: Vec<f64>,
    /// Values at one place.
    out: Vec<f64>,
}

impl<C: Curve> Search<'_, C> {
    /// The greatest value of sign · column.
    fn greatest(&mut self, column: usize, sign: f64) -> Option<Extremum> {
        let samples = self.samples;
        let values = samples.column(column);
        let magnitude = peaks::magnitude(values);
        let highest = values.iter().fold(f64::NEG_INFINITY, |m, y| f64::max(m, sign * y));
        if highest == f64::NEG_INFINITY {
            return None;
        }
        // the best sample takes part whatever becomes of its peak: of noise, only the most promising peaks are looked into
        let top = values.iter().position(|y| sign * y == highest).unwrap_or(0);
        let looked = Candidate { y: highest, at: samples.places[top], piece: samples.pieces[top] };
        // the values at the ends of pieces are those of the curve
        let mut found = vec![if samples.is_end(top) { looked } else { self.exact(column, sign, looked) }];
        let mut best = found[0].y;
        let mut peaks = peaks(samples, values, sign, highest, &mut found);
        for (sample, bound) in peaks.iter_mut().filter(|(_, bound)| *bound >= best - tie(best, magnitude)) {
            *bound = bound.min(samples.reach(&self.polynomials, *sample, column, sign, magnitude));
        }
        // the most promising first, so that the others can be left out
        let noisy = peaks.len() > 16 + values.len() / 6;
        peaks.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        peaks.truncate(if noisy { MOST_NOISY } else { MOST_BRACKETS });
        // where polynomials tell the place, one value tells which peak is the highest, and that one is refined in the end
        let mut coarse = Vec::new();
        for (sample, bound) in peaks {
            if bound < best - tie(best, magnitude) {
                break;
            }
            let itself = Candidate { y: sign * values[sample], at: samples.places[sample], piece: samples.pieces[sample] };
            let candidate = match samples.crest(&self.polynomials, sample, column, sign, magnitude) {
                Some(at) if at == itself.at && samples.is_end(sample) => itself,
                Some(at) => {
                    coarse.push((at, itself.piece, sample));
                    self.exact(column, sign, Candidate { at, ..itself })
                }
                // next to a dead point places can no longer be reached: there the sample counts
                None => self.refine(column, sign, sample).unwrap_or(itself),
            };
            best = best.max(candidate.y);
            found.push(candidate);
        }
        let level = best - tie(best, magnitude);
        let first = found.iter().filter(|c| c.y >= level).min_by(|a, b| a.at.total_cmp(&b.at).then(a.piece.cmp(&b.piece)))?;
        let sample = coarse.iter().find(|(at, piece, _)| *at == first.at && *piece == first.piece).map(|c| c.2);
        let first = match sample {
            Some(sample) => self.refine(column, sign, sample).ok().filter(|c| c.y >= level).unwrap_or(*first),
            None if self.breaks.contains(&first.at) => *first,
            // the begin of a dwell is a sample
            None => self.exact(column, sign, *first),
        };
        Some(Extremum { value: sign * first.y, at: first.at, piece: first.piece })
    }

    /// A candidate with the value of the curve; as it is where there is none.
    fn exact(&mut self, column: usize, sign: f64, candidate: Candidate) -> Candidate {
        match self.curve.eval(candidate.at, candidate.piece, &mut self.out) {
            Ok(()) if self.out[column].is_finite() => Candidate { y: sign * self.out[column], ..candidate },
            _ => candidate,
        }
    }

    /// The best place around a sample, or the sample itself where there is nothing better.
    fn refine(&mut self, column: usize, sign: f64, sample: usize) -> Result<Candidate, C::Error> {
        let (places, pieces, values) = (self.samples.places, self.samples.pieces, self.samples.column(column));
        let piece = pieces[sample];
        let by_itself = |k: usize| Candidate { y: sign * values[k], at: places[k], piece };
        let itself = self.exact(column, sign, by_itself(sample));
        let neighbour = |k: usize| (pieces.get(k) == Some(&piece) && !values[k].is_nan()).then_some(k);
        let left = sample.checked_sub(1).and_then(neighbour).unwrap_or(sample);
        let right = neighbour(sample + 1).unwrap_or(sample);
        let mut bracket = Bracket { from: places[left], to: places[right], piece };
        if bracket.half() <= 0.0 {
            return Ok(itself);
        }
        let Some(mut peak) = self.first_peak(column, sign, sample, bracket)? else { return Ok(itself) };
        while !peak.resolved {
            let narrower = bracket.around(peak.at, NARROWER, (bracket.from, bracket.to));
            match self.peak(column, sign, narrower, peak.at)? {
                Some(next) if next.error < peak.error => (bracket, peak) = (narrower, next),
                // round-off is reached
                _ => break,
            }
        }
        if peak.wider > 1.5 && peak.error > PLACE * self.range() {
            let wider = bracket.around(peak.at, peak.wider, (self.breaks[piece], self.breaks[piece + 1]));
            if let Some(next) = self.peak(column, sign, wider, peak.at)?
                && next.error < peak.error
            {
                peak = next;
            }
        }
        self.curve.eval(peak.at, piece, &mut self.out)?;
        let y = sign * self.out[column];
        // the beginning or end of a piece where the slope vanishes is that place, not one a little beside it
        let close = peak.error.clamp(SNAP * self.range(), 100.0 * SNAP * self.range());
        let end = [left, right].into_iter().map(by_itself).find(|end| (end.at - peak.at).abs() <= close && end.y >= y - tie(y, y.abs()));
        // and what round-off makes lower than the sample beside it is still the better place
        let refined = if y >= itself.y - 1e-13 * y.abs() { Candidate { y, at: peak.at, piece } } else { itself };
        Ok(end.unwrap_or(refined))
    }

    /// Width of all pieces together.
    fn range(&self) -> f64 {
        self.breaks[self.breaks.len() - 1] - self.breaks[0]
    }

    /// The peak between the neighbours of a sample; all columns share the evaluation.
    fn first_peak(&mut self, column: usize, sign: f64, sample: usize, bracket: Bracket) -> Result<Option<Peak>, C::Error> {
        // a column with an undefined neighbour has a bracket of its own
        let n = self.samples.places.len();
        let inside = |k: usize| k < n && self.samples.pieces[k] == bracket.piece;
        let full = (sample == 0 || !inside(sample - 1) || self.samples.places[sample - 1] == bracket.from)
            && (!inside(sample + 1) || self.samples.places[sample + 1] == bracket.to);
        if !full {
            return self.peak(column, sign, bracket, self.samples.places[sample]);
        }
        let values = match self.first.remove(&sample) {
            Some(values) => values,
            None => {
                self.evaluate(bracket)?;
                self.nodes.clone()
            }
        };
        let peak = self.highest(&values, column, sign, bracket, self.samples.places[sample]);
        self.first.insert(sample, values);
        Ok(peak)
    }

    /// The peak in any bracket.
    fn peak(&mut self, column: usize, sign: f64, bracket: Bracket, near: f64) -> Result<Option<Peak>, C::Error> {
        self.evaluate(bracket)?;
        Ok(self.highest(&self.nodes, column, sign, bracket, near))
    }

    /// All columns at the nodes of a bracket.
    fn evaluate(&mut self, bracket: Bracket) -> Result<(), C::Error> {
        let columns = self.curve.columns();
        for (s, out) in self.basis.nodes().iter().zip(self.nodes.chunks_exact_mut(columns)) {
            self.curve.eval(bracket.at(*s), bracket.piece, out)?;
        }
        Ok(())
    }

    /// The local maximum of one column's interpolant next to the place `near`; none where a value is not finite or all are equal.
    fn highest(&self, nodes: &[f64], column: usize, sign: f64, bracket: Bracket, near: f64) -> Option<Peak> {
        let columns = self.out.len();
        let y: [f64; NODES] = std::array::from_fn(|j| sign * nodes[j * columns + column]);
        if !y.iter().all(|y| y.is_finite()) {
            return None;
        }
        let series = self.basis.series(&y);
        let slope = chebyshev::derivative(&series);
        let bend = chebyshev::derivative(&slope);
        // start from data, not from what a poor interpolant makes of it: the highest node, if higher than what is known
        let near = (near - bracket.at(0.0)) / bracket.half();
        let node = (0..NODES).max_by(|i, j| y[*i].total_cmp(&y[*j])).filter(|j| y[*j] > chebyshev::value(&series, near));
        let near = node.map_or(near, |j| self.basis.nodes()[j]);
        let mut best: Option<f64> = None;
        let mut offer = |s: f64| {
            if best.is_none_or(|b| (s - near).abs() < (b - near).abs()) {
                best = Some(s);
            }
        };
        chebyshev::zeros(&slope, |s| {
            if chebyshev::value(&bend, s) < 0.0 {
                offer(s)
            }
        });
        for end in [-1.0, 1.0] {
            if end * chebyshev::value(&slope, end) > 0.0 {
                offer(end);
            }
        }
        let s = best?;

        // round-off of the values, or what the polynomial leaves out
        let round_off = f64::EPSILON * y.iter().fold(0.0, |m, y| f64::max(m, y.abs()));
        let tail = series[NODES - 3..].iter().fold(round_off, |m, c| f64::max(m, c.abs()));
        let error = match s.abs() < 1.0 {
            true => NODES as f64 * tail / chebyshev::value(&bend, s).abs() * bracket.half(),
            false => f64::INFINITY,
        };
        let resolved = tail <= 64.0 * round_off || error < PLACE * self.range();
        let at = if s == -1.0 {
            bracket.from
        } else if s == 1.0 {
            bracket.to
        } else {
            bracket.at(s)
        };
        Some(Peak { at, error, wider: wider(&series, tail), resolved })
    }
}

/// By what factor a bracket can be widened before the last coefficient rises above the noise: |c_k| ≈ c r^(k−2) gets the
/// factor w^k.
fn wider(series: &chebyshev::Series, noise: f64) -> f64 {
    let significant = series.iter().rposition(|c| c.abs() > 4.0 * noise).unwrap_or(0);
    if significant + 2 >= NODES {
        return 1.0;
    }
    let largest = series[2..].iter().fold(noise, |m, c| f64::max(m, c.abs()));
    let last = (significant + 1).max(3) - 2;
    let r = (noise / largest).powf(1.0 / last as f64);
    let n = NODES as f64;
    ((noise / largest) / r.powf(n - 2.0)).powf(1.0 / n).clamp(1.0, MOST_WIDER)
}

/// How far below the best value a place counts as equal.
fn tie(best: f64, magnitude: f64) -> f64 {
    TIE * best.abs() + 4.0 * f64::EPSILON * magnitude
}

#[cfg(test)]
#[path = "extremum_tests.rs"]
mod tests;
