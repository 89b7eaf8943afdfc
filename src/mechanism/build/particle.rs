//! Point masses: bodies of `mass` alone, as far as nothing knows how they are turned.
//!
//! A rotation without inertia would leave M singular. Such a body has its place for coordinates and no others, its axes stay those
//! of the world, and the joints that leave all its rotations are rows between points.

use crate::model::{Body, CouplingKind, Joint, JointKind, LoadOn, Model, Quantity, SpringOn};

/// For each body, whether it is a point mass.
pub(super) fn particles(model: &Model, planar: bool) -> Vec<bool> {
    let pointlike = model.bodies.iter().enumerate().map(|(index, body)| index > 0 && is_point(body) && !is_turned(model, index));
    let mut found: Vec<bool> = pointlike.collect();
    for (index, joint) in model.joints.iter().enumerate() {
        let held = |point: bool, other: bool| match joint.kind {
            JointKind::Distance { .. } | JointKind::Spherical => false,
            JointKind::Revolute if planar => point && uses_coordinate(model, index, joint),
            // the slot is one of the first body
            JointKind::PinInSlot => point && !other,
            _ => point,
        };
        for (body, second) in [(joint.a.body, false), (joint.b.body, true)] {
            if held(found[body], second) {
                found[body] = false;
            }
        }
    }
    found
}

/// Whether all that a body has is a mass at its origin.
fn is_point(body: &Body) -> bool {
    let attached = body.attached.iter().all(|a| a.at == 0 && a.inertia.is_empty());
    // the points that every body has
    let bare = body.points.len() == 2;
    body.mass.is_some() && body.shape.is_none() && body.inertia.is_empty() && body.com.is_none() && attached && bare
}

/// Whether something turns a body, or names how it is turned.
fn is_turned(model: &Model, body: usize) -> bool {
    let named = |quantity: &Quantity| match *quantity {
        Quantity::Angle { body: b, .. } | Quantity::Spin { body: b, .. } | Quantity::Quaternion { body: b, .. } => b == body,
        _ => false,
    };
    let loaded = model.loads.iter().any(|load| match &load.on {
        LoadOn::Point { at, torque, frame, .. } => at.body == body && !torque.is_empty() || frame.body == body,
        LoadOn::Joint { .. } => false,
    });
    loaded || model.inputs.iter().any(named) || model.start.iter().any(|start| named(&start.quantity))
}

/// Whether something works on the coordinate of a joint, or names it.
fn uses_coordinate(model: &Model, index: usize, joint: &Joint) -> bool {
    let coupled = |kind: &CouplingKind| match *kind {
        CouplingKind::Gear { a, b, .. } => a == index || b == index,
        CouplingKind::Rack { pinion, slide, .. } => pinion == index || slide == index,
        CouplingKind::Zero(_) => false,
    };
    let named = |quantity: &Quantity| matches!(*quantity, Quantity::Joint { joint, .. } if joint == index);
    joint.damping.is_some()
        || joint.friction.is_some()
        || joint.has_stops()
        || model.drivers.iter().any(|d| d.joint == index)
        || model.motors.iter().any(|m| m.joint == index)
        || model.springs.iter().any(|s| matches!(s.on, SpringOn::Joint(j) if j == index))
        || model.loads.iter().any(|l| matches!(l.on, LoadOn::Joint { joint, .. } if joint == index))
        || model.events.iter().any(|e| e.restitution.as_ref().is_some_and(|r| r.joint == index))
        || model.couplings.iter().any(|c| coupled(&c.kind))
        || model.inputs.iter().any(named)
        || model.start.iter().any(|s| named(&s.quantity))
}
