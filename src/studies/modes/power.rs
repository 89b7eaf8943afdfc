//! Inverse iteration with deflation: y = (K − σM)⁻¹ M x again and again, with x kept M-orthogonal to the vectors found before
//! (Bathe, Finite Element Procedures, 2nd edition, sections 11.2.1 and 11.2.5).
//!
//! The shift σ begins below all eigenvalues (Gershgorin's circles), so that negative and zero ones are found like others, the lowest
//! first. With residual e = ‖L⁻¹(K x − ρ M x)‖ an eigenvalue lies within e of Rayleigh's quotient ρ; once e is small against ρ − σ
//! the shift moves up to ρ − 2e, and the iteration converges faster than linearly. A multiple eigenvalue gives its vectors one after
//! the other, since each start is M-orthogonal to those before.

use super::eigen::{Eigen, Standard, product};
use nalgebra::linalg::LU;
use nalgebra::{DMatrix, DVector, Dyn};

/// Steps for one vector before the method counts as not converging.
const STEPS: usize = 2000;

/// Eigenvalues of K x = λ M x by inverse iteration; none if M is not positive definite or a vector does not converge.
#[must_use]
pub fn power(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Option<Eigen> {
    let standard = Standard::new(k, m)?;
    let n = k.nrows();
    let [low, high] = circles(&standard.s);
    let size = low.abs().max(high.abs());
    let mut search = Search { k, m, standard: &standard, found: Vec::new(), size, steps: 0 };
    let mut values = Vec::new();
    for i in 0..n {
        let x = search.start(i)?;
        let (value, x) = search.converge(low - 0.01 * (high - low) - 1e-3 * size - f64::MIN_POSITIVE.sqrt(), x)?;
        values.push(value);
        search.found.push(x);
    }
    let vectors = DMatrix::from_fn(n, n, |i, j| search.found[j][i]);
    let steps = search.steps;
    standard.eigen(&values, &(standard.factor.l().transpose() * vectors), steps)
}

/// Bounds of all eigenvalues of a symmetric matrix, by Gershgorin.
fn circles(s: &DMatrix<f64>) -> [f64; 2] {
    let radius = |i: usize| s.row(i).iter().map(|x| x.abs()).sum::<f64>() - s[(i, i)].abs();
    let low = (0..s.nrows()).map(|i| s[(i, i)] - radius(i)).fold(f64::INFINITY, f64::min);
    let high = (0..s.nrows()).map(|i| s[(i, i)] + radius(i)).fold(f64::NEG_INFINITY, f64::max);
    [low, high]
}

/// The vectors found so far, and what the next one is searched with.
struct Search<'a> {
    k: &'a DMatrix<f64>,
    m: &'a DMatrix<f64>,
    standard: &'a Standard,
    found: Vec<DVector<f64>>,
    /// Bound of |λ|.
    size: f64,
    steps: usize,
}

impl Search<'_> {
    /// A unit vector in no special direction, orthogonal to those found.
    fn start(&self, seed: usize) -> Option<DVector<f64>> {
        let n = self.k.nrows();
        let y = DVector::from_fn(n, |i, _| 1.0 + (2.39 * (i + 1) as f64 * (seed + 1) as f64).sin());
        let mut x = self.standard.factor.l_dirty().tr_solve_lower_triangular(&y)?;
        self.deflate(&mut x);
        Some(x)
    }

    /// x := its part that is M-orthogonal to the vectors found, of unit length; twice, for the digits that the first loses.
    fn deflate(&self, x: &mut DVector<f64>) {
        for _ in 0..2 {
            for v in &self.found {
                let along = product(self.m, v, x);
                x.axpy(-along, v, 1.0);
            }
            let length = product(self.m, x, x).sqrt();
            x.scale_mut(length.recip());
        }
    }

    fn shifted(&self, sigma: f64) -> LU<f64, Dyn, Dyn> {
        (self.k - self.m * sigma).lu()
    }

    /// One eigenvalue with its vector, beginning at x with the shift σ.
    fn converge(&mut self, mut sigma: f64, mut x: DVector<f64>) -> Option<(f64, DVector<f64>)> {
        let mut factors = self.shifted(sigma);
        let mut best = f64::INFINITY;
        let mut idle = 0;
        for _ in 0..STEPS {
            self.steps += 1;
            match factors.solve(&(self.m * &x)) {
                Some(y) if y.iter().all(|y| y.is_finite()) => x = y,
                // the shift is an eigenvalue to the last bit
                _ => {
                    sigma -= 4.0 * f64::EPSILON * self.size;
                    factors = self.shifted(sigma);
                    continue;
                }
            }
            self.deflate(&mut x);
            let rho = product(self.k, &x, &x);
            let residual = self.standard.factor.l_dirty().solve_lower_triangular(&(self.k * &x - self.m * &x * rho))?;
            let e = residual.norm();
            idle = if e < 0.5 * best { 0 } else { idle + 1 };
            best = best.min(e);
            // what is left is round-off once steps no longer halve it
            if e <= f64::EPSILON * self.size || (idle >= 3 && e <= 1e-10 * self.size) {
                return Some((rho, x));
            }
            if e < 0.25 * (rho - sigma) {
                sigma = rho - 2.0 * e;
                factors = self.shifted(sigma);
            }
        }
        None
    }
}
