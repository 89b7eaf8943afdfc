//! Sparse LU factorisation, made for many matrices of one pattern.

use super::columns::Columns;
use super::dense::{self, Singular, log_determinant, pivot_ratio};
use super::number::Number;
use super::ordering::Ordering;
use super::pivoting::Pivoting;
use crate::Sparsity;
use crate::sparsity::DENSE_UP_TO;

/// At least this part of the largest entry of its column for a pivot when pivots are kept.
const KEPT: f64 = 1e-3;

/// Kept pivots may let max |u| / max |a| grow to this many times what it was when they were chosen.
const GROWTH: f64 = 100.0;

/// P A Q = L U with L unit lower and U upper triangular, by columns; no allocation while the pivots hold.
///
/// Q is the minimum degree order of the pattern. The first factorisation chooses the row order P: Gilbert & Peierls, SIAM J. Sci.
/// Stat. Comput. 9 (1988) 862-874, with the diagonal preferred from 0.1 of the largest entry of its column on. The next ones keep
/// Q, P and the patterns of L and U and only compute numbers. When a kept pivot falls below 1e-3 of its column or the entries
/// of U grow 100 times as much as with fresh pivots, the pivots are chosen anew.
#[derive(Clone, Debug)]
pub struct SparseLu<T: Number> {
    /// Rows of the entries of each column.
    columns: Sparsity,
    /// Column eliminated at each step: Q (n).
    order: Vec<usize>,
    /// Step at which each row is the pivot: P (n).
    step: Vec<u32>,
    /// Whether P, L and U stand.
    factored: bool,
    /// Entries of A by steps: place in the values given, and step of the row.
    source: Columns<(u32, u32)>,
    /// L without its diagonal: steps of the rows, rising.
    lower: Columns<u32>,
    lower_values: Vec<T>,
    /// U without its diagonal: steps of the rows, rising.
    upper: Columns<u32>,
    upper_values: Vec<T>,
    /// Reciprocal pivots (n).
    inverse: Vec<T>,
    /// max |u| / max |a| when the pivots were chosen.
    growth: f64,
    /// One column or right-hand side, by steps (n). What a solution leaves here does no harm: fill in row i comes from an
    /// earlier column with this row, so a row is first met in an entry of A, which overwrites it.
    x: Vec<T>,
    /// Choice of pivots.
    pivoting: Pivoting<T>,
}

/// Why pivots cannot be kept.
struct Unfit;

impl SparseLu<f64> {
    /// The sign of det A of the matrix factored last, 1 or −1: of the pivots and of both permutations.
    pub fn determinant_sign(&self) -> f64 {
        let steps: Vec<usize> = self.step.iter().map(|step| *step as usize).collect();
        dense::pivot_sign(&self.inverse) * permutation_sign(&self.order) * permutation_sign(&steps)
    }
}

/// 1 for an even permutation, −1 for an odd one: each cycle of length k is k − 1 exchanges.
fn permutation_sign(order: &[usize]) -> f64 {
    let mut seen = vec![false; order.len()];
    let mut sign = 1.0;
    for first in 0..order.len() {
        let mut at = first;
        while !std::mem::replace(&mut seen[at], true) {
            at = order[at];
            if at != first {
                sign = -sign;
            }
        }
    }
    sign
}

impl<T: Number> SparseLu<T> {
    /// Orders the unknowns of a square pattern. No pivots are chosen yet.
    pub fn new(pattern: &Sparsity) -> Self {
        Self::with_order(pattern, Ordering::minimum_degree(pattern))
    }

    /// One for matrices whose rows stand in no relation to their columns; none where the dense form costs less.
    ///
    /// The order of the columns is that for AᵀA, whose factor holds the fill of L and U whatever rows become pivots (George & Ng, SIAM J.
    /// Sci. Stat. Comput. 6 (1985) 390-409).
    pub fn of_rows(pattern: &Sparsity) -> Option<Self> {
        let n = pattern.columns();
        if n <= DENSE_UP_TO || pattern.is_full() {
            return None;
        }
        let ordering = Ordering::minimum_degree(&Sparsity::of_groups(n, (0..n).map(|i| pattern.row(i))));
        (ordering.cost(pattern) < dense::cost(n)).then(|| Self::with_order(pattern, ordering))
    }

