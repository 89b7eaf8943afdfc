//! The linear system of accelerations and multipliers.
//!
//! ```text
//! [ M   Gᵀ ] [ a ]   [ f ]
//! [ G  −E  ] [ λ ] = [ γ ],   E = 1e-8 · diag(G D⁻¹ Gᵀ), taken at assembly
//! ```
//!
//! E makes the matrix regular when rows of G are redundant or a position is singular, so that no row is ever dropped. Up to two
//! steps of iterative refinement against the matrix without E take its error away: each multiplies it by about 1e-8/σ², σ the
//! smallest non-zero singular value of diag(G D⁻¹ Gᵀ)^−½ G D^−½. Where that is small at the start already, conjugate gradients do
//! (`conjugate.rs`). Where rows are redundant, the multipliers are those of least λᵀEλ. An E that follows the present rows vanishes with
//! them, and a smaller one loses energy in singular positions (measured).
//!
//! Where an inertia has grown to over a hundred times that at assembly, rows feel little of it, and E would be large beside that. There
//! each E is multiplied by Σ g²/max(D, M/100) / Σ g²/D, sums over the present row: the growth alone, which does not vanish with the row.
//!
//! The diagonal of a row that is round-off at assembly is that of its natural size, and of one that happens to vanish there that of
//! a position nearby ([`natural_row_scale`]).
//!
//! The matrix is scaled symmetrically by powers of two near D^−½ and diag(G D⁻¹ Gᵀ)^−½ before it is factored: pivots then do
//! not depend on the units, and nothing is rounded.

mod blocks;
pub(crate) mod columns;
mod conjugate;
mod definite;
pub mod dense;
pub mod factor;
pub mod number;
pub mod ordering;
mod pivoted;
mod pivoting;
mod quasi;
pub(crate) mod reach;
mod scale;
mod singular;
mod small;
pub mod sparse;

pub(crate) use scale::root_inverse;
pub use scale::{Kind, REGULARIZATION, ROUND_OFF, metric, natural_row_scale, row_scale};

use crate::sparsity::{DENSE_UP_TO, SPARSE_COST};
use crate::{Pattern, Sparsity};
use blocks::Blocks;
use conjugate::{Conjugate, largest};
use definite::Definite;
use dense::Singular;
use pivoted::Pivoted;
use quasi::Quasi;

/// Solver of M a + Gᵀλ = f, G a = γ; free of allocation behind the first factorisation.
///
/// The matrix is factored as a quasi-definite one, and by elimination with pivots where M is singular; either as a full or as a sparse one,
/// whichever is less work.
#[derive(Clone, Debug)]
pub struct Kkt {
    nv: usize,
    rows: usize,
    /// Powers of two near D^−½, then near diag(G D⁻¹ Gᵀ)^−½ (nv + m).
    scale: Vec<f64>,
    /// Scaled E (m) at assembly, and that of the factors at hand.
    assembled: Vec<f64>,
    e: Vec<f64>,
    /// Roots of the parts that are left of E (m), and whether one of them is not 1; see [`Kkt::follow_inertias`].
    weights: Vec<f64>,
    grown: bool,
    refinements: usize,
    /// Whether solutions go on until rows hold to round-off.
    further: Option<Further>,
    /// Values of G, where they do.
    g: Vec<f64>,
    blocks: Blocks,
    /// Places of the diagonal of M (nv).
    diagonal: Vec<usize>,
    /// L D Lᵀ of the scaled [M Gᵀ; G −E]. Made when it is needed.
    form: Option<Form>,
    /// Whether it holds; else it is `pivoted` that does.
    definite: bool,
    /// Made when it is needed.
    pivoted: Option<Pivoted>,
    /// Scaled right-hand side, then solution (nv + m).
    x: Vec<f64>,
    /// Made when it is needed.
    conjugate: Conjugate,
}

/// Where solutions go on until rows hold to round-off.
#[derive(Clone, Copy, Debug)]
enum Further {
    /// In directions from this σ on, of rows that are nearly dependent at the start. Where another one is needed nothing changes.
    Regular(f64),
    /// In all directions, as far as they can: at rest no singular position is passed.
    Everywhere,
}

