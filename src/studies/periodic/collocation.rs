//! Gauss's collocation for linear equations: four stages, order 8, A-stable (Hairer, Nørsett & Wanner, Solving ODEs I, 2nd ed.,
//! section II.7).
//!
//! Ψ' = A(t) Ψ over a step h from Ψ₀: with nodes c_i, the zeros of Legendre's polynomial on [0, 1], and a_ij = ∫₀^{c_i} ℓ_j,
//! b_j = ∫₀¹ ℓ_j of the Lagrange polynomials ℓ_j on them,
//!
//! ```text
//! K_i = A_i (Ψ₀ + h Σ_j a_ij K_j),    Ψ₁ = Ψ₀ + h Σ_j b_j K_j.
//! ```

use nalgebra::{DMatrix, Matrix4, RowVector4};

/// Stages.
pub(super) const STAGES: usize = 4;

/// The method's numbers.
#[derive(Clone, Debug)]
pub(super) struct Gauss {
    /// Nodes on [0, 1].
    pub(super) nodes: [f64; STAGES],
    a: Matrix4<f64>,
    b: RowVector4<f64>,
}

impl Gauss {
    /// The method.
    pub(super) fn new() -> Self {
        // zeros of P₄: x² = 3/7 ∓ (2/7)√(6/5)
        let root = 2.0 / 7.0 * (6.0_f64 / 5.0).sqrt();
        let (near, far) = ((3.0 / 7.0 - root).sqrt(), (3.0 / 7.0 + root).sqrt());
        let nodes = [-far, -near, near, far].map(|x| 0.5 * (1.0 + x));
        // Σ_j a_ij c_j^k = c_i^(k+1)/(k+1) and Σ_j b_j c_j^k = 1/(k+1), k = 0 … 3, determine a and b
        let powers = Matrix4::from_fn(|j, k| nodes[j].powi(k as i32));
        let whole = |x: f64, k: usize| x.powi(k as i32 + 1) / (k + 1) as f64;
        let inverse = powers.try_inverse().unwrap_or_else(Matrix4::zeros);
        let a = Matrix4::from_fn(|i, k| whole(nodes[i], k)) * inverse;
        let b = RowVector4::from_fn(|_, k| whole(1.0, k)) * inverse;
        Self { nodes, a, b }
    }

    /// Ψ after a step h (s), A at the nodes given; none if the stages have no solution.
    pub(super) fn step(&self, h: f64, a: &[DMatrix<f64>; STAGES], psi: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let (n, columns) = psi.shape();
        let mut stages = DMatrix::identity(STAGES * n, STAGES * n);
        let mut right = DMatrix::zeros(STAGES * n, columns);
        for (i, a) in a.iter().enumerate() {
            right.view_mut((i * n, 0), (n, columns)).copy_from(&(a * psi));
            for j in 0..STAGES {
                let mut block = stages.view_mut((i * n, j * n), (n, n));
                block -= a * (h * self.a[(i, j)]);
            }
        }
        let k = stages.lu().solve(&right)?;
        let mut next = psi.clone();
        for j in 0..STAGES {
            next += k.view((j * n, 0), (n, columns)) * (h * self.b[j]);
        }
        Some(next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_is_eight() {
        // ψ' = 2 t ψ + its companion: exp(t²) and exp(sin t) on the diagonal, a coupling between
        let gauss = Gauss::new();
        let a = |t: f64| DMatrix::from_row_slice(2, 2, &[2.0 * t, 0.0, 1.0, 2.0 * t]);
        let error = |steps: usize| {
            let h = 1.0 / steps as f64;
            let mut psi = DMatrix::identity(2, 2);
            for k in 0..steps {
                psi = gauss.step(h, &gauss.nodes.map(|c| a((k as f64 + c) * h)), &psi).unwrap();
            }
            // Ψ = e^{t²} [1 0; t 1]
            (psi - DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 1.0, 1.0]) * 1.0_f64.exp()).amax()
        };
        let (coarse, fine) = (error(1), error(2));
        let order = (coarse / fine).log2();
        assert!((7.5..9.0).contains(&order), "order {order}: {coarse:e}, {fine:e}");
        // a rounding of Ψ, whose size is e, in each step
        assert!(error(32) < 32.0 * f64::EPSILON * 1.0_f64.exp(), "{:e}", error(32));
    }
}
