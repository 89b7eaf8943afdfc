//! What fields take, and how they are written.

use crate::expression::Dimension as D;
use crate::model::fields::Shape::{Either, List, Name, Value};
use crate::model::fields::{Choice, Field, Shape, Size, Want};

pub(super) const fn need(key: &'static str, shape: Shape, doc: &'static str) -> Field {
    Field { key, shape, required: true, doc }
}
pub(super) const fn may(key: &'static str, shape: Shape, doc: &'static str) -> Field {
    Field { key, shape, required: false, doc }
}
pub(super) const fn one_of(keys: &'static [&'static str]) -> Choice {
    Choice { keys, required: true }
}
pub(super) const fn at_most_one(keys: &'static [&'static str]) -> Choice {
    Choice { keys, required: false }
}

pub(super) const LENGTH: Shape = Value(Want::Of(D::LENGTH));
pub(super) const MASS: Shape = Value(Want::Of(D::MASS));
pub(super) const INERTIA: Shape = Value(Want::Of(D::INERTIA));
pub(super) const TIME: Shape = Value(Want::Of(D::TIME));
pub(super) const NUMBER: Shape = Value(Want::Of(D::NONE));
pub(super) const ANGLE: Shape = Value(Want::Angle);
pub(super) const ANY: Shape = Value(Want::Any);
/// Angle or length, as the joint has it.
pub(super) const COORDINATE: Shape = Value(Want::Varies("an angle (rad) or a length (m), as the joint has it"));
pub(super) const EFFORT: Shape = Value(Want::Varies("a torque (N m) or a force (N), as the joint has it"));
pub(super) const STIFFNESS: Shape = Value(Want::Varies("a stiffness: N/m, or N m/rad for an angle"));
pub(super) const DAMPING: Shape = Value(Want::Varies("a damping: N s/m, or N m s/rad for an angle"));
pub(super) const RATE: Shape = Value(Want::Varies("a speed (m/s) or an angular speed (rad/s)"));
pub(super) const FRICTION_LEVEL: Shape =
    Value(Want::Varies("a torque (N m) or a force (N), as the joint has it, or a coefficient of friction"));
pub(super) const BRISTLE_STIFFNESS: Shape =
    Value(Want::Varies("a stiffness: N/m or N m/rad; with a coefficient of friction 1/m, or a plain number"));
pub(super) const BRISTLE_DAMPING: Shape = Value(Want::Varies("a damping: N s/m or N m s/rad; with a coefficient of friction s/m, or s"));
pub(super) const ROLL_PITCH_YAW: Shape = List(&ANGLE, Size::Exactly(3));
pub(super) const POSITION: Shape = List(&LENGTH, Size::Space);
pub(super) const DIRECTION: Shape = List(&NUMBER, Size::Space);
pub(super) const POINT: Shape = Name("a point `body.point`, or a body for its origin");
pub(super) const JOINT_NAME: Shape = Name("the name of a joint");
pub(super) const FIGURES: Shape = Either(&[INERTIA, List(&INERTIA, Size::OneOf(&[1, 3, 6]))]);
