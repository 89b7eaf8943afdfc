//! Radau IIA with three stages: order five, stiffly accurate, L-stable (Hairer & Wanner, Solving ODEs II, section IV.8).
//!
//! The state at the end of a step is that of the third stage. Orders of q and v: 5, but v 3 at [`Level::Position`] (section
//! VI.4, table of index 3). λ comes from the KKT system at the nodes.
//!
//! The estimate of the error belongs to an embedded formula of order three, while the method has order five: for a tolerance τ of
//! the estimate, h ∝ τ^¼ and the error of the run is ∝ h⁵ = τ^(5/4). That alone makes the scheme a hundred times too careful at
//! small tolerances. So the estimate is held against τ = κ tol^⅘ (in the spirit of radau5.f, which takes tol^⅔ for the error of
//! one step), and Newton's iteration against tol itself.

use crate::System;
use crate::dense_output::Dense;
use crate::engine::{Engine, Node, Rejected, Why};
use crate::scheme::{Level, Scheme};
use crate::settings::Settings;
use continuous::Continuous;
use estimate::Estimate;
use stages::Stages;

mod continuous;
mod estimate;
mod stages;
mod tableau;

/// κ: errors of a run of some seconds are then 0.03 to 11 times the tolerance (measured on six problems from 1e-4 to 1e-10).
const CARE: f64 = 0.1;

/// Part of the step that is thought to meet the tolerance which is taken.
const SAFETY: f64 = 0.9;

/// Bounds of the change of a step.
const SHRINK: f64 = 0.2;
const GROW: f64 = 8.0;

/// A change of the step by less is not worth new factors.
const HARDLY: f64 = 1.2;

/// The rate of Newton's iteration grows like h where G turns, so that iterations per second are fewest near the rate 1/e; below,
/// since the start of the iteration gets better, too, when h shrinks.
const BEST_RATE: f64 = 0.2;

/// τ/tol: the estimate that an accepted step may have, in units of the tolerance.
fn allowed(engine: &Engine) -> f64 {
    CARE * engine.tolerance().powf(-0.2)
}

/// Radau IIA with three stages.
pub(super) struct Radau5 {
    level: Level,
    stages: Stages,
    estimate: Estimate,
    /// The step tried last, its error, and those of the step accepted before.
    h: f64,
    error: f64,
    before: Option<[f64; 2]>,
    /// The begin and the events so far.
    restarts: usize,
    /// Whether a trial from this node has failed.
    rejected: bool,
    continuous: Continuous,
}

impl Radau5 {
    /// Room for a system.
    pub(super) fn new(settings: Settings, system: &dyn System) -> Self {
        let dims = system.dims();
        Self {
            level: settings.level,
            stages: Stages::new(settings.level, !settings.locate, system),
            estimate: Estimate::new(settings.level, dims),
            h: 0.0,
            error: 0.0,
            before: None,
            restarts: 0,
            rejected: false,
            continuous: Continuous::new(dims),
        }
    }

    /// Error of the trial, 1 at what is allowed.
    fn error(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64) -> Result<f64, Why> {
        let scale = allowed(engine).recip();
        let mut error = scale * self.estimate.norm(system, engine, from, &mut self.stages, h);
        if error >= 1.0 && (self.before.is_none() || self.rejected) {
            error = scale * self.estimate.again(system, engine, from, &mut self.stages, h)?;
        }
        // behind an event forces may be far stiffer than before
        if self.before.is_none() && self.restarts > 1 {
            error = error.max(scale * self.estimate.unfiltered(system, engine, from, &self.stages, h));
        }
        if error.is_finite() { Ok(error) } else { Err(Why::Newton) }
    }

    /// What the error allows of the next step, in parts of this one; slow iterations count as less safety.
    fn change(&self) -> f64 {
        let iterations = f64::from(self.stages.iterations);
        let safety = SAFETY * (21.0 / (20.0 + iterations)).min(1.0);
        (safety * self.error.max(1e-10).powf(-0.25)).clamp(SHRINK, GROW)
    }
}

impl Scheme for Radau5 {
    fn restart(&mut self, _: &mut dyn System, _: &mut Engine, _: &Node, _: f64) -> Result<(), Why> {
        self.stages.forget();
        (self.before, self.rejected) = (None, false);
        self.restarts += 1;
        Ok(())
    }

    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected> {
        self.h = h;
        let trial = self.stages.solve(system, engine, from, h);
        if let Err(why) = trial {
            self.rejected = true;
            let rate = self.stages.rate.max(BEST_RATE);
            return Err(Rejected { why, retry: h * (BEST_RATE / rate).clamp(0.1, 0.5) });
        }
        if !engine.is_fixed() {
            self.error = self.error(system, engine, from, h).map_err(|why| Rejected { why, retry: 0.25 * h })?;
            if self.error > 1.0 {
                let first = self.before.is_none() && !self.rejected;
                self.rejected = true;
                let change = if first { 0.1 } else { self.change().min(SAFETY) };
                return Err(Rejected { why: Why::Error(self.error), retry: h * change });
            }
        }
        let end = &self.stages.stage[2].state;
        to.state.copy_from(&from.state);
        to.state.t = from.state.t + h;
        to.state.q.copy_from_slice(&end.q);
        to.state.v.copy_from_slice(&end.v);
        to.state.z.copy_from_slice(&end.z);
        if self.level == Level::Acceleration {
            engine.settle(system, to).map_err(|why| Rejected { why, retry: 0.25 * h })?;
        }
        Ok(())
    }

    fn completes(&self) -> bool {
        self.level == Level::Acceleration
    }

    /// Gustafsson's predictive control: the error of the last two steps tells how it will go on (IV.8.23).
    fn accept(&mut self, engine: &mut Engine, _: &Node, _: &Node) -> f64 {
        let h = self.h;
        self.stages.accept(h);
        if engine.is_fixed() {
            return h;
        }
        let mut change = self.change();
        let error = self.error.max(1e-10);
        if let Some([h_before, error_before]) = self.before {
            let predicted = SAFETY * h / h_before * (error_before / (error * error)).powf(0.25);
            change = change.min(predicted.clamp(SHRINK, GROW));
        }
        if self.rejected {
            change = change.min(1.0);
        }
        let rate = self.stages.rate;
        if rate > BEST_RATE / GROW {
            change = change.min((BEST_RATE / rate).max(0.5));
        }
        self.before = Some([h, self.error.max(1e-2)]);
        self.rejected = false;
        if (1.0..HARDLY).contains(&change) && self.stages.keeps_factors() { h } else { h * change }
    }

    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why> {
        out.hermite(system, engine, from, to)?;
        if let Some(stages) = self.stages.accepted() {
            self.continuous.choose(engine, [from, to], stages, allowed(engine), out);
        }
        Ok(())
    }

    fn is_implicit(&self) -> bool {
        true
    }

    fn order(&self) -> usize {
        5
    }

    fn name(&self) -> &'static str {
        "radau5"
    }
}
