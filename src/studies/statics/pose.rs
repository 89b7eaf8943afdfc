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
//! K = ∂(Gᵀλ − f)/∂q at fixed λ contains the curvature of the constraints; the states follow the position, z = z(q). Where h = 0
//! this is the Hessian of the Lagrangian on the tangent space (Nocedal & Wright, Numerical Optimization, theorem 12.6).

use crate::dynamics::LANES;
use crate::geometry::{Force, Motion, Space};
use crate::mechanism::{EffortLaw, Measured, Step, StretchOf};
use crate::numerics::least_squares::{shortest, shortest_beyond};
use crate::scalar::Dual;
use crate::studies::dynamics::system::Mechanical;
use grashof_solvers::kkt::ROUND_OFF;
use grashof_solvers::rank::{NullSpace, RANK_TOLERANCE};
use grashof_solvers::{Span, Stage, State, System, Tangent, Terms};
use nalgebra::{DMatrix, DVector};

/// Residual of a closed constraint, in units of the mechanism's size.
const CLOSED: f64 = 1e-12;
/// Newton steps for constraints and for states.
const STEPS: usize = 40;

/// A position with its constraints closed and its states at rest.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    /// Coordinates (nq).
    pub(super) q: Vec<f64>,
    /// First-order states (nz).
    pub(super) z: Vec<f64>,
    /// ż (nz): not 0 where a state finds no rest.
    pub(super) drift: Vec<f64>,
    /// Modes of switches and windings.
    pub(super) modes: Vec<i32>,
    /// λ (rows).
    pub(super) lambda: Vec<f64>,
    /// P (nv × n).
    pub(super) basis: DMatrix<f64>,
    /// h (n).
    pub(super) force: DVector<f64>,
    /// What h is made of, before it cancels: the measure of its round-off.
    pub(super) grain: f64,
    /// A stiffness of the order of those that act, before they cancel.
    pub(super) stiffness: f64,
}

/// Why there is no pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lost {
    /// The constraints cannot be closed from there.
    Open,
    /// The force on this velocity is not a number.
    NotFinite(usize),
}

/// A mechanism that rests: evaluates poses.
pub(super) struct Rest<'m, G: Space<S = f64>, D: Space<S = Dual<LANES>>> {
    pub(super) system: Mechanical<'m, G, D>,
    /// Characteristic length, m.
    pub(super) size: f64,
    /// What counts as a whole way of each velocity: 1 rad, or the size (nv).
    pub(super) unit: Vec<f64>,
    state: State,
    terms: Terms,
    tangent: Tangent,
    zeros: Vec<f64>,
}

