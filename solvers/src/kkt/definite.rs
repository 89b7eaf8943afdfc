//! A = L D Lᵀ of a full quasi-definite matrix; up to 12 unknowns for sizes known to the compiler.
//!
//! [M Gᵀ; G −E] with M and E positive definite has L D Lᵀ in any order without a search for pivots, D positive in the rows of M and
//! negative in the others (Vanderbei, SIAM J. Optim. 5 (1995) 100-113). It is half the work of an elimination with pivots and has
//! no branch but the test of the pivots; what small pivots of M cost in digits is won back by the refinement that follows.

use super::Blocks;
use super::dense::{dot, sized, square, square_mut};
use crate::sparsity::DENSE_UP_TO;

/// Pivots of the scaled M, whose diagonal is about one, that are smaller count as no mass: an elimination with pivots is needed.
pub(super) const MASSLESS: f64 = 1e-7;

/// A residual of four roundings of the largest unknown needs no correction: the scaled matrix has entries of about one.
const REFINED: f64 = 4.0 * f64::EPSILON;

/// Whether a residual asks for one more correction.
#[inline]
pub(super) fn refines(r: &[f64], x: &[f64]) -> bool {
    let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| if x.abs() > m { x.abs() } else { m });
    largest(r) > REFINED * largest(x)
}

/// An entry of M, on its diagonal or below it, or of G.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Its place in the values of its block.
    from: u32,
    /// Its place in the matrix, and that across the diagonal.
    places: [u32; 2],
    /// Product of the scales of its row and column.
    product: f64,
}

/// A full matrix with its factors.
#[derive(Clone, Debug)]
pub(super) struct Definite {
    /// Entries of M and of G; none of more than [`DENSE_UP_TO`] unknowns, which are scaled row by row.
    entries: [Vec<Entry>; 2],
    /// Scaled [M Gᵀ; G 0] (n × n).
    matrix: Vec<f64>,
    /// L below the diagonal, or Lᵀ above it where the size is not known to the compiler (n × n), and 1/D (n).
    l: Vec<f64>,
    inverse: Vec<f64>,
    scale: Vec<f64>,
    /// Right-hand side; residual or correction (n); of sizes that are not known to the compiler.
    rhs: Vec<f64>,
    r: Vec<f64>,
}

impl Definite {
    /// Room for the matrix of two blocks.
    pub(super) fn new(blocks: &Blocks) -> Self {
        let n = blocks.order();
        let (square, vector) = (vec![0.0; n * n], vec![0.0; n]);
        let entries = [(0, 0), (1, blocks.velocities())].map(|(block, shift)| {
            let places = blocks.0[block].places().enumerate();
            let below = places.map(|(from, (i, j))| (from, i + shift, j)).filter(|(_, i, j)| i >= j && n <= DENSE_UP_TO);
            below.map(|(from, i, j)| Entry { from: from as u32, places: [i * n + j, j * n + i].map(|x| x as u32), product: 1.0 }).collect()
        });
        Self { entries, matrix: square.clone(), l: square, inverse: vector.clone(), scale: vec![1.0; n], rhs: vector.clone(), r: vector }
    }

    /// Takes the scales of the unknowns (n).
    pub(super) fn set_scale(&mut self, scale: &[f64]) {
        self.scale.copy_from_slice(scale);
        for entry in self.entries.iter_mut().flatten() {
            let (i, j) = (entry.places[0] as usize / scale.len(), entry.places[0] as usize % scale.len());
            entry.product = scale[i] * scale[j];
        }
    }

    /// Scales M and G, given by the values of their patterns, and factors the matrix with the scaled E (m); false if M is nearly singular, or
    /// a number is not finite.
    pub(super) fn factor(&mut self, blocks: &Blocks, values: [&[f64]; 2], e: &[f64]) -> bool {
        let (nv, n) = (blocks.velocities(), blocks.order());
        if n > DENSE_UP_TO {
            blocks.fill(values, &self.scale, &mut self.matrix);
        }
        for (entries, values) in self.entries.iter().zip(values) {
            for Entry { from, places: [place, across], product } in entries {
                let x = values[*from as usize] * product;
                self.matrix[*place as usize] = x;
                self.matrix[*across as usize] = x;
            }
        }
        self.l.copy_from_slice(&self.matrix);
        for (j, e) in e.iter().enumerate() {
            self.l[(nv + j) * (n + 1)] = -e;
        }
        macro_rules! small {
            ($k:literal) => {
                match (square_mut::<f64, $k>(&mut self.l), self.inverse.first_chunk_mut()) {
                    (Some(l), Some(inverse)) => factor::<$k>(l, inverse, nv),
                    _ => false,
                }
            };
        }
        sized!(n, small, factor_large(nv, &mut self.l, &mut self.inverse))
    }

