//! Bodies and what they look like.

use super::places::{numbers, of_body, of_joints};
use crate::geometry::Space;
use crate::mechanism::{self, Mechanism, Outline, Solid, SolidForm, axis_rotation};
use crate::model::Model;
use crate::results::scene::{Body, Shape};

/// Radius of the largest point mass, as part of the size of the mechanism.
const LARGEST: f64 = 0.035;
/// Width of an arm to a point mass beside its body, as part of the size of the mechanism.
const ARM: f64 = 0.008;
/// Distance of a centre of mass from the joint of a body without a shape from which on the body is drawn as an arm, as part of the size.
const APART: f64 = 1e-3;
/// Distance of a joint from the edge of an outline from which on it is beside it, as part of the size of the outline.
const BESIDE: f64 = 0.005;
/// Thickness of a thin bar, as part of its width.
const THIN: f64 = 0.02;

/// The bodies of a mechanism with their shapes.
pub(super) fn bodies<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>) -> Vec<Body> {
    let masses: Vec<Vec<(G::Vector, f64)>> = (0..mechanism.bodies.len()).map(|body| masses(model, mechanism, body)).collect();
    let heaviest = masses.iter().flatten().fold(0.0_f64, |most, (_, mass)| most.max(*mass));
    let largest = LARGEST * mechanism.size();
    let bodies = mechanism.bodies.iter().zip(masses).enumerate();
    bodies
        .map(|(index, (body, masses))| {
            let mut shapes = if index == 0 { Vec::new() } else { shapes(mechanism, index) };
            let arms: Vec<Shape> = masses.iter().filter_map(|(at, _)| arm(mechanism, &shapes, &numbers::<G>(*at))).collect();
            shapes.splice(0..0, arms);
            shapes.extend(masses.into_iter().map(|(at, mass)| Shape::Mass {
                at: numbers::<G>(at),
                mass,
                radius: largest * (mass / heaviest).sqrt(),
            }));
            Body { name: body.name.clone(), shapes }
        })
        .collect()
}

/// Point masses: those that are attached, and a body that is one itself.
fn masses<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>, index: usize) -> Vec<(G::Vector, f64)> {
    let (body, said) = (&mechanism.bodies[index], &model.bodies[index]);
    // one that slides is seen by the box of its slide
    let slides = mechanism.joints.iter().any(|j| (j.a.0 == index || j.b.0 == index) && j.kind == "slider");
    let itself = index > 0 && !slides && said.shape.is_none() && (said.inertia.is_empty() || is_an_arm(mechanism, index));
    let itself = itself.then_some((body.bare.com, body.bare.mass));
    let attached = body.attached.iter().map(|a| (a.mass.com, a.mass.mass));
    itself.into_iter().chain(attached).filter(|(_, mass)| *mass > 0.0).collect()
}

/// Whether a body without a shape has one joint, away from its centre of mass, and nothing else that shows where it is.
fn is_an_arm<G: Space<S = f64>>(mechanism: &Mechanism<G>, index: usize) -> bool {
    let body = &mechanism.bodies[index];
    let [only] = of_body(mechanism, index)[..] else { return false };
    let away = only - body.bare.com;
    body.drawn.is_empty() && body.solids.is_empty() && G::dot(away, away).sqrt() > APART * mechanism.size()
}

/// What leads from the shapes of a body to a point mass beside them.
fn arm<G: Space<S = f64>>(mechanism: &Mechanism<G>, shapes: &[Shape], mass: &[f64]) -> Option<Shape> {
    if shapes.iter().any(|shape| holds(shape, mass)) {
        return None;
    }
    let gap = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let nearer = |points: &[Vec<f64>]| points.iter().min_by(|a, b| gap(a, mass).total_cmp(&gap(b, mass))).cloned();
    let from = |shape: &Shape| match shape {
        Shape::Bar { from, to, .. } | Shape::Cylinder { from, to, .. } => {
            let ends = [from, to].map(|end| std::array::from_fn(|i| end.get(i).copied().unwrap_or(0.0)));
            Some(nearest([&ends[0], &ends[1]], mass))
        }
        // a plate has room for what is among its corners
        Shape::Hull { points } => {
            let middle: Vec<f64> = (0..mass.len()).map(|i| points.iter().map(|p| p[i]).sum::<f64>() / points.len() as f64).collect();
            let reach = points.iter().map(|p| gap(&middle, p)).fold(0.0, f64::max);
            nearer(points).filter(|_| gap(&middle, mass) > reach * (1.0 + 1e-6))
        }
        Shape::Polygon { points } => nearer(points),
        Shape::Disc { center, .. } | Shape::Gear { center, .. } | Shape::Box { center, .. } | Shape::Sphere { center, .. } => {
            Some(center.clone())
        }
        Shape::Mass { .. } => None,
    };
    let from = nearer(&shapes.iter().filter_map(from).collect::<Vec<_>>())?;
    Some(Shape::Bar { from, to: mass.to_vec(), width: Some(ARM * mechanism.size()) })
}

