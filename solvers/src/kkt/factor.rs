//! One interface to the dense and the sparse factorisation.

use super::dense::{self, Lu, Singular};
use super::number::Number;
use super::ordering::Ordering;
use super::sparse::SparseLu;
use crate::Sparsity;
use crate::sparsity::DENSE_UP_TO;

/// A factorisation A = L U of matrices of one square pattern.
///
/// Nothing allocates after construction, but for the sparse form when it chooses pivots: in the first factorisation and rarely later.
///
/// Measured on a chain of planar bodies in absolute coordinates (three a body, two rows a joint, real numbers), µs for a
/// factorisation and for a solution on one busy 2.8 GHz core: order 12: sparse 0.4 and 0.1, dense 0.4 and 0.1; 22: 0.7 and 0.2,
/// 2.0 and 0.6; 52: 1.8 and 0.6, 25 and 2.1; 202: 5.6 and 2.3, 860 and 15; 1002: 25 and 10, 132000 and 420.
#[derive(Clone, Debug)]
pub enum Factor<T: Number> {
    /// For small and for nearly full matrices.
    Dense(Dense<T>),
    /// For the others.
    Sparse(Box<SparseLu<T>>),
}

/// The dense form.
#[derive(Clone, Debug)]
pub struct Dense<T: Number> {
    lu: Lu<T>,
    /// Place of each entry of the pattern in the row-major matrix.
    place: Vec<usize>,
}

impl<T: Number> Factor<T> {
    /// The form that is faster: dense up to [`DENSE_UP_TO`] unknowns and where elimination fills the matrix, else sparse.
    pub fn new(pattern: &Sparsity) -> Self {
        let n = pattern.columns();
        if n <= DENSE_UP_TO || pattern.is_full() {
            return Self::dense(pattern);
        }
        let dense = dense::cost(n);
        match Ordering::minimum_degree(pattern) {
            ordering if ordering.cost(pattern) < dense => Self::Sparse(Box::new(SparseLu::with_order(pattern, ordering))),
            _ => Self::dense(pattern),
        }
    }

    /// Cost of a factorisation in the form that [`Factor::new`] takes, in multiplications of the dense one.
    pub fn cost(pattern: &Sparsity) -> usize {
        let dense = dense::cost(pattern.columns());
        if pattern.is_full() { dense } else { dense.min(Ordering::minimum_degree(pattern).cost(pattern)) }
    }

    /// The dense form.
    pub fn dense(pattern: &Sparsity) -> Self {
        let n = pattern.columns();
        let place = pattern.transposed().places().map(|(j, i)| i * n + j).collect();
        Self::Dense(Dense { lu: Lu::new(n), place })
    }

    /// The sparse form.
    pub fn sparse(pattern: &Sparsity) -> Self {
        Self::Sparse(Box::new(SparseLu::new(pattern)))
    }

    /// Factors the matrix with the given values of the entries of the pattern, column after column; zeros are allowed.
    ///
    /// Fails where the matrix is singular or a number is not finite.
    pub fn factor(&mut self, values: &[T]) -> Result<(), Singular> {
        match self {
            Self::Dense(Dense { lu, place }) => {
                let matrix = lu.matrix_mut();
                matrix.fill(T::ZERO);
                for (&place, value) in place.iter().zip(values) {
                    matrix[place] = *value;
                }
                lu.factor_in_place()
            }
            Self::Sparse(lu) => lu.factor(values),
        }
    }

    /// b := A⁻¹ b (n), after a factorisation.
    pub fn solve(&mut self, b: &mut [T]) {
        match self {
            Self::Dense(Dense { lu, .. }) => lu.solve(b),
            Self::Sparse(lu) => lu.solve(b),
        }
    }

    /// Order of the matrix.
    pub fn order(&self) -> usize {
        match self {
            Self::Dense(Dense { lu, .. }) => lu.order(),
            Self::Sparse(lu) => lu.order(),
        }
    }

    /// Entries of L and U, the unit diagonal of L not counted; 0 for the sparse form before its first factorisation.
    pub fn fill(&self) -> usize {
        match self {
            Self::Dense(Dense { lu, .. }) => lu.order() * lu.order(),
            Self::Sparse(lu) => lu.fill(),
        }
    }
}
