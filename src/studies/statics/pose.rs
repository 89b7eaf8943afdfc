//! A mechanism at rest in one position: what its forces leave unbalanced, and how that changes with the position.
//!
//! At rest (v = 0, a = 0) the equations of motion are Gᵀλ = f(q, z), and ż(q, z) = 0 of the first-order states. With D the metric
//! of the start and P (nv × n) a basis of the motions that the constraints leave, GP = 0 and PᵀDP = 1,
//!
//! ```text
//! h = Pᵀf                                   the unbalanced force (n); 0 in equilibrium
//! f − Gᵀλ = D P h                           least in D⁻¹; of all such λ the one of least λᵀEλ
//! H = Pᵀ (K − R_z Z_z⁺ Z_q) P               the tangent stiffness (n × n): −dh along P y
//! ```
//!
//! Z_z⁺ is the group inverse: rates keep the sums of states that Z_z keeps, as heat that flows between two bodies, and so does the way to
//! rest (Meyer, SIAM Review 17 (1975) 443-464).
//!
//! K = ∂(Gᵀλ − f)/∂q at fixed λ contains the curvature of the constraints; the states follow the position, z = z(q). Where h = 0
//! this is the Hessian of the Lagrangian on the tangent space (Nocedal & Wright, Numerical Optimization, theorem 12.6).

use super::rest::{CLOSED, Lost, Position, Rest, norm};
use crate::geometry::Space;
use crate::numerics::least_squares::{shortest, shortest_beyond};
use grashof_solvers::kkt::ROUND_OFF;
use grashof_solvers::rank::{NullSpace, RANK_TOLERANCE};
use grashof_solvers::{Span, Stage, System};
use nalgebra::{DMatrix, DVector};

/// Newton steps for constraints and for states.
const STEPS: usize = 40;

