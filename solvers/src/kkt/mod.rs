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
//! The diagonal of a row that is round-off at assembly is that of its natural size, and of one that happens to vanish there that of
//! a position nearby ([`natural_row_scale`]).
//!
//! The matrix is scaled symmetrically by powers of two near D^−½ and diag(G D⁻¹ Gᵀ)^−½ before it is factored: pivots then do
//! not depend on the units, and nothing is rounded.

pub(crate) mod columns;
mod definite;
pub mod dense;
pub mod factor;
pub mod number;
pub mod ordering;
mod pivoting;
pub(crate) mod reach;
mod scale;
mod singular;
mod small;
pub mod sparse;

pub(crate) use scale::root_inverse;
pub use scale::{REGULARIZATION, ROUND_OFF, metric, natural_row_scale, row_scale};

use crate::sparsity::DENSE_UP_TO;
use crate::{Pattern, Sparsity};
use dense::{Lu, Singular, sized, square, square_mut};
use factor::Factor;

/// Solver of M a + Gᵀλ = f, G a = γ; sized at construction, then free of allocation.
///
/// Up to [`DENSE_UP_TO`] unknowns the matrix is factored as a quasi-definite one, and by elimination with pivots where M is
/// singular; above, by elimination, dense or sparse.
#[derive(Clone, Debug)]
pub struct Kkt {
    nv: usize,
    rows: usize,
    /// Powers of two near D^−½, then near diag(G D⁻¹ Gᵀ)^−½ (nv + m).
    scale: Vec<f64>,
    /// Scaled E (m).
    e: Vec<f64>,
    refinements: usize,
    /// Patterns of M and G, and places of the diagonal of M (nv).
    patterns: [Sparsity; 2],
    diagonal: Vec<usize>,
    /// Products of the scales of rows and columns, of small matrices (n × n).
    products: Vec<f64>,
    /// Scaled [M Gᵀ; G 0] (n × n); not kept by the sparse form.
    matrix: Vec<f64>,
    /// L D Lᵀ of the scaled [M Gᵀ; G −E]: L (n × n), 1/D (n).
    l: Vec<f64>,
    inverse: Vec<f64>,
    /// Whether L D Lᵀ holds; else it is `factors` that do.
    definite: bool,
    factors: Factors,
    /// Scaled right-hand side (nv + m).
    rhs: Vec<f64>,
    /// Scaled solution (nv + m).
    x: Vec<f64>,
    /// Residual and correction (nv + m).
    r: Vec<f64>,
}

/// An elimination with pivots.
#[derive(Clone, Debug)]
enum Factors {
    Dense(Lu),
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

/// Steps of iterative refinement; and where a coordinate has no mass: E is then large beside what its rows feel.
const REFINEMENTS: usize = 2;
const REFINEMENTS_WITHOUT_MASS: usize = 8;

/// Part of D below which a diagonal entry of M counts as none.
const LIGHT: f64 = 1e-2;

impl Kkt {
    /// One for full matrices of `nv` velocities and `rows` constraint rows, with scales of one.
    pub fn new(nv: usize, rows: usize) -> Self {
        Self::dense([&Sparsity::dense(nv, nv), &Sparsity::dense(rows, nv)])
    }

    /// One for the pattern of a system, with its scales; sparse where that pays.
    pub fn of_pattern(pattern: &Pattern) -> Self {
        let mut kkt = Self::of_blocks(&pattern.mass, &pattern.g);
        kkt.set_scale(&pattern.metric, &pattern.g_scale);
        kkt
    }

    /// One for the patterns of M and G, with scales of one; sparse where that pays.
    pub fn of_blocks(mass: &Sparsity, g: &Sparsity) -> Self {
        if g.columns() + g.rows() <= DENSE_UP_TO {
            return Self::dense([mass, g]);
        }
        Self::sparse([mass, g]).unwrap_or_else(|| Self::dense([mass, g]))
    }

    /// Cost of a factorisation for the patterns of M and G, in multiplications of a dense one.
    pub fn cost(mass: &Sparsity, g: &Sparsity) -> usize {
        Factor::<f64>::cost(&whole([mass, g]))
    }

    fn dense(patterns: [&Sparsity; 2]) -> Self {
        let n = patterns[1].columns() + patterns[1].rows();
        let small = if n <= DENSE_UP_TO { n } else { 0 };
        Self {
            products: vec![1.0; small * small],
            matrix: vec![0.0; n * n],
            l: vec![0.0; small * small],
            inverse: vec![0.0; small],
            factors: Factors::Dense(Lu::new(n)),
            ..Self::vectors(patterns)
        }
    }

