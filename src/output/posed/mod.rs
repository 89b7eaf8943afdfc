//! The drawing of a scene: its shown frames in the plane of the picture.

mod forces;
pub(super) mod forms;
mod gears;
pub(super) mod joints;
mod moves;
mod telescope;
pub(super) mod traces;

use super::pose::{Drawing, Link, LinkKind, Outline, Symbol};
use super::view::View;
use crate::results::Scene;
use crate::results::scene::{self, Place};

/// Length of the tubes of an actuator, as part of the shortest distance of its ends.
const TUBE: f64 = 0.85;

/// The drawing of a scene of a study: its name is part of the title, but for that of the mechanism itself.
#[must_use]
pub fn drawing(model: &str, study: &str, name: &str, scene: &Scene) -> Drawing {
    let asked = scene.at.map(|x| scene.frames.at(x, scene.dimensions));
    // one that would lie under it is not drawn
    let width = scene.frames.at.last().zip(scene.frames.at.first()).map_or(0.0, |(last, first)| last - first);
    let other = |index: &&usize| scene.at.zip(scene.frames.at.get(**index)).is_none_or(|(x, at)| (x - at).abs() > 1e-9 * width);
    let shown = scene.frames.shown.iter().filter(other);
    let frames = asked.iter().map(Vec::as_slice).chain(shown.map(|index| scene.frame(*index))).collect();
    let posed = Posed::of(scene, frames);
    let traces = scene.traces.iter().filter_map(|trace| posed.trace(trace)).collect();
    let first = scene.at.or_else(|| scene.frames.at.get(*scene.frames.shown.first()?).copied());
    let forces = first.map(|at| posed.forces(at).collect()).unwrap_or_default();
    let moves = scene.frames.rest.map(|index| posed.moves(scene.frame(index))).unwrap_or_default();
    Drawing { title: title(model, study, name, &scene.caption), traces, forces, moves, ..posed.positions() }
}

/// The drawing of a scene at a place of the independent variable, without title and paths.
pub(super) fn at(scene: &Scene, x: f64) -> Drawing {
    let poses = scene.frames.at(x, scene.dimensions);
    let posed = Posed::of(scene, vec![&poses]);
    Drawing { forces: posed.forces(x).collect(), ..posed.positions() }
}

/// The drawing of a scene at several places: one position for each, and the forces of all of them; without title and paths.
pub(super) fn at_all(scene: &Scene, places: &[f64]) -> Drawing {
    let poses: Vec<Vec<f64>> = places.iter().map(|x| scene.frames.at(*x, scene.dimensions)).collect();
    let one = |poses| Posed::of(scene, vec![poses]);
    let forces = poses.iter().zip(places).flat_map(|(poses, x)| one(poses.as_slice()).forces(*x).collect::<Vec<_>>()).collect();
    let all = Posed::of(scene, poses.iter().map(Vec::as_slice).collect());
    Drawing { forces, ..all.positions() }
}

/// Length of each tube of an actuator, m.
pub(super) fn tube(link: &scene::Link) -> f64 {
    TUBE * link.rest.unwrap_or(0.0)
}

/// Azimuth and elevation of the eye of a scene in space, rad.
pub(super) fn eye(scene: &Scene) -> [f64; 2] {
    scene.view.unwrap_or(View::ISOMETRIC)
}

/// From where a scene is seen.
pub(super) fn view(scene: &Scene) -> View {
    match (scene.dimensions, scene.view) {
        (2, _) => View::PLANE,
        (_, Some([azimuth, elevation])) => View::from(scene.up, azimuth, elevation),
        _ => View::isometric(scene.up),
    }
}

/// What stands above the picture.
pub(super) fn title(model: &str, study: &str, name: &str, caption: &str) -> String {
    let name = if name == "mechanism" { String::new() } else { name.replace('-', " ") };
    let caption = crate::output::units::pretty(caption);
    let after: Vec<&str> = [name.as_str(), caption.as_str()].into_iter().filter(|part| !part.is_empty()).collect();
    let before = [model, study].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
    if after.is_empty() { before } else { format!("{before}: {}", after.join(", ")) }
}

