//! The lowest modes of few bodies by Lanczos' method, beside the methods that find all of them.

use super::eigen::{Eigen, Largest};
use crate::kinematics::lowest::{Lowest, lowest};
use crate::kinematics::pencil::Pencil;
use grashof_solvers::{Block, Sparsity};
use nalgebra::DMatrix;

/// The `count` lowest eigenvalues of a full pair (n × n); none as [`lowest`] says.
#[must_use]
pub fn full(k: &DMatrix<f64>, m: &DMatrix<f64>, count: usize, stop: &dyn Fn() -> bool) -> Option<Eigen> {
    let block = |x: &DMatrix<f64>| {
        let mut block = Block::full(x.nrows(), x.ncols());
        block.values_mut().iter_mut().zip(x.transpose().iter()).for_each(|(out, x)| *out = *x);
        block
    };
    let n = k.nrows();
    let (metric, rows) = (m.diagonal().as_slice().to_vec(), Block::full(0, n));
    let (damping, grain) = (Block::new(&Sparsity::new(n, n, [])), vec![0.0; n]);
    let pencil = Pencil { mass: block(m), stiffness: block(k), damping, rows, metric, row_scale: Vec::new(), grain, freedom: n };
    let Lowest { values, vectors, steps } = lowest(&pencil, count, stop)?;
    let mut vectors = DMatrix::from_iterator(n, vectors.len(), vectors.into_iter().flatten());
    for mut column in vectors.column_iter_mut() {
        if column.iamax_sign() < 0.0 {
            column.neg_mut();
        }
    }
    Some(Eigen { values, vectors, iterations: steps })
}
