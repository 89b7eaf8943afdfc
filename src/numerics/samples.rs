//! What is known of a curve: its values at places, and the polynomials between them.

use super::chebyshev;
use super::panel::{Basis, NODES, Panel};

/// Parts of the stretch between two samples in which a polynomial is looked at.
const PARTS: usize = 8;

/// How often a third of one of them is left, until the greatest value is found to round-off.
const THIRDS: usize = 24;

/// Samples of a [`Curve`](super::continuous::Curve).
///
/// Places never fall; the ends of each piece are among them, so a break stands there twice, once with either piece.
#[derive(Clone, Copy, Debug)]
pub struct Samples<'a> {
    /// Where the columns were evaluated (n).
    pub places: &'a [f64],
    /// On which piece (n).
    pub pieces: &'a [usize],
    /// The values, column after column (columns × n).
    pub values: &'a [f64],
    /// What is between them, if that is known.
    pub(crate) between: Option<Between<'a>>,
}

/// Polynomials between samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Between<'a> {
    /// The panels of a resolved curve, rising.
    pub(crate) panels: &'a [Panel],
    /// Part of a column's largest magnitude that they leave out.
    pub(crate) width: f64,
    /// Round-off of each column (columns).
    pub(crate) noise: &'a [f64],
}

impl<'a> Samples<'a> {
    /// The samples of one column.
    pub fn column(&self, column: usize) -> &'a [f64] {
        let n = self.places.len();
        &self.values[column * n..(column + 1) * n]
    }

    /// The range of samples that belong to each piece, in order; pieces without samples are left out.
    pub fn runs(&self) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        let mut start = 0;
        self.pieces.chunk_by(|a, b| a == b).map(move |run| {
            start += run.len();
            start - run.len()..start
        })
    }

    /// Whether a sample is the first or the last of its piece.
    pub(crate) fn is_end(&self, sample: usize) -> bool {
        let own = self.pieces.get(sample);
        sample == 0 || self.pieces.get(sample - 1) != own || self.pieces.get(sample + 1) != own
    }

    /// Upper bound of sign · column, of the largest magnitude `size`, between the neighbours of a sample, as the polynomials tell it;
    /// infinite where they tell nothing.
    pub(crate) fn reach(&self, basis: &Basis, sample: usize, column: usize, sign: f64, size: f64) -> f64 {
        let Some(allowed) = self.left(column, size) else { return f64::INFINITY };
        let mut bound = f64::NEG_INFINITY;
        let known = self.parts(basis, sample, column, sign, |part| {
            let hidden = (1..PARTS).map(|i| bend(&part.x, &part.y, i)).fold(0.0, f64::max);
            let left = allowed.max(basis.tail(&part.panel.column(column)));
            bound = part.y.into_iter().fold(bound, |bound, y| bound.max(y + 0.5 * hidden + left));
        });
        if known { bound } else { f64::INFINITY }
    }

    /// Where sign · column is greatest between the neighbours of a sample by the polynomials; none where they do not resolve it.
    pub(crate) fn crest(&self, basis: &Basis, sample: usize, column: usize, sign: f64, size: f64) -> Option<f64> {
        let allowed = self.left(column, size)?;
        let (mut best, mut resolved): (Option<(f64, f64)>, bool) = (None, true);
        let known = self.parts(basis, sample, column, sign, |part| {
            resolved &= basis.tail(&part.panel.column(column)) <= allowed;
            let k = (0..=PARTS).max_by(|a, b| part.y[*a].total_cmp(&part.y[*b])).unwrap_or(0);
            if best.is_some_and(|(y, _)| y >= part.y[k]) {
                return;
            }
            let (mut low, mut high) = (part.x[k.saturating_sub(1)], part.x[(k + 1).min(PARTS)]);
            for _ in 0..THIRDS {
                let third = (high - low) / 3.0;
                if part.value(low + third) < part.value(high - third) { low += third } else { high -= third }
            }
            let middle = 0.5 * (low + high);
            best = Some(if part.value(middle) > part.y[k] { (part.value(middle), middle) } else { (part.y[k], part.x[k]) });
        });
        best.filter(|_| known && resolved).map(|(_, at)| at)
    }

    /// What the polynomials of a column of a size may leave out.
    fn left(&self, column: usize, size: f64) -> Option<f64> {
        self.between.map(|Between { width, noise, .. }| f64::max(width * size, noise[column]))
    }

    /// Calls `with` for the part of each panel between the neighbours of a sample; false if panels do not cover it.
    fn parts(&self, basis: &Basis, sample: usize, column: usize, sign: f64, mut with: impl FnMut(&Part<'_>)) -> bool {
        let Some(Between { panels, .. }) = self.between else { return false };
        let (piece, own) = (self.pieces[sample], self.places[sample]);
        let place = |k: Option<usize>| k.filter(|k| self.pieces.get(*k) == Some(&piece)).map_or(own, |k| self.places[k]);
        let (from, to) = (place(sample.checked_sub(1)), place(Some(sample + 1)));
        let first = panels.partition_point(|p| p.piece < piece || p.piece == piece && p.to <= from);
        let mut known = from;
        for panel in panels[first..].iter().take_while(|p| p.piece == piece && p.from < to) {
            let values = panel.column(column);
            if panel.from > known || !values.iter().all(|y| y.is_finite()) {
                return false;
            }
            let (low, high) = (panel.from.max(from), panel.to.min(to));
            let x = std::array::from_fn(|k| low + (high - low) * k as f64 / PARTS as f64);
            let mut part = Part { panel, series: basis.series(&values), sign, x, y: x };
            part.y = x.map(|x| part.value(x));
            with(&part);
            known = panel.to;
        }
        known >= to
    }
}

/// A part of a panel, cut into equal ones.
struct Part<'a> {
    panel: &'a Panel,
    series: [f64; NODES],
    sign: f64,
    /// Ends of the equal parts, and the values there, times the sign.
    x: [f64; PARTS + 1],
    y: [f64; PARTS + 1],
}

impl Part<'_> {
    fn value(&self, x: f64) -> f64 {
        self.sign * chebyshev::value(&self.series, self.panel.relative(x))
    }
}

/// How much the samples around sample i bend: |difference of the slopes| · width; four times what a parabola can hide between
/// two of them is half of it.
pub(crate) fn bend(x: &[f64], y: &[f64], i: usize) -> f64 {
    let at = |k: usize| {
        let (h0, h1) = (x[k] - x[k - 1], x[k + 1] - x[k]);
        let slopes = (y[k + 1] - y[k]) / h1 - (y[k] - y[k - 1]) / h0;
        // equal places or an undefined neighbour: nothing is known
        if slopes.is_finite() { slopes.abs() * h0.max(h1) } else { 0.0 }
    };
    let inner = i.saturating_sub(1).max(1)..(i + 2).min(x.len().saturating_sub(1));
    if x.len() < 3 {
        return if x.len() == 2 { (y[1] - y[0]).abs() } else { 0.0 };
    }
    inner.map(at).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bend_bounds_what_a_parabola_hides() {
        // the greatest of −(x − s)² over its samples is lower than the top by s² at most, s ≤ ½
        let x: Vec<f64> = (-3..=3).map(f64::from).collect();
        let y: Vec<f64> = x.iter().map(|x| -(x - 0.5) * (x - 0.5)).collect();
        assert_eq!(bend(&x, &y, 3), 2.0);
        assert_eq!(bend(&x, &y, 0), 2.0);
        assert_eq!(bend(&x[..2], &y[..2], 0), (y[1] - y[0]).abs());
        assert_eq!(bend(&x[..1], &y[..1], 0), 0.0);
    }
}
