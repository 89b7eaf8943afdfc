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
/// Least difference of the numbers of teeth of a ring and a wheel within it, whose tips would meet beside the place of contact.
const APART: usize = 9;
/// Width of the stem from the slide of a rack to it, and least distance that it bridges, modules.
const STEM: f64 = 4.0;

/// A wheel with its number of teeth and the direction of the first one in its body, rad; or a rack, of radius 0, with the teeth that a whole
/// turn of its first pinion takes and the place of a tooth along its line, m.
#[derive(Clone, Debug)]
struct Toothed {
    wheel: Wheel,
    teeth: usize,
    first: f64,
    /// Of all wheels and racks that mesh with it, m.
    module: f64,
}

/// Gives the wheels that mesh their teeth, in place of the discs of their pitch circles, and racks their outline. The gears of the scene are
/// there.
pub(super) fn cut(scene: &mut Scene) {
    if scene.dimensions != 2 || scene.frames.count() == 0 {
        return;
    }
    let (racks, wheels): (Vec<Toothed>, Vec<Toothed>) = toothed(scene).into_iter().partition(|one| one.wheel.radius == 0.0);
    let racks: Vec<(usize, Vec<Shape>)> = racks.iter().filter_map(|one| Some((one.wheel.body, rack_of(scene, one)?))).collect();
    for Toothed { wheel, teeth, first, .. } in wheels {
        let shapes = &mut scene.bodies[wheel.body].shapes;
        let pitch = wheel.radius.abs();
        // what is smaller is a hub, and what is larger a disc beside it
        let own = |shape: &Shape| matches!(shape, Shape::Disc { center, radius, .. } if apart(center, &wheel.at) <= WHOLE * pitch && (radius / pitch - 1.0).abs() <= 2.5 / teeth as f64);
        shapes.retain(|shape| !own(shape));
        shapes.insert(0, Shape::Gear { center: wheel.at, radius: wheel.radius, teeth, first });
    }
    for (body, shapes) in racks {
        scene.bodies[body].shapes.splice(0..0, shapes);
    }
}

