//! Joints in the picture: their places, ways, stops, and the sense in which they move.

use super::Posed;
use crate::output::pose::{Placement, Symbol, SymbolKind};
use crate::output::view::{across, cross, dot};
use crate::results::scene::{Joint, Place, Shape};

impl Posed<'_> {
    pub(super) fn joints(&self) -> impl Iterator<Item = Symbol> {
        self.scene.joints.iter().filter_map(|joint| {
            let kind = symbol(&joint.kind)?;
            Some(Symbol {
                name: joint.name.clone(),
                kind,
                grounded: joint.a.body == 0 || joint.b.body == 0,
                way_grounded: joint.a.body == 0,
                way_body: joint.a.body,
                driven: joint.driven,
                damped: joint.damped,
                poses: self.frames.iter().map(|poses| self.placement(poses, joint, kind)).collect(),
            })
        })
    }

    fn placement(&self, poses: &[f64], joint: &Joint, kind: SymbolKind) -> Placement {
        let slides = matches!(kind, SymbolKind::Slide | SymbolKind::Slot);
        let planar = self.scene.dimensions == 2;
        let axis = self.scene.direction(poses, joint.a.body, &joint.axis);
        let a = self.scene.world(poses, &joint.a);
        let on_way = |s: f64| self.view.flat(std::array::from_fn(|i| a[i] + s * axis[i]));
        let about = if planar { [0.0, 0.0, 1.0] } else { axis };
        Placement {
            at: self.flat(poses, if slides { &joint.b } else { &joint.a }),
            along: if planar && !slides { [0.0; 2] } else { self.view.flat(axis) },
            way: joint.stroke.filter(|_| slides).map(|ends| ends.map(on_way)),
            across: across(about).map(|e| self.view.flat(e)),
            clear: if slides && planar { self.clear(poses, joint, axis) } else { 0.0 },
            sense: if joint.driven { self.sense(joint, slides) } else { 0.0 },
            stops: joint.stops.map(|stop| if slides { Some(on_way(stop?)) } else { self.stop_of_hinge(poses, joint, stop?) }),
        }
    }

    /// How far the outlines of the body that slides reach from the way to its lower side, m.
    fn clear(&self, poses: &[f64], joint: &Joint, axis: [f64; 3]) -> f64 {
        let upright = axis[0].abs() <= 1e-6;
        let sign = if if upright { axis[1] < 0.0 } else { axis[0] < 0.0 } { -1.0 } else { 1.0 };
        let lower = [sign * axis[1], -sign * axis[0]];
        let from = self.flat(poses, &joint.b);
        let reach = |at: &[f64]| {
            let [x, y] = self.flat(poses, &Place { body: joint.b.body, at: at.to_vec() });
            lower[0] * (x - from[0]) + lower[1] * (y - from[1])
        };
        let of = |shape: &Shape| match shape {
            Shape::Polygon { points } => points.iter().map(|p| reach(p)).fold(0.0, f64::max),
            Shape::Disc { center, radius, .. } | Shape::Sphere { center, radius } => reach(center) + radius,
            _ => 0.0,
        };
        self.scene.bodies[joint.b.body].shapes.iter().map(of).filter(|x| x.is_finite()).fold(0.0, f64::max)
    }

    /// The direction in the plane that the second body has on a stop: from the hinge to its middle.
    fn stop_of_hinge(&self, poses: &[f64], joint: &Joint, stop: f64) -> Option<[f64; 2]> {
        let at = &joint.b.at;
        let from = |p: &&Vec<f64>| (p[0] - at[0]).hypot(p[1] - at[1]);
        let joints = self.scene.joints.iter().flat_map(|j| [&j.a, &j.b]).filter(|p| p.body == joint.b.body).map(|p| &p.at);
        let far =
            joints.chain(self.scene.bodies[joint.b.body].shapes.iter().flat_map(points)).max_by(|p, q| from(p).total_cmp(&from(q)))?;
        if self.scene.dimensions == 3 || from(&far) == 0.0 {
            return None;
        }
        let own = (far[1] - at[1]).atan2(far[0] - at[0]);
        let (s, c) = (self.angle(poses, joint.a.body) + stop + own).sin_cos();
        Some([c, s])
    }

    /// Sense of the motion of a joint from the first shown frame on, 0 at rest.
    fn sense(&self, joint: &Joint, slides: bool) -> f64 {
        let frames = &self.scene.frames;
        let asked = self.scene.at.map(|x| frames.at.partition_point(|at| *at <= x).saturating_sub(1));
        let Some(first) = asked.or(frames.shown.first().copied()).map(|first| first.min(frames.count().saturating_sub(2))) else {
            return 0.0;
        };
        // back in its time a motion that begins at its end goes the other way
        let ahead = if frames.shown.len() > 1 && frames.shown[1] < frames.shown[0] { -1.0 } else { 1.0 };
        let [before, behind] = [first, first + 1].map(|index| self.scene.frame(index.min(frames.count() - 1)));
        let change = if slides {
            let along = |poses: &[f64]| {
                let (a, b) = (self.scene.world(poses, &joint.a), self.scene.world(poses, &joint.b));
                dot(std::array::from_fn(|i| b[i] - a[i]), self.scene.direction(poses, joint.a.body, &joint.axis))
            };
            along(behind) - along(before)
        } else {
            let planar = self.scene.dimensions == 2;
            let axis = if planar { [0.0, 0.0, 1.0] } else { std::array::from_fn(|i| joint.axis.get(i).copied().unwrap_or(0.0)) };
            let e = across(axis)[0];
            // a direction of b that lies across the axis before, seen from a before and behind
            let seen = |poses: &[f64], own: [f64; 3]| self.in_axes_of(poses, joint.a.body, self.scene.direction(poses, joint.b.body, &own));
            let own = self.in_axes_of(before, joint.b.body, self.scene.direction(before, joint.a.body, &e));
            dot(axis, cross(seen(before, own), seen(behind, own)))
        };
        if change.abs() > 1e-12 { change.signum() * ahead } else { 0.0 }
    }

    /// A direction of the world in the axes of a body.
    fn in_axes_of(&self, poses: &[f64], body: usize, v: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| {
            let mut e = [0.0; 3];
            e[i] = 1.0;
            dot(self.scene.direction(poses, body, &e), v)
        })
    }
}

/// Points of a shape.
fn points(shape: &Shape) -> Vec<&Vec<f64>> {
    match shape {
        Shape::Bar { from, to, .. } | Shape::Cylinder { from, to, .. } => vec![from, to],
        Shape::Hull { points } | Shape::Polygon { points } => points.iter().collect(),
        Shape::Disc { center: at, .. } | Shape::Box { center: at, .. } | Shape::Sphere { center: at, .. } | Shape::Mass { at, .. } => {
            vec![at]
        }
    }
}

/// What a kind of joint looks like; none if it is not seen.
fn symbol(kind: &str) -> Option<SymbolKind> {
    match kind {
        "slider" | "cylindrical" | "planar" | "screw" => Some(SymbolKind::Slide),
        "pin-in-slot" => Some(SymbolKind::Slot),
        "spherical" | "universal" => Some(SymbolKind::Ball),
        "fixed" => Some(SymbolKind::Weld),
        "free" | "distance" | "point" => None,
        _ => Some(SymbolKind::Hinge),
    }
}
