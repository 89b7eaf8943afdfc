//! Where joints have friction: their normal forces by the rows of the cut joint.

use super::super::{Pressed, Pressing};
use super::builder::Builder;
use crate::geometry::Space;
use crate::model::{JointKind, Pressure};

impl<G: Space> Builder<'_, G> {
    /// The normal force of a joint that is cut, by its rows; its number.
    ///
    /// With the rows of `Shape::rows` the force on the second body is −λ along the direction of each slide, and the couple −λ w×u of a
    /// cosine between u and w. A guide of the length L with the force F across its axis n and the moment M bears at both ends,
    ///
    /// ```text
    /// F± = F/2 ± (M × n)/L,
    /// ```
    ///
    /// and without a length at the joint's point alone. A pin bears all of its force, in space that along the axis as well.
    pub(super) fn pressing(&mut self, joint: usize, by: Pressure) -> usize {
        let place = format!("{}.friction", self.model.joints[joint].place);
        let first = self.mechanism.joints[joint].rows.start;
        let components = |of: &[&[(usize, f64)]]| of.iter().map(|sum| sum.iter().map(|(k, c)| (first + k, *c)).collect()).collect();
        let pressed = |of: &[&[(usize, f64)]]| Pressed { components: components(of), side: 0 };
        let revolute = matches!(self.model.joints[joint].kind, JointKind::Revolute);
        let places = match by {
            _ if revolute && self.planar => vec![pressed(&[&[(0, -1.0)], &[(1, -1.0)]])],
            _ if revolute => vec![pressed(&[&[(0, -1.0)], &[(1, -1.0)], &[(2, -1.0)]])],
            Pressure::Guide { length: None } | Pressure::Pin if self.planar => vec![pressed(&[&[(0, -1.0)]])],
            Pressure::Guide { length: None } | Pressure::Pin => vec![pressed(&[&[(0, -1.0)], &[(1, -1.0)]])],
            Pressure::Guide { length: Some(length) } => {
                let arm = self.number(length, &place).recip();
                // planar rows: across the axis, angle; spatial: first and second across, first and second tilt, twist
                let end = |c: f64| match self.planar {
                    true => pressed(&[&[(0, -0.5), (1, -c)]]),
                    false => pressed(&[&[(0, -0.5), (2, -c)], &[(1, -0.5), (3, -c)]]),
                };
                vec![end(arm), end(-arm)]
            }
        };
        self.mechanism.pressings.push(Pressing { joint, places });
        self.mechanism.pressings.len() - 1
    }
}
