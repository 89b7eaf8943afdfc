//! Where slides are seen: a rod at the mouth of its cylinder, and what slides in space on a guide beside it.
//!
//! A model may name any point of a body for a slide; what guides a rod is the end of its cylinder, and a guide through the middle of a solid
//! body is not seen, or seems to pierce it.

use crate::results::Scene;
use crate::results::scene::{Joint, Place, Shape};

/// Most of a rod's thickness, as part of its length.
const SLENDER: f64 = 0.25;

/// By how much a cylinder must be thicker than its rod to be told from it.
const THICKER: f64 = 1.01;

/// What a rod without width seems to be off its axis, as part of its length.
const ROUND_OFF: f64 = 1e-9;

/// Where the eye is in the first view of a picture in space, beside which guides stand.
const EYE: [f64; 3] = [1.0, 1.0, 1.0];

/// What of a body lies along a slide, measured along the axis from the point of its joint, m.
#[derive(Clone, Copy)]
struct Rod {
    ends: [f64; 2],
    /// How far it reaches from the axis, m.
    radius: f64,
}

/// A slide as it is seen. The frames of the scene are there.
pub(super) fn seen(scene: &Scene, joint: Joint) -> Joint {
    if joint.kind != "slider" || scene.frames.count() == 0 {
        return joint;
    }
    telescope(scene, &joint).or_else(|| beside(scene, &joint)).unwrap_or(joint)
}

/// A slide between a cylinder and its rod: the mouth of the cylinder on the rod.
fn telescope(scene: &Scene, joint: &Joint) -> Option<Joint> {
    let [low, high] = joint.stroke?;
    let first = rod(scene, &joint.a, &joint.axis)?;
    let own = in_body(scene, &joint.b, joint);
    let second = rod(scene, &joint.b, &own)?;
    // how far the second sticks out of the first at the ends of the stroke
    let out = [first.ends[0] - (second.ends[0] + low), second.ends[1] + high - first.ends[1]];
    let meets = |s: f64| second.ends[0] + s <= first.ends[1] && second.ends[1] + s >= first.ends[0];
    if !meets(low) || !meets(high) || out[0].max(out[1]) <= 0.0 {
        return None;
    }
    let ahead = out[1] >= out[0];
    let end = |rod: Rod, ahead: bool| rod.ends[usize::from(ahead)];
    let moved = |ends: [f64; 2], by: f64| ends.map(|s| s + by);
    let stops = |by: f64| joint.stops.map(|stop| stop.map(|s| s + by));
    let along =
        |place: &Place, axis: &[f64], s: f64| Place { body: place.body, at: place.at.iter().zip(axis).map(|(x, e)| x + s * e).collect() };
    let round_off = ROUND_OFF * (first.ends[1] - first.ends[0]);
    if second.radius > THICKER * first.radius + round_off {
        let mouth = end(second, !ahead);
        return Some(Joint {
            b: along(&joint.b, &own, mouth),
            stroke: Some(moved([low, high], mouth)),
            stops: stops(mouth),
            telescopes: true,
            ..joint.clone()
        });
    }
    let mouth = end(first, ahead);
    Some(Joint {
        a: joint.b.clone(),
        b: along(&joint.a, &joint.axis, mouth),
        axis: own.iter().map(|e| 0.0 - e).collect(),
        stroke: Some(moved([low, high], -mouth)),
        stops: stops(-mouth),
        telescopes: true,
        ..joint.clone()
    })
}

/// The axis of a slide in the frame of its second body.
fn in_body(scene: &Scene, place: &Place, joint: &Joint) -> Vec<f64> {
    let world = scene.direction(scene.frame(0), joint.a.body, &joint.axis);
    turned_back(scene, place.body, world)
}

/// A direction of the world in the frame of a body, at the first frame.
fn turned_back(scene: &Scene, body: usize, world: [f64; 3]) -> Vec<f64> {
    let unit = |i: usize| std::array::from_fn::<f64, 3, _>(|k| f64::from(u8::from(i == k)));
    let own = |i: usize| scene.direction(scene.frame(0), body, &unit(i)).iter().zip(world).map(|(e, w)| e * w).sum();
    (0..scene.dimensions).map(own).collect()
}

