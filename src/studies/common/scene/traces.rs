//! Points whose paths are drawn.

use super::places::{numbers, same};
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use crate::model::{PointRef, Quantity};
use crate::results::Scene;
use crate::results::scene::{Place, Trace};
use crate::studies::common::case::Case;

/// Paths at most that are drawn unasked, so that a picture of a large mechanism stays readable.
const MOST: usize = 8;

/// Points that the study asks for, else those that its columns name; without any, points of the file and joints between moving bodies whose paths are neither
/// circles nor lines. The frames of the scene are there.
pub(super) fn traces<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, scene: &Scene) -> Vec<Trace> {
    if scene.frames.count() < 4 {
        return Vec::new();
    }
    let trace = |at: &PointRef| {
        let body = &mechanism.bodies[at.body];
        let (point, place) = &body.points[at.point];
        let name = if point == "origin" { body.name.clone() } else { format!("{}.{point}", body.name) };
        Trace { name, body: at.body, at: numbers::<G>(*place) }
    };
    if let Some(asked) = &case.study.trace {
        return asked.iter().map(trace).collect();
    }
    let named = of_columns(case);
    if named.is_empty() { of_mechanism(mechanism, scene) } else { named.iter().map(trace).take(MOST).collect() }
}

/// Points of moving bodies whose coordinates are columns.
fn of_columns(case: Case<'_>) -> Vec<PointRef> {
    let ids: Vec<_> = case.study.columns.iter().map(|column| column.value).collect();
    let mut found: Vec<PointRef> = Vec::new();
    for id in ids {
        for input in case.model.pool.inputs_of(&[id]) {
            if let Quantity::Point { at, order: 0, .. } = case.model.inputs[input as usize]
                && at.body != 0
                && !found.contains(&at)
            {
                found.push(at);
            }
        }
    }
    found
}

/// Points of moving bodies that are not fixed on a circle or a line.
fn of_mechanism<G: Space<S = f64>>(mechanism: &Mechanism<G>, scene: &Scene) -> Vec<Trace> {
    let mut found: Vec<(String, usize, G::Vector)> = Vec::new();
    for (b, body) in mechanism.bodies.iter().enumerate().skip(1) {
        for (name, p) in &body.points {
            let at_joint = mechanism.joints.iter().any(|j| [j.a, j.b].iter().any(|(k, x)| *k == b && same::<G>(*x, *p)));
            if !["origin", "com", "start", "end"].contains(&&**name) && !at_joint {
                found.push((format!("{}.{name}", body.name), b, *p));
            }
        }
    }
    for joint in mechanism.joints.iter().filter(|joint| joint.a.0 != 0 && joint.b.0 != 0) {
        found.push((joint.name.clone(), joint.b.0, joint.b.1));
    }
    // the end of an open chain has no joint
    for (b, body) in mechanism.bodies.iter().enumerate().skip(1) {
        let end = body.points.iter().find(|(name, _)| name == "end").map(|(_, p)| *p);
        let hung = mechanism.joints.iter().filter(|j| j.a.0 == b || j.b.0 == b).count();
        if let (Some(end), 1) = (end, hung) {
            found.push((body.name.clone(), b, end));
        }
    }
    let seen = found.into_iter().map(|(name, body, at)| Trace { name, body, at: numbers::<G>(at) });
    seen.filter(|trace| !is_plain(&path(scene, trace))).take(MOST).collect()
}

/// The places of a trace in all frames, m.
fn path(scene: &Scene, trace: &Trace) -> Vec<[f64; 3]> {
    let place = Place { body: trace.body, at: trace.at.clone() };
    (0..scene.frames.count()).map(|i| scene.world(scene.frame(i), &place)).collect()
}

/// Whether points lie on one circle, on one line or at one place, to a millionth of their extent.
///
/// The centre of the circle through three of them is a + (|u|² v − |v|² u) × (u × v) / 2|u × v|², with u and v from a to the others
/// (in the order of the formula of the circumcentre).
fn is_plain(points: &[[f64; 3]]) -> bool {
    let difference = |a: &[f64; 3], b: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| a[i] - b[i]) };
    let cross = |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let Some(a) = points.first() else { return true };
    let far = |from: &dyn Fn(&[f64; 3]) -> f64| points.iter().copied().max_by(|p, q| from(p).total_cmp(&from(q))).unwrap_or(*a);
    let b = far(&|p| dot(difference(p, a), difference(p, a)));
    let u = difference(&b, a);
    let c = far(&|p| {
        let n = cross(u, difference(p, a));
        dot(n, n)
    });
    let v = difference(&c, a);
    let (n, size) = (cross(u, v), dot(u, u).sqrt());
    let flat = dot(n, n).sqrt();
    if flat <= 1e-6 * size * size {
        return true;
    }
    let [uu, vv] = [dot(u, u), dot(v, v)];
    let mixed: [f64; 3] = std::array::from_fn(|i| uu * v[i] - vv * u[i]);
    let to_center = cross(mixed, n).map(|x| x / (2.0 * flat * flat));
    let radius = dot(to_center, to_center).sqrt();
    points.iter().all(|p| {
        let d = difference(p, a);
        let r = difference(&d, &to_center);
        (dot(r, r).sqrt() - radius).abs() <= 1e-6 * size && (dot(d, n) / flat).abs() <= 1e-6 * size
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_and_lines_are_plain() {
        let along = |f: &dyn Fn(f64) -> [f64; 3]| (0..40).map(|i| f(0.1 * f64::from(i))).collect::<Vec<_>>();
        assert!(is_plain(&along(&|t| [2.0 + 3.0 * t.cos(), 3.0 * t.sin(), 1.0])));
        assert!(is_plain(&along(&|t| [0.0, 2.0 + t.cos(), 5.0 + t.sin()])));
        assert!(is_plain(&along(&|t| [t, 2.0 * t, 0.0])));
        assert!(is_plain(&along(&|_| [1.0; 3])) && is_plain(&[]));
        assert!(!is_plain(&along(&|t| [2.0 * t.cos(), t.sin(), 0.0])));
        assert!(!is_plain(&along(&|t| [t.cos(), t.sin(), 0.1 * t])));
    }
}
