//! Choice of pivots of a sparse factorisation.

use super::columns::Columns;
use super::dense::Singular;
use super::number::Number;
use super::reach::{FREE, Reach};

/// The preferred pivot is taken from this part of the largest entry of its column on.
const THRESHOLD: f64 = 0.1;

/// L U by columns with partial pivoting, where the pattern of a column is found before its numbers.
///
/// Step k solves L x = a_k with the columns of L made so far:
/// x_j of the rows that are pivots already is column k of U, the rest over the pivot column k of L. The pattern of x are the
/// rows that can be reached from those of a_k through columns of L.
///
/// Preferred pivots are on the diagonal, as the order of columns expects it. When another row must be taken, the row given up is
/// preferred in the column whose row was taken: that keeps the symmetry of the pattern of [M Gᵀ; G −E] as far as it can be.
#[derive(Clone, Debug)]
pub(super) struct Pivoting<T> {
    /// Step at which each row is the pivot (n).
    step: Vec<u32>,
    /// Row at each step (n).
    pivot: Vec<u32>,
    /// Preferred row of each column, and the column that prefers each row (n).
    preferred: Vec<u32>,
    preferring: Vec<u32>,
    /// Step at which each column is eliminated (n).
    column_step: Vec<u32>,
    /// The present column by rows (n); zeros outside of its pattern.
    x: Vec<T>,
    /// Pattern of the present column.
    reach: Reach,
    /// Numbers to sort.
    pairs: Vec<(u32, T)>,
}

impl<T: Number> Pivoting<T> {
    /// For columns taken in the given order.
    pub(super) fn new(order: &[usize]) -> Self {
        let n = order.len();
        let mut column_step = vec![0; n];
        order.iter().enumerate().for_each(|(k, &j)| column_step[j] = k as u32);
        Self {
            step: vec![FREE; n],
            pivot: vec![0; n],
            preferred: vec![0; n],
            preferring: vec![0; n],
            column_step,
            x: vec![T::ZERO; n],
            reach: Reach::new(n),
            pairs: Vec::with_capacity(n),
        }
    }

    /// Forgets all pivots.
    pub(super) fn start(&mut self) {
        self.step.fill(FREE);
        self.reach.clear();
        self.x.fill(T::ZERO);
        for (j, (row, column)) in self.preferred.iter_mut().zip(&mut self.preferring).enumerate() {
            (*row, *column) = (j as u32, j as u32);
        }
    }

    /// Step `k`: column `column` with the given entries; its pivot. The column stays for [`upper`](Self::upper) and
    /// [`lower`](Self::lower).
    pub(super) fn column(
        &mut self,
        k: usize,
        column: usize,
        rows: &[usize],
        values: &[T],
        lower: &Columns<u32>,
        lower_values: &[T],
    ) -> Result<T, Singular> {
        self.reach.find(k as u32, rows, &self.step, lower);
        for (&row, value) in rows.iter().zip(values) {
            self.x[row] = *value;
        }
        let mut sum = 0.0;
        for &j in &self.reach.above {
            let u = self.x[self.pivot[j as usize] as usize];
            sum += u.abs1();
            let range = lower.range(j as usize);
            for (&i, &l) in lower.items[range.clone()].iter().zip(&lower_values[range]) {
                self.x[i as usize] -= l * u;
            }
        }
        let row = self.choose(column, sum).ok_or(Singular { column })?;
        self.prefer_elsewhere(column, row);
        self.step[row as usize] = k as u32;
        self.pivot[k] = row;
        self.reach.below.retain(|&i| i != row);
        Ok(std::mem::replace(&mut self.x[row as usize], T::ZERO))
    }

    /// Column of U without the pivot: step and number, steps rising.
    pub(super) fn upper(&mut self) -> impl Iterator<Item = (u32, T)> {
        let (pivot, x) = (&self.pivot, &mut self.x);
        self.reach.above.iter().map(|&j| (j, std::mem::replace(&mut x[pivot[j as usize] as usize], T::ZERO)))
    }

    /// Column of L times the pivot: row and number.
    pub(super) fn lower(&mut self) -> impl Iterator<Item = (u32, T)> {
        let x = &mut self.x;
        self.reach.below.iter().map(|&i| (i, std::mem::replace(&mut x[i as usize], T::ZERO)))
    }

    /// Step at which each row is the pivot.
    pub(super) fn steps(&self) -> &[u32] {
        &self.step
    }

    /// Turns rows into steps and sorts them, with their numbers.
    pub(super) fn sort_by_step(&mut self, rows: &mut [u32], values: &mut [T]) {
        self.pairs.clear();
        self.pairs.extend(rows.iter().map(|&i| self.step[i as usize]).zip(values.iter().copied()));
        self.pairs.sort_unstable_by_key(|pair| pair.0);
        for ((row, value), pair) in rows.iter_mut().zip(values).zip(&self.pairs) {
            (*row, *value) = *pair;
        }
    }

    /// The pivot row: the preferred one if it is large enough, else the largest; none if it is zero or a number is not finite.
    ///
    /// `sum` is that of the magnitudes of the pivot rows. Of equal rows the one whose column comes first is taken.
    fn choose(&self, column: usize, sum: f64) -> Option<u32> {
        let size = |row: u32| self.x[row as usize].abs1();
        let rank = |row: u32| self.column_step[self.preferring[row as usize] as usize];
        let mut best: Option<(f64, u32)> = None;
        let mut sum = sum;
        for &row in &self.reach.below {
            let x = size(row);
            sum += x;
            if best.is_none_or(|(most, other)| x > most || (x == most && rank(row) < rank(other))) {
                best = Some((x, row));
            }
        }
        let (most, row) = best.filter(|(most, _)| *most > 0.0 && sum < f64::INFINITY)?;
        let preferred = self.preferred[column];
        let reached = self.reach.holds(self.column_step[column], preferred);
        Some(if reached && size(preferred) >= THRESHOLD * most { preferred } else { row })
    }

    /// The row that `column` gives up goes to the column whose row it takes.
    fn prefer_elsewhere(&mut self, column: usize, row: u32) {
        let (given_up, other) = (self.preferred[column], self.preferring[row as usize]);
        self.preferred[other as usize] = given_up;
        self.preferring[given_up as usize] = other;
        self.preferred[column] = row;
        self.preferring[row as usize] = column as u32;
    }
}