    /// A sparse one; none where elimination fills the matrix.
    fn sparse(patterns: [&Sparsity; 2]) -> Option<Self> {
        let [mass, g] = patterns;
        let nv = g.columns();
        let whole = whole(patterns);
        let factor = Factor::new(&whole);
        if matches!(factor, Factor::Dense(_)) {
            return None;
        }
        let at = |block: &Sparsity, i: usize, j: usize| block.place(i, j).unwrap_or_default();
        let source = |i: usize, j: usize| match (i < nv, j < nv) {
            (true, true) => Source::Mass(at(mass, i, j)),
            (true, false) => Source::Row(at(g, j - nv, i)),
            (false, true) => Source::Row(at(g, i - nv, j)),
            (false, false) => Source::Regular(i - nv),
        };
        let entries: Vec<_> = whole.transposed().places().map(|(j, i)| (i, j, source(i, j))).collect();
        let values = vec![0.0; entries.len()];
        let sparse = Sparse { factor, plain: values.clone(), values, entries };
        Some(Self { factors: Factors::Sparse(Box::new(sparse)), ..Self::vectors(patterns) })
    }

    /// Vectors without matrices.
    fn vectors(patterns: [&Sparsity; 2]) -> Self {
        let (nv, rows) = (patterns[1].columns(), patterns[1].rows());
        let n = nv + rows;
        Self {
            nv,
            rows,
            diagonal: (0..nv).filter_map(|i| patterns[0].place(i, i)).collect(),
            patterns: patterns.map(Clone::clone),
            scale: vec![1.0; n],
            e: vec![REGULARIZATION; rows],
            refinements: REFINEMENTS,
            products: Vec::new(),
            matrix: Vec::new(),
            l: Vec::new(),
            inverse: Vec::new(),
            definite: false,
            factors: Factors::Dense(Lu::new(0)),
            rhs: vec![0.0; n],
            x: vec![0.0; n],
            r: vec![0.0; n],
        }
    }

    /// Number of velocities.
    pub fn velocities(&self) -> usize {
        self.nv
    }

    /// Takes the scales from the matrices at assembly; see [`metric`] and [`row_scale`]. Allocates.
    pub fn scale(&mut self, mass: &[f64], g: &[f64], unit: &[u8]) {
        let metric = metric(self.diagonal.iter().map(|k| mass[*k]), unit);
        let g_scale = row_scale(&self.patterns[1], g, &metric);
        self.set_scale(&metric, &g_scale);
    }

    /// Takes the scales D (nv) and diag(G D⁻¹ Gᵀ) (m) of a [`Pattern`].
    pub fn set_scale(&mut self, metric: &[f64], g_scale: &[f64]) {
        for (s, x) in self.scale.iter_mut().zip(metric.iter().chain(g_scale)) {
            *s = scale::root_inverse(*x);
        }
        for ((e, x), s) in self.e.iter_mut().zip(g_scale).zip(&self.scale[self.nv..]) {
            *e = REGULARIZATION * x * s * s;
        }
        let products = self.scale.iter().flat_map(|a| self.scale.iter().map(move |b| a * b));
        self.products.iter_mut().zip(products).for_each(|(out, product)| *out = product);
    }

    /// Factors the matrix of M (nv × nv) and G (m × nv), by their patterns.
    ///
    /// Fails where M is singular on the free motions (a massless freedom), and where a number is not finite.
    pub fn factor(&mut self, mass: &[f64], g: &[f64]) -> Result<(), Singular> {
        if self.nv + self.rows == 0 {
            // nothing is free and nothing constrains: minimal coordinates of what cannot move
            return Ok(());
        }
        let light = self.diagonal.iter().zip(&self.scale).any(|(k, s)| mass[*k] * s * s < LIGHT);
        self.refinements = if light { REFINEMENTS_WITHOUT_MASS } else { REFINEMENTS };
        if let Factors::Sparse(sparse) = &mut self.factors {
            return sparse.factor(mass, g, &self.scale, &self.e);
        }
        self.definite = self.quasi_definite(mass, g);
        if self.definite { Ok(()) } else { self.eliminate() }
    }

    /// Factors the dense matrix by elimination with pivots.
    fn eliminate(&mut self) -> Result<(), Singular> {
        self.definite = false;
        let Factors::Dense(lu) = &mut self.factors else { return Ok(()) };
        let (nv, n) = (self.nv, self.nv + self.rows);
        let work = lu.matrix_mut();
        work.copy_from_slice(&self.matrix);
        for (j, e) in self.e.iter().enumerate() {
            work[(nv + j) * (n + 1)] = -e;
        }
        lu.factor_in_place()
    }

