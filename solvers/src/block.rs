//! Matrices of a fixed pattern.

use crate::Sparsity;
use std::ops::{AddAssign, Mul};

/// A matrix of a fixed pattern: the values of its entries, row after row. One with a full pattern is a row-major matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Block<T = f64> {
    pattern: Sparsity,
    values: Vec<T>,
}

/// A row of a [`Block`].
#[derive(Clone, Copy, Debug)]
pub struct Line<'b, T = f64> {
    /// Columns of its entries, rising.
    pub columns: &'b [usize],
    /// Their values.
    pub values: &'b [T],
    /// Whether the entries are all there are.
    full: bool,
}

impl<T: Copy + Default> Block<T> {
    /// Zeros.
    pub fn new(pattern: &Sparsity) -> Self {
        Self { pattern: pattern.clone(), values: vec![T::default(); pattern.entries()] }
    }

    /// Zeros of a full matrix.
    pub fn full(rows: usize, columns: usize) -> Self {
        Self::new(&Sparsity::dense(rows, columns))
    }

    /// All entries, row after row, zeros included. Allocates.
    pub fn to_dense(&self) -> Vec<T> {
        let columns = self.pattern.columns();
        let mut out = vec![T::default(); self.pattern.rows() * columns];
        self.pattern.places().zip(&self.values).for_each(|((i, j), value)| out[i * columns + j] = *value);
        out
    }

    /// The entry at a row and a column.
    #[inline]
    pub fn at(&self, i: usize, j: usize) -> T {
        self.pattern.place(i, j).map_or_else(T::default, |k| self.values[k])
    }

    /// Writes the entry at a row and a column, which must be in the pattern.
    ///
    /// # Panics
    /// If it is not.
    pub fn set(&mut self, i: usize, j: usize, value: T) {
        match self.pattern.place(i, j) {
            Some(k) => self.values[k] = value,
            None => panic!("({i}, {j}) is no entry of the pattern"),
        }
    }

    /// The given rows, one after the other.
    #[must_use]
    pub fn select_rows(&self, rows: &[usize]) -> Self {
        let places = rows.iter().enumerate().flat_map(|(i, &row)| self.pattern.row(row).iter().map(move |&j| (i, j)));
        let pattern = Sparsity::new(rows.len(), self.pattern.columns(), places);
        let values = rows.iter().flat_map(|&row| self.line(row).values.iter().copied()).collect();
        Self { pattern, values }
    }

    /// Takes the entries of a matrix of the same size, all of which must be in the pattern.
    ///
    /// # Panics
    /// If one is not.
    pub fn take(&mut self, other: &Self) {
        self.values.fill(T::default());
        other.pattern.places().zip(&other.values).for_each(|((i, j), x)| self.set(i, j, *x));
    }
}

impl<T> Block<T> {
    /// Its pattern.
    pub fn pattern(&self) -> &Sparsity {
        &self.pattern
    }

    /// Values of the entries, row after row.
    #[inline]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The same, to be written.
    #[inline]
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Its pattern, and the values of the entries to be written.
    pub fn parts_mut(&mut self) -> (&Sparsity, &mut [T]) {
        (&self.pattern, &mut self.values)
    }

    /// A row.
    #[inline]
    pub fn line(&self, i: usize) -> Line<'_, T> {
        let range = self.pattern.range(i);
        Line { columns: self.pattern.row(i), values: &self.values[range], full: self.pattern.is_full() }
    }

    /// All rows.
    #[inline]
    pub fn lines(&self) -> impl ExactSizeIterator<Item = Line<'_, T>> + Clone {
        (0..self.pattern.rows()).map(|i| self.line(i))
    }

    /// Exchanges the values with those of a matrix of the same pattern.
    pub fn swap_values(&mut self, other: &mut Self) {
        debug_assert_eq!(self.pattern, other.pattern);
        std::mem::swap(&mut self.values, &mut other.values);
    }

    /// Columns and values of a row, to be written.
    #[inline]
    pub fn line_mut(&mut self, i: usize) -> (&[usize], &mut [T]) {
        (self.pattern.row(i), &mut self.values[self.pattern.range(i)])
    }
}

impl<T: Copy + Default> Default for Block<T> {
    /// A matrix without rows and columns.
    fn default() -> Self {
        Self::full(0, 0)
    }
}

impl<T: Copy> Line<'_, T> {
    /// Columns and values of the entries.
    #[inline]
    pub fn entries(&self) -> impl Iterator<Item = (usize, T)> + Clone + '_ {
        self.columns.iter().copied().zip(self.values.iter().copied())
    }
}

impl<T: Copy + Mul<Output = T> + AddAssign> Line<'_, T> {
    /// out += factor · row.
    #[inline]
    pub fn add_to(&self, factor: T, out: &mut [T]) {
        if self.full {
            out.iter_mut().zip(self.values).for_each(|(out, x)| *out += *x * factor);
        } else {
            self.entries().for_each(|(j, x)| out[j] += x * factor);
        }
    }
}

impl Line<'_> {
    /// Calls with each entry and the number of a vector that it is multiplied by.
    #[inline]
    pub fn with(&self, x: &[f64], mut each: impl FnMut(f64, f64)) {
        if self.full {
            self.values.iter().zip(x).for_each(|(a, x)| each(*a, *x));
        } else {
            self.entries().for_each(|(j, a)| each(a, x[j]));
        }
    }

    /// The product with a vector.
    #[inline]
    pub fn dot(&self, x: &[f64]) -> f64 {
        if self.full { self.values.iter().zip(x).map(|(a, x)| a * x).sum() } else { self.entries().map(|(j, a)| a * x[j]).sum() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sparse_matrix_is_the_dense_one() {
        let places = [(0, 1), (2, 0), (2, 1), (2, 2)];
        let (mut sparse, mut dense) = (Block::new(&Sparsity::new(3, 3, places)), Block::full(3, 3));
        for (k, (i, j)) in places.into_iter().enumerate() {
            sparse.set(i, j, k as f64 - 1.5);
            dense.set(i, j, k as f64 - 1.5);
        }
        assert_eq!((sparse.to_dense(), sparse.values().len()), (dense.values().to_vec(), 4));
        let x = [2.0, -3.0, 5.0];
        for (sparse, dense) in sparse.lines().zip(dense.lines()) {
            assert_eq!(sparse.dot(&x), dense.dot(&x));
            let mut sums = [[1.0, 1.0, 1.0]; 2];
            sparse.add_to(2.0, &mut sums[0]);
            dense.add_to(2.0, &mut sums[1]);
            assert_eq!(sums[0], sums[1]);
        }
        assert_eq!((sparse.at(2, 0), sparse.at(1, 1)), (-0.5, 0.0));
        assert_eq!(sparse.select_rows(&[2, 0]).to_dense(), [&dense.values()[6..], &dense.values()[..3]].concat());
    }

    #[test]
    #[should_panic(expected = "(1, 1) is no entry")]
    fn outside_of_the_pattern_nothing_is_written() {
        Block::new(&Sparsity::empty(2, 2)).set(1, 1, 7.0);
    }
}
