//! A pose that is held at rest, and the linear motion about it.
//!
//! With v = 0 and a = 0 the residual is r = Gᵀλ − f. The rows bear the dependent velocities, G_dᵀλ = f_d; what is left on the
//! independent ones, −r_i, is the unbalanced force that would have to hold the pose. About it
//!
//! ```text
//! PᵀMP ü + PᵀCP u̇ + PᵀKP u = unbalanced force,   K = ∂(Gᵀλ − f)/∂q at fixed λ, C = −∂f/∂v
//! ```
//!
//! holds to first order with the constraints followed to second order, whose curvature is in K by λ: the derivative of Pᵀ meets
//! r_d = 0 alone. Redundant rows leave λ free, but not PᵀKP: along motions that all rows allow, rows that agree have curvatures that
//! agree. A force on an independent coordinate that does not change with the pose (a motor at rest) stands in neither M nor K.
//!
//! Velocities of quaternion joints do not commute, so that K of a potential V is not symmetric off equilibrium: with the
//! fields e_j along velocities, K_jk − K_kj = [e_k, e_j] V = −ε_jkl r_l. The second derivative of V along geodesics is K − ½ r×,
//! which is symmetric again; what remains unsymmetric is of forces without a potential.

use super::linear::Singular;
use super::partition::Partition;
use crate::dynamics::{Dynamics, Linearizer, Point};
use crate::geometry::Space;
use crate::mechanism::{Mechanism, Step};
use grashof_solvers::{Block, Tangent};
use nalgebra::{DMatrix, DVector};

/// A pose: coordinates (nq), first-order states (nz), modes.
#[derive(Clone, Copy, Debug)]
pub struct Pose<'a> {
    /// Coordinates (nq).
    pub q: &'a [f64],
    /// First-order states (nz).
    pub z: &'a [f64],
    /// Modes of switches and windings.
    pub modes: &'a [i32],
}

/// The linear motion about a held pose, on n independent velocities.
#[derive(Clone, Debug)]
pub struct Held {
    /// Which velocities are independent, and P.
    pub partition: Partition,
    /// PᵀMP (n × n), kg or kg m².
    pub mass: DMatrix<f64>,
    /// PᵀCP (n × n).
    pub damping: DMatrix<f64>,
    /// PᵀKP (n × n); not symmetric where forces have no potential.
    pub stiffness: DMatrix<f64>,
    /// Part of the sum |P|ᵀ|K||P| that is lost at most to round-off, as |K_ij| (n × n).
    pub round_off: DMatrix<f64>,
    /// PᵀR_z (n × nz).
    pub r_z: DMatrix<f64>,
    /// ∂ż/∂(q, v, z): (nz × n), (nz × n), (nz × nz).
    pub z_q: DMatrix<f64>,
    /// See `z_q`.
    pub z_v: DMatrix<f64>,
    /// See `z_q`.
    pub z_z: DMatrix<f64>,
    /// −r on the independent velocities, N or N m (n): what is unbalanced.
    pub unbalanced: DVector<f64>,
    /// Sum of the sizes of what adds up to it (n).
    pub forces: DVector<f64>,
    /// What weights, loads and efforts do on whole ways, J: of a mechanism in balance little of it is left in `forces`.
    pub acting: f64,
    /// λ (rows).
    pub lambda: DVector<f64>,
    /// Largest |Φ|, m or rad.
    pub residual: f64,
}

