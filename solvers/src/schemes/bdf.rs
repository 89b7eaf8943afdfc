//! Backward differences of orders 1 to 5 with variable steps.
//!
//! With P the polynomial of degree k through the last k + 1 states y = (q, v, z), the new state solves
//!
//! ```text
//! ẏ = Ṗ(t) + (y − P(t))/c,   q̇ = N(q) v
//! c = h/Σ 1/j                 adaptive steps: fixed leading coefficient, factors outlive a change of the steps behind
//! c = 1/Σ 1/(t − t_{n+1−j})   given steps: the points themselves, stable where steps alternate 1 : 1.5 or 1 : 2
//! ```
//!
//! (j = 1 to k; Brenan, Campbell & Petzold 1996, Numerical Solution of Initial-Value Problems in DAEs, section 5.2). q is a vector
//! in ℝ^nq: the step is q = q̂ + N(q)(c v + w) with q̂ = P − c Ṗ. The norm of a quaternion has no meaning for a pose, but stays in
//! the error test and is not renewed (measured on a top that spins at 200 rad/s: in a second it drifts by 3 tolerances of 1e-4 or
//! 50 of 1e-10).
//!
//! The error is (y − P) max(|S h − Σ 1/j|, h/(t − t_{n−k})), S = Σ 1/(t − t_{n+1−j}) to j = k + 1 (section 5.2.2 there), times the
//! caution of [`control::norm`]. Multipliers are not in it, nor velocities at index 3.

use crate::System;
use crate::dense_output::Dense;
use crate::engine::{Control, Engine, Node, Rejected, Why};
use crate::matrix::Coefficients;
use crate::newton::{Implicit, Newton, Place, Unknown};
use crate::scheme::{Level, Scheme};
use crate::settings::Settings;
use control::ORDER;
use history::History;
use start::Start;

mod control;
mod history;
mod start;

/// Backward differences.
pub(super) struct Bdf {
    level: Level,
    follow: bool,
    /// Orders allowed, lowest and highest.
    orders: [usize; 2],
    order: usize,
    history: History,
    newton: Newton,
    unknown: Unknown,
    start: Start,
    /// P, Ṗ and ŷ at the new time, and the error (nq + nv + nz each).
    predicted: Vec<f64>,
    rate: Vec<f64>,
    hat: Vec<f64>,
    error: Vec<f64>,
    /// Norm of the error of the last trial.
    size: f64,
    /// Step of the last trial, s.
    h: f64,
    /// Step proposed last, s.
    proposed: f64,
    /// First step after a restart (s); infinite when it is done.
    first: f64,
    /// Whether order and step still grow towards what the tolerance allows.
    starting: bool,
    /// Steps since order or step was changed.
    steady: usize,
    /// Trials rejected in a row.
    failures: usize,
    /// Whether the step accepted last has taken the place of the newest point.
    replaced: bool,
}

/// A step shorter than this part of what was proposed (cut by the end of a span) replaces the newest point: points that lie close
/// together would magnify round-off.
const SHORT: f64 = 0.1;

/// A longer step must be worth a new factorisation.
const WORTH: f64 = 1.2;

/// Steps grow at most by this factor at once.
const GROWTH: f64 = 2.0;

impl Bdf {
    /// Room for a system; `order` fixes the order, which is 2 for given steps if it is silent.
    pub(super) fn new(order: Option<usize>, settings: Settings, system: &dyn System) -> Self {
        let dims = system.dims();
        let n = dims.q + dims.v + dims.z;
        let mut newton = Newton::new(system);
        newton.trust = 0.3;
        let orders = match (order, settings.control) {
            (Some(k), _) => [k.clamp(1, ORDER); 2],
            (None, Control::Tolerance(_)) => [1, ORDER],
            // the highest that is stable for every oscillation
            (None, Control::Steps(_)) => [2, 2],
        };
        Self {
            level: settings.level,
            follow: !settings.locate,
            orders,
            order: orders[1].min(3),
            history: History::new(n),
            newton,
            unknown: Unknown::new(dims),
            start: Start::new(system),
            predicted: vec![0.0; n],
            rate: vec![0.0; n],
            hat: vec![0.0; n],
            error: vec![0.0; n],
            size: 0.0,
            h: 0.0,
            proposed: 0.0,
            first: f64::INFINITY,
            starting: true,
            steady: 0,
            failures: 0,
            replaced: false,
        }
    }

    /// Whether errors of velocities count.
    fn velocities(&self, engine: &Engine) -> bool {
        self.level != Level::Position || engine.dims.holonomic == 0
    }

    /// P, Ṗ and ŷ at t + h; returns c and the factor of the error.
    fn predict(&mut self, engine: &Engine, t: f64, h: f64) -> [f64; 2] {
        self.history.set_time(t);
        let (k, next) = (self.order, t + h);
        let gaps = self.history.times().iter().map(|past| (next - past).recip());
        let (sum, gamma) = (gaps.clone().take(k).sum::<f64>(), control::gamma(k));
        let last = gaps.clone().nth(k).unwrap_or(0.0);
        let c = if engine.is_fixed() { sum.recip() } else { h / gamma };
        let [value, rate] = self.history.lagrange(next, k + 1);
        let mut hat = value;
        hat.iter_mut().zip(&rate).for_each(|(x, r)| *x -= c * r);
        self.history.combine(&value, true, &mut self.predicted);
        self.history.combine(&rate, false, &mut self.rate);
        self.history.combine(&hat, true, &mut self.hat);
        [c, (h * (sum + last) - gamma).abs().max(h * last)]
    }

