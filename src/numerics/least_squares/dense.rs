//! Least squares by singular values, of full rows.

use super::rows::Level;
use grashof_solvers::svd::Svd;
use nalgebra::{DMatrix, DVector, Dyn, QR};

/// Part of the largest singular value below which a direction counts as not determined.
const RANK_TOLERANCE: f64 = 1e-10;

/// Rows of which no combination is shorter than this part of the longest row are independent beyond doubt: its square is still far
/// above the rounding of products of rows. The singular values themselves, which cost some twenty times as much, decide on others.
pub(super) const CLEAR: f64 = 1e-6;

/// Columns up to which singular values cost next to nothing, so that nothing else is asked.
pub(super) const FEW: usize = 64;

/// The shortest x (in the metric, Σ dᵢ xᵢ²) that makes |A x − b|² + μ (its size)² least; A is rows × metric.len(), row-major.
///
/// With μ = 0 it is the pseudo-inverse in the metric; μ > 0 is Levenberg's damping.
#[must_use]
pub(crate) fn shortest(a: &[f64], b: &[f64], metric: &[f64], damping: f64) -> Vec<f64> {
    shortest_beyond(0.0, a, b, metric, damping)
}

/// The same where singular values of A D^−½ up to `round_off` are nothing else, even if there are no larger ones.
#[must_use]
pub(crate) fn shortest_beyond(round_off: f64, a: &[f64], b: &[f64], metric: &[f64], damping: f64) -> Vec<f64> {
    let n = metric.len();
    if b.is_empty() || n == 0 {
        return vec![0.0; n];
    }
    let root: Vec<f64> = metric.iter().map(|d| d.sqrt()).collect();
    let rows = scaled(a, metric);
    if damping == 0.0 {
        let met = if are_independent(&rows, round_off) {
            Some(shortest_met(&rows, b))
        } else if are_independent(&rows.transpose(), round_off) {
            Some(least_missed(rows.clone(), b))
        } else {
            None
        };
        if let Some(x) = met {
            return x.iter().zip(&root).map(|(x, r)| x / r).collect();
        }
    }
    let svd = Svd::new(&rows);
    let largest = svd.largest();
    let least = f64::max(RANK_TOLERANCE * largest, round_off);
    let x = svd.solve(b, |s| if s > least { s / (s * s + damping * largest * largest) } else { 0.0 });
    x.iter().zip(&root).map(|(x, r)| x / r).collect()
}

/// x + δ with the shortest δ (in the metric) that makes |A x − b|² least for the first level, among those for the second, and so on.
#[must_use]
pub(super) fn in_turn(levels: &[Level], metric: &[f64], x: Vec<f64>) -> Vec<f64> {
    let n = metric.len();
    let root: Vec<f64> = metric.iter().map(|d| d.sqrt()).collect();
    let mut x = x;
    let levels: Vec<&Level> = levels.iter().filter(|level| !level.rows.is_empty()).collect();
    if n == 0 || levels.iter().all(|level| level.missing(&x).iter().all(|b| *b == 0.0)) {
        return x;
    }
    // motions that the levels so far leave open, in units of the metric
    let mut basis = DMatrix::identity(n, n);
    for (index, level) in levels.iter().enumerate() {
        if basis.ncols() == 0 {
            break;
        }
        let last = index + 1 == levels.len();
        let rows = scaled(&level.rows.to_dense(n), metric);
        // what is small beside the rows before they are seen along the basis is round-off
        let least = f64::max(RANK_TOLERANCE * rows.row_iter().fold(0.0, |m, row| f64::max(m, row.norm())), level.round_off);
        let rows = if index == 0 { rows } else { &rows * &basis };
        let mut right = level.missing(&x);
        let (way, open) = if n > FEW && are_independent(&rows, least) {
            met(&rows, &right)
        } else {
            let svd = if last { Svd::new(&rows) } else { padded(rows, level.b.len()) };
            right.resize(svd.u.nrows(), 0.0);
            let way = svd.solve(&right, |s| if s > least { 1.0 / s } else { 0.0 });
            (way, if last { DMatrix::zeros(0, 0) } else { left_over(&svd, least) })
        };
        for i in 0..n {
            x[i] += (0..way.len()).map(|k| basis[(i, k)] * way[k]).sum::<f64>() / root[i];
        }
        if !last {
            basis = &basis * open;
        }
    }
    x
}

