//! Forces that come from outside: motions of points, and wrenches on bodies as forces along the velocities.

use super::Dynamics;
use crate::geometry::{Force, Space};

impl<G: Space> Dynamics<'_, G> {
    /// Velocity of a point of a body, world axes, m/s; after [`Dynamics::velocity`].
    #[must_use]
    pub fn point_velocity(&self, body: usize, at: G::Vector) -> G::Vector {
        self.work.twists[body].at(self.work.places[body].point(at))
    }

    /// The wrench of a force and a moment, both in world axes, at a point of a body.
    #[must_use]
    pub fn wrench(&self, body: usize, at: G::Vector, force: G::Vector, moment: G::Spin) -> Force<G> {
        Force::at(force, self.work.places[body].point(at)) + Force::couple(moment)
    }

    /// f_k += s_k · Σ (wrenches on all that hangs on k); `wrenches` has one for each body, and is used up. After [`Dynamics::position`].
    pub fn add_wrenches(&self, wrenches: &mut [Force<G>], force: &mut [G::S]) {
        for node in self.mechanism.nodes.iter().rev() {
            let sum = wrenches[node.body];
            for k in node.columns.clone() {
                force[k] += sum.power(self.work.columns[k]);
            }
            if node.parent != 0 {
                wrenches[node.parent] += sum;
            }
        }
    }
}