/// How L D Lᵀ is computed.
#[derive(Clone, Debug)]
enum Form {
    Full(Definite),
    Sparse(Box<Quasi>),
}

impl Form {
    /// The cheaper one for the patterns of M and G, with the scales of the unknowns (nv + m).
    fn new(blocks: &Blocks, scale: &[f64]) -> Self {
        let n = blocks.order();
        let sparse = (n > DENSE_UP_TO).then(|| blocks.whole()).and_then(|whole| {
            let (cost, ordering) = quasi::ordered(blocks.velocities(), &whole);
            (cost < definite_cost(n)).then(|| Self::Sparse(Box::new(Quasi::new(blocks, &whole, &ordering))))
        });
        let mut form = sparse.unwrap_or_else(|| Self::Full(Definite::new(blocks)));
        form.set_scale(blocks, scale);
        form
    }

    fn set_scale(&mut self, blocks: &Blocks, scale: &[f64]) {
        match self {
            Self::Full(full) => full.set_scale(scale),
            Self::Sparse(quasi) => quasi.set_scale(blocks, scale),
        }
    }
}

/// Multiplications of L D Lᵀ of a full matrix of n unknowns.
fn definite_cost(n: usize) -> usize {
    n * (n + 1) * (n + 2) / 6
}

/// Steps of iterative refinement; and where a coordinate has no mass: E is then large beside what its rows feel.
const REFINEMENTS: usize = 2;
const REFINEMENTS_WITHOUT_MASS: usize = 8;

/// A residual of so many roundings of the largest unknown is none.
const ROUNDED: f64 = 8.0 * f64::EPSILON;

/// Part of D below which a diagonal entry of M counts as none.
const LIGHT: f64 = 1e-2;

/// Inertia, in parts of that at assembly, from which on E follows it.
const GROWN: f64 = 100.0;

/// Inverse iterations for the smallest singular value at the start.
const ITERATIONS: usize = 4;

/// σ at the start below which it is a singular position, and from which on the refinements leave round-off.
const SINGULAR: f64 = 1e-8;
const NEARLY_DEPENDENT: f64 = 1e-2;

/// Part of σ at the start below which a position is nearer to a singular one: there solutions would multiply what states are off.
const NEARER: f64 = 1e-2;

impl Kkt {
    /// One for full matrices of `nv` velocities and `rows` constraint rows, with scales of one.
    pub fn new(nv: usize, rows: usize) -> Self {
        Self::of_blocks(&Sparsity::dense(nv, nv), &Sparsity::dense(rows, nv))
    }

    /// One for the pattern of a system, with its scales; sparse where that pays.
    pub fn of_pattern(pattern: &Pattern) -> Self {
        let mut kkt = Self::of_blocks(&pattern.mass, &pattern.g);
        kkt.set_scale(&pattern.metric, &pattern.g_scale);
        kkt.set_weakest(pattern.weakest);
        kkt
    }

    /// One for the patterns of M and G, with scales of one; sparse where that pays.
    pub fn of_blocks(mass: &Sparsity, g: &Sparsity) -> Self {
        let blocks = Blocks([mass.clone(), g.clone()]);
        let (nv, n) = (blocks.velocities(), blocks.order());
        Self {
            nv,
            rows: n - nv,
            diagonal: (0..nv).filter_map(|i| blocks.0[0].place(i, i)).collect(),
            blocks,
            scale: vec![1.0; n],
            assembled: vec![REGULARIZATION; n - nv],
            e: vec![REGULARIZATION; n - nv],
            weights: vec![1.0; n - nv],
            grown: false,
            refinements: REFINEMENTS,
            further: None,
            g: Vec::new(),
            form: None,
            definite: false,
            pivoted: None,
            x: vec![0.0; n],
            conjugate: Conjugate::default(),
        }
    }

    /// Cost of a factorisation for the patterns of M and G, in multiplications of a dense one.
    pub fn cost(mass: &Sparsity, g: &Sparsity) -> usize {
        let blocks = Blocks([mass.clone(), g.clone()]);
        definite_cost(blocks.order()).min(quasi::ordered(blocks.velocities(), &blocks.whole()).0)
    }

