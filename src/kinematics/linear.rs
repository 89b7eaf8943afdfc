//! Motion near a state, linearised: exact tangents, constraints followed to second order.
//!
//! A small deviation is (δq, δv, δz) with δq along velocities. On the tangent space of the constraints it obeys
//!
//! ```text
//! δq̇ = δv − S δq                                    S: ω × of each quaternion joint, whose velocities do not commute
//! M δa + Gᵀδλ = −K δq − (C δv + R_z δz)              the residual r = M a + Gᵀλ − f stays 0
//! G δa        = −Γ_q δq − Γ_v δv                     so does G a − γ
//! G δv        = −N_q δq                              and G v − ν
//! δż = Z_q δq + Z_v δv + Z_z δz
//! ```
//!
//! with K, C at the multipliers λ of the state, so that the curvature of the constraints is in K.
//!
//! On independent velocities i (δq = P x, δv = P u + W x, both from the rows) the residual projected by Pᵀ gives
//!
//! ```text
//! PᵀMP u̇ + (PᵀCP + PᵀM Y_v) u + (PᵀKP + PᵀCW + PᵀM Y_q) x + PᵀR_z δz = 0,    δa = P u̇ + Y_v u + Y_q x;
//! ```
//!
//! Gᵀδλ and dPᵀ r fall out, because GP = 0 and r = 0 in its dependent part (Udwadia & Kalaba's projected form; compare Nikravesh,
//! Planar Multibody Dynamics, section 14.3, without the second-order terms).

use super::partition::Partition;
use crate::dynamics::{Dynamics, Linearizer, Point, RowTangent};
use crate::geometry::Space;
use crate::mechanism::{Mechanism, Step};
use grashof_solvers::weakest::weakest;
use grashof_solvers::{Block, Kkt, Tangent};
use nalgebra::DMatrix;

/// The terms of a linearised motion at one state.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Derivatives of the residual and of ż.
    pub tangent: Tangent,
    /// Derivatives of the rates of the rows.
    pub rows: RowTangent,
    /// M (nv × nv).
    pub mass: DMatrix<f64>,
    /// G (rows × nv).
    pub g: DMatrix<f64>,
    /// S (nv × nv).
    pub spin: DMatrix<f64>,
    /// Number of first-order states.
    pub nz: usize,
    /// D (nv) and diag(G D⁻¹ Gᵀ) (rows).
    metric: Vec<f64>,
    row_scale: Vec<f64>,
    kkt: Kkt,
}

/// A linearised motion on independent velocities.
#[derive(Clone, Debug)]
pub struct Reduced {
    /// Which velocities are independent (n), and P: δq = P x.
    pub partition: Partition,
    /// W (nv × n): δv = P u + W x.
    pub w: DMatrix<f64>,
    /// PᵀMP (n × n), kg or kg m².
    pub mass: DMatrix<f64>,
    /// Factor of u (n × n), per unit speed.
    pub damping: DMatrix<f64>,
    /// Factor of x (n × n), per unit way.
    pub stiffness: DMatrix<f64>,
    /// State matrix A of (x, u, δz): order 2n + nz.
    pub a: DMatrix<f64>,
}

impl Linear {
    /// Linearises at a state with its accelerations and multipliers; `metric` (nv) is that of the assembled start. Forces must not
    /// depend on λ there.
    ///
    /// # Errors
    /// If the mass matrix is singular on the motions that are left.
    pub fn new<G>(mechanism: &Mechanism<G>, linearizer: &mut Linearizer<'_, G>, at: &Point<'_>, metric: &[f64]) -> Result<Self, Singular>
    where
        G: Space<S = f64>,
    {
        let (nv, rows, nz) = (mechanism.nv, mechanism.rows.len(), at.z.len());
        let mut dynamics = Dynamics::new(mechanism);
        dynamics.work.z.copy_from_slice(at.z);
        dynamics.terms(at.t, at.q, at.v, at.modes);
        let mut tangent = Tangent::new(&linearizer.pattern(nz));
        linearizer.tangents(at, &mut tangent);
        let mut kkt = Kkt::of_blocks(dynamics.work.mass.pattern(), dynamics.work.g.pattern());
        let row_scale = dynamics.row_scale(at.q, at.modes, metric);
        kkt.set_scale(metric, &row_scale);
        let weakest = weakest(&mut kkt, metric, &row_scale, &dynamics.work.g);
        kkt.set_weakest(weakest);
        kkt.factor(dynamics.work.mass.values(), dynamics.work.g.values()).map_err(|_| Singular)?;
        Ok(Self {
            rows: linearizer.rows(at),
            tangent,
            mass: DMatrix::from_row_slice(nv, nv, &dynamics.work.mass.to_dense()),
            g: DMatrix::from_row_slice(rows, nv, &dynamics.work.g.to_dense()),
            spin: spin(mechanism, at.v),
            nz,
            metric: metric.to_vec(),
            row_scale,
            kkt,
        })
    }