/// A scene in a few poses, seen from somewhere.
struct Posed<'a> {
    scene: &'a Scene,
    view: View,
    frames: Vec<&'a [f64]>,
    /// For each body how many cylinders are around it, and rods within it.
    stages: Vec<[u32; 2]>,
    /// For each body the cylinder in which it slides.
    cylinders: Vec<Option<usize>>,
}

impl<'a> Posed<'a> {
    /// A scene in some positions.
    fn of(scene: &'a Scene, frames: Vec<&'a [f64]>) -> Self {
        Self { scene, view: view(scene), frames, stages: telescope::stages(scene), cylinders: telescope::cylinders(scene) }
    }
}

impl Posed<'_> {
    fn positions(&self) -> Drawing {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| self.view.flat(e));
        Drawing {
            title: String::new(),
            length: self.scene.length.clone(),
            force: self.scene.force.clone(),
            torque: self.scene.torque.clone(),
            bodies: self.bodies().collect(),
            joints: self.joints().chain(self.pins()).collect(),
            links: self.links().collect(),
            gears: self.gears().collect(),
            traces: Vec::new(),
            forces: Vec::new(),
            moves: Vec::new(),
            axes: (self.scene.dimensions == 3).then_some(axes),
        }
    }

    fn flat(&self, poses: &[f64], place: &Place) -> [f64; 2] {
        self.view.flat(self.scene.world(poses, place))
    }

    fn bodies(&self) -> impl Iterator<Item = Outline> {
        self.scene.bodies.iter().enumerate().map(|(index, body)| {
            let shapes = |poses: &&[f64]| body.shapes.iter().flat_map(|shape| self.forms(poses, index, shape)).collect();
            Outline { name: body.name.clone(), poses: self.frames.iter().map(shapes).collect() }
        })
    }

    /// The pins of massless links.
    fn pins(&self) -> impl Iterator<Item = Symbol> {
        let rods = self.scene.links.iter().filter(|link| link.kind == scene::LinkKind::Rod);
        rods.flat_map(|link| [&link.a, &link.b]).map(|end| {
            let pin = |poses: &&[f64]| super::pose::Placement { at: self.flat(poses, end), ..super::pose::Placement::default() };
            Symbol { grounded: end.body == 0, poses: self.frames.iter().map(pin).collect(), ..Symbol::default() }
        })
    }

    fn links(&self) -> impl Iterator<Item = Link> {
        self.scene.links.iter().map(|link| {
            let kind = match link.kind {
                scene::LinkKind::Spring => LinkKind::Spring,
                scene::LinkKind::Damper => LinkKind::Damper,
                scene::LinkKind::SpringDamper => LinkKind::SpringDamper,
                scene::LinkKind::Rod => LinkKind::Rod,
                scene::LinkKind::Actuator => LinkKind::Actuator,
                scene::LinkKind::Torsion => LinkKind::Torsion,
                scene::LinkKind::Shaft => LinkKind::Shaft,
                scene::LinkKind::Clutch => LinkKind::Clutch,
                scene::LinkKind::Brake => LinkKind::Brake,
            };
            let ends = |poses: &&[f64]| self.scene.ends(poses, link).map(|end| self.view.flat(end));
            let cylinder = |poses: &&[f64]| {
                let [a, b] = self.scene.ends(poses, link);
                tube(link) / (0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt()
            };
            let turned = |poses: &&[f64]| [link.a.body, link.b.body].map(|body| self.angle(poses, body));
            Link {
                name: link.name.clone(),
                kind,
                grounded: [&link.a, &link.b].map(|end| end.body == 0),
                poses: self.frames.iter().map(ends).collect(),
                turned: self.frames.iter().map(turned).collect(),
                cylinder: self.frames.iter().map(cylinder).collect(),
                stages: link.stages,
            }
        })
    }

    /// Direction of the x axis of a body in the picture, rad.
    fn angle(&self, poses: &[f64], body: usize) -> f64 {
        let [x, y] = self.view.flat(self.scene.direction(poses, body, &[1.0]));
        y.atan2(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_name_the_study_and_the_run() {
        assert_eq!(title("engine", "turn", "mechanism", ""), "engine, turn");
        assert_eq!(title("engine", "turn", "mechanism", "r = 0.1 m"), "engine, turn: r = 0.1 m");
        assert_eq!(title("engine", "v", "mode-1", "2.3 Hz"), "engine, v: mode 1, 2.3 Hz");
    }
}
