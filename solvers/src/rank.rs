//! Rank of the constraint rows at assembly: which rows are redundant, and which motions are left.

/// Length that a scaled row must keep beside the others, unless the caller knows better; sound rows have the length 1.
pub const RANK_TOLERANCE: f64 = 1e-8;

/// What the constraint rows G (m × nv) amount to in one position.
///
/// Everything is taken of Ĝ = diag(g_scale)^−½ G D^−½, so that neither units nor mass ratios decide what is redundant.
#[derive(Clone, Debug, PartialEq)]
pub struct Rank {
    /// Number of independent rows.
    pub rank: usize,
    /// Independent rows, in the order they were chosen.
    pub independent: Vec<usize>,
    /// Rows that depend on the others, rising; of equally good rows the later ones are named.
    pub dependent: Vec<usize>,
    /// A basis of the motions with G v = 0 (nv × dof, row-major), orthonormal in D.
    pub null_space: Vec<f64>,
    /// Velocities that can serve as independent ones, in the order they were chosen (dof).
    pub freedoms: Vec<usize>,
}

impl Rank {
    /// Rank-revealing orthogonalisation of the rows.
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
            let null_space = (0..nv * nv).map(|k| if k % (nv + 1) == 0 { metric[k / nv].sqrt().recip() } else { 0.0 }).collect();
            return Self { rank: 0, independent: Vec::new(), dependent: Vec::new(), null_space, freedoms: (0..nv).collect() };
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
        let mut freedoms = Vec::new();
        let mut columns: Vec<usize> = (0..nv).collect();
        while basis.len() < nv {
            let distance = |j: &usize| (1.0 - basis.iter().map(|b| b[*j] * b[*j]).sum::<f64>()).max(0.0);
            let Some(next) = longest(columns.iter().map(distance), -1.0) else { break };
            let chosen = columns.remove(next);
            freedoms.push(chosen);
            let mut e = vec![0.0; nv];
            e[chosen] = 1.0;
            orthogonalize(&mut e, &basis);
            basis.push(unit(e, &basis));
        }
        let null_space = (0..nv).flat_map(|i| basis[rank..].iter().map(move |b| b[i] / metric[i].sqrt())).collect();
        Self { rank, independent, dependent: left, null_space, freedoms }
    }

    /// Degrees of freedom, nv − rank.
    pub fn mobility(&self) -> usize {
        self.freedoms.len()
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

    fn rank(g: &[f64], nv: usize) -> Rank {
        let metric = vec![1.0; nv];
        Rank::new(g, &metric, &row_scale(&Sparsity::dense(g.len() / nv, nv), g, &metric), RANK_TOLERANCE)
    }

    #[test]
    fn later_copies_of_a_row_are_named() {
        let found = rank(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -2.0, 0.0, 0.0, 3.0, 1.0, 0.0], 3);
        assert_eq!((found.rank, found.mobility()), (2, 1));
        assert_eq!(found.dependent, [2, 3]);
        assert_eq!(found.freedoms, [2]);
        assert_eq!(found.null_space, [0.0, 0.0, 1.0]);
    }

    #[test]
    fn without_rows_every_velocity_is_free() {
        let metric = [4.0, 1.0, 0.25];
        let found = Rank::new(&[], &metric, &[], RANK_TOLERANCE);
        // a row of round-off is none, and takes the long way to the same
        let long = Rank::new(&[1e-30; 3], &metric, &[1.0], RANK_TOLERANCE);
        assert_eq!((found.rank, &found.freedoms), (0, &vec![0, 1, 2]));
        assert_eq!((found.null_space, found.freedoms), (long.null_space, long.freedoms));
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
            let d = metric(masses, &vec![0; nv]);
            let scale = row_scale(&Sparsity::dense(m, nv), &rows, &d);
            let found = Rank::new(&rows, &d, &scale, RANK_TOLERANCE);
            assert_eq!((found.rank, found.dependent.len(), found.mobility()), (r, m - r, nv - r));
            let basis = DMatrix::from_row_slice(nv, nv - r, &found.null_space);
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
    fn rows_of_round_off_constrain_nothing() {
        let mut noise = Noise(5);
        let (nv, m) = (3, 5);
        let metric = [2.0, 1e-3, 40.0];
        for size in [1.0, 1e-6, 1e6] {
            let natural = vec![size; m * nv];
            let scale = |g: &[f64]| natural_row_scale(&Sparsity::dense(m, nv), g, &natural, &metric);
            let round_off: Vec<f64> = noise.vector(m * nv).iter().map(|x| 1e-15 * size * x).collect();
            let found = Rank::new(&round_off, &metric, &scale(&round_off), RANK_TOLERANCE);
            assert_eq!((found.rank, found.mobility(), found.dependent.len()), (0, 3, 5));
            // rows as small as can be told from it constrain, alone and beside others
            for small in [1e-9, 1e-3] {
                let mut g = round_off.clone();
                g[3..6].copy_from_slice(&[0.0, small * size, 0.0]);
                assert_eq!(Rank::new(&g, &metric, &scale(&g), RANK_TOLERANCE).independent, [1]);
                g[9..12].copy_from_slice(&[size, size, size]);
                let found = Rank::new(&g, &metric, &scale(&g), RANK_TOLERANCE);
                assert_eq!((found.rank, found.dependent), (2, vec![0, 2, 4]));
            }
        }
    }

    #[test]
    fn far_from_where_they_were_scaled_each_row_is_judged_by_itself() {
        // scaled where the first row was a millionth of what it is here
        let g = [1e6, 0.0, 0.0, 1e6, 1e-9, 0.0, 0.0, 0.0, 0.1];
        assert_eq!(Rank::new(&g, &[1.0; 3], &[1.0; 3], RANK_TOLERANCE).dependent, [1]);
    }

    #[test]
    fn nothing_is_a_matrix_too() {
        assert_eq!(rank(&[], 2).null_space, [1.0, 0.0, 0.0, 1.0]);
        assert_eq!(rank(&[0.0, 0.0], 2).dependent, [0]);
        // the row along neither of the others is kept last
        assert_eq!(rank(&[1.0, 0.0, 1.0, 1.0, 0.0, 1.0], 2).dependent, [1]);
    }
}
