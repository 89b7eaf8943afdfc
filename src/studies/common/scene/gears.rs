//! Pitch circles of gears and racks, belts and ropes, which the model does not give: they follow from the ratio and the distance of the axes.
//!
//! With both hinges on one carrier, at a distance d, and wheels that turn relative to it by φ_b = ρ φ_a: teeth that run on each other
//! turn outer gears against each other, ρ < 0, r_a + r_b = d; one with inner teeth turns like the other, ρ > 0, |r_a − r_b| = d; in
//! both |ρ| = r_a/r_b. Wheels that turn alike are joined by a belt or chain, r_a = ρ r_b, unless outlines show that one has inner teeth.

use super::places::numbers;
use crate::geometry::Space;
use crate::mechanism::{Joint, Mechanism, Outline, RowKind, RowOwner};
use crate::model::{CouplingKind, Model};
use crate::results::Scene;
use crate::results::scene::{Body, Gear, GearKind, Place, Shape, Wheel};

/// A disc up to this multiple of a pitch circle is that of the pitch circle.
const PITCH: f64 = 1.02;
/// Radius of the larger wheel under a belt whose outlines do not tell it, as part of the distance of the axes.
const UNDER_BELT: f64 = 0.2;

/// The gears of a mechanism whose circles can be told. The frames of the scene are there.
pub(super) fn gears<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>, scene: &Scene) -> Vec<Gear> {
    if scene.frames.count() == 0 {
        return Vec::new();
    }
    let welded = Welded::of(mechanism);
    let rows = mechanism.rows.iter().filter(|row| row.owner == RowOwner::Coupling);
    let all = rows.filter_map(|row| {
        let RowKind::Ratio { first, second, ratio } = row.kind else { return None };
        let of_gauge = |gauge: usize| mechanism.joints.iter().find(|joint| joint.slots.first() == Some(&gauge));
        let (first, second) = (of_gauge(first)?, of_gauge(second)?);
        match (first.kind, second.kind) {
            ("revolute", "revolute") => pair(mechanism, (scene, &welded), &row.label, [first, second], ratio),
            ("revolute", "slider") if is_rope(model, &row.label) => rope(&row.label, [first, second], ratio, (scene, &welded)),
            ("revolute", "slider") => rack(&row.label, [first, second], ratio, (scene, &welded)),
            _ => None,
        }
    });
    all.map(|gear| Gear { a: on_disc::<G>(scene, &welded, gear.a), b: on_disc::<G>(scene, &welded, gear.b), ..gear }).collect()
}

/// A wheel on that of the bodies welded to its own which has the disc of the pitch circle.
fn on_disc<G: Space<S = f64>>(scene: &Scene, welded: &Welded, wheel: Wheel) -> Wheel {
    let poses = scene.frame(0);
    let world = |body: usize, at: &[f64]| scene.world(poses, &Place { body, at: at.to_vec() });
    let (center, radius) = (world(wheel.body, &wheel.at), wheel.radius.abs());
    let disc = |body: usize| {
        scene.bodies[body].shapes.iter().find_map(|shape| match shape {
            Shape::Disc { center: at, radius: r, .. } if (r / radius - 1.0).abs() <= PITCH - 1.0 => {
                let gap = world(body, at).iter().zip(center).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt();
                (gap <= (PITCH - 1.0) * radius).then(|| at.clone())
            }
            _ => None,
        })
    };
    if wheel.radius == 0.0 || disc(wheel.body).is_some() {
        return wheel;
    }
    let others = (0..scene.bodies.len()).filter(|body| *body != wheel.body && welded.0[*body] == welded.0[wheel.body]);
    let Some((body, at)) = others.into_iter().find_map(|body| Some((body, disc(body)?))) else { return wheel };
    let axis = if wheel.axis.is_empty() { Vec::new() } else { own::<G>(scene, body, scene.direction(poses, wheel.body, &wheel.axis)) };
    Wheel { body, at, axis, ..wheel }
}

