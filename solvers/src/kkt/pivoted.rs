//! The KKT matrix by elimination with pivots, dense or sparse, with refinement against the matrix without E.

use super::Blocks;
use super::dense::{self, Lu, Singular};
use super::factor::Factor;

/// A matrix with its factors; sized once.
#[derive(Clone, Debug)]
pub(super) struct Pivoted {
    form: Form,
    /// Right-hand side; residual or correction (n).
    rhs: Vec<f64>,
    r: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Form {
    /// Factors, and the scaled [M Gᵀ; G 0] (n × n).
    Dense(Lu, Vec<f64>),
    Sparse(Box<Sparse>),
}

/// A sparse matrix with its factors.
#[derive(Clone, Debug)]
struct Sparse {
    factor: Factor<f64>,
    /// Row, column and source of each entry, column after column.
    entries: Vec<(usize, usize, Source)>,
    /// Scaled entries with −E, and without.
    values: Vec<f64>,
    plain: Vec<f64>,
}

/// Where an entry comes from: place in M, place in G, number of a row's E.
#[derive(Clone, Copy, Debug)]
enum Source {
    Mass(usize),
    Row(usize),
    Regular(usize),
}

impl Pivoted {
    /// Room for matrices of the patterns of M and G; sparse where that is less work.
    pub(super) fn new(blocks: &Blocks) -> Self {
        let n = blocks.order();
        let form = match Sparse::new(blocks) {
            Some(sparse) => Form::Sparse(Box::new(sparse)),
            None => Form::Dense(Lu::new(n), vec![0.0; n * n]),
        };
        Self { form, rhs: vec![0.0; n], r: vec![0.0; n] }
    }

    /// Factors M and G, by their patterns, with the scales of all unknowns (n) and the scaled E (m).
    pub(super) fn factor(&mut self, blocks: &Blocks, values: [&[f64]; 2], scale: &[f64], e: &[f64]) -> Result<(), Singular> {
        match &mut self.form {
            Form::Sparse(sparse) => sparse.factor(values, scale, e),
            Form::Dense(lu, matrix) => {
                blocks.fill(values, scale, matrix);
                let work = lu.matrix_mut();
                work.copy_from_slice(matrix);
                let (nv, n) = (blocks.velocities(), blocks.order());
                for (j, e) in e.iter().enumerate() {
                    work[(nv + j) * (n + 1)] = -e;
                }
                lu.factor_in_place()
            }
        }
    }

    /// x := A⁻¹ x (n), then as often x += A⁻¹ (b − [M Gᵀ; G 0] x) as there are `refinements`.
    pub(super) fn solve(&mut self, x: &mut [f64], refinements: usize) {
        self.rhs.copy_from_slice(x);
        match &mut self.form {
            Form::Dense(lu, _) => lu.solve(x),
            Form::Sparse(sparse) => sparse.factor.solve(x),
        }
        for _ in 0..refinements {
            self.r.copy_from_slice(&self.rhs);
            match &mut self.form {
                Form::Dense(lu, matrix) => {
                    for (r, row) in self.r.iter_mut().zip(matrix.chunks_exact(x.len().max(1))) {
                        *r -= dense::dot(row, x);
                    }
                    lu.solve(&mut self.r);
                }
                Form::Sparse(sparse) => {
                    sparse.subtract_product(x, &mut self.r);
                    sparse.factor.solve(&mut self.r);
                }
            }
            x.iter_mut().zip(&self.r).for_each(|(x, r)| *x += r);
        }
    }
}

impl Sparse {
    /// None where elimination fills the matrix.
    fn new(blocks: &Blocks) -> Option<Self> {
        let nv = blocks.velocities();
        let whole = blocks.whole();
        let factor = Factor::new(&whole);
        if matches!(factor, Factor::Dense(_)) {
            return None;
        }
        let [mass, g] = &blocks.0;
        let source = |i: usize, j: usize| match (i < nv, j < nv) {
            (true, true) => Source::Mass(mass.place(i, j).unwrap_or_default()),
            (true, false) => Source::Row(g.place(j - nv, i).unwrap_or_default()),
            (false, true) => Source::Row(g.place(i - nv, j).unwrap_or_default()),
            (false, false) => Source::Regular(i - nv),
        };
        let entries: Vec<_> = whole.transposed().places().map(|(j, i)| (i, j, source(i, j))).collect();
        let values = vec![0.0; entries.len()];
        Some(Self { factor, plain: values.clone(), values, entries })
    }

    fn factor(&mut self, [mass, g]: [&[f64]; 2], scale: &[f64], e: &[f64]) -> Result<(), Singular> {
        for ((value, plain), &(i, j, source)) in self.values.iter_mut().zip(&mut self.plain).zip(&self.entries) {
            (*plain, *value) = match source {
                Source::Mass(at) => [mass[at] * scale[i] * scale[j]; 2].into(),
                Source::Row(at) => [g[at] * scale[i] * scale[j]; 2].into(),
                Source::Regular(row) => (0.0, -e[row]),
            };
        }
        self.factor.factor(&self.values)
    }

    /// r −= [M Gᵀ; G 0] x.
    fn subtract_product(&self, x: &[f64], r: &mut [f64]) {
        for (&(i, j, _), value) in self.entries.iter().zip(&self.plain) {
            r[i] -= value * x[j];
        }
    }
}
