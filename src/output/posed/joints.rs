//! Joints in the picture: their places, ways, stops, and the sense in which they move.

use super::Posed;
use crate::output::measure::encloses;
use crate::output::pose::{Placement, Symbol, SymbolKind};
use crate::output::{view, winding};
use crate::results::Scene;
use crate::results::scene::{GearKind, Joint, Place, Shape};

impl Posed<'_> {
    pub(super) fn joints(&self) -> impl Iterator<Item = Symbol> {
        self.scene.joints.iter().filter_map(|joint| {
            let kind = symbol(&joint.kind)?;
            Some(Symbol {
                name: joint.name.clone(),
                kind,
                bodies: [joint.a.body, joint.b.body],
                grounded: joint.a.body == 0 || joint.b.body == 0,
                way_grounded: joint.a.body == 0,
                way_body: joint.a.body,
                driven: joint.driven,
                turns: joint.kind == "screw",
                damped: joint.damped,
                telescopes: joint.telescopes,
                above: self.stands_above(joint),
                framed: kind == SymbolKind::Slot && !self.scene.bodies[joint.a.body].shapes.iter().any(is_area),
                boxed: !self.scene.bodies[joint.b.body].shapes.iter().any(is_area),
                rings: joint.kind == "cylindrical",
                hidden: kind == SymbolKind::Slide && [&joint.a, &joint.b].iter().all(|place| self.is_hidden(place.body, &joint.b)),
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
        let across = match kind {
            SymbolKind::Cross => [axis, self.scene.direction(poses, joint.b.body, &joint.second)],
            // the middle of the arrow of what drives
            _ => self.view.facing(about, 0.75),
        };
        let upper = kind == SymbolKind::Slide && planar && self.guided_above(joint, axis);
        let reach = if kind == SymbolKind::Slide { self.extent_along(poses, joint, axis) } else { [0.0; 2] };
        let beyond = std::array::from_fn(|end| if joint.stops[end].is_some() { reach[end] } else { 0.0 });
        let turned = joint.stops.map(|stop| self.stop_of_hinge(poses, joint, stop.filter(|_| !slides)?));
        let stops = joint.stops.map(|stop| Some(on_way(stop.filter(|_| slides)?)));
        let stops = if slides { stops } else { turned.map(|ends| Some(ends?[0])) };
        Placement {
            at: self.flat(poses, if slides || kind == SymbolKind::Plane { &joint.b } else { &joint.a }),
            along: if planar && !slides { [0.0; 2] } else { self.view.flat(axis) },
            way: joint.stroke.filter(|_| slides).map(|[low, high]| [on_way(low - beyond[0]), on_way(high + beyond[1])]),
            carrier: self.carrier(joint).filter(|_| slides).map(|(ends, round)| (ends.map(on_way), round)),
            across: across.map(|e| self.view.flat(e)),
            clear: if slides && planar { self.clear(poses, joint, axis, upper) } else { 0.0 },
            upper,
            sense: joint.sense,
            swing: joint.stops[0].zip(joint.stops[1]).map(|(a, b)| b - a).filter(|_| !slides && stops.iter().all(Option::is_some)),
            stops,
            quarter: turned.map(|ends| ends.map_or([0.0; 2], |[_, quarter]| quarter)),
            beyond,
            back: if joint.damped { reach[0] } else { 0.0 },
        }
    }

    /// How far blocks, outlines and discs of the body that slides reach from its point along the way, m: back and ahead.
    /// A rod goes through what guides it.
    fn extent_along(&self, poses: &[f64], joint: &Joint, axis: [f64; 3]) -> [f64; 2] {
        let body = joint.b.body;
        let from = self.scene.world(poses, &joint.b);
        let along = |v: [f64; 3]| (0..3).map(|i| axis[i] * v[i]).sum::<f64>();
        let at = |p: &[f64]| {
            let p = self.scene.world(poses, &Place { body, at: p.to_vec() });
            along(std::array::from_fn(|i| p[i] - from[i]))
        };
        let of = |shape: &Shape| match shape {
            Shape::Polygon { points } => points.iter().map(|p| at(p)).map(|s| [s, s]).collect(),
            Shape::Disc { center, radius, axis: about, .. } => {
                let tilt = about.as_ref().map_or(0.0, |about| along(self.scene.direction(poses, body, about)));
                let reach = radius * (1.0 - tilt * tilt).max(0.0).sqrt();
                vec![[at(center) - reach, at(center) + reach]]
            }
            Shape::Gear { center, radius, .. } | Shape::Sphere { center, radius } => vec![[at(center) - radius, at(center) + radius]],
            Shape::Box { center, size } => {
                let edge = |i: usize| self.scene.direction(poses, body, &std::array::from_fn::<_, 3, _>(|k| f64::from(u8::from(i == k))));
                let half = 0.5 * (0..size.len()).map(|i| (along(edge(i)) * size[i]).abs()).sum::<f64>();
                vec![[at(center) - half, at(center) + half]]
            }
            _ => Vec::new(),
        };
        let all = self.scene.bodies[body].shapes.iter().flat_map(of);
        let [back, ahead] = all.fold([0.0; 2], |[back, ahead], [low, high]| [f64::max(back, -low), f64::max(ahead, high)]);
        [back, ahead].map(|reach| if reach.is_finite() { reach } else { 0.0 })
    }

    /// Where along a slide the shape of the moving body that carries it ends, measured from its point along the axis, m, and whether it ends
    /// round: that of the first shape given by the model that lies along the slide and reaches some of its way.
    fn carrier(&self, joint: &Joint) -> Option<([f64; 2], bool)> {
        let [low, high] = joint.stroke.filter(|_| joint.a.body != 0)?;
        let n = self.scene.dimensions;
        let from = |p: &[f64]| (0..n).map(|i| p[i] - joint.a.at[i]).collect::<Vec<f64>>();
        let along = |p: &[f64]| from(p).iter().zip(&joint.axis).map(|(d, e)| d * e).sum::<f64>();
        let beside = |p: &[f64]| {
            let s = along(p);
            from(p).iter().zip(&joint.axis).map(|(d, e)| (d - s * e).powi(2)).sum::<f64>().sqrt()
        };
        let bar = |from: &[f64], to: &[f64], radius: f64, round: bool| {
            let ends = [along(from).min(along(to)), along(from).max(along(to))];
            (beside(from).max(beside(to)) <= radius.max(1e-6 * (ends[1] - ends[0]))).then_some((ends, round))
        };
        let of = |shape: &Shape| match shape {
            Shape::Bar { from, to, width } => bar(from, to, 0.5 * width.unwrap_or(0.0), true),
            Shape::Cylinder { from, to, radius } => bar(from, to, *radius, false),
            Shape::Box { center, size } => {
                let half = 0.5 * (0..n).map(|i| (joint.axis[i] * size[i]).abs()).sum::<f64>();
                let thick = 0.5 * size.iter().map(|x| x * x).sum::<f64>().sqrt();
                (beside(center) < thick).then(|| ([along(center) - half, along(center) + half], false))
            }
            Shape::Polygon { points } => {
                let side = |p: &Vec<f64>| joint.axis[0] * from(p)[1] - joint.axis[1] * from(p)[0];
                let span = |of: &dyn Fn(&Vec<f64>) -> f64| {
                    points.iter().map(of).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
                };
                let across = span(&side);
                (across[0] <= 0.0 && across[1] >= 0.0).then(|| (span(&|p| along(p)), false))
            }
            _ => None,
        };
        let shapes = self.scene.bodies[joint.a.body].shapes.iter().filter_map(of);
        shapes.into_iter().find(|(ends, _)| ends[0] < high && ends[1] > low)
    }

    /// Whether the guide of a slide is on the upper side of its way, as the teeth of the rack that slides are on the lower one.
    fn guided_above(&self, joint: &Joint, axis: [f64; 3]) -> bool {
        let Some(poses) = self.frames.first() else { return false };
        self.scene.gears.iter().any(|gear| {
            if gear.kind != GearKind::Rack || gear.b.body != joint.b.body {
                return false;
            }
            let (_, mesh) = winding::pitch_line(self.scene, poses, gear);
            let pinion = self.scene.world(poses, &Place { body: gear.a.body, at: gear.a.at.clone() });
            let [x, y] = lower(axis);
            x * (pinion[0] - mesh[0]) + y * (pinion[1] - mesh[1]) > 0.0
        })
    }

    /// How far the outlines of the body that slides reach from the way to the side of its guide, m.
    fn clear(&self, poses: &[f64], joint: &Joint, axis: [f64; 3], upper: bool) -> f64 {
        let lower = if upper { lower(axis).map(|x| -x) } else { lower(axis) };
        let from = self.flat(poses, &joint.b);
        let reach = |at: &[f64]| {
            let [x, y] = self.flat(poses, &Place { body: joint.b.body, at: at.to_vec() });
            lower[0] * (x - from[0]) + lower[1] * (y - from[1])
        };
        let of = |shape: &Shape| match shape {
            Shape::Polygon { points } => points.iter().map(|p| reach(p)).fold(0.0, f64::max),
            Shape::Disc { center, radius, .. } | Shape::Gear { center, radius, .. } | Shape::Sphere { center, radius } => {
                reach(center) + radius
            }
            _ => 0.0,
        };
        self.scene.bodies[joint.b.body].shapes.iter().map(of).filter(|x| x.is_finite()).fold(0.0, f64::max)
    }

    /// Whether an area of a body in the plane lies around a place in the first position.
    fn is_hidden(&self, body: usize, place: &Place) -> bool {
        let Some(poses) = self.frames.first().filter(|_| self.scene.dimensions == 2 && body != 0) else { return false };
        let at = self.flat(poses, place);
        let flat = |p: &[f64]| self.flat(poses, &Place { body, at: p.to_vec() });
        let around = |shape: &Shape| match shape {
            Shape::Polygon { points } => encloses(&points.iter().map(|p| flat(p)).collect::<Vec<_>>(), at),
            Shape::Disc { center, radius, .. } | Shape::Gear { center, radius, .. } => {
                let [x, y] = flat(center);
                (x - at[0]).hypot(y - at[1]) < *radius
            }
            Shape::Box { center, size } => {
                let corner = |[s, t]: [f64; 2]| flat(&[center[0] + 0.5 * s * size[0], center[1] + 0.5 * t * size[1]]);
                encloses(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner), at)
            }
            _ => false,
        };
        self.scene.bodies[body].shapes.iter().any(around)
    }

    /// Whether the bearing of a hinge stands above it: in the plane under a wheel whose rack is below.
    fn stands_above(&self, joint: &Joint) -> bool {
        let wheel = if joint.a.body == 0 { joint.b.body } else { joint.a.body };
        let Some(poses) = self.frames.first().filter(|_| self.scene.dimensions == 2 && wheel != 0) else { return false };
        self.scene.gears.iter().any(|gear| {
            let (_, [x, y, _]) = match gear.kind {
                GearKind::Rack if gear.a.body == wheel => winding::pitch_line(self.scene, poses, gear),
                _ => return false,
            };
            let [u, v, _] = self.scene.world(poses, &Place { body: wheel, at: gear.a.at.clone() });
            v - y > (x - u).abs()
        })
    }

    /// The direction that the second body has on a stop, as it is seen, and that a quarter turn on: in the plane from the hinge to its
    /// farthest place, or if that is one of several its x axis.
    fn stop_of_hinge(&self, poses: &[f64], joint: &Joint, stop: f64) -> Option<[[f64; 2]; 2]> {
        if self.scene.dimensions == 3 {
            let [axis, far] =
                [&joint.axis[..], &far_at_stop(self.scene, joint, stop)?].map(|e| self.scene.direction(poses, joint.a.body, e));
            return Some([far, cross(axis, far)].map(|e| self.view.flat(e)));
        }
        let at = &joint.b.at;
        let from = |p: &&Vec<f64>| (p[0] - at[0]).hypot(p[1] - at[1]);
        let places = places_of(self.scene, joint.b.body);
        let far = places.iter().copied().max_by(|p, q| from(p).total_cmp(&from(q)))?;
        let (reach, apart) = (from(&far), |p: &&&Vec<f64>| (p[0] - far[0]).hypot(p[1] - far[1]));
        let alone = !places.iter().any(|p| from(p) > 0.99 * reach && apart(&p) > 0.1 * reach);
        let own = if alone && reach > 0.0 { (far[1] - at[1]).atan2(far[0] - at[0]) } else { 0.0 };
        let (s, c) = (self.angle(poses, joint.a.body) + stop + own).sin_cos();
        Some([[c, s], [-s, c]])
    }
}

/// The unit direction in the first body, across the axis of a hinge in space, in which the second one reaches farthest on a stop.
pub(in crate::output) fn far_at_stop(scene: &Scene, joint: &Joint, stop: f64) -> Option<[f64; 3]> {
    let three = |v: &[f64]| -> Option<[f64; 3]> { v.try_into().ok() };
    let (axis, rows) = (three(&joint.axis)?, <[f64; 9]>::try_from(&joint.drawn[..]).ok()?);
    let from = |p: &Vec<f64>| {
        let p: [f64; 3] = std::array::from_fn(|i| p[i] - joint.b.at[i]);
        let p: [f64; 3] = std::array::from_fn(|i| (0..3).map(|k| rows[3 * i + k] * p[k]).sum());
        let along: f64 = p.iter().zip(&axis).map(|(x, e)| x * e).sum();
        p.iter().zip(&axis).map(|(x, e)| x - along * e).collect::<Vec<f64>>()
    };
    let length = |p: &[f64]| p.iter().map(|x| x * x).sum::<f64>().sqrt();
    let far = places_of(scene, joint.b.body).into_iter().map(from).max_by(|p, q| length(p).total_cmp(&length(q)))?;
    let reach = length(&far);
    // a wheel without a place beside its axis has any
    let far = if reach > 0.0 { three(&far)?.map(|x| x / reach) } else { view::across(axis)[0] };
    let (s, c) = stop.sin_cos();
    let quarter = cross(axis, far);
    Some(std::array::from_fn(|i| c * far[i] + s * quarter[i]))
}

fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// The places of a body: those of its joints, and of its shapes.
fn places_of(scene: &Scene, body: usize) -> Vec<&Vec<f64>> {
    let joints = scene.joints.iter().flat_map(|j| [&j.a, &j.b]).filter(|p| p.body == body).map(|p| &p.at);
    joints.chain(scene.bodies[body].shapes.iter().flat_map(points)).collect()
}

/// The direction to the lower side of a way, or to the right of an upright one.
fn lower(axis: [f64; 3]) -> [f64; 2] {
    let upright = axis[0].abs() <= 1e-6;
    let sign = if if upright { axis[1] < 0.0 } else { axis[0] < 0.0 } { -1.0 } else { 1.0 };
    [sign * axis[1], -sign * axis[0]]
}

/// Whether a shape has room for a slot.
fn is_area(shape: &Shape) -> bool {
    match shape {
        Shape::Hull { points } => points.len() > 2,
        Shape::Polygon { .. } | Shape::Disc { .. } | Shape::Gear { .. } | Shape::Box { .. } => true,
        Shape::Bar { .. } | Shape::Cylinder { .. } | Shape::Sphere { .. } | Shape::Mass { .. } => false,
    }
}

/// Points of a shape.
fn points(shape: &Shape) -> Vec<&Vec<f64>> {
    match shape {
        Shape::Bar { from, to, .. } | Shape::Cylinder { from, to, .. } => vec![from, to],
        Shape::Hull { points } | Shape::Polygon { points } => points.iter().collect(),
        Shape::Disc { center: at, .. }
        | Shape::Gear { center: at, .. }
        | Shape::Box { center: at, .. }
        | Shape::Sphere { center: at, .. }
        | Shape::Mass { at, .. } => vec![at],
    }
}

/// What a kind of joint looks like; none if it is not seen.
fn symbol(kind: &str) -> Option<SymbolKind> {
    match kind {
        "slider" | "cylindrical" | "screw" => Some(SymbolKind::Slide),
        "planar" => Some(SymbolKind::Plane),
        "pin-in-slot" => Some(SymbolKind::Slot),
        "spherical" => Some(SymbolKind::Ball),
        "universal" => Some(SymbolKind::Cross),
        "fixed" => Some(SymbolKind::Weld),
        "free" | "distance" | "point" => None,
        _ => Some(SymbolKind::Hinge),
    }
}
