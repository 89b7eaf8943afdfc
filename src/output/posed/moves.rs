//! How bodies have moved from rest, in the picture.

use super::Posed;
use super::traces::{rotation, size};
use crate::output::pose::Move;
use crate::output::view::dot;
use crate::results::scene::{Place, Shape};
use std::f64::consts::TAU;

/// The shortest way that has an arrow, as part of the size of what is seen of joints.
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
        let size = size(self.scene);
        let seen = SEEN * if size > 0.0 { size } else { 1.0 };
        let near = 0.1 * seen;
        let mut joints: Vec<Vec<Way>> = vec![Vec::new(); self.scene.bodies.len()];
        let mut all = Vec::new();
        for joint in &self.scene.joints {
            // the points of both bodies, of a slide only that which slides
            let mut ways = Vec::new();
            for place in [&joint.a, &joint.b].into_iter().skip(usize::from(joint.stroke.is_some())) {
                let way = way(place);
                joints[place.body].push(way);
                add(&mut ways, way, near);
            }
            all.append(&mut ways);
        }
        let mut turns = Vec::new();
        for (body, joints) in joints.iter().enumerate().skip(1) {
            let [marked, corners] = self.places_of(body).map(|places| places.iter().map(way).collect::<Vec<_>>());
            let mut found = Vec::new();
            for way in joints {
                add(&mut found, *way, near);
            }
            for &way in &marked {
                if add(&mut found, way, near) {
                    all.push(way);
                }
            }
            if found.len() < 2 {
                let shift = |[from, to]: &Way| std::array::from_fn(|i| to[i] - from[i]);
                let known: [f64; 3] = found.first().map(shift).unwrap_or_default();
                let apart = |way: &Way| length(&[known, shift(way)]);
                let other = corners.into_iter().max_by(|a, b| apart(a).total_cmp(&apart(b)));
                let other = other.filter(|way| apart(way) >= OTHERWISE * length(&[[0.0; 3], known]));
                found.extend(other);
                all.extend(other);
            }
            let pose = (body - 1) * self.scene.stride()..body * self.scene.stride();
            let [from, to] = [rest, poses].map(|poses| poses.get(pose.clone()).unwrap_or_default());
            let turn = rotation(from, to);
            if dot(turn, turn).sqrt() >= TURNED && found.iter().all(|way| length(way) < seen) {
                let origin = || way(&Place { body, at: vec![0.0; self.scene.dimensions] });
                let about = joints.first().or(marked.first()).copied().unwrap_or_else(origin);
                turns.push(self.turned(about[1], turn));
            }
        }
        let shift = |way: Way| {
            let [from, to] = way.map(|at| self.view.flat(at));
            Move::Shift { from, to }
        };
        all.into_iter().filter(|way| length(way) >= seen).map(shift).chain(turns).collect()
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

    /// A turn about a place.
    fn turned(&self, at: [f64; 3], turn: [f64; 3]) -> Move {
        let at = self.view.flat(at);
        if self.scene.dimensions == 2 {
            return Move::Turn { at, across: [[1.0, 0.0], [0.0, turn[2].signum()]] };
        }
        Move::Turn { at, across: self.view.facing(turn, 0.75 * TAU).map(|e| self.view.flat(e)) }
    }
}

/// Adds a way to others, but for one that is there; whether it is new.
fn add(ways: &mut Vec<Way>, way: Way, near: f64) -> bool {
    let new = !ways.iter().any(|other| (0..2).all(|k| length(&[other[k], way[k]]) < near));
    if new {
        ways.push(way);
    }
    new
}

fn length([from, to]: &Way) -> f64 {
    (0..3).map(|i| (to[i] - from[i]).powi(2)).sum::<f64>().sqrt()
}
