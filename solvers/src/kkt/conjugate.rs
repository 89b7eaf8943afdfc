//! Multipliers whose rows hold to round-off, also where rows are nearly dependent.
//!
//! Eliminating a from the equations leaves S λ = G M⁻¹ f − γ with S = G M⁻¹ Gᵀ, whose residual is r = G a − γ. The factors at hand are those of
//! S + E, so conjugate gradients with S + E as preconditioner need one solve for each step, with the right-hand side (0, −r):
//!
//! ```text
//! z = (S + E)⁻¹ r,   δa = −M⁻¹Gᵀz,   S z = r − E z
//! ```
//!
//! and are done after as many steps as there are different σ²/(σ² + E), while each step of iterative refinement leaves the part
//! E/(E + σ²) of an error (Saad, Iterative Methods for Sparse Linear Systems, 2003, section 9.2).

use super::dense::dot;

/// Most steps where singular positions may be near: few singular values are near to E at the same time.
const MOST: usize = 30;
/// Most steps where all directions are wanted: along a structure of hundreds of light and heavy bodies there are many.
const MOST_OF_ALL: usize = 400;

/// Conjugate gradients on the multipliers, with the accelerations that belong to them; room is made when it is needed.
#[derive(Clone, Debug, Default)]
pub(super) struct Conjugate {
    /// Residual, and E (m each).
    pub(super) r: Vec<f64>,
    pub(super) e: Vec<f64>,
    /// What has been added to accelerations and multipliers (nv + m).
    pub(super) sum: Vec<f64>,
    /// δa and z, and the direction with its accelerations (nv + m).
    z: Vec<f64>,
    p: Vec<f64>,
    /// S times the direction (m).
    sp: Vec<f64>,
}

/// Largest entry in size.
pub(super) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

impl Conjugate {
    /// Takes the residual `r` away down to `round_off`, for so many velocities; whether that was reached. `solve(r, x)` writes δa and z
    /// of a residual.
    ///
    /// It is not where a direction is needed whose σ² is below `least`; without it all are taken.
    pub(super) fn reduce(
        &mut self,
        velocities: usize,
        round_off: f64,
        least: Option<f64>,
        mut solve: impl FnMut(&[f64], &mut [f64]),
    ) -> bool {
        let (m, n) = (self.r.len(), velocities + self.r.len());
        for (x, n) in [(&mut self.sum, n), (&mut self.z, n), (&mut self.p, n), (&mut self.sp, m)] {
            x.clear();
            x.resize(n, 0.0);
        }
        let mut last = f64::INFINITY;
        for _ in 0..if least.is_some() { MOST } else { MOST_OF_ALL } {
            solve(&self.r, &mut self.z);
            let z = &self.z[velocities..];
            let now = dot(&self.r, z);
            let beta = now / last;
            last = now;
            for (((sp, r), z), e) in self.sp.iter_mut().zip(&self.r).zip(z).zip(&self.e) {
                *sp = r - e * z + beta * *sp;
            }
            self.p.iter_mut().zip(&self.z).for_each(|(p, z)| *p = z + beta * *p);
            let p = &self.p[velocities..];
            let of_rows = dot(p, &self.sp);
            if of_rows.is_nan() || of_rows <= least.unwrap_or(0.0) * dot(p, p) {
                return false;
            }
            let step = now / of_rows;
            self.sum.iter_mut().zip(&self.p).for_each(|(x, p)| *x += step * p);
            self.r.iter_mut().zip(&self.sp).for_each(|(r, sp)| *r -= step * sp);
            if largest(&self.r) <= round_off {
                return true;
            }
        }
        false
    }
}