impl<'m, G, D> Rest<'m, G, D>
where
    G: Space<S = f64>,
    D: Space<S = Dual<LANES>>,
{
    /// A system of a characteristic length, m.
    pub(super) fn new(system: Mechanical<'m, G, D>, size: f64) -> Self {
        let dims = system.dims();
        let unit = system.pattern().size_v.clone();
        let (state, terms, tangent) = (State::new(dims), Terms::new(dims, system.pattern()), Tangent::new(system.pattern()));
        Self { size, unit, state, terms, tangent, zeros: vec![0.0; dims.v], system }
    }

    /// Holds contacts where they stand, rad or m.
    pub(super) fn hold(&mut self, live: &[f64]) {
        self.state.live.copy_from_slice(live);
    }

    /// The state at a pose.
    pub(super) fn state(&mut self, pose: &Pose) -> State {
        self.show(pose);
        self.state.clone()
    }

    /// The pose nearest to given coordinates, states and modes.
    pub(super) fn at(&mut self, q: &[f64], z: &[f64], modes: &[i32]) -> Result<Pose, Lost> {
        self.state.q.copy_from_slice(q);
        self.state.z.copy_from_slice(z);
        // those of a mechanism; rigid stops and events have more of them, which nothing at rest needs
        self.state.modes[..modes.len()].copy_from_slice(modes);
        self.close()?;
        // a state may switch what drives it, and so may the position
        for _ in 0..2 {
            let mut next = self.state.modes.clone();
            self.system.modes(self.state.at(), &mut next);
            self.state.modes = next;
            self.settle();
        }
        self.evaluate(Stage::Dynamics);
        if let Some(k) = self.terms.force.iter().position(|f| !f.is_finite()) {
            return Err(Lost::NotFinite(k));
        }
        Ok(self.balance())
    }

    /// The pose behind a displacement `delta` (nv).
    pub(super) fn moved(&mut self, from: &Pose, delta: &[f64]) -> Result<Pose, Lost> {
        let mut q = from.q.clone();
        self.system.retract(Span::at(self.state.t), &mut q, delta);
        self.at(&q, &from.z, &from.modes)
    }

    /// Largest part of a displacement (nv), in radians or sizes.
    pub(super) fn measure(&self, delta: &DVector<f64>) -> f64 {
        delta.iter().zip(&self.unit).fold(0.0, |m, (d, u)| f64::max(m, d.abs() / u))
    }

    /// H (n × n) at a pose.
    pub(super) fn tangent(&mut self, pose: &Pose) -> Result<DMatrix<f64>, Lost> {
        self.state.q.copy_from_slice(&pose.q);
        self.state.z.copy_from_slice(&pose.z);
        self.state.modes.copy_from_slice(&pose.modes);
        self.system.tangent(self.state.at(), &self.zeros, &pose.lambda, &mut self.tangent);
        let (nv, nz) = (self.zeros.len(), pose.z.len());
        let mut k = DMatrix::from_row_slice(nv, nv, &self.tangent.k.to_dense());
        if nz > 0 {
            let mut follow = DMatrix::zeros(nz, nv);
            for j in 0..nv {
                let rates: Vec<f64> = (0..nz).map(|i| self.tangent.z_q.at(i, j)).collect();
                follow.set_column(j, &DVector::from_vec(shortest(&self.tangent.z_z.to_dense(), &rates, &vec![1.0; nz], 0.0)));
            }
            k -= DMatrix::from_row_slice(nv, nz, &self.tangent.r_z.to_dense()) * follow;
        }
        let h = pose.basis.transpose() * k * &pose.basis;
        // an entry without bound belongs to a force that is none
        if h.iter().all(|x| x.is_finite()) { Ok(h) } else { Err(Lost::NotFinite(0)) }
    }

    /// What tells apart two equilibria: poses of the bodies and stretches of the springs, lengths by the size.
    pub(super) fn signature(&mut self, pose: &Pose) -> Vec<f64> {
        self.show(pose);
        let d = &self.system.dynamics;
        let mut out = Vec::new();
        for p in d.poses() {
            out.extend((0..9).map(|i| G::entry(p.r, i / 3, i % 3)));
            out.extend((0..G::VECTOR).map(|i| G::component(p.p, i) / self.size));
        }
        for stretch in &d.mechanism.stretches {
            let turns = match stretch.of {
                StretchOf::Gauge(g) => match d.mechanism.gauges[g].measured {
                    Measured::Angle | Measured::Turn { .. } => true,
                    Measured::Coordinate { along, .. } => along.turns,
                    _ => false,
                },
                StretchOf::Function(_) => false,
            };
            out.push(d.extent(stretch.of) / if turns { 1.0 } else { self.size });
        }
        out
    }

    /// Evaluates a pose for whoever reads the workspace: quantities of the columns, outlines.
    pub(super) fn show(&mut self, pose: &Pose) {
        self.state.q.copy_from_slice(&pose.q);
        self.state.z.copy_from_slice(&pose.z);
        self.state.modes.copy_from_slice(&pose.modes);
        self.system.observe(&self.state.at(), &self.zeros, &pose.lambda);
    }

    /// The unbalanced force on each velocity, D P h (nv).
    pub(super) fn net(&self, pose: &Pose) -> DVector<f64> {
        let along = &pose.basis * &pose.force;
        DVector::from_fn(along.len(), |k, _| self.system.pattern().metric[k] * along[k])
    }

    /// Largest |Φ| at a pose, m or rad.
    pub(super) fn open(&mut self, pose: &Pose) -> f64 {
        self.show(pose);
        self.system.dynamics.work.phi.iter().fold(0.0, |m, p| f64::max(m, p.abs()))
    }

    /// How far the quaternions of a pose are turned from those of another, as rotation vectors in the turned body (nv), rad;
    /// 0 for other velocities.
    pub(super) fn turned(&self, from: &Pose, to: &Pose) -> Vec<f64> {
        let mut out = vec![0.0; self.unit.len()];
        let quaternion = |q: &[f64]| nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]);
        for step in &self.system.dynamics.mechanism.steps {
            if let Step::Ball { q, v, .. } = *step {
                let between = quaternion(&from.q[q..]).conjugate() * quaternion(&to.q[q..]);
                let turn = nalgebra::UnitQuaternion::from_quaternion(between).scaled_axis();
                out[v..v + 3].copy_from_slice(turn.as_slice());
            }
        }
        out
    }

    fn evaluate(&mut self, stage: Stage) {
        self.system.terms(self.state.at(), stage, &mut self.terms);
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

    /// Largest |Φ|, lengths by the size.
    fn gap(&self) -> f64 {
        let rows = &self.system.dynamics.mechanism.rows;
        let scaled = self.terms.phi.iter().zip(rows).map(|(p, r)| p.abs() / if r.angular { 1.0 } else { self.size });
        scaled.fold(0.0, |m, x| if x > m || x.is_nan() { x } else { m })
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
        shortest(&self.tangent.z_z.to_dense(), &wanted, &vec![1.0; wanted.len()], 0.0)
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
        let (grain, stiffness) = self.scales(&root);
        Pose {
            q: self.state.q.clone(),
            z: self.state.z.clone(),
            drift: self.terms.zdot.clone(),
            modes: self.state.modes.clone(),
            lambda,
            force: basis.transpose() * DVector::from_column_slice(force),
            basis,
            grain,
            stiffness,
        }
    }

    /// Sizes of the forces and of the stiffnesses that act, each before anything cancels, in the metric; `root` is D^½.
    fn scales(&self, root: &[f64]) -> (f64, f64) {
        let (m, w) = (self.system.dynamics.mechanism, &self.system.dynamics.work);
        // a moment is the difference of larger ones, about as large as the force at the body's own distance and size; places that
        // coordinates give are rounded by these
        let far = m.steps.iter().fold(self.size, |far, step| match *step {
            Step::Axis { turns: false, q, .. } => far.max(self.state.q[q].abs()),
            _ => far,
        });
        let length = |(body, f): (usize, &Force<G>)| {
            let (p, size) = (w.places[body].p, G::dot(f.f, f.f).sqrt());
            [G::dot_spin(f.n, f.n).sqrt() + size * (G::dot(p, p).sqrt() + far), size]
        };
        let mut pulls: Vec<[f64; 2]> = w.applied.iter().enumerate().map(length).collect();
        let mut grains = vec![0.0; root.len()];
        for node in m.nodes.iter().rev() {
            let [n, f] = pulls[node.body];
            for k in node.columns.clone() {
                let Motion { w, v } = w.columns[k];
                grains[k] = (n * G::dot_spin(w, w).sqrt() + f * G::dot(v, v).sqrt()) / root[k];
            }
            let parent = &mut pulls[node.parent];
            *parent = [parent[0] + n, parent[1] + f];
        }
        let mut stiffness = G::dot(m.gravity, m.gravity).sqrt() / self.size;
        for (effort, size) in m.efforts.iter().zip(&w.efforts) {
            let mut along = vec![0.0; root.len()];
            let mut add = |gauge: usize, slope: f64| {
                m.gauges[gauge].project(&w.readings[gauge], &w.columns, |k, x| along[k] += slope * x / root[k]);
            };
            match effort.along {
                StretchOf::Gauge(gauge) => add(gauge, 1.0),
                StretchOf::Function(f) => {
                    let function = &m.functions[f];
                    function.gauges.iter().enumerate().for_each(|(i, &gauge)| add(gauge, w.functions[function.value + 1 + i]));
                }
            }
            let mut size = size.abs();
            if let EffortLaw::Linear { stiffness: k, rest, .. } = effort.law {
                stiffness += k.abs() * along.iter().map(|a| a * a).sum::<f64>();
                size += k.abs() * (self.system.dynamics.extent(effort.along).abs() + rest.abs());
            }
            grains.iter_mut().zip(&along).for_each(|(g, a)| *g += size * a.abs());
        }
        (norm(&grains), stiffness)
    }
}

/// √Σ x².
pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
