//! Eigenvalues λ and vectors x of K x = λ M x for symmetric K and positive definite M.

use nalgebra::linalg::Cholesky;
use nalgebra::{DMatrix, DVector, Dyn};

/// Eigenvalues with their vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigen {
    /// Eigenvalues, rising.
    pub values: Vec<f64>,
    /// Their vectors, columns with xᵀMx = 1 whose largest component is positive.
    pub vectors: DMatrix<f64>,
    /// What was spent: sweeps of rotations, or steps of iteration; 0 if the method does not count.
    pub iterations: usize,
}

impl Eigen {
    /// The lowest of them.
    pub(super) fn lowest(mut self, count: usize) -> Self {
        self.values.truncate(count);
        let vectors = self.vectors.columns(0, self.values.len()).into_owned();
        Self { vectors, ..self }
    }
}

/// The standard form of a pair: S y = λ y with S = L⁻¹ K L⁻ᵀ, M = L Lᵀ, y = Lᵀ x (Golub & Van Loan, Matrix Computations, 4th
/// edition, section 8.7.2).
#[derive(Clone, Debug)]
pub(super) struct Standard {
    pub(super) s: DMatrix<f64>,
    pub(super) factor: Cholesky<f64, Dyn>,
}

impl Standard {
    /// None if M is not positive definite.
    pub(super) fn new(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Option<Self> {
        let factor = m.clone().cholesky()?;
        let l = factor.l_dirty();
        let half = l.solve_lower_triangular(k)?;
        let s = l.solve_lower_triangular(&half.transpose())?;
        Some(Self { s: (&s + s.transpose()) * 0.5, factor })
    }

    /// Eigenvalues and vectors of the pair from those of S.
    pub(super) fn eigen(&self, values: &[f64], vectors: &DMatrix<f64>, iterations: usize) -> Option<Eigen> {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        let mut x = self.factor.l_dirty().tr_solve_lower_triangular(&vectors.select_columns(&order))?;
        for mut column in x.column_iter_mut() {
            if column.iamax_sign() < 0.0 {
                column.neg_mut();
            }
        }
        Some(Eigen { values: order.iter().map(|&i| values[i]).collect(), vectors: x, iterations })
    }
}

/// The component of largest size.
pub(super) trait Largest {
    fn iamax_sign(&self) -> f64;
}

impl<S: nalgebra::Storage<f64, Dyn, nalgebra::U1>> Largest for nalgebra::Matrix<f64, Dyn, nalgebra::U1, S> {
    fn iamax_sign(&self) -> f64 {
        self.iter().fold(0.0, |m: f64, x| if x.abs() > m.abs() * (1.0 + 1e-9) { *x } else { m })
    }
}

/// By the symmetric QR algorithm of the linear algebra library; none if M is not positive definite.
#[must_use]
pub fn library(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Option<Eigen> {
    let standard = Standard::new(k, m)?;
    if k.is_empty() {
        return standard.eigen(&[], k, 0);
    }
    let found = standard.s.clone().symmetric_eigen();
    standard.eigen(found.eigenvalues.as_slice(), &found.eigenvectors, 0)
}

/// yᵀ M x.
pub(super) fn product(m: &DMatrix<f64>, y: &DVector<f64>, x: &DVector<f64>) -> f64 {
    y.dot(&(m * x))
}
