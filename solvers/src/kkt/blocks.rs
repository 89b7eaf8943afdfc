//! The patterns of M and G, and of the matrix that is made of them.

use crate::Sparsity;

/// The patterns of M (nv × nv) and G (m × nv).
#[derive(Clone, Debug)]
pub(super) struct Blocks(pub(super) [Sparsity; 2]);

impl Blocks {
    /// Number of velocities.
    pub(super) fn velocities(&self) -> usize {
        self.0[1].columns()
    }

    /// Number of unknowns n = nv + m.
    pub(super) fn order(&self) -> usize {
        self.0[1].columns() + self.0[1].rows()
    }

    /// Whether every entry is in both patterns, of which M has some.
    pub(super) fn are_full(&self) -> bool {
        self.velocities() > 0 && self.0.iter().all(Sparsity::is_full)
    }

    /// The pattern of [M Gᵀ; G −E].
    pub(super) fn whole(&self) -> Sparsity {
        let [mass, g] = &self.0;
        let (nv, n) = (self.velocities(), self.order());
        if g.rows() == 0 {
            return mass.clone();
        }
        let rows = g.places().flat_map(|(i, j)| [(nv + i, j), (j, nv + i)]);
        Sparsity::new(n, n, mass.places().chain(rows).chain((nv..n).map(|i| (i, i))))
    }

    /// The scaled [M Gᵀ; G 0] (n × n, row-major) of the values of both blocks; entries outside of the patterns stay as they are.
    pub(super) fn fill(&self, [mass, g]: [&[f64]; 2], scale: &[f64], matrix: &mut [f64]) {
        let (nv, n) = (self.velocities(), self.order());
        let (d, s) = scale.split_at(nv);
        if self.are_full() {
            let (upper, lower) = matrix.split_at_mut(nv * n);
            for ((out, row), di) in upper.chunks_exact_mut(n).zip(mass.chunks_exact(nv)).zip(d) {
                out.iter_mut().zip(row).zip(d).for_each(|((x, m), dj)| *x = m * di * dj);
            }
            for (i, ((out, row), si)) in lower.chunks_exact_mut(n).zip(g.chunks_exact(nv)).zip(s).enumerate() {
                for (j, ((x, g), dj)) in out.iter_mut().zip(row).zip(d).enumerate() {
                    *x = g * si * dj;
                    upper[j * n + nv + i] = *x;
                }
            }
            return;
        }
        let [of_mass, of_g] = &self.0;
        of_mass.places().zip(mass).for_each(|((i, j), m)| matrix[i * n + j] = m * d[i] * d[j]);
        for ((i, j), g) in of_g.places().zip(g) {
            let x = g * s[i] * d[j];
            matrix[(nv + i) * n + j] = x;
            matrix[j * n + nv + i] = x;
        }
    }
}
