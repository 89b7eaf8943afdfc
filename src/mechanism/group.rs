//! Bodies that hang together other than by the ground.

use crate::geometry::Space;
use crate::scalar::Scalar;

/// The road from the origin of the world to the reference point of a group.
#[derive(Clone, Debug, Default)]
pub struct Group<G: Space> {
    /// Frame of its first joint on the ground, m.
    pub(super) anchor: G::Vector,
    /// Slides of that joint along directions that stay: index in q, and the direction.
    pub(super) slides: Vec<(usize, G::Vector)>,
}

impl<G: Space> Group<G> {
    /// The reference point at the coordinates `q` (nq), m.
    #[inline(always)]
    #[must_use]
    pub fn reference(&self, q: &[G::S]) -> G::Vector {
        self.slides.iter().fold(self.anchor, |p, &(i, d)| p + d * G::S::constant(q[i].value()))
    }

    pub(super) fn lift<D: Scalar>(&self) -> Group<G::Lift<D>> {
        let slides = self.slides.iter().map(|&(i, d)| (i, G::lift_vector::<D>(d))).collect();
        Group { anchor: G::lift_vector::<D>(self.anchor), slides }
    }
}
