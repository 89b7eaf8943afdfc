//! The frames of one turn: positions at the same angles of a crank, turn after turn, would lie over each other.

use super::frames::SHOWN;
use crate::results::Scene;
use crate::results::scene::Joint;
use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::TAU;

/// Frames at even angles of the first turn of what is driven, the one that is shown first before; none if no hinge is driven for more
/// than a turn, always in one sense. Of several hinges the slowest counts.
pub(super) fn first_turn(scene: &Scene) -> Option<Vec<usize>> {
    let (frames, start) = (&scene.frames, *scene.frames.shown.first()?);
    let falls = frames.shown.get(1).is_some_and(|next| *next < start);
    let way: Vec<usize> = if falls { (0..=start).rev().collect() } else { (start..frames.count()).collect() };
    let hinges = scene.joints.iter().filter(|joint| joint.driven && joint.kind == "revolute");
    let turned = hinges.filter_map(|joint| angles(scene, joint, &way)).min_by(|a, b| a[a.len() - 1].total_cmp(&b[b.len() - 1]))?;
    let nearest = |k: usize| {
        let wanted = TAU * k as f64 / SHOWN as f64;
        let behind = turned.partition_point(|angle| *angle < wanted).clamp(1, turned.len() - 1);
        way[if turned[behind] - wanted < wanted - turned[behind - 1] { behind } else { behind - 1 }]
    };
    let mut shown: Vec<usize> = (0..SHOWN).map(nearest).collect();
    shown.dedup();
    Some(shown)
}

/// By how much a hinge has turned on a way through frames, rad, rising; none if it is not more than a turn or not in one sense.
fn angles(scene: &Scene, joint: &Joint, way: &[usize]) -> Option<Vec<f64>> {
    let mut angles = vec![0.0];
    for pair in way.windows(2) {
        let step = step(scene, joint, [pair[0], pair[1]]);
        angles.push(angles[angles.len() - 1] + step);
    }
    let sense = angles[angles.len() - 1].signum();
    angles.iter_mut().for_each(|angle| *angle *= sense);
    let rises = angles.windows(2).all(|pair| pair[1] >= pair[0]);
    (rises && angles[angles.len() - 1] > TAU * (1.0 + 1e-6)).then_some(angles)
}

/// By how much a hinge turns from one frame to another, in space less than half a turn, rad.
pub(super) fn step(scene: &Scene, joint: &Joint, frames: [usize; 2]) -> f64 {
    if scene.dimensions == 2 {
        // angles in the plane are not wrapped
        let angle =
            |index: usize, body: usize| body.checked_sub(1).map_or(0.0, |k| scene.frame(index).get(3 * k + 2).copied().unwrap_or(f64::NAN));
        let between = |index: usize| angle(index, joint.b.body) - angle(index, joint.a.body);
        return between(frames[1]) - between(frames[0]);
    }
    let [before, behind] = frames.map(|index| [&joint.a, &joint.b].map(|place| rotation(scene, index, place.body)));
    // of b in a before and behind, and the one from the other
    let [from, to] = [before, behind].map(|[a, b]| a.inverse() * b);
    let turn = to * from.inverse();
    let axis: [f64; 3] = std::array::from_fn(|i| joint.axis.get(i).copied().unwrap_or(0.0));
    let along = turn.i * axis[0] + turn.j * axis[1] + turn.k * axis[2];
    let angle = 2.0 * along.atan2(turn.w);
    angle - TAU * (angle / TAU).round()
}

/// How a body is turned in a frame.
fn rotation(scene: &Scene, index: usize, body: usize) -> UnitQuaternion<f64> {
    let Some(before) = body.checked_sub(1) else { return UnitQuaternion::identity() };
    match *scene.frame(index).get(before * scene.stride()..body * scene.stride()).unwrap_or_default() {
        [_, _, _, w, x, y, z] => UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)),
        _ => UnitQuaternion::identity(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::scene::{Body, Frames, Place};

    /// A crank on the ground that turns by `turns`, in the plane or about x in space.
    fn crank(dimensions: usize, turns: f64) -> Scene {
        let angle = |i: usize| TAU * turns * i as f64 / 200.0;
        let pose = |i: usize| match dimensions {
            2 => vec![0.0, 0.0, angle(i)],
            _ => vec![0.0, 0.0, 0.0, (0.5 * angle(i)).cos(), (0.5 * angle(i)).sin(), 0.0, 0.0],
        };
        let joint = Joint {
            kind: "revolute".into(),
            b: Place { body: 1, at: vec![] },
            axis: vec![1.0, 0.0, 0.0],
            driven: true,
            ..Joint::default()
        };
        let frames = Frames {
            at: (0..=200).map(f64::from).collect(),
            poses: (0..=200).flat_map(pose).collect(),
            shown: vec![0, 40, 80, 120, 160, 200],
            ..Frames::default()
        };
        Scene { dimensions, bodies: vec![Body::default(); 2], joints: vec![joint], frames, ..Scene::default() }
    }

    #[test]
    fn positions_of_several_turns_are_those_of_the_first_one() {
        for dimensions in [2, 3] {
            for turns in [5.0, -5.0, 4.0] {
                let shown = first_turn(&crank(dimensions, turns)).expect("more than a turn");
                let a_turn = 200.0 / turns.abs();
                let even = |(k, index): (usize, &usize)| (*index as f64 - a_turn * k as f64 / 6.0).abs() <= 0.51;
                assert!(shown.len() == 6 && shown.iter().enumerate().all(even), "{turns}: {shown:?}");
            }
            assert_eq!(first_turn(&crank(dimensions, 1.0)), None);
        }
    }
}