    /// What [`Kkt::cost`] is at least for n unknowns, the first of which are velocities that meet each other along the roads of a tree: for
    /// each of them the number of others on its road to the root, `depths`.
    ///
    /// Without rows such an M has no fill if leaves are eliminated first, and no order makes fewer products: the pairs of neighbours of
    /// what is eliminated, with it, are the triangles of the graph, of which fill only makes more.
    pub fn least_cost(unknowns: usize, depths: &[usize]) -> usize {
        let products: usize = depths.iter().map(|depth| depth * depth).sum();
        definite_cost(unknowns).min(SPARSE_COST * products / 2)
    }

    /// Number of velocities.
    pub fn velocities(&self) -> usize {
        self.nv
    }

    /// Takes the scales from the matrices at assembly; see [`metric`] and [`row_scale`]. Allocates.
    pub fn scale(&mut self, mass: &[f64], g: &[f64], kinds: &[Kind]) {
        let metric = metric(self.diagonal.iter().map(|k| mass[*k]), kinds);
        let g_scale = row_scale(&self.blocks.0[1], g, &metric);
        self.set_scale(&metric, &g_scale);
    }

    /// Takes the scales D (nv) and diag(G D⁻¹ Gᵀ) (m) of a [`Pattern`].
    pub fn set_scale(&mut self, metric: &[f64], g_scale: &[f64]) {
        for (s, x) in self.scale.iter_mut().zip(metric.iter().chain(g_scale)) {
            *s = scale::root_inverse(*x);
        }
        for ((e, x), s) in self.assembled.iter_mut().zip(g_scale).zip(&self.scale[self.nv..]) {
            *e = REGULARIZATION * x * s * s;
        }
        self.e.copy_from_slice(&self.assembled);
        if let Some(form) = &mut self.form {
            form.set_scale(&self.blocks, &self.scale);
        }
    }

    /// Factors the matrix of M (nv × nv) and G (m × nv), by their patterns.
    ///
    /// Fails where M is singular on the free motions (a massless freedom), and where a number is not finite.
    pub fn factor(&mut self, mass: &[f64], g: &[f64]) -> Result<(), Singular> {
        if self.nv + self.rows == 0 {
            // nothing is free and nothing constrains: minimal coordinates of what cannot move
            return Ok(());
        }
        if self.further.is_some() {
            self.g.clear();
            self.g.extend_from_slice(g);
        }
        let (mut light, mut grown) = (false, false);
        for (k, s) in self.diagonal.iter().zip(&self.scale) {
            let inertia = mass[*k] * s * s;
            light |= inertia < LIGHT;
            grown |= inertia > GROWN;
        }
        self.refinements = if light { REFINEMENTS_WITHOUT_MASS } else { REFINEMENTS };
        if grown || self.grown {
            self.follow_inertias(mass, g);
        }
        self.grown = grown;
        self.definite = match self.form.get_or_insert_with(|| Form::new(&self.blocks, &self.scale)) {
            Form::Full(full) => full.factor(&self.blocks, [mass, g], &self.e),
            Form::Sparse(quasi) => quasi.factor([mass, g], &self.e),
        };
        if self.definite { Ok(()) } else { self.eliminate(mass, g) }
    }

    /// Takes E for inertias that are not those at assembly: of each row the part Σ g²/max(D, M/100) / Σ g²/D is left, all of it where no
    /// inertia has grown so much.
    fn follow_inertias(&mut self, mass: &[f64], g: &[f64]) {
        let (d, pattern) = (&self.scale[..self.nv], &self.blocks.0[1]);
        for i in 0..self.rows {
            let (mut at_assembly, mut now) = (0.0, 0.0);
            for (&j, g) in pattern.row(i).iter().zip(&g[pattern.range(i)]) {
                let square = (g * d[j]).powi(2);
                at_assembly += square;
                now += square / (mass[self.diagonal[j]] * d[j] * d[j] / GROWN).max(1.0);
            }
            let left = if at_assembly > 0.0 { now / at_assembly } else { 1.0 };
            self.e[i] = left * self.assembled[i];
            self.weights[i] = left.sqrt();
        }
    }

    /// Factors by elimination with pivots.
    fn eliminate(&mut self, mass: &[f64], g: &[f64]) -> Result<(), Singular> {
        self.definite = false;
        let pivoted = self.pivoted.get_or_insert_with(|| Pivoted::new(&self.blocks));
        pivoted.factor(&self.blocks, [mass, g], &self.scale, &self.e)
    }

