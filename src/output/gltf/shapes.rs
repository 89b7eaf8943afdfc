//! Bodies and joints as meshes.

use super::mesh::{Mesh, V, plus};
use super::solids::{Outline, around};
use crate::output::outlines::hull;
use crate::output::posed::forms::faces_of;
use crate::results::Scene;
use crate::results::scene::{Place, Shape, rim, wheel};

/// Width of a bar, thickness of a body of the plane, and radius of a pin, as parts of the size of the mechanism.
const WIDTH: f64 = 0.035;
const THICKNESS: f64 = 0.012;
const PIN: f64 = 0.011;
/// Layers of a mechanism of the plane.
const LAYERS: usize = 4;

/// Makes meshes in the sizes of a mechanism.
#[derive(Clone, Copy, Debug)]
pub(super) struct Builder<'a> {
    scene: &'a Scene,
    /// Size of the mechanism, m.
    size: f64,
}

impl<'a> Builder<'a> {
    /// For a mechanism with its size in given poses.
    pub(super) fn new(scene: &'a Scene, poses: &[f64]) -> Self {
        let shapes = scene.bodies.iter().enumerate().flat_map(|(body, b)| b.shapes.iter().map(move |shape| (body, shape)));
        let of_shapes = shapes.flat_map(|(body, shape)| points(shape).into_iter().map(move |at| Place { body, at: at.clone() }));
        let of_joints = scene.joints.iter().flat_map(|joint| [joint.a.clone(), joint.b.clone()]);
        let mut ends = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for place in of_shapes.chain(of_joints) {
            let p = scene.world(poses, &place);
            for i in 0..3 {
                ends[0][i] = ends[0][i].min(p[i]);
                ends[1][i] = ends[1][i].max(p[i]);
            }
        }
        let size = (0..3).map(|i| ends[1][i] - ends[0][i]).fold(0.0, f64::max);
        Self { scene, size: if size.is_finite() && size > 1e-9 { size } else { 1.0 } }
    }

    /// Radius of a thin rod, m.
    pub(super) fn thin(&self) -> f64 {
        0.3 * WIDTH * self.size
    }

    /// The shapes of a body.
    pub(super) fn body(&self, index: usize) -> Mesh {
        let mut mesh = Mesh::default();
        for shape in &self.scene.bodies[index].shapes {
            if self.scene.dimensions == 2 { self.flat(&mut mesh, shape, self.layer(index)) } else { self.solid(&mut mesh, shape) }
        }
        mesh
    }

    /// The joints that a body carries.
    pub(super) fn pins(&self, index: usize) -> Mesh {
        let mut mesh = Mesh::default();
        let shown = |kind: &str| !["free", "distance", "point"].contains(&kind);
        for joint in self.scene.joints.iter().filter(|joint| joint.a.body == index && shown(&joint.kind)) {
            let at = v(&joint.a.at);
            let radius = PIN * self.size;
            match &*joint.kind {
                _ if self.scene.dimensions == 2 => {
                    let [low, high] = [self.layer(joint.a.body), self.layer(joint.b.body)];
                    let (low, high) = (low[0].min(high[0]), low[1].max(high[1]));
                    let more = 0.4 * THICKNESS * self.size;
                    mesh.tube([at[0], at[1], low - more], [at[0], at[1], high + more], radius);
                }
                "revolute" | "slider" | "cylindrical" | "screw" => {
                    let (axis, half) = (v(&joint.axis), 1.2 * WIDTH * self.size);
                    mesh.tube(plus(at, -half, axis), plus(at, half, axis), 1.8 * radius);
                }
                _ => mesh.ball(at, 2.2 * radius),
            }
        }
        mesh
    }

    /// Heights between which a body of the plane lies; the ground is at the back.
    fn layer(&self, index: usize) -> [f64; 2] {
        let thickness = THICKNESS * self.size;
        let layer = index.checked_sub(1).map_or(-1.0, |k| (k % LAYERS) as f64);
        [1.15 * thickness * layer, 1.15 * thickness * layer + thickness]
    }

