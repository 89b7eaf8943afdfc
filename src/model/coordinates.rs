//! The coordinates of joints: their names, and what they are measured in.

use super::Model;
use super::entities::JointKind;
use super::fields::Want;
use crate::expression::Dimension;

/// A coordinate of a joint.
#[derive(Debug)]
pub(crate) struct Coordinate {
    /// Its name, that of its rate and that of its second rate.
    pub(crate) names: [&'static str; 3],
    /// Its number in the joint.
    pub(crate) slot: usize,
    /// Angle or length.
    pub(crate) angle: bool,
}

pub(super) const fn angle(names: [&'static str; 3], slot: usize) -> Coordinate {
    Coordinate { names, slot, angle: true }
}
pub(super) const fn length(names: [&'static str; 3], slot: usize) -> Coordinate {
    Coordinate { names, slot, angle: false }
}

pub(super) const ANGLE: [&str; 3] = ["angle", "omega", "alpha"];
pub(super) const POSITION: [&str; 3] = ["position", "velocity", "acceleration"];

/// The coordinates of a joint that have names.
pub(crate) fn coordinates(kind: &JointKind) -> &'static [Coordinate] {
    const HINGE: &[Coordinate] = &[angle(ANGLE, 0)];
    const SLIDE: &[Coordinate] = &[length(POSITION, 0)];
    const CYLINDER: &[Coordinate] = &[angle(ANGLE, 0), length(POSITION, 1)];
    const CROSS: &[Coordinate] = &[angle(["angle1", "omega1", "alpha1"], 0), angle(["angle2", "omega2", "alpha2"], 1)];
    const PLANE: &[Coordinate] = &[length(["x", "vx", "ax"], 0), length(["y", "vy", "ay"], 1), angle(ANGLE, 2)];
    match kind {
        JointKind::Revolute | JointKind::Screw { .. } => HINGE,
        JointKind::Slider => SLIDE,
        JointKind::Cylindrical => CYLINDER,
        JointKind::Universal { .. } => CROSS,
        JointKind::Planar => PLANE,
        JointKind::PinInSlot | JointKind::Fixed | JointKind::Distance { .. } | JointKind::Spherical => &[],
        JointKind::Free | JointKind::Particle => &[],
    }
}

/// Degrees of freedom that a joint leaves of as many as two bodies have against each other.
pub(crate) fn freedom(kind: &JointKind, whole: usize) -> usize {
    match kind {
        JointKind::Free | JointKind::Particle => whole,
        JointKind::Distance { .. } => whole - 1,
        JointKind::Spherical => 3,
        JointKind::PinInSlot => 2,
        _ => coordinates(kind).len(),
    }
}

impl Coordinate {
    /// Dimension of its rate of this order.
    pub(crate) fn dimension(&self, order: usize) -> Dimension {
        let base = if self.angle { Dimension::ANGLE } else { Dimension::LENGTH };
        base.div(Dimension::TIME.pow(order as i32))
    }

    /// Dimension of the generalised force that works on it.
    pub(crate) fn effort(&self) -> Dimension {
        if self.angle { Dimension::TORQUE } else { Dimension::FORCE }
    }
}

impl Model {
    /// Whether one driver moves the mechanism, and turns a joint.
    #[must_use]
    pub fn is_turned(&self) -> bool {
        let [driver] = &self.drivers[..] else { return false };
        coordinates(&self.joints[driver.joint].kind).iter().any(|c| c.slot == 0 && c.angle)
    }
}

/// What a value of a coordinate must be.
pub(crate) fn wanted_of(coordinate: Option<&Coordinate>) -> Want {
    match coordinate {
        Some(c) if !c.angle => Want::Of(Dimension::LENGTH),
        _ => Want::Angle,
    }
}