/// Gives wheels with outer teeth that have no outline of their own the disc of their pitch circle, and takes the disc of its pitch circle
/// from a wheel with inner teeth in the plane, in which the others stand.
pub(super) fn outline_wheels<G: Space<S = f64>>(mechanism: &Mechanism<G>, gears: &[Gear], bodies: &mut [Body]) {
    let of_bars = |body: usize, shapes: &[Shape]| {
        let bar = matches!(mechanism.bodies[body].outline, Some(Outline::Bar { .. }));
        let of_bar = |shape: &Shape| matches!(shape, Shape::Bar { .. } | Shape::Hull { .. } | Shape::Mass { .. });
        shapes.iter().all(|shape| of_bar(shape) || bar && matches!(shape, Shape::Box { .. }))
    };
    for wheel in
        gears.iter().flat_map(|gear| [&gear.a, &gear.b]).filter(|wheel| wheel.body > 0 && wheel.radius < 0.0 && wheel.axis.is_empty())
    {
        let pitch = |shape: &Shape| matches!(shape, Shape::Disc { radius, .. } if *radius <= PITCH * wheel.radius.abs());
        bodies[wheel.body].shapes.retain(|shape| !pitch(shape));
    }
    for gear in gears.iter().filter(|gear| !matches!(gear.kind, GearKind::Rope)) {
        for wheel in [&gear.a, &gear.b].into_iter().filter(|wheel| wheel.body > 0 && wheel.radius > 0.0) {
            let shapes = &mut bodies[wheel.body].shapes;
            if of_bars(wheel.body, shapes) {
                let axis = (!wheel.axis.is_empty()).then(|| wheel.axis.clone());
                shapes.insert(0, Shape::Disc { center: wheel.at.clone(), radius: wheel.radius, axis, thickness: None });
            }
        }
    }
}

/// Whether a coupling is a rope.
fn is_rope(model: &Model, name: &str) -> bool {
    model.couplings.iter().any(|coupling| coupling.name == name && matches!(coupling.kind, CouplingKind::Rack { rope: true, .. }))
}

/// For each body that one of the bodies welded to it which stands for all of them.
struct Welded(Vec<usize>);

impl Welded {
    fn of<G: Space>(mechanism: &Mechanism<G>) -> Self {
        let mut of: Vec<usize> = (0..mechanism.bodies.len()).collect();
        for joint in mechanism.joints.iter().filter(|joint| joint.kind == "fixed") {
            let (kept, gone) = (of[joint.a.0].min(of[joint.b.0]), of[joint.a.0].max(of[joint.b.0]));
            of.iter_mut().filter(|body| **body == gone).for_each(|body| *body = kept);
        }
        Self(of)
    }

    /// What carries both of two joints: the body on one side of each, or bodies welded to each other.
    fn carrier<G: Space>(&self, first: &Joint<G>, second: &Joint<G>) -> Option<usize> {
        let of = |side: (usize, G::Vector)| self.0[side.0];
        [first.a, first.b].map(of).into_iter().find(|body| [second.a, second.b].map(of).contains(body))
    }
}

/// A wheel on its hinge: its side of the joint and that of the carrier, and 1 if the wheel is the second body.
struct Hung<G: Space> {
    wheel: (usize, G::Vector),
    carrier: (usize, G::Vector),
    sign: f64,
}

/// The axis of a joint in the first frame, world axes.
fn direction<G: Space<S = f64>>(scene: &Scene, joint: &Joint<G>) -> [f64; 3] {
    scene.direction(scene.frame(0), joint.a.0, &joint.axis[..G::VECTOR])
}

/// A direction of the first frame in the axes of a body.
fn own<G: Space<S = f64>>(scene: &Scene, body: usize, v: [f64; 3]) -> Vec<f64> {
    let axis = |i: usize| scene.direction(scene.frame(0), body, &std::array::from_fn::<_, 3, _>(|k| f64::from(u8::from(i == k))));
    (0..G::VECTOR).map(|i| axis(i).iter().zip(v).map(|(e, v)| e * v).sum()).collect()
}

impl<G: Space<S = f64>> Hung<G> {
    /// The wheel of a hinge whose other body is welded to the carrier.
    fn on(joint: &Joint<G>, carrier: usize, welded: &Welded) -> Option<Self> {
        let is_carrier = |side: (usize, G::Vector)| welded.0[side.0] == carrier;
        match [joint.a, joint.b].map(is_carrier) {
            [true, _] => Some(Self { wheel: joint.b, carrier: joint.a, sign: 1.0 }),
            [_, true] => Some(Self { wheel: joint.a, carrier: joint.b, sign: -1.0 }),
            _ => None,
        }
    }

    /// Its pitch circle, about the axis of its hinge.
    fn circle(&self, joint: &Joint<G>, radius: f64, scene: &Scene) -> Wheel {
        let axis = if G::VECTOR == 3 { own::<G>(scene, self.wheel.0, direction(scene, joint)) } else { Vec::new() };
        Wheel { body: self.wheel.0, at: numbers::<G>(self.wheel.1), radius, axis }
    }
}