/// The shapes of a moving body: its outline, and what reaches from there to joints and points outside of it.
fn shapes<G: Space<S = f64>>(mechanism: &Mechanism<G>, index: usize) -> Vec<Shape> {
    let (body, mut places) = (&mechanism.bodies[index], of_body(mechanism, index));
    let all = |places: &[G::Vector]| places.iter().map(|p| numbers::<G>(*p)).collect::<Vec<_>>();
    let drawn = all(&body.drawn);
    if !body.solids.is_empty() {
        return solids(body, &all(&places));
    }
    if G::VECTOR == 2 && is_simple(&drawn) {
        let joints: Vec<G::Vector> = of_joints(mechanism, index).collect();
        return outlined(drawn, &all(&joints));
    }
    places.extend(&body.drawn);
    let Some(own) = body.outline.map(|outline| outline_shape(outline, G::VECTOR)) else {
        return if places.is_empty() { Vec::new() } else { vec![Shape::Hull { points: all(&places) }] };
    };
    let within = match body.outline {
        Some(Outline::Bar { from, to, width, height }) => {
            let [from, to] = [from, to].map(|end| end[..G::VECTOR].to_vec());
            Shape::Bar { from, to, width: Some(width.max(height)) }
        }
        _ => own.clone(),
    };
    let outside: Vec<G::Vector> = places.into_iter().filter(|p| !holds(&within, &numbers::<G>(*p))).collect();
    match (own, body.outline) {
        (own, _) if outside.is_empty() => vec![own],
        // a bar with something beside it is a plate, unless it has a size of its own
        (Shape::Bar { from, to, width: None }, _) => vec![Shape::Hull { points: [vec![from, to], all(&outside)].concat() }],
        (own, Some(Outline::Bar { from, to, .. })) => {
            let leg = |p: Vec<f64>| Shape::Bar { from: nearest([&from, &to], &p), to: p, width: None };
            all(&outside).into_iter().map(leg).chain([own]).collect()
        }
        (own, _) => vec![Shape::Hull { points: [vec![vec![0.0; G::VECTOR]], all(&outside)].concat() }, own],
    }
}

/// An outline as the user has drawn it, and bars from its nearest edge to joints beside it.
fn outlined(drawn: Vec<Vec<f64>>, joints: &[Vec<f64>]) -> Vec<Shape> {
    let gap = |a: &[f64], b: &[f64]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let reach = drawn.iter().map(|p| gap(&drawn[0], p)).fold(0.0, f64::max);
    let triple = |p: &[f64]| [p[0], p[1], 0.0];
    let bar = |joint: &Vec<f64>| {
        let edges = drawn.iter().zip(drawn.iter().cycle().skip(1));
        let places = edges.map(|(a, b)| nearest([&triple(a), &triple(b)], joint));
        let from = places.min_by(|a, b| gap(a, joint).total_cmp(&gap(b, joint)))?;
        let beside = !is_inside(&drawn, joint) && gap(&from, joint) > BESIDE * reach;
        beside.then(|| Shape::Bar { from, to: joint.clone(), width: None })
    };
    let bars: Vec<Shape> = joints.iter().filter_map(bar).collect();
    bars.into_iter().chain([Shape::Polygon { points: drawn }]).collect()
}