    /// The scaled matrix without E.
    fn fill(&mut self, mass: &[f64], g: &[f64]) {
        let (nv, n) = (self.nv, self.nv + self.rows);
        if nv == 0 {
            return;
        }
        let (d, s) = self.scale.split_at(nv);
        if self.patterns.iter().any(|pattern| !pattern.is_full()) {
            // entries outside of the patterns stay 0
            let [of_mass, of_g] = &self.patterns;
            of_mass.places().zip(mass).for_each(|((i, j), m)| self.matrix[i * n + j] = m * d[i] * d[j]);
            for ((i, j), g) in of_g.places().zip(g) {
                let x = g * s[i] * d[j];
                self.matrix[(nv + i) * n + j] = x;
                self.matrix[j * n + nv + i] = x;
            }
            return;
        }
        let (upper, lower) = self.matrix.split_at_mut(nv * n);
        for ((out, row), di) in upper.chunks_exact_mut(n).zip(mass.chunks_exact(nv)).zip(d) {
            for ((x, m), dj) in out.iter_mut().zip(row).zip(d) {
                *x = m * di * dj;
            }
        }
        for (i, ((out, row), si)) in lower.chunks_exact_mut(n).zip(g.chunks_exact(nv)).zip(s).enumerate() {
            for (j, ((x, g), dj)) in out.iter_mut().zip(row).zip(d).enumerate() {
                *x = g * si * dj;
                upper[j * n + nv + i] = *x;
            }
        }
    }

    /// Scales the matrix, and factors it by L D Lᵀ; false if it is too large for that, or M is nearly singular.
    fn quasi_definite(&mut self, mass: &[f64], g: &[f64]) -> bool {
        let (nv, n) = (self.nv, self.nv + self.rows);
        let full = nv > 0 && self.patterns.iter().all(Sparsity::is_full);
        if !full || n > DENSE_UP_TO {
            self.fill(mass, g);
        }
        if n > DENSE_UP_TO || n == 0 {
            return false;
        }
        if !full {
            self.l.copy_from_slice(&self.matrix);
            for (j, e) in self.e.iter().enumerate() {
                self.l[(nv + j) * (n + 1)] = -e;
            }
        }
        macro_rules! small {
            ($k:literal) => {
                match (
                    square_mut::<f64, $k>(&mut self.matrix),
                    square_mut::<f64, $k>(&mut self.l),
                    square::<f64, $k>(&self.products),
                    self.inverse.first_chunk_mut(),
                ) {
                    (Some(matrix), Some(l), Some(products), Some(inverse)) => {
                        if full {
                            definite::fill::<$k>([matrix, l], products, [mass, g, &self.e], nv);
                        }
                        definite::factor::<$k>(l, inverse, nv)
                    }
                    _ => false,
                }
            };
        }
        sized!(n, small, false)
    }

    /// x := the solution with the right-hand side x, by the factors at hand, with `refinements` against the matrix without E.
    fn apply(&mut self, refinements: usize) {
        if self.definite {
            macro_rules! small {
                ($k:literal) => {
                    if let (Some(matrix), Some(l), Some(inverse), Some(x)) =
                        (square::<f64, $k>(&self.matrix), square::<f64, $k>(&self.l), self.inverse.first_chunk(), self.x.first_chunk_mut())
                    {
                        definite::refined::<$k>(matrix, l, inverse, x, refinements);
                    }
                };
            }
            sized!(self.nv + self.rows, small, ());
            return;
        }
        self.rhs.copy_from_slice(&self.x);
        match &mut self.factors {
            Factors::Dense(lu) => lu.solve(&mut self.x),
            Factors::Sparse(sparse) => sparse.factor.solve(&mut self.x),
        }
        // x += [M Gᵀ; G −E]⁻¹ (b − [M Gᵀ; G 0] x)
        for _ in 0..refinements {
            self.r.copy_from_slice(&self.rhs);
            match &mut self.factors {
                Factors::Dense(lu) => {
                    subtract_product(&self.matrix, &self.x, &mut self.r);
                    lu.solve(&mut self.r);
                }
                Factors::Sparse(sparse) => {
                    sparse.subtract_product(&self.x, &mut self.r);
                    sparse.factor.solve(&mut self.r);
                }
            }
            self.x.iter_mut().zip(&self.r).for_each(|(x, r)| *x += r);
        }
    }

    /// Accelerations `a` (nv) and multipliers `lambda` (m) of the forces `f` (nv) and the right-hand side `gamma` (m).
    ///
    /// With M as metric, f = 0 and γ = −Φ the same gives the shortest correction onto the constraints.
    pub fn solve(&mut self, f: &[f64], gamma: &[f64], a: &mut [f64], lambda: &mut [f64]) {
        let nv = self.nv;
        for ((b, x), s) in self.x.iter_mut().zip(f.iter().chain(gamma)).zip(&self.scale) {
            *b = x * s;
        }
        // without rows there is no E to take away
        self.apply(if self.rows == 0 { 0 } else { self.refinements });
        let (d, s) = self.scale.split_at(nv);
        for ((out, x), d) in a.iter_mut().zip(&self.x).zip(d) {
            *out = x * d;
        }
        for ((out, x), s) in lambda.iter_mut().zip(&self.x[nv..]).zip(s) {
            *out = x * s;
        }
    }

