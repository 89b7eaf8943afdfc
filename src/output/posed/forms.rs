//! Shapes of bodies in the picture; solids as the faces that are seen.

use super::{Posed, telescope};
use crate::output::polytope;
use crate::output::pose::{Facet, Form, FormKind, Width};
use crate::output::view::{across, cross, dot};
use crate::results::scene::{Place, Shape, rim, wheel};
use std::f64::consts::TAU;

/// Corners of a circle.
const CORNERS: usize = 96;
/// Every so many of them are corners of the facets of a round shape.
const COARSER: usize = 2;
/// Light on the side of a round bar.
const SIDE: f64 = 0.75;
/// Length of the line that shows how a gear is turned, as part of its pitch radius.
const SPOKE: f64 = 0.8;
/// How far points on one line are off it by rounding, as part of its length.
const ROUND_OFF: f64 = 1e-9;
/// Points in space that legs lead to; more than that are taken for an outline.
const LEGS: usize = 4;

/// The ends of a shape in space that is a bar: also of points that all lie on one line.
fn ends(shape: &Shape) -> Option<[&Vec<f64>; 2]> {
    match shape {
        Shape::Bar { from, to, .. } => Some([from, to]),
        Shape::Hull { points } => {
            let apart = |a: &[f64], b: &[f64]| -> [f64; 3] { std::array::from_fn(|i| b[i] - a[i]) };
            let size = |e: [f64; 3]| dot(e, e).sqrt();
            let farthest = |from: &[f64]| points.iter().max_by(|a, b| size(apart(from, a)).total_cmp(&size(apart(from, b))));
            let from = farthest(points.first()?)?;
            let to = farthest(from)?;
            let along = apart(from, to);
            let off = |p: &Vec<f64>| size(cross(along, apart(from, p)));
            (size(along) > 0.0 && points.iter().all(|p| off(p) <= ROUND_OFF * dot(along, along))).then_some([from, to])
        }
        _ => None,
    }
}

/// The faces of the hull of points in space, of those that are not joined by legs.
pub(in crate::output) fn faces_of(points: &[Vec<f64>]) -> Vec<Vec<usize>> {
    let places: Vec<[f64; 3]> = points.iter().map(|p| std::array::from_fn(|i| p.get(i).copied().unwrap_or(0.0))).collect();
    if places.len() > LEGS { polytope::faces(&places) } else { Vec::new() }
}