/// Whether all singular values of rows A are above `least`, and far above what rounding leaves: A Aᵀ − τ² is positive definite.
pub(super) fn are_independent(a: &DMatrix<f64>, least: f64) -> bool {
    if a.nrows() > a.ncols() {
        return false;
    }
    let longest = a.row_iter().fold(0.0, |m, row| f64::max(m, row.norm()));
    let clear = f64::max(CLEAR * longest, 10.0 * least);
    let mut gram = a * a.transpose();
    (0..a.nrows()).for_each(|i| gram[(i, i)] -= clear * clear);
    gram.cholesky().is_some()
}

/// The shortest x with A x = b for independent rows A, by A = Rᵀ Qᵀ.
fn shortest_met(a: &DMatrix<f64>, b: &[f64]) -> Vec<f64> {
    let qr = a.transpose().qr();
    (qr.q() * along(&qr, b)).as_slice().to_vec()
}

/// The x that makes |A x − b|² least for independent columns A, by A = Q R.
fn least_missed(a: DMatrix<f64>, b: &[f64]) -> Vec<f64> {
    let n = a.ncols();
    let qr = a.qr();
    let mut right = DVector::from_column_slice(b);
    qr.q_tr_mul(&mut right);
    let mut x = right.rows(0, n).into_owned();
    let solved = qr.r().solve_upper_triangular_mut(&mut x);
    debug_assert!(solved, "independent columns have no zero on the diagonal");
    x.as_slice().to_vec()
}

/// The shortest x with A x = b for independent rows A, and an orthonormal basis of what the rows leave open.
fn met(a: &DMatrix<f64>, b: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
    let (rows, columns) = a.shape();
    let qr = a.transpose().qr();
    let mut transposed = DMatrix::identity(columns, columns);
    qr.q_tr_mul(&mut transposed);
    let way = transposed.rows(0, rows).tr_mul(&along(&qr, b));
    (way.as_slice().to_vec(), transposed.rows(rows, columns - rows).transpose())
}

/// Parts y of x along the columns of Q, of Rᵀ y = b.
fn along(qr: &QR<f64, Dyn, Dyn>, b: &[f64]) -> DVector<f64> {
    let mut y = DVector::from_column_slice(b);
    let met = qr.r().tr_solve_upper_triangular_mut(&mut y);
    debug_assert!(met, "independent rows have no zero on the diagonal");
    y
}

/// Motions that rows A leave open, as columns that are orthonormal in the metric; A is rows × metric.len(), row-major. Singular
/// values of A D^−½ up to `round_off` are nothing else.
#[must_use]
pub(crate) fn left_open(round_off: f64, a: &[f64], metric: &[f64]) -> DMatrix<f64> {
    let n = metric.len();
    let rows = a.len() / n.max(1);
    let root: Vec<f64> = metric.iter().map(|d| d.sqrt()).collect();
    let svd = padded(scaled(a, metric), rows);
    let least = f64::max(RANK_TOLERANCE * svd.largest(), round_off);
    let mut basis = left_over(&svd, least);
    basis.row_iter_mut().zip(&root).for_each(|(mut row, root)| row /= *root);
    basis
}

/// Whether all singular values are above a part of the largest: by a bound from below, σ ≥ 1/‖R⁻¹‖_F with A = Q R or Aᵀ = Q R, a small
/// part of the work that the values themselves take.
pub(super) fn are_above(a: &DMatrix<f64>, part: f64) -> bool {
    least_singular_value(a) > part * a.norm()
}

/// The bound; 0 if R is singular.
fn least_singular_value(a: &DMatrix<f64>) -> f64 {
    let r = if a.nrows() < a.ncols() { a.transpose().qr().unpack_r() } else { a.clone().qr().unpack_r() };
    let n = r.ncols();
    if n == 0 || (0..n).any(|i| r[(i, i)] == 0.0) {
        return 0.0;
    }
    r.solve_upper_triangular(&DMatrix::identity(n, n)).map_or(0.0, |inverse| inverse.norm().recip())
}

/// A D^−½ of row-major A.
pub(super) fn scaled(a: &[f64], metric: &[f64]) -> DMatrix<f64> {
    let n = metric.len();
    let root: Vec<f64> = metric.iter().map(|d| d.sqrt()).collect();
    DMatrix::from_fn(a.len() / n.max(1), n, |i, j| a[i * n + j] / root[j])
}

/// Gauss-Newton's steps among the motions that rows leave, by a basis of these.
pub(super) struct Within {
    /// The motions (n × k, orthonormal in the metric), and the slopes along them (rows × k, row-major).
    basis: DMatrix<f64>,
    along: Vec<f64>,
}

