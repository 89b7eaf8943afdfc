//! G of as many rows as velocities, factored: by full matrices, or for many loops by sparse ones.

use grashof_solvers::{Block, Lu, Singular, SparseLu, Sparsity};

/// Factors of a square G with scaled rows.
#[derive(Clone, Debug)]
pub(super) struct Square {
    form: Form,
    /// What each row is multiplied by (rows).
    scale: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Form {
    Full(Lu),
    /// With the row of each entry of G, column after column, and its place in the values; and these times the scales.
    Sparse {
        lu: Box<SparseLu<f64>>,
        places: Vec<(u32, u32)>,
        values: Vec<f64>,
    },
}

impl Square {
    /// For the pattern of G (rows × rows) and the scales of its rows.
    pub(super) fn new(pattern: &Sparsity, scale: Vec<f64>) -> Self {
        let sparse = |lu: SparseLu<f64>| {
            let columns = pattern.transposed();
            let place = |(k, row): (usize, usize)| Some((row as u32, pattern.place(row, k)? as u32));
            let places: Vec<(u32, u32)> = columns.places().filter_map(place).collect();
            Form::Sparse { lu: Box::new(lu), values: vec![0.0; places.len()], places }
        };
        let form = SparseLu::of_rows(pattern).map_or_else(|| Form::Full(Lu::new(scale.len())), sparse);
        Self { form, scale }
    }

    /// Factors G.
    pub(super) fn factor(&mut self, g: &Block) -> Result<(), Singular> {
        match &mut self.form {
            Form::Full(lu) => {
                let matrix = lu.matrix_mut();
                matrix.fill(0.0);
                for ((out, row), s) in matrix.chunks_exact_mut(self.scale.len().max(1)).zip(g.lines()).zip(&self.scale) {
                    row.entries().for_each(|(k, g)| out[k] = g * s);
                }
                lu.factor_in_place()
            }
            Form::Sparse { lu, places, values } => {
                for (x, &(row, place)) in values.iter_mut().zip(&*places) {
                    *x = g.values()[place as usize] * self.scale[row as usize];
                }
                lu.factor(values)
            }
        }
    }

    /// x := G⁻¹ `rhs`.
    pub(super) fn solve(&mut self, rhs: &[f64], x: &mut [f64]) {
        for ((x, r), s) in x.iter_mut().zip(rhs).zip(&self.scale) {
            *x = r * s;
        }
        match &mut self.form {
            Form::Full(lu) => lu.solve(x),
            Form::Sparse { lu, .. } => lu.solve(x),
        }
    }

    /// x := G⁻ᵀ x.
    pub(super) fn solve_transposed(&mut self, x: &mut [f64]) {
        match &mut self.form {
            Form::Full(lu) => lu.solve_transposed(x),
            Form::Sparse { lu, .. } => lu.solve_transposed(x),
        }
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
    }

    /// Smallest over largest magnitude of a pivot.
    pub(super) fn pivot_ratio(&self) -> f64 {
        match &self.form {
            Form::Full(lu) => lu.pivot_ratio(),
            Form::Sparse { lu, .. } => lu.pivot_ratio(),
        }
    }

    /// The sign of det G.
    pub(super) fn determinant_sign(&self) -> f64 {
        match &self.form {
            Form::Full(lu) => lu.determinant_sign(),
            Form::Sparse { lu, .. } => lu.determinant_sign(),
        }
    }

    /// ln |det G| of the scaled rows.
    pub(super) fn log_determinant(&self) -> f64 {
        match &self.form {
            Form::Full(lu) => lu.log_determinant(),
            Form::Sparse { lu, .. } => lu.log_determinant(),
        }
    }
}