/// The solids of a body, and bars from the nearest of them to places outside of all.
fn solids<G: Space>(body: &mechanism::Body<G>, places: &[Vec<f64>]) -> Vec<Shape> {
    let triple = |at: &[f64]| [0, 1, 2].map(|i| at.get(i).copied().unwrap_or(0.0));
    let far = |solid: &Solid, at: [f64; 3]| (0..3).map(|i| (solid.at[i] - at[i]).powi(2)).sum::<f64>();
    let bar = |at: &Vec<f64>| {
        let end = triple(at);
        let nearest = body.solids.iter().min_by(|a, b| far(a, end).total_cmp(&far(b, end)))?;
        Some(Shape::Bar { from: nearest.at.to_vec(), to: at.clone(), width: None })
    };
    let outside = places.iter().filter(|at| !body.solids.iter().any(|solid| solid.holds(triple(at))));
    body.solids.iter().filter_map(solid_shape).chain(outside.filter_map(bar)).collect()
}

/// A solid in the frame of its body; none of one that has no size.
fn solid_shape(solid: &Solid) -> Option<Shape> {
    let upright = (0..3).all(|i| (0..3).all(|k| solid.turned[i][k] == f64::from(u8::from(i == k))));
    match solid.form {
        SolidForm::Box { size } if size == [0.0; 3] => None,
        SolidForm::Box { size } if upright => Some(Shape::Box { center: solid.at.to_vec(), size: size.to_vec() }),
        SolidForm::Box { .. } => Some(Shape::Hull { points: solid.corners().map(|corner| corner.to_vec()).to_vec() }),
        SolidForm::Cylinder { radius, .. } | SolidForm::Ball { radius } if radius == 0.0 => None,
        SolidForm::Cylinder { radius, length: 0.0 } => {
            let axis = Some([0, 1, 2].map(|i| solid.turned[i][2]).to_vec());
            Some(Shape::Disc { center: solid.at.to_vec(), radius, axis, thickness: None })
        }
        SolidForm::Cylinder { radius, length } => {
            let [from, to] = [-0.5, 0.5].map(|part| solid.point([0.0, 0.0, part * length]).to_vec());
            Some(Shape::Cylinder { from, to, radius })
        }
        SolidForm::Ball { radius } => Some(Shape::Sphere { center: solid.at.to_vec(), radius }),
    }
}

/// The place of a line between two ends that is nearest to a point.
fn nearest([from, to]: [&[f64; 3]; 2], p: &[f64]) -> Vec<f64> {
    let way = [0, 1, 2].map(|i| to[i] - from[i]);
    let along: f64 = p.iter().zip(from).zip(way).map(|((p, from), way)| (p - from) * way).sum();
    let part = (along / way.iter().map(|x| x * x).sum::<f64>()).clamp(0.0, 1.0);
    (0..p.len()).map(|i| from[i] + part * way[i]).collect()
}

