//! Places on bodies that a picture shows.

use crate::geometry::{Pose, Space};
use crate::mechanism::{Mechanism, Solid};
use crate::results::scene::Place;

/// A vector as 2 or 3 numbers.
pub(super) fn numbers<G: Space<S = f64>>(v: G::Vector) -> Vec<f64> {
    (0..G::VECTOR).map(|i| G::component(v, i)).collect()
}

/// A place on a body.
pub(super) fn place<G: Space<S = f64>>((body, at): (usize, G::Vector)) -> Place {
    Place { body, at: numbers::<G>(at) }
}

/// Whether two places are one.
pub(super) fn same<G: Space<S = f64>>(a: G::Vector, b: G::Vector) -> bool {
    G::dot(a - b, a - b) <= 1e-18
}

/// Places on a body that it has for others and for the user: joint points, ends of its bar, points of the file.
pub(super) fn of_body<G: Space<S = f64>>(mechanism: &Mechanism<G>, body: usize) -> Vec<G::Vector> {
    let mut places: Vec<G::Vector> = Vec::new();
    let of_joints = of_joints(mechanism, body);
    let named = mechanism.bodies[body].points.iter().filter(|(name, _)| name != "origin" && name != "com").map(|(_, at)| *at);
    for at in of_joints.chain(named) {
        if places.iter().all(|other| !same::<G>(*other, at)) {
            places.push(at);
        }
    }
    places
}

/// Points of a body that joints are at.
pub(super) fn of_joints<G: Space<S = f64>>(mechanism: &Mechanism<G>, body: usize) -> impl Iterator<Item = G::Vector> + '_ {
    mechanism.joints.iter().flat_map(|joint| [joint.a, joint.b]).filter(move |(b, _)| *b == body).map(|(_, at)| at)
}

/// All places on all bodies, those of joints on the ground included.
fn all<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Vec<(usize, G::Vector)> {
    let moving = (1..mechanism.bodies.len()).flat_map(|body| {
        let drawn = mechanism.bodies[body].drawn.iter().copied();
        let solids = mechanism.bodies[body].solids.iter().flat_map(Solid::corners).map(|corner| G::vector(&corner));
        of_body(mechanism, body).into_iter().chain(drawn).chain(solids).map(move |at| (body, at))
    });
    let grounded = mechanism.joints.iter().flat_map(|joint| [joint.a, joint.b]).filter(|(body, _)| *body == 0);
    grounded.chain(moving).collect()
}

/// Size of what is seen in a pose, m, and the largest way of one of its places from there to another pose, m.
pub(crate) fn extent<G: Space<S = f64>>(mechanism: &Mechanism<G>, first: &[Pose<G>], second: &[Pose<G>]) -> (f64, f64) {
    let (mut low, mut high, mut moved) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], 0.0_f64);
    for (body, at) in all(mechanism) {
        let (p, q) = (first[body].point(at), second[body].point(at));
        moved = moved.max(G::dot(q - p, q - p).sqrt());
        for axis in 0..G::VECTOR {
            low[axis] = low[axis].min(G::component(p, axis));
            high[axis] = high[axis].max(G::component(p, axis));
        }
    }
    let size = (0..G::VECTOR).map(|i| (high[i] - low[i]).powi(2)).sum::<f64>().sqrt();
    (if size > 0.0 && size.is_finite() { size } else { 1.0 }, moved)
}

/// For each body the farthest of its places from its origin, m.
pub(super) fn reaches<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Vec<f64> {
    let mut reaches = vec![0.0_f64; mechanism.bodies.len()];
    for (body, at) in all(mechanism) {
        reaches[body] = reaches[body].max(G::dot(at, at).sqrt());
    }
    reaches
}
