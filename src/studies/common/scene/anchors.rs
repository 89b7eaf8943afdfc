//! Springs and couplings over an expression of the coordinates of points: between which places they act.
//!
//! The stretch s of a spring from an anchor c is s = |p − c| − l, of which |∇s| = 1 and ∇∇s = (1 − n nᵀ)/|p − c| with n = ∇s. So the
//! curvature across n tells how far away c is; without any, s is measured from a line or plane, as that of a tyre on its road.

use super::places::{numbers, place, reaches};
use crate::expression::{Id, Pool};
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use crate::model::{PointRef, Quantity};
use crate::results::Scene;
use crate::results::scene::Place;
use crate::studies::common::case::Case;

/// Shortest spring to the ground, as part of the size of the mechanism.
const SHORTEST: f64 = 0.1;
/// Steps of differences, as part of the size.
const STEP: f64 = 1e-4;
/// Farthest anchor, in sizes of the mechanism.
const FARTHEST: f64 = 20.0;
/// How well the stretch of an anchor agrees with that of the expression, as part of 1.
const AGREES: f64 = 1e-4;
/// Most frames at which the direction of a stretch is looked at.
const LOOKS: usize = 500;
/// How far a point may go along the ground, in sizes of the mechanism.
const AWAY: f64 = 1.5;

/// A stretch over places of a point.
struct Stretch<'a, G: Space<S = f64>> {
    pool: Pool,
    id: Id,
    /// 1, or −1 for one that is shorter at a greater distance.
    sign: f64,
    /// The points, with their places.
    points: Vec<(PointRef, [f64; 3])>,
    case: Case<'a>,
    mechanism: &'a Mechanism<G>,
}

impl<G: Space<S = f64>> Stretch<'_, G> {
    /// At a place of its last point at time 0.
    fn at(&mut self, p: [f64; 3]) -> f64 {
        let last = self.points.len() - 1;
        self.points[last].1 = p;
        for (input, quantity) in self.case.model.inputs.iter().enumerate() {
            match quantity {
                Quantity::Point { at, axis, order: 0 } => {
                    if let Some((_, p)) = self.points.iter().find(|(point, _)| point == at) {
                        self.pool.give(input as u32, p[*axis]);
                    }
                }
                Quantity::Time => self.pool.give(input as u32, 0.0),
                _ => {}
            }
        }
        self.sign * self.pool.values_with_tables(&[self.id], self.case.parameters, &self.mechanism.tables)[0]
    }

    /// Its gradient, by differences over a step, m.
    fn gradient(&mut self, p: [f64; 3], step: f64) -> [f64; 3] {
        let mut beside = |i: usize, sign: f64| {
            let mut p = p;
            p[i] += sign * step;
            self.at(p)
        };
        std::array::from_fn(|i| if i < G::VECTOR { (beside(i, 1.0) - beside(i, -1.0)) / (2.0 * step) } else { 0.0 })
    }

    /// The place that the stretch is the distance to but for a constant, near a place p with the unit gradient n; none if there is no such.
    fn anchor(&mut self, p: [f64; 3], n: [f64; 3], size: f64) -> Option<[f64; 3]> {
        let step = STEP * size;
        let across = across(n);
        let mut curvature = |e: &[f64; 3]| {
            let far = 10.0 * step;
            let [ahead, behind] = [far, -far].map(|x| self.gradient(moved(p, *e, x), step));
            (dot(ahead, *e) - dot(behind, *e)) / (2.0 * far)
        };
        let most = across[..G::VECTOR - 1].iter().map(&mut curvature).fold(0.0, f64::max);
        let radius = most.recip();
        if radius > FARTHEST * size {
            return None;
        }
        let anchor = moved(p, n, -radius);
        let own = self.at(p) - radius;
        // also far beside and beyond, where a curved road is no circle
        let looks = [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.4, -0.5)];
        let agrees = looks.into_iter().all(|(aside, along)| {
            let q = moved(moved(p, across[0], aside * radius), n, along * radius);
            let to: [f64; 3] = std::array::from_fn(|i| q[i] - anchor[i]);
            // about an axis in space, on which every place would do
            let distance = if G::VECTOR == 2 { dot(to, to) } else { dot(to, n).powi(2) + dot(to, across[0]).powi(2) }.sqrt();
            (self.at(q) - distance - own).abs() <= AGREES * radius
        });
        agrees.then_some(anchor)
    }
}

