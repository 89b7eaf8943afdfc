//! The linear system of accelerations and multipliers.
//!
//! ```text
//! [ M   Gᵀ ] [ a ]   [ f ]
//! [ G  −E  ] [ λ ] = [ γ ],   E = 1e-8 · diag(G D⁻¹ Gᵀ), taken at assembly
//! ```
//!
//! E makes the matrix regular when rows of G are redundant or a position is singular, so that no row is ever dropped. Two steps
//! of iterative refinement against the matrix without E take its error away: each multiplies it by about 1e-8/σ², σ the
//! smallest non-zero singular value of diag(G D⁻¹ Gᵀ)^−½ G D^−½. Where rows are redundant, the multipliers are those of least
//! λᵀEλ. An E that follows the present rows vanishes with them, and a smaller one loses energy in singular positions (measured).
//!
//! The matrix is scaled symmetrically by powers of two near D^−½ and diag(G D⁻¹ Gᵀ)^−½ before it is factored: pivots then do
//! not depend on the units, and nothing is rounded.

pub mod dense;
pub mod factor;
pub mod number;
pub mod ordering;
mod pivoting;
mod scale;
mod small;
pub mod sparse;

pub(crate) use scale::root_inverse;
pub use scale::{REGULARIZATION, metric, row_scale};

use dense::{Lu, Singular};

/// Solver of M a + Gᵀλ = f, G a = γ; sized at construction, then free of allocation.
///
/// It has two forms. The general one serves every system. The *determinate* one serves as many rows as velocities (a driven
/// mechanism without freedom) in positions that are not singular: a = G⁻¹γ, λ = G⁻ᵀ(f − M a) from one factorisation of G alone.
#[derive(Clone, Debug)]
pub struct Kkt {
    nv: usize,
    rows: usize,
    determinate: bool,
    /// Powers of two near D^−½, then near diag(G D⁻¹ Gᵀ)^−½ (nv + m).
    scale: Vec<f64>,
    /// Scaled E (m).
    e: Vec<f64>,
    /// General: scaled [M Gᵀ; G 0] (n × n). Determinate: M (nv × nv).
    matrix: Vec<f64>,
    /// General: of the scaled [M Gᵀ; G −E]. Determinate: of the scaled G.
    lu: Lu,
    /// Scaled right-hand side (nv + m).
    rhs: Vec<f64>,
    /// Scaled solution (nv + m).
    x: Vec<f64>,
    /// Residual and correction (nv + m).
    r: Vec<f64>,
}

/// Steps of iterative refinement in the general form.
const REFINEMENTS: usize = 2;

impl Kkt {
    /// The general form for `nv` velocities and `rows` constraint rows, with scales of one.
    pub fn new(nv: usize, rows: usize) -> Self {
        Self::with_form(nv, rows, false)
    }

    /// The determinate form for n velocities and n rows.
    pub fn determinate(n: usize) -> Self {
        Self::with_form(n, n, true)
    }

    fn with_form(nv: usize, rows: usize, determinate: bool) -> Self {
        let n = nv + rows;
        let order = if determinate { nv } else { n };
        Self {
            nv,
            rows,
            determinate,
            scale: vec![1.0; n],
            e: vec![REGULARIZATION; rows],
            matrix: vec![0.0; order * order],
            lu: Lu::new(order),
            rhs: vec![0.0; n],
            x: vec![0.0; n],
            r: vec![0.0; n],
        }
    }

    /// Takes the scales from the matrices at assembly; see [`metric`] and [`row_scale`]. Allocates.
    pub fn scale(&mut self, mass: &[f64], g: &[f64], unit: &[u8]) {
        let metric = metric(mass, unit);
        let g_scale = row_scale(g, &metric);
        self.set_scale(&metric, &g_scale);
    }

    /// Takes the scales D (nv) and diag(G D⁻¹ Gᵀ) (m) of a [`Pattern`](crate::Pattern).
    pub fn set_scale(&mut self, metric: &[f64], g_scale: &[f64]) {
        for (s, x) in self.scale.iter_mut().zip(metric.iter().chain(g_scale)) {
            *s = scale::root_inverse(*x);
        }
        for ((e, x), s) in self.e.iter_mut().zip(g_scale).zip(&self.scale[self.nv..]) {
            *e = REGULARIZATION * x * s * s;
        }
    }

    /// Whether this is the determinate form.
    pub fn is_determinate(&self) -> bool {
        self.determinate
    }

    /// Factors the matrix of M (nv × nv) and G (m × nv).
    ///
    /// Fails where M is singular on the free motions (a massless freedom), where a number is not finite and, in the
    /// determinate form, where G is singular.
    pub fn factor(&mut self, mass: &[f64], g: &[f64]) -> Result<(), Singular> {
        let nv = self.nv;
        if nv == 0 {
            return if self.determinate { Ok(()) } else { self.factor_general(mass, g) };
        }
        if !self.determinate {
            return self.factor_general(mass, g);
        }
        let (d, s) = self.scale.split_at(nv);
        self.matrix.copy_from_slice(mass);
        let rows = self.lu.matrix_mut().chunks_exact_mut(nv).zip(g.chunks_exact(nv)).zip(s);
        for ((out, row), s) in rows {
            for ((out, g), d) in out.iter_mut().zip(row).zip(d) {
                *out = g * s * d;
            }
        }
        self.lu.factor_in_place()
    }

