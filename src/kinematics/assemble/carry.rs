//! A start in other coordinates of the same mechanism: joint coordinates are taken as they are, free bodies and ball joints from the
//! poses, so that nothing is searched.

use super::begun::{Begun, anchor};
use super::rotation;
use super::rotation::spin;
use crate::dynamics::Dynamics;
use crate::geometry::{Pose, Space, basis};
use crate::mechanism::{Measured, Mechanism, Step, TreeNode};
use std::f64::consts::PI;

/// The start of `from`, in the coordinates of `to`, whose rows it anchors.
pub(super) fn carry<G: Space<S = f64>>(from: &Mechanism<G>, begun: &Begun, to: &mut Mechanism<G>) -> Begun {
    let (q, v, modes) = carried(from, [&begun.q, &begun.v], &begun.modes, to);
    let change = begun.change.as_ref().map(|change| {
        change.carried(
            |q, v| {
                let (q, v, _) = carried(from, [q, v], &begun.modes, to);
                (q, v)
            },
            &begun.q,
        )
    });
    anchor(to, &q, &modes);
    Begun { q, v, modes, change, turned: begun.turned.clone() }
}

/// Coordinates, velocities and modes of a state [q, v] of `from` in the coordinates of `to`.
fn carried<G: Space<S = f64>>(from: &Mechanism<G>, state: [&[f64]; 2], modes: &[i32], to: &Mechanism<G>) -> (Vec<f64>, Vec<f64>, Vec<i32>) {
    let mut dynamics = Dynamics::without_mass(from);
    dynamics.time(0.0, modes);
    dynamics.position(state[0], modes);
    dynamics.velocity(state[1], modes);
    dynamics.watch(state[0], state[1], modes);
    let (mut q, mut v) = (to.drawn(), vec![0.0; to.nv]);
    for (index, node) in to.nodes.iter().enumerate() {
        coordinates(&dynamics, to, index, node, &mut q, &mut v);
    }
    let mut other = Dynamics::without_mass(to);
    let mut modes = to.modes();
    other.follow_time(0.0, &mut modes);
    other.position(&q, &modes);
    other.take_signs(&q, &mut modes);
    other.follow_position(&mut modes);
    for node in &to.nodes {
        let relative = dynamics.work.twists[node.body] - dynamics.work.twists[node.parent];
        for step in &to.steps[node.steps.clone()] {
            if let Step::Ball { v: k, .. } = *step {
                (k..k + G::SPIN).for_each(|k| v[k] = spin(&other.work.columns[k]).dot(&spin(&relative)));
            }
        }
    }
    wind(&dynamics, to, &mut modes);
    (q, v, modes)
}

/// Coordinates of a branch, and the velocities of its axes.
fn coordinates<G: Space<S = f64>>(
    from: &Dynamics<'_, G>,
    to: &Mechanism<G>,
    index: usize,
    node: &TreeNode<G>,
    q: &mut [f64],
    v: &mut [f64],
) {
    let work = &from.work;
    let mut slots = to.joint_of_node[index].map(|joint| from.mechanism.joints[joint].slots.iter().map(|&slot| work.readings[slot]));
    let (parent, body) = (work.places[node.parent], work.places[node.body]);
    // from the zero of its coordinates; far from the origin of the world the difference of the references is the small one
    let beside = body.p + (from.reference(node.body) - node.before.p);
    let origin = work.twists[node.body].at(body.p);
    let steps = to.steps[node.steps.clone()].iter();
    // slots stand in the order of the joint's axes, which a reversed branch runs through backwards
    let reversed = to.joint_of_node[index].is_some_and(|joint| to.joints[joint].tree.is_some_and(|(_, reversed)| reversed));
    let steps: Vec<&Step<G>> = if reversed { steps.rev().collect() } else { steps.collect() };
    for (axis, step) in steps.into_iter().enumerate() {
        match *step {
            Step::Axis { turns, q: i, v: k, .. } => {
                (q[i], v[k]) = match slots.as_mut() {
                    Some(slots) => slots.next().map_or((0.0, 0.0), |reading| (reading.x, reading.rate)),
                    // a free body: along the axes of the ground, then about its own origin
                    None if turns => (G::angle(body.r), G::spin_component(work.twists[node.body].w, 2)),
                    None => (G::component(beside, axis), G::dot(basis::<G>(axis), origin)),
                };
            }
            Step::Ball { q: i, reversed, .. } => {
                let after = node.after.map_or_else(G::identity, |pose: Pose<G>| pose.r);
                let turn =
                    G::multiply(G::multiply(G::inverse(node.before.r), G::multiply(G::inverse(parent.r), body.r)), G::inverse(after));
                let unit = rotation::quaternion(&rotation::matrix::<G>(if reversed { G::inverse(turn) } else { turn }));
                q[i..i + 4].copy_from_slice(&[unit.w, unit.i, unit.j, unit.k]);
            }
        }
    }
}

/// Half turns of hinges that are cut in `to`, by their coordinates.
fn wind<G: Space<S = f64>>(from: &Dynamics<'_, G>, to: &Mechanism<G>, modes: &mut [i32]) {
    for (joint, other) in to.joints.iter().zip(&from.mechanism.joints) {
        for (&slot, &known) in joint.slots.iter().zip(&other.slots) {
            if let Measured::Turn { winding, .. } = to.gauges[slot].measured {
                let half = (from.work.readings[known].x - to.gauges[slot].shift) / PI;
                modes[to.switches + winding] = half.round() as i32;
            }
        }
    }
}
