//! The drawing of a scene: its shown frames in the plane of the picture.

use super::view::View;
use super::{Drawing, Link, LinkKind, Outline, Placement, Symbol, SymbolKind, Trace};
use crate::results::Scene;
use crate::results::scene::{self, Place, Shape};

/// Places along a path.
const ALONG: usize = 240;

/// The drawing of a scene of a study; that of the mechanism itself is titled by the model alone.
#[must_use]
pub fn drawing(model: &str, study: &str, name: &str, scene: &Scene) -> Drawing {
    let view = if scene.dimensions == 2 { View::PLANE } else { View::isometric(scene.up) };
    let frames: Vec<&[f64]> = scene.frames.shown.iter().map(|index| scene.frame(*index)).collect();
    let posed = Posed { scene, view, frames };
    Drawing {
        title: if name == "mechanism" { model.to_string() } else { format!("{model}, {study}: {}", name.replace('-', " ")) },
        bodies: posed.bodies().chain(posed.rods()).collect(),
        joints: posed.joints().chain(posed.pins()).collect(),
        links: posed.links().collect(),
        traces: scene.traces.iter().map(|trace| posed.trace(trace)).collect(),
    }
}

/// A scene in a few poses, seen from somewhere.
struct Posed<'a> {
    scene: &'a Scene,
    view: View,
    frames: Vec<&'a [f64]>,
}

impl Posed<'_> {
    fn flat(&self, poses: &[f64], place: &Place) -> [f64; 2] {
        self.view.flat(self.scene.world(poses, place))
    }

    fn bodies(&self) -> impl Iterator<Item = Outline> {
        self.scene.bodies.iter().enumerate().skip(1).map(|(index, body)| {
            let points: Vec<Vec<f64>> = body.shapes.iter().flat_map(points).collect();
            let place = |at: &Vec<f64>| Place { body: index, at: at.clone() };
            let poses = self.frames.iter().map(|poses| points.iter().map(|at| self.flat(poses, &place(at))).collect());
            Outline { name: body.name.clone(), poses: poses.collect() }
        })
    }

    /// Massless links: each looks like a body between two pins.
    fn rods(&self) -> impl Iterator<Item = Outline> {
        let rods = self.scene.links.iter().filter(|link| link.kind == scene::LinkKind::Rod);
        rods.map(|link| {
            let ends = |poses: &&[f64]| vec![self.flat(poses, &link.a), self.flat(poses, &link.b)];
            Outline { name: link.name.clone(), poses: self.frames.iter().map(ends).collect() }
        })
    }

    fn pins(&self) -> impl Iterator<Item = Symbol> {
        let rods = self.scene.links.iter().filter(|link| link.kind == scene::LinkKind::Rod);
        rods.flat_map(|link| [&link.a, &link.b]).map(|end| {
            let pin = |poses: &&[f64]| Placement { at: self.flat(poses, end), along: [1.0, 0.0], way: None };
            Symbol { grounded: end.body == 0, poses: self.frames.iter().map(pin).collect(), ..Symbol::default() }
        })
    }

    fn joints(&self) -> impl Iterator<Item = Symbol> {
        self.scene.joints.iter().filter_map(|joint| {
            let kind = symbol(&joint.kind)?;
            let sliding = matches!(kind, SymbolKind::Slide | SymbolKind::Slot);
            let placement = |poses: &&[f64]| Placement {
                at: self.flat(poses, if sliding { &joint.b } else { &joint.a }),
                along: self.view.flat(self.scene.direction(poses, joint.a.body, &joint.axis)),
                way: None,
            };
            let grounded = joint.a.body == 0 || joint.b.body == 0;
            Some(Symbol { name: joint.name.clone(), kind, grounded, poses: self.frames.iter().map(placement).collect() })
        })
    }

    fn links(&self) -> impl Iterator<Item = Link> {
        let links = self.scene.links.iter().filter(|link| !matches!(link.kind, scene::LinkKind::Rod | scene::LinkKind::Torsion));
        links.map(|link| {
            let kind = if link.kind == scene::LinkKind::Damper { LinkKind::Damper } else { LinkKind::Spring };
            let ends = |poses: &&[f64]| [self.flat(poses, &link.a), self.flat(poses, &link.b)];
            Link { name: String::new(), kind, poses: self.frames.iter().map(ends).collect() }
        })
    }

    /// A path through the frames, with places between them where they are few.
    fn trace(&self, trace: &scene::Trace) -> Trace {
        let place = Place { body: trace.body, at: trace.at.clone() };
        let frames = &self.scene.frames;
        let between = ALONG.div_ceil(frames.count().max(2) - 1);
        let mut points = Vec::new();
        for (index, pair) in frames.at.windows(2).enumerate() {
            points.push(self.flat(self.scene.frame(index), &place));
            for k in 1..between {
                let x = pair[0] + (pair[1] - pair[0]) * k as f64 / between as f64;
                points.push(self.flat(&frames.at(x, self.scene.dimensions), &place));
            }
        }
        points.extend(frames.count().checked_sub(1).map(|last| self.flat(self.scene.frame(last), &place)));
        Trace { name: trace.name.clone(), points }
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

/// Points that outline a shape.
fn points(shape: &Shape) -> Vec<Vec<f64>> {
    match shape {
        Shape::Bar { from, to, .. } | Shape::Cylinder { from, to, .. } => vec![from.clone(), to.clone()],
        Shape::Hull { points } | Shape::Polygon { points } => points.clone(),
        Shape::Disc { center, .. } | Shape::Box { center, .. } | Shape::Sphere { center, .. } => vec![center.clone()],
        Shape::Mass { .. } => vec![],
    }
}
