//! K x = λ M x with G x = 0 for sparse matrices: how many eigenvalues are below a place, and the shifted system.

use super::pencil::Pencil;
use super::saddle::Saddle;
use grashof_solvers::{Block, Sparsity};

/// A first shift, as part of the largest stiffness: far enough below zero for the digits, near enough to tell low eigenvalues apart. No
/// power of ten, since the largest stiffness may itself be an eigenvalue, and negative.
const SHIFT: f64 = 3e-8;

/// The matrices of a pencil on one pattern.
pub(crate) struct Pair<'a> {
    pub(super) pencil: &'a Pencil,
    /// The symmetric part of K, and M.
    pub(super) stiffness: Block,
    pub(super) mass: Block,
    /// D^−½ and diag(G D⁻¹ Gᵀ)^−½.
    scale: Vec<f64>,
    /// The largest entry of D^−½ K D^−½, or of what K is made of, 1/s²; 1 without any.
    pub(crate) size: f64,
}

impl<'a> Pair<'a> {
    pub(crate) fn new(pencil: &'a Pencil) -> Self {
        let nv = pencil.metric.len();
        let places = pencil.stiffness.pattern().places().flat_map(|(i, j)| [(i, j), (j, i)]);
        let pattern = Sparsity::new(nv, nv, places.chain(pencil.mass.pattern().places())).or_dense();
        let (mut stiffness, mut mass) = (Block::new(&pattern), Block::new(&pattern));
        mass.take(&pencil.mass);
        for (i, line) in pencil.stiffness.lines().enumerate() {
            for (j, k) in line.entries() {
                stiffness.set(i, j, stiffness.at(i, j) + 0.5 * k);
                stiffness.set(j, i, stiffness.at(j, i) + 0.5 * k);
            }
        }
        let scale: Vec<f64> = pencil.metric.iter().chain(&pencil.row_scale).map(|x| x.sqrt().recip()).collect();
        let sizes = pattern.places().zip(stiffness.values()).map(|((i, j), k): (_, &f64)| (k * scale[i] * scale[j]).abs());
        let size = sizes.chain(pencil.grain.iter().zip(&pencil.metric).map(|(grain, d)| grain / d)).fold(0.0, f64::max);
        Self { pencil, stiffness, mass, scale, size: if size > 0.0 { size } else { 1.0 } }
    }

    /// Entries of (K − σM)/size.
    pub(super) fn shifted(&self, shift: f64) -> impl Iterator<Item = f64> + '_ {
        self.stiffness.values().iter().zip(self.mass.values()).map(move |(k, m)| (k - shift * m) / self.size)
    }

    /// Number of eigenvalues below a place; none if a number is not finite.
    pub(crate) fn below(&self, place: f64) -> Option<usize> {
        Some(self.factored(place)?.below)
    }

    /// [K − σM, Gᵀ; G, −E] by the size of the stiffness, factored; none if a number is not finite.
    pub(crate) fn factored(&self, shift: f64) -> Option<Saddle> {
        self.beside_rows(self.stiffness.pattern().places().zip(self.shifted(shift)).map(|((i, j), x)| (i, j, x)))
    }

    /// A symmetric matrix (nv × nv) in the place of K − σM.
    pub(super) fn beside_rows(&self, entries: impl Iterator<Item = (usize, usize, f64)>) -> Option<Saddle> {
        Saddle::new(entries, &self.pencil.rows, &self.scale)
    }

    /// A shift below all eigenvalues.
    pub(super) fn below_all(&self) -> Option<f64> {
        let mut shift = -SHIFT * self.size;
        while self.below(shift)? > 0 {
            shift *= 10.0;
        }
        shift.is_finite().then_some(shift)
    }
}
