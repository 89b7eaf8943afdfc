//! Which entries of a system's matrices can be other than zero.

use crate::Dims;

/// The pattern of a matrix, by columns: entries outside of it are zero in every state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sparsity {
    /// Number of rows.
    rows: usize,
    /// Where each column begins in `indices`, and the end (columns + 1).
    starts: Vec<usize>,
    /// Rows of the entries, column after column, rising in each.
    indices: Vec<usize>,
}

impl Sparsity {
    /// The pattern with the given (row, column) entries, in any order, repeated or not.
    ///
    /// Entries outside of the matrix are ignored.
    pub fn new(rows: usize, columns: usize, entries: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let mut entries: Vec<_> = entries.into_iter().filter(|&(i, j)| i < rows && j < columns).map(|(i, j)| (j, i)).collect();
        entries.sort_unstable();
        entries.dedup();
        let starts = (0..=columns).map(|j| entries.partition_point(|&(column, _)| column < j)).collect();
        Self { rows, starts, indices: entries.into_iter().map(|(_, i)| i).collect() }
    }

    /// The pattern of a square matrix in which all indices of a group meet each other, for each of the groups, whose indices may come
    /// in any order, repeated or not.
    ///
    /// Groups may overlap in most of their indices, as the paths to the bodies of a chain do: each costs its length times a row of
    /// bits, not the square of its length.
    pub fn of_groups<'g>(size: usize, groups: impl IntoIterator<Item = &'g [usize]>) -> Self {
        let words = size.div_ceil(64);
        let mut met = vec![0_u64; size * words];
        let mut own = vec![0_u64; words];
        for group in groups {
            own.fill(0);
            group.iter().filter(|&&i| i < size).for_each(|&i| own[i / 64] |= 1 << (i % 64));
            for &j in group.iter().filter(|&&j| j < size) {
                met[j * words..][..words].iter_mut().zip(&own).for_each(|(met, own)| *met |= own);
            }
        }
        let (mut starts, mut indices) = (vec![0], Vec::new());
        for column in 0..size {
            indices.extend((0..size).filter(|i| met[column * words + i / 64] >> (i % 64) & 1 == 1));
            starts.push(indices.len());
        }
        Self { rows: size, starts, indices }
    }

    /// A full matrix.
    pub fn dense(rows: usize, columns: usize) -> Self {
        Self { rows, starts: (0..=columns).map(|j| j * rows).collect(), indices: (0..columns).flat_map(|_| 0..rows).collect() }
    }

    /// A matrix of zeros.
    pub fn empty(rows: usize, columns: usize) -> Self {
        Self { rows, starts: vec![0; columns + 1], indices: Vec::new() }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.indices.len()
    }

    /// Rows of the entries of a column, rising.
    pub fn column(&self, j: usize) -> &[usize] {
        &self.indices[self.starts[j]..self.starts[j + 1]]
    }

    /// The pattern of the transposed matrix.
    pub fn transposed(&self) -> Self {
        let entries = (0..self.columns()).flat_map(|j| self.column(j).iter().map(move |&i| (j, i)));
        Self::new(self.columns(), self.rows, entries)
    }
}

/// The velocities that share in a common translation, each with its components along up to three directions that are orthogonal unit
/// vectors (nv each); the velocities of two common translations differ.
pub type Common = Vec<(usize, [f64; 3])>;

/// What powers are functions of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Power {
    /// Nothing: they are zero, the energy stays as it is.
    Zero,
    /// t, q, v and z.
    State,
    /// The reactions, too, which take a solution of the accelerations.
    Reactions,
}