impl Posed<'_> {
    /// A shape of a body in one position.
    pub(super) fn forms(&self, poses: &[f64], body: usize, shape: &Shape) -> Vec<Form> {
        let world = |at: &[f64]| self.scene.world(poses, &Place { body, at: at.to_vec() });
        let planar = self.scene.dimensions == 2;
        match shape {
            Shape::Bar { from, to, width } => vec![self.bar(poses, body, [world(from), world(to)], *width)],
            Shape::Hull { points } => {
                let places: Vec<[f64; 3]> = points.iter().map(|p| world(p)).collect();
                let line = if planar { None } else { ends(shape) };
                match if planar { Vec::new() } else { faces_of(points) } {
                    _ if let Some([from, to]) = line => vec![self.bar(poses, body, [world(from), world(to)], None)],
                    _ if !planar && (3..=LEGS).contains(&places.len()) => self.legs(poses, body, &places),
                    // a flat one is a plate
                    _ if places.len() == 2 => vec![self.bar(poses, body, [places[0], places[1]], None)],
                    faces if faces.len() < 3 => vec![self.plate(body, &places)],
                    faces => {
                        let corners = faces.iter().map(|face| face.iter().map(|k| places[*k]).collect::<Vec<_>>());
                        corners.filter_map(|corners| self.face(&corners)).collect()
                    }
                }
            }
            Shape::Polygon { points } => vec![self.area(&points.iter().map(|p| world(p)).collect::<Vec<_>>(), 1.0)],
            Shape::Disc { center, radius, axis, thickness } => match axis {
                Some(axis) => {
                    let (c, n) = (world(center), self.scene.direction(poses, body, axis));
                    let half = 0.5 * thickness.unwrap_or(0.0);
                    let [a, b] = [-half, half].map(|s| std::array::from_fn(|i| c[i] + s * n[i]));
                    // what is as long as it is wide is no wheel
                    if 2.0 * half > *radius { self.cylinder(a, b, n, *radius) } else { vec![self.wheel([a, b], n, *radius)] }
                }
                None => {
                    let mut rim = center.clone();
                    rim[0] += radius;
                    let (center, spoke) = (self.view.flat(world(center)), Some(self.view.flat(world(&rim))));
                    vec![Form::flat(FormKind::Disc { center, radius: *radius, spoke }, -8f64.sqrt() * radius)]
                }
            },
            Shape::Gear { center, radius, teeth, first } => {
                let flat = |p: [f64; 2]| self.view.flat(world(&p));
                let outline = wheel([center[0], center[1]], *radius, *teeth, *first).into_iter().map(flat).collect();
                let ring = *radius < 0.0;
                let kind = FormKind::Gear {
                    center: self.view.flat(world(center)),
                    radius: radius.abs(),
                    teeth: *teeth,
                    outline,
                    spoke: (!ring).then(|| flat([center[0] + SPOKE * radius, center[1]])),
                    rim: ring.then(|| rim(*radius, *teeth)),
                };
                vec![Form::flat(kind, -8f64.sqrt() * radius.abs())]
            }
            Shape::Box { center, size } => {
                let edges: [[f64; 3]; 3] = std::array::from_fn(|i| {
                    let mut e = [0.0; 3];
                    e[i] = 0.5 * size[i];
                    self.scene.direction(poses, body, &e)
                });
                self.faces(world(center), edges)
            }
            Shape::Cylinder { from, to, radius } => {
                let (a, b) = (world(from), world(to));
                self.cylinder(a, b, std::array::from_fn(|i| b[i] - a[i]), *radius)
            }
            Shape::Sphere { center, radius } => {
                let c = world(center);
                let kind = FormKind::Disc { center: self.view.flat(c), radius: radius * self.view.stretch(), spoke: None };
                vec![Form::flat(kind, self.view.depth(c))]
            }
            Shape::Mass { at, radius, .. } => {
                let c = world(at);
                let depth = if planar { f64::INFINITY } else { self.view.depth(c) + radius };
                vec![Form::flat(FormKind::Mass { center: self.view.flat(c), radius: radius * self.view.stretch() }, depth)]
            }
        }
    }

    /// A plane face around its corners, counter-clockwise from outside; none if it is turned away.
    fn face(&self, corners: &[[f64; 3]]) -> Option<Form> {
        let from = |k: usize| std::array::from_fn(|i| corners[k][i] - corners[0][i]);
        let normal = (1..corners.len() - 1).fold([0.0; 3], |sum, k| {
            let n = cross(from(k), from(k + 1));
            std::array::from_fn(|i| sum[i] + n[i])
        });
        self.light(normal).map(|light| self.flat_face(corners, light))
    }

    /// A bar of a body.
    fn bar(&self, poses: &[f64], body: usize, [a, b]: [[f64; 3]; 2], width: Option<f64>) -> Form {
        let width = width.map_or_else(|| self.width(body), Width::Given);
        let depth = self.depth_of_bar(body).unwrap_or_else(|| self.depth(&[a, b]).min(self.within(poses, body)));
        let kind = FormKind::Bar { from: self.view.flat(a), to: self.view.flat(b), width };
        let line = Facet { corners: vec![self.seen(a), self.seen(b)], edges: vec![true] };
        Form { kind, depth, facets: if self.scene.dimensions == 2 { Vec::new() } else { vec![line] } }
    }

    /// The width of a bar of a body to which the model gives none.
    fn width(&self, body: usize) -> Width {
        Width::Drawn(self.stages[body][0])
    }

    /// In the plane the depth of a bar of a body: cylinders lie in front of what slides in them.
    fn depth_of_bar(&self, body: usize) -> Option<f64> {
        (self.scene.dimensions == 2).then(|| f64::from(self.stages[body][1]) * f64::MIN_POSITIVE)
    }

    /// In space a depth that lies behind the bars of the cylinders in which a body slides.
    fn within(&self, poses: &[f64], body: usize) -> f64 {
        let around = std::iter::successors(self.cylinders[body], |cylinder| self.cylinders[*cylinder]).take(telescope::MOST as usize);
        let bars = around.flat_map(|body| self.scene.bodies[body].shapes.iter().filter_map(move |shape| Some((body, ends(shape)?))));
        let ends = bars.map(|(body, ends)| ends.map(|at| self.scene.world(poses, &Place { body, at: at.clone() })));
        ends.map(|ends| self.depth(&ends)).fold(f64::INFINITY, f64::min).next_down()
    }

    /// In the plane large plates lie under small ones and under bars; a disc is as large as the square around it.
    fn depth(&self, places: &[[f64; 3]]) -> f64 {
        if self.scene.dimensions == 2 {
            let span = |axis: usize| {
                let along = places.iter().map(|p| p[axis]);
                along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
            };
            return -span(0).hypot(span(1));
        }
        places.iter().map(|p| self.view.depth(*p)).sum::<f64>() / places.len().max(1) as f64
    }

    fn plate(&self, body: usize, places: &[[f64; 3]]) -> Form {
        let points: Vec<[f64; 2]> = places.iter().map(|p| self.view.flat(*p)).collect();
        // on one line they are a bar, too
        let line = self.depth_of_bar(body).map(|depth| (depth, crate::output::outlines::hull(&points)));
        match line {
            Some((depth, ends)) if ends.len() == 2 => {
                Form::flat(FormKind::Bar { from: ends[0], to: ends[1], width: self.width(body) }, depth)
            }
            Some((depth, ends)) if ends.len() < 3 => Form::flat(FormKind::Plate { points }, depth),
            _ => Form::flat(FormKind::Plate { points }, self.depth(places)),
        }
    }

    fn area(&self, places: &[[f64; 3]], shade: f64) -> Form {
        let points = places.iter().map(|p| self.view.flat(*p)).collect();
        Form::flat(FormKind::Area { points, shade }, self.depth(places))
    }

    /// A flat convex face of a solid.
    fn flat_face(&self, corners: &[[f64; 3]], light: f64) -> Form {
        let facet = Facet { corners: corners.iter().map(|p| self.seen(*p)).collect(), edges: vec![true; corners.len()] };
        Form { facets: vec![facet], ..self.area(corners, light) }
    }

    /// A place in the axes of the picture: to the right, upwards, and towards the eye.
    fn seen(&self, p: [f64; 3]) -> [f64; 3] {
        let [x, y] = self.view.flat(p);
        [x, y, self.view.depth(p)]
    }

    /// Bars from the middle of places to each of them.
    fn legs(&self, poses: &[f64], body: usize, places: &[[f64; 3]]) -> Vec<Form> {
        let middle = std::array::from_fn(|i| places.iter().map(|p| p[i]).sum::<f64>() / places.len() as f64);
        places.iter().map(|p| self.bar(poses, body, [middle, *p], None)).collect()
    }

    /// How light a face with this outward normal is; none if it is turned away.
    fn light(&self, normal: [f64; 3]) -> Option<f64> {
        let length = dot(normal, normal).sqrt();
        let facing = self.view.depth(normal) / length;
        (facing > 1e-6).then(|| 0.62 + 0.38 * (0.5 * facing + 0.5 * (dot(normal, self.scene.up) / length).max(0.0)))
    }

    /// The faces of a box that are seen, from its half edges.
    fn faces(&self, center: [f64; 3], edges: [[f64; 3]; 3]) -> Vec<Form> {
        let mut faces = Vec::new();
        for axis in 0..3 {
            let (u, v) = (edges[(axis + 1) % 3], edges[(axis + 2) % 3]);
            let normal = cross(u, v);
            for side in [-1.0, 1.0] {
                if let Some(light) = self.light(normal.map(|x| side * x)) {
                    let corner = |s: f64, t: f64| std::array::from_fn(|i| center[i] + side * edges[axis][i] + s * u[i] + t * v[i]);
                    faces.push(self.flat_face(&[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], light));
                }
            }
        }
        faces
    }

    /// The side of a round bar and the end that is seen.
    fn cylinder(&self, a: [f64; 3], b: [f64; 3], axis: [f64; 3], radius: f64) -> Vec<Form> {
        let ring = |center: [f64; 3]| self.ring(center, axis, radius);
        let (first, second) = (ring(a), ring(b));
        let front = if self.view.depth(axis) >= 0.0 { &second } else { &first };
        let light = self.light(axis).or_else(|| self.light(axis.map(|x| -x))).unwrap_or(1.0);
        let mut forms: Vec<Form> = self.side(a, [&first, &second]).into_iter().collect();
        let coarse: Vec<[f64; 3]> = front.iter().step_by(COARSER).copied().collect();
        forms.push(Form { kind: self.area(front, light).kind, ..self.flat_face(&coarse, light) });
        forms
    }

    /// The side of a round bar as far as it is seen, between circles about its ends, the first of which is at `end`; none if it is seen
    /// from an end.
    fn side(&self, end: [f64; 3], rings: [&[[f64; 3]]; 2]) -> Option<Form> {
        let count = rings[0].len();
        let faces_eye = |k: usize| {
            let (p, q) = (rings[0][k % count], rings[0][(k + COARSER) % count]);
            self.light(std::array::from_fn(|i| 0.5 * (p[i] + q[i]) - end[i])).is_some()
        };
        let steps = || (0..count).step_by(COARSER);
        // what is seen is half of it, and in one piece
        let begin = steps().find(|k| faces_eye(*k) && !faces_eye(k + count - COARSER))?;
        let seen: Vec<usize> = steps().map(|k| begin + k).take_while(|k| faces_eye(*k)).collect();
        let end = seen.last()? + COARSER;
        let along = |ring: usize| (begin..=end).map(move |k| rings[ring][k % count]);
        let outline: Vec<[f64; 3]> = along(0).chain(along(1).rev()).collect();
        let strip = |k: &usize| {
            let next = k + COARSER;
            let corners = [(0, *k), (0, next), (1, next), (1, *k)].map(|(ring, k)| self.seen(rings[ring][k % count])).to_vec();
            Facet { corners, edges: vec![true, next == end, true, *k == begin] }
        };
        (rings[0] != rings[1]).then(|| Form { facets: seen.iter().map(strip).collect(), ..self.area(&outline, SIDE) })
    }

    /// A wheel between two ends.
    fn wheel(&self, ends: [[f64; 3]; 2], axis: [f64; 3], radius: f64) -> Form {
        let rings = ends.map(|center| self.ring(center, axis, radius));
        let flat = |ring: &Vec<[f64; 3]>| ring.iter().map(|p| self.view.flat(*p)).collect::<Vec<_>>();
        let face = flat(&rings[usize::from(self.view.depth(axis) >= 0.0)]);
        let outline = crate::output::outlines::hull(&rings.iter().flat_map(flat).collect::<Vec<_>>());
        Form::flat(FormKind::Wheel { outline, face }, self.depth(&rings.concat()))
    }

    /// A circle in space.
    pub(super) fn ring(&self, center: [f64; 3], axis: [f64; 3], radius: f64) -> Vec<[f64; 3]> {
        let [u, v] = across(axis);
        let corner = |k: usize| {
            let (s, c) = (TAU * k as f64 / CORNERS as f64).sin_cos();
            std::array::from_fn(|i| center[i] + radius * (c * u[i] + s * v[i]))
        };
        (0..CORNERS).map(corner).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::drawing;
    use crate::results::Scene;
    use crate::results::scene::{Body, Frames};

    /// The forms of one body that stands as the world does.
    fn seen(shape: Shape, view: Option<[f64; 2]>) -> Vec<Form> {
        let bodies = vec![Body { name: "ground".into(), shapes: vec![] }, Body { name: "b".into(), shapes: vec![shape] }];
        let frames = Frames { at: vec![0.0], poses: vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], shown: vec![0], ..Frames::default() };
        let scene = Scene { dimensions: 3, up: [0.0, 0.0, 1.0], view, bodies, frames, ..Scene::default() };
        drawing("m", "s", "mechanism", &scene).bodies.remove(1).poses.remove(0)
    }

    #[test]
    fn solids_show_the_faces_that_are_turned_to_the_eye() {
        let cuboid = Shape::Box { center: vec![0.0; 3], size: vec![1.0, 2.0, 3.0] };
        assert_eq!(seen(cuboid.clone(), None).len(), 3);
        // from the front one face, as wide as x and as high as z
        let front = seen(cuboid, Some([-0.25 * TAU, 0.0]));
        let [Form { kind: FormKind::Area { points, .. }, .. }] = &front[..] else { panic!("{front:?}") };
        let span = |axis: usize| points.iter().map(|p| p[axis]).fold(0.0, f64::max) * 2.0;
        assert!((span(0) - 1.0).abs() < 1e-12 && (span(1) - 3.0).abs() < 1e-12, "{points:?}");
        let round =
            |thickness| Shape::Disc { center: vec![0.0; 3], radius: 1.0, axis: Some(vec![0.0, 0.0, 1.0]), thickness: Some(thickness) };
        assert_eq!(seen(round(1.5), None).len(), 2);
        // a wheel lets through what is behind it: its outline is wider than the end that is seen
        let [Form { kind: FormKind::Wheel { outline, face }, .. }] = &seen(round(0.2), None)[..] else { panic!("one form") };
        let tall = |points: &[[f64; 2]]| points.iter().fold(0.0_f64, |most, p| most.max(-p[1]));
        assert!(face.len() == CORNERS && tall(outline) > tall(face) + 0.1, "{} {}", tall(outline), tall(face));
        let hull = |n: usize| Shape::Hull { points: (0..n).map(|i| vec![i as f64, (i * i) as f64, 0.5]).collect() };
        assert_eq!((seen(hull(2), None).len(), seen(hull(3), None).len(), seen(hull(8), None).len()), (1, 3, 1));
        // the side of a round bar is what its end leaves of it
        let round = seen(Shape::Cylinder { from: vec![0.0; 3], to: vec![0.0, 0.0, 2.0], radius: 0.5 }, None);
        let area = |form: &Form| {
            let FormKind::Area { points, .. } = &form.kind else { panic!("{form:?}") };
            let turn = |k: usize| points[k][0] * points[(k + 1) % points.len()][1] - points[(k + 1) % points.len()][0] * points[k][1];
            0.5 * (0..points.len()).map(turn).sum::<f64>().abs()
        };
        let flat = |form: &Form| {
            form.facets
                .iter()
                .map(|facet| Form::flat(FormKind::Area { points: facet.corners.iter().map(|p| [p[0], p[1]]).collect(), shade: 1.0 }, 0.0))
                .map(|part| area(&part))
                .sum::<f64>()
        };
        assert_eq!(round.len(), 2);
        assert!(round.iter().all(|form| (flat(form) - area(form)).abs() < 5e-3 * area(form)), "{round:?}");
        // what is solid is seen by its faces, as a box is
        let corners = (0..8).map(|k| vec![f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)]).collect();
        assert_eq!(seen(Shape::Hull { points: corners }, None).len(), 3);
    }
}
