//! Eigenvalues of a real matrix, found in a bounded number of steps or not at all.

use nalgebra::linalg::Schur;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector};

/// Iterations of the QR algorithm for each row and column; it takes two or three.
const PER_ROW: usize = 100;

/// Round-off that an entry below the diagonal may have, of those beside it, when it counts as zero: of eigenvalues that are many times the
/// same, the algorithm does not come below the first.
const ROUNDINGS: [f64; 4] = [1.0, 4.0, 16.0, 64.0];

/// Part of an eigenvalue up to which its imaginary part is round-off: half of the digits, since two equal ones are no better known.
const PAIRED: f64 = 1e-7;

/// Eigenvalues by the QR algorithm, behind a balancing by powers of two (Parlett & Reinsch, Numer. Math. 13 (1969) 293-304), since
/// coordinates, rates and states differ by orders of magnitude; none if the size of the matrix is no number, with which neither balancing nor the algorithm
/// would end, or if it does not converge.
#[must_use]
pub fn eigenvalues(a: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    if a.is_empty() {
        return Some(Vec::new());
    }
    if !measurable(a) {
        return None;
    }
    let mut balanced = a.clone();
    balance_parlett_reinsch(&mut balanced);
    let schur = ROUNDINGS.into_iter().find_map(|part| Schur::try_new(balanced.clone(), part * f64::EPSILON, PER_ROW * (a.nrows() + 1)))?;
    Some(schur.complex_eigenvalues().iter().copied().collect())
}

/// Real eigenvalues, and of each complex pair the one with the positive imaginary part. Two real ones that round-off has made a pair are
/// two real ones.
#[must_use]
pub fn of_each_pair(values: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
    let real = |x: Complex<f64>| if x.im.abs() <= PAIRED * x.norm() { Complex::from(x.re) } else { x };
    values.into_iter().map(real).filter(|x| x.im >= 0.0).collect()
}

/// The eigenvector of unit length of an eigenvalue, by three steps of inverse iteration next to it, which begin in no special direction:
/// another one for each `seed`.
#[must_use]
pub fn eigenvector(a: &DMatrix<f64>, value: Complex<f64>, seed: usize) -> DVector<Complex<f64>> {
    let order = a.nrows();
    let beside = value + Complex::new(f64::EPSILON * a.norm(), 0.0);
    let shifted = DMatrix::from_fn(order, order, |i, j| Complex::from(a[(i, j)]) - if i == j { beside } else { Complex::default() });
    let factors = shifted.lu();
    let noise = DVector::from_fn(order, |i, _| Complex::from(1.0 + (2.39 * (i + 1) as f64 * (seed + 1) as f64).sin()));
    let mut x = noise.unscale(noise.norm());
    for _ in 0..3 {
        if let Some(y) = factors.solve(&x)
            && y.iter().all(|y| y.re.is_finite() && y.im.is_finite())
        {
            x = y.unscale(y.norm());
        }
    }
    x
}

/// Whether the size of a matrix is a number.
pub(crate) fn measurable(a: &DMatrix<f64>) -> bool {
    a.norm_squared().is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_do_not_cost_digits() {
        // a slow state of a fast oscillator, in units 1e12 apart
        let slow = DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, -1.6e7, -160.0, 1e-6, 0.0, 1e6, -0.01]);
        let units = [1.0, 1e-3, 1e12];
        let scaled = DMatrix::from_fn(3, 3, |i, j| slow[(i, j)] * units[i] / units[j]);
        let least = |a: &DMatrix<f64>| eigenvalues(a).unwrap().into_iter().map(|x| x.re).fold(f64::NEG_INFINITY, f64::max);
        // −det / (sum of the products of pairs), to the square of its part of them
        let expected = -0.01 * 1.6e7 / (1.6e7 + 1.6 - 1.0);
        for a in [&slow, &scaled] {
            assert!((least(a) / expected - 1.0).abs() < 1e-6, "{} {expected}", least(a));
        }
        assert!((least(&slow) / least(&scaled) - 1.0).abs() < 1e-10);
    }

    #[test]
    fn equal_ones_are_found_however_many() {
        // x″ + c x′ + λ x = 0, a third of each kind
        let kinds = [(7.36, 0.5), (14.7, 8.0), (-7.36, 0.5)];
        for n in [6, 21, 60] {
            let (mut a, mut right) = (DMatrix::zeros(2 * n, 2 * n), Vec::new());
            for i in 0..n {
                let (lambda, c): (f64, f64) = kinds[i % 3];
                a[(i, n + i)] = 1.0;
                a[(n + i, i)] = -lambda;
                a[(n + i, n + i)] = -c;
                let root = Complex::from(0.25 * c * c - lambda).sqrt();
                right.extend([root, -root].map(|root| root - 0.5 * c));
            }
            let order = |x: &Complex<f64>, y: &Complex<f64>| (x.re, x.im).partial_cmp(&(y.re, y.im)).unwrap();
            let rounded = |x: Complex<f64>| Complex::new((x.re * 1e9).round() / 1e9, (x.im * 1e9).round() / 1e9 + 0.0);
            let mut found: Vec<Complex<f64>> = eigenvalues(&a).unwrap().into_iter().map(rounded).collect();
            let mut right: Vec<Complex<f64>> = right.into_iter().map(rounded).collect();
            found.sort_by(order);
            right.sort_by(order);
            assert!(found.iter().zip(&right).all(|(x, y)| (x - y).norm() < 1e-8), "{n}: {found:?}, {right:?}");
        }
    }

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
