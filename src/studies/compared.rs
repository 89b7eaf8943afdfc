//! What of a motion is compared with that of another computation: its columns, or where these say nothing of it all that moves.

use crate::expression::Dimension;
use crate::model::{Body, Column, Dimensions, Model, PointRef, Quantity, Study};

const XYZ: [&str; 3] = ["x", "y", "z"];
const WXYZ: [&str; 4] = ["qw", "qx", "qy", "qz"];

/// The study; if none of its columns depends on the motion, with the places and the angles (in space the quaternions) of all bodies
/// and the first-order states as columns.
pub(super) fn with_motion(model: &mut Model, study: &Study) -> Study {
    let mut study = study.clone();
    let values: Vec<_> = study.columns.iter().map(|column| column.value).collect();
    let of_motion = |i: u32| !matches!(model.inputs[i as usize], Quantity::Time | Quantity::Taken(_));
    if !model.pool.inputs_of(&values).into_iter().any(of_motion) {
        for (name, dimension, quantity) in all(model) {
            let known = model.inputs.iter().position(|input| *input == quantity);
            let input = known.unwrap_or_else(|| {
                model.inputs.push(quantity);
                model.inputs.len() - 1
            });
            study.columns.push(Column { name, dimension, value: model.pool.input(input as u32) });
        }
    }
    study
}

/// Places, angles and states by their paths.
fn all(model: &Model) -> Vec<(String, Dimension, Quantity)> {
    let planar = model.space == Dimensions::Planar;
    let mut all = Vec::new();
    for (body, Body { name, .. }) in model.bodies.iter().enumerate().skip(1) {
        let at = PointRef { body, point: 0 };
        let axes = XYZ.iter().enumerate().take(if planar { 2 } else { 3 });
        all.extend(axes.map(|(axis, x)| (format!("{name}.origin.{x}"), Dimension::LENGTH, Quantity::Point { at, axis, order: 0 })));
        if planar {
            all.push((format!("{name}.angle"), Dimension::ANGLE, Quantity::Angle { body, order: 0 }));
        } else {
            let parts = WXYZ.iter().enumerate();
            let quaternion = |component| Quantity::Quaternion { body, component, order: 0 };
            all.extend(parts.map(|(component, q)| (format!("{name}.{q}"), Dimension::NONE, quaternion(component))));
        }
    }
    all.extend(model.states.iter().enumerate().map(|(i, state)| (state.name.clone(), state.dimension, Quantity::State(i))));
    all
}