/// Patterns of all blocks of a system, and the scales of its equations; both taken once, at assembly.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// M (nv × nv).
    pub mass: Sparsity,
    /// G (m × nv).
    pub g: Sparsity,
    /// K = ∂r/∂q (nv × nv).
    pub k: Sparsity,
    /// C = ∂r/∂v (nv × nv).
    pub c: Sparsity,
    /// ∂r/∂z (nv × nz).
    pub r_z: Sparsity,
    /// ∂r/∂λ beyond Gᵀ (nv × m); without entries no force depends on the reactions, and [`System::reaction_friction`](crate::System::reaction_friction) is not asked.
    pub r_lambda: Sparsity,
    /// ∂ż/∂q (nz × nv).
    pub z_q: Sparsity,
    /// ∂ż/∂v (nz × nv).
    pub z_v: Sparsity,
    /// ∂ż/∂z (nz × nz).
    pub z_z: Sparsity,
    /// D (nv), see [`kkt::metric`](crate::kkt::metric).
    pub metric: Vec<f64>,
    /// diag(G D⁻¹ Gᵀ) (m), see [`kkt::natural_row_scale`](crate::kkt::natural_row_scale), and
    /// [`kkt::row_scale`](crate::kkt::row_scale) where nothing is known of rows but their entries; E = 1e-8 of it.
    pub g_scale: Vec<f64>,
    /// Sizes of coordinates (nq): errors of q count in units of these, absolutely, since angles wind up and places drift.
    pub size_q: Vec<f64>,
    /// The same for displacements and velocities (nv): errors of v count relative to size + |v|, where |v| is what is left without
    /// the velocity in `common`.
    pub size_v: Vec<f64>,
    /// Translations of bodies that nothing holds in place: a constant velocity of all of them is no motion that errors are measured by.
    pub common: Vec<Common>,
    /// What the powers of [`System::power`](crate::System::power) are functions of.
    pub power: Power,
    /// Whether root functions read a and λ; else they are functions of t, q, v and z alone, which saves a solution at each look.
    pub roots_by_reactions: bool,
    /// Roots that are located even where switches are marched across (see [`Settings::locate`](crate::Settings::locate)): those of
    /// events, and of contacts whose crossing gives a blow.
    pub acting: Vec<usize>,
    /// Roots behind which forces follow other laws: a step that reaches far beyond one is made again.
    pub forceful: Vec<usize>,
    /// Roots that depend on time alone, in any modes: [`System::ahead`](crate::System::ahead) finds them.
    pub timed: Vec<usize>,
    /// Roots that need not be smooth functions of the state: they are looked at, not resolved.
    pub rough: Vec<usize>,
}

impl Pattern {
    /// Full blocks of the given sizes, with scales of one; no force depends on the reactions.
    pub fn dense(dims: Dims) -> Self {
        let (v, z, m) = (dims.v, dims.z, dims.rows());
        Self {
            mass: Sparsity::dense(v, v),
            g: Sparsity::dense(m, v),
            k: Sparsity::dense(v, v),
            c: Sparsity::dense(v, v),
            r_z: Sparsity::dense(v, z),
            r_lambda: Sparsity::empty(v, m),
            z_q: Sparsity::dense(z, v),
            z_v: Sparsity::dense(z, v),
            z_z: Sparsity::dense(z, z),
            metric: vec![1.0; v],
            g_scale: vec![1.0; m],
            size_q: vec![1.0; dims.q],
            size_v: vec![1.0; v],
            common: Vec::new(),
            power: Power::Reactions,
            roots_by_reactions: false,
            acting: Vec::new(),
            forceful: Vec::new(),
            timed: Vec::new(),
            rough: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_their_pairs() {
        let groups: [&[usize]; 4] = [&[0, 2], &[70, 2, 2], &[5], &[9, 70, 80]];
        let pairs = groups.iter().flat_map(|g| g.iter().flat_map(|&i| g.iter().map(move |&k| (i, k))));
        assert_eq!(Sparsity::of_groups(71, groups), Sparsity::new(71, 71, pairs));
        assert_eq!(Sparsity::of_groups(0, [[].as_slice()]), Sparsity::empty(0, 0));
    }

    #[test]
    fn entries_are_sorted_and_unique_and_inside() {
        let pattern = Sparsity::new(3, 2, [(2, 1), (0, 1), (2, 1), (1, 0), (5, 0), (0, 7)]);
        assert_eq!((pattern.rows(), pattern.columns(), pattern.entries()), (3, 2, 3));
        assert_eq!(pattern.column(0), [1]);
        assert_eq!(pattern.column(1), [0, 2]);
        assert_eq!(pattern.transposed(), Sparsity::new(2, 3, [(0, 1), (1, 0), (1, 2)]));
        assert_eq!(pattern.transposed().transposed(), pattern);
    }

    #[test]
    fn dense_and_empty_are_the_extremes() {
        assert_eq!(Sparsity::dense(2, 3), Sparsity::new(2, 3, (0..2).flat_map(|i| (0..3).map(move |j| (i, j)))));
        assert_eq!(Sparsity::empty(2, 3), Sparsity::new(2, 3, []));
    }
}
