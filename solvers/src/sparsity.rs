//! Which entries of a matrix can be other than zero.

use std::ops::Range;
use std::sync::Arc;

/// Largest order of a matrix that is always kept and factored as a full one: up to here that form has code of its own for every order.
pub const DENSE_UP_TO: usize = 12;

/// Time of a number moved or multiplied in the sparse form over that of a multiplication in the dense form.
pub(crate) const SPARSE_COST: usize = 3;

/// The pattern of a matrix, by rows: entries outside of it are zero in every state. A copy shares it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sparsity {
    rows: usize,
    columns: usize,
    /// Whether every entry is in it.
    full: bool,
    /// Where each row begins in `indices`, and the end (rows + 1); nothing if it is full.
    starts: Arc<[usize]>,
    /// Columns of the entries, row after row, rising in each; if it is full, all columns once.
    indices: Arc<[usize]>,
}

impl Sparsity {
    /// The pattern with the given (row, column) entries, in any order, repeated or not.
    ///
    /// Entries outside of the matrix are ignored.
    pub fn new(rows: usize, columns: usize, entries: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let entries: Vec<_> = entries.into_iter().filter(|&(i, j)| i < rows && j < columns).collect();
        let mut starts = vec![0; rows + 1];
        entries.iter().for_each(|&(i, _)| starts[i + 1] += 1);
        (0..rows).for_each(|i| starts[i + 1] += starts[i]);
        let (mut next, mut indices) = (starts.clone(), vec![0; entries.len()]);
        for (i, j) in entries {
            indices[next[i]] = j;
            next[i] += 1;
        }
        let mut end = 0;
        for i in 0..rows {
            let row = starts[i]..starts[i + 1];
            starts[i] = end;
            indices[row.clone()].sort_unstable();
            for k in row {
                if end == starts[i] || indices[end - 1] != indices[k] {
                    indices[end] = indices[k];
                    end += 1;
                }
            }
        }
        starts[rows] = end;
        indices.truncate(end);
        Self::of(columns, starts, indices)
    }

    /// The pattern of rows that begin at `starts` of the columns `indices`.
    fn of(columns: usize, starts: Vec<usize>, indices: Vec<usize>) -> Self {
        let rows = starts.len() - 1;
        if indices.len() == rows * columns {
            return Self::dense(rows, columns);
        }
        Self { rows, columns, full: false, starts: starts.into(), indices: indices.into() }
    }

