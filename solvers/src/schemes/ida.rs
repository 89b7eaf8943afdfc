//! IDA of SUNDIALS (Hindmarsh et al. 2005): backward differences of order 1 to 5 with fixed leading coefficient, on the equations
//! of Gear, Gupta & Leimkuhler (1985).
//!
//! ```text
//! q̇ = N(q) (v − D⁻¹Gᵀμ)        Φ = 0             y = (q, v, z, λ, μ), index 2;
//! M v̇ + Gᵀλ = f                G v = ν           λ and μ are algebraic and not in the error test
//! ż = g(t, q, v, z)
//! ```
//!
//! D is the constant diagonal metric of the pattern. q is a vector: a displacement of the tangent is (NᵀN)⁻¹Nᵀ δq, exact since
//! poses are homogeneous of degree 0 in a quaternion. The constraint rows are always these, whatever the
//! [`Level`](crate::Level), and IDA chooses its steps itself: given steps are only the longest that it may take.

use crate::System;
use crate::dense_output::Dense;
use crate::engine::{Control, Engine, Node, Rejected, Why};
use crate::scheme::Scheme;
use c::{Failure, Solver, Spent};
use equations::{Layout, Lent, PART, Work};

mod c;
mod equations;

/// IDA over a system.
pub(super) struct Ida {
    solver: Solver,
    layout: Layout,
    work: Work,
    follow: bool,
    /// Time that IDA has reached; none if it must start afresh.
    reached: Option<f64>,
    /// First step of a fresh start, s.
    first: f64,
    spent: Spent,
    scratch: Node,
    jerk: Vec<f64>,
}

impl Ida {
    /// Room for a system; `follow` if modes are taken from the state in each evaluation.
    pub(super) fn new(system: &dyn System, follow: bool) -> Self {
        let dims = system.dims();
        let layout = Layout::new(dims);
        let differential: Vec<_> = (0..layout.size()).map(|i| i < layout.differential()).collect();
        Self {
            solver: Solver::new(&differential),
            layout,
            work: Work::new(dims, system.pattern()),
            follow,
            reached: None,
            first: 0.0,
            spent: Spent::default(),
            scratch: Node::new(dims),
            jerk: vec![0.0; dims.v],
        }
    }

    /// A first step of order 1, at most h: its error h²/2 (v̇, v̈, z̈) is half of what is allowed, by differences along the motion.
    fn first_step(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node, h: f64) -> f64 {
        if engine.is_fixed() {
            return h;
        }
        let largest = |x: &[f64]| x.iter().zip(&engine.size_v).fold(0.0, |m, (x, size)| f64::max(m, x.abs() / size));
        let reach = 1e-3 / largest(&node.state.v).max(largest(&node.a).sqrt()).max(1.0);
        if engine.jerk(system, node, reach, &mut self.scratch, &mut self.jerk).is_err() {
            // IDA finds its own way down from what is too long, and says what cannot be evaluated
            return 1e-3 * h;
        }
        let ahead = &mut self.scratch.zdot;
        ahead.iter_mut().zip(&node.zdot).for_each(|(x, r)| *x = (*x - r) / reach);
        let norm = engine.step_norm(&node.state, &node.a, &self.jerk, ahead);
        if norm > 0.0 { h.min((PART / norm).sqrt()) } else { h }
    }

    /// Starts IDA at a node: y and ẏ are known exactly but for the rates of the multipliers, which do not matter.
    fn begin(&mut self, system: &dyn System, engine: &Engine, node: &Node) {
        let layout = self.layout;
        let state = &node.state;
        self.solver.begin(state.t, self.first, |y, rates| {
            rates.fill(0.0);
            let [q, v, z, lambda, mu] = layout.split_mut(y);
            let [qdot, vdot, zdot, ..] = layout.split_mut(rates);
            for (to, from) in [(q, &state.q), (v, &state.v), (z, &state.z), (lambda, &node.lambda), (vdot, &node.a), (zdot, &node.zdot)] {
                to.copy_from_slice(from);
            }
            mu.fill(0.0);
            system.rate(state.t, &state.q, &state.v, qdot);
        });
        if let Control::Steps(steps) = engine.control {
            self.solver.set_longest(steps[0].min(steps[1]));
        }
        self.spent = Spent::default();
        self.reached = Some(state.t);
    }

    /// Adds what IDA has spent since it was asked last.
    fn count(&mut self, engine: &mut Engine) {
        let (now, before) = (self.solver.spent(), self.spent);
        let counts = &mut engine.counts;
        counts.rejected += now.rejected - before.rejected;
        counts.factorisations += now.jacobians - before.jacobians;
        counts.iterations += now.iterations - before.iterations;
        self.spent = now;
    }
}

/// Whether two times are the same but for rounding.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 8.0 * f64::EPSILON * a.abs()
}

impl Scheme for Ida {
    fn restart(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node, h: f64) -> Result<(), Why> {
        self.first = self.first_step(system, engine, node, h);
        self.reached = None;
        Ok(())
    }

    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        if let Some(t) = self.reached
            && !same(t, from.state.t)
        {
            // the step that led here was not taken by the loop
            self.first = self.first.min(0.25 * (t - from.state.t));
            self.reached = None;
        }
        if self.reached.is_none() {
            self.begin(system, engine, from);
        }
        self.work.state.copy_from(&from.state);
        let mut lent = Lent { system: &mut *system, engine: &mut *engine, work: &mut self.work, follow: self.follow, why: None };
        let result = self.solver.step(&mut lent, from.state.t + h);
        let why = lent.why;
        self.count(engine);
        match result {
            Ok(t) => {
                self.reached = Some(t);
                to.state.copy_from(&from.state);
                to.state.t = t;
                let [q, v, z, ..] = self.layout.split(self.solver.y());
                to.state.q.copy_from_slice(q);
                to.state.v.copy_from_slice(v);
                to.state.z.copy_from_slice(z);
                engine.settle(system, to).map_err(|why| Rejected { why, retry: 0.25 * (t - from.state.t) })
            }
            Err(failure) => {
                self.reached = None;
                self.first = 0.25 * self.solver.next().min(self.first).min(h);
                let why = if failure == Failure::Error { Why::Error(2.0) } else { why.unwrap_or(Why::Newton) };
                Err(Rejected { why, retry: self.first })
            }
        }
    }

    /// The nodes are projected, which is less than Newton's method leaves; IDA's own history is not.
    fn completes(&self) -> bool {
        true
    }

    fn chooses_steps(&self) -> bool {
        true
    }

    fn accept(&mut self, _: &mut Engine, _: &Node, _: &Node) -> f64 {
        let next = self.solver.next();
        self.first = next;
        next
    }

    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why> {
        out.hermite(system, engine, from, to)
    }

    fn is_implicit(&self) -> bool {
        true
    }

    fn order(&self) -> usize {
        self.reached.map_or(1, |_| self.solver.order())
    }

    fn name(&self) -> &'static str {
        "ida"
    }
}
