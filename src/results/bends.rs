//! At which switches a curve shows.

/// Nodes of the polynomials whose slopes at a switch are compared; those of one less tell how good these are.
const NODES: usize = 4;
/// Part of the range of a curve by which it has to jump to show.
const JUMP: f64 = 3e-3;
/// Angle by which a curve has to bend to show, rad, in a square picture of its whole range.
const BEND: f64 = 0.03;

/// Of the `switches` of a table, rows that stand just before one and at the x of the row that follows, those where a curve `y` over `x`
/// visibly jumps, bends, begins or ends.
#[must_use]
pub fn bends(x: &[f64], y: &[f64], switches: &[usize]) -> Vec<usize> {
    let [wide, high] = [range(x), range(y)];
    let shows = |&&row: &&usize| {
        let (Some(before), Some(after)) = (y.get(row), y.get(row + 1)) else { return false };
        if before.is_finite() != after.is_finite() {
            return true;
        }
        if !(wide > 0.0 && high > 0.0) || before.is_nan() {
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

/// The angle in which a curve through some points leaves the first of them, and about how far that is off; none of a single point.
fn angle(points: Vec<(f64, f64)>) -> Option<(f64, f64)> {
    let best = slope(&points)?;
    let worse = if points.len() > 2 { slope(&points[..points.len() - 1])? } else { best };
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
        bends(&x, &y, &[20]) == [20]
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
    fn the_slope_of_a_polynomial_is_exact() {
        let cubic = |x: f64| 2.0 * x.powi(3) - x;
        let points: Vec<(f64, f64)> = [0.5, 0.7, 1.0, 1.1].map(|x| (x, cubic(x))).to_vec();
        assert!((slope(&points).expect("a slope") - 0.5).abs() < 1e-13);
        assert_eq!(slope(&points[..1]), None);
    }
}
