//! The state at a root: on the constraints, and behind the root there, too.

use super::Integration;
use crate::System;
use crate::engine::Why;

/// First part of the step, and the growth from one to the next, by which a state is taken farther that the constraints have moved back before
/// its root; and the part up to which that is tried.
const FARTHER: f64 = 1e-10;
const GROWTH: f64 = 4.0;
const FARTHEST: f64 = 1e-4;

impl Integration {
    /// Ends the last step at its part `theta`, just behind a root of the continuous solution. That is as exact as the tolerance asks for, and
    /// what the constraints make of it may lie before the root of a contact: then its sense would be the old one, and it would be met again and
    /// again.
    pub(super) fn land(&mut self, system: &mut dyn System, theta: f64, root: usize) -> Result<(), Why> {
        self.end_at(system, theta)?;
        let pattern = system.pattern();
        let moves = pattern.acting.contains(&root) && pattern.striking.iter().all(|(striking, _)| *striking != root);
        if !moves || system.dims().rows() == 0 || !self.is_before(system, root) {
            return Ok(());
        }
        let mut part = FARTHER;
        while part <= FARTHEST && theta + part < 1.0 {
            self.end_at(system, theta + part)?;
            if !self.is_before(system, root) {
                return Ok(());
            }
            part *= GROWTH;
        }
        self.end_at(system, theta)
    }

    fn end_at(&mut self, system: &mut dyn System, theta: f64) -> Result<(), Why> {
        let (t, h) = (self.last.state.t, self.ahead.state.t - self.last.state.t);
        self.dense.evaluate(t + theta * h, &mut self.node.state);
        self.node.state.modes.copy_from_slice(&self.last.state.modes);
        self.engine.settle(system, &mut self.node)
    }

    /// Whether a root is on its positive side at the node.
    fn is_before(&mut self, system: &mut dyn System, root: usize) -> bool {
        let (state, a, lambda) = (&self.node.state, &self.node.a, &self.node.lambda);
        system.roots(state.at(), a, lambda, &mut self.probe);
        self.probe[root] > 0.0
    }
}
