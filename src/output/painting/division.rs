//! Pieces of shapes in space, from the farthest to the nearest: space is divided by the planes of the faces, and what lies on both
//! sides of one is cut there (Fuchs, Kedem and Naylor: On Visible Surface Generation by A Priori Tree Structures, SIGGRAPH 1980).

use crate::output::pose::Facet;
use crate::output::view::{cross, dot};

/// What is nearer to a plane than this part of the picture lies in it.
const THICKNESS: f64 = 1e-6;
/// Faces that are tried as the next plane.
const TRIED: usize = 12;
/// Cuts count as much as so many pieces that lie on one side more than on the other.
const CUT: usize = 8;
/// Pieces beyond which a picture is too much for this.
pub(super) const MOST: usize = 4000;

/// A part of a shape. One corner stands for a shape that is placed as a whole.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// The shape that it is of.
    pub(super) form: usize,
    /// How near the shape is, for those in one plane or without one.
    pub(super) depth: f64,
    pub(super) facet: Facet,
}

/// A plane: what is on the side towards the eye has a positive distance.
#[derive(Clone, Copy)]
struct Plane {
    normal: [f64; 3],
    offset: f64,
}

impl Plane {
    /// The plane of a face (Newell's normal); none of a line, or of a face that is seen from its side.
    fn of(corners: &[[f64; 3]]) -> Option<Self> {
        let first = *corners.first()?;
        let from = |p: [f64; 3]| std::array::from_fn(|i| p[i] - first[i]);
        let normal = corners.windows(2).fold([0.0; 3], |sum, ends| {
            let n = cross(from(ends[0]), from(ends[1]));
            std::array::from_fn(|i| sum[i] + n[i])
        });
        let length = dot(normal, normal).sqrt();
        let facing = if normal[2] < 0.0 { -length } else { length };
        let normal = normal.map(|x| x / facing);
        (normal[2] > THICKNESS).then(|| Self { normal, offset: dot(normal, first) })
    }

    fn distances(&self, corners: &[[f64; 3]]) -> Vec<f64> {
        corners.iter().map(|p| dot(self.normal, *p) - self.offset).collect()
    }
}

/// Where something lies beside a plane.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Behind,
    Within,
    Before,
    Across,
}

fn side(distances: &[f64], thickness: f64) -> Side {
    match (distances.iter().any(|s| *s < -thickness), distances.iter().any(|s| *s > thickness)) {
        (true, true) => Side::Across,
        (true, false) => Side::Behind,
        (false, true) => Side::Before,
        (false, false) => Side::Within,
    }
}

/// The part of a facet before a plane (`sign` 1) or behind it (−1). The cut is no edge of the shape.
fn part(facet: &Facet, distances: &[f64], sign: f64, thickness: f64) -> Facet {
    let count = facet.corners.len();
    let mut kept = Facet::default();
    // a line has one edge, a face one behind each corner
    for k in 0..count {
        let next = (k + 1) % count;
        let (here, there) = (sign * distances[k], sign * distances[next]);
        let edge = facet.edges.get(k).copied().unwrap_or(false);
        let stays = here >= -thickness;
        if stays {
            kept.corners.push(facet.corners[k]);
            kept.edges.push(edge && (here > thickness || there >= -thickness));
        }
        let crosses = here.abs() > thickness && there.abs() > thickness && (here > 0.0) != (there > 0.0);
        if crosses && (count > 2 || k == 0) {
            let (a, b, share) = (facet.corners[k], facet.corners[next], here / (here - there));
            kept.corners.push(std::array::from_fn(|i| a[i] + share * (b[i] - a[i])));
            kept.edges.push(edge && !stays);
        }
    }
    kept
}

/// The face whose plane cuts little and leaves as many pieces before it as behind it.
fn splitter(pieces: &[Piece], thickness: f64) -> Option<(usize, Plane)> {
    let faces: Vec<(usize, Plane)> =
        pieces.iter().enumerate().filter_map(|(k, piece)| Some((k, Plane::of(&piece.facet.corners)?))).collect();
    let tried = faces.iter().step_by(faces.len().div_ceil(TRIED).max(1));
    let cost = |plane: &Plane| {
        let (mut cuts, mut before, mut behind) = (0, 0_usize, 0_usize);
        for piece in pieces {
            match side(&plane.distances(&piece.facet.corners), thickness) {
                Side::Across => cuts += 1,
                Side::Before => before += 1,
                Side::Behind => behind += 1,
                Side::Within => {}
            }
        }
        CUT * cuts + before.abs_diff(behind)
    };
    tried.min_by_key(|(_, plane)| cost(plane)).copied()
}

