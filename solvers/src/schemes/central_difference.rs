//! Central differences at a given step, implicit in the forces that depend on velocity.
//!
//! ```text
//! v_n = (q_{n+1} − q_{n−1})/(2h),   a_n = (q_{n+1} − 2 q_n + q_{n−1})/h²,   M a_n + Gᵀλ = f(t_n, q_n, v_n)
//! ```
//!
//! in terms of the increment d_n = q_n − q_{n−1} (Bathe, Finite Element Procedures, section 9.2.1; on a group the displacement that
//! leads from q_{n−1} to q_n, in the frame of v, which turns with it):
//!
//! ```text
//! q_{n+1} = q_n ⊕ d_{n+1},   d_{n+1} = d_n + h² a_n,   v_{n+1} = d_{n+1}/h + (h/2) a_{n+1}
//! ```
//!
//! so that a_{n+1} solves the equations at t_{n+1} by Newton's method with c_q = 0, c_v = h/2, and the velocity of the last row needs
//! no step beyond. The start q(−h) = q₀ − h v₀ + h²a₀/2 is d₀ = h v₀ − h²a₀/2; a change of the step begins anew in the same way.
//! First-order states follow the trapezoidal rule.
//!
//! Constraints hold as G a = γ; then q and v move to them by the shortest way in the metric M, and what moved them is kept in d, as in
//! RATTLE (Andersen, J. Comput. Phys. 52 (1983) 24-34): otherwise the increments would drift off.

use crate::dense_output::Dense;
use crate::engine::{Engine, Node, Rejected, Why};
use crate::matrix::Coefficients;
use crate::newton::{Implicit, Newton, Place, Unknown};
use crate::scheme::{Level, Scheme};
use crate::settings::Settings;
use crate::{Span, Stage, State, System};

/// Central differences.
pub(super) struct CentralDifference {
    follow: bool,
    newton: Newton,
    x: Unknown,
    /// d that led to the last node (nv), for the step `belongs`.
    d: Vec<f64>,
    /// d of the step being tried.
    next: Vec<f64>,
    /// a of the last node, of the scheme's own equations (nv).
    a: Vec<f64>,
    /// The step to which d belongs, s; 0 at a start.
    belongs: f64,
    /// q̂, v̂, ẑ of the stage, and displacements of zero.
    q: Vec<f64>,
    v: Vec<f64>,
    z: Vec<f64>,
    zeros: Vec<f64>,
    /// Rows of the closing of positions, its step and multipliers.
    rows: Vec<f64>,
    step: Vec<f64>,
    mu: Vec<f64>,
    h: f64,
}

/// Most Newton steps of the closing of positions.
const CLOSINGS: usize = 12;

/// A correction below this (in units of size) leaves a residual of its square.
const SQUARE_ENOUGH: f64 = 1e-8;

impl CentralDifference {
    /// Room for a system.
    pub(super) fn new(settings: Settings, system: &dyn System) -> Self {
        let dims = system.dims();
        let zeros = || vec![0.0; dims.v];
        Self {
            follow: !settings.locate,
            newton: Newton::new(system),
            x: Unknown::new(dims),
            d: zeros(),
            next: zeros(),
            a: zeros(),
            belongs: 0.0,
            q: vec![0.0; dims.q],
            v: zeros(),
            z: vec![0.0; dims.z],
            zeros: zeros(),
            rows: vec![0.0; dims.rows()],
            step: zeros(),
            mu: vec![0.0; dims.rows()],
            h: 0.0,
        }
    }

