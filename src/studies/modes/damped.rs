//! Damped modes: complex eigenvalues μ of the state matrix of a linear motion.
//!
//! ```text
//! M ü + C u̇ + K u + R δz = 0,   δż = Z_q u + Z_v u̇ + Z_z δz
//! ```
//!
//! A pair μ = −ζω ± iω√(1 − ζ²) is an oscillation with the damping ratio ζ = −Re μ/|μ|, which is negative where it grows.

use super::free::Free;
use crate::kinematics::held::Held;
use crate::numerics::eigenvalues::{eigenvalues, eigenvector, measurable, of_each_pair};
use nalgebra::{Complex, DMatrix, DVector};

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
/// Round-off of eigenvalues for each row of the matrix, as part of the largest.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

impl Damped {
    /// Whether it grows.
    pub(super) fn grows(&self) -> bool {
        self.value.re > GROWS * self.value.norm()
    }

    /// A motion (n) that nothing drives back.
    pub(super) fn free(motion: &DVector<f64>) -> Self {
        Self { value: Complex::default(), shape: by_largest(&motion.map(Complex::from)) }
    }

    /// ζ = −Re μ/|μ|; 1 for a real eigenvalue that decays, NaN for 0.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        // of no decay 0, not −0
        -self.value.re / self.value.norm() + 0.0
    }
}

/// The state matrix of (u, u̇, δz) (order 2n + nz); `with_damping` false leaves out C, and holds δz (order 2n). None if M is not positive
/// definite.
#[must_use]
pub fn state_matrix(held: &Held, with_damping: bool) -> Option<DMatrix<f64>> {
    let (n, nz) = (held.mass.nrows(), if with_damping { held.z_z.nrows() } else { 0 });
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
    let values = of_each_pair(eigenvalues(a)?);
    Some(with_shapes(values, a, n))
}

/// Eigenvalues as [`damped`] finds them, of which those of free motions are 0 and have the shapes of these: one for the place of each, and
/// another where nothing slows it down. What damps less than round-off does not damp.
pub(super) fn beside(free: &Free, a: &DMatrix<f64>, n: usize) -> Option<Vec<Damped>> {
    if !measurable(a) {
        return None;
    }
    let rest = free.removed(a);
    let mut values = of_each_pair(eigenvalues(&rest)?);
    let round_off = ROUND_OFF * rest.nrows() as f64 * values.iter().fold(0.0, |m: f64, x| m.max(x.norm()));
    for value in values.iter_mut().filter(|value| value.re.abs() <= round_off) {
        value.re = 0.0;
    }
    values.sort_by(|x, y| x.norm().total_cmp(&y.norm()));
    let going_on = values.iter().take(free.motions.len()).take_while(|value| value.norm() <= round_off).count();
    let moving = values.split_off(going_on);
    let at_rest = free.motions.iter().cycle().take(free.motions.len() + going_on);
    let mut found: Vec<Damped> = at_rest.map(|motion| Damped::free(&motion.rows(0, n).into_owned())).collect();
    found.extend(with_shapes(moving, a, n));
    Some(found)
}

/// Eigenvalues of a state matrix by rising |μ|, with their shapes.
fn with_shapes(mut values: Vec<Complex<f64>>, a: &DMatrix<f64>, n: usize) -> Vec<Damped> {
    values.sort_by(|x, y| x.norm().total_cmp(&y.norm()).then(x.re.total_cmp(&y.re)));
    let shape = |i, value| by_largest(&eigenvector(a, value, i).rows(0, n).into_owned());
    values.into_iter().enumerate().map(|(i, value)| Damped { shape: shape(i, value), value }).collect()
}

/// A shape by the largest of its coordinates, which becomes 1.
pub(super) fn by_largest(x: &DVector<Complex<f64>>) -> DVector<Complex<f64>> {
    let largest = x.iter().fold(Complex::default(), |m: Complex<f64>, x| if x.norm() > m.norm() * (1.0 + 1e-9) { *x } else { m });
    if largest.norm() > 0.0 { x.map(|x| x / largest) } else { x.clone() }
}
