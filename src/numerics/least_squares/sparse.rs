//! Least squares of many rows by one sparse factorisation.
//!
//! ```text
//! Σ (aᵢ x − bᵢ)²/(2 eᵢ) + ½ w Σ dⱼ xⱼ²  is least where   [ w D  Aᵀ ] [x]   [0]
//!                                                        [ A   −E ] [λ] = [b],
//! ```
//!
//! with one e for the rows of each group: next to nothing for rows that must hold, 1 for those that are to be met as well as can be. Rows
//! that must hold may be redundant: E keeps the matrix regular, and iterative refinement against the matrix without it takes its
//! error away (Tikhonov's regularisation, iterated), as in the system of accelerations.

use super::rows::{Rows, length};
use grashof_solvers::{Factor, Sparsity};

/// E of rows that must hold, in parts of the square of each: rounding stands far below, the singular values that count far above.
const HARD: f64 = 1e-13;

/// Rows that must hold count as no shorter than this part of the longest, nor than this times what is round-off.
const SHORTEST: f64 = 1e-9;
const CLEAR: f64 = 10.0;

/// Steps of refinement.
const REFINEMENTS: usize = 3;

/// Steps of inverse iteration: the smallest of singular values that differ by powers of ten stands out after the first.
const ITERATIONS: usize = 4;

/// Rows with their right sides and the slack that they have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group<'r> {
    pub(super) rows: &'r Rows,
    pub(super) b: &'r [f64],
    pub(super) slack: Slack,
}

/// How well rows are to be met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Slack {
    /// They hold; singular values of A D^−½ up to `round_off` are nothing else.
    None { round_off: f64 },
    /// Squares of what is missing count 1/e, in parts of the square of the longest row.
    Some(f64),
}

/// The factored matrix, in units of the metric and of the rows: each by itself if they must hold, else by the longest of the group.
pub(super) struct Saddle {
    /// √D of the columns.
    root: Vec<f64>,
    factor: Factor<f64>,
    /// Row and column of each entry, column after column, and its value without the E of rows that hold.
    places: Vec<(usize, usize)>,
    plain: Vec<f64>,
    /// Unit of each row.
    unit: Vec<f64>,
}

impl Saddle {
    /// For groups of rows over `metric.len()` columns with the given weight w; none where the matrix is singular.
    pub(super) fn new(groups: &[Group], metric: &[f64], weight: f64) -> Option<Self> {
        let n = metric.len();
        let root: Vec<f64> = metric.iter().map(|d| d.sqrt()).collect();
        let rows: usize = groups.iter().map(|group| group.rows.len()).sum();
        let order = n + rows;
        // column after column, as the factor takes them: of x the weight, then its entries in the rows; of λ those of the row, then E
        let mut next = vec![1; order];
        for (i, line) in groups.iter().flat_map(|group| group.rows.lines()).enumerate() {
            next[n + i] += line.len();
            line.iter().for_each(|&(j, _)| next[j] += 1);
        }
        let mut end = 0;
        next.iter_mut().for_each(|next| end += std::mem::replace(next, end));
        let (mut places, mut values, mut plain) = (vec![(0, 0); end], vec![0.0; end], vec![0.0; end]);
        let mut enter = |i: usize, j: usize, value: f64, without: f64| {
            let k = next[j];
            (places[k], values[k], plain[k]) = ((i, j), value, without);
            next[j] += 1;
        };
        (0..n).for_each(|j| enter(j, j, weight, weight));
        let mut unit = Vec::with_capacity(rows);
        for group in groups {
            let longest = group.rows.longest(metric);
            let longest = if longest > 0.0 { longest } else { 1.0 };
            let (least, e, without) = match group.slack {
                Slack::None { round_off } => (f64::max(SHORTEST * longest, CLEAR * round_off), -HARD, 0.0),
                Slack::Some(e) => (longest, -e, -e),
            };
            for line in group.rows.lines() {
                let row = n + unit.len();
                let size = length(line, metric).max(least);
                for &(j, a) in line {
                    let a = a / (root[j] * size);
                    enter(row, j, a, a);
                    enter(j, row, a, a);
                }
                enter(row, row, e, without);
                unit.push(size);
            }
        }
        // the pattern is symmetric
        let mut factor = Factor::new(&Sparsity::new(order, order, places.iter().map(|&(i, j)| (j, i))));
        factor.factor(&values).ok()?;
        Some(Self { root, factor, places, plain, unit })
    }

    /// The solution x for a right side `top` of the first equations and those of the groups, one after the other; what is missing is 0.
    pub(super) fn solve(&mut self, top: &[f64], right: &[f64]) -> Vec<f64> {
        let mut b = vec![0.0; self.root.len() + self.unit.len()];
        let (first, rest) = b.split_at_mut(self.root.len());
        first.iter_mut().zip(top).zip(&self.root).for_each(|((b, top), root)| *b = top / root);
        rest.iter_mut().zip(right).zip(&self.unit).for_each(|((b, right), unit)| *b = right / unit);
        let mut x = b.clone();
        self.factor.solve(&mut x);
        for _ in 0..REFINEMENTS {
            let mut r = b.clone();
            self.places.iter().zip(&self.plain).for_each(|(&(i, j), a)| r[i] -= a * x[j]);
            self.factor.solve(&mut r);
            x.iter_mut().zip(&r).for_each(|(x, r)| *x += r);
        }
        x.iter().zip(&self.root).map(|(x, root)| x / root).collect()
    }

    /// An estimate, if at all too large, of the smallest singular value of rows that are alone in the matrix, with the weight 1: in units of
    /// the longest and of the metric; nothing below √E is seen.
    fn least_singular_value(&mut self) -> f64 {
        let n = self.root.len();
        let mut row: Vec<f64> = (0..self.unit.len()).map(|i| (1.0 + 2.4 * i as f64).cos()).collect();
        let mut square = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
            let mut x = vec![0.0; n];
            x.extend(row.iter().map(|x| x / length));
            self.factor.solve(&mut x);
            row.copy_from_slice(&x[n..]);
            // λ' = −(A Aᵀ + E)⁻¹ λ
            square = row.iter().map(|x| x * x).sum::<f64>().sqrt().recip();
        }
        (square - HARD).max(0.0).sqrt()
    }
}

/// An estimate of the smallest singular value of A D^−½, if at all too large; what is below 1e-7 of the longest row is not told from 0.
pub(super) fn least_singular_value(rows: &Rows, metric: &[f64]) -> f64 {
    let group = Group { rows, b: &[], slack: Slack::Some(HARD) };
    Saddle::new(&[group], metric, 1.0).map_or(0.0, |mut saddle| saddle.least_singular_value() * rows.longest(metric))
}

/// The solution of groups of rows with a weight, by one factorisation; none where the matrix is singular.
pub(super) fn solve(groups: &[Group], metric: &[f64], weight: f64) -> Option<Vec<f64>> {
    let mut saddle = Saddle::new(groups, metric, weight)?;
    let right: Vec<f64> = groups.iter().flat_map(|group| group.b.iter().copied()).collect();
    let x = saddle.solve(&[], &right);
    x.iter().all(|x| x.is_finite()).then_some(x)
}
