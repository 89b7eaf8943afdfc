//! Eigenvalues of a real matrix, found in a bounded number of steps or not at all.

use nalgebra::linalg::Schur;
use nalgebra::{Complex, DMatrix};

/// Iterations of the QR algorithm for each row and column; it takes two or three.
const PER_ROW: usize = 100;

/// Eigenvalues by the QR algorithm; none if the size of the matrix is no number, with which neither balancing nor the algorithm
/// would end, or if it does not converge.
#[must_use]
pub fn eigenvalues(a: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    if a.is_empty() {
        return Some(Vec::new());
    }
    if !measurable(a) {
        return None;
    }
    let schur = Schur::try_new(a.clone(), f64::EPSILON, PER_ROW * (a.nrows() + 1))?;
    Some(schur.complex_eigenvalues().iter().copied().collect())
}

/// Whether the size of a matrix is a number.
pub(crate) fn measurable(a: &DMatrix<f64>) -> bool {
    a.norm_squared().is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_beyond_numbers_has_none() {
        let rotation = DMatrix::from_row_slice(2, 2, &[0.0, -3.0, 3.0, 0.0]);
        let mut found: Vec<f64> = eigenvalues(&rotation).unwrap().iter().map(|x| x.im).collect();
        found.sort_by(f64::total_cmp);
        assert!((found[0] + 3.0).abs() < 1e-14 && (found[1] - 3.0).abs() < 1e-14);
        for x in [1e200, f64::INFINITY, f64::NAN] {
            assert!(eigenvalues(&DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -x, x])).is_none());
        }
    }
}