    /// The pattern of a square matrix in which all indices of a group meet each other, for each of the groups, whose indices may come
    /// in any order, repeated or not.
    ///
    /// Short groups cost the squares of their lengths. Where they overlap in most of their indices, as the paths to the bodies of a chain
    /// do, each costs its length times a row of bits instead.
    pub fn of_groups<'g>(size: usize, groups: impl IntoIterator<Item = &'g [usize]>) -> Self {
        let groups: Vec<&[usize]> = groups.into_iter().collect();
        let words = size.div_ceil(64);
        let meetings: usize = groups.iter().map(|group| group.len() * group.len()).sum();
        let lengths: usize = groups.iter().map(|group| group.len()).sum();
        if meetings <= (size + lengths) * words { Self::of_short_groups(size, &groups) } else { Self::of_long_groups(size, &groups) }
    }

    /// Row by row, through the groups that each index is in.
    fn of_short_groups(size: usize, groups: &[&[usize]]) -> Self {
        let members = || groups.iter().enumerate().flat_map(|(g, group)| group.iter().filter(|&&i| i < size).map(move |&i| (g, i)));
        let mut begins = vec![0; size + 1];
        members().for_each(|(_, i)| begins[i + 1] += 1);
        (0..size).for_each(|i| begins[i + 1] += begins[i]);
        let (mut next, mut of) = (begins.clone(), vec![0; begins[size]]);
        for (g, i) in members() {
            of[next[i]] = g;
            next[i] += 1;
        }
        let mut met = vec![usize::MAX; size];
        let (mut starts, mut indices) = (vec![0], Vec::new());
        for row in 0..size {
            let begin = indices.len();
            for &j in of[begins[row]..begins[row + 1]].iter().flat_map(|&g| groups[g]).filter(|&&j| j < size) {
                if std::mem::replace(&mut met[j], row) != row {
                    indices.push(j);
                }
            }
            indices[begin..].sort_unstable();
            starts.push(indices.len());
        }
        Self::of(size, starts, indices)
    }

    /// By a row of bits for each index.
    fn of_long_groups(size: usize, groups: &[&[usize]]) -> Self {
        let words = size.div_ceil(64);
        let mut met = vec![0_u64; size * words];
        let mut own = vec![0_u64; words];
        for group in groups {
            own.fill(0);
            group.iter().filter(|&&i| i < size).for_each(|&i| own[i / 64] |= 1 << (i % 64));
            for &j in group.iter().filter(|&&j| j < size) {
                met[j * words..][..words].iter_mut().zip(&own).for_each(|(met, own)| *met |= own);
            }
        }
        let (mut starts, mut indices) = (vec![0], Vec::new());
        for row in 0..size {
            indices.extend((0..size).filter(|i| met[row * words + i / 64] >> (i % 64) & 1 == 1));
            starts.push(indices.len());
        }
        Self::of(size, starts, indices)
    }

    /// A full matrix.
    pub fn dense(rows: usize, columns: usize) -> Self {
        Self { rows, columns, full: true, starts: Arc::new([]), indices: (0..columns).collect() }
    }

    /// A matrix of zeros.
    pub fn empty(rows: usize, columns: usize) -> Self {
        Self::of(columns, vec![0; rows + 1], Vec::new())
    }

    /// The full pattern in place of this one where dense code is faster: for small matrices, and for those of which so many entries can
    /// be other than zero that a walk from one to the next costs more than one along all.
    #[must_use]
    pub fn or_dense(self) -> Self {
        if Self::is_nearly_full(self.rows, self.columns, self.entries()) { Self::dense(self.rows, self.columns) } else { self }
    }

    /// Whether a matrix of so many entries is kept full.
    pub fn is_nearly_full(rows: usize, columns: usize, entries: usize) -> bool {
        rows.max(columns) <= DENSE_UP_TO || SPARSE_COST * entries >= rows * columns
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        if self.full { self.rows * self.columns } else { self.indices.len() }
    }

    /// Whether every entry is in it.
    #[inline]
    pub fn is_full(&self) -> bool {
        self.full
    }

    /// Columns of the entries of a row, rising.
    #[inline]
    pub fn row(&self, i: usize) -> &[usize] {
        if self.full { &self.indices } else { &self.indices[self.range(i)] }
    }

    /// Where the entries of a row stand among all.
    #[inline]
    pub fn range(&self, i: usize) -> Range<usize> {
        if self.full { i * self.columns..(i + 1) * self.columns } else { self.starts[i]..self.starts[i + 1] }
    }

    /// Where an entry stands among all, if it is in the pattern.
    #[inline]
    pub fn place(&self, i: usize, j: usize) -> Option<usize> {
        if self.full {
            return Some(i * self.columns + j);
        }
        self.row(i).binary_search(&j).ok().map(|k| self.starts[i] + k)
    }

    /// Rows and columns of all entries, in order.
    pub fn places(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.rows).flat_map(|i| self.row(i).iter().map(move |&j| (i, j)))
    }

    /// The pattern of the transposed matrix.
    pub fn transposed(&self) -> Self {
        if self.full {
            return Self::dense(self.columns, self.rows);
        }
        // counting, as entries come by rows already
        let mut starts = vec![0; self.columns + 1];
        self.places().for_each(|(_, j)| starts[j + 1] += 1);
        (0..self.columns).for_each(|j| starts[j + 1] += starts[j]);
        let mut next = starts.clone();
        let mut indices = vec![0; self.entries()];
        for (i, j) in self.places() {
            indices[next[j]] = i;
            next[j] += 1;
        }
        Self::of(self.rows, starts, indices)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_their_pairs() {
        let groups: [&[usize]; 4] = [&[0, 2], &[70, 2, 2], &[5], &[9, 70, 80]];
        let pairs = groups.iter().flat_map(|g| g.iter().flat_map(|&i| g.iter().map(move |&k| (i, k))));
        let all = Sparsity::new(71, 71, pairs);
        assert_eq!([Sparsity::of_short_groups(71, &groups), Sparsity::of_long_groups(71, &groups)], [all.clone(), all.clone()]);
        assert_eq!(Sparsity::of_groups(71, groups), all);
        assert_eq!(Sparsity::of_groups(0, [[].as_slice()]), Sparsity::empty(0, 0));
    }

    #[test]
    fn entries_are_sorted_and_unique_and_inside() {
        let pattern = Sparsity::new(2, 3, [(1, 2), (1, 0), (1, 2), (0, 1), (0, 5), (7, 0)]);
        assert_eq!((pattern.rows(), pattern.columns(), pattern.entries()), (2, 3, 3));
        assert_eq!((pattern.row(0), pattern.row(1)), ([1].as_slice(), [0, 2].as_slice()));
        assert_eq!([(0, 1), (1, 2), (0, 0)].map(|(i, j)| pattern.place(i, j)), [Some(0), Some(2), None]);
        assert_eq!(pattern.transposed(), Sparsity::new(3, 2, [(0, 1), (1, 0), (2, 1)]));
        assert_eq!(pattern.transposed().transposed(), pattern);
        assert!(pattern.places().eq([(0, 1), (1, 0), (1, 2)]));
    }

    #[test]
    fn dense_and_empty_are_the_extremes() {
        assert_eq!(Sparsity::dense(2, 3), Sparsity::new(2, 3, (0..2).flat_map(|i| (0..3).map(move |j| (i, j)))));
        assert_eq!(Sparsity::empty(2, 3), Sparsity::new(2, 3, []));
        assert!(Sparsity::dense(2, 3).is_full() && !Sparsity::empty(2, 3).is_full() && Sparsity::empty(0, 3).is_full());
        assert_eq!(Sparsity::dense(2, 3).place(1, 2), Some(5));
    }

    #[test]
    fn what_is_small_or_nearly_full_is_kept_full() {
        let band = |n: usize, width: usize| Sparsity::new(n, n, (0..n).flat_map(|i| (0..width).map(move |k| (i, i + k))));
        assert!(band(12, 1).or_dense().is_full());
        assert!(!band(13, 1).or_dense().is_full());
        assert!(band(30, 20).or_dense().is_full());
    }
}
