//! Joints as they are drawn, with the strokes of slides.

use super::guides::seen;
use super::places::place;
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use crate::model::{self, SpringOn};
use crate::results::Scene;
use crate::results::scene::Joint;
use crate::studies::common::case::Case;

/// Kinds of joints that slide along their axis.
const SLIDING: [&str; 4] = ["slider", "cylindrical", "screw", "pin-in-slot"];

/// The joints of a mechanism; of those of the kind `distance` links are made. The frames of the scene are there.
pub(super) fn joints<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, scene: &Scene) -> Vec<Joint> {
    let all = mechanism.joints.iter().zip(&case.model.joints).enumerate();
    all.filter(|(_, (joint, _))| joint.kind != "distance")
        .map(|(index, (joint, said))| {
            let stops = stops(case, said).map(|end| Some(end? - joint.zero));
            let drivers = case.model.drivers.iter().map(|d| d.joint);
            let mut drawn = Joint {
                name: joint.name.clone(),
                kind: joint.kind.into(),
                a: place::<G>(joint.a),
                b: place::<G>(joint.b),
                on_ground: on_ground(mechanism, index),
                axis: joint.axis[..G::VECTOR].to_vec(),
                second: joint.second.map_or_else(Vec::new, Vec::from),
                stroke: None,
                drawn: if G::VECTOR == 3 && joint.kind == "revolute" && stops.iter().any(Option::is_some) {
                    joint.drawn.concat()
                } else {
                    Vec::new()
                },
                stops,
                cut: joint.tree.is_none(),
                driven: drivers.chain(case.model.motors.iter().map(|m| m.joint)).any(|driven| driven == index),
                sense: 0.0,
                damped: said.damping.is_some_and(|damping| case.value(damping) != 0.0) || joint.kind != "slider" && by_spring(case, index),
                telescopes: false,
            };
            drawn.stroke = stroke(scene, &drawn);
            let drawn = if drawn.on_ground { from_ground(scene, drawn) } else { drawn };
            seen(scene, drawn)
        })
        .collect()
}

/// Whether a spring on a joint damps it.
fn by_spring(case: Case<'_>, joint: usize) -> bool {
    let springs = case.model.springs.iter().filter(|spring| matches!(spring.on, SpringOn::Joint(on) if on == joint));
    let varies = |damping| !case.model.pool.inputs_of(&[damping]).is_empty();
    springs.filter_map(|spring| spring.damping).any(|damping| varies(damping) || case.value(damping) != 0.0)
}

/// Whether the model names the ground as the second body of a joint.
pub(super) fn on_ground<G: Space<S = f64>>(mechanism: &Mechanism<G>, joint: usize) -> bool {
    let joint = &mechanism.joints[joint];
    joint.b.0 == 0 && joint.a.0 != 0
}

/// A joint to the ground as one from the ground, so that what carries and guides rests, and what moves is the second body: the coordinate
/// is the same about or along the opposite axis. A slot stays in its body, and joints of two axes as they are.
fn from_ground(scene: &Scene, joint: Joint) -> Joint {
    let planar = scene.dimensions == 2;
    let turns = joint.kind == "revolute" && planar;
    if scene.frames.count() == 0 || !["revolute", "slider", "cylindrical", "screw", "spherical", "fixed"].contains(&&*joint.kind) {
        return joint;
    }
    let along = scene.direction(scene.frame(0), joint.a.body, &joint.axis);
    // the axis of a hinge in the plane is the third one, whatever the order
    let stops = if turns { [joint.stops[1], joint.stops[0]].map(|stop| stop.map(|stop| -stop)) } else { joint.stops };
    let drawn = if joint.drawn.is_empty() { Vec::new() } else { (0..9).map(|k| joint.drawn[3 * (k % 3) + k / 3]).collect() };
    Joint { drawn, a: joint.b, b: joint.a, axis: along[..scene.dimensions].iter().map(|x| 0.0 - x).collect(), stops, ..joint }
}

/// The ends of the coordinate of a joint, if it has stops.
fn stops(case: Case<'_>, joint: &model::Joint) -> [Option<f64>; 2] {
    let soft = joint.limit.map(|limit| [limit.from, limit.to]);
    let ends = joint.stops.map(|stops| [stops.from, stops.to]).or(soft);
    ends.unwrap_or_default().map(|end| Some(case.value(end?)))
}

/// Positions along the axis over all frames, widened to the stops.
fn stroke(scene: &Scene, joint: &Joint) -> Option<[f64; 2]> {
    if !SLIDING.contains(&&*joint.kind) {
        return None;
    }
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for index in 0..scene.frames.count() {
        let poses = scene.frame(index);
        let (a, b) = (scene.world(poses, &joint.a), scene.world(poses, &joint.b));
        let axis = scene.direction(poses, joint.a.body, &joint.axis);
        let along: f64 = (0..3).map(|i| axis[i] * (b[i] - a[i])).sum();
        ends = [ends[0].min(along), ends[1].max(along)];
    }
    if joint.kind == "slider" {
        ends = [joint.stops[0].map_or(ends[0], |stop| ends[0].min(stop)), joint.stops[1].map_or(ends[1], |stop| ends[1].max(stop))];
    }
    ends.iter().all(|end| end.is_finite()).then_some(ends)
}
