//! Ropes and belts on their drums, in the plane and in space.

use super::view::{across, cross, dot};
use crate::results::Scene;
use crate::results::scene::{Gear, GearKind, Place, Wheel};
use std::f64::consts::TAU;

type V = [f64; 3];

/// Points of the arc of a belt on a drum, less one.
const ARC: usize = 96;
/// Half length of the pitch line of a rack, in radii of its pinion.
const RACK: f64 = 2.0;

/// A circle on which something is wound.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drum {
    pub(super) center: V,
    /// Unit axis.
    pub(super) axis: V,
    pub(super) radius: f64,
}

impl Drum {
    /// The circle of a wheel, with the bodies as in `poses`.
    pub(super) fn of(scene: &Scene, poses: &[f64], wheel: &Wheel) -> Self {
        let planar = wheel.axis.len() != 3;
        Self {
            center: scene.world(poses, &Place { body: wheel.body, at: wheel.at.clone() }),
            axis: if planar { [0.0, 0.0, 1.0] } else { scene.direction(poses, wheel.body, &wheel.axis) },
            radius: wheel.radius,
        }
    }

    /// Directions of its plane; those of the plane of a picture as they are.
    fn plane(&self) -> [V; 2] {
        if self.axis == [0.0, 0.0, 1.0] { [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] } else { across(self.axis) }
    }

    /// A place from its centre: in its plane, and along its axis.
    fn own(&self, at: V) -> ([f64; 2], f64) {
        let from = std::array::from_fn(|i| at[i] - self.center[i]);
        (self.plane().map(|e| dot(e, from)), dot(self.axis, from))
    }

    /// The place with these coordinates.
    fn world(&self, [x, y]: [f64; 2], height: f64) -> V {
        let [u, v] = self.plane();
        std::array::from_fn(|i| self.center[i] + x * u[i] + y * v[i] + height * self.axis[i])
    }
}

/// The pitch line of a rack, and the place of it below the pinion, wherever the rack has gone.
pub(super) fn pitch_line(scene: &Scene, poses: &[f64], Gear { a, b, .. }: &Gear) -> ([V; 2], V) {
    let [pinion, from] = [a, b].map(|wheel| scene.world(poses, &Place { body: wheel.body, at: wheel.at.clone() }));
    let along = scene.direction(poses, b.body, &b.axis);
    let s = dot(along, std::array::from_fn(|i| pinion[i] - from[i]));
    let at = |s: f64| std::array::from_fn(|i| from[i] + s * along[i]);
    let half = RACK * a.radius.abs();
    ([at(s - half), at(s + half)], at(s))
}

/// The straight parts of what joins two wheels, or a wheel and what slides.
pub(super) fn stretches(scene: &Scene, poses: &[f64], gear: &Gear) -> Vec<[V; 2]> {
    let [a, b] = [&gear.a, &gear.b].map(|wheel| Drum::of(scene, poses, wheel));
    match gear.kind {
        GearKind::Teeth => Vec::new(),
        GearKind::Rack => vec![pitch_line(scene, poses, gear).0],
        GearKind::Rope => vec![[leaving(&a, b.center, scene.direction(poses, gear.b.body, &gear.b.axis)), b.center]],
        GearKind::Belt => {
            let points = belt(&a, &b);
            vec![[points[ARC], points[ARC + 1]], [points[points.len() - 1], points[0]]]
        }
    }
}

/// Where a rope to `end` leaves a drum, if that goes along `goes` when the drum turns counter-clockwise: of the two places where the rope
/// would touch it that on this side, or if the end is within the drum the place of the drum there.
///
/// The radius to it and the line from the centre to the end, at a distance d in the plane of the drum, have an angle of acos(r/d)
/// between them.
pub(super) fn leaving(drum: &Drum, end: V, goes: V) -> V {
    let side = drum.plane().map(|e| dot(e, cross(goes, drum.axis)));
    let ([x, y], _) = drum.own(end);
    let distance = x.hypot(y);
    if distance <= drum.radius {
        return drum.world(side.map(|s| drum.radius * s), 0.0);
    }
    let (toward, lean) = (y.atan2(x), (drum.radius / distance).acos());
    let radii = [toward - lean, toward + lean].map(|angle| [angle.cos(), angle.sin()]);
    let facing = radii.map(|[x, y]| x * side[0] + y * side[1]);
    let radius = if facing[0] >= facing[1] { radii[0] } else { radii[1] };
    drum.world(radius.map(|x| drum.radius * x), 0.0)
}

