//! Rank of the constraint rows at assembly: which rows are redundant, and which motions are left.

use crate::Block;
use crate::elimination::Elimination;

/// Length that a scaled row must keep beside the others, unless the caller knows better; sound rows have the length 1.
pub const RANK_TOLERANCE: f64 = 1e-8;

/// Multiplications of an orthogonalisation up to which nothing else is asked: about 160 rows of as many velocities.
const CHEAP: usize = 1 << 22;

/// What the constraint rows G (m × nv) amount to in one position.
///
/// Everything is taken of Ĝ = diag(g_scale)^−½ G D^−½, so that neither units nor mass ratios decide what is redundant.
#[derive(Clone, Debug, PartialEq)]
pub struct Rank {
    /// Number of independent rows.
    pub rank: usize,
    /// Rows that depend on the others, rising; of equally good rows the later ones are named.
    pub dependent: Vec<usize>,
    /// Number of motions with G v = 0, nv − rank.
    pub mobility: usize,
    motions: Motions,
}

/// The motions that the rows leave.
#[derive(Clone, Debug, PartialEq)]
enum Motions {
    /// A basis of them (nv × dof, row-major).
    Basis(Vec<f64>),
    /// The elimination that they follow from, and D^−½ (nv).
    Eliminated(Elimination, Vec<f64>),
}

/// Independent rows and a basis of the motions that they leave.
#[derive(Clone, Debug, PartialEq)]
pub struct NullSpace {
    /// Independent rows, in the order they were chosen.
    pub independent: Vec<usize>,
    /// Rows that depend on the others, rising.
    pub dependent: Vec<usize>,
    /// A basis of the motions with G v = 0 (nv × dof, row-major), orthonormal in D.
    pub basis: Vec<f64>,
    /// Number of motions in it.
    pub mobility: usize,
}

impl Rank {
    /// By orthogonal rows ([`NullSpace::new`]) where these cost little, else by sparse elimination.
    pub fn new(g: &Block, metric: &[f64], g_scale: &[f64], tolerance: f64) -> Self {
        let (nv, m) = (metric.len(), g_scale.len());
        if nv * nv * nv.max(m) <= CHEAP || m > 0 && g.pattern().is_full() {
            let found = NullSpace::new(&g.to_dense(), metric, g_scale, tolerance);
            let (rank, dependent, mobility) = (found.independent.len(), found.dependent, found.mobility);
            return Self { rank, dependent, mobility, motions: Motions::Basis(found.basis) };
        }
        let root = |x: &[f64]| x.iter().map(|x| x.sqrt().recip()).collect::<Vec<f64>>();
        let (scale, unit) = (root(g_scale), root(metric));
        let found =
            Elimination::of_independent(g, &scale, &unit, tolerance).unwrap_or_else(|| Elimination::new(g, &scale, &unit, tolerance));
        let (rank, dependent, mobility) = (found.independent.len(), found.dependent.clone(), found.free.len());
        Self { rank, dependent, mobility, motions: Motions::Eliminated(found, unit) }
    }

    /// The motion (nv) with the given parts (dof) of the motions that the rows leave.
    pub fn motion(&self, parts: &[f64]) -> Vec<f64> {
        match &self.motions {
            Motions::Basis(basis) => {
                basis.chunks_exact(self.mobility.max(1)).map(|row| row.iter().zip(parts).map(|(p, y)| p * y).sum()).collect()
            }
            Motions::Eliminated(rows, unit) => rows.annihilated(parts).iter().zip(unit).map(|(x, unit)| x * unit).collect(),
        }
    }
}

impl NullSpace {
    /// Rank-revealing orthogonalisation of the rows G (m × nv, row-major).
    ///
    /// Rows of Ĝ are orthogonalised by Gram-Schmidt, always the longest remainder next (Businger & Golub, Numer. Math. 7 (1965)
    /// 269-276, there by reflections), each twice against the basis ("twice is enough": Giraud et al., Numer. Math. 101 (2005)
    /// 87-100). A row depends on the others if its remainder is not longer than `tolerance`, or than that part of the row: by its
    /// own measure, so that rows of round-off alone all depend. Then unit vectors complete the basis in the same way: that is the
    /// null space. Costs about 2 nv² · max(nv, m) operations.
    pub fn new(g: &[f64], metric: &[f64], g_scale: &[f64], tolerance: f64) -> Self {
        let (nv, m) = (metric.len(), g_scale.len());
        if m == 0 {
            // the unit vectors one after the other
            let basis = (0..nv * nv).map(|k| if k % (nv + 1) == 0 { metric[k / nv].sqrt().recip() } else { 0.0 }).collect();
            return Self { independent: Vec::new(), dependent: Vec::new(), basis, mobility: nv };
        }
        let mut rows = scaled_rows(g, metric, g_scale);
        let mut basis: Vec<Vec<f64>> = Vec::with_capacity(nv);
        let mut left: Vec<usize> = (0..m).collect();
        let mut independent = Vec::new();
        let threshold: Vec<f64> = rows.iter().map(|row| tolerance * f64::max(1.0, norm(row))).collect();
        while basis.len() < nv {
            let beyond = |length: f64, threshold: f64| if length > threshold { length } else { 0.0 };
            let Some(next) = longest(left.iter().map(|&i| beyond(norm(&rows[i]), threshold[i])), 0.0) else { break };
            let chosen = left.remove(next);
            independent.push(chosen);
            basis.push(unit(std::mem::take(&mut rows[chosen]), &basis));
            let last = &basis[basis.len() - 1..];
            left.iter().for_each(|&i| orthogonalize(&mut rows[i], last));
        }
        let rank = basis.len();

        // complement: the unit vector farthest from the basis, again and again
        let mut columns: Vec<usize> = (0..nv).collect();
        while basis.len() < nv {
            let distance = |j: &usize| (1.0 - basis.iter().map(|b| b[*j] * b[*j]).sum::<f64>()).max(0.0);
            let Some(next) = longest(columns.iter().map(distance), -1.0) else { break };
            let mut e = vec![0.0; nv];
            e[columns.remove(next)] = 1.0;
            orthogonalize(&mut e, &basis);
            basis.push(unit(e, &basis));
        }
        let mobility = basis.len() - rank;
        let basis = (0..nv).flat_map(|i| basis[rank..].iter().map(move |b| b[i] / metric[i].sqrt())).collect();
        Self { independent, dependent: left, basis, mobility }
    }
}