/// Two gears.
fn pair<G: Space<S = f64>>(
    mechanism: &Mechanism<G>,
    (scene, welded): (&Scene, &Welded),
    name: &str,
    [first, second]: [&Joint<G>; 2],
    ratio: f64,
) -> Option<Gear> {
    let carrier = welded.carrier(first, second)?;
    let (a, b) = (Hung::on(first, carrier, welded)?, Hung::on(second, carrier, welded)?);
    let in_plane = G::VECTOR == 2;
    let axes = [first, second].map(|joint| if in_plane { [0.0, 0.0, 1.0] } else { direction(scene, joint) });
    let dot = |x: [f64; 3], y: [f64; 3]| (0..3).map(|i| x[i] * y[i]).sum::<f64>();
    let facing = dot(axes[0], axes[1]);
    if facing.abs() < 1.0 - 1e-6 {
        return None;
    }
    let [from, to] = [a.carrier, b.carrier].map(|at| scene.world(scene.frame(0), &super::places::place::<G>(at)));
    let apart: [f64; 3] = std::array::from_fn(|i| to[i] - from[i]);
    let along = dot(apart, axes[0]);
    let distance = (dot(apart, apart) - along * along).max(0.0).sqrt();
    let turned = ratio * a.sign * b.sign * facing.signum();
    let wheels = [a.wheel, b.wheel].map(|(body, hinge)| Seen::of(mechanism, body, hinge));
    let (kind, [ra, rb]) = if turned > 0.0 && !has_inner_teeth(turned, distance, wheels) {
        (GearKind::Belt, belted(turned, distance, wheels)?)
    } else {
        (GearKind::Teeth, radii(turned, distance)?)
    };
    Some(Gear { name: name.into(), kind, a: a.circle(first, ra, scene), b: b.circle(second, rb, scene) })
}

/// What the outline of a wheel tells of its size, m.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    /// Radius of a disc about its hinge; 0 if it has none.
    disc: f64,
    /// How far it reaches from its hinge; 0 without an outline.
    reach: f64,
    /// Whether it is fixed to the ground, which has no outline.
    ground: bool,
}

impl Seen {
    fn of<G: Space<S = f64>>(mechanism: &Mechanism<G>, body: usize, hinge: G::Vector) -> Self {
        let ground = body == 0;
        let body = &mechanism.bodies[body];
        let disc = match body.outline {
            Some(Outline::Disc { center, radius, .. }) if G::vector(&center) == hinge => radius,
            _ => 0.0,
        };
        let reach = body.drawn.iter().map(|at| G::dot(*at - hinge, *at - hinge).sqrt()).fold(disc, f64::max);
        Self { disc, reach, ground }
    }
}

/// Whether of two wheels that turn alike the larger one has inner teeth: it is the ground, or its disc goes around the axis of the other, or
/// that of the other is its pitch circle.
fn has_inner_teeth(ratio: f64, distance: f64, [a, b]: [Seen; 2]) -> bool {
    let Some([ra, rb]) = radii(ratio, distance) else { return false };
    let (ring, wheel, pitch) = if ra < 0.0 { (a, b, rb) } else { (b, a, ra) };
    ring.ground || ring.disc >= distance || (wheel.disc / pitch - 1.0).abs() <= PITCH - 1.0
}

/// Radii of two wheels under a belt: within their outlines if these stand apart.
fn belted(ratio: f64, distance: f64, [a, b]: [Seen; 2]) -> Option<[f64; 2]> {
    let apart = a.reach + b.reach < distance;
    let most = |wheel: Seen| if apart && wheel.reach > 0.0 { wheel.reach } else { UNDER_BELT * distance };
    let rb = most(b).min(most(a) / ratio);
    (rb > 0.0 && rb.is_finite()).then_some([ratio * rb, rb])
}

/// Radii of two gears, the one with inner teeth negative.
fn radii(ratio: f64, distance: f64) -> Option<[f64; 2]> {
    let size = ratio.abs();
    let usable = |r: f64| (r > 0.0 && r.is_finite() && distance > 0.0).then_some(r);
    if ratio < 0.0 {
        let rb = usable(distance / (1.0 + size))?;
        return Some([size * rb, rb]);
    }
    let rb = usable(distance / (size - 1.0).abs())?;
    // that with inner teeth is the larger one
    Some(if size > 1.0 { [-size * rb, rb] } else { [size * rb, -rb] })
}

/// A wheel and what slides, both on one carrier.
struct Wound<G: Space> {
    wheel: Hung<G>,
    moved: Hung<G>,
    /// Direction of the slide in the first frame, world axes.
    axis: [f64; 3],
    /// Where the wheel is touched there, from its centre, as part of the radius: with the slide along u and the wheel turning about n, a
    /// point at c moves by φ n × c; that is r φ u for c = r u × n.
    touched: [f64; 3],
    /// Way of the slide along it by the angle of the wheel, m.
    radius: f64,
}

