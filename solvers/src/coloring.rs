//! Columns of a sparse matrix that can be computed together.

use crate::Sparsity;

/// A partition of the columns of a matrix into groups (colours) whose members share no row.
///
/// A directional derivative along the sum of one group's unit vectors gives all of its columns at once, so a Jacobian costs
/// `count` evaluations instead of one a column. Curtis, Powell & Reid, IMA J. Appl. Math. 13 (1974) 117-119; as a colouring:
/// Coleman & Moré, SIAM J. Numer. Anal. 20 (1983) 187-209.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coloring {
    /// Colour of each column.
    pub color: Vec<usize>,
    /// Number of colours.
    pub count: usize,
}

impl Coloring {
    /// Gives each column in turn the smallest colour that no column sharing a row with it has.
    ///
    /// Work is Σ over entries of columns/64: rows are looked at by their bits. The count is the least possible for banded and dense matrices.
    pub fn new(pattern: &Sparsity) -> Self {
        let words = pattern.columns().div_ceil(64);
        let mut by_row = vec![0_u64; pattern.rows() * words];
        pattern.places().for_each(|(i, j)| by_row[i * words + j / 64] |= 1 << (j % 64));
        let columns = pattern.transposed();
        let mut neighbours = vec![0_u64; words];
        let mut color = vec![usize::MAX; pattern.columns()];
        // taken[c]: the last column that found colour c at a neighbour
        let mut taken: Vec<usize> = Vec::new();
        for j in 0..pattern.columns() {
            neighbours.fill(0);
            for &i in columns.row(j) {
                neighbours.iter_mut().zip(&by_row[i * words..][..words]).for_each(|(all, row)| *all |= row);
            }
            for neighbour in (0..pattern.columns()).filter(|k| neighbours[k / 64] >> (k % 64) & 1 == 1) {
                if let Some(last) = taken.get_mut(color[neighbour]) {
                    *last = j;
                }
            }
            let free = taken.iter().position(|&last| last != j).unwrap_or(taken.len());
            if free == taken.len() {
                taken.push(usize::MAX);
            }
            color[j] = free;
        }
        Self { color, count: taken.len() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::Noise;

    fn assert_valid(pattern: &Sparsity, coloring: &Coloring) {
        assert_eq!(coloring.color.len(), pattern.columns());
        let columns = pattern.transposed();
        for j in 0..pattern.columns() {
            assert!(coloring.color[j] < coloring.count);
            for k in 0..j {
                let share = columns.row(j).iter().any(|i| columns.row(k).contains(i));
                assert!(!share || coloring.color[j] != coloring.color[k], "columns {k} and {j} share a row and a colour");
            }
        }
    }

    #[test]
    fn a_random_pattern_is_coloured_validly() {
        let mut noise = Noise(7);
        let entries: Vec<_> = (0..40).flat_map(|i| (0..60).map(move |j| (i, j))).filter(|_| noise.next() > 0.9).collect();
        let pattern = Sparsity::new(40, 60, entries);
        let coloring = Coloring::new(&pattern);
        assert_valid(&pattern, &coloring);
        assert!(coloring.count < 20, "{} colours", coloring.count);
    }

    #[test]
    fn tridiagonal_needs_three() {
        let pattern = Sparsity::new(50, 50, (0..50usize).flat_map(|j| [(j.wrapping_sub(1), j), (j, j), (j + 1, j)]));
        let coloring = Coloring::new(&pattern);
        assert_valid(&pattern, &coloring);
        assert_eq!(coloring.count, 3);
    }

    #[test]
    fn dense_needs_one_a_column_and_empty_needs_one() {
        assert_eq!(Coloring::new(&Sparsity::dense(3, 5)).count, 5);
        assert_eq!(Coloring::new(&Sparsity::empty(3, 5)).count, 1);
        assert_eq!(Coloring::new(&Sparsity::empty(0, 0)).count, 0);
    }
}