/// What of a body is a rod along an axis through a place of it.
fn rod(scene: &Scene, place: &Place, axis: &[f64]) -> Option<Rod> {
    let shapes = scene.bodies[place.body].shapes.iter().filter_map(corners);
    let rods = shapes.filter_map(|(corners, radius)| {
        let mut rod = Rod { ends: [f64::INFINITY, f64::NEG_INFINITY], radius: 0.0 };
        for corner in corners {
            let from: Vec<f64> = corner.iter().zip(&place.at).map(|(x, p)| x - p).collect();
            let s: f64 = from.iter().zip(axis).map(|(x, e)| x * e).sum();
            let off = from.iter().zip(axis).map(|(x, e)| (x - s * e).powi(2)).sum::<f64>().sqrt();
            rod.ends = [rod.ends[0].min(s), rod.ends[1].max(s)];
            rod.radius = rod.radius.max(off);
        }
        rod.radius += radius;
        (rod.radius <= SLENDER * (rod.ends[1] - rod.ends[0])).then_some(rod)
    });
    rods.reduce(|a, b| Rod { ends: [a.ends[0].min(b.ends[0]), a.ends[1].max(b.ends[1])], radius: a.radius.max(b.radius) })
}

/// The corners of what may be a rod, and how far it reaches beyond them.
fn corners(shape: &Shape) -> Option<(Vec<Vec<f64>>, f64)> {
    match shape {
        Shape::Bar { from, to, width } => Some((vec![from.clone(), to.clone()], 0.5 * width.unwrap_or(0.0))),
        Shape::Cylinder { from, to, radius } => Some((vec![from.clone(), to.clone()], *radius)),
        Shape::Hull { points } | Shape::Polygon { points } => Some((points.clone(), 0.0)),
        Shape::Box { center, size } => {
            let corner = |k: usize| {
                let side = |i: usize| if k >> i & 1 == 0 { -0.5 } else { 0.5 };
                center.iter().zip(size).enumerate().map(|(i, (c, size))| c + side(i) * size).collect()
            };
            Some(((0..1 << center.len()).map(corner).collect(), 0.0))
        }
        Shape::Disc { .. } | Shape::Gear { .. } | Shape::Sphere { .. } | Shape::Mass { .. } => None,
    }
}

/// A slide in space through a solid body: on the side of that, to the right of it in the first view.
fn beside(scene: &Scene, joint: &Joint) -> Option<Joint> {
    if scene.dimensions != 3 {
        return None;
    }
    let axis = scene.direction(scene.frame(0), joint.a.body, &joint.axis);
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let right = [
        scene.up[1] * EYE[2] - scene.up[2] * EYE[1],
        scene.up[2] * EYE[0] - scene.up[0] * EYE[2],
        scene.up[0] * EYE[1] - scene.up[1] * EYE[0],
    ];
    // along the axes of the world as far as they are across, those that are seen first
    let sides = (0..3).flat_map(|i| [1.0, -1.0].map(|sign| std::array::from_fn::<f64, 3, _>(|k| if i == k { sign } else { 0.0 })));
    let across = sides.filter_map(|w| {
        let along = dot(w, axis);
        let off: [f64; 3] = std::array::from_fn(|i| w[i] - along * axis[i]);
        let length = dot(off, off).sqrt();
        (length > 0.5).then(|| off.map(|x| x / length))
    });
    let side = across.max_by(|a, b| (dot(*a, right) + 1e-3 * dot(*a, EYE)).total_cmp(&(dot(*b, right) + 1e-3 * dot(*b, EYE))))?;
    let own = turned_back(scene, joint.b.body, side);
    let back: Vec<f64> = own.iter().map(|e| -e).collect();
    let solids = scene.bodies[joint.b.body].shapes.iter();
    let [reach, behind] = solids.fold([0.0; 2], |[reach, behind], shape| {
        [f64::max(reach, reaches(shape, &joint.b.at, &own)), f64::max(behind, reaches(shape, &joint.b.at, &back))]
    });
    if reach <= 0.0 || behind <= 0.0 {
        return None;
    }
    let moved = |place: &Place| Place {
        body: place.body,
        at: place.at.iter().zip(turned_back(scene, place.body, side)).map(|(x, e)| x + reach * e).collect(),
    };
    Some(Joint { a: moved(&joint.a), b: moved(&joint.b), ..joint.clone() })
}

/// How far a solid reaches from a place in a direction, both in its body, m.
fn reaches(shape: &Shape, from: &[f64], along: &[f64]) -> f64 {
    let dot = |v: &[f64]| v.iter().zip(along).map(|(x, e)| x * e).sum::<f64>();
    let at = |p: &[f64]| dot(&p.iter().zip(from).map(|(p, f)| p - f).collect::<Vec<f64>>());
    match shape {
        Shape::Box { center, size } => at(center) + 0.5 * size.iter().zip(along).map(|(size, e)| (size * e).abs()).sum::<f64>(),
        Shape::Sphere { center, radius } => at(center) + radius,
        Shape::Disc { center, radius, axis: Some(axis), thickness: Some(thickness) } => {
            let tilt = dot(axis);
            at(center) + radius * (1.0 - tilt * tilt).max(0.0).sqrt() + 0.5 * thickness * tilt.abs()
        }
        _ => 0.0,
    }
}
