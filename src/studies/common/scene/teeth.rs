//! Teeth of wheels that mesh, in the plane. A model gives ratios alone; the drawing has the smallest numbers of teeth in the ratio of the
//! radii, of one module in each train, with which all of its pairs mesh.
//!
//! At the point of contact of two pitch circles a tooth of one meets a gap of the other. With u the number of teeth from a wheel's own first
//! one to that point, counted along its turn, that is u_a + u_b = 1/2 plus a whole number; within a ring, where both turn alike,
//! u_a − u_b = 1/2. As wheels roll on each other these sums stay as they are, so that one frame is enough.

use crate::results::Scene;
use crate::results::scene::{Gear, GearKind, Place, Shape, Wheel, rack};
use std::f64::consts::{PI, TAU};

/// Least number of teeth that are not undercut by a rack at 20°.
const LEAST: usize = 17;
/// Most teeth of a wheel or rack that are drawn.
const MOST: usize = 400;
/// How far numbers of teeth may be from whole ones.
const WHOLE: f64 = 1e-6;
/// How far pairs may be from meshing, parts of a pitch.
const MESHES: f64 = 1e-2;
/// How far pitch circles that touch may be apart, as part of a radius.
const TOUCH: f64 = 1e-5;
/// What of a rack is beyond the places where it is touched, radii of its pinion.
const BEYOND: f64 = 1.0;

/// A wheel with its number of teeth and the direction of the first one in its body, rad.
#[derive(Clone, Debug)]
struct Toothed {
    wheel: Wheel,
    teeth: usize,
    first: f64,
}

/// Gives the wheels that mesh their teeth, in place of the discs of their pitch circles, and racks their outline. The gears of the scene are
/// there.
pub(super) fn cut(scene: &mut Scene) {
    if scene.dimensions != 2 || scene.frames.count() == 0 {
        return;
    }
    let all = toothed(scene);
    let racks = scene.gears.iter().filter(|gear| gear.kind == GearKind::Rack);
    let racks: Vec<(usize, Shape)> = racks.filter_map(|gear| Some((gear.b.body, rack_of(scene, gear, &all)?))).collect();
    for Toothed { wheel, teeth, first } in all {
        let shapes = &mut scene.bodies[wheel.body].shapes;
        let rim = wheel.radius.abs() * (1.0 + 2.5 / teeth as f64);
        let own = |shape: &Shape| matches!(shape, Shape::Disc { center, radius, .. } if apart(center, &wheel.at) <= WHOLE * rim && *radius <= rim);
        shapes.retain(|shape| !own(shape));
        shapes.insert(0, Shape::Gear { center: wheel.at, radius: wheel.radius, teeth, first });
    }
    for (body, shape) in racks {
        scene.bodies[body].shapes.insert(0, shape);
    }
}

/// All wheels of pairs and of racks that have teeth.
fn toothed(scene: &Scene) -> Vec<Toothed> {
    let mut wheels: Vec<Wheel> = Vec::new();
    let mut number = |wheel: &Wheel| {
        wheels.iter().position(|known| same(known, wheel)).unwrap_or_else(|| {
            wheels.push(wheel.clone());
            wheels.len() - 1
        })
    };
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for Gear { kind, a, b, .. } in &scene.gears {
        match kind {
            GearKind::Teeth => pairs.push([number(a), number(b)]),
            GearKind::Rack => {
                number(a);
            }
            GearKind::Belt | GearKind::Rope => {}
        }
    }
    trains(wheels.len(), &pairs).into_iter().flat_map(|of| train(scene, &wheels, &pairs, &of).unwrap_or_default()).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Whether two pitch circles are one.
fn same(a: &Wheel, b: &Wheel) -> bool {
    let near = WHOLE * a.radius.abs();
    a.body == b.body && (a.radius - b.radius).abs() < near && apart(&a.at, &b.at) < near
}

/// The numbers of wheels that mesh with each other, directly or through others.
fn trains(count: usize, pairs: &[[usize; 2]]) -> Vec<Vec<usize>> {
    let mut of: Vec<usize> = (0..count).collect();
    for [a, b] in pairs {
        let (from, to) = (of[*b], of[*a]);
        of.iter_mut().filter(|train| **train == from).for_each(|train| *train = to);
    }
    let members = |train: usize| (0..count).filter(|wheel| of[*wheel] == train).collect::<Vec<_>>();
    (0..count).map(members).filter(|members| !members.is_empty()).collect()
}

/// The teeth of a train; none if there are no whole numbers with which all of its pairs mesh.
fn train(scene: &Scene, wheels: &[Wheel], pairs: &[[usize; 2]], of: &[usize]) -> Option<Vec<Toothed>> {
    let numbers = ratio(&of.iter().map(|wheel| wheels[*wheel].radius.abs()).collect::<Vec<_>>())?;
    let (least, most) = (*numbers.iter().min()?, *numbers.iter().max()?);
    (LEAST.div_ceil(least)..=MOST / most).find_map(|times| {
        let mut teeth = vec![0; wheels.len()];
        of.iter().zip(&numbers).for_each(|(wheel, number)| teeth[*wheel] = times * number);
        let firsts = firsts(scene, wheels, pairs, &teeth, of[0])?;
        Some(of.iter().map(|k| Toothed { wheel: wheels[*k].clone(), teeth: teeth[*k], first: firsts[*k] }).collect())
    })
}

/// The smallest whole numbers in the ratio of radii; none if they are too large.
fn ratio(radii: &[f64]) -> Option<Vec<usize>> {
    let (least, most) = radii.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), r| (least.min(*r), most.max(*r)));
    (1..=MOST).take_while(|n| *n as f64 * most / least <= MOST as f64).find_map(|n| {
        let numbers = radii.iter().map(|radius| n as f64 * radius / least);
        numbers.clone().all(|x| (x - x.round()).abs() < WHOLE).then(|| numbers.map(|x| x.round() as usize).collect())
    })
}