    /// The same with an order found before.
    pub(super) fn with_order(pattern: &Sparsity, ordering: Ordering) -> Self {
        let n = pattern.columns();
        let half = ordering.fill / 2;
        Self {
            columns: pattern.transposed(),
            step: vec![0; n],
            factored: false,
            source: Columns::with_capacity(n, pattern.entries()),
            lower: Columns::with_capacity(n, half),
            lower_values: Vec::with_capacity(half),
            upper: Columns::with_capacity(n, half),
            upper_values: Vec::with_capacity(half),
            inverse: vec![T::ZERO; n],
            growth: 0.0,
            x: vec![T::ZERO; n],
            pivoting: Pivoting::new(&ordering.order),
            order: ordering.order,
        }
    }

    /// Order of the matrix.
    pub fn order(&self) -> usize {
        self.order.len()
    }

    /// Entries of L and U, the unit diagonal of L not counted; 0 before the first factorisation.
    pub fn fill(&self) -> usize {
        if self.factored { self.lower.items.len() + self.upper.items.len() + self.order.len() } else { 0 }
    }

    /// Factors the matrix with the given values of the entries of the pattern, column after column.
    ///
    /// After a failure there is no factorisation, and the next call chooses pivots.
    pub fn factor(&mut self, values: &[T]) -> Result<(), Singular> {
        if self.factored && self.refactor(values).is_ok() {
            return Ok(());
        }
        self.factored = false;
        self.choose_pivots(values)?;
        self.factored = true;
        Ok(())
    }

    /// b := A⁻¹ b = Q U⁻¹ L⁻¹ P b; not a number where there is no factorisation.
    pub fn solve(&mut self, b: &mut [T]) {
        if !self.factored {
            b.fill(T::from(f64::NAN));
            return;
        }
        let x = &mut self.x[..];
        for (b, &step) in b.iter().zip(&self.step) {
            x[step as usize] = *b;
        }
        for k in 0..x.len() {
            let range = self.lower.range(k);
            subtract(x, x[k], &self.lower.items[range.clone()], &self.lower_values[range]);
        }
        for k in (0..x.len()).rev() {
            let range = self.upper.range(k);
            let y = x[k] * self.inverse[k];
            b[self.order[k]] = y;
            subtract(x, y, &self.upper.items[range.clone()], &self.upper_values[range]);
        }
    }

    /// b := A⁻ᵀ b = Pᵀ L⁻ᵀ U⁻ᵀ Qᵀ b; not a number where there is no factorisation.
    pub fn solve_transposed(&mut self, b: &mut [T]) {
        if !self.factored {
            b.fill(T::from(f64::NAN));
            return;
        }
        let x = &mut self.x[..];
        for (k, &column) in self.order.iter().enumerate() {
            let range = self.upper.range(k);
            let above = dot(x, &self.upper.items[range.clone()], &self.upper_values[range]);
            x[k] = (b[column] - above) * self.inverse[k];
        }
        for k in (0..x.len()).rev() {
            let range = self.lower.range(k);
            let below = dot(x, &self.lower.items[range.clone()], &self.lower_values[range]);
            x[k] -= below;
        }
        for (b, &step) in b.iter_mut().zip(&self.step) {
            *b = x[step as usize];
        }
    }

    /// Smallest over largest magnitude of a pivot, as [`Lu::pivot_ratio`](super::dense::Lu::pivot_ratio).
    pub fn pivot_ratio(&self) -> f64 {
        pivot_ratio(&self.inverse)
    }

    /// ln |det A| of the matrix factored last.
    pub fn log_determinant(&self) -> f64 {
        log_determinant(&self.inverse)
    }