impl<G: Space<S = f64>> Wound<G> {
    /// Of the hinge of a wheel and a slide across its axis.
    fn of([pinion, slide]: [&Joint<G>; 2], radius: f64, (scene, welded): (&Scene, &Welded)) -> Option<Self> {
        let carrier = welded.carrier(pinion, slide)?;
        let (wheel, moved) = (Hung::on(pinion, carrier, welded)?, Hung::on(slide, carrier, welded)?);
        let (u, n) = (direction(scene, slide), if G::VECTOR == 3 { direction(scene, pinion) } else { [0.0, 0.0, 1.0] });
        let across = (0..3).map(|i| u[i] * n[i]).sum::<f64>().abs() < 1e-6;
        let touched = [u[1] * n[2] - u[2] * n[1], u[2] * n[0] - u[0] * n[2], u[0] * n[1] - u[1] * n[0]];
        across.then_some(Self { radius: radius * wheel.sign * moved.sign, wheel, moved, axis: u, touched })
    }
}

/// A pinion and its rack: the line along the slide that the pinion touches.
fn rack<G: Space<S = f64>>(name: &str, joints: [&Joint<G>; 2], radius: f64, in_scene: (&Scene, &Welded)) -> Option<Gear> {
    let (scene, [pinion, _]) = (in_scene.0, joints);
    let wound = Wound::of(joints, radius, in_scene)?;
    let Wound { wheel, moved, axis, touched, radius: signed } = &wound;
    let world = |at| scene.world(scene.frame(0), &super::places::place::<G>(at));
    let center = world(wheel.wheel);
    let origin = world((moved.wheel.0, G::Vector::default()));
    let at = own::<G>(scene, moved.wheel.0, std::array::from_fn(|i| center[i] + signed * touched[i] - origin[i]));
    let line = Wheel { body: moved.wheel.0, at, radius: 0.0, axis: own::<G>(scene, moved.wheel.0, *axis) };
    Some(Gear { name: name.into(), kind: GearKind::Rack, a: wheel.circle(pinion, radius.abs(), scene), b: line })
}

/// A drum and the end of its rope, which is at the joint of what slides.
fn rope<G: Space<S = f64>>(name: &str, joints: [&Joint<G>; 2], radius: f64, in_scene: (&Scene, &Welded)) -> Option<Gear> {
    let (scene, [drum, _]) = (in_scene.0, joints);
    let wound = Wound::of(joints, radius, in_scene)?;
    let (body, at) = wound.moved.wheel;
    let axis = own::<G>(scene, body, wound.axis.map(|x| wound.radius.signum() * x));
    let end = Wheel { body, at: numbers::<G>(at), radius: 0.0, axis };
    Some(Gear { name: name.into(), kind: GearKind::Rope, a: wound.wheel.circle(drum, radius.abs(), scene), b: end })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_fit_the_distance_and_the_ratio() {
        assert_eq!(radii(-2.0, 3.0), Some([2.0, 1.0]));
        assert_eq!(radii(3.0, 4.0), Some([-6.0, 2.0]));
        assert_eq!(radii(0.5, 1.0), Some([1.0, -2.0]));
        assert_eq!(radii(1.0, 1.0), None);
        assert_eq!(radii(-1.0, 0.0), None);
    }

    #[test]
    fn wheels_that_turn_alike_are_under_a_belt_unless_one_is_seen_to_go_around_the_other() {
        let disc = |radius: f64| Seen { disc: radius, reach: radius, ground: false };
        // the smaller wheel turns four times as fast
        assert_eq!(belted(0.25, 0.5, [disc(0.05), disc(0.16)]), Some([0.04, 0.16]));
        // no outline, or one that reaches as far as the other axis, tells nothing
        let bar = Seen { reach: 0.6, ..Seen::default() };
        for wheels in [[Seen::default(); 2], [bar; 2]] {
            let [ra, rb] = belted(0.5, 0.5, wheels).expect("a belt");
            assert!((ra - 0.05).abs() < 1e-12 && (rb - 0.1).abs() < 1e-12, "{ra} {rb}");
            assert!(!has_inner_teeth(0.5, 0.5, wheels));
        }
        assert_eq!(belted(0.5, 0.0, [Seen::default(); 2]), None);
        // a ring of 1 m around a wheel of 0.5 m
        let ground = Seen { ground: true, ..Seen::default() };
        for wheels in [[disc(0.2), disc(1.1)], [disc(0.5), Seen::default()], [Seen::default(), ground]] {
            assert!(has_inner_teeth(2.0, 0.5, [wheels[1], wheels[0]]) && has_inner_teeth(0.5, 0.5, wheels), "{wheels:?}");
        }
        // wheels that turn at the same rate have none
        assert!(!has_inner_teeth(1.0, 0.5, [ground; 2]));
    }
}
