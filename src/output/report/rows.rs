//! Which rows of a table a page needs to draw its curves.
//!
//! Between the rows that are kept a curve is Lagrange's polynomial through the four of them around it. Where one that is left out
//! lies off that curve by more than is allowed, the row in the middle is kept, too.

use std::ops::Range;

/// Rows that interpolation looks at.
const NODES: usize = 4;
/// Stretches between the rows that are kept first, in each smooth piece.
const STRETCHES: usize = 16;

/// The columns of a table as they are thinned.
pub(super) struct Curves<'a> {
    /// The independent variable of each row.
    pub(super) x: &'a [f64],
    /// Columns, each of as many numbers.
    pub(super) columns: Vec<&'a [f64]>,
    /// What each of them may be off between the rows that are kept.
    pub(super) allowed: Vec<Allowed>,
    /// Rows that stand just before a switch.
    pub(super) switches: &'a [usize],
}

/// What a curve may be off: `within` where an axis shows it, the same part more of how far it is beyond the ends of that axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed {
    pub(super) within: f64,
    pub(super) axis: [f64; 2],
}

impl Allowed {
    /// The same everywhere.
    pub(super) fn everywhere(within: f64) -> Self {
        Self { within, axis: [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// Where the curve has a value.
    fn at(&self, y: f64) -> f64 {
        let [low, high] = self.axis;
        let beyond = (low - y).max(y - high).max(0.0);
        if beyond > 0.0 { self.within * (1.0 + beyond / (high - low)) } else { self.within }
    }
}

/// The rows that are kept.
#[derive(Debug, PartialEq)]
pub(super) struct Kept {
    /// Their numbers, rising.
    pub(super) rows: Vec<usize>,
    /// Places in that list behind which a new smooth piece begins.
    pub(super) breaks: Vec<usize>,
    /// How far the others are off at most, in units of what is allowed; at most 1 unless `most` was reached.
    pub(super) off: f64,
}

impl Curves<'_> {
    /// Chooses rows, about `most` of them at most.
    pub(super) fn kept(&self, most: usize) -> Kept {
        let pieces = self.pieces();
        let mut kept = Kept { rows: Vec::new(), breaks: Vec::new(), off: 0.0 };
        let share = |piece: &Range<usize>| most * piece.len() / self.x.len().max(1);
        for piece in pieces {
            let (rows, off) = self.of_piece(piece.clone(), share(&piece));
            if !kept.rows.is_empty() {
                kept.breaks.push(kept.rows.len() - 1);
            }
            kept.rows.extend(rows);
            kept.off = kept.off.max(off);
        }
        kept
    }

    /// Smooth pieces: they end at switches, and where a column begins or ceases to have values.
    fn pieces(&self) -> Vec<Range<usize>> {
        let n = self.x.len();
        let ends = |i: &usize| {
            let (x, y) = (self.x[i - 1], self.x[*i]);
            let gap = |column: &&[f64]| column[i - 1].is_finite() != column[*i].is_finite();
            x == y || self.switches.binary_search(&(i - 1)).is_ok() || self.columns.iter().any(gap)
        };
        let cuts: Vec<usize> = std::iter::once(0).chain((1..n).filter(ends)).chain([n]).collect();
        cuts.windows(2).map(|ends| ends[0]..ends[1]).filter(|piece| !piece.is_empty()).collect()
    }

    /// Rows of one piece, and how far the others are off.
    fn of_piece(&self, piece: Range<usize>, most: usize) -> (Vec<usize>, f64) {
        let last = piece.len() - 1;
        if last <= NODES {
            return (piece.collect(), 0.0);
        }
        let stretches = STRETCHES.min(last);
        let mut rows: Vec<usize> = (0..=stretches).map(|k| piece.start + k * last / stretches).collect();
        let mut fresh = vec![true; stretches];
        loop {
            let bad: Vec<bool> = (0..rows.len() - 1).map(|k| fresh[k] && self.off(&rows, k, 1.0) > 1.0).collect();
            if !bad.contains(&true) {
                return (rows, 1.0);
            }
            if rows.len() >= most.max(STRETCHES + 1) {
                let off = (0..rows.len() - 1).map(|k| self.off(&rows, k, f64::INFINITY)).fold(0.0, f64::max);
                return (rows, off);
            }
            (rows, fresh) = halved(&rows, &bad);
        }
    }

    /// How far rows between `rows[k]` and the next one are off, in units of what is allowed; any number above `enough` ends the search.
    fn off(&self, rows: &[usize], k: usize, enough: f64) -> f64 {
        let first = k.saturating_sub(1).min(rows.len().saturating_sub(NODES));
        let nodes = &rows[first..(first + NODES).min(rows.len())];
        let mut worst = 0.0;
        for row in rows[k] + 1..rows[k + 1] {
            let weights = self.weights(nodes, self.x[row]);
            for (column, allowed) in self.columns.iter().zip(&self.allowed) {
                let off = nodes.iter().zip(weights).map(|(node, weight)| weight * column[*node]).sum::<f64>() - column[row];
                let off = off.abs() / allowed.at(column[row]);
                // a column that has no value in this piece asks for nothing; weights of rows at one place are no numbers
                if off.is_nan() && column[row].is_finite() {
                    return f64::INFINITY;
                }
                if off > worst {
                    worst = off;
                }
            }
            if worst > enough {
                break;
            }
        }
        worst
    }

    /// Weights of nodes at x in Lagrange's polynomial.
    fn weights(&self, nodes: &[usize], x: f64) -> [f64; NODES] {
        let mut weights = [0.0; NODES];
        for (k, weight) in weights.iter_mut().enumerate().take(nodes.len()) {
            let at = self.x[nodes[k]];
            let others = nodes.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, node)| self.x[*node]);
            *weight = others.map(|other| (x - other) / (at - other)).product();
        }
        weights
    }
}