/// From the ground to a point by the coordinates of which a spring is stretched: from the place that the stretch is the distance to, else from
/// where it is measured, as far below its least as the body reaches, and along the ground with the point, if its direction (which is given,
/// too) is the same everywhere; none if it is not and the point goes far along the ground.
pub(super) fn to_ground<G: Space<S = f64>>(
    case: Case<'_>,
    mechanism: &Mechanism<G>,
    scene: &Scene,
    id: Id,
    point: PointRef,
) -> Option<([Place; 2], Vec<f64>)> {
    let (body, at) = (point.body, mechanism.bodies[point.body].points[point.point].1);
    let (end, size) = (place::<G>((body, at)), mechanism.size());
    let places = || (0..scene.frames.count()).map(|i| scene.world(scene.frame(i), &end)).filter(|p| p.iter().all(|x| x.is_finite()));
    let first = places().next()?;
    let mut stretch = Stretch { pool: case.model.pool.clone(), id, sign: 1.0, points: vec![(point, first)], case, mechanism };
    let gradient = stretch.gradient(first, STEP * size);
    let length = dot(gradient, gradient).sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let n = gradient.map(|x| x / length);
    let unit = (length - 1.0).abs() <= 1e-6;
    let mut direction = Vec::new();
    let foot = if let Some(anchor) = unit.then(|| stretch.anchor(first, n, size)).flatten() {
        anchor
    } else {
        let along = |p: [f64; 3]| dot(p, n) - dot(first, n);
        let below = reaches(mechanism)[body].max(SHORTEST * size);
        let foot = moved(first, n, places().map(along).fold(0.0, f64::min) - below);
        let aside = |p: [f64; 3]| {
            let way: [f64; 3] = std::array::from_fn(|i| p[i] - first[i]);
            (dot(way, way) - dot(way, n).powi(2)).max(0.0).sqrt()
        };
        let turned = |g: [f64; 3]| (dot(g, n) - dot(g, g).sqrt()).abs() > AGREES * dot(g, g).sqrt();
        let some = places().step_by(1 + scene.frames.count() / LOOKS);
        if !some.into_iter().any(|p| turned(stretch.gradient(p, STEP * size))) {
            direction = n[..G::VECTOR].to_vec();
        } else if places().map(aside).fold(0.0, f64::max) > AWAY * size {
            return None;
        }
        foot
    };
    Some(([Place { body: 0, at: foot[..G::VECTOR].to_vec() }, Place { body, at: numbers::<G>(at) }], direction))
}

/// The ends of an expression that is the distance of a point from another one, or from a place on the ground, but for what it takes off
/// from that over time, or minus that, with its sign; none for any other.
pub(super) fn distance<G: Space<S = f64>>(
    case: Case<'_>,
    mechanism: &Mechanism<G>,
    scene: &Scene,
    id: Id,
    points: &[PointRef],
) -> Option<([Place; 2], f64)> {
    let ends: Vec<Place> = points.iter().map(|p| place::<G>((p.body, mechanism.bodies[p.body].points[p.point].1))).collect();
    let places: Vec<[f64; 3]> = ends.iter().map(|end| scene.world(scene.frame(0), end)).collect();
    let (size, last) = (mechanism.size(), *places.last()?);
    [1.0, -1.0].into_iter().find_map(|sign| {
        let points = points.iter().copied().zip(places.iter().copied()).collect();
        let mut stretch = Stretch { pool: case.model.pool.clone(), id, sign, points, case, mechanism };
        let gradient = stretch.gradient(last, STEP * size);
        let length = dot(gradient, gradient).sqrt();
        if length.is_nan() || (length - 1.0).abs() > 1e-6 {
            return None;
        }
        let found = stretch.anchor(last, gradient.map(|x| x / length), size)?;
        match &ends[..] {
            [end] => Some(([Place { body: 0, at: found[..G::VECTOR].to_vec() }, end.clone()], sign)),
            [from, to] => {
                let apart: [f64; 3] = std::array::from_fn(|i| found[i] - places[0][i]);
                (dot(apart, apart).sqrt() <= AGREES * size).then(|| ([from.clone(), to.clone()], sign))
            }
            _ => None,
        }
    })
}

/// Unit directions across one; the first in the plane.
fn across(n: [f64; 3]) -> [[f64; 3]; 2] {
    let flat = n[0].hypot(n[1]);
    let first = if flat > 0.5 { [-n[1] / flat, n[0] / flat, 0.0] } else { [1.0, 0.0, 0.0] };
    let first = moved(first, n, -dot(first, n));
    let first = first.map(|x| x / dot(first, first).sqrt());
    [first, std::array::from_fn(|i| n[(i + 1) % 3] * first[(i + 2) % 3] - n[(i + 2) % 3] * first[(i + 1) % 3])]
}

fn moved(p: [f64; 3], along: [f64; 3], by: f64) -> [f64; 3] {
    std::array::from_fn(|i| p[i] + by * along[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}
