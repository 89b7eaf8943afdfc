//! Rows of a least-squares problem, by their entries.

/// Rows of a sparse matrix that grows row by row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    /// End of each row among the entries.
    ends: Vec<usize>,
    /// Column and value of the entries, columns rising in each row.
    entries: Vec<(usize, f64)>,
}

impl Rows {
    /// Number of rows.
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    pub(crate) fn clear(&mut self) {
        self.ends.clear();
        self.entries.clear();
    }

    /// Adds a row of the given entries, in any order; those of one column are added up.
    pub(crate) fn push(&mut self, entries: impl IntoIterator<Item = (usize, f64)>) {
        let start = self.entries.len();
        self.entries.extend(entries);
        let row = &mut self.entries[start..];
        if !row.is_sorted_by(|a, b| a.0 < b.0) {
            row.sort_by_key(|entry| entry.0);
            let mut end = start;
            for k in start + 1..self.entries.len() {
                if self.entries[k].0 == self.entries[end].0 {
                    self.entries[end].1 += self.entries[k].1;
                } else {
                    end += 1;
                    self.entries[end] = self.entries[k];
                }
            }
            self.entries.truncate(end + 1);
        }
        self.ends.push(self.entries.len());
    }

    /// Entries of a row.
    pub(crate) fn line(&self, i: usize) -> &[(usize, f64)] {
        &self.entries[if i == 0 { 0 } else { self.ends[i - 1] }..self.ends[i]]
    }

    /// Entries of each row.
    pub(crate) fn lines(&self) -> impl ExactSizeIterator<Item = &[(usize, f64)]> + Clone {
        (0..self.len()).map(|i| self.line(i))
    }

    /// The product of each row with a vector.
    pub(crate) fn product<'r>(&'r self, x: &'r [f64]) -> impl Iterator<Item = f64> + 'r {
        self.lines().map(|line| line.iter().map(|&(j, a)| a * x[j]).sum())
    }

    /// All rows with all `columns` (row-major).
    pub(crate) fn to_dense(&self, columns: usize) -> Vec<f64> {
        let mut out = vec![0.0; self.len() * columns];
        for (i, line) in self.lines().enumerate() {
            line.iter().for_each(|&(j, a)| out[i * columns + j] = a);
        }
        out
    }

    /// The largest length of a row in units of the metric, √(Σ a_j²/d_j).
    pub(crate) fn longest(&self, metric: &[f64]) -> f64 {
        self.lines().map(|line| length(line, metric)).fold(0.0, f64::max)
    }

    /// A bound from above of the largest singular value in units of the metric, √(‖A‖₁ ‖A‖_∞).
    pub(crate) fn most(&self, metric: &[f64]) -> f64 {
        let mut columns = vec![0.0; metric.len()];
        let mut most = 0.0;
        for line in self.lines() {
            let mut sum = 0.0;
            for &(j, a) in line {
                let size = a.abs() / metric[j].sqrt();
                columns[j] += size;
                sum += size;
            }
            most = f64::max(most, sum);
        }
        (most * columns.into_iter().fold(0.0, f64::max)).sqrt()
    }
}

/// Rows A and right sides b of one level of a least-squares problem.
#[derive(Clone, Debug, Default)]
pub(crate) struct Level {
    pub(crate) rows: Rows,
    pub(crate) b: Vec<f64>,
    /// Singular values of A D^−½ up to this are round-off.
    pub(crate) round_off: f64,
}

impl Level {
    /// Adds a row times a scale.
    pub(crate) fn row(&mut self, row: impl IntoIterator<Item = (usize, f64)>, b: f64, scale: f64) {
        self.rows.push(row.into_iter().map(|(k, x)| (k, x * scale)));
        self.b.push(b * scale);
    }

    /// b − A x.
    pub(crate) fn missing(&self, x: &[f64]) -> Vec<f64> {
        self.b.iter().zip(self.rows.product(x)).map(|(b, product)| b - product).collect()
    }
}

/// The length of a row in units of the metric.
pub(super) fn length(line: &[(usize, f64)], metric: &[f64]) -> f64 {
    line.iter().map(|&(j, a)| a * a / metric[j]).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_come_in_any_order() {
        let mut rows = Rows::default();
        rows.push([(2, 1.0), (0, 4.0), (2, 0.5)]);
        rows.push([]);
        rows.push([(1, -1.0)]);
        assert_eq!(rows.to_dense(3), [4.0, 0.0, 1.5, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0]);
        assert_eq!((rows.len(), rows.line(0)), (3, [(0, 4.0), (2, 1.5)].as_slice()));
        assert_eq!(rows.product(&[1.0, 2.0, 4.0]).collect::<Vec<_>>(), [10.0, 0.0, -2.0]);
        assert_eq!(rows.longest(&[4.0, 1.0, 1.0]), 2.5);
        assert_eq!(rows.most(&[4.0, 1.0, 1.0]), (3.5_f64 * 2.0).sqrt());
    }
}