    /// Solves the step; `to` receives t, q, v, z.
    fn solve(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, c: f64, to: &mut Node) -> Result<(), Why> {
        let (nq, nv) = (engine.dims.q, engine.dims.v);
        let x = &mut self.unknown;
        x.a.copy_from_slice(&self.rate[nq..nq + nv]);
        x.zdot.copy_from_slice(&self.rate[nq + nv..]);
        x.lambda.copy_from_slice(&from.lambda);
        x.w.fill(0.0);
        let (q, rest) = self.hat.split_at(nq);
        let (v, z) = rest.split_at(nv);
        let stage = Implicit {
            t: from.state.t + h,
            span: c,
            q,
            d: &[],
            v,
            z,
            c: Coefficients { q: c * c, v: c, z: c },
            place: Place::Displace,
            level: self.level,
            follow: self.follow,
        };
        to.state.copy_from(&from.state);
        self.newton.solve(system, engine, &stage, x, &mut to.state)
    }

    /// Order and step after a success.
    fn next(&mut self, engine: &Engine, to: &Node) -> f64 {
        let h = self.h;
        if let Control::Steps(_) = engine.control {
            // orders are built up where the past could not be followed
            self.order = (self.order + 1).min(self.orders[1]).min(self.history.count() - 1);
            return h;
        }
        let velocities = self.velocities(engine);
        let choice = control::choose(engine, &self.history, to, (self.order, self.orders), h, (&mut self.error, velocities));
        if self.starting {
            self.starting = choice.factor >= WORTH || choice.order > self.order;
        } else if self.steady <= self.order && choice.factor >= 0.9 {
            return h;
        }
        if choice.order == self.order && (0.9..WORTH).contains(&choice.factor) {
            return h;
        }
        (self.order, self.steady) = (choice.order, 0);
        h * if choice.factor < WORTH { choice.factor.clamp(0.5, 1.0) } else { choice.factor.min(GROWTH) }
    }

    /// The step after an error that was too large: the order falls when it happens again, as behind a jump.
    fn shorter(&mut self, h: f64) -> f64 {
        self.failures += 1;
        let factor = control::factor(self.size, self.order, control::SAME).clamp(0.2, 0.9);
        if self.orders[0] < self.order {
            match self.failures {
                1 => {}
                2 => self.order -= 1,
                _ => self.order = self.orders[0],
            }
        }
        (self.starting, self.steady, self.proposed) = (false, 0, h * factor);
        self.proposed
    }
}

impl Scheme for Bdf {
    fn restart(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node, h: f64) -> Result<(), Why> {
        self.newton.forget();
        let first = match engine.control {
            Control::Steps(steps) => self.start.given(system, engine, node, steps, self.orders[1], &mut self.history),
            Control::Tolerance(_) => {
                let velocities = self.velocities(engine);
                self.start.search(system, engine, node, h, (self.orders[1], velocities), &mut self.history)
            }
        };
        (self.order, self.first, self.proposed, self.starting) = (first.order, first.h, first.h, true);
        (self.steady, self.failures, self.replaced) = (0, 0, false);
        Ok(())
    }

    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        if !engine.is_fixed() && h > 1.1 * self.first {
            return Err(Rejected { why: Why::Error(h / self.first), retry: self.first });
        }
        self.h = h;
        let [c, weight] = self.predict(engine, from.state.t, h);
        if let Err(why) = self.solve(system, engine, from, h, c, to) {
            (self.starting, self.steady, self.proposed) = (false, 0, 0.25 * h);
            return Err(Rejected { why, retry: 0.25 * h });
        }
        let s = &to.state;
        let new = s.q.iter().chain(&s.v).chain(&s.z);
        for ((e, y), p) in self.error.iter_mut().zip(new).zip(&self.predicted) {
            *e = weight * (y - p);
        }
        let velocities = self.velocities(engine);
        self.size = control::norm(engine, from, &mut self.error, velocities);
        if !engine.is_fixed() && (self.size.is_nan() || self.size > 1.0) {
            return Err(Rejected { why: Why::Error(self.size), retry: self.shorter(h) });
        }
        if self.completes() {
            engine.settle(system, to).map_err(|why| Rejected { why, retry: 0.25 * h })?;
        }
        Ok(())
    }

    fn completes(&self) -> bool {
        self.level == Level::Acceleration
    }

    fn accept(&mut self, engine: &mut Engine, _: &Node, to: &Node) -> f64 {
        let s = &to.state;
        self.replaced = self.h < SHORT * self.proposed;
        if self.replaced {
            self.history.replace(s.t, [&s.q, &s.v, &s.z]);
        } else {
            self.history.push(s.t, [&s.q, &s.v, &s.z]);
        }
        (self.first, self.failures) = (f64::INFINITY, 0);
        self.steady += 1;
        self.proposed = self.next(engine, to);
        self.proposed
    }

    /// The polynomial through the last k + 1 points: as accurate inside of a step as Hermite's interpolant (measured, orders 1 to 5),
    /// without an evaluation.
    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why> {
        if self.replaced {
            return out.hermite(system, engine, from, to);
        }
        let h = to.state.t - from.state.t;
        let points = (self.order + 1).min(self.history.count());
        self.history.polynomial(from.state.t, h, points, engine.dims, out);
        Ok(())
    }

    fn is_implicit(&self) -> bool {
        true
    }

    fn order(&self) -> usize {
        self.order
    }

    fn name(&self) -> &'static str {
        "bdf"
    }
}