impl Within {
    pub(super) fn new(hold: &[f64], round_off: f64, slopes: &[f64], metric: &[f64]) -> Self {
        let basis = left_open(round_off, hold, metric);
        let along = slopes
            .chunks_exact(metric.len().max(1))
            .flat_map(|row| basis.column_iter().map(move |way| row.iter().zip(way.iter()).map(|(a, b)| a * b).sum::<f64>()))
            .collect();
        Self { basis, along }
    }

    pub(super) fn slope(&self, right: &[f64]) -> f64 {
        let n = self.basis.ncols();
        let along = |k: usize| right.iter().enumerate().map(|(i, r)| r * self.along[i * n + k]).sum::<f64>();
        (0..n).map(|k| along(k).powi(2)).sum::<f64>().sqrt()
    }

    pub(super) fn step(&self, right: &[f64], damping: f64) -> Vec<f64> {
        let way = shortest(&self.along, right, &vec![1.0; self.basis.ncols()], damping);
        (0..self.basis.nrows()).map(|i| way.iter().enumerate().map(|(k, x)| self.basis[(i, k)] * x).sum()).collect()
    }
}

/// The decomposition with as many rows as columns at least, so that V is whole.
fn padded(a: DMatrix<f64>, rows: usize) -> Svd {
    let columns = a.ncols();
    Svd::new(&a.resize_vertically(rows.max(columns), 0.0))
}

