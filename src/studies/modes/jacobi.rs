//! Jacobi's rotations: every off-diagonal entry in turn is rotated to zero, until all are (Golub & Van Loan, Matrix
//! Computations, 4th edition, section 8.5).

use super::eigen::{Eigen, Standard};
use nalgebra::DMatrix;

/// Sweeps before the method counts as not converging; it converges by squares, in about ten.
const SWEEPS: usize = 60;

/// Eigenvalues of K x = λ M x by cyclic rotations of the standard form; none if M is not positive definite.
#[must_use]
pub fn jacobi(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Option<Eigen> {
    let standard = Standard::new(k, m)?;
    let mut a = standard.s.clone();
    let n = a.nrows();
    let mut v = DMatrix::identity(n, n);
    let floor = f64::EPSILON * f64::EPSILON * a.norm();
    for sweep in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                let off = a[(p, q)].abs();
                if off > floor && off > 0.25 * f64::EPSILON * (a[(p, p)] * a[(q, q)]).abs().sqrt() {
                    rotate(&mut a, &mut v, p, q);
                    rotated = true;
                }
            }
        }
        if !rotated {
            return standard.eigen(a.diagonal().as_slice(), &v, sweep);
        }
    }
    None
}

/// A := JᵀAJ and V := VJ with the rotation of p and q by at most 45° that takes a_pq to zero: τ = (a_qq − a_pp)/(2 a_pq),
/// t = sign τ/(|τ| + √(1 + τ²)) (equation 8.5.2 there).
fn rotate(a: &mut DMatrix<f64>, v: &mut DMatrix<f64>, p: usize, q: usize) {
    let (app, aqq, apq) = (a[(p, p)], a[(q, q)], a[(p, q)]);
    let tau = (aqq - app) / (2.0 * apq);
    let t = tau.signum() / (tau.abs() + tau.hypot(1.0));
    let c = t.hypot(1.0).recip();
    let s = t * c;
    for k in (0..a.nrows()).filter(|k| *k != p && *k != q) {
        let (x, y) = (a[(k, p)], a[(k, q)]);
        (a[(k, p)], a[(k, q)]) = (c * x - s * y, s * x + c * y);
        (a[(p, k)], a[(q, k)]) = (a[(k, p)], a[(k, q)]);
    }
    (a[(p, p)], a[(q, q)]) = (app - t * apq, aqq + t * apq);
    (a[(p, q)], a[(q, p)]) = (0.0, 0.0);
    for k in 0..v.nrows() {
        let (x, y) = (v[(k, p)], v[(k, q)]);
        (v[(k, p)], v[(k, q)]) = (c * x - s * y, s * x + c * y);
    }
}