    /// Makes room for an elimination with pivots now, not when the first matrix asks for it.
    #[must_use]
    pub fn with_pivots(mut self) -> Self {
        self.pivoted.get_or_insert_with(|| Pivoted::new(&self.blocks));
        self
    }

    /// x := the solution with the right-hand side x, by the factors at hand, with `refinements` against the matrix without E.
    fn apply(&mut self, refinements: usize) {
        match (&mut self.form, &mut self.pivoted) {
            (Some(Form::Full(full)), _) if self.definite => full.solve(&self.e, &mut self.x, refinements),
            (Some(Form::Sparse(quasi)), _) if self.definite => quasi.solve(&self.e, &mut self.x, refinements),
            (_, Some(pivoted)) => pivoted.solve(&mut self.x, refinements),
            _ => {}
        }
    }

    /// Accelerations `a` (nv) and multipliers `lambda` (m) of the forces `f` (nv) and the right-hand side `gamma` (m).
    ///
    /// With M as metric, f = 0 and γ = −Φ the same gives the shortest correction onto the constraints.
    pub fn solve(&mut self, f: &[f64], gamma: &[f64], a: &mut [f64], lambda: &mut [f64]) {
        let nv = self.nv;
        let (of_motions, of_rows) = self.x.split_at_mut(nv);
        for (b, (f, d)) in of_motions.iter_mut().zip(f.iter().zip(&self.scale)) {
            *b = f * d;
        }
        for (b, (gamma, s)) in of_rows.iter_mut().zip(gamma.iter().zip(&self.scale[nv..])) {
            *b = gamma * s;
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
        if let Some(further) = self.further {
            self.converge(gamma, further, a, lambda);
        }
    }

    /// Goes on from accelerations `a` (nv) and multipliers `lambda` (m) until G a = `gamma` (m) holds to round-off.
    ///
    /// Nothing changes where it does already.
    fn converge(&mut self, gamma: &[f64], further: Further, a: &mut [f64], lambda: &mut [f64]) {
        let nv = self.nv;
        let mut conjugate = std::mem::take(&mut self.conjugate);
        let g = &self.blocks.0[1];
        let row = |i: usize| g.row(i).iter().zip(&self.g[g.range(i)]).map(|(k, g)| g * a[*k]).sum::<f64>();
        conjugate.r.clear();
        conjugate.r.extend(gamma.iter().zip(&self.scale[nv..]).enumerate().map(|(i, (gamma, s))| (row(i) - gamma) * s));
        let unknowns = a.iter().chain(&*lambda).zip(&self.scale);
        let round_off = ROUNDED * unknowns.fold(0.0, |size: f64, (x, s)| size.max((x / s).abs()));
        if largest(&conjugate.r) > round_off {
            conjugate.e.clone_from(&self.e);
            let least = if let Further::Regular(sigma) = further { Some(sigma * sigma) } else { None };
            let reached = conjugate.reduce(nv, round_off, least, |r, x| {
                self.x[..nv].fill(0.0);
                self.x[nv..].iter_mut().zip(r).for_each(|(x, r)| *x = -r);
                self.apply(0);
                x.copy_from_slice(&self.x);
            });
            if reached || least.is_none() {
                let unknowns = a.iter_mut().chain(lambda);
                unknowns.zip(conjugate.sum.iter().zip(&self.scale)).for_each(|(unknown, (x, s))| *unknown += x * s);
            }
        }
        self.conjugate = conjugate;
    }

    /// Estimates of the smallest singular value of diag(G D⁻¹ Gᵀ)^−½ G D^−½, and of the smallest that is not of redundant rows, with D (nv)
    /// the `metric` and `g` the values of G at the start; 1 without rows. The second is not good below 1e-4, which E hides. Factors anew,
    /// and allocates.
    pub(crate) fn weakest(&mut self, metric: &[f64], g: &[f64]) -> (f64, f64) {
        let mass = self.diagonal_mass(metric);
        let mut vector = vec![0.0; self.rows];
        if vector.is_empty() || self.factor(&mass, g).is_err() {
            return (1.0, 1.0);
        }
        let mut smallest = [1.0];
        (0..ITERATIONS / 2).for_each(|_| self.smallest_singular_values(&mut vector, &mut smallest));
        vector.fill(0.0);
        (smallest[0], (0..ITERATIONS).fold(1.0, |_, _| self.smallest_singular_value_that_moves(&mut vector)))
    }

    /// The smallest singular value of rows that are independent, by factors without E; 0 where they have none. The factors are of no other use.
    pub(crate) fn weakest_of_independent(&mut self, metric: &[f64], g: &[f64]) -> f64 {
        let mass = self.diagonal_mass(metric);
        self.e.fill(0.0);
        let mut vector = vec![0.0; self.rows];
        if vector.is_empty() || self.eliminate(&mass, g).is_err() {
            return if vector.is_empty() { 1.0 } else { 0.0 };
        }
        dense::start(&mut vector, 0);
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        (0..ITERATIONS).fold(1.0, |_, _| {
            let length = norm(&vector);
            self.x[..self.nv].fill(0.0);
            self.x[self.nv..].iter_mut().zip(&vector).for_each(|(x, y)| *x = y / length);
            self.apply(0);
            vector.copy_from_slice(&self.x[self.nv..]);
            norm(&vector).sqrt().recip()
        })
    }

    /// Values of an M that is the `metric` (nv).
    fn diagonal_mass(&self, metric: &[f64]) -> Vec<f64> {
        let mut mass = vec![0.0; self.blocks.0[0].entries()];
        self.diagonal.iter().zip(metric).for_each(|(k, d)| mass[*k] = *d);
        mass
    }

    /// Lets solutions go on until rows hold to round-off where they are nearly dependent at the start, by the σ that
    /// [`weakest`](crate::weakest::weakest) finds there, and as far as no position is nearer to a singular one.
    pub fn set_weakest(&mut self, weakest: f64) {
        self.further = (SINGULAR..NEARLY_DEPENDENT).contains(&weakest).then_some(Further::Regular(NEARER * weakest));
    }

    /// Lets solutions go on until rows hold to round-off in all directions, or no longer: for what is at rest.
    pub fn set_exact(&mut self, exact: bool) {
        self.further = exact.then_some(Further::Everywhere);
    }

    /// Estimates of the smallest singular values σ of diag(G D⁻¹ Gᵀ)^−½ G D^−½, the smallest first, by one inverse iteration on the
    /// factorisation; 1 for independent rows, 0 in a singular position and for each redundant row.
    ///
    /// `vectors` (as many as `sigma` × m) keeps the vectors from call to call (zeros at first): the combinations of scaled rows that are
    /// nearest to dependence, orthonormal. M stands in the place of D (rows are scaled by inertias that have grown, as E is), and E hides
    /// what is below 1e-4; a factor of about 2 is what to expect.
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
            self.x[nv..].iter_mut().zip(&*row).zip(&self.weights).for_each(|((x, y), w)| *x = w * y / length);
            self.apply(0);
            self.x[nv..].iter_mut().zip(&self.weights).for_each(|(x, w)| *x *= w);
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
        self.x[self.nv..].iter_mut().zip(&*vector).zip(&self.weights).for_each(|((x, y), w)| *x = w * y / length);
        self.apply(0);
        vector.iter_mut().zip(&self.x[self.nv..]).zip(&self.weights).for_each(|((y, x), w)| *y = w * x);
        self.without_redundant(vector);
        let size = norm(vector);
        vector.iter_mut().for_each(|x| *x /= size);
        (size.recip() - REGULARIZATION).max(0.0).sqrt()
    }

    /// x − (S + E)⁻¹ E x, of x times the weights.
    fn without_redundant(&mut self, vector: &mut [f64]) {
        self.x[..self.nv].fill(0.0);
        let e = self.e.iter().zip(&self.weights).map(|(e, w)| e / w);
        self.x[self.nv..].iter_mut().zip(e).zip(&*vector).for_each(|((x, e), y)| *x = e * y);
        self.apply(0);
        vector.iter_mut().zip(&self.x[self.nv..]).zip(&self.weights).for_each(|((y, x), w)| *y += w * x);
    }
}

#[cfg(test)]
mod factor_tests;
#[cfg(test)]
mod tests;