    /// x := A⁻¹ x (n), with as many `refinements` against the matrix without E (m) as the residual asks for.
    pub(super) fn solve(&mut self, e: &[f64], x: &mut [f64], refinements: usize) {
        macro_rules! small {
            ($k:literal) => {
                if let (Some(matrix), Some(l), Some(inverse), Some(x)) =
                    (square::<f64, $k>(&self.matrix), square::<f64, $k>(&self.l), self.inverse.first_chunk(), x.first_chunk_mut())
                {
                    refined::<$k>([matrix, l], inverse, e, x, refinements);
                }
            };
        }
        sized!(self.inverse.len(), small, self.refined_large(e, x, refinements));
    }

    /// [`refined`] of a size that is not known to the compiler.
    fn refined_large(&mut self, e: &[f64], x: &mut [f64], refinements: usize) {
        let (n, nv) = (x.len(), x.len() - e.len());
        self.rhs.copy_from_slice(x);
        solve_large(&self.l, &self.inverse, x);
        if refinements == 0 {
            return;
        }
        self.r[..nv].fill(0.0);
        self.r[nv..].iter_mut().zip(&x[nv..]).zip(e).for_each(|((r, x), e)| *r = -e * x);
        for left in (0..refinements).rev() {
            solve_large(&self.l, &self.inverse, &mut self.r);
            x.iter_mut().zip(&self.r).for_each(|(x, r)| *x += r);
            if left == 0 {
                break;
            }
            for ((r, b), row) in self.r.iter_mut().zip(&self.rhs).zip(self.matrix.chunks_exact(n)) {
                *r = b - dot(row, x);
            }
            if !refines(&self.r, x) {
                break;
            }
        }
    }
}

/// Factors the lower triangle of `a` in place: L below the diagonal, and 1/D. `positive` rows come first.
///
/// False if M is nearly singular, or a number is not finite.
#[inline]
fn factor<const N: usize>(a: &mut [[f64; N]; N], inverse: &mut [f64; N], positive: usize) -> bool {
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

/// Factors the upper triangle of `a` (n × n) in place by rows: Lᵀ above the diagonal, and 1/D; as [`factor`].
fn factor_large(positive: usize, a: &mut [f64], inverse: &mut [f64]) -> bool {
    let n = inverse.len();
    for k in 0..n {
        let (done, rest) = a.split_at_mut((k + 1) * n);
        let row = &mut done[k * n..];
        let d = row[k];
        if !(if k < positive { d > MASSLESS && d < f64::INFINITY } else { d < 0.0 && d > f64::NEG_INFINITY }) {
            return false;
        }
        let inv = 1.0 / d;
        inverse[k] = inv;
        for (below, i) in rest.chunks_exact_mut(n).zip(k + 1..n) {
            // a_ij −= l_ik u_kj
            let l = row[i] * inv;
            if l != 0.0 {
                below[i..].iter_mut().zip(&row[i..]).for_each(|(a, u)| *a -= l * u);
            }
        }
        row[k + 1..].iter_mut().for_each(|u| *u *= inv);
    }
    true
}

/// b := L⁻ᵀ D⁻¹ L⁻¹ b by the rows of Lᵀ.
fn solve_large(l: &[f64], inverse: &[f64], b: &mut [f64]) {
    let n = b.len();
    for (k, row) in l.chunks_exact(n).enumerate() {
        let x = b[k];
        b[k + 1..].iter_mut().zip(&row[k + 1..]).for_each(|(b, l)| *b -= l * x);
    }
    for (k, row) in l.chunks_exact(n).enumerate().rev() {
        b[k] = b[k] * inverse[k] - dot(&row[k + 1..], &b[k + 1..]);
    }
}

/// b := L⁻ᵀ D⁻¹ L⁻¹ b.
#[inline]
fn solve<const N: usize>(l: &[[f64; N]; N], inverse: &[f64; N], b: &mut [f64; N]) {
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

/// b := the solution with the right-hand side b, refined as often as the residual asks for, at most `refinements` times, against `matrix`
/// (symmetric, N × N), which is without E (m).
#[inline]
fn refined<const N: usize>([matrix, l]: [&[[f64; N]; N]; 2], inverse: &[f64; N], e: &[f64], b: &mut [f64; N], refinements: usize) {
    let rhs = *b;
    solve(l, inverse, b);
    if refinements == 0 {
        return;
    }
    // what E has done, all at once: the residual of this solution is −Eλ
    let mut r = [0.0; N];
    let nv = N - e.len();
    for ((r, x), e) in r[nv..].iter_mut().zip(&b[nv..]).zip(e) {
        *r = -e * x;
    }
    for left in (0..refinements).rev() {
        solve(l, inverse, &mut r);
        for i in 0..N {
            b[i] += r[i];
        }
        if left == 0 {
            break;
        }
        r = rhs;
        for j in 0..N {
            let x = b[j];
            for i in 0..N {
                // symmetric: row j is column j
                r[i] -= matrix[j][i] * x;
            }
        }
        if !refines(&r, b) {
            break;
        }
    }
}