impl Held {
    /// The motion about a pose at time 0; `metric` (nv) is that of the assembled start, `preferred` velocities are independent as
    /// far as the rows leave them so.
    ///
    /// # Errors
    /// If forces are not numbers in the pose.
    pub fn new<G>(
        mechanism: &Mechanism<G>,
        linearizer: &mut Linearizer<'_, G>,
        pose: Pose<'_>,
        metric: &[f64],
        preferred: &[usize],
    ) -> Result<Self, Singular>
    where
        G: Space<S = f64>,
    {
        let (nv, rows, nz) = (mechanism.nv, mechanism.rows.len(), pose.z.len());
        let rest = vec![0.0; nv];
        let mut dynamics = Dynamics::new(mechanism);
        dynamics.work.z.copy_from_slice(pose.z);
        dynamics.terms(0.0, pose.q, &rest, pose.modes);
        let w = &dynamics.work;
        let g = DMatrix::from_row_slice(rows, nv, &w.g.to_dense());
        let force = DVector::from_column_slice(&w.force);
        if !force.iter().chain(g.iter()).all(|x| x.is_finite()) {
            return Err(Singular);
        }
        let partition = Partition::new(&g, metric, &dynamics.row_scale(pose.q, pose.modes, metric), preferred);
        let lambda = partition.multipliers(&force);
        // joints press to the side that the multipliers say
        let mut modes = pose.modes.to_vec();
        for (_, side) in dynamics.pressed(lambda.as_slice()).filter(|(force, _)| *force < 0.0) {
            modes[side] = if modes[side] < 0 { 1 } else { -1 };
        }
        let at = Point { t: 0.0, q: pose.q, v: &rest, z: pose.z, a: &rest, lambda: lambda.as_slice(), modes: &modes };
        let mut tangent = Tangent::new(&linearizer.pattern(nz));
        linearizer.tangents(&at, &mut tangent);
        if !tangent.is_finite() {
            return Err(Singular);
        }
        let matrix = |rows: usize, columns: usize, x: &Block| DMatrix::from_row_slice(rows, columns, &x.to_dense());
        let r = g.transpose() * &lambda - &force;
        let (mut k, c) = (matrix(nv, nv, &tangent.k), matrix(nv, nv, &tangent.c));
        geodesic(mechanism, r.as_slice(), |i, j, x| k[(i, j)] += x);
        let p = partition.p.clone();
        let pt = p.transpose();
        let sizes = p.abs();
        Ok(Self {
            mass: &pt * matrix(nv, nv, &w.mass) * &p,
            damping: &pt * c * &p,
            stiffness: &pt * &k * &p,
            round_off: sizes.transpose() * k.abs() * &sizes,
            r_z: &pt * matrix(nv, nz, &tangent.r_z),
            z_q: matrix(nz, nv, &tangent.z_q) * &p,
            z_v: matrix(nz, nv, &tangent.z_v) * &p,
            z_z: matrix(nz, nz, &tangent.z_z),
            unbalanced: -r.select_rows(&partition.independent),
            forces: sizes.transpose() * force.abs(),
            acting: dynamics.acting(mechanism.size()),
            residual: w.phi.iter().fold(0.0, |m, phi| m.max(phi.abs())),
            lambda,
            partition,
        })
    }

    /// Largest |K_ij − K_ji| against the size of what K is the sum of: 0 for forces with a potential.
    #[must_use]
    pub fn circulation(&self) -> f64 {
        let off = (&self.stiffness - self.stiffness.transpose()).amax();
        let size = self.stiffness.amax();
        if off > 1e-11 * self.round_off.amax() { off / size } else { 0.0 }
    }
}

/// What is added to K, as row, column and value: −½ r× of each quaternion joint.
pub(super) fn geodesic<G: Space>(mechanism: &Mechanism<G>, r: &[f64], mut add: impl FnMut(usize, usize, f64)) {
    for step in &mechanism.steps {
        if let Step::Ball { v, .. } = *step {
            let half = nalgebra::Vector3::new(r[v], r[v + 1], r[v + 2]).cross_matrix() * -0.5;
            (0..9).filter(|k| k / 3 != k % 3).for_each(|k| add(v + k / 3, v + k % 3, half[(k / 3, k % 3)]));
        }
    }
}

/// The modes of the switches of forces at time 0 in a state (q: nq, v: nv, z: nz): those of `modes` where nothing says otherwise.
#[must_use]
pub fn settled<G: Space<S = f64>>(mechanism: &Mechanism<G>, [q, v, z]: [&[f64]; 3], modes: &[i32]) -> Vec<i32> {
    let mut modes = modes.to_vec();
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.work.z.copy_from_slice(z);
    // a function of positions may switch and feed the others: twice settles what depends on it
    for _ in 0..2 {
        dynamics.time(0.0, &modes);
        dynamics.position(q, &modes);
        dynamics.velocity(v, &modes);
        for staged in mechanism.programs() {
            dynamics.switch(staged, &mut modes);
        }
    }
    modes
}
