//! Switches of time alone: known before the step that would pass them.

use super::Integration;
use super::foresight::shortest;
use crate::engine::{Node, Why};
use crate::{Ahead, At, System};

/// Crossings of one root of time alone at one instant.
const MOST: usize = 3;

impl Integration {
    /// The time in (from, to] that a step may not pass: of the first root of time alone that leaves its positive side in the modes of
    /// the state at hand, or behind which nothing is known.
    ///
    /// # Errors
    /// If a root cannot be bounded at all.
    pub(super) fn foresee(&mut self, system: &mut dyn System, from: f64, to: f64) -> Result<Option<f64>, Why> {
        if self.foresight.roots.is_empty() {
            return Ok(None);
        }
        let Self { foresight, node, last, .. } = self;
        // a step that has been made began at the last node, one that is to be made begins at this one
        let state = if from < node.state.t { &last.state } else { &node.state };
        if foresight.modes != state.modes || foresight.until < from {
            foresight.modes.copy_from_slice(&state.modes);
            // what happens in the instant of a start or an event is crossed there
            (foresight.until, foresight.next, foresight.unknown) = (from + shortest(from, self.goal), None, false);
        }
        if foresight.next.is_none() && foresight.until < to {
            let mut at = state.at();
            at.t = foresight.until;
            match system.ahead(at, to, &foresight.roots) {
                Ahead::Clear => (foresight.until, foresight.unknown) = (to, false),
                Ahead::Crossing(t, root) => (foresight.until, foresight.next) = (t, Some((t, root))),
                Ahead::Unknown(t, root) if t <= foresight.until => {
                    self.unbounded(root, from)?;
                    return self.foresee(system, from, to);
                }
                Ahead::Unknown(t, _) => (foresight.until, foresight.unknown) = (t, true),
            }
        }
        Ok(foresight.next.map(|(t, _)| t).or(foresight.unknown.then_some(foresight.until)))
    }

    /// The root of time alone that leaves its positive side within the last step: θ and its number.
    pub(super) fn timed_crossing(&mut self, system: &mut dyn System) -> Result<Option<(f64, usize)>, Why> {
        let (from, to) = (self.last.state.t, self.node.state.t);
        self.foresee(system, from, to)?;
        let next = if self.foresight.roots.is_empty() { None } else { self.foresight.next };
        Ok(next.filter(|(t, _)| *t <= to).map(|(t, root)| (((t - from) / (to - from)).clamp(0.0, 1.0), root)))
    }

    /// A root of time alone that belongs to the instant of the node. Whether one that is zero there does so shows behind it, as far ahead
    /// as the next step will look. One that was crossed may be so again, by round-off of what another one has let jump.
    pub(super) fn also_timed(&mut self, system: &mut dyn System) -> Option<usize> {
        if self.foresight.roots.is_empty() {
            return None;
        }
        let Node { state, .. } = &self.node;
        let instant = state.t + shortest(state.t, self.goal);
        match system.ahead(state.at(), instant.max(state.t + self.h), &self.foresight.roots) {
            Ahead::Crossing(t, root) if t <= instant && self.crossed.iter().filter(|crossed| **crossed == root).count() < MOST => {
                Some(root)
            }
            _ => None,
        }
    }

    /// Crosses roots of time alone at a start, whose modes are those of a moment later, until they are those of its instant. Whether one that
    /// is zero there leaves its positive side may show much later, as that of a cosine does.
    pub(super) fn cross_timed_at_start(&mut self, system: &mut dyn System) -> Result<(), Why> {
        if self.foresight.roots.is_empty() {
            return Ok(());
        }
        for _ in 0..MOST * self.foresight.roots.len() {
            let moment = self.moment();
            let state = &mut self.node.state;
            let instant = state.t + shortest(state.t, self.goal);
            let to = instant.max(state.t + moment);
            let Ahead::Crossing(t, root) = system.ahead(At { t: instant, ..state.at() }, to, &self.foresight.roots) else { break };
            if t > instant {
                break;
            }
            system.cross(root, state, &mut self.row);
            self.engine.accelerate(system, &mut self.node)?;
        }
        Ok(())
    }
}