    /// Numbers of L and U with the pivots kept; column after column as in [`Pivoting`], with all patterns known.
    fn refactor(&mut self, values: &[T]) -> Result<(), Unfit> {
        let x = &mut self.x[..];
        let (mut largest_a, mut largest_u) = (0.0_f64, 0.0_f64);
        for k in 0..x.len() {
            for &(place, step) in &self.source.items[self.source.range(k)] {
                let a = values[place as usize];
                largest_a = largest_a.max(a.abs1());
                x[step as usize] = a;
            }
            // u_jk = x_j, x −= u_jk l_j; rows rise, so that x_j is final when its turn comes
            let mut sum = 0.0;
            let range = self.upper.range(k);
            for (&j, u) in self.upper.items[range.clone()].iter().zip(&mut self.upper_values[range]) {
                *u = std::mem::replace(&mut x[j as usize], T::ZERO);
                let magnitude = u.abs1();
                sum += magnitude;
                largest_u = largest_u.max(magnitude);
                let range = self.lower.range(j as usize);
                subtract(x, *u, &self.lower.items[range.clone()], &self.lower_values[range]);
            }
            let pivot = std::mem::replace(&mut x[k], T::ZERO);
            let (size, inverse) = (pivot.abs1(), pivot.recip());
            let mut largest = 0.0_f64;
            let range = self.lower.range(k);
            for (&i, l) in self.lower.items[range.clone()].iter().zip(&mut self.lower_values[range]) {
                let y = std::mem::replace(&mut x[i as usize], T::ZERO);
                let magnitude = y.abs1();
                sum += magnitude;
                largest = largest.max(magnitude);
                *l = y * inverse;
            }
            largest_u = largest_u.max(size);
            self.inverse[k] = inverse;
            // the sum is not finite where any number of the column is not (max passes over what is not a number)
            if !(size > 0.0 && size >= KEPT * largest && sum + size < f64::INFINITY) {
                return Err(Unfit);
            }
        }
        if largest_u > GROWTH * self.growth.max(1.0) * largest_a { Err(Unfit) } else { Ok(()) }
    }

    /// Pivots, patterns and numbers from nothing.
    fn choose_pivots(&mut self, values: &[T]) -> Result<(), Singular> {
        let (pivoting, lower, upper) = (&mut self.pivoting, &mut self.lower, &mut self.upper);
        pivoting.start();
        lower.clear();
        upper.clear();
        self.lower_values.clear();
        self.upper_values.clear();
        let mut largest_u = 0.0_f64;
        for (k, &column) in self.order.iter().enumerate() {
            let (rows, entries) = (self.columns.row(column), &values[self.columns.range(column)]);
            let pivot = pivoting.column(k, column, rows, entries, lower, &self.lower_values)?;
            largest_u = largest_u.max(pivot.abs1());
            self.inverse[k] = pivot.recip();
            for (j, u) in pivoting.upper() {
                largest_u = largest_u.max(u.abs1());
                upper.items.push(j);
                self.upper_values.push(u);
            }
            upper.close();
            for (i, y) in pivoting.lower() {
                lower.items.push(i);
                self.lower_values.push(y * self.inverse[k]);
            }
            lower.close();
        }
        let largest_a = values.iter().fold(0.0_f64, |m, a| m.max(a.abs1()));
        self.growth = largest_u / largest_a;
        self.step.copy_from_slice(pivoting.steps());
        self.number_by_steps();
        Ok(())
    }

    /// Rows of L become steps, rising in each column; the entries of A find their steps.
    fn number_by_steps(&mut self) {
        for k in 0..self.order.len() {
            let range = self.lower.range(k);
            self.pivoting.sort_by_step(&mut self.lower.items[range.clone()], &mut self.lower_values[range]);
        }
        self.source.clear();
        for &column in &self.order {
            for (place, &row) in self.columns.range(column).zip(self.columns.row(column)) {
                self.source.items.push((place as u32, self.step[row]));
            }
            self.source.close();
        }
    }
}

/// The product of x and a sparse column.
#[inline(always)]
fn dot<T: Number>(x: &[T], rows: &[u32], values: &[T]) -> T {
    rows.iter().zip(values).fold(T::ZERO, |sum, (&i, &l)| sum + l * x[i as usize])
}

/// x −= u · (sparse column).
#[inline(always)]
fn subtract<T: Number>(x: &mut [T], u: T, rows: &[u32], values: &[T]) {
    for (&i, &l) in rows.iter().zip(values) {
        x[i as usize] -= l * u;
    }
}
