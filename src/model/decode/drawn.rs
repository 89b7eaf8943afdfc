//! What a body is drawn as: points that outline it, a circle, solids.

use super::decoder::Decoder;
use crate::expression::Dimension;
use crate::model::bodies::{Circle, Solid, SolidForm};
use crate::model::fault::{At, Spot};
use crate::model::fields::{DIRECTION, LENGTH, POSITION, ROLL_PITCH_YAW, Shape, Size, one_of};
use crate::model::keys::{Entry, keys};
use crate::model::merge::Node;
use crate::model::rules::Rule;

keys! {
    /// A circle as outline.
    CIRCLE = CircleKeys "a circle" [] {
        circle: need LENGTH, "Radius.";
        at: may POSITION, "Centre in the body frame; its origin if omitted.";
        axis: may DIRECTION, "Spatial: what it is round about, body frame; z if omitted.";
    }
}

keys! {
    /// A solid.
    SOLID = SolidKeys "a solid" [one_of(&["box", "cylinder", "ball"])] {
        cuboid("box"): may Shape::List(&LENGTH, Size::Exactly(3)), "Sizes along its own axes.";
        cylinder: may LENGTH, "Radius of a cylinder about its own z axis.";
        length: may LENGTH, "Length of a cylinder.";
        ball: may LENGTH, "Radius.";
        at: may POSITION, "Middle in the body frame; its origin if omitted.";
        rpy: may ROLL_PITCH_YAW, "Orientation of its own axes in the body: turned about x, then y, then z.";
    }
}

/// Points, a circle, one solid or several.
pub(super) const DRAWN: Shape = Shape::Either(&[
    Shape::Map(&CIRCLE),
    Shape::Map(&SOLID),
    Shape::List(&Shape::Either(&[POSITION, Shape::Map(&SOLID)]), Size::AtLeast(1)),
]);

/// Whether the one table that a body is drawn as is a solid, not a circle.
fn is_solid(node: &Node<'_>) -> bool {
    ["box", "cylinder", "ball"].iter().any(|form| node.get(form).is_some()) && node.get("circle").is_none()
}

impl<'n> Decoder<'n> {
    /// The circle that a body is drawn as.
    pub(super) fn circle(&mut self, entry: Entry<'n>, at: &At<'_, 'n>) -> Option<Circle> {
        let circle = CircleKeys::of(entry.node.filter(|node| node.is_map() && !is_solid(node))?);
        let at = at.key(entry);
        let radius = self.size(circle.circle, &at, "the radius")?;
        let center = self.read_vector(circle.at, &at, Dimension::LENGTH).unwrap_or_default();
        if circle.axis.given() && self.name_space.components() == 2 {
            let fault = self.fault("spatial-only", &at.key(circle.axis), "an axis of a circle in the plane", "no `axis`");
            fault.spot = Spot::Key;
            fault.help = Some("remove it: in the plane circles are round about z".to_owned());
        }
        let axis = self.read_vector(circle.axis, &at, Dimension::NONE).unwrap_or_default();
        Some(Circle { radius, at: center, axis })
    }

    /// The solids that a body is drawn as.
    pub(super) fn solids(&mut self, entry: Entry<'n>, at: &At<'_, 'n>) -> Vec<Solid> {
        let at = at.key(entry);
        if let Some(solid) = entry.node.filter(is_solid) {
            return self.solid(solid, &at).into_iter().collect();
        }
        let (solids, points): (Vec<_>, Vec<_>) = entry.items().iter().map(Node::Plain).enumerate().partition(|(_, item)| item.is_map());
        if let ([_, ..], [(first, _), ..]) = (&solids[..], &points[..]) {
            let fault = self.fault("two-kinds", &at.index(*first), "a point in a list of solids", "solids alone, or points alone");
            fault.help = Some("draw the body by one of both; joints and points outside of its solids are shown as they are".to_owned());
        }
        solids.into_iter().filter_map(|(i, item)| self.solid(item, &at.index(i))).collect()
    }

    fn solid(&mut self, node: Node<'n>, at: &At<'_, 'n>) -> Option<Solid> {
        let keys = SolidKeys::of(node);
        if self.name_space.components() == 2 {
            let fault = self.fault("spatial-only", at, "a solid in the plane", "points `[x, y]`, or a circle");
            fault.help = Some("outline the body by points, or draw it as `{ circle: radius }`".to_owned());
            return None;
        }
        if keys.length.given() != keys.cylinder.given() {
            let [code, message] = if keys.length.given() {
                ["two-kinds", "a `length` without a `cylinder`"]
            } else {
                ["missing-key", "a `cylinder` without a `length`"]
            };
            self.fault(code, at, message, "`{ cylinder: radius, length: ... }`").spot = Spot::Key;
            return None;
        }
        let form = if keys.cuboid.given() {
            let here = at.key(keys.cuboid);
            let size = self.vector(keys.cuboid.node, &here, Dimension::LENGTH)?;
            size.iter().enumerate().for_each(|(i, id)| self.check(Rule::NotNegative("the size"), &[*id], &here.index(i)));
            SolidForm::Box { size: size.try_into().ok()? }
        } else if keys.cylinder.given() {
            SolidForm::Cylinder { radius: self.size(keys.cylinder, at, "the radius")?, length: self.size(keys.length, at, "the length")? }
        } else {
            SolidForm::Ball { radius: self.size(keys.ball, at, "the radius")? }
        };
        let center = self.read_vector(keys.at, at, Dimension::LENGTH).unwrap_or_default();
        let rpy = keys.rpy.node.and_then(|rpy| self.roll_pitch_yaw(rpy, &at.key(keys.rpy)));
        Some(Solid { form, at: center, rpy })
    }
}