    fn flat(&self, mesh: &mut Mesh, shape: &Shape, heights: [f64; 2]) {
        let flat = |p: &Vec<f64>| [p[0], p[1]];
        let half = 0.5 * WIDTH * self.size;
        let outline: Outline = match shape {
            Shape::Bar { from, to, width } => {
                let half = width.map_or(half, |width| 0.5 * width);
                around(&hull(&[flat(from), flat(to)]), half)
            }
            Shape::Hull { points } => around(&hull(&points.iter().map(flat).collect::<Vec<_>>()), half),
            Shape::Polygon { points } => points.iter().map(flat).collect(),
            Shape::Disc { center, radius, .. } | Shape::Sphere { center, radius } => around(&[flat(center)], *radius),
            Shape::Gear { center, radius, teeth, first } => {
                let outline = wheel(flat(center), *radius, *teeth, *first);
                if *radius > 0.0 {
                    return mesh.prism(&outline, heights);
                }
                // a ring from its teeth to its rim
                let rim: Outline = outline.iter().map(|p| out(flat(center), *p, rim(*radius, *teeth))).collect();
                for (k, next) in (1..outline.len()).chain([0]).enumerate() {
                    mesh.prism(&[outline[k], rim[k], rim[next], outline[next]], heights);
                }
                return;
            }
            Shape::Mass { at, radius, .. } => {
                let more = THICKNESS * self.size;
                return mesh.prism(&around(&[flat(at)], *radius), [heights[0] - more, heights[1] + more]);
            }
            Shape::Box { center, size } => {
                let corner = |s: f64, t: f64| [center[0] + 0.5 * s * size[0], center[1] + 0.5 * t * size[1]];
                vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]
            }
            Shape::Cylinder { from, to, radius } => around(&hull(&[flat(from), flat(to)]), *radius),
        };
        mesh.prism(&outline, heights);
    }

    fn solid(&self, mesh: &mut Mesh, shape: &Shape) {
        let radius = 0.5 * WIDTH * self.size;
        match shape {
            Shape::Bar { from, to, width } => mesh.tube(v(from), v(to), width.map_or(radius, |width| 0.5 * width)),
            Shape::Hull { points } => {
                let places: Vec<V> = points.iter().map(|p| v(p)).collect();
                if let [from, to] = places[..] {
                    return mesh.tube(from, to, radius);
                }
                // what is solid has its faces, as in drawings
                let faces = faces_of(points);
                if faces.len() > 2 {
                    return faces.iter().for_each(|face| mesh.face(&face.iter().map(|k| places[*k]).collect::<Vec<V>>()));
                }
                let middle = std::array::from_fn(|i| places.iter().map(|p| p[i]).sum::<f64>() / places.len() as f64);
                places.iter().for_each(|p| mesh.tube(middle, *p, radius));
                mesh.ball(middle, radius);
            }
            Shape::Polygon { points } => {
                let ends = points.iter().zip(points.iter().cycle().skip(1));
                ends.for_each(|(a, b)| mesh.tube(v(a), v(b), 0.5 * radius));
            }
            Shape::Disc { center, radius, axis, thickness } => {
                let axis = axis.as_deref().map_or([0.0, 0.0, 1.0], v);
                let half = 0.5 * thickness.unwrap_or(0.0).max(THICKNESS * self.size);
                mesh.tube(plus(v(center), -half, axis), plus(v(center), half, axis), *radius);
            }
            // in the plane alone
            Shape::Gear { .. } => {}
            Shape::Box { center, size } => mesh.cuboid(v(center), v(size)),
            Shape::Cylinder { from, to, radius } => mesh.tube(v(from), v(to), *radius),
            Shape::Sphere { center, radius } | Shape::Mass { at: center, radius, .. } => mesh.ball(v(center), *radius),
        }
    }
}

/// The point of a circle about `center` that is beside another one, m.
fn out(center: [f64; 2], at: [f64; 2], radius: f64) -> [f64; 2] {
    let [x, y] = [at[0] - center[0], at[1] - center[1]];
    let length = x.hypot(y);
    [center[0] + radius * x / length, center[1] + radius * y / length]
}

/// A place with three numbers.
fn v(at: &[f64]) -> V {
    std::array::from_fn(|i| at.get(i).copied().unwrap_or(0.0))
}

/// Places of a shape.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_solid_keeps_its_size() {
        let scene = Scene { dimensions: 3, ..Scene::default() };
        let corner = |k: usize| [0, 1, 2].map(|i| [0.2, 0.1, 0.05][i] * if k >> i & 1 == 0 { -0.5 } else { 0.5 }).to_vec();
        let (sin, cos) = 0.5_f64.sin_cos();
        let turned = |p: Vec<f64>| vec![cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]];
        let mut mesh = Mesh::default();
        Builder { scene: &scene, size: 1.0 }.solid(&mut mesh, &Shape::Hull { points: (0..8).map(corner).map(turned).collect() });
        assert_eq!((mesh.positions.len(), mesh.indices.len()), (24, 36));
        assert!(mesh.positions.iter().all(|p| (p[2].abs() - 0.025).abs() < 1e-12 && p[0].hypot(p[1]) < 0.1119));
    }
}
