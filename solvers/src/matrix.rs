//! The one matrix of all implicit schemes.
//!
//! ```text
//! [ M + c_v C + c_q K   c_z R_z      Gᵀ + R_λ ] [ Δa ]
//! [ −c_q Z_q − c_v Z_v  I − c_z Z_z  0        ] [ Δż ]
//! [ G                   0            −E       ] [ Δλ ]
//! ```
//!
//! A scheme is a predictor and its coefficients: δq = c_q δa, δv = c_v δa, δz = c_z δż. Rows and columns are scaled by powers
//! of two near D^−½ and diag(G D⁻¹ Gᵀ)^−½, so that pivots do not depend on units; E is fixed at assembly
//! (see [`kkt`](crate::kkt)). ∂(G v)/∂q and ∂(Gᵀλ)/∂q's counterpart in the constraint rows are left out: Newton's method is a
//! simplified one.

use crate::kkt::{REGULARIZATION, root_inverse};
use crate::{Block, Dims, Factor, Number, Pattern, Singular, Sparsity, Tangent, Terms};

/// Coefficients of a scheme: δq = c_q δa, δv = c_v δa, δz = c_z δż.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients<T> {
    /// δq by δa, s².
    pub q: T,
    /// δv by δa, s.
    pub v: T,
    /// δz by δż, s.
    pub z: T,
}

/// Blocks of the matrix at the point of linearisation.
#[derive(Clone, Debug)]
pub struct Blocks {
    /// M (nv × nv).
    pub mass: Block,
    /// G (m × nv).
    pub g: Block,
    /// K, C, R_z, R_λ, Z_q, Z_v, Z_z.
    pub tangent: Tangent,
}

impl Blocks {
    /// Zeros of the patterns of a system.
    pub fn new(pattern: &Pattern) -> Self {
        Self { mass: Block::new(&pattern.mass), g: Block::new(&pattern.g), tangent: Tangent::new(pattern) }
    }

    /// Takes M and G of terms.
    pub fn take(&mut self, terms: &Terms) {
        self.mass.values_mut().copy_from_slice(terms.mass.values());
        self.g.values_mut().copy_from_slice(terms.g.values());
    }
}

/// An entry of the matrix: which blocks it is made of, and where in them; [`NOWHERE`] for a block without it.
#[derive(Clone, Copy, Debug)]
enum Entry {
    /// M + c_v C + c_q K: places in M, C and K.
    Motion([usize; 3]),
    /// c_z R_z.
    OfState(usize),
    /// Gᵀ + R_λ: places in G and in R_λ.
    OfMultiplier(usize, usize),
    /// −c_q Z_q − c_v Z_v: places in both.
    StateByMotion([usize; 2]),
    /// δ − c_z Z_z, and whether it is on the diagonal.
    StateByState(usize, bool),
    /// G.
    Row(usize),
    /// −E.
    Regular(f64),
}

/// The place of an entry that a block has not.
const NOWHERE: usize = usize::MAX;

/// The matrix over real or complex numbers, factored.
#[derive(Clone, Debug)]
pub struct Matrix<T: Number> {
    entries: Vec<(Entry, f64)>,
    values: Vec<T>,
    factor: Factor<T>,
    /// Power of two of each unknown and of its equation.
    scale: Vec<f64>,
}

impl<T: Number> Matrix<T> {
    /// Room for the matrix of a system.
    pub fn new(dims: Dims, pattern: &Pattern) -> Self {
        let (nv, nz) = (dims.v, dims.z);
        let n = nv + nz + dims.rows();
        let mut scale = vec![1.0; n];
        let units = pattern.metric.iter().chain(std::iter::repeat_n(&1.0, nz)).chain(&pattern.g_scale);
        scale.iter_mut().zip(units).for_each(|(s, unit)| *s = root_inverse(*unit));
        let block = |s: &Sparsity, row: usize, column: usize| s.places().map(|(i, j)| (row + i, column + j)).collect::<Vec<_>>();
        let mut places = Vec::new();
        for s in [&pattern.mass, &pattern.k, &pattern.c] {
            places.extend(block(s, 0, 0));
        }
        places.extend(block(&pattern.r_z, 0, nv));
        places.extend(block(&pattern.g.transposed(), 0, nv + nz));
        places.extend(block(&pattern.r_lambda, 0, nv + nz));
        places.extend(block(&pattern.z_q, nv, 0));
        places.extend(block(&pattern.z_v, nv, 0));
        places.extend(block(&pattern.z_z, nv, nv));
        places.extend(block(&pattern.g, nv + nz, 0));
        places.extend((nv..n).map(|i| (i, i)));
        let whole = Sparsity::new(n, n, places);
        let p = pattern;
        let at = |block: &Sparsity, i: usize, j: usize| block.place(i, j).unwrap_or(NOWHERE);
        let entry = |i: usize, j: usize| match (i, j) {
            _ if i < nv && j < nv => Entry::Motion([&p.mass, &p.c, &p.k].map(|block| at(block, i, j))),
            _ if i < nv && j < nv + nz => Entry::OfState(at(&p.r_z, i, j - nv)),
            _ if i < nv => Entry::OfMultiplier(at(&p.g, j - nv - nz, i), at(&p.r_lambda, i, j - nv - nz)),
            _ if i < nv + nz && j < nv => Entry::StateByMotion([&p.z_q, &p.z_v].map(|block| at(block, i - nv, j))),
            _ if i < nv + nz => Entry::StateByState(at(&p.z_z, i - nv, j - nv), i == j),
            _ if j < nv => Entry::Row(at(&p.g, i - nv - nz, j)),
            _ => Entry::Regular(REGULARIZATION * p.g_scale[i - nv - nz]),
        };
        // the factor takes its values column after column
        let entries: Vec<_> = whole.transposed().places().map(|(j, i)| (entry(i, j), scale[i] * scale[j])).collect();
        Self { values: vec![T::from(0.0); entries.len()], factor: Factor::new(&whole), entries, scale }
    }

    /// Factors the matrix of the blocks with the coefficients of a scheme.
    ///
    /// # Errors
    /// If it is singular or not finite.
    pub fn factor(&mut self, blocks: &Blocks, c: Coefficients<T>) -> Result<(), Singular> {
        let t = &blocks.tangent;
        let of = |block: &Block, place: usize| T::from(block.values().get(place).copied().unwrap_or(0.0));
        for (value, &(entry, scale)) in self.values.iter_mut().zip(&self.entries) {
            let x = match entry {
                Entry::Motion([mass, by_v, by_q]) => of(&blocks.mass, mass) + c.v * of(&t.c, by_v) + c.q * of(&t.k, by_q),
                Entry::OfState(i) => c.z * of(&t.r_z, i),
                Entry::OfMultiplier(g, r) => of(&blocks.g, g) + of(&t.r_lambda, r),
                Entry::StateByMotion([q, v]) => -(c.q * of(&t.z_q, q) + c.v * of(&t.z_v, v)),
                Entry::StateByState(i, diagonal) => T::from(f64::from(u8::from(diagonal))) - c.z * of(&t.z_z, i),
                Entry::Row(i) => of(&blocks.g, i),
                Entry::Regular(e) => T::from(-e),
            };
            *value = x * T::from(scale);
        }
        self.factor.factor(&self.values)
    }

    /// Solves for Δa, Δż, Δλ in place of the right-hand sides (nv + nz + m).
    pub fn solve(&mut self, x: &mut [T]) {
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= T::from(*s));
        self.factor.solve(x);
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= T::from(*s));
    }
}
