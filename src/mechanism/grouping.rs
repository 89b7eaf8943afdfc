//! Groups of bodies that hang together other than by the ground, each with a reference point near it.
//!
//! Moments are taken about that point, and the velocity of a body is that of its point which passes there. About the origin of the
//! world, bodies at the distance p would have inertias of m p², whose round-off hides their own, so that a mechanism would know
//! where the origin is. The point is fixed in the world during an evaluation, a function of q alone, and a plain number also where
//! q carries derivatives: what is taken about it is no rate of it. It stands where the first joint between the group and the ground
//! stands now, so that places near it are differences of places as early as they can be.

use super::group::Group;
use super::sets::Sets;
use super::{Mechanism, Step};
use crate::geometry::Space;

impl<G: Space> Mechanism<G> {
    /// Finds the groups: bodies of one tree branch, and bodies between which something is measured.
    pub(super) fn group(&mut self) {
        let mut sets = Sets::new(self.bodies.len());
        let branches = self.nodes.iter().map(|n| (n.parent, n.body));
        for (a, b) in branches.chain(self.gauges.iter().map(|g| (g.a, g.b))) {
            if a != 0 && b != 0 {
                sets.join(a, b);
            }
        }
        // group of each set
        let mut found: Vec<Option<usize>> = vec![None; self.bodies.len()];
        for node in &self.nodes {
            // parents come first: the first node of a group hangs on the ground
            let of = &mut found[sets.of(node.body)];
            if of.is_none() {
                *of = Some(self.groups.len());
                let slides = slides(&self.steps[node.steps.clone()], node.before.r).iter().map(|s| (s.q, s.along)).collect();
                self.groups.push(Group { anchor: node.before.p, slides });
            }
        }
        if self.groups.is_empty() {
            self.groups.push(Group::default());
        }
        self.group_of = (0..self.bodies.len()).map(|body| found[sets.of(body)].unwrap_or(0)).collect();
    }

    /// The group of what lies between two bodies, of which one may be the ground.
    #[inline(always)]
    #[must_use]
    pub fn group_between(&self, a: usize, b: usize) -> usize {
        self.group_of[a.max(b)]
    }
}

/// A slide along a direction that no coordinate turns.
pub(super) struct Slide<G: Space> {
    /// Index in q.
    pub(super) q: usize,
    /// Index in v.
    pub(super) v: usize,
    /// Direction in the world.
    pub(super) along: G::Vector,
    /// Whether its coordinate turns the body, too.
    pub(super) turns: bool,
}

/// The slides of a joint on the ground along directions that do not turn with its coordinates.
pub(super) fn slides<G: Space>(steps: &[Step<G>], before: G::Rotation) -> Vec<Slide<G>> {
    let (mut out, mut axes) = (Vec::new(), Vec::new());
    for step in steps {
        let Step::Axis { u, d, turns, slides, q, v } = *step else { break };
        if turns {
            axes.push(u);
        }
        if slides && axes.iter().all(|u| G::turn(*u, d) == G::Vector::default()) {
            out.push(Slide { q, v, along: G::rotate(before, d), turns });
        }
    }
    out
}