/// Right singular vectors of singular values up to `least`.
fn left_over(svd: &Svd, least: f64) -> DMatrix<f64> {
    let open: Vec<usize> = (0..svd.values.len()).filter(|&k| svd.values[k] <= least).collect();
    DMatrix::from_fn(svd.v.nrows(), open.len(), |i, k| svd.v[(i, open[k])])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn redundant_rows_give_the_shortest_solution() {
        // x + y = 2 twice; metric (1, 4): the shortest is (1.6, 0.4)
        let x = shortest(&[1.0, 1.0, 2.0, 2.0], &[2.0, 4.0], &[1.0, 4.0], 0.0);
        assert!((x[0] - 1.6).abs() < 1e-14 && (x[1] - 0.4).abs() < 1e-14, "{x:?}");
    }

    #[test]
    fn independent_rows_have_the_solution_of_singular_values() {
        let (rows, columns) = (7, 12);
        let a: Vec<f64> = (0..rows * columns).map(|k| ((3 * k + k * k / 5) as f64).sin()).collect();
        let metric: Vec<f64> = (0..columns).map(|k| 10f64.powi(k % 4 - 2)).collect();
        let b: Vec<f64> = (0..rows).map(|k| k as f64 - 2.5).collect();
        assert!(are_independent(&scaled(&a, &metric), 0.0));
        let svd = Svd::new(&scaled(&a, &metric));
        let right = svd.solve(&b, f64::recip);
        let found = shortest(&a, &b, &metric, 0.0);
        assert!(found.iter().zip(&right).zip(&metric).all(|((x, y), d)| (x * d.sqrt() - y).abs() < 1e-12 * (1.0 + y.abs())), "{found:?}");
    }

    #[test]
    fn independent_columns_have_the_solution_of_singular_values() {
        let (rows, columns) = (11, 6);
        let a: Vec<f64> = (0..rows * columns).map(|k| ((3 * k + k * k / 5) as f64).sin()).collect();
        let metric: Vec<f64> = (0..columns).map(|k| 10f64.powi(k % 4 - 2)).collect();
        let b: Vec<f64> = (0..rows).map(|k| k as f64 - 2.5).collect();
        assert!(are_independent(&scaled(&a, &metric).transpose(), 0.0));
        let right = Svd::new(&scaled(&a, &metric)).solve(&b, f64::recip);
        let found = shortest(&a, &b, &metric, 0.0);
        assert!(found.iter().zip(&right).zip(&metric).all(|((x, y), d)| (x * d.sqrt() - y).abs() < 1e-12 * (1.0 + y.abs())), "{found:?}");
    }

    #[test]
    fn rows_of_round_off_move_nothing() {
        let noise = [3e-17, -1e-17, 2e-17, 5e-18];
        assert!(shortest(&noise, &[1e-16, 1e-16], &[1.0, 4.0], 0.0)[0].abs() > 1.0);
        assert_eq!(shortest_beyond(1e-11, &noise, &[1e-16, 1e-16], &[1.0, 4.0], 0.0), [0.0, 0.0]);
    }

    #[test]
    fn levels_are_met_in_turn() {
        // x + y = 1 holds; x = 3 and x = 5 are as near as can be at 4; then z rests, and w at half its wish
        let level = |rows: &[([f64; 4], f64)]| {
            let mut level = Level::default();
            rows.iter().for_each(|(row, b)| level.row(row.iter().copied().enumerate(), *b, 1.0));
            level
        };
        let levels = [
            level(&[([1.0, 1.0, 0.0, 0.0], 1.0), ([2.0, 2.0, 0.0, 0.0], 2.0)]),
            level(&[([1.0, 0.0, 0.0, 0.0], 3.0), ([1.0, 0.0, 0.0, 0.0], 5.0)]),
            level(&[([1.0, 0.0, 0.0, 0.0], 0.0), ([0.0, 0.0, 1.0, 0.0], 0.0), ([0.0, 0.0, 0.0, 1.0], 2.0), ([0.0, 0.0, 0.0, 1.0], 0.0)]),
        ];
        let x = in_turn(&levels, &[1.0, 4.0, 1.0, 1.0], vec![0.3, -0.2, 7.0, 1.0]);
        let right = [4.0, -3.0, 0.0, 1.0];
        assert!(x.iter().zip(right).all(|(x, r)| (x - r).abs() < 1e-14), "{x:?}");
    }

    #[test]
    fn independent_rows_are_met_as_by_singular_values() {
        // entries of no special rule; the metric of several sizes
        let n = FEW + 6;
        let entry = |i: usize, j: usize| ((3 * i + 7 * j * j + i * j) as f64).sin();
        let metric: Vec<f64> = (0..n).map(|k| 10f64.powi(k as i32 % 4 - 2)).collect();
        let level = |rows: std::ops::Range<usize>| {
            let mut level = Level::default();
            for i in rows {
                level.row((0..n).map(|j| (j, entry(i, j))), i as f64 - 3.0, 1.0);
            }
            level
        };
        let mut levels = [level(0..30), level(30..60), level(60..80)];
        let met = in_turn(&levels, &metric, vec![0.1; n]);
        // a copy of a row changes nothing but the way of the solution
        let scaled = |level: &Level| scaled(&level.rows.to_dense(n), &metric);
        assert!(are_independent(&scaled(&levels[0]), 0.0));
        let (copy, right) = (levels[0].rows.line(0).to_vec(), levels[0].b[0]);
        levels[0].row(copy, right, 1.0);
        assert!(!are_independent(&scaled(&levels[0]), 0.0));
        let decomposed = in_turn(&levels, &metric, vec![0.1; n]);
        assert!(met.iter().zip(&decomposed).all(|(x, y)| (x - y).abs() < 1e-11 * (1.0 + y.abs())), "{met:?} {decomposed:?}");
        assert!(levels[0].missing(&met).iter().chain(&levels[1].missing(&met)).all(|b| b.abs() < 1e-9));
    }

    #[test]
    fn rows_near_dependence_are_left_to_their_singular_values() {
        let rows = |angle: f64| DMatrix::from_row_slice(2, 3, &[1.0, 0.0, 0.0, angle.cos(), angle.sin(), 0.0]);
        assert!(are_independent(&rows(0.1), 0.0) && !are_independent(&rows(0.1), 0.01));
        assert!(!are_independent(&rows(1e-7), 0.0) && are_independent(&rows(1e-5), 0.0) && !are_independent(&rows(0.0), 0.0));
        assert!(!are_independent(&DMatrix::zeros(3, 2), 0.0) && are_independent(&DMatrix::zeros(0, 2), 0.0));
    }

    #[test]
    fn singular_values_are_bounded_from_below() {
        for (rows, columns) in [(4, 7), (7, 4), (5, 5)] {
            let a = DMatrix::from_fn(rows, columns, |i, k| ((3 * i + 5 * k * k + i * k) as f64).sin());
            let least = Svd::new(&a).values.into_iter().fold(f64::INFINITY, f64::min);
            let bound = least_singular_value(&a);
            assert!(bound <= least && bound > 0.3 * least, "{bound} {least}");
        }
        assert_eq!(least_singular_value(&DMatrix::zeros(2, 3)), 0.0);
    }

    #[test]
    fn what_rows_leave_open_is_orthonormal() {
        let (a, metric) = ([1.0, 1.0, 0.0, 2.0, 2.0, 0.0], [1.0, 4.0, 9.0]);
        let basis = left_open(0.0, &a, &metric);
        assert_eq!(basis.ncols(), 2);
        for way in basis.column_iter() {
            assert!((way[0] + way[1]).abs() < 1e-14);
        }
        let product = basis.transpose() * DMatrix::from_diagonal(&nalgebra::DVector::from_row_slice(&metric)) * &basis;
        assert!((product - DMatrix::identity(2, 2)).norm() < 1e-14);
    }
}
