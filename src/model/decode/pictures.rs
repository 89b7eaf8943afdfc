//! What a study says of its drawing: points whose paths are drawn, and where the eye is.

use super::decoder::Decoder;
use crate::expression::Dimension;
use crate::model::fault::{At, Spot};
use crate::model::fields::{ANGLE, POINT, Shape, Size};
use crate::model::keys::{Entry, Words};
use crate::model::merge::Node;
use crate::model::place::PointRef;
use crate::model::study::{Side, View};

/// What `trace` takes.
pub(super) const TRACE: Shape = Shape::List(&POINT, Size::AtLeast(0));
/// What `view` takes.
pub(super) const VIEW: Shape = Shape::Either(&[Shape::Word(Side::WORDS), Shape::List(&ANGLE, Size::Exactly(2))]);

impl<'n> Decoder<'n> {
    /// Points whose paths are drawn, if the study names them.
    pub(super) fn trace(&mut self, asked: Entry<'n>, at: &At<'_, 'n>) -> Option<Vec<PointRef>> {
        let here = at.key(asked);
        asked.node?;
        let mut points = Vec::new();
        for (i, item) in asked.items().iter().enumerate() {
            let at = here.index(i);
            match self.point(Some(Node::Plain(item)), &at) {
                Some(point) if point.body == 0 => {
                    let help = "name a point of a body, as `rocker.tip`".to_owned();
                    self.fault("fixed-point", &at, "a point of the ground has no path", "a point of a moving body").help = Some(help);
                }
                point => points.extend(point),
            }
        }
        Some(points)
    }

    /// Where the eye is, if the study says so.
    pub(super) fn view(&mut self, asked: Entry<'n>, at: &At<'_, 'n>) -> Option<View> {
        let here = at.key(asked);
        let node = asked.node?;
        if self.name_space.components() == 2 {
            let fault = self.fault("spatial-only", &here, "a drawing in the plane has one view", "a key of a planar study");
            fault.spot = Spot::Key;
            fault.help = Some("remove it".to_owned());
            return None;
        }
        if let Some(side) = asked.word::<Side>() {
            return Some(View::Side(side));
        }
        let angles = self.vector(Some(node), &here, Dimension::ANGLE)?;
        let [azimuth, elevation] = angles[..] else { return None };
        Some(View::From { azimuth, elevation })
    }
}