/// Rows with those in the middle of bad stretches, and which stretches must be looked at again.
fn halved(rows: &[usize], bad: &[bool]) -> (Vec<usize>, Vec<bool>) {
    let (mut more, mut fresh) = (vec![rows[0]], Vec::new());
    for k in 0..bad.len() {
        let near = bad[k.saturating_sub(2)..(k + 3).min(bad.len())].contains(&true);
        let (from, to) = (rows[k], rows[k + 1]);
        if bad[k] {
            more.push(from + (to - from) / 2);
            fresh.push(true);
        }
        more.push(to);
        fresh.push(near);
    }
    (more, fresh)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(x: &[f64], y: &[f64], switches: &[usize], most: usize) -> Kept {
        Curves { x, columns: vec![y], allowed: vec![Allowed::everywhere(1e-4)], switches }.kept(most)
    }

    #[test]
    fn a_smooth_curve_takes_few_rows_and_is_met_by_them() {
        let x: Vec<f64> = (0..=3600).map(|i| f64::from(i) / 3600.0).collect();
        let y: Vec<f64> = x.iter().map(|x| (40.0 * x).sin()).collect();
        let kept = of(&x, &y, &[], 4000);
        assert!((80..300).contains(&kept.rows.len()), "{}", kept.rows.len());
        assert_eq!((kept.rows.first(), kept.rows.last(), kept.breaks.len()), (Some(&0), Some(&3600), 0));
        let curves = Curves { x: &x, columns: vec![&y], allowed: vec![Allowed::everywhere(1e-4)], switches: &[] };
        let off = (0..kept.rows.len() - 1).map(|k| curves.off(&kept.rows, k, f64::INFINITY)).fold(0.0, f64::max);
        assert!(off <= 1.0, "{off}");
    }

    #[test]
    fn both_sides_of_switches_and_gaps_are_kept() {
        let x: Vec<f64> = (0..100).map(|i| f64::from(if i > 40 { i - 1 } else { i })).collect();
        let mut y: Vec<f64> = (0..100).map(|i| if i > 40 { 5.0 } else { 1.0 }).collect();
        y[70..].fill(f64::NAN);
        let kept = of(&x, &y, &[40], 4000);
        let ends: Vec<[usize; 2]> = kept.breaks.iter().map(|&k| [kept.rows[k], kept.rows[k + 1]]).collect();
        assert_eq!(ends, [[40, 41], [69, 70]]);
    }

    #[test]
    fn noise_is_cut_off_and_says_how_far() {
        let x: Vec<f64> = (0..10_000).map(f64::from).collect();
        let y: Vec<f64> = x.iter().map(|x| (x * x * 0.37).sin()).collect();
        let kept = of(&x, &y, &[], 1000);
        assert!(kept.rows.len() < 2100 && kept.off > 100.0, "{} {}", kept.rows.len(), kept.off);
    }

    #[test]
    fn few_rows_are_all_kept() {
        for n in 0..6_i32 {
            let x: Vec<f64> = (0..n).map(f64::from).collect();
            assert_eq!(of(&x, &x, &[], 4000).rows, (0..n as usize).collect::<Vec<_>>());
        }
    }
}
