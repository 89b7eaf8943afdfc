//! Rows of which some depend on others, by sparse elimination.

use super::dense::FEW;
use super::rows::Rows;
use grashof_solvers::{Block, Elimination, Sparsity};

/// Rows that are combinations of independent ones, of many velocities.
pub(crate) struct Redundant {
    elimination: Elimination,
    /// The independent rows.
    independent: Rows,
    /// D^−½ (columns).
    unit: Vec<f64>,
}

impl Redundant {
    /// Of rows A over columns with a metric; what is left of a dependent row of A D^−½ is below `left`. None where columns are few, or no row
    /// depends on others.
    pub(crate) fn new(rows: &Rows, metric: &[f64], left: f64) -> Option<Self> {
        if metric.len() <= FEW {
            return None;
        }
        let places = rows.lines().enumerate().flat_map(|(i, line)| line.iter().map(move |(j, _)| (i, *j)));
        let mut block = Block::new(&Sparsity::new(rows.len(), metric.len(), places));
        rows.lines().enumerate().for_each(|(i, line)| line.iter().for_each(|(j, a)| block.set(i, *j, *a)));
        let unit: Vec<f64> = metric.iter().map(|d| d.sqrt().recip()).collect();
        let elimination = Elimination::new(&block, &vec![1.0; rows.len()], &unit, left);
        if elimination.dependent.is_empty() {
            return None;
        }
        let mut independent = Rows::default();
        elimination.independent.iter().for_each(|&i| independent.push(rows.line(i).iter().copied()));
        Some(Self { elimination, independent, unit })
    }

    /// The independent rows A_i: the singular values of A D^−½ are no less than theirs, but for those of the dependent rows, since
    /// |A x| ≥ |A_i x|.
    pub(crate) fn independent(&self) -> &Rows {
        &self.independent
    }

    /// A velocity that the rows leave, whose largest part is 1 in the metric, in no special direction; none if they leave none.
    pub(crate) fn motion(&self, phase: f64) -> Option<Vec<f64>> {
        let parts: Vec<f64> = (0..self.elimination.free.len()).map(|k| (2.4 * k as f64 + phase).cos()).collect();
        let x = self.elimination.annihilated(&parts);
        let most = x.iter().fold(0.0, |m, x| f64::max(m, x.abs()));
        (most > 0.0).then(|| x.iter().zip(&self.unit).map(|(x, unit)| x * unit / most).collect())
    }

    /// The largest value that combinations of rows that vanish, each of length 1, have of numbers of the rows.
    pub(crate) fn largest(&self, numbers: &[f64]) -> f64 {
        let value = |combination: Vec<(usize, f64)>| {
            let length = combination.iter().map(|(_, l)| l * l).sum::<f64>().sqrt();
            combination.iter().map(|&(i, l)| l * numbers[i]).sum::<f64>().abs() / length
        };
        self.elimination.vanishing().map(value).fold(0.0, f64::max)
    }
}