    /// Extends d until the position it leads to is closed: q = q₀ ⊕ d.
    fn close(&mut self, system: &mut dyn System, engine: &mut Engine, from: &State, to: &mut State) -> Result<(), Why> {
        if engine.dims.holonomic == 0 {
            return Ok(());
        }
        for _ in 0..CLOSINGS {
            engine.evaluate(system, to.at(), Stage::Position);
            engine.factor()?;
            self.rows.fill(0.0);
            self.rows.iter_mut().zip(&engine.terms.phi).for_each(|(r, phi)| *r = -phi);
            engine.kkt.solve(&self.zeros, &self.rows, &mut self.step, &mut self.mu);
            self.next.iter_mut().zip(&self.step).for_each(|(d, s)| *d += s);
            to.q.copy_from_slice(&from.q);
            system.retract(Span { end: to.t, length: to.t - from.t }, &mut to.q, &self.next);
            let size = self.step.iter().zip(&engine.size_v).fold(0.0, |m, (d, s)| f64::max(m, d.abs() / s));
            if size < SQUARE_ENOUGH {
                return Ok(());
            }
        }
        let (row, residual) = engine.terms.phi.iter().map(|x| x.abs()).enumerate().fold((0, 0.0), |b, x| if x.1 > b.1 { x } else { b });
        Err(Why::Constraints { row, residual })
    }

    /// The position at the end of the step, and accelerations there.
    fn solve(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Why> {
        if h == self.belongs {
            self.next.copy_from_slice(&self.d);
        } else {
            for ((d, v), a) in self.next.iter_mut().zip(&from.state.v).zip(&self.a) {
                *d = h * v - 0.5 * h * h * a;
            }
        }
        self.next.iter_mut().zip(&self.a).for_each(|(d, a)| *d += h * h * a);
        let s = &mut to.state;
        s.copy_from(&from.state);
        s.t = from.state.t + h;
        system.retract(Span { end: s.t, length: h }, &mut s.q, &self.next);
        self.close(system, engine, &from.state, s)?;
        self.accelerations(system, engine, from, h, to)
    }

    /// a, ż, λ and v at the position of `to`.
    fn accelerations(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Why> {
        self.v.iter_mut().zip(&self.next).for_each(|(v, d)| *v = d / h);
        for ((z, z0), rate) in self.z.iter_mut().zip(&from.state.z).zip(&from.zdot) {
            *z = z0 + 0.5 * h * rate;
        }
        self.q.copy_from_slice(&to.state.q);
        self.x.a.copy_from_slice(&self.a);
        self.x.zdot.copy_from_slice(&from.zdot);
        self.x.lambda.copy_from_slice(&from.lambda);
        self.x.w.fill(0.0);
        let stage = Implicit {
            t: to.state.t,
            span: 0.0,
            q: &self.q,
            d: &self.zeros,
            v: &self.v,
            z: &self.z,
            c: Coefficients { q: 0.0, v: 0.5 * h, z: 0.5 * h },
            place: Place::Retract,
            level: Level::Acceleration,
            follow: self.follow,
        };
        self.newton.solve(system, engine, &stage, &mut self.x, &mut to.state)?;
        if engine.dims.rows() == 0 {
            to.a.copy_from_slice(&self.x.a);
            to.zdot.copy_from_slice(&self.x.zdot);
        } else {
            self.v.copy_from_slice(&to.state.v);
            engine.settle(system, to)?;
            for ((d, v), unprojected) in self.next.iter_mut().zip(&to.state.v).zip(&self.v) {
                *d += h * (v - unprojected);
            }
        }
        // the loop counts what was marched across
        to.state.modes.copy_from_slice(&from.state.modes);
        Ok(())
    }
}

impl Scheme for CentralDifference {
    fn restart(&mut self, _: &mut dyn System, _: &mut Engine, node: &Node, _: f64) -> Result<(), Why> {
        self.newton.forget();
        self.a.copy_from_slice(&node.a);
        self.belongs = 0.0;
        Ok(())
    }

    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        if !engine.is_fixed() {
            // there is no estimate of the error by which a step could be chosen
            return Err(Rejected { why: Why::StepSize, retry: 0.0 });
        }
        self.h = h;
        self.solve(system, engine, from, h, to).map_err(|why| Rejected { why, retry: 0.5 * h })
    }

    fn completes(&self) -> bool {
        true
    }

    fn accept(&mut self, _: &mut Engine, _: &Node, _: &Node) -> f64 {
        self.d.copy_from_slice(&self.next);
        self.a.copy_from_slice(&self.x.a);
        self.belongs = self.h;
        self.h
    }

    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why> {
        out.hermite(system, engine, from, to)
    }

    fn order(&self) -> usize {
        2
    }

    fn name(&self) -> &'static str {
        "central-difference"
    }
}