/// A position with its constraints closed and its states at rest.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    /// Where it is.
    pub(super) position: Position,
    /// Rows that do not depend on others.
    pub(super) independent: Vec<usize>,
    /// P (nv × n).
    pub(super) basis: DMatrix<f64>,
    /// h (n).
    pub(super) force: DVector<f64>,
    /// What h is made of, before it cancels: the measure of its round-off.
    pub(super) grain: f64,
    /// A stiffness of the order of those that act, before they cancel.
    pub(super) stiffness: f64,
}

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// The pose nearest to given coordinates, states and modes.
    pub(super) fn at(&mut self, q: &[f64], z: &[f64], modes: &[i32]) -> Result<Pose, Lost> {
        self.state.q.copy_from_slice(q);
        self.state.z.copy_from_slice(z);
        // those of a mechanism; rigid stops and events have more of them, which nothing at rest needs
        self.state.modes[..modes.len()].copy_from_slice(modes);
        self.close()?;
        // a state may switch what drives it, and so may the position
        for _ in 0..2 {
            self.take_modes();
            self.settle();
        }
        self.evaluate(Stage::Dynamics);
        if let Some(k) = self.undefined() {
            return Err(Lost::NotFinite(k));
        }
        Ok(self.balance())
    }

    /// The pose behind a displacement `delta` (nv).
    pub(super) fn moved(&mut self, from: &Pose, delta: &[f64]) -> Result<Pose, Lost> {
        let mut q = from.position.q.clone();
        self.system.retract(Span::at(self.state.t), &mut q, delta);
        self.at(&q, &from.position.z, &from.position.modes)
    }

    /// H (n × n) at a pose.
    pub(super) fn tangent(&mut self, pose: &Pose) -> Result<DMatrix<f64>, Lost> {
        self.stand_at(&pose.position);
        self.system.tangent(self.state.at(), &self.zeros, &pose.position.lambda, &mut self.tangent);
        let (nv, nz) = (self.zeros.len(), pose.position.z.len());
        let mut k = DMatrix::from_row_slice(nv, nv, &self.tangent.k.to_dense());
        if nz > 0 {
            let mut follow = DMatrix::zeros(nz, nv);
            for j in 0..nv {
                let rates: Vec<f64> = (0..nz).map(|i| self.tangent.z_q.at(i, j)).collect();
                follow.set_column(j, &DVector::from_vec(along_flow(&self.tangent.z_z.to_dense(), &rates)));
            }
            k -= DMatrix::from_row_slice(nv, nz, &self.tangent.r_z.to_dense()) * follow;
        }
        let h = pose.basis.transpose() * k * &pose.basis;
        // an entry without bound belongs to a force that is none
        if h.iter().all(|x| x.is_finite()) { Ok(h) } else { Err(Lost::NotFinite(0)) }
    }

    /// The unbalanced force on each velocity, D P h (nv).
    pub(super) fn net(&self, pose: &Pose) -> DVector<f64> {
        let along = &pose.basis * &pose.force;
        DVector::from_fn(along.len(), |k, _| self.system.pattern().metric[k] * along[k])
    }

    /// Moves the coordinates to the constraints, by the shortest way in the metric.
    fn close(&mut self) -> Result<(), Lost> {
        if self.terms.phi.is_empty() {
            return Ok(());
        }
        let round_off = ROUND_OFF * self.system.pattern().g_scale.iter().fold(0.0, |m, x| f64::max(m, x.sqrt()));
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            self.evaluate(Stage::Position);
            let gap = self.gap();
            if gap >= last || gap.is_nan() {
                // at round-off, or never
                return if last <= CLOSED { Ok(()) } else { Err(Lost::Open) };
            }
            last = gap;
            if gap <= 0.01 * CLOSED {
                // near zero a gap may shrink for ever, far below the round-off of what it is the difference of
                return Ok(());
            }
            let wanted: Vec<f64> = self.terms.phi.iter().map(|p| -p).collect();
            let delta = shortest_beyond(round_off, &self.terms.g.to_dense(), &wanted, &self.system.pattern().metric, 0.0);
            self.system.retract(Span::at(self.state.t), &mut self.state.q, &delta);
        }
        // round-off may shrink for ever
        if last <= CLOSED { Ok(()) } else { Err(Lost::Open) }
    }

    /// Brings the states to rest by Newton's method where their rates allow it; what cannot rest keeps its value. A step counts if
    /// the next one is shorter (the natural test of Deuflhard, Newton Methods for Nonlinear Problems, section 2.1.4).
    fn settle(&mut self) {
        let nz = self.state.z.len();
        let none = vec![0.0; self.terms.phi.len()];
        if nz > 0 {
            self.evaluate(Stage::Dynamics);
        }
        for _ in 0..STEPS.min(STEPS * nz) {
            self.system.tangent(self.state.at(), &self.zeros, &none, &mut self.tangent);
            let step = self.correction();
            let length = norm(&step);
            if length == 0.0 || !length.is_finite() {
                return;
            }
            let before = self.state.z.clone();
            let better = (0..12).any(|halves| {
                let part = 0.5_f64.powi(halves);
                self.state.z.iter_mut().zip(&before).zip(&step).for_each(|((z, b), s)| *z = b + part * s);
                self.evaluate(Stage::Dynamics);
                norm(&self.correction()) < length
            });
            if !better {
                self.state.z = before;
                return;
            }
        }
    }

    /// −Z_z⁺ ż.
    fn correction(&self) -> Vec<f64> {
        let wanted: Vec<f64> = self.terms.zdot.iter().map(|x| -x).collect();
        along_flow(&self.tangent.z_z.to_dense(), &wanted)
    }

    /// The pose at the state evaluated last.
    fn balance(&self) -> Pose {
        let pattern = self.system.pattern();
        let (metric, e) = (&pattern.metric, &pattern.g_scale);
        let (nv, m) = (metric.len(), e.len());
        let (g, force) = (self.terms.g.to_dense(), &self.terms.force);
        let left = NullSpace::new(&g, metric, e, RANK_TOLERANCE);
        let basis = DMatrix::from_row_slice(nv, left.mobility, &left.basis);
        let root: Vec<f64> = metric.iter().map(|d| d.sqrt()).collect();
        let transposed: Vec<f64> = (0..nv).flat_map(|k| (0..m).map(move |i| (i, k))).map(|(i, k)| g[i * nv + k] / root[k]).collect();
        let scaled: Vec<f64> = force.iter().zip(&root).map(|(f, r)| f / r).collect();
        let lambda = if m == 0 { Vec::new() } else { shortest_beyond(RANK_TOLERANCE, &transposed, &scaled, e, 0.0) };
        let (grain, stiffness) = self.sizes();
        let force = basis.transpose() * DVector::from_column_slice(force);
        Pose { position: self.position(lambda), independent: left.independent, basis, force, grain, stiffness }
    }
}

/// Z⁺ x by the group inverse of a square matrix, row after row: the y in the range of Z with Z y = x, as far as there is one; without it,
/// where Z is nilpotent, the shortest.
fn along_flow(z: &[f64], x: &[f64]) -> Vec<f64> {
    let n = x.len();
    let times = |a: &[f64], b: &[f64]| -> Vec<f64> { a.chunks_exact(n).map(|row| row.iter().zip(b).map(|(a, b)| a * b).sum()).collect() };
    let square: Vec<f64> = (0..n * n).map(|k| (0..n).map(|j| z[k / n * n + j] * z[j * n + k % n]).sum()).collect();
    let y = times(z, &shortest(&square, x, &vec![1.0; n], 0.0));
    let left = |y: &[f64]| norm(&times(z, y).iter().zip(x).map(|(a, b)| a - b).collect::<Vec<f64>>());
    let other = shortest(z, x, &vec![1.0; n], 0.0);
    if left(&y) <= left(&other) + 1e-9 * norm(x) { y } else { other }
}
