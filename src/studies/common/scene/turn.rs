//! The frames of one cycle: positions at the same angles of a crank, cycle after cycle, would lie over each other.

use super::frames::SHOWN;
use crate::results::Scene;
use crate::results::scene::{Joint, Place, Shape};
use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::TAU;

/// What turns back by less than this goes in one sense all the same, as where a shaft begins to turn against a load, rad.
const BACK: f64 = 0.02;
/// Turns between frames by which what is shown can be told apart, rad.
const RESOLVED: f64 = TAU / 6.0;
/// What differs by less than this part of the size of the whole motion is seen at one place.
const ALIKE: f64 = 0.01;
/// Angles within a cycle, and cycles, that are compared at most.
const COMPARED: usize = 12;
/// By how much what is driven turns in a cycle at least, rad.
const LEAST: f64 = 0.75 * TAU;
/// Turns of a cycle at most.
const MOST_TURNS: usize = 100;

/// Frames at even angles of the first cycle of a motion in which a hinge is driven for more than a turn, always in one sense, the one
/// that is shown first before; none if there is no such hinge, or if the mechanism does not come back to where it was some turns
/// before. Of several hinges that are driven the slowest counts; the angles are its own, or those of another hinge after whose turns all is
/// as before where that takes less, as behind gears or a soft shaft.
pub(super) fn first_cycle(scene: &Scene) -> Option<Vec<usize>> {
    let (frames, start) = (&scene.frames, *scene.frames.shown.first()?);
    let falls = frames.shown.get(1).is_some_and(|next| *next < start);
    let way: Vec<usize> = if falls { (0..=start).rev().collect() } else { (start..frames.count()).collect() };
    let hinges = |driven: bool| scene.joints.iter().filter(move |joint| joint.kind == "revolute" && joint.driven == driven);
    let turned = |joint: &Joint| angles(scene, joint, &way);
    let driven = hinges(true).filter_map(turned).min_by(|a, b| a[a.len() - 1].total_cmp(&b[b.len() - 1]))?;
    let grounded = |joint: &&Joint| joint.a.body == 0 || joint.b.body == 0;
    let (on_ground, between): (Vec<&Joint>, Vec<&Joint>) = hinges(false).partition(grounded);
    // angles, the cycle by them, and by how much what is driven turns in it
    let mut best: Option<(Vec<f64>, f64, f64)> = None;
    for turned in std::iter::once(driven.clone()).chain(on_ground.into_iter().chain(between).filter_map(turned)) {
        let Some(cycle) = Cycles::new(scene, &way, &turned).shortest() else { continue };
        let takes = at(&turned, &driven, cycle);
        if takes > LEAST && best.as_ref().is_none_or(|(.., least)| takes < least * (1.0 - ALIKE)) {
            best = Some((turned, cycle, takes));
        }
    }
    let (turned, cycle, _) = best?;
    let nearest = |k: usize| {
        let wanted = cycle * k as f64 / SHOWN as f64;
        let behind = turned.partition_point(|angle| *angle < wanted).clamp(1, turned.len() - 1);
        way[if turned[behind] - wanted < wanted - turned[behind - 1] { behind } else { behind - 1 }]
    };
    let mut shown: Vec<usize> = (0..SHOWN).map(nearest).collect();
    shown.dedup();
    Some(shown)
}