/// The corners of a bar in space with a rectangle of these sizes across it, of which one may be 0: a box if it lies along x.
fn beam(from: [f64; 3], to: [f64; 3], sizes: [f64; 2]) -> Shape {
    let way = [0, 1, 2].map(|i| to[i] - from[i]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [width, height] = [sizes[0].max(THIN * sizes[1]), sizes[1].max(THIN * sizes[0])];
    let middle = [0, 1, 2].map(|i| 0.5 * (from[i] + to[i]));
    if way[0] == length {
        return Shape::Box { center: middle.to_vec(), size: vec![length, width, height] };
    }
    let turned = axis_rotation([1.0, 0.0, 0.0], way.map(|x| x / length));
    let corner = |k: usize| {
        let [x, y, z] = [0, 1, 2].map(|i| if k >> i & 1 == 0 { -0.5 } else { 0.5 });
        let local = [x * length, y * width, z * height];
        (0..3).map(|i| middle[i] + (0..3).map(|j| turned[i][j] * local[j]).sum::<f64>()).collect()
    };
    Shape::Hull { points: (0..8).map(corner).collect() }
}

/// The shape of an outline.
fn outline_shape(outline: Outline, dimensions: usize) -> Shape {
    let cut = |p: [f64; 3]| p[..dimensions].to_vec();
    let origin = vec![0.0; dimensions];
    let given = |x: f64| (x > 0.0).then_some(x);
    match outline {
        Outline::Bar { from, to, width, height } if dimensions == 3 && width.max(height) > 0.0 => beam(from, to, [width, height]),
        Outline::Bar { from, to, width, .. } => Shape::Bar { from: cut(from), to: cut(to), width: given(width) },
        Outline::Disc { center, axis, radius, thickness } => {
            let axis = (dimensions == 3).then(|| axis.to_vec());
            Shape::Disc { center: cut(center), radius, axis, thickness: given(thickness) }
        }
        Outline::Block { size: [a, b, _] } if dimensions == 2 => {
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            Shape::Polygon { points: corners.map(|[x, y]| vec![0.5 * x * a, 0.5 * y * b]).to_vec() }
        }
        Outline::Block { size } => Shape::Box { center: origin, size: size.to_vec() },
        Outline::Ball { radius } if dimensions == 2 => Shape::Disc { center: origin, radius, axis: None, thickness: None },
        Outline::Ball { radius } => Shape::Sphere { center: origin, radius },
    }
}

/// Whether a place is within a shape, to a millionth of its size.
fn holds(shape: &Shape, p: &[f64]) -> bool {
    let length = |p: &[f64]| p.iter().map(|x| x * x).sum::<f64>().sqrt();
    match shape {
        Shape::Bar { from, to, width } => {
            let d: Vec<f64> = to.iter().zip(from).map(|(a, b)| a - b).collect();
            let r: Vec<f64> = p.iter().zip(from).map(|(a, b)| a - b).collect();
            let size = length(&d);
            let along = d.iter().zip(&r).map(|(d, r)| d * r).sum::<f64>() / (size * size);
            let across: Vec<f64> = r.iter().zip(&d).map(|(r, d)| r - along * d).collect();
            (-1e-6..=1.0 + 1e-6).contains(&along) && length(&across) <= width.unwrap_or(0.0) * 0.5 + 1e-6 * size
        }
        Shape::Disc { center, radius, .. } | Shape::Gear { center, radius, .. } | Shape::Sphere { center, radius } => {
            let from: Vec<f64> = p.iter().zip(center).map(|(p, c)| p - c).collect();
            length(&from) <= radius * (1.0 + 1e-6)
        }
        Shape::Box { center, size } => {
            let thick = size.iter().copied().fold(0.0, f64::max);
            size.iter().zip(center.iter().zip(p)).all(|(size, (c, x))| (x - c).abs() <= 0.5 * size + 1e-6 * thick)
        }
        Shape::Polygon { points } => is_inside(points, p),
        Shape::Hull { .. } | Shape::Cylinder { .. } | Shape::Mass { .. } => false,
    }
}

/// Whether a point in the plane is in a polygon or on its edge: edges above it are crossed an odd number of times.
fn is_inside(points: &[Vec<f64>], p: &[f64]) -> bool {
    let mut inside = false;
    for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
        let turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        let length2 = (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2);
        let along = (b[0] - a[0]) * (p[0] - a[0]) + (b[1] - a[1]) * (p[1] - a[1]);
        if turn.abs() <= 1e-6 * length2 && (0.0..=length2).contains(&along) {
            return true;
        }
        if (a[1] > p[1]) != (b[1] > p[1]) && (turn > 0.0) == (b[1] > a[1]) {
            inside = !inside;
        }
    }
    inside
}

/// Whether points in the plane, joined in their order, are an outline that does not cross itself.
fn is_simple(points: &[Vec<f64>]) -> bool {
    let n = points.len();
    let side = |a: &[f64], b: &[f64], p: &[f64]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0.0;
    let crosses = |i: usize, k: usize| {
        let [a, b, c, d] = [i, (i + 1) % n, k, (k + 1) % n].map(|i| points[i].as_slice());
        side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
    };
    n >= 3 && (0..n).all(|i| (i + 2..n).filter(|k| (k + 1) % n != i).all(|k| !crosses(i, k)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_that_crosses_itself_is_none() {
        let [a, b, c, d] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(|p| p.to_vec());
        assert!(is_simple(&[a.clone(), b.clone(), c.clone(), d.clone()]));
        assert!(!is_simple(&[a.clone(), c, b, d]) && !is_simple(&[a]));
    }

    #[test]
    fn places_within_a_polygon_and_on_its_edge_belong_to_it() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|p| p.to_vec());
        for p in [[1.0, 1.0], [2.0, 1.0], [0.0, 0.0]] {
            assert!(is_inside(&square, &p), "{p:?}");
        }
        assert!(!is_inside(&square, &[3.0, 1.0]) && !is_inside(&square, &[-1.0, 0.5]));
    }
}
