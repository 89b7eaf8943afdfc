//! Steps made again because an event lies early in them.
//!
//! Between two events a force may act in a zone that is much narrower than a step (the fall of friction with speed, a stiff stop that
//! is just touched). A step that reaches far beyond evaluates the force at none or few places of the zone, and its error estimate
//! does not know of it either. Made again to just behind the event it does.

use super::foresight::shortest;
use super::{Integration, Progress};
use crate::System;
use crate::engine::Why;

/// An event is early in this part of a step.
const EARLY: f64 = 0.1;

/// Nearer to the begin it is located to no part of its own.
const NEAREST: f64 = 1e-9;

/// The step made again is so many times as long as the way to the event.
const BEHIND: f64 = 1.05;

/// Shortest ways to an event that are stepped to, in the shortest steps that can be made.
const WORTH: f64 = 64.0;

impl Integration {
    /// Whether the last step reaches so far beyond a root at its place θ that it is to be made again.
    pub(super) fn is_early(&self, system: &dyn System, theta: f64, root: usize) -> bool {
        let (t, h) = (self.last.state.t, self.node.state.t - self.last.state.t);
        let chosen = !self.engine.is_fixed() && self.bridging.is_none() && !self.scheme.chooses_steps();
        // the rest of a step behind something recorded has been a whole step before
        let whole = self.dense.h <= h * (1.0 + 1e-9);
        let narrow = theta < EARLY && theta > NEAREST && theta * h > WORTH * shortest(t, self.goal);
        chosen && whole && narrow && system.pattern().forceful.contains(&root)
    }

    /// Makes the last step again, to just behind an event at its place θ.
    pub(super) fn repeat(&mut self, system: &mut dyn System, theta: f64) -> Result<Progress, Why> {
        let h = self.node.state.t - self.last.state.t;
        self.repeated.get_or_insert((self.h, self.resolved));
        self.node.copy_from(&self.last);
        self.engine.counts.steps -= 1;
        self.engine.counts.rejected += 1;
        self.h = BEHIND * theta * h;
        self.scheme.restart(system, &mut self.engine, &self.node, self.h)?;
        self.step(system, self.goal)
    }
}