/// A curve over rising angles at one of them, on straight lines.
fn at(angles: &[f64], values: &[f64], angle: f64) -> f64 {
    let behind = angles.partition_point(|turned| *turned < angle).clamp(1, angles.len() - 1);
    let (from, to) = (angles[behind - 1], angles[behind]);
    let part = if to > from { ((angle - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
    values[behind - 1] + part * (values[behind] - values[behind - 1])
}

/// A motion over the angle of a hinge.
struct Cycles<'a> {
    scene: &'a Scene,
    /// The independent variable in the order of the motion, and by how much the hinge has turned there, rad.
    places: Vec<f64>,
    turned: &'a [f64],
    /// Places by which it is seen where the bodies are.
    seen: Vec<Place>,
    /// What is one place to the eye, m.
    near: f64,
}

impl<'a> Cycles<'a> {
    fn new(scene: &'a Scene, way: &[usize], turned: &'a [f64]) -> Self {
        let seen = seen(scene);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for at in way.iter().flat_map(|index| seen.iter().map(|place| scene.world(scene.frame(*index), place))) {
            (0..3).for_each(|i| (low[i], high[i]) = (low[i].min(at[i]), high[i].max(at[i])));
        }
        let size = (0..3).map(|i| (high[i] - low[i]).powi(2)).sum::<f64>().sqrt();
        // places that rest differ by round-off
        let far = low.iter().chain(&high).fold(0.0_f64, |far, x| far.max(x.abs()));
        let places = way.iter().map(|index| scene.frames.at[*index]).collect();
        Self { scene, places, turned, seen, near: ALIKE * size + 1e-9 * far }
    }

    /// The fewest turns after which all is as before, over and over to the end, or all of the motion if its end is its beginning, rad.
    fn shortest(&self) -> Option<f64> {
        let whole = self.turned[self.turned.len() - 1];
        if self.turned.windows(2).any(|pair| pair[1] - pair[0] > RESOLVED) {
            return None;
        }
        let turns = ((whole / TAU * (1.0 + 1e-9)) as usize).min(MOST_TURNS);
        (1..=turns).map(|turns| TAU * turns as f64).chain([whole]).find(|cycle| self.repeats(*cycle, whole))
    }

    /// Whether the mechanism is after each cycle as before it.
    fn repeats(&self, cycle: f64, whole: f64) -> bool {
        let common = cycle.min(whole - cycle).max(0.0);
        (0..=COMPARED).map(|k| common * k as f64 / COMPARED as f64).all(|angle| {
            let first = self.at(angle);
            let cycles = (((whole - angle) / cycle * (1.0 + 1e-9)) as usize).max(1);
            let some = (1..=COMPARED).map(|k| (k * cycles).div_ceil(COMPARED));
            some.map(|k| self.at((angle + cycle * k as f64).min(whole))).all(|later| {
                let apart = |(p, q): (&[f64; 3], &[f64; 3])| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt();
                first.iter().zip(&later).all(|pair| apart(pair) <= self.near)
            })
        })
    }

    /// Where what is seen is at an angle of the hinge.
    fn at(&self, angle: f64) -> Vec<[f64; 3]> {
        let poses = self.scene.frames.at(at(self.turned, &self.places, angle), self.scene.dimensions);
        self.seen.iter().map(|place| self.scene.world(&poses, place)).collect()
    }
}

/// Places on moving bodies by which it is seen where they are: of what is round its centre alone.
fn seen(scene: &Scene) -> Vec<Place> {
    let joints = scene.joints.iter().flat_map(|joint| [&joint.a, &joint.b]);
    let links = scene.links.iter().flat_map(|link| [&link.a, &link.b]);
    let shapes = scene.bodies.iter().enumerate().flat_map(|(body, of)| of.shapes.iter().flat_map(move |shape| of_shape(body, shape)));
    joints.chain(links).filter(|place| place.body != 0).cloned().chain(shapes.filter(|place| place.body != 0)).collect()
}

/// The places of a shape.
fn of_shape(body: usize, shape: &Shape) -> Vec<Place> {
    let points = match shape {
        Shape::Bar { from, to, .. } | Shape::Cylinder { from, to, .. } => vec![from.clone(), to.clone()],
        Shape::Hull { points } | Shape::Polygon { points } => points.clone(),
        Shape::Disc { center: at, .. } | Shape::Gear { center: at, .. } | Shape::Sphere { center: at, .. } | Shape::Mass { at, .. } => {
            vec![at.clone()]
        }
        Shape::Box { center, size } => {
            let corner = |signs: &[f64]| center.iter().zip(size).zip(signs).map(|((c, size), sign)| c + 0.5 * sign * size).collect();
            vec![corner(&[1.0, 1.0, 1.0]), corner(&[-1.0, 1.0, 1.0]), corner(&[1.0, -1.0, 1.0]), corner(&[1.0, 1.0, -1.0])]
        }
    };
    points.into_iter().map(|at| Place { body, at }).collect()
}

/// By how much a hinge has turned on a way through frames, rad, rising; none if it is not more than a turn or not in one sense.
fn angles(scene: &Scene, joint: &Joint, way: &[usize]) -> Option<Vec<f64>> {
    let mut angles = vec![0.0];
    for pair in way.windows(2) {
        let step = step(scene, joint, [pair[0], pair[1]]);
        angles.push(angles[angles.len() - 1] + step);
    }
    let sense = angles[angles.len() - 1].signum();
    let mut farthest = 0.0_f64;
    for angle in &mut angles {
        *angle *= sense;
        if farthest - *angle > BACK {
            return None;
        }
        farthest = farthest.max(*angle);
        *angle = farthest;
    }
    (farthest > TAU * (1.0 + 1e-6)).then_some(angles)
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
                let shown = first_cycle(&crank(dimensions, turns)).expect("more than a turn");
                let a_turn = 200.0 / turns.abs();
                let even = |(k, index): (usize, &usize)| (*index as f64 - a_turn * k as f64 / 6.0).abs() <= 0.51;
                assert!(shown.len() == 6 && shown.iter().enumerate().all(even), "{turns}: {shown:?}");
            }
            assert_eq!(first_cycle(&crank(dimensions, 1.0)), None);
        }
    }
}