    /// The state matrix of (δq, δv, δz) on all coordinates, order 2nv + nz. Its solutions that begin on the tangent space of the
    /// constraints stay there.
    #[must_use]
    pub fn state_matrix(&mut self) -> DMatrix<f64> {
        let (nv, nz, rows) = (self.mass.nrows(), self.nz, self.g.nrows());
        let n = 2 * nv + nz;
        let mut a = DMatrix::zeros(n, n);
        a.view_mut((0, 0), (nv, nv)).copy_from(&(-&self.spin));
        a.view_mut((0, nv), (nv, nv)).fill_with_identity();
        let (mut force, mut gamma) = (vec![0.0; nv], vec![0.0; rows]);
        let (mut da, mut dl) = (vec![0.0; nv], vec![0.0; rows]);
        for j in 0..n {
            let of = |by_q: &Block, by_v: &Block, by_z: &Block, i: usize| match j {
                _ if j < nv => by_q.at(i, j),
                _ if j < 2 * nv => by_v.at(i, j - nv),
                _ => by_z.at(i, j - 2 * nv),
            };
            let of_rows = |by_q: &[f64], by_v: &[f64], i: usize| match j {
                _ if j < nv => by_q[i * nv + j],
                _ if j < 2 * nv => by_v[i * nv + j - nv],
                _ => 0.0,
            };
            let (t, r) = (&self.tangent, &self.rows);
            (0..nv).for_each(|i| force[i] = -of(&t.k, &t.c, &t.r_z, i));
            (0..rows).for_each(|i| gamma[i] = -of_rows(&r.acceleration_q, &r.acceleration_v, i));
            self.kkt.solve(&force, &gamma, &mut da, &mut dl);
            (0..nv).for_each(|i| a[(nv + i, j)] = da[i]);
            (0..nz).for_each(|i| a[(2 * nv + i, j)] = of(&t.z_q, &t.z_v, &t.z_z, i));
        }
        a
    }

    /// Independent velocities, `preferred` ones as far as the rows leave them independent.
    #[must_use]
    pub fn partition(&self, preferred: &[usize]) -> Partition {
        Partition::new(&self.g, &self.metric, &self.row_scale, preferred)
    }

    /// The same on independent velocities, `preferred` ones as far as the rows leave them independent.
    ///
    /// # Errors
    /// If the mass matrix is singular on them.
    pub fn reduce(&self, preferred: &[usize]) -> Result<Reduced, Singular> {
        let (nv, nz, rows) = (self.mass.nrows(), self.nz, self.g.nrows());
        let partition = self.partition(preferred);
        let (p, n) = (&partition.p, partition.independent.len());
        let t = &self.tangent;
        let matrix = |rows: usize, columns: usize, x: &[f64]| DMatrix::from_row_slice(rows, columns, x);
        let whole = |block: &Block| matrix(block.pattern().rows(), block.pattern().columns(), &block.to_dense());
        let (k, c, r_z) = (whole(&t.k), whole(&t.c), whole(&t.r_z));
        let gamma_q = matrix(rows, nv, &self.rows.acceleration_q);
        let gamma_v = matrix(rows, nv, &self.rows.acceleration_v);
        let w = partition.follow(&(matrix(rows, nv, &self.rows.velocity_q) * p));
        let y_v = partition.follow(&(&gamma_v * p));
        let y_q = partition.follow(&(&gamma_q * p + &gamma_v * &w));
        let project = p.transpose();
        let mass = &project * &self.mass * p;
        let damping = &project * (&c * p + &self.mass * y_v);
        let stiffness = &project * (k * p + c * &w + &self.mass * y_q);
        let factor = mass.clone().cholesky().ok_or(Singular)?;
        let (z_q, z_v) = (whole(&t.z_q), whole(&t.z_v));
        let mut a = DMatrix::zeros(2 * n + nz, 2 * n + nz);
        // the rates of x are u but for the joints whose velocities do not commute
        a.view_mut((0, 0), (n, n)).copy_from(&-(&self.spin * p).select_rows(&partition.independent));
        a.view_mut((0, n), (n, n)).fill_with_identity();
        a.view_mut((n, 0), (n, n)).copy_from(&-factor.solve(&stiffness));
        a.view_mut((n, n), (n, n)).copy_from(&-factor.solve(&damping));
        a.view_mut((n, 2 * n), (n, nz)).copy_from(&-factor.solve(&(&project * r_z)));
        a.view_mut((2 * n, 0), (nz, n)).copy_from(&(&z_q * p + &z_v * &w));
        a.view_mut((2 * n, n), (nz, n)).copy_from(&(&z_v * p));
        a.view_mut((2 * n, 2 * n), (nz, nz)).copy_from(&whole(&t.z_z));
        Ok(Reduced { w, mass, damping, stiffness, a, partition })
    }
}

/// The mass matrix is singular on the motions that are left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular;

/// S (nv × nv): ω × of each quaternion joint, as δω = δ̇ + ω × δ for a rotation Ṙ = R ω~ that is disturbed to R exp(δ~).
pub(crate) fn spin<G: Space>(mechanism: &Mechanism<G>, v: &[f64]) -> DMatrix<f64> {
    let mut s = DMatrix::zeros(mechanism.nv, mechanism.nv);
    for step in &mechanism.steps {
        if let Step::Ball { v: k, .. } = *step {
            let [x, y, z] = [v[k], v[k + 1], v[k + 2]];
            for (i, j, w) in [(0, 1, -z), (0, 2, y), (1, 0, z), (1, 2, -x), (2, 0, -y), (2, 1, x)] {
                s[(k + i, k + j)] = w;
            }
        }
    }
    s
}