/// All wheels of pairs and of racks that have teeth, and the racks.
fn toothed(scene: &Scene) -> Vec<Toothed> {
    let mut wheels: Vec<Wheel> = Vec::new();
    let mut number = |wheel: &Wheel| {
        wheels.iter().position(|known| same(known, wheel)).unwrap_or_else(|| {
            wheels.push(wheel.clone());
            wheels.len() - 1
        })
    };
    let meshing = scene.gears.iter().filter(|gear| matches!(gear.kind, GearKind::Teeth | GearKind::Rack));
    let pairs: Vec<[usize; 2]> = meshing.map(|gear| [number(&gear.a), number(&gear.b)]).collect();
    trains(wheels.len(), &pairs).into_iter().flat_map(|of| train(scene, &wheels, &pairs, &of).unwrap_or_default()).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Whether two pitch circles, or the lines of two racks, are one.
fn same(a: &Wheel, b: &Wheel) -> bool {
    if a.body != b.body || (a.radius == 0.0) != (b.radius == 0.0) {
        return false;
    }
    if a.radius == 0.0 {
        let [x, y] = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
        let aside = |[u, v]: [f64; 2]| (u * a.axis[1] - v * a.axis[0]).abs();
        return aside([x, y]) <= WHOLE * x.hypot(y) && aside([b.axis[0], b.axis[1]]) <= WHOLE;
    }
    let near = WHOLE * a.radius.abs();
    (a.radius - b.radius).abs() < near && apart(&a.at, &b.at) < near
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
    let round: Vec<usize> = of.iter().copied().filter(|wheel| wheels[*wheel].radius != 0.0).collect();
    let numbers = ratio(&round.iter().map(|wheel| wheels[*wheel].radius.abs()).collect::<Vec<_>>())?;
    let (least, most) = (*numbers.iter().min()?, *numbers.iter().max()?);
    (LEAST.div_ceil(least)..=MOST / most).find_map(|times| {
        let mut teeth = vec![0; wheels.len()];
        round.iter().zip(&numbers).for_each(|(wheel, number)| teeth[*wheel] = times * number);
        let fits = |[a, b]: &[usize; 2]| {
            let within = wheels[*a].radius < 0.0 || wheels[*b].radius < 0.0;
            !of.contains(a) || !within || teeth[*a].abs_diff(teeth[*b]) >= APART
        };
        if !pairs.iter().all(fits) {
            return None;
        }
        let module = 2.0 * wheels[round[0]].radius.abs() / teeth[round[0]] as f64;
        let firsts = firsts(scene, (wheels, pairs, &teeth), module, round[0])?;
        Some(of.iter().map(|k| Toothed { wheel: wheels[*k].clone(), teeth: teeth[*k], first: firsts[*k], module }).collect())
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

/// Where two wheels, or a pinion and its rack, touch in the first frame, and how teeth are counted there.
#[derive(Clone, Copy, Debug)]
struct Contact {
    /// Of each a number of teeth from its own beginning to the point of contact, if its first tooth is there.
    free: [f64; 2],
    /// Whether both numbers grow together as they roll.
    alike: bool,
}

/// Angle of a body, rad, in the first frame, less whole turns.
fn angle(scene: &Scene, body: usize) -> f64 {
    let [x, y, _] = scene.direction(scene.frame(0), body, &[1.0, 0.0]);
    y.atan2(x)
}

/// The contact of two wheels with so many teeth, or of a pinion and its rack; none where pitch circles do not touch.
fn contact(scene: &Scene, [a, b]: [&Wheel; 2], teeth: [usize; 2], module: f64) -> Option<Contact> {
    let turned = |wheel: &Wheel, teeth: usize, direction: f64| teeth as f64 * (direction - angle(scene, wheel.body)) / TAU;
    if a.radius == 0.0 {
        let Contact { free, alike } = contact(scene, [b, a], [teeth[1], teeth[0]], module)?;
        return Some(Contact { free: [free[1], free[0]], alike });
    }
    let [p, q] = [a, b].map(|wheel| scene.world(scene.frame(0), &Place { body: wheel.body, at: wheel.at.clone() }));
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    if b.radius == 0.0 {
        let [along, aside] = touched(scene, a, b, 0);
        let [x, y, _] = scene.direction(scene.frame(0), b.body, &toothed_side(b, aside).map(|x| -x));
        // along a line on its right a wheel that turns counter-clockwise counts its teeth backwards
        return Some(Contact { free: [turned(a, teeth[0], y.atan2(x)), along / (PI * module)], alike: aside > 0.0 });
    }
    if (dx.hypot(dy) - (a.radius + b.radius).abs()).abs() > TOUCH * a.radius.abs() {
        return None;
    }
    let toward = dy.atan2(dx);
    let (directions, alike) = match (a.radius < 0.0, b.radius < 0.0) {
        (_, true) => ([toward + PI; 2], true),
        (true, false) => ([toward; 2], true),
        (false, false) => ([toward, toward + PI], false),
    };
    Some(Contact { free: [turned(a, teeth[0], directions[0]), turned(b, teeth[1], directions[1])], alike })
}

/// The unit direction in the body of a rack in which its teeth point, for a pinion on this side of its line.
fn toothed_side(rack: &Wheel, aside: f64) -> [f64; 2] {
    [-rack.axis[1], rack.axis[0]].map(|x| aside.signum() * x)
}

/// Where a pinion is in a frame, in the axes of its rack: along its line from its own place, and to the left of it, m.
fn touched(scene: &Scene, pinion: &Wheel, rack: &Wheel, frame: usize) -> [f64; 2] {
    let poses = scene.frame(frame);
    let [from, center] = [rack, pinion].map(|of| scene.world(poses, &Place { body: of.body, at: of.at.clone() }));
    let own = |e: [f64; 2]| {
        let [x, y, _] = scene.direction(poses, rack.body, &e);
        x * (center[0] - from[0]) + y * (center[1] - from[1])
    };
    [own([rack.axis[0], rack.axis[1]]), own([-rack.axis[1], rack.axis[0]])]
}

/// Where the first teeth of a train are with which all of its pairs mesh: of wheels directions in their bodies, rad, of racks places along their
/// lines, m; none if there are no such.
fn firsts(scene: &Scene, (wheels, pairs, teeth): (&[Wheel], &[[usize; 2]], &[usize]), module: f64, start: usize) -> Option<Vec<f64>> {
    // in teeth
    let mut found: Vec<Option<f64>> = vec![None; wheels.len()];
    found[start] = Some(0.0);
    let mut open = vec![start];
    while let Some(from) = open.pop() {
        for pair in pairs.iter().filter(|pair| pair.contains(&from)) {
            let to = if pair[0] == from { pair[1] } else { pair[0] };
            let Contact { free, alike } = contact(scene, [&wheels[from], &wheels[to]], [teeth[from], teeth[to]], module)?;
            let here = free[0] - found[from]?;
            let wanted = if alike { here - 0.5 } else { 0.5 - here };
            match found[to] {
                None => {
                    found[to] = Some(free[1] - wanted);
                    open.push(to);
                }
                Some(first) => {
                    let off = free[1] - first - wanted;
                    if (off - off.round()).abs() > MESHES {
                        return None;
                    }
                }
            }
        }
    }
    let size = |k: usize| if wheels[k].radius == 0.0 { PI * module } else { TAU / teeth[k] as f64 };
    Some(found.into_iter().enumerate().map(|(k, first)| first.map_or(0.0, |first| first * size(k))).collect())
}

/// The outline of a rack in its body, as far as its pinions come and a little farther, and a stem from its slide if that is beside it.
fn rack_of(scene: &Scene, of: &Toothed) -> Option<Vec<Shape>> {
    let Toothed { wheel, first, module, .. } = of;
    let pinions = scene.gears.iter().filter(|gear| gear.kind == GearKind::Rack && same(&gear.b, wheel));
    let (mut ends, mut side) = ([f64::INFINITY, f64::NEG_INFINITY], 0.0);
    for Gear { a, .. } in pinions {
        for [s, aside] in (0..scene.frames.count()).map(|frame| touched(scene, a, wheel, frame)).filter(|p| p[0].is_finite()) {
            ends = [ends[0].min(s - BEYOND * a.radius), ends[1].max(s + BEYOND * a.radius)];
            side = if side == 0.0 { aside } else { side };
        }
    }
    let length = ends[1] - ends[0];
    if !length.is_finite() || length > MOST as f64 * PI * module {
        return None;
    }
    let (up, [start, along]) = (toothed_side(wheel, side), [&wheel.at, &wheel.axis].map(|v| [v[0], v[1]]));
    let mut shapes =
        vec![Shape::Polygon { points: rack(*module, [start, along, up], ends, *first).into_iter().map(|p| p.to_vec()).collect() }];
    let slides = scene.joints.iter().filter(|joint| joint.kind == "slider").flat_map(|joint| [&joint.a, &joint.b]);
    if let Some(slide) = slides.into_iter().find(|place| wheel.body != 0 && place.body == wheel.body)
        && scene.bodies[wheel.body].shapes.iter().all(|shape| matches!(shape, Shape::Hull { .. } | Shape::Mass { .. }))
    {
        let from = [slide.at[0] - start[0], slide.at[1] - start[1]];
        let [s, height] = [along, up].map(|e| e[0] * from[0] + e[1] * from[1]);
        if height.abs() > STEM * module {
            let s = s.clamp(ends[0], ends[1]);
            let foot = (0..2).map(|i| start[i] + s * along[i] - 0.5 * STEM * module * up[i]).collect();
            shapes.push(Shape::Bar { from: slide.at.clone(), to: foot, width: Some(STEM * module) });
        }
    }
    Some(shapes)
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