/// Teeth from the first one of a wheel to a direction; both as they stand in the world, rad.
fn count(teeth: usize, first: f64, direction: f64) -> f64 {
    teeth as f64 * (direction - first) / TAU
}

/// Angle of a body, rad, in the first frame, less whole turns.
fn angle(scene: &Scene, body: usize) -> f64 {
    let [x, y, _] = scene.direction(scene.frame(0), body, &[1.0, 0.0]);
    y.atan2(x)
}

/// The directions of contact from the centres of two wheels in the first frame, if their pitch circles touch, and whether both turn alike.
fn contact(scene: &Scene, a: &Wheel, b: &Wheel) -> Option<([f64; 2], bool)> {
    let [p, q] = [a, b].map(|wheel| scene.world(scene.frame(0), &Place { body: wheel.body, at: wheel.at.clone() }));
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    if (dx.hypot(dy) - (a.radius + b.radius).abs()).abs() > TOUCH * a.radius.abs() {
        return None;
    }
    let toward = dy.atan2(dx);
    Some(match (a.radius < 0.0, b.radius < 0.0) {
        (_, true) => ([toward + PI; 2], true),
        (true, false) => ([toward; 2], true),
        (false, false) => ([toward, toward + PI], false),
    })
}

/// The directions of first teeth in their bodies with which all pairs of the train of a wheel mesh, rad; none if there are no such.
fn firsts(scene: &Scene, wheels: &[Wheel], pairs: &[[usize; 2]], teeth: &[usize], start: usize) -> Option<Vec<f64>> {
    let mut found: Vec<Option<f64>> = vec![None; wheels.len()];
    found[start] = Some(0.0);
    let mut open = vec![start];
    while let Some(from) = open.pop() {
        for pair in pairs.iter().filter(|pair| pair.contains(&from)) {
            let to = if pair[0] == from { pair[1] } else { pair[0] };
            let (directions, alike) = contact(scene, &wheels[from], &wheels[to])?;
            let here = count(teeth[from], angle(scene, wheels[from].body) + found[from]?, directions[0]);
            let wanted = if alike { here - 0.5 } else { 0.5 - here };
            let free = count(teeth[to], angle(scene, wheels[to].body), directions[1]);
            match found[to] {
                None => {
                    found[to] = Some((free - wanted) * TAU / teeth[to] as f64);
                    open.push(to);
                }
                Some(first) => {
                    let off = free - first * teeth[to] as f64 / TAU - wanted;
                    if (off - off.round()).abs() > MESHES {
                        return None;
                    }
                }
            }
        }
    }
    Some(found.into_iter().map(Option::unwrap_or_default).collect())
}

/// The outline of a rack in its body, as far as its pinion comes and a little farther.
fn rack_of(scene: &Scene, gear: &Gear, all: &[Toothed]) -> Option<Shape> {
    let Toothed { wheel, teeth, first } = all.iter().find(|toothed| same(&toothed.wheel, &gear.a))?;
    let (radius, module) = (wheel.radius, 2.0 * wheel.radius / *teeth as f64);
    let [start, along] = [&gear.b.at, &gear.b.axis].map(|v| [v[0], v[1]]);
    let touched = |index: usize| {
        let poses = scene.frame(index);
        let [from, center] = [&gear.b, &gear.a].map(|of| scene.world(poses, &Place { body: of.body, at: of.at.clone() }));
        let to: [f64; 2] = [center[0] - from[0], center[1] - from[1]];
        // in the axes of the rack
        let own = |e: [f64; 2]| {
            let [x, y, _] = scene.direction(poses, gear.b.body, &e);
            x * to[0] + y * to[1]
        };
        [own(along), own([-along[1], along[0]])]
    };
    let ways = (0..scene.frames.count()).map(|index| touched(index)[0]).filter(|s| s.is_finite());
    let [low, high] = ways.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| [low.min(s), high.max(s)]);
    let ends = [low - BEYOND * radius, high + BEYOND * radius];
    let length = ends[1] - ends[0];
    if length.is_nan() || length > MOST as f64 * PI * module {
        return None;
    }
    // where one of its teeth is: a gap of the pinion is where it is touched
    let [at, aside] = touched(0);
    let side = aside.signum();
    let up = [-along[1], along[0]].map(|x| side * x);
    let [x, y, _] = scene.direction(scene.frame(0), gear.b.body, &up.map(|x| -x));
    let own = side * (count(*teeth, angle(scene, wheel.body) + first, y.atan2(x)) - 0.5);
    let tooth = at - own * PI * module;
    Some(Shape::Polygon { points: rack(module, [start, along, up], ends, tooth).into_iter().map(|p| p.to_vec()).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_teeth_are_the_smallest_in_their_ratio() {
        assert_eq!(ratio(&[0.018, 0.027, 0.072]), Some(vec![2, 3, 8]));
        assert_eq!(ratio(&[0.3, 0.3]), Some(vec![1, 1]));
        assert_eq!(ratio(&[1.0, std::f64::consts::SQRT_2]), None);
        assert_eq!(ratio(&[1.0, 401.0]), None);
    }

    #[test]
    fn wheels_that_mesh_through_others_are_one_train() {
        assert_eq!(trains(5, &[[0, 1], [3, 1], [4, 2]]), [vec![0, 1, 3], vec![2, 4]]);
    }
}
