//! Switches of what other switches let jump, as `floor(mod(x, 1)/0.5)`: what is inside is crossed first, and what its jump leaves on the wrong
//! side is crossed with it, once more if it has been crossed before.

use super::Integration;
use crate::engine::Node;
use crate::{Effect, System};

/// Crossings at one event for each root, behind which there is no end of them.
const MOST: usize = 16;

impl Integration {
    /// The root to begin with where several leave their positive side at one place, of which `found` is one: the first in their order, in
    /// which what others are made of stands before them.
    pub(super) fn innermost(&mut self, system: &mut dyn System, found: usize) -> usize {
        self.jumped.clear();
        if !system.pattern().nested.contains(&found) {
            return found;
        }
        let first = self.also_crossed(system).filter(|root| *root < found && system.pattern().nested.contains(root));
        first.unwrap_or(found)
    }

    /// Crosses a root, and notes which others that lets jump to their negative side: nothing else changes with the modes at one state.
    pub(super) fn cross(&mut self, system: &mut dyn System, root: usize) -> Effect {
        self.crossed.push(root);
        self.jumped.retain(|jumped| *jumped != root);
        let Node { state, a, lambda, .. } = &mut self.node;
        if !system.pattern().nested.contains(&root) || self.crossed.len() > MOST * self.looked.len() {
            return system.cross(root, state, &mut self.row);
        }
        system.roots(state.at(), a, lambda, &mut self.near_side);
        let effect = system.cross(root, state, &mut self.row);
        self.note_jumped(system, root);
        effect
    }

    /// Notes which nested roots the new mode of a nested one lets jump to their negative side, from `near_side`: those of the node before.
    pub(super) fn note_jumped(&mut self, system: &mut dyn System, root: usize) {
        if !system.pattern().nested.contains(&root) {
            return;
        }
        let Node { state, a, lambda, .. } = &self.node;
        system.roots(state.at(), a, lambda, &mut self.probe);
        let jumps = |other: &usize| self.probe[*other] < self.near_side[*other].min(0.0) && self.looked.contains(other);
        for &other in system.pattern().nested.iter().filter(|other| **other != root && jumps(other)) {
            if !self.jumped.contains(&other) {
                self.jumped.push(other);
            }
        }
    }
}
