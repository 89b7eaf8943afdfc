//! The past that a multistep method needs behind a start, an event or a bridge.
//!
//! The motion is followed backwards by the classical Runge-Kutta method on the equations of index 1 with the modes of the new
//! side: its smooth continuation, which need not be the motion that really was. The differences of the points show at once which
//! order and step the tolerance allows. Where the past cannot be followed (a force that ends at the event, a fast mode that grows
//! backwards) there is one point only, by Taylor's formula, and order 1.

use super::control;
use super::history::History;
use crate::System;
use crate::engine::{Engine, Node, Why};

/// Scratch of the way back.
pub(super) struct Start {
    node: Node,
    stage: Node,
    /// q̇ of a stage (nq).
    rate: Vec<f64>,
    sums: [Vec<f64>; 3],
    difference: Vec<f64>,
}

/// Order and step (s) to begin with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct First {
    pub(super) order: usize,
    pub(super) h: f64,
}

/// Steps of Runge-Kutta's method from one point to the next where steps are given: they ask for no error at all.
const FINE: usize = 4;

/// Trials to find a step.
const TRIALS: usize = 6;

impl Start {
    /// Room for a system.
    pub(super) fn new(system: &dyn System) -> Self {
        let dims = system.dims();
        Self {
            node: Node::new(dims),
            stage: Node::new(dims),
            rate: vec![0.0; dims.q],
            sums: [vec![0.0; dims.q], vec![0.0; dims.v], vec![0.0; dims.z]],
            difference: vec![0.0; dims.q + dims.v + dims.z],
        }
    }

    /// Points for `order` at the distances of given steps, which come in turn: the last one before the start is `steps[1]`.
    pub(super) fn given(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        node: &Node,
        steps: [f64; 2],
        order: usize,
        history: &mut History,
    ) -> First {
        let gap = |i: usize| steps[(i + 1) % 2];
        let order = match self.back(system, engine, node, gap, (order, FINE), history) {
            Ok(()) => order,
            Err(_) => {
                self.taylor(system, node, steps[1], history);
                1
            }
        };
        First { order, h: steps[0] }
    }

    /// Points for the order and step that the tolerance allows; `h` (s) is a guess.
    pub(super) fn search(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        node: &Node,
        h: f64,
        (most, velocities): (usize, bool),
        history: &mut History,
    ) -> First {
        // strict tolerances pay for a high order from the first step on
        let points = (if engine.tolerance() < 1e-7 { 5 } else { 4 }).min(most + 1);
        let mut h = h;
        for trial in 0..TRIALS {
            if self.back(system, engine, node, |_| h, (points, 1), history).is_err() {
                h *= 0.1;
                continue;
            }
            let mut best = (0.0, 1);
            for order in 1..points {
                history.combine(&history.difference(order + 1, h), false, &mut self.difference);
                let error = control::norm(engine, node, &mut self.difference, velocities) / (order as f64 + 1.0);
                let factor = control::factor(error, order, control::SAME);
                if factor > best.0 {
                    best = (factor, order);
                }
            }
            let (factor, order) = best;
            if (0.5..4.0).contains(&factor) || (factor >= 4.0 && trial + 1 == TRIALS) {
                return First { order, h: h * factor.min(1.0) };
            }
            // from afar the factor is only a direction
            h *= if factor < 0.5 { (0.8 * factor).max(0.02) } else { (0.7 * factor).min(20.0) };
        }
        self.first_order(system, engine, node, h, velocities, history)
    }

    /// One point by Taylor's formula, and the step at which the next term of it meets the tolerance.
    fn first_order(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        node: &Node,
        h: f64,
        velocities: bool,
        history: &mut History,
    ) -> First {
        let reach = 1e-3 * h;
        let mut step = 0.1 * reach;
        if self.back(system, engine, node, |_| reach, (2, 1), history).is_ok() {
            history.combine(&history.difference(2, h), false, &mut self.difference);
            let error = 0.5 * control::norm(engine, node, &mut self.difference, velocities);
            if error.is_finite() {
                step = h * control::factor(error, 1, 2.0).min(1.0);
            }
        }
        self.taylor(system, node, step, history);
        First { order: 1, h: step }
    }

    /// The node, and y − h ẏ before it.
    fn taylor(&mut self, system: &dyn System, node: &Node, h: f64, history: &mut History) {
        let s = &node.state;
        system.rate(s.t, &s.q, &s.v, &mut self.rate);
        let past = &mut self.node.state;
        for (x, x0, rate) in [(&mut past.q, &s.q, &self.rate), (&mut past.v, &s.v, &node.a), (&mut past.z, &s.z, &node.zdot)] {
            for ((x, x0), r) in x.iter_mut().zip(x0).zip(rate) {
                *x = x0 - h * r;
            }
        }
        history.clear();
        history.push(s.t, [&s.q, &s.v, &s.z]);
        history.push_oldest(s.t - h, [&past.q, &past.v, &past.z]);
    }

    /// The node and `points` before it, each by `fine` steps.
    fn back(
        &mut self,
        system: &mut dyn System,
        engine: &mut Engine,
        node: &Node,
        gap: impl Fn(usize) -> f64,
        (points, fine): (usize, usize),
        history: &mut History,
    ) -> Result<(), Why> {
        self.node.copy_from(node);
        history.clear();
        history.push(node.state.t, [&node.state.q, &node.state.v, &node.state.z]);
        for point in 0..points {
            for _ in 0..fine {
                self.step(system, engine, -gap(point) / fine as f64)?;
            }
            let s = &self.node.state;
            history.push_oldest(s.t, [&s.q, &s.v, &s.z]);
        }
        Ok(())
    }

    /// One step of the classical Runge-Kutta method on the node, whose rates are known and will be.
    fn step(&mut self, system: &mut dyn System, engine: &mut Engine, h: f64) -> Result<(), Why> {
        let Self { node, stage, rate, sums, .. } = self;
        stage.copy_from(node);
        sums.iter_mut().for_each(|s| s.fill(0.0));
        for (place, weight) in [(0.5, 1.0 / 6.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 3.0), (0.0, 1.0 / 6.0)] {
            system.rate(stage.state.t, &stage.state.q, &stage.state.v, rate);
            for (sum, rate) in sums.iter_mut().zip([&*rate, &stage.a, &stage.zdot]) {
                sum.iter_mut().zip(rate).for_each(|(s, r)| *s += weight * r);
            }
            if place > 0.0 {
                let (s, s0) = (&mut stage.state, &node.state);
                s.t = s0.t + place * h;
                for (x, x0, rate) in [(&mut s.q, &s0.q, &*rate), (&mut s.v, &s0.v, &stage.a), (&mut s.z, &s0.z, &stage.zdot)] {
                    for ((x, x0), r) in x.iter_mut().zip(x0).zip(rate) {
                        *x = x0 + place * h * r;
                    }
                }
                accelerate(system, engine, stage)?;
            }
        }
        let s = &mut node.state;
        s.t += h;
        for (x, sum) in [&mut s.q, &mut s.v, &mut s.z].into_iter().zip(&*sums) {
            x.iter_mut().zip(sum).for_each(|(x, s)| *x += h * s);
        }
        accelerate(system, engine, node)
    }
}

/// Accelerations on the smooth continuation, if there is one.
fn accelerate(system: &mut dyn System, engine: &mut Engine, node: &mut Node) -> Result<(), Why> {
    engine.accelerate(system, node)?;
    if system.beyond() { Err(Why::NotFinite(0)) } else { Ok(()) }
}
