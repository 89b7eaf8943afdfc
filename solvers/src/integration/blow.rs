//! The blows of one event, and what they pass on.

use super::Integration;
use crate::engine::Why;
use crate::engine::blows::Blow;
use crate::{Effect, System};

impl Integration {
    /// Adds the blow that the crossing of a root has asked for, along the row that it wrote.
    pub(super) fn add_blow(&mut self, system: &mut dyn System, root: usize, restitution: f64) {
        let swept: f64 = self.row.iter().zip(&self.node.state.v).map(|(r, v)| r * v).sum();
        // where a rate has a part that time prescribes, a plastic blow has a restitution that takes it away as well
        let closing = system.pattern().closing.contains(&root).then_some(restitution * swept);
        self.blows.push(Blow { root, row: self.row.clone(), restitution, closing });
    }

    /// Lets the blows of the event at hand act on its velocities, with what takes part in them because they would make its rate negative;
    /// whether the run ends there is added to `stop`.
    ///
    /// Returns the root of a blow that the constraints hold.
    pub(super) fn blow(&mut self, system: &mut dyn System, stop: &mut bool) -> Result<Option<usize>, Why> {
        let before = if system.pattern().closing.is_empty() { Vec::new() } else { self.node.state.v.clone() };
        let mut held = self.engine.impulses(system, &mut self.node.state, &self.blows)?;
        while held.is_none()
            && let Some(root) = self.closes(system)
        {
            self.crossed.push(root);
            match system.cross(root, &mut self.node.state, &mut self.row) {
                Effect::Impulse { restitution, stops } | Effect::Bounce { restitution, stops } => {
                    *stop |= stops;
                    self.add_blow(system, root, restitution);
                    self.node.state.v.copy_from_slice(&before);
                    held = self.engine.pass_on(system, &mut self.node.state, &self.blows)?;
                }
                effect => *stop |= effect == Effect::Stop,
            }
        }
        Ok(held)
    }

    /// A rate that the blows have made negative though it does not become so, and that takes no part in them yet.
    fn closes(&mut self, system: &mut dyn System) -> Option<usize> {
        if system.pattern().closing.is_empty() {
            return None;
        }
        let (state, a, lambda) = (&self.node.state, &self.node.a, &self.node.lambda);
        system.roots(state.at(), a, lambda, &mut self.probe);
        system.pattern().closing.iter().copied().find(|root| self.probe[*root] < 0.0 && !self.crossed.contains(root))
    }
}
