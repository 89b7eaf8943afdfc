//! Forces that a drawing shows: where they act and in which axes they are given; and their values along the motion.

use super::joints::on_ground;
use super::links::Held;
use super::places::numbers;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, PointLoad};
use crate::model::{ForceOn, LoadOn, Shown, ShownForce, Study};
use crate::results::Scene;
use crate::results::scene::{Arrow, ArrowKind, Place};
use crate::studies::common::case::Case;

/// The forces that a study shows, in its order, without values: of a joint those on its second body, or on the first where the second is the
/// ground. Moments of joints are about the point on that body. Of a coupling it is that on the second end of its distance, without a direction
/// where it is none.
pub(super) fn arrows<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, held: &[Held]) -> Vec<Arrow> {
    let arrow = |force: &ShownForce| {
        let scale = force.scale.map(|id| case.value(id));
        let (kind, joint, (body, at), frame, axes) = match force.on {
            ForceOn::Reaction(joint) => (ArrowKind::Reaction, Some(joint), mechanism.joints[joint].b, 0, world(G::VECTOR)),
            ForceOn::Moment(joint) => (ArrowKind::Moment, Some(joint), mechanism.joints[joint].b, 0, world(G::VECTOR)),
            ForceOn::Load(load) | ForceOn::Torque(load) => {
                let joint = if let LoadOn::Joint { joint, .. } = case.model.loads[load].on { Some(joint) } else { None };
                let (place, frame, axes) = load_of(case, mechanism, load);
                (if matches!(force.on, ForceOn::Load(_)) { ArrowKind::Load } else { ArrowKind::Torque }, joint, place, frame, axes)
            }
            ForceOn::Coupling(coupling) => return along_line(case, force, held.iter().find(|held| held.coupling == coupling)),
        };
        let other = joint.filter(|joint| on_ground(mechanism, *joint));
        let (body, at) = other.map_or((body, at), |joint| mechanism.joints[joint].a);
        // a torque in the plane is about the third axis, which is the same in all bodies
        let (frame, axes) = if kind.turns() && G::VECTOR == 2 { (0, vec![vec![0.0, 0.0, 1.0]]) } else { (frame, axes) };
        let turned = |axis: Vec<f64>| if other.is_some() { axis.into_iter().map(|x| 0.0 - x).collect() } else { axis };
        let axes: Vec<Vec<f64>> = axes.into_iter().map(turned).collect();
        let minus = other.is_some();
        // the columns of a moment are about the point on the second body
        let are_columns = match kind {
            ArrowKind::Reaction => true,
            ArrowKind::Moment => !minus,
            ArrowKind::Load | ArrowKind::Torque => false,
        };
        let columns = force.components.iter().take(if are_columns { axes.len() } else { 0 }).map(|c| c.name.clone()).collect();
        Arrow {
            name: force.name.clone(),
            kind,
            body,
            at: numbers::<G>(at),
            columns,
            minus,
            values: Vec::new(),
            frame,
            axes,
            from: None,
            scale,
        }
    };
    case.study.forces.iter().map(arrow).collect()
}

/// The force of a coupling along the line between its ends.
fn along_line(case: Case<'_>, force: &ShownForce, held: Option<&Held>) -> Arrow {
    let scale = force.scale.map(|id| case.value(id));
    let ends = held.map(|held| (held.link.b.clone(), held.link.a.clone(), held.sense < 0.0));
    let (b, from, minus) = ends.map_or((Place { body: 0, at: Vec::new() }, None, false), |(b, a, minus)| (b, Some(a), minus));
    Arrow {
        name: force.name.clone(),
        kind: ArrowKind::Reaction,
        body: b.body,
        at: b.at,
        columns: Vec::new(),
        minus,
        values: Vec::new(),
        frame: 0,
        axes: Vec::new(),
        from,
        scale,
    }
}

/// Where a load acts, the body of its axes, and these in it.
fn load_of<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, load: usize) -> ((usize, G::Vector), usize, Vec<Vec<f64>>) {
    let at_points = |loads: &[crate::model::Load]| loads.iter().filter(|load| matches!(load.on, LoadOn::Point { .. })).count();
    match case.model.loads[load].on {
        LoadOn::Joint { joint, .. } => {
            let joint = &mechanism.joints[joint];
            (joint.b, joint.a.0, vec![joint.axis[..G::VECTOR].to_vec()])
        }
        LoadOn::Point { .. } => {
            // those at points come first, in the order of the file
            let PointLoad { body, at, frame, axes, .. } = &mechanism.point_loads[at_points(&case.model.loads[..load])];
            let turned = |axis: Vec<f64>| axes.map_or(axis.clone(), |r| numbers::<G>(G::rotate(r, G::vector(&axis))));
            ((*body, *at), *frame, world(G::VECTOR).into_iter().map(turned).collect())
        }
    }
}

