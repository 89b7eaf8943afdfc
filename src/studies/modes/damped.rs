//! Damped modes: complex eigenvalues μ of the state matrix of a linear motion.
//!
//! ```text
//! M ü + C u̇ + K u + R δz = 0,   δż = Z_q u + Z_v u̇ + Z_z δz
//! ```
//!
//! A pair μ = −ζω ± iω√(1 − ζ²) is an oscillation with the damping ratio ζ = −Re μ/|μ|, which is negative where it grows.

use crate::kinematics::held::Held;
use crate::numerics::eigenvalues::{eigenvalues, eigenvector, measurable, of_each_pair};
use nalgebra::{Complex, DMatrix, DVector};

/// Part of the largest stiffness against inertia below which a motion is free.
const FREE: f64 = 1e-12;

/// One of each pair of complex eigenvalues, and every real one.
#[derive(Clone, Debug)]
pub struct Damped {
    /// Eigenvalue, 1/s; its imaginary part is not negative.
    pub value: Complex<f64>,
    /// Its coordinates (n), the largest of them 1.
    pub shape: DVector<Complex<f64>>,
}

/// Re μ above this part of |μ| is growth.
const GROWS: f64 = 1e-8;

impl Damped {
    /// Whether it grows; one with |μ| ≤ `zero` is a free motion.
    pub(super) fn grows(&self, zero: f64) -> bool {
        self.value.norm() > zero && self.value.re > GROWS * self.value.norm()
    }

    /// ζ = −Re μ/|μ|; 1 for a real eigenvalue that decays, NaN for 0.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        -self.value.re / self.value.norm()
    }
}

/// The state matrix of (u, u̇, δz) (order 2n + nz); `with_damping` false leaves out C. None if M is not positive definite.
#[must_use]
pub fn state_matrix(held: &Held, with_damping: bool) -> Option<DMatrix<f64>> {
    let (n, nz) = (held.mass.nrows(), held.z_z.nrows());
    let factor = held.mass.clone().cholesky()?;
    let mut a = DMatrix::zeros(2 * n + nz, 2 * n + nz);
    a.view_mut((0, n), (n, n)).fill_with_identity();
    a.view_mut((n, 0), (n, n)).copy_from(&-factor.solve(&held.stiffness));
    if with_damping {
        a.view_mut((n, n), (n, n)).copy_from(&-factor.solve(&held.damping));
        a.view_mut((n, 2 * n), (n, nz)).copy_from(&-factor.solve(&held.r_z));
        a.view_mut((2 * n, 0), (nz, n)).copy_from(&held.z_q);
        a.view_mut((2 * n, n), (nz, n)).copy_from(&held.z_v);
        a.view_mut((2 * n, 2 * n), (nz, nz)).copy_from(&held.z_z);
    }
    Some(a)
}

/// Eigenvalues of a state matrix of which the first `n` states are coordinates, by rising |μ|: one of each complex pair.
///
/// Vectors come from inverse iteration.
///
/// None if the matrix is beyond what they can be found of, as [`eigenvalues`] says.
#[must_use]
pub fn damped(a: &DMatrix<f64>, n: usize) -> Option<Vec<Damped>> {
    if a.is_empty() {
        return Some(Vec::new());
    }
    if !measurable(a) {
        return None;
    }
    let mut values = of_each_pair(eigenvalues(a)?);
    values.sort_by(|x, y| x.norm().total_cmp(&y.norm()).then(x.re.total_cmp(&y.re)));
    let shape = |i, value| by_largest(&eigenvector(a, value, i).rows(0, n).into_owned());
    Some(values.into_iter().enumerate().map(|(i, value)| Damped { shape: shape(i, value), value }).collect())
}

/// Gives modes without a rate, |μ| ≤ `zero`, the free motions that the stiffness (n × n) leaves as their shapes, one after the other: inverse
/// iteration gives any mixture of them. Each has coordinates of its own, as far as there are such.
pub(super) fn tell_free_apart(found: &mut [Damped], held: &Held, zero: f64) {
    let free = free_motions(held);
    let at_rest = found.iter_mut().filter(|mode| mode.value.norm() <= zero);
    for (mode, motion) in at_rest.zip(free.iter().cycle()) {
        mode.shape = by_largest(&motion.map(Complex::from));
    }
}

/// A basis of the motions with K x = 0, each 1 in a coordinate in which the others are 0.
fn free_motions(held: &Held) -> Vec<DVector<f64>> {
    let n = held.mass.nrows();
    if n == 0 {
        return Vec::new();
    }
    let unit = held.mass.diagonal().map(|m| m.sqrt().recip());
    let scaled = DMatrix::from_fn(n, n, |i, j| unit[i] * held.stiffness[(i, j)] * unit[j]);
    let svd = scaled.svd(false, true);
    let Some(turned) = &svd.v_t else { return Vec::new() };
    let least = FREE * svd.singular_values.iter().copied().fold(0.0, f64::max);
    let rows = svd.singular_values.iter().enumerate().filter(|(_, size)| **size <= least);
    let mut basis: Vec<DVector<f64>> = rows.map(|(i, _)| turned.row(i).transpose().component_mul(&unit)).collect();
    let mut taken = Vec::new();
    for k in 0..basis.len() {
        let sizes = (0..n).filter(|i| !taken.contains(i)).map(|i| (i, basis[k][i].abs() / unit[i]));
        let Some((pivot, _)) = sizes.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        taken.push(pivot);
        let own = &basis[k] / basis[k][pivot];
        for (_, x) in basis.iter_mut().enumerate().filter(|(other, _)| *other != k) {
            let part = x[pivot];
            *x -= &own * part;
        }
        basis[k] = own;
    }
    basis
}

/// A shape by the largest of its coordinates, which becomes 1.
pub(super) fn by_largest(x: &DVector<Complex<f64>>) -> DVector<Complex<f64>> {
    let largest = x.iter().fold(Complex::default(), |m: Complex<f64>, x| if x.norm() > m.norm() * (1.0 + 1e-9) { *x } else { m });
    if largest.norm() > 0.0 { x.map(|x| x / largest) } else { x.clone() }
}
