//! How bodies have moved from rest, in the picture.

use super::Posed;
use crate::output::pose::Move;
use crate::output::view::{cross, dot};
use crate::results::scene::{Place, Shape};
use std::f64::consts::TAU;

/// The shortest way that has an arrow, as part of how far joints are apart.
const SEEN: f64 = 0.015;
/// The smallest turn that has one, rad.
const TURNED: f64 = 0.05;
/// How far the way of a tip is from that of the joint or mass of its body at least, as part of that way.
const OTHERWISE: f64 = 0.2;

/// Where a place of a body was and where it is, m.
type Way = [[f64; 3]; 2];

impl Posed<'_> {
    /// What has moved from the poses at rest to the first position: joints, masses and the middles of what is round; of a body with one of
    /// these or none also the corner that has moved most otherwise; of what has only turned, how.
    pub(super) fn moves(&self, rest: &[f64]) -> Vec<Move> {
        let Some(&poses) = self.frames.first() else { return Vec::new() };
        let way = |place: &Place| [self.scene.world(rest, place), self.scene.world(poses, place)];
        let seen = SEEN * self.apart(rest);
        let mut shifts: Vec<Way> = Vec::new();
        let mut turns = Vec::new();
        for body in 1..self.scene.bodies.len() {
            let joints: Vec<Place> = self.joints_of(body).collect();
            let [marked, corners] = self.places_of(body);
            let mut found: Vec<Way> = Vec::new();
            joints.iter().chain(&marked).map(way).for_each(|way| add(&mut found, way, 0.1 * seen));
            if found.len() < 2 {
                let shift = |[from, to]: &Way| std::array::from_fn(|i| to[i] - from[i]);
                let known: [f64; 3] = found.first().map(shift).unwrap_or_default();
                let apart = |way: &Way| length(&[known, shift(way)]);
                let other = corners.iter().map(way).max_by(|a, b| apart(a).total_cmp(&apart(b)));
                found.extend(other.filter(|way| apart(way) >= OTHERWISE * length(&[[0.0; 3], known])));
            }
            found.retain(|way| length(way) >= seen);
            let turn = self.turn(body, [rest, poses]);
            if found.is_empty() && dot(turn, turn).sqrt() >= TURNED {
                let about = joints.first().or(marked.first()).cloned().unwrap_or(Place { body, at: vec![0.0; self.scene.dimensions] });
                turns.push(self.turned(way(&about)[1], turn));
            }
            found.into_iter().for_each(|way| add(&mut shifts, way, 0.1 * seen));
        }
        let shift = |way: Way| {
            let [from, to] = way.map(|at| self.view.flat(at));
            Move::Shift { from, to }
        };
        shifts.into_iter().map(shift).chain(turns).collect()
    }

    /// The points of the joints of a body, of a slide only that which slides.
    fn joints_of(&self, body: usize) -> impl Iterator<Item = Place> {
        let ends = self.scene.joints.iter().flat_map(|joint| [(joint.stroke.is_some(), &joint.a), (false, &joint.b)]);
        ends.filter(move |(guide, place)| !guide && place.body == body).map(|(_, place)| place.clone())
    }

    /// Masses and middles of what is round on a body, and its corners.
    fn places_of(&self, body: usize) -> [Vec<Place>; 2] {
        let [mut marked, mut corners] = [Vec::new(), Vec::new()];
        for shape in &self.scene.bodies[body].shapes {
            match shape {
                Shape::Mass { at, .. } => marked.push(at.clone()),
                Shape::Disc { center, .. } | Shape::Gear { center, .. } | Shape::Sphere { center, .. } => marked.push(center.clone()),
                Shape::Bar { from, to, .. } | Shape::Cylinder { from, to, .. } => corners.extend([from.clone(), to.clone()]),
                Shape::Hull { points } | Shape::Polygon { points } => corners.extend(points.iter().cloned()),
                Shape::Box { center, size } => {
                    let corner = |k: usize| (0..3).map(|i| center[i] + (if k >> i & 1 == 1 { 0.5 } else { -0.5 }) * size[i]).collect();
                    corners.extend((0..8).map(corner));
                }
            }
        }
        [marked, corners].map(|places| places.into_iter().map(|at| Place { body, at }).collect())
    }

    /// The diagonal of the room that joints take in some poses; 1 if that is a point, m.
    fn apart(&self, poses: &[f64]) -> f64 {
        let mut ends = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for joint in &self.scene.joints {
            let at = self.scene.world(poses, &joint.b);
            ends = [std::array::from_fn(|i| ends[0][i].min(at[i])), std::array::from_fn(|i| ends[1][i].max(at[i]))];
        }
        Some(length(&ends)).filter(|most| most.is_finite() && *most > 0.0).unwrap_or(1.0)
    }

    /// The turn of a body from one pose to another, rad, along its axis.
    fn turn(&self, body: usize, poses: [&[f64]; 2]) -> [f64; 3] {
        let stride = self.scene.stride();
        match poses.map(|poses| poses.get((body - 1) * stride..body * stride).unwrap_or_default()) {
            [&[_, _, from], &[_, _, to]] => [0.0, 0.0, to - from],
            [&[_, _, _, a, b, c, d], &[_, _, _, w, x, y, z]] => {
                // the quaternion after times the conjugate of the one before
                let (before, after) = ([b, c, d], [x, y, z]);
                let across = cross(before, after);
                let part: [f64; 3] = std::array::from_fn(|i| a * after[i] - w * before[i] + across[i]);
                let (sine, cosine) = (dot(part, part).sqrt(), a * w + dot(before, after));
                let angle = 2.0 * sine.atan2(cosine.abs()) * cosine.signum();
                if sine > 0.0 { part.map(|x| x * angle / sine) } else { [0.0; 3] }
            }
            _ => [0.0; 3],
        }
    }

    /// A turn about a place.
    fn turned(&self, at: [f64; 3], turn: [f64; 3]) -> Move {
        let at = self.view.flat(at);
        if self.scene.dimensions == 2 {
            return Move::Turn { at, across: [[1.0, 0.0], [0.0, turn[2].signum()]] };
        }
        Move::Turn { at, across: self.view.facing(turn, 0.75 * TAU).map(|e| self.view.flat(e)) }
    }
}

/// Adds a way to others, but for one that is there.
fn add(ways: &mut Vec<Way>, way: Way, near: f64) {
    if !ways.iter().any(|other| (0..2).all(|k| length(&[other[k], way[k]]) < near)) {
        ways.push(way);
    }
}

fn length([from, to]: &Way) -> f64 {
    (0..3).map(|i| (to[i] - from[i]).powi(2)).sum::<f64>().sqrt()
}