    fn factor_general(&mut self, mass: &[f64], g: &[f64]) -> Result<(), Singular> {
        let (nv, n) = (self.nv, self.nv + self.rows);
        let (d, s) = self.scale.split_at(nv);
        // upper rows [M Gᵀ], lower rows [G 0]
        for (i, row) in self.matrix.chunks_exact_mut(n.max(1)).enumerate() {
            let (left, right) = row.split_at_mut(nv);
            if i < nv {
                for (j, x) in left.iter_mut().enumerate() {
                    *x = mass[i * nv + j] * d[i] * d[j];
                }
                for (j, x) in right.iter_mut().enumerate() {
                    *x = g[j * nv + i] * s[j] * d[i];
                }
            } else {
                for (j, x) in left.iter_mut().enumerate() {
                    *x = g[(i - nv) * nv + j] * s[i - nv] * d[j];
                }
            }
        }
        let work = self.lu.matrix_mut();
        work.copy_from_slice(&self.matrix);
        for (j, e) in self.e.iter().enumerate() {
            work[(nv + j) * (n + 1)] = -e;
        }
        self.lu.factor_in_place()
    }

    /// Accelerations `a` (nv) and multipliers `lambda` (m) of the forces `f` (nv) and the right-hand side `gamma` (m).
    ///
    /// With M as metric, f = 0 and γ = −Φ the same gives the shortest correction onto the constraints.
    pub fn solve(&mut self, f: &[f64], gamma: &[f64], a: &mut [f64], lambda: &mut [f64]) {
        if self.determinate {
            return self.solve_determinate(f, gamma, a, lambda);
        }
        let nv = self.nv;
        for ((b, x), s) in self.rhs.iter_mut().zip(f.iter().chain(gamma)).zip(&self.scale) {
            *b = x * s;
        }
        self.x.copy_from_slice(&self.rhs);
        self.lu.solve(&mut self.x);
        // x += [M Gᵀ; G −E]⁻¹ (b − [M Gᵀ; G 0] x); without rows there is no E to take away
        let refinements = if self.rows == 0 { 0 } else { REFINEMENTS };
        for _ in 0..refinements {
            self.r.copy_from_slice(&self.rhs);
            subtract_product(&self.matrix, &self.x, &mut self.r);
            self.lu.solve(&mut self.r);
            self.x.iter_mut().zip(&self.r).for_each(|(x, r)| *x += r);
        }
        for (out, (x, s)) in a.iter_mut().chain(lambda).zip(self.x[..nv].iter().chain(&self.x[nv..]).zip(&self.scale)) {
            *out = x * s;
        }
    }

    fn solve_determinate(&mut self, f: &[f64], gamma: &[f64], a: &mut [f64], lambda: &mut [f64]) {
        let nv = self.nv;
        let (d, s) = self.scale.split_at(nv);
        let (a, lambda) = (&mut a[..nv], &mut lambda[..nv]);
        // a = G⁻¹ γ
        for ((a, gamma), s) in a.iter_mut().zip(gamma).zip(s) {
            *a = gamma * s;
        }
        self.lu.solve(a);
        a.iter_mut().zip(d).for_each(|(a, d)| *a *= d);
        // λ = G⁻ᵀ (f − M a)
        let rows = self.matrix.chunks_exact(nv.max(1));
        for (((lambda, f), row), d) in lambda.iter_mut().zip(f).zip(rows).zip(d) {
            *lambda = d * (f - dense::dot(row, a));
        }
        self.lu.solve_transposed(lambda);
        lambda.iter_mut().zip(s).for_each(|(lambda, s)| *lambda *= s);
    }

    /// Estimate of σ, the smallest singular value of diag(G D⁻¹ Gᵀ)^−½ G D^−½, by one inverse iteration on the factorisation;
    /// 1 for independent rows, 0 in a singular position, infinite without rows.
    ///
    /// `row` (m) keeps the vector from call to call (zeros at first): the combination of scaled rows that is nearest to
    /// dependence. In the general form M stands in the place of D and E hides what is below 1e-4; a factor of about 2 is
    /// what to expect.
    pub fn smallest_singular_value(&mut self, row: &mut [f64]) -> f64 {
        let nv = self.nv;
        if self.rows == 0 {
            return f64::INFINITY;
        }
        if self.determinate {
            return self.lu.smallest_singular_value(1, row, &mut self.x[..nv]);
        }
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut length = norm(row);
        if !(length > 0.0 && length < f64::INFINITY) {
            dense::start(row);
            length = norm(row);
        }
        // λ' = −(G M⁻¹ Gᵀ + E)⁻¹ λ, so |λ| / |λ'| tends to σ² + E
        self.x[..nv].fill(0.0);
        self.x[nv..].iter_mut().zip(&*row).for_each(|(x, y)| *x = y / length);
        self.lu.solve(&mut self.x);
        let grown = norm(&self.x[nv..]);
        row.iter_mut().zip(&self.x[nv..]).for_each(|(y, x)| *y = x / grown);
        (grown.recip() - REGULARIZATION).max(0.0).sqrt()
    }

    /// The factorisation: its pivots tell the condition.
    pub fn lu(&self) -> &Lu {
        &self.lu
    }
}

/// r −= matrix · x, row-major and square.
fn subtract_product(matrix: &[f64], x: &[f64], r: &mut [f64]) {
    for (r, row) in r.iter_mut().zip(matrix.chunks_exact(x.len().max(1))) {
        *r -= dense::dot(row, x);
    }
}

#[cfg(test)]
mod factor_tests;
#[cfg(test)]
mod tests;
