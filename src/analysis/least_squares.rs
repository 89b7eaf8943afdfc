//! Small least-squares solves at assembly, where rows may be redundant or contradict each other.

use grashof_solvers::svd::Svd;
use nalgebra::DMatrix;

/// Part of the largest singular value below which a direction counts as not determined.
const RANK_TOLERANCE: f64 = 1e-10;

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
    let scaled = DMatrix::from_fn(b.len(), n, |i, j| a[i * n + j] / root[j]);
    let svd = Svd::new(&scaled);
    let largest = svd.largest();
    let least = f64::max(RANK_TOLERANCE * largest, round_off);
    let x = svd.solve(b, |s| if s > least { s / (s * s + damping * largest * largest) } else { 0.0 });
    x.iter().zip(&root).map(|(x, r)| x / r).collect()
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
    fn rows_of_round_off_move_nothing() {
        let noise = [3e-17, -1e-17, 2e-17, 5e-18];
        assert!(shortest(&noise, &[1e-16, 1e-16], &[1.0, 4.0], 0.0)[0].abs() > 1.0);
        assert_eq!(shortest_beyond(1e-11, &noise, &[1e-16, 1e-16], &[1.0, 4.0], 0.0), [0.0, 0.0]);
    }
}
