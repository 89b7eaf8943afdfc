//! Names of the coordinates of a mechanism, as the model file has them.

use super::assemble::units;
use crate::geometry::Space;
use crate::mechanism::{Measured, Mechanism};
use crate::model::{Model, coordinates_of};

/// A velocity column with the coordinate that it moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coordinate {
    /// `O.angle`, `body.x`; `ball.turn_x` is a small turn about the second body's own x axis.
    pub name: String,
    /// Of its rate: `O.omega`.
    pub rate: String,
    /// Angle (rad) or length (m).
    pub turns: bool,
}

/// The coordinates behind all velocity columns (nv).
#[must_use]
pub fn coordinates<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>) -> Vec<Coordinate> {
    let mut out: Vec<Coordinate> =
        units(mechanism).iter().map(|u| Coordinate { name: String::new(), rate: String::new(), turns: *u == 0 }).collect();
    for (joint, of) in mechanism.joints.iter().zip(&model.joints) {
        for (slot, &gauge) in joint.slots.iter().enumerate() {
            let named = coordinates_of(&of.kind).iter().find(|c| c.slot == slot);
            if let (Some(c), Measured::Coordinate { along, .. }) = (named, mechanism.gauges[gauge].measured) {
                out[along.v].name = format!("{}.{}", joint.name, c.names[0]);
                out[along.v].rate = format!("{}.{}", joint.name, c.names[1]);
            }
        }
    }
    for (node, joint) in mechanism.nodes.iter().zip(&mechanism.joint_of_node) {
        let owner = joint.map_or(&mechanism.bodies[node.body].name, |j| &mechanism.joints[j].name);
        let (slides, turns): (Vec<usize>, Vec<usize>) = node.columns.clone().partition(|&k| !out[k].turns);
        for (columns, [alone, alone_rate], words, rates) in [
            (slides, ["position", "velocity"], ["x", "y", "z"], ["vx", "vy", "vz"]),
            (turns, ["angle", "omega"], ["turn_x", "turn_y", "turn_z"], ["wx", "wy", "wz"]),
        ] {
            let several = columns.len() > 1;
            for (axis, k) in columns.into_iter().enumerate().filter(|(axis, _)| *axis < 3) {
                if out[k].name.is_empty() {
                    out[k].name = format!("{owner}.{}", if several { words[axis] } else { alone });
                    out[k].rate = format!("{owner}.{}", if several { rates[axis] } else { alone_rate });
                }
            }
        }
    }
    out
}
