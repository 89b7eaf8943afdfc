//! Singular values by rotations.
//!
//! Columns of A are rotated in pairs until all are orthogonal: A V = U Σ (Hestenes, J. SIAM 6 (1958) 51-90; that small singular
//! values keep their digits: Demmel & Veselić, SIAM J. Matrix Anal. Appl. 13 (1992) 1204-1245). nalgebra's own decomposition is not
//! used: where some entries are round-off beside others, as in the rows of a mechanism in a symmetric position, U Σ Vᵀ is off from A
//! by up to 0.7 in 0.4 % of small random matrices (measured, version 0.35).

use nalgebra::DMatrix;

/// Sweeps over all pairs at most; some six to ten do.
const SWEEPS: usize = 60;

/// A (m × n) = U diag(σ) Vᵀ with k = min(m, n).
#[derive(Clone, Debug, PartialEq)]
pub struct Svd {
    /// U (m × k): orthonormal columns; a column of zeros where σ is 0.
    pub u: DMatrix<f64>,
    /// σ (k), in no special order.
    pub values: Vec<f64>,
    /// V (n × k).
    pub v: DMatrix<f64>,
}

impl Svd {
    /// Decomposes a matrix; what is not finite gives values that are not finite.
    pub fn new(a: &DMatrix<f64>) -> Self {
        if a.nrows() < a.ncols() {
            let Self { u, values, v } = Self::tall(a.transpose());
            return Self { u: v, values, v: u };
        }
        Self::tall(a.clone())
    }

    fn tall(mut w: DMatrix<f64>) -> Self {
        let n = w.ncols();
        let mut v = DMatrix::identity(n, n);
        let mut squares: Vec<f64> = w.column_iter().map(|c| c.norm_squared()).collect();
        for _ in 0..SWEEPS {
            let mut rotated = false;
            for p in 0..n {
                for q in p + 1..n {
                    let (a, b, c) = (squares[p], squares[q], w.column(p).dot(&w.column(q)));
                    if c.abs() > f64::EPSILON * (a * b).sqrt() {
                        rotated = true;
                        let zeta = (b - a) / (2.0 * c);
                        // where ζ² overflows the angle is none
                        let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                        let cos = (1.0 + t * t).sqrt().recip();
                        rotate(&mut w, p, q, [cos, cos * t]);
                        rotate(&mut v, p, q, [cos, cos * t]);
                        (squares[p], squares[q]) = (w.column(p).norm_squared(), w.column(q).norm_squared());
                    }
                }
            }
            if !rotated {
                break;
            }
        }
        let values: Vec<f64> = w.column_iter().map(|c| c.norm()).collect();
        for (mut column, s) in w.column_iter_mut().zip(&values) {
            if *s > 0.0 {
                column /= *s;
            }
        }
        Self { u: w, values, v }
    }

    /// The largest σ; 0 of nothing.
    pub fn largest(&self) -> f64 {
        self.values.iter().fold(0.0, |m, s| f64::max(m, *s))
    }

    /// x (n) = V f(σ) Uᵀ b: `f` is 1/σ, or what stands for it.
    pub fn solve(&self, b: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut x = vec![0.0; self.v.nrows()];
        for (k, s) in self.values.iter().enumerate() {
            let part = f(*s) * self.u.column(k).iter().zip(b).map(|(u, b)| u * b).sum::<f64>();
            x.iter_mut().zip(self.v.column(k).iter()).for_each(|(x, v)| *x += part * v);
        }
        x
    }
}

/// Columns p and q become c p − s q and s p + c q.
fn rotate(x: &mut DMatrix<f64>, p: usize, q: usize, [c, s]: [f64; 2]) {
    for i in 0..x.nrows() {
        let (a, b) = (x[(i, p)], x[(i, q)]);
        x[(i, p)] = c * a - s * b;
        x[(i, q)] = s * a + c * b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::Noise;

    /// Entries are numbers, zeros, or of the size of round-off.
    fn uneven(noise: &mut Noise, m: usize, n: usize) -> DMatrix<f64> {
        DMatrix::from_fn(m, n, |_, _| {
            let (kind, x) = (noise.next(), noise.next());
            match kind {
                k if k < -0.5 => 0.0,
                k if k < 0.0 => x * 10f64.powf(-15.0 + 6.0 * k),
                _ => x,
            }
        })
    }

    #[test]
    fn the_product_is_the_matrix_whatever_the_sizes_of_its_entries() {
        let mut noise = Noise(5);
        for k in 0..20_000 {
            let a = uneven(&mut noise, 1 + k % 5, 1 + (k / 5) % 4);
            let Svd { u, values, v } = Svd::new(&a);
            let product = &u * DMatrix::from_diagonal(&values.clone().into()) * v.transpose();
            assert!((product - &a).norm() < 1e-14 * (1.0 + a.norm()), "{a}");
            for (k, s) in values.iter().enumerate().filter(|(_, s)| **s > 1e-12) {
                assert!((u.column(k).norm() - 1.0).abs() < 1e-14 && (v.column(k).norm() - 1.0).abs() < 1e-14, "{s}");
            }
        }
    }

    #[test]
    fn small_values_keep_their_digits() {
        let a = DMatrix::from_row_slice(3, 2, &[1.0, 1.0, 1e-9, 0.0, 0.0, 1e-9]);
        let mut values = Svd::new(&a).values;
        values.sort_by(f64::total_cmp);
        assert!((values[0] / 1e-9 - 1.0).abs() < 1e-12 && (values[1] / 2f64.sqrt() - 1.0).abs() < 1e-15, "{values:?}");
    }

    #[test]
    fn the_shortest_solution() {
        let a = DMatrix::from_row_slice(2, 3, &[1.0, 1.0, 0.0, 2.0, 2.0, 0.0]);
        let x = Svd::new(&a).solve(&[2.0, 4.0], |s| if s > 1e-9 { 1.0 / s } else { 0.0 });
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 1.0).abs() < 1e-15 && x[2] == 0.0, "{x:?}");
        assert!(Svd::new(&DMatrix::zeros(0, 3)).values.is_empty());
    }
}
