//! The error of a step: Hairer's filtered estimate on the constraints.
//!
//! The embedded formula of order three differs from the method by e_q, e_v, e_z. With c = h/γ̂, the real block filters it:
//!
//! ```text
//! (M + c C + c² K) x_v + c R_z x_z + Gᵀμ = M e_v − c K e_q        G x_v = 0
//! x_z − c (c Z_q + Z_v) x_v − c Z_z x_z  = e_z + c Z_q e_q
//! x_q = e_q + c x_v + P η,  G x_q = 0,   P = the real solution with [0; I]
//! ```
//!
//! which is (I − c J)⁻¹ e for the differential part (Hairer & Wanner, Solving ODEs II, (IV.8.19)). Multipliers are no part of it.
//! The difference e itself keeps errors that stiff forces damp; therefore a first or repeated step that is about to be rejected
//! filters again from y₀ + x (IV.8.20).

use super::stages::Stages;
use super::tableau::{BEGIN, ERROR, ERROR_OF_RATES, REAL};
use crate::engine::{Engine, Node, Why};
use crate::scheme::Level;
use crate::{Dims, System};

/// The estimate and its scratch.
#[derive(Clone, Debug)]
pub(super) struct Estimate {
    level: Level,
    /// e_q as a displacement (nv), and what it becomes.
    d: Vec<f64>,
    /// e_q (nq), x_v (nv), x_z (nz).
    q: Vec<f64>,
    v: Vec<f64>,
    z: Vec<f64>,
    x: Vec<f64>,
    rate: Vec<f64>,
    scratch: Node,
}

impl Estimate {
    /// Room for a system.
    pub(super) fn new(level: Level, dims: Dims) -> Self {
        Self {
            level,
            d: vec![0.0; dims.v],
            q: vec![0.0; dims.q],
            v: vec![0.0; dims.v],
            z: vec![0.0; dims.z],
            x: vec![0.0; dims.v + dims.z + dims.rows()],
            rate: vec![0.0; dims.q],
            scratch: Node::new(dims),
        }
    }

    /// Norm of the error of the step of size `h` from `from` with the given stages, 1 at the tolerance.
    pub(super) fn norm(&mut self, system: &mut dyn System, engine: &Engine, from: &Node, stages: &mut Stages, h: f64) -> f64 {
        self.scratch.copy_from(from);
        self.difference(system, from, stages, h);
        self.filter(system, engine, from, stages, h)
    }

    /// The same without the filter, which takes for damped what a stiff force without damping throws back: a rebound.
    pub(super) fn unfiltered(&mut self, system: &mut dyn System, engine: &Engine, from: &Node, stages: &Stages, h: f64) -> f64 {
        self.scratch.copy_from(from);
        self.difference(system, from, stages, h);
        engine.norm(&from.state, &self.q, &self.v, &self.z)
    }

    /// The same from y₀ + x, x being the error found by [`norm`](Self::norm).
    ///
    /// # Errors
    /// If the system cannot be evaluated there.
    pub(super) fn again(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        from: &Node,
        stages: &mut Stages,
        h: f64,
    ) -> Result<f64, Why> {
        let s = &mut self.scratch.state;
        for (x, e) in [(&mut s.q, &self.q), (&mut s.v, &self.v), (&mut s.z, &self.z)] {
            x.iter_mut().zip(e).for_each(|(x, e)| *x += e);
        }
        engine.accelerate(system, &mut self.scratch)?;
        self.difference(system, from, stages, h);
        Ok(self.filter(system, engine, from, stages, h))
    }

    /// e from the rates of `scratch` and the stages.
    fn difference(&mut self, system: &mut dyn System, from: &Node, stages: &Stages, h: f64) {
        let begin = &self.scratch;
        system.rate(begin.state.t, &begin.state.q, &begin.state.v, &mut self.rate);
        let [s0, s1, s2] = &stages.stage;
        let [e0, e1, e2] = ERROR;
        let [r0, r1, r2] = ERROR_OF_RATES;
        for (i, q) in self.q.iter_mut().enumerate() {
            let past = from.state.q[i];
            let stage = e0 * (s0.state.q[i] - past) + e1 * (s1.state.q[i] - past) + e2 * (s2.state.q[i] - past);
            *q = h * BEGIN * self.rate[i] + stage;
        }
        for i in 0..self.v.len() {
            self.v[i] = h * (BEGIN * begin.a[i] + r0 * s0.a[i] + r1 * s1.a[i] + r2 * s2.a[i]);
            self.d[i] = h * (BEGIN * begin.state.v[i] + r0 * s0.state.v[i] + r1 * s1.state.v[i] + r2 * s2.state.v[i])
                + (e0 * s0.w[i] + e1 * s1.w[i] + e2 * s2.w[i]);
        }
        for i in 0..self.z.len() {
            self.z[i] = h * (BEGIN * begin.zdot[i] + r0 * s0.zdot[i] + r1 * s1.zdot[i] + r2 * s2.zdot[i]);
        }
    }

    /// x from e.
    fn filter(&mut self, system: &mut dyn System, engine: &Engine, from: &Node, stages: &mut Stages, h: f64) -> f64 {
        self.solve(stages, h);
        // x_q = e_q + N (c x_v + P η)
        let c = h / REAL;
        for ((d, v), correction) in self.d.iter_mut().zip(&self.v).zip(&self.x) {
            *d = c * v + correction;
        }
        system.lift(from.state.t, &from.state.q, &self.d, &mut self.rate);
        self.q.iter_mut().zip(&self.rate).for_each(|(q, r)| *q += r);
        engine.norm(&from.state, &self.q, &self.v, &self.z)
    }

    /// x_v and x_z in place of e_v and e_z; P η goes to the begin of `x`.
    fn solve(&mut self, stages: &mut Stages, h: f64) {
        let (nv, nz, c) = (self.v.len(), self.z.len(), h / REAL);
        let (blocks, x) = (&stages.blocks, &mut self.x);
        x.fill(0.0);
        for (x, (mass, k)) in x.iter_mut().zip(blocks.mass.lines().zip(blocks.tangent.k.lines())) {
            *x = mass.dot(&self.v) - c * k.dot(&self.d);
        }
        for ((x, e), z_q) in x[nv..].iter_mut().zip(&self.z).zip(blocks.tangent.z_q.lines()) {
            *x = e + c * z_q.dot(&self.d);
        }
        stages.real.solve(x);
        self.v.copy_from_slice(&x[..nv]);
        self.z.copy_from_slice(&x[nv..nv + nz]);
        x.fill(0.0);
        if self.level == Level::Stabilized || self.level == Level::Position {
            for (s, row) in x[nv + nz..].iter_mut().zip(blocks.g.lines()) {
                *s = -row.entries().map(|(j, g)| g * (self.d[j] + c * self.v[j])).sum::<f64>();
            }
            stages.real.solve(x);
        }
    }
}
