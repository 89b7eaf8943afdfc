//! Unit texts of columns: the SI unit of the dimension, and `rad` where an expression measures an angle.
//!
//! rad is 1, so the dimension alone does not tell an angle from a number. An expression is an angle if it is a sum or a
//! multiple of angles of bodies and joints; rates of angles are in rad/s and rad/s².

use grashof::expression::{Dimension, Id, Node};
use grashof::model::{JointKind, Model, Quantity};

/// Unit of an expression of a model.
pub(super) fn unit(model: &Model, id: Id, dimension: Dimension) -> String {
    let si = dimension.si();
    if !angular(model, id, 0) {
        return si;
    }
    match si.as_str() {
        "" => "rad".into(),
        "1/s" => "rad/s".into(),
        "1/s^2" => "rad/s^2".into(),
        other => other.into(),
    }
}

fn angular(model: &Model, id: Id, depth: usize) -> bool {
    if depth > 64 {
        return false;
    }
    let inner = |id: Id| angular(model, id, depth + 1);
    let plain = |id: Id| model.pool.inputs_of(&[id]).is_empty();
    match model.pool.node(id) {
        Node::Input(i) => match model.inputs[i as usize] {
            Quantity::Angle { .. } | Quantity::Spin { .. } => true,
            Quantity::Joint { joint, slot, .. } => turns(&model.joints[joint].kind, slot),
            Quantity::Functional(k) => model.study.as_ref().is_some_and(|s| inner(s.functionals[k].of)),
            _ => false,
        },
        Node::Neg(a) | Node::Abs { a, .. } => inner(a),
        Node::Add(a, b) | Node::Sub(a, b) => inner(a) || inner(b),
        Node::Mul(a, b) => inner(a) && plain(b) || plain(a) && inner(b),
        Node::Div(a, b) => inner(a) && plain(b),
        Node::If { then, other, .. } => inner(then) || inner(other),
        Node::Min { a, b, .. } | Node::Max { a, b, .. } => inner(a) || inner(b),
        Node::Asin(_) | Node::Acos(_) | Node::Atan(_) | Node::Atan2(..) => true,
        _ => false,
    }
}

fn turns(kind: &JointKind, slot: usize) -> bool {
    match kind {
        JointKind::Slider => false,
        JointKind::PinInSlot => slot == 1,
        JointKind::Cylindrical => slot == 0,
        JointKind::Planar | JointKind::Free => slot == 2,
        _ => true,
    }
}
