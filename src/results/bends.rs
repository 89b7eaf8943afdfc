//! At which switches a curve shows.

use super::Column;
use std::collections::BTreeMap;

/// Nodes of the polynomials whose slopes at a switch are compared; those of one less tell how good these are.
const NODES: usize = 4;
/// Part of the range of a curve by which it has to jump to show.
const JUMP: f64 = 3e-3;
/// Angle by which a curve has to bend to show, rad, in a square picture of its whole range.
const BEND: f64 = 0.03;

/// Part of the largest value of a unit by which a column varies through rounding alone.
const ROUNDING: f64 = 1e-9;

/// The largest value of the columns of each unit.
#[must_use]
pub fn largest<'a>(columns: impl IntoIterator<Item = &'a Column>) -> BTreeMap<&'a str, f64> {
    let mut all = BTreeMap::new();
    for column in columns {
        let largest: &mut f64 = all.entry(column.unit.as_str()).or_default();
        *largest = column.values.iter().filter(|value| value.is_finite()).fold(*largest, |largest, value| largest.max(value.abs()));
    }
    all
}

/// Of the `switches` of a table, rows that stand just before one and at the x of the row that follows, those where a `column` over `x`
/// visibly jumps, bends, begins or ends. What varies by nothing beside the `largest` value of its unit is constant.
#[must_use]
pub fn bends(x: &[f64], column: &Column, largest: &BTreeMap<&str, f64>, switches: &[usize]) -> Vec<usize> {
    let least = largest.get(column.unit.as_str()).map_or(0.0, |largest| ROUNDING * largest);
    shown(x, &column.values, least, switches)
}

/// The same of a curve that is constant if it varies by no more than `least`.
fn shown(x: &[f64], y: &[f64], least: f64, switches: &[usize]) -> Vec<usize> {
    let [wide, high] = [range(x), range(y)];
    let shows = |&&row: &&usize| {
        let (Some(before), Some(after)) = (y.get(row), y.get(row + 1)) else { return false };
        if before.is_finite() != after.is_finite() {
            return true;
        }
        if !(wide > 0.0 && high > least) || before.is_nan() {
            return false;
        }
        let angle = |rows: &[usize]| angle(rows.iter().map(|&row| (x[row] / wide, y[row] / high)).collect());
        (after - before).abs() > JUMP * high
            || match [angle(&piece(x, y, row, -1)), angle(&piece(x, y, row + 1, 1))] {
                [Some((left, off)), Some((right, of))] => (left - right).abs() > BEND + 2.0 * (off + of),
                _ => false,
            }
    };
    switches.iter().filter(shows).copied().collect()
}

/// The range of the finite among some numbers.
fn range(values: &[f64]) -> f64 {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min)
}

/// Up to `NODES` rows from `row` on to one side, in one smooth piece.
fn piece(x: &[f64], y: &[f64], row: usize, step: isize) -> Vec<usize> {
    let mut rows = vec![row];
    while let (Some(next), true) = (rows[rows.len() - 1].checked_add_signed(step), rows.len() < NODES) {
        if next >= x.len() || x[next] == x[rows[rows.len() - 1]] || !y[next].is_finite() {
            break;
        }
        rows.push(next);
    }
    rows
}

/// The angle in which a curve through some points leaves the first of them, and about how far that is off; none of fewer than three, of
/// which a chord tells no slope.
fn angle(points: Vec<(f64, f64)>) -> Option<(f64, f64)> {
    let [best, worse] = [slope(&points)?, slope(points.get(..points.len() - 1).filter(|fewer| fewer.len() > 1)?)?];
    Some((best.atan(), (best.atan() - worse.atan()).abs()))
}

/// The slope at its first point of the polynomial through all of them, after Newton's divided differences; none of a single point.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let first = points.first()?.0;
    let mut differences: Vec<f64> = points.iter().map(|point| point.1).collect();
    let (mut sum, mut product) = (None, 1.0);
    for order in 1..points.len() {
        for k in (order..points.len()).rev() {
            differences[k] = (differences[k] - differences[k - 1]) / (points[k].0 - points[k - order].0);
        }
        sum = Some(sum.unwrap_or(0.0) + differences[order] * product);
        product *= first - points[order].0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of two branches that meet at x = 1.
    fn rows(before: impl Fn(f64) -> f64, after: impl Fn(f64) -> f64) -> [Vec<f64>; 2] {
        let left: Vec<f64> = (0..=20).map(|k| f64::from(k) / 20.0).collect();
        let right: Vec<f64> = (20..=40).map(|k| f64::from(k) / 20.0).collect();
        let y = left.iter().map(|x| before(*x)).chain(right.iter().map(|x| after(*x))).collect();
        [[left, right].concat(), y]
    }

    fn shows(before: impl Fn(f64) -> f64, after: impl Fn(f64) -> f64) -> bool {
        let [x, y] = rows(before, after);
        shown(&x, &y, 0.0, &[20]) == [20]
    }

    #[test]
    fn jumps_and_bends_show_and_smooth_curves_do_not() {
        let sine = |x: f64| (7.0 * x).sin();
        assert!(!shows(sine, sine));
        assert!(!shows(|x| x, |x| x + 2e-3));
        assert!(shows(|x| x, |x| x + 0.01));
        assert!(shows(|x| x, |x| 1.0 + 1.2 * (x - 1.0)));
        assert!(shows(sine, |x| sine(x) - 3.0 * (x - 1.0)) && !shows(sine, |x| sine(x) + 0.5 * (x - 1.0)));
        // where only the curvature jumps nothing is seen
        assert!(!shows(|_| 0.0, |x| (x - 1.0).powi(2)));
        assert!(shows(|_| f64::NAN, |x| x));
        assert!(!shows(|_| 1.0, |_| 1.0));
    }

    #[test]
    fn two_rows_tell_no_slope() {
        // a smooth curve with another switch a row later
        let y = |x: f64| x * x;
        let x = [0.0, 0.2, 0.4, 0.6, 0.8, 0.8, 1.0, 1.0, 1.2, 1.4];
        assert!(shown(&x, &x.map(y), 0.0, &[4, 6]).is_empty());
        let jumps = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        assert_eq!(shown(&x, &jumps, 0.0, &[4, 6]), [4, 6]);
    }

    #[test]
    fn rounding_does_not_bend() {
        let column = |name: &str, values: Vec<f64>| Column { name: name.into(), unit: "J".into(), values, ..Column::default() };
        let [x, noise] = rows(|x| 1e-12 * (900.0 * x).sin(), |x| -1e-12 * x);
        let [total, kinetic] = [column("total", noise.clone()), column("kinetic", noise.iter().map(|e| 1e12 * e).collect())];
        assert!(!shown(&x, &noise, 0.0, &[20]).is_empty());
        assert!(bends(&x, &total, &largest([&total, &kinetic]), &[20]).is_empty());
        assert_eq!(bends(&x, &kinetic, &largest([&total, &kinetic]), &[20]), [20]);
    }

    #[test]
    fn the_slope_of_a_polynomial_is_exact() {
        let cubic = |x: f64| 2.0 * x.powi(3) - x;
        let points: Vec<(f64, f64)> = [0.5, 0.7, 1.0, 1.1].map(|x| (x, cubic(x))).to_vec();
        assert!((slope(&points).expect("a slope") - 0.5).abs() < 1e-13);
        assert_eq!(slope(&points[..1]), None);
    }
}