/// The rows of diag(g_scale)^−½ G D^−½.
fn scaled_rows(g: &[f64], metric: &[f64], g_scale: &[f64]) -> Vec<Vec<f64>> {
    let row = |(i, s): (usize, &f64)| {
        let row = &g[i * metric.len()..(i + 1) * metric.len()];
        row.iter().zip(metric).map(|(g, d)| g / (d * s).sqrt()).collect()
    };
    g_scale.iter().enumerate().map(row).collect()
}

/// Index of the first of the greatest lengths above the threshold; lengths within 1e-6 count as equal.
fn longest(lengths: impl Iterator<Item = f64>, threshold: f64) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (i, length) in lengths.enumerate() {
        if length > threshold && best.is_none_or(|(_, most)| length > most * (1.0 + 1e-6)) {
            best = Some((i, length));
        }
    }
    best.map(|(i, _)| i)
}

/// x −= B Bᵀ x for orthonormal vectors B.
fn orthogonalize(x: &mut [f64], basis: &[Vec<f64>]) {
    for b in basis {
        let along: f64 = x.iter().zip(b).map(|(x, b)| x * b).sum();
        x.iter_mut().zip(b).for_each(|(x, b)| *x -= along * b);
    }
}

/// The unit vector of x after another orthogonalisation.
fn unit(mut x: Vec<f64>, basis: &[Vec<f64>]) -> Vec<f64> {
    orthogonalize(&mut x, basis);
    let length = norm(&x);
    x.iter_mut().for_each(|x| *x /= length);
    x
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sparsity;
    use crate::kkt::{metric, natural_row_scale, row_scale};
    use crate::noise::Noise;
    use crate::svd::Svd;
    use nalgebra::DMatrix;

    fn rank(g: &[f64], nv: usize) -> NullSpace {
        let metric = vec![1.0; nv];
        NullSpace::new(g, &metric, &row_scale(&Sparsity::dense(g.len() / nv, nv), g, &metric), RANK_TOLERANCE)
    }

    #[test]
    fn later_copies_of_a_row_are_named() {
        let found = rank(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -2.0, 0.0, 0.0, 3.0, 1.0, 0.0], 3);
        assert_eq!((found.independent.len(), found.mobility), (2, 1));
        assert_eq!(found.dependent, [2, 3]);
        assert_eq!(found.basis, [0.0, 0.0, 1.0]);
    }

    #[test]
    fn without_rows_every_velocity_is_free() {
        let metric = [4.0, 1.0, 0.25];
        let found = NullSpace::new(&[], &metric, &[], RANK_TOLERANCE);
        // a row of round-off is none, and takes the long way to the same
        let long = NullSpace::new(&[1e-30; 3], &metric, &[1.0], RANK_TOLERANCE);
        assert_eq!((found.mobility, found.independent.len()), (3, 0));
        assert_eq!((found.basis, found.mobility), (long.basis, long.mobility));
    }

    #[test]
    fn null_space_is_orthonormal_and_annihilated() {
        let mut noise = Noise(3);
        let (nv, m, r) = (14, 10, 6);
        for _ in 0..20 {
            let base = DMatrix::from_row_slice(r, nv, &noise.vector(r * nv));
            let g = DMatrix::from_row_slice(m, r, &noise.vector(m * r)) * base;
            let masses: Vec<f64> = (0..nv).map(|_| 10f64.powf(3.0 * noise.next())).collect();
            let rows = g.transpose().as_slice().to_vec();
            let d = metric(masses, &vec![(0, None); nv]);
            let scale = row_scale(&Sparsity::dense(m, nv), &rows, &d);
            let found = NullSpace::new(&rows, &d, &scale, RANK_TOLERANCE);
            assert_eq!((found.independent.len(), found.dependent.len(), found.mobility), (r, m - r, nv - r));
            let basis = DMatrix::from_row_slice(nv, nv - r, &found.basis);
            assert!((&g * &basis).norm() < 1e-9 * g.norm() * basis.norm(), "{:e}", (&g * &basis).norm());
            let gram = basis.transpose() * DMatrix::from_diagonal(&d.clone().into()) * &basis;
            assert!((gram - DMatrix::identity(nv - r, nv - r)).norm() < 1e-12);
            let rows = scaled_rows(&rows, &d, &scale);
            let mut values = Svd::new(&DMatrix::from_fn(m, nv, |i, j| rows[i][j])).values;
            values.sort_by(|x, y| y.total_cmp(x));
            assert_eq!(values.len(), m);
            assert!(values[r - 1] > 1e-4 && values[r] < 1e-12, "{values:?}");
        }
    }

    #[test]
    fn many_sparse_rows_are_judged_as_by_orthogonal_rows() {
        // a band in which every fifth row is made of the two before it; masses of several sizes
        let (m, nv) = (180, 200);
        let mut noise = Noise(8);
        let mut g = Block::new(&Sparsity::new(m, nv, (0..m).flat_map(|i| (i.saturating_sub(2)..i + 4).map(move |j| (i, j)))));
        for i in 0..m {
            for j in i..i + 4 {
                g.set(i, j, noise.next());
            }
            if i % 5 == 4 {
                (i.saturating_sub(2)..i + 4).for_each(|j| g.set(i, j, 2.0 * g.at(i - 1, j) - 0.5 * g.at(i - 2, j)));
            }
        }
        let metric: Vec<f64> = (0..nv).map(|_| 10f64.powf(noise.next())).collect();
        let scale = row_scale(g.pattern(), g.values(), &metric);
        let (sparse, dense) = (Rank::new(&g, &metric, &scale, 1e-8), NullSpace::new(&g.to_dense(), &metric, &scale, 1e-8));
        assert!(matches!(sparse.motions, Motions::Eliminated(..)));
        assert_eq!((sparse.rank, sparse.mobility, sparse.dependent.len()), (dense.independent.len(), dense.mobility, m / 5));
        assert_eq!(sparse.dependent, (4..m).step_by(5).collect::<Vec<_>>());
        let v = sparse.motion(&vec![1.0; sparse.mobility]);
        let size = v.iter().fold(0.0, |m, x| f64::max(m, x.abs()));
        assert!(g.lines().all(|line| line.dot(&v).abs() < 1e-10 * size));
        // without rows all is free, and nothing of the size nv² is made
        let free = Rank::new(&Block::new(&Sparsity::empty(0, nv)), &metric, &[], 1e-8);
        assert_eq!((free.mobility, free.motion(&metric)[3]), (nv, metric[3].sqrt()));
    }

    #[test]
    fn rows_of_round_off_constrain_nothing() {
        let mut noise = Noise(5);
        let (nv, m) = (3, 5);
        let metric = [2.0, 1e-3, 40.0];
        for size in [1.0, 1e-6, 1e6] {
            let natural = vec![size; m * nv];
            let scale = |g: &[f64]| natural_row_scale(&Sparsity::dense(m, nv), g, &natural, &metric);
            let round_off: Vec<f64> = noise.vector(m * nv).iter().map(|x| 1e-15 * size * x).collect();
            let found = NullSpace::new(&round_off, &metric, &scale(&round_off), RANK_TOLERANCE);
            assert_eq!((found.independent.len(), found.mobility, found.dependent.len()), (0, 3, 5));
            // rows as small as can be told from it constrain, alone and beside others
            for small in [1e-9, 1e-3] {
                let mut g = round_off.clone();
                g[3..6].copy_from_slice(&[0.0, small * size, 0.0]);
                assert_eq!(NullSpace::new(&g, &metric, &scale(&g), RANK_TOLERANCE).independent, [1]);
                g[9..12].copy_from_slice(&[size, size, size]);
                let found = NullSpace::new(&g, &metric, &scale(&g), RANK_TOLERANCE);
                assert_eq!((found.independent.len(), found.dependent), (2, vec![0, 2, 4]));
            }
        }
    }

    #[test]
    fn far_from_where_they_were_scaled_each_row_is_judged_by_itself() {
        // scaled where the first row was a millionth of what it is here
        let g = [1e6, 0.0, 0.0, 1e6, 1e-9, 0.0, 0.0, 0.0, 0.1];
        assert_eq!(NullSpace::new(&g, &[1.0; 3], &[1.0; 3], RANK_TOLERANCE).dependent, [1]);
    }

    #[test]
    fn nothing_is_a_matrix_too() {
        assert_eq!(rank(&[], 2).basis, [1.0, 0.0, 0.0, 1.0]);
        assert_eq!(rank(&[0.0, 0.0], 2).dependent, [0]);
        // the row along neither of the others is kept last
        assert_eq!(rank(&[1.0, 0.0, 1.0, 1.0, 0.0, 1.0], 2).dependent, [1]);
    }
}