/// Pieces, cut where they pierce each other, so that each hides nothing that comes after it; none if there are too many.
pub(super) fn divided(pieces: Vec<Piece>, size: f64) -> Option<Vec<Piece>> {
    enum Work {
        Divide(Vec<Piece>),
        Paint(Vec<Piece>),
    }
    let thickness = THICKNESS * size;
    let mut done: Vec<Piece> = Vec::new();
    let mut count = pieces.len();
    let mut work = vec![Work::Divide(pieces)];
    while let Some(next) = work.pop() {
        if count > MOST {
            return None;
        }
        let together = match next {
            Work::Paint(pieces) => pieces,
            Work::Divide(pieces) => {
                let Some((chosen, plane)) = splitter(&pieces, thickness) else {
                    work.push(Work::Paint(pieces));
                    continue;
                };
                let (mut behind, mut within, mut before) = (Vec::new(), Vec::new(), Vec::new());
                for (k, piece) in pieces.into_iter().enumerate() {
                    let distances = plane.distances(&piece.facet.corners);
                    match side(&distances, thickness) {
                        _ if k == chosen => within.push(piece),
                        Side::Behind => behind.push(piece),
                        Side::Before => before.push(piece),
                        // what is placed as a whole stands on the face
                        Side::Within if piece.facet.corners.len() == 1 => before.push(piece),
                        Side::Within => within.push(piece),
                        Side::Across => {
                            let [far, near] = [-1.0, 1.0].map(|sign| part(&piece.facet, &distances, sign, thickness));
                            behind.push(Piece { facet: far, ..piece.clone() });
                            before.push(Piece { facet: near, ..piece });
                            count += 1;
                        }
                    }
                }
                work.extend([Work::Divide(before), Work::Paint(within), Work::Divide(behind)]);
                continue;
            }
        };
        let begun = done.len();
        done.extend(together);
        done[begun..].sort_by(|a, b| a.depth.total_cmp(&b.depth));
    }
    Some(done)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face(form: usize, corners: &[[f64; 3]]) -> Piece {
        let facet = Facet { corners: corners.to_vec(), edges: vec![true; corners.len()] };
        Piece { form, depth: 0.0, facet }
    }

    fn area(corners: &[[f64; 3]]) -> f64 {
        let twice: f64 = (0..corners.len())
            .map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
                a[0] * b[1] - a[1] * b[0]
            })
            .sum();
        0.5 * twice.abs()
    }

    #[test]
    fn what_is_nearer_comes_later() {
        let level = |form, x: f64, z: f64| face(form, &[[x, 0.0, z], [x + 2.0, 0.0, z], [x + 2.0, 1.0, z], [x, 1.0, z]]);
        let order = |pieces| divided(pieces, 3.0).unwrap().iter().map(|piece| piece.form).collect::<Vec<_>>();
        assert_eq!(order(vec![level(0, 0.0, 2.0), level(1, 1.0, 0.0), level(2, 0.5, 1.0)]), [1, 2, 0]);
        // a large face that leans is nearer in the mean, but behind a small one before its far end
        let leaning = face(0, &[[0.0, 0.0, 9.0], [10.0, 0.0, -1.0], [10.0, 1.0, -1.0], [0.0, 1.0, 9.0]]);
        let small = face(1, &[[9.0, 0.2, 1.0], [9.9, 0.2, 1.0], [9.9, 0.8, 1.0], [9.0, 0.8, 1.0]]);
        assert_eq!(order(vec![leaning.clone(), small.clone()]), [0, 1]);
        assert_eq!(order(vec![small, leaning]), [0, 1]);
    }

    #[test]
    fn faces_that_pierce_each_other_are_cut_along_their_line() {
        let rising = face(0, &[[0.0, 0.0, -1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0], [0.0, 1.0, -1.0]]);
        let falling = face(1, &[[0.0, 0.0, 1.0], [2.0, 0.0, -1.0], [2.0, 1.0, -1.0], [0.0, 1.0, 1.0]]);
        let pieces = divided(vec![rising, falling], 2.0).unwrap();
        assert_eq!(pieces.iter().map(|piece| piece.form).collect::<Vec<_>>(), [1, 0, 1]);
        for piece in &pieces {
            let expected = if piece.form == 0 { 2.0 } else { 1.0 };
            assert!((area(&piece.facet.corners) - expected).abs() < 1e-12, "{piece:?}");
            // of the two halves three edges each are of the face
            let edges = piece.facet.edges.iter().filter(|edge| **edge).count();
            assert_eq!((piece.facet.edges.len(), edges), (4, if piece.form == 0 { 4 } else { 3 }), "{piece:?}");
        }
        // a bar through a face
        let bar = Piece { facet: Facet { corners: vec![[0.5, 0.5, -1.0], [0.7, 0.5, 3.0]], edges: vec![true] }, ..face(2, &[]) };
        let level = face(0, &[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
        let pieces = divided(vec![bar, level], 2.0).unwrap();
        assert_eq!(pieces.iter().map(|piece| piece.form).collect::<Vec<_>>(), [2, 0, 2]);
        let ends = |k: usize| &pieces[k].facet.corners;
        assert!(ends(0)[1] == ends(2)[0] && ends(0)[1][2].abs() < 1e-12 && (ends(0)[1][0] - 0.55).abs() < 1e-12, "{pieces:?}");
    }
}