/// Unit directions of the axes.
fn world(dimensions: usize) -> Vec<Vec<f64>> {
    (0..dimensions).map(|i| (0..dimensions).map(|k| f64::from(u8::from(i == k))).collect()).collect()
}

/// Gives the arrows of a scene their values at its frames: those of the rows at `places`, between rows on straight lines.
pub(crate) fn fill_arrows<'c>(study: &Study, scene: &mut Scene, places: &[f64], column: &dyn Fn(&str) -> Option<&'c [f64]>) {
    let mut arrows = std::mem::take(&mut scene.arrows);
    for (arrow, force) in arrows.iter_mut().zip(&study.forces) {
        let columns: Option<Vec<&[f64]>> = force.components.iter().map(|Shown { name, .. }| column(name)).collect();
        let Some(columns) = columns.filter(|columns| !places.is_empty() && columns.iter().all(|c| c.len() == places.len())) else {
            continue;
        };
        if matches!(force.on, ForceOn::Coupling(_)) {
            let Some(from) = &arrow.from else { continue };
            arrow.values = along(scene, arrow, from, places, columns[0]);
            continue;
        }
        if arrow.kind == ArrowKind::Moment {
            arrow.values = moments(scene, arrow, places, &columns);
            continue;
        }
        let planar_torque = arrow.kind.turns() && scene.dimensions == 2;
        let components = if planar_torque { 2..3 } else { 0..scene.dimensions };
        arrow.values = (0..scene.frames.count())
            .flat_map(|index| {
                let poses = scene.frame(index);
                let mut sum = [0.0; 3];
                for (values, axis) in columns.iter().zip(&arrow.axes) {
                    let (value, along) = (between(places, values, scene.frames.at[index]), scene.direction(poses, arrow.frame, axis));
                    (0..3).for_each(|i| sum[i] += value * along[i]);
                }
                sum[components.clone()].to_vec()
            })
            .collect();
    }
    scene.arrows = arrows;
}

/// Forces along the line from one place to that of an arrow at the frames of a scene.
fn along(scene: &Scene, arrow: &Arrow, from: &Place, places: &[f64], column: &[f64]) -> Vec<f64> {
    let to = Place { body: arrow.body, at: arrow.at.clone() };
    let at = |index: usize| {
        let poses = scene.frame(index);
        let (a, b) = (scene.world(poses, from), scene.world(poses, &to));
        let way: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        let force = between(places, column, scene.frames.at[index]) * if arrow.minus { -1.0 } else { 1.0 };
        way.map(|x| force * x / length)[..scene.dimensions].to_vec()
    };
    (0..scene.frames.count()).flat_map(at).collect()
}

/// The moments of a joint at the frames of a scene, about the point of their arrow: columns are those of its moment about the point on its
/// second body, and of its force.
fn moments(scene: &Scene, arrow: &Arrow, places: &[f64], columns: &[&[f64]]) -> Vec<f64> {
    let planar = scene.dimensions == 2;
    let own = if planar { 2..3 } else { 0..3 };
    let point = Place { body: arrow.body, at: arrow.at.clone() };
    let joint = scene.joints.iter().find(|joint| arrow.minus && joint.name == arrow.name);
    let ground = joint.and_then(|joint| [&joint.a, &joint.b].into_iter().find(|place| place.body == 0));
    let (turning, forces) = columns.split_at(own.len());
    let mut values = Vec::with_capacity(own.len() * scene.frames.count());
    for (index, at) in scene.frames.at.iter().enumerate() {
        let [mut m, mut f] = [[0.0; 3]; 2];
        m[own.clone()].iter_mut().zip(turning).for_each(|(m, column)| *m = between(places, column, *at));
        f.iter_mut().zip(forces).for_each(|(f, column)| *f = between(places, column, *at));
        if let Some(ground) = ground {
            let poses = scene.frame(index);
            let (from, to) = (scene.world(poses, &point), scene.world(poses, ground));
            let arm: [f64; 3] = std::array::from_fn(|i| to[i] - from[i]);
            m = std::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                -(m[i] + arm[j] * f[k] - arm[k] * f[j])
            });
        }
        values.extend_from_slice(&m[own.clone()]);
    }
    values
}

/// A value between rows at places that rise or fall; beyond them that of the end.
fn between(places: &[f64], values: &[f64], x: f64) -> f64 {
    let falls = places.len() > 1 && places[places.len() - 1] < places[0];
    let sign = if falls { -1.0 } else { 1.0 };
    let above = places.partition_point(|place| sign * place <= sign * x);
    let (low, high) = (above.saturating_sub(1), above.min(places.len() - 1));
    let width = places[high] - places[low];
    if width == 0.0 { values[low] } else { values[low] + (values[high] - values[low]) * (x - places[low]) / width }
}