/// A belt around two drums that do not touch: the arcs on them, between which are their outer tangents. From the first drum to the second
/// one it goes along the axis as far as these stand apart.
pub(super) fn belt(a: &Drum, b: &Drum) -> Vec<V> {
    let ([x, y], height) = a.own(b.center);
    let toward = y.atan2(x);
    // the direction of a radius to a tangent, from the line of centres
    let lean = ((a.radius - b.radius) / x.hypot(y)).clamp(-1.0, 1.0).acos();
    let arc = |[x, y]: [f64; 2], height: f64, radius: f64, from: f64, to: f64| {
        (0..=ARC).map(move |k| {
            let (s, c) = (toward + from + (to - from) * k as f64 / ARC as f64).sin_cos();
            a.world([x + radius * c, y + radius * s], height)
        })
    };
    arc([0.0; 2], 0.0, a.radius, lean, TAU - lean).chain(arc([x, y], height, b.radius, -lean, lean)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(v: V) -> f64 {
        dot(v, v).sqrt()
    }

    fn minus(a: V, b: V) -> V {
        std::array::from_fn(|i| a[i] - b[i])
    }

    #[test]
    fn a_rope_leaves_its_drum_along_a_tangent() {
        let flat = |center: [f64; 2], radius| Drum { center: [center[0], center[1], 0.0], axis: [0.0, 0.0, 1.0], radius };
        // below the right side of the drum it hangs straight down; what goes upwards leaves on the right
        let at = leaving(&flat([1.0, 2.0], 0.5), [1.5, -3.0, 0.0], [0.0, 1.0, 0.0]);
        assert!(length(minus(at, [1.5, 2.0, 0.0])) < 1e-12, "{at:?}");
        // elsewhere the radius stays at right angles to it, on the side that is asked for
        for goes in [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]] {
            let [x, y, _] = leaving(&flat([0.0; 2], 0.5), [0.1, -2.0, 0.0], goes);
            assert!((x * (0.1 - x) + y * (-2.0 - y)).abs() < 1e-12 && x * goes[1] > 0.0, "{x} {y}");
        }
        assert_eq!(leaving(&flat([0.0; 2], 1.0), [0.2, 0.0, 0.0], [-1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        // in space, to an end beside the plane of the drum
        let drum = Drum { center: [1.0, 1.0, 1.0], axis: [0.0, 0.6, 0.8], radius: 0.5 };
        let (end, goes) = ([3.0, 0.0, -2.0], [1.0, 0.0, 0.0]);
        let at = leaving(&drum, end, goes);
        let (radius, rope) = (minus(at, drum.center), minus(end, at));
        assert!((length(radius) - 0.5).abs() < 1e-12 && dot(radius, drum.axis).abs() < 1e-12 && dot(radius, rope).abs() < 1e-12, "{at:?}");
        assert!(dot(radius, cross(goes, drum.axis)) > 0.0);
    }

    #[test]
    fn a_belt_lies_on_both_drums_in_space() {
        let axis = [0.6, 0.0, 0.8];
        let (a, b) = (Drum { center: [0.0; 3], axis, radius: 0.3 }, Drum { center: [0.0, 2.0, 0.1], axis, radius: 0.1 });
        let points = belt(&a, &b);
        for (k, p) in points.iter().enumerate() {
            let drum = if k <= ARC { a } else { b };
            let from = minus(*p, drum.center);
            assert!((length(from) - drum.radius).abs() < 1e-12 && dot(from, axis).abs() < 1e-12, "{k}: {p:?}");
        }
        // seen along the axes what lies between the arcs is at right angles to the radii
        let (free, radius) = (minus(points[ARC + 1], points[ARC]), minus(points[ARC], a.center));
        assert!(dot(free, radius).abs() < 1e-12, "{free:?}");
    }
}
