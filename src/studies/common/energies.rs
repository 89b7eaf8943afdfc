//! Which values are energies: their dimension is that of a torque, so that the formula decides.
//!
//! Each part of a formula has two degrees: how often an energy (or a power) is a factor of it, and how often an angle is. A product
//! adds them, a quotient takes them from each other; an energy is what has the degrees (1, 0). An energy over an angle, and a power
//! over an angular speed, have (1, −1): torques.

use crate::expression::{Dimension, Id, Node};
use crate::model::{Functional, FunctionalKind, Model, Quantity, Study, coordinates_of};
use crate::results::Finding;
use std::collections::HashMap;

/// How often energies and angles are factors.
type Degrees = (i32, i32);

/// Whether a value of a study is an energy, not a torque.
pub(super) fn is_energy(model: &Model, study: &Study, dimension: Dimension, value: Id) -> bool {
    dimension == Dimension::ENERGY && degrees(model, study, value) == (1, 0)
}

/// The degrees of a value.
fn degrees(model: &Model, study: &Study, value: Id) -> Degrees {
    let mut known: HashMap<Id, Degrees> = HashMap::new();
    for id in model.pool.reach(&[value]) {
        let of = |id: Id| known.get(&id).copied().unwrap_or_default();
        // a part of a sum that holds an energy tells what the sum is
        let sum = |a: Id, b: Id| [of(a), of(b)].into_iter().find(|d| *d != (0, 0)).unwrap_or_default();
        let found = match model.pool.node(id) {
            Node::Parameter(i) => (0, i32::from(model.parameters[i as usize].dimension.is_angle())),
            Node::Input(i) => of_quantity(model, study, model.inputs[i as usize]),
            Node::Neg(a) | Node::Where(a, _) | Node::Abs { a, .. } | Node::Floor { a, .. } => of(a),
            Node::Add(a, b) | Node::Sub(a, b) | Node::Min { a, b, .. } | Node::Max { a, b, .. } => sum(a, b),
            Node::If { then, other, .. } => sum(then, other),
            Node::Mul(a, b) => (of(a).0 + of(b).0, of(a).1 + of(b).1),
            Node::Div(a, b) => (of(a).0 - of(b).0, of(a).1 - of(b).1),
            Node::Powi(a, n) => (of(a).0.saturating_mul(n), of(a).1.saturating_mul(n)),
            Node::Sqrt(a) => (of(a).0 / 2, of(a).1 / 2),
            Node::Asin(_) | Node::Acos(_) | Node::Atan(_) | Node::Atan2(..) => (0, 1),
            _ => (0, 0),
        };
        known.insert(id, found);
    }
    known.get(&value).copied().unwrap_or_default()
}

/// The degrees of an input.
fn of_quantity(model: &Model, study: &Study, quantity: Quantity) -> Degrees {
    match quantity {
        Quantity::Kinetic | Quantity::Potential | Quantity::SpringEnergy { .. } | Quantity::Work(_) | Quantity::DriverPower { .. } => {
            (1, 0)
        }
        Quantity::Angle { .. } | Quantity::Spin { .. } => (0, 1),
        Quantity::Joint { joint, slot, .. } => {
            let angle = coordinates_of(&model.joints[joint].kind).iter().any(|c| c.slot == slot && c.angle);
            (0, i32::from(angle))
        }
        Quantity::Taken(k) => (0, i32::from(study.take[k].dimension.is_angle())),
        Quantity::Functional(k) => {
            let Functional { kind, of, dimension, .. } = &study.functionals[k];
            match kind {
                // of a power over time, of a torque over an angle
                FunctionalKind::Integral if *dimension == Dimension::ENERGY => (1, 0),
                FunctionalKind::First => (0, i32::from(dimension.is_angle())),
                _ => degrees(model, study, *of),
            }
        }
        _ => (0, 0),
    }
}

/// That the energy of a spring was not resolved.
pub(crate) fn unresolved(model: &Model, spring: usize) -> Finding {
    let name = model.springs.get(spring).map_or("", |spring| spring.name.as_str());
    Finding {
        code: "unresolved".into(),
        message: format!(
            "the energy of the spring `{name}` is not resolved: between its rest and where it stands its law has more kinks and jumps than are followed (some thousand): energies and their balance may be wrong; give it a law with fewer of them, or a smooth one"
        ),
        path: format!("springs.{name}.force"),
    }
}
