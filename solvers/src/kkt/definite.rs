//! A = L D Lᵀ of a quasi-definite matrix, for sizes known to the compiler.
//!
//! [M Gᵀ; G −E] with M and E positive definite has L D Lᵀ in any order without a search for pivots, D positive in the rows of M and
//! negative in the others (Vanderbei, SIAM J. Optim. 5 (1995) 100-113). It is half the work of an elimination with pivots and has
//! no branch but the test of the pivots; what small pivots of M cost in digits is won back by the refinement that follows.

/// Pivots of the scaled M, whose diagonal is about one, that are smaller count as no mass: an elimination with pivots is needed.
const MASSLESS: f64 = 1e-7;

/// Scales full M (nv × nv) and G (m × nv): [M Gᵀ; G 0] into `matrix`, whose lower right block is 0, and the lower triangle of
/// [M Gᵀ; G −E] into `l`. `products` are those of the scales of rows and columns.
#[inline]
pub(super) fn fill<const N: usize>([matrix, l]: [&mut [[f64; N]; N]; 2], products: &[[f64; N]; N], [mass, g, e]: [&[f64]; 3], nv: usize) {
    let (upper, lower) = matrix.split_at_mut(nv);
    for (((row, l), products), mass) in upper.iter_mut().zip(l.iter_mut()).zip(products).zip(mass.chunks_exact(nv)) {
        for ((x, p), m) in row.iter_mut().zip(products).zip(mass) {
            *x = m * p;
        }
        *l = *row;
    }
    for (i, (((row, l), products), g)) in lower.iter_mut().zip(&mut l[nv..]).zip(&products[nv..]).zip(g.chunks_exact(nv)).enumerate() {
        for (j, ((x, p), g)) in row.iter_mut().zip(products).zip(g).enumerate() {
            *x = g * p;
            upper[j][nv + i] = *x;
        }
        *l = *row;
        l[nv + i] = -e[i];
    }
}

/// Factors the lower triangle of `a` in place: L below the diagonal, and 1/D. `positive` rows come first.
///
/// False if M is nearly singular, or a number is not finite.
#[inline]
pub(super) fn factor<const N: usize>(a: &mut [[f64; N]; N], inverse: &mut [f64; N], positive: usize) -> bool {
    let mut sound = true;
    for k in 0..N {
        let d = a[k][k];
        sound &= if k < positive { d > MASSLESS && d < f64::INFINITY } else { d < 0.0 && d > f64::NEG_INFINITY };
        let inv = 1.0 / d;
        inverse[k] = inv;
        let mut column = [0.0; N];
        for i in k + 1..N {
            column[i] = a[i][k];
        }
        for i in k + 1..N {
            let l = column[i] * inv;
            a[i][k] = l;
            for j in k + 1..=i {
                a[i][j] -= l * column[j];
            }
        }
    }
    sound
}

/// b := L⁻ᵀ D⁻¹ L⁻¹ b.
#[inline]
pub(super) fn solve<const N: usize>(l: &[[f64; N]; N], inverse: &[f64; N], b: &mut [f64; N]) {
    for k in 0..N {
        let x = b[k];
        for i in k + 1..N {
            b[i] -= l[i][k] * x;
        }
    }
    for k in 0..N {
        b[k] *= inverse[k];
    }
    for k in (0..N).rev() {
        let x = b[k];
        for i in 0..k {
            b[i] -= l[k][i] * x;
        }
    }
}

/// b := the solution with the right-hand side b, refined against `matrix` (symmetric, N × N).
#[inline]
pub(super) fn refined<const N: usize>(matrix: &[[f64; N]; N], l: &[[f64; N]; N], inverse: &[f64; N], b: &mut [f64; N], refinements: usize) {
    let rhs = *b;
    solve(l, inverse, b);
    for _ in 0..refinements {
        let mut r = rhs;
        for j in 0..N {
            let x = b[j];
            for i in 0..N {
                // symmetric: row j is column j
                r[i] -= matrix[j][i] * x;
            }
        }
        solve(l, inverse, &mut r);
        for i in 0..N {
            b[i] += r[i];
        }
    }
}
