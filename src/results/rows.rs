//! Rows of numbers, and who takes them as they are computed.

use super::Column;
use serde::{Deserialize, Serialize};
use std::ops::Index;
use std::slice::ChunksExact;

/// Rows of numbers of one width, one behind the other in memory.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rows {
    width: usize,
    values: Vec<f64>,
}

impl Rows {
    /// No rows yet, of so many numbers each.
    #[must_use]
    pub fn new(width: usize) -> Self {
        Self { width, values: Vec::new() }
    }

    /// Rows of so many numbers each, one behind the other.
    #[must_use]
    pub fn of(width: usize, values: Vec<f64>) -> Self {
        debug_assert!(width == 0 || values.len().is_multiple_of(width), "a row of another width");
        Self { width, values }
    }

    /// Adds a row, of as many numbers as the others.
    pub fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        self.values.extend(row);
        debug_assert!(self.width == 0 || self.values.len().is_multiple_of(self.width), "a row of another width");
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(0)
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Number of numbers in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// The rows, in order.
    pub fn iter(&self) -> ChunksExact<'_, f64> {
        self.values.chunks_exact(self.width.max(1))
    }

    /// The first row.
    #[must_use]
    pub fn first(&self) -> Option<&[f64]> {
        self.iter().next()
    }

    /// The last row.
    #[must_use]
    pub fn last(&self) -> Option<&[f64]> {
        self.iter().next_back()
    }

    /// The numbers of a column.
    pub fn column(&self, column: usize) -> impl Iterator<Item = f64> + '_ {
        self.iter().map(move |row| row[column])
    }
}

impl Index<usize> for Rows {
    type Output = [f64];

    fn index(&self, row: usize) -> &[f64] {
        &self.values[row * self.width..][..self.width]
    }
}

impl<'r> IntoIterator for &'r Rows {
    type Item = &'r [f64];
    type IntoIter = ChunksExact<'r, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// Takes the rows of a run as they are computed, in place of the table of the results.
pub trait Sink: Sync {
    /// Before the first row: the independent variable and the columns, without values. Where a column turns out to have no value the
    /// run ends there and begins its rows again: those before this call do not count.
    fn begin(&self, independent: &Column, columns: &[Column]);

    /// A row: the independent variable and the columns, SI; NaN where there is no value. Two rows at the same place are the two sides
    /// of a switch.
    fn row(&self, place: f64, values: &[f64]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_by_number_and_by_column() {
        let mut rows = Rows::new(2);
        rows.push([1.0, 2.0]);
        rows.push([3.0, 4.0]);
        assert_eq!((rows.len(), rows[1][0], rows.last()), (2, 3.0, Some(&[3.0, 4.0][..])));
        assert_eq!(rows.column(1).collect::<Vec<_>>(), [2.0, 4.0]);
        assert!(Rows::new(0).is_empty() && Rows::new(0).first().is_none());
    }
}
