//! How a number is distributed over the runs of a sweep whose values are drawn.

use super::{Column, ShownIn};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Deviations below this part of the mean are round-off.
const ROUND_OFF: f64 = 1e-12;
/// The percentages of [`Statistics::percentiles`].
pub const PERCENTAGES: [f64; 5] = [5.0, 25.0, 50.0, 75.0, 95.0];

/// Moments and percentiles of a number over the runs that have it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// Name of the number.
    pub name: String,
    /// The SI unit; empty for a number.
    pub unit: String,
    /// The unit to show it in, if the model asks for one.
    pub shown_in: Option<ShownIn>,
    /// Runs that have it.
    pub runs: usize,
    /// Mean, SI.
    pub mean: f64,
    /// Standard deviation, that of the sample: the sum of squares over the number of runs less one.
    pub deviation: f64,
    /// Least and largest value.
    pub range: [f64; 2],
    /// Values below which 5, 25, 50, 75 and 95 of a hundred runs are, interpolated linearly between the runs (Hyndman & Fan, The American
    /// Statistician 50 (1996) 361-365, definition 7).
    pub percentiles: [f64; 5],
    /// What each parameter with a distribution has to do with it; nothing where there are too few runs, other parameters vary as well, or
    /// its deviation is round-off, below 1e-12 of its mean.
    pub parts: Vec<Part>,
}

/// What a parameter has to do with a number: by the plane through all runs that has the least squares.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Name of the parameter.
    pub parameter: String,
    /// How much the number changes with it, SI.
    pub slope: f64,
    /// Its share of the variance: all of them together are what the plane has of it, 1 for a number that is linear in the parameters (Pratt,
    /// Proc. Second Tampere Conference in Statistics (1987) 245-260).
    pub share: f64,
}

impl Statistics {
    /// Of a column with a value for each run; none if no run has one.
    #[must_use]
    pub fn of(column: &Column) -> Option<Self> {
        let mut values: Vec<f64> = column.values.iter().copied().filter(|x| x.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        let (&least, &most) = (values.first()?, values.last()?);
        let runs = values.len();
        let mean = least + values.iter().map(|x| x - least).sum::<f64>() / runs as f64;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        let at = |percentage: f64| {
            let place = percentage / 100.0 * (runs - 1) as f64;
            let below = place as usize;
            let above = (below + 1).min(runs - 1);
            values[below] + (place - below as f64) * (values[above] - values[below])
        };
        Some(Self {
            name: column.name.clone(),
            unit: column.unit.clone(),
            shown_in: column.shown_in.clone(),
            runs,
            mean,
            deviation: if runs > 1 { (squares / (runs - 1) as f64).sqrt() } else { f64::NAN },
            range: [least, most],
            percentiles: PERCENTAGES.map(at),
            parts: Vec::new(),
        })
    }

    /// The same with the parts of the parameters in columns that were `drawn`, each on its own.
    #[must_use]
    pub fn with_parts(self, column: &Column, drawn: &[&Column]) -> Self {
        let rows: Vec<usize> = (0..column.values.len()).filter(|&i| column.values[i].is_finite()).collect();
        let varies = !drawn.is_empty() && self.deviation > ROUND_OFF * self.mean.abs() && rows.len() > 2 * drawn.len() + 1;
        let parts = if varies { parts(&rows, column, drawn) } else { None };
        Self { parts: parts.unwrap_or_default(), ..self }
    }

    /// Size of the unit to show it in, and that unit.
    #[must_use]
    pub fn shown(&self) -> (&str, f64) {
        self.shown_in.as_ref().map_or((&self.unit, 1.0), |shown| (&shown.unit, shown.size))
    }
}

/// Parts of a column by its rows that have a value; none where parameters do not vary.
fn parts(rows: &[usize], column: &Column, drawn: &[&Column]) -> Option<Vec<Part>> {
    let centred = |values: &[f64]| {
        let mean = rows.iter().map(|&i| values[i]).sum::<f64>() / rows.len() as f64;
        DVector::from_iterator(rows.len(), rows.iter().map(|&i| values[i] - mean))
    };
    let y = centred(&column.values);
    let mut x: Vec<DVector<f64>> = drawn.iter().map(|column| centred(&column.values)).collect();
    let sizes: Vec<f64> = x.iter().map(DVector::norm).collect();
    x.iter_mut().zip(&sizes).for_each(|(x, size)| *x /= *size);
    let x = DMatrix::from_columns(&x);
    let along = x.transpose() * &y;
    let slopes = (x.transpose() * &x).cholesky()?.solve(&along);
    let part =
        |i: usize| Part { parameter: drawn[i].name.clone(), slope: slopes[i] / sizes[i], share: slopes[i] * along[i] / y.norm_squared() };
    Some((0..drawn.len()).map(part).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_plane_are_its_slopes() {
        let column = |name: &str, values: Vec<f64>| Column { name: name.into(), values, ..Column::default() };
        // a square of points: the parameters do not go together
        let (a, b) = (column("a", vec![1.0, 1.0, 3.0, 3.0, 2.0, 2.0]), column("b", vec![0.0, 4.0, 0.0, 4.0, 2.0, 2.0]));
        let y = column("y", a.values.iter().zip(&b.values).map(|(a, b)| 7.0 + 2.0 * a - 0.5 * b).collect());
        let found = Statistics::of(&y).unwrap().with_parts(&y, &[&a, &b]);
        let shares: Vec<f64> = found.parts.iter().map(|p| p.share).collect();
        assert!((found.parts[0].slope - 2.0).abs() < 1e-14 && (found.parts[1].slope + 0.5).abs() < 1e-14, "{found:?}");
        assert!((shares[0] - 0.8).abs() < 1e-14 && (shares[1] - 0.2).abs() < 1e-14, "{found:?}");
        let still = column("a", vec![1.0; 6]);
        assert!(Statistics::of(&y).unwrap().with_parts(&y, &[&still, &b]).parts.is_empty());
        // what does not depend on the parameters but for its last digits
        let constant = column("y", [0.0, 1.0, 0.0, 1.0, 2.0, 0.0].map(|digit| 9.81 * (1.0 + digit * f64::EPSILON)).to_vec());
        let found = Statistics::of(&constant).unwrap().with_parts(&constant, &[&a, &b]);
        assert!(found.deviation > 0.0 && found.parts.is_empty(), "{found:?}");
    }

    #[test]
    fn percentiles_are_those_of_the_definition() {
        let column = Column { name: "x".into(), values: vec![4.0, f64::NAN, 1.0, 3.0, 2.0, 5.0], ..Column::default() };
        let found = Statistics::of(&column).unwrap();
        assert_eq!((found.runs, found.mean, found.range), (5, 3.0, [1.0, 5.0]));
        assert!((found.deviation - 2.5f64.sqrt()).abs() < 1e-15);
        // numpy.percentile([1, 2, 3, 4, 5], [5, 25, 50, 75, 95])
        for (x, known) in found.percentiles.into_iter().zip([1.2, 2.0, 3.0, 4.0, 4.8]) {
            assert!((x - known).abs() < 1e-14, "{x} {known}");
        }
        assert!(Statistics::of(&Column { values: vec![f64::NAN], ..Column::default() }).is_none());
    }
}