    /// Estimates of the smallest singular values σ of diag(G D⁻¹ Gᵀ)^−½ G D^−½, the smallest first, by one inverse iteration on the
    /// factorisation; 1 for independent rows, 0 in a singular position and for each redundant row.
    ///
    /// `vectors` (as many as `sigma` × m) keeps the vectors from call to call (zeros at first): the combinations of scaled rows that are
    /// nearest to dependence, orthonormal. M stands in the place of D, and E hides what is below 1e-4; a factor of about 2 is what to
    /// expect.
    pub fn smallest_singular_values(&mut self, vectors: &mut [f64], sigma: &mut [f64]) {
        let (nv, m) = (self.nv, self.rows);
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        for (k, sigma) in sigma.iter_mut().enumerate() {
            let (before, rest) = vectors.split_at_mut(k * m);
            let row = &mut rest[..m];
            let mut length = norm(row);
            if !(length > 0.0 && length < f64::INFINITY) {
                dense::start(row, k);
                length = norm(row);
            }
            // λ' = −(G M⁻¹ Gᵀ + E)⁻¹ λ, so |λ| / |λ'| tends to σ² + E
            self.x[..nv].fill(0.0);
            self.x[nv..].iter_mut().zip(&*row).for_each(|(x, y)| *x = y / length);
            self.apply(0);
            let grown = &mut self.x[nv..];
            // twice is enough
            for other in before.chunks_exact(m).chain(before.chunks_exact(m)) {
                let along = dense::dot(other, grown);
                grown.iter_mut().zip(other).for_each(|(x, y)| *x -= along * y);
            }
            let size = norm(grown);
            row.iter_mut().zip(grown).for_each(|(y, x)| *y = *x / size);
            *sigma = (size.recip() - REGULARIZATION).max(0.0).sqrt();
        }
    }

    /// An estimate of the smallest singular value that is not of redundant rows, by one inverse iteration on the factorisation, in which
    /// their combinations are taken away: with S = G M⁻¹ Gᵀ, x − (S + E)⁻¹ E x is 0 for S x = 0, and nearly x where S is large beside E.
    ///
    /// `vector` (m) keeps the combination of scaled rows from call to call, zeros at first.
    pub fn smallest_singular_value_that_moves(&mut self, vector: &mut [f64]) -> f64 {
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        if !(norm(vector) > 0.0 && norm(vector) < f64::INFINITY) {
            dense::start(vector, 0);
        }
        self.without_redundant(vector);
        let length = norm(vector);
        self.x[..self.nv].fill(0.0);
        self.x[self.nv..].iter_mut().zip(&*vector).for_each(|(x, y)| *x = y / length);
        self.apply(0);
        vector.copy_from_slice(&self.x[self.nv..]);
        self.without_redundant(vector);
        let size = norm(vector);
        vector.iter_mut().for_each(|x| *x /= size);
        (size.recip() - REGULARIZATION).max(0.0).sqrt()
    }

    /// x − (S + E)⁻¹ E x.
    fn without_redundant(&mut self, vector: &mut [f64]) {
        self.x[..self.nv].fill(0.0);
        self.x[self.nv..].iter_mut().zip(&self.e).zip(&*vector).for_each(|((x, e), y)| *x = e * y);
        self.apply(0);
        vector.iter_mut().zip(&self.x[self.nv..]).for_each(|(y, x)| *y += x);
    }
}

/// The pattern of [M Gᵀ; G −E].
fn whole([mass, g]: [&Sparsity; 2]) -> Sparsity {
    let (nv, n) = (g.columns(), g.columns() + g.rows());
    if g.rows() == 0 {
        return mass.clone();
    }
    let rows = g.places().flat_map(|(i, j)| [(nv + i, j), (j, nv + i)]);
    Sparsity::new(n, n, mass.places().chain(rows).chain((nv..n).map(|i| (i, i))))
}

impl Sparse {
    fn factor(&mut self, mass: &[f64], g: &[f64], scale: &[f64], e: &[f64]) -> Result<(), Singular> {
        for ((value, plain), &(i, j, source)) in self.values.iter_mut().zip(&mut self.plain).zip(&self.entries) {
            (*plain, *value) = match source {
                Source::Mass(at) => [mass[at] * scale[i] * scale[j]; 2].into(),
                Source::Row(at) => [g[at] * scale[i] * scale[j]; 2].into(),
                Source::Regular(row) => (0.0, -e[row]),
            };
        }
        self.factor.factor(&self.values)
    }

    /// r −= matrix · x, without E.
    fn subtract_product(&self, x: &[f64], r: &mut [f64]) {
        for (&(i, j, _), value) in self.entries.iter().zip(&self.plain) {
            r[i] -= value * x[j];
        }
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
