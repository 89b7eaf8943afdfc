//! Switches that are only read: what columns and scalars ask for must not decide how the motion is computed.
//!
//! Such a switch is located as all others are, so that a kink of a column lies between two rows. Where that cannot be done (its root is
//! round-off around zero, as the difference of two rates that are equal, or changes faster than a step can be looked at, or without end)
//! it is given up for the rest of the run: its mode follows the values at the ends of steps, and the run tells it.

use super::Integration;
use super::zeno::Zeno;
use crate::engine::Why;
use crate::{Effect, System};

/// Crossings of one root that are located in a run.
const MOST_CROSSINGS: usize = 10_000;

impl Integration {
    /// Roots that are only read and were given up: their modes are those of the values at the ends of steps.
    pub fn given_up(&self) -> &[usize] {
        &self.given_up
    }

    /// Whether a root is only read.
    pub(super) fn observes(&self, root: usize) -> bool {
        self.observing[root] > 0
    }

    /// Looks for a root that is only read no longer, from the time `t` (s) on.
    pub(super) fn give_up(&mut self, root: usize, t: f64) {
        self.engine.counts.unresolved += 1;
        self.unresolved.get_or_insert((root, t));
        self.looked.retain(|looked| *looked != root);
        self.foresight.roots.retain(|timed| *timed != root);
        // what is known ahead may be of it
        self.foresight.until = f64::NEG_INFINITY;
        self.resolved = None;
        self.given_up.push(root);
    }

    /// Counts the event at hand of roots that are only read; one that piles up, or goes on without end, is given up.
    pub(super) fn count_observed(&mut self) {
        let t = self.node.state.t;
        let piles = self.observed.pile_up(t, self.start);
        if piles {
            self.observed = Zeno::default();
        }
        for k in 0..self.crossed.len() {
            let root = self.crossed[k];
            self.observing[root] += 1;
            if piles || self.observing[root] > MOST_CROSSINGS {
                self.give_up(root, t);
            }
        }
    }

    /// Gives the switches that were given up the modes of the values at the node.
    pub(super) fn follow_given_up(&mut self, system: &mut dyn System) {
        if self.given_up.is_empty() {
            return;
        }
        let (state, a, lambda) = (&self.node.state, &self.node.a, &self.node.lambda);
        system.roots(state.at(), a, lambda, &mut self.probe);
        for k in 0..self.given_up.len() {
            let root = self.given_up[k];
            if self.probe[root] < 0.0 {
                let effect = system.cross(root, &mut self.node.state, &mut self.row);
                debug_assert_eq!(effect, Effect::Record);
            }
        }
    }

    /// Gives up a root of time alone whose sign cannot be bounded, if it is only read.
    ///
    /// # Errors
    /// If it is not.
    pub(super) fn unbounded(&mut self, root: usize, t: f64) -> Result<(), Why> {
        if !self.observes(root) {
            return Err(Why::Unresolved(root));
        }
        self.give_up(root, t);
        Ok(())
    }
}
