//! How nearly rows are dependent at the start, redundant ones apart.

use crate::rank::{RANK_TOLERANCE, Rank};
use crate::{Block, Kkt, Sparsity};

/// σ below which E hides what a value is, and whether it is one of redundant rows.
const HIDDEN: f64 = 1e-3;

/// The smallest singular value of diag(G D⁻¹ Gᵀ)^−½ G D^−½ that is not of redundant rows, with D (nv) the `metric`, diag(G D⁻¹ Gᵀ) (m) the
/// `row_scale` and `g` G at the start; 1 without rows. Values below [`RANK_TOLERANCE`] count as those of redundant rows. Factors `kkt` anew,
/// and allocates.
///
/// Where a value is hidden it is that of independent rows alone, without E: of redundant rows another choice would have another one, by
/// a factor of about their number's root.
pub fn weakest(kkt: &mut Kkt, metric: &[f64], row_scale: &[f64], g: &Block) -> f64 {
    let (smallest, moving) = kkt.weakest(metric, g.values());
    if smallest > HIDDEN {
        return moving;
    }
    let dependent = Rank::new(g, metric, row_scale, RANK_TOLERANCE).dependent;
    let independent: Vec<usize> = (0..row_scale.len()).filter(|row| dependent.binary_search(row).is_err()).collect();
    let rows = g.select_rows(&independent);
    let scale: Vec<f64> = independent.iter().map(|row| row_scale[*row]).collect();
    let diagonal = Sparsity::new(metric.len(), metric.len(), (0..metric.len()).map(|i| (i, i)));
    let mut kkt = Kkt::of_blocks(&diagonal, rows.pattern());
    kkt.set_scale(metric, &scale);
    let exact = kkt.weakest_of_independent(metric, rows.values());
    if exact < HIDDEN { exact } else { moving }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kkt::{metric, row_scale};
    use crate::noise::Noise;
    use crate::svd::Svd;
    use nalgebra::DMatrix;

    /// Rows of which two are dependent but for ε, alone and beside copies of others.
    #[test]
    fn nearly_dependent_rows_are_told_from_redundant_ones() {
        let mut noise = Noise(23);
        for trial in 0..60 {
            let (nv, m) = (9, 5);
            let epsilon = 10f64.powi(-(trial % 7));
            let mut rows: Vec<Vec<f64>> = (0..m).map(|_| noise.vector(nv)).collect();
            let off = noise.vector(nv);
            rows[1] = rows[0].iter().zip(&off).map(|(x, y)| 1.7 * x + epsilon * y).collect();
            let independent = rows.concat();
            if trial >= 30 {
                rows.push(rows[3].iter().zip(&rows[4]).map(|(x, y)| x - 2.0 * y).collect());
                rows.push(rows[2].clone());
            }
            let mass: Vec<f64> = (0..nv).map(|i| 10f64.powi(i as i32 % 5 - 2)).collect();
            let d = metric(mass.iter().copied(), &vec![(0, None); nv]);
            let mut g = Block::full(rows.len(), nv);
            g.values_mut().copy_from_slice(&rows.concat());
            let scale = row_scale(g.pattern(), g.values(), &d);
            let mut kkt = Kkt::of_blocks(&Sparsity::dense(nv, nv), g.pattern());
            kkt.set_scale(&d, &scale);
            let found = weakest(&mut kkt, &d, &scale, &g);
            let scaled = DMatrix::from_fn(m, nv, |i, j| independent[i * nv + j] / (scale[i] * d[j]).sqrt());
            let right = Svd::new(&scaled).values.iter().copied().fold(f64::INFINITY, f64::min);
            assert!((0.4..2.5).contains(&(found / right)), "trial {trial}: {found:e}, right is {right:e}");
        }
    }
}
