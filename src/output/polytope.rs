//! The faces of the convex hull of points in space.

use super::outlines::hull;
use super::view::{across, cross, dot};

/// Part of the extent of points that is no height.
const FLAT: f64 = 1e-6;
/// Points of which the hull is made at most; more are seen by their outline.
const MOST: usize = 400;

type V = [f64; 3];

fn minus(a: V, b: V) -> V {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Faces as corners, counter-clockwise seen from outside; of points in one plane both sides of their outline; none of points on one line,
/// of one place, and of very many.
pub(super) fn faces(points: &[V]) -> Vec<Vec<usize>> {
    if points.len() > MOST || !points.iter().flatten().all(|x| x.is_finite()) {
        return Vec::new();
    }
    let Some([a, b, c, d]) = apart(points) else { return Vec::new() };
    let size = length(minus(points[b], points[a]));
    let height = |[p, q, r]: [usize; 3], at: usize| {
        let normal = cross(minus(points[q], points[p]), minus(points[r], points[p]));
        dot(normal, minus(points[at], points[p])) / length(normal)
    };
    if height([a, b, c], d).abs() <= FLAT * size {
        let normal = cross(minus(points[b], points[a]), minus(points[c], points[a]));
        return [normal, normal.map(|x| -x)].into_iter().map(|normal| around(points, 0..points.len(), normal)).collect();
    }
    let [b, c] = if height([a, b, c], d) < 0.0 { [b, c] } else { [c, b] };
    let mut triangles = vec![[a, b, c], [a, d, b], [b, d, c], [c, d, a]];
    for at in (0..points.len()).filter(|at| ![a, b, c, d].contains(at)) {
        let (seen, hidden): (Vec<_>, Vec<_>) = triangles.iter().copied().partition(|t| height(*t, at) > FLAT * size);
        let edges: Vec<[usize; 2]> = seen.iter().flat_map(|[p, q, r]| [[*p, *q], [*q, *r], [*r, *p]]).collect();
        let rim = edges.iter().filter(|[p, q]| !edges.contains(&[*q, *p]));
        triangles = hidden.into_iter().chain(rim.map(|[p, q]| [*p, *q, at])).collect();
    }
    // triangles of one plane are one face
    let mut planes: Vec<[usize; 3]> = Vec::new();
    for [p, q, r] in triangles {
        let within = |plane: &[usize; 3]| [p, q, r].into_iter().all(|at| height(*plane, at).abs() <= 10.0 * FLAT * size);
        if length(cross(minus(points[q], points[p]), minus(points[r], points[p]))) > FLAT * size * size && !planes.iter().any(within) {
            planes.push([p, q, r]);
        }
    }
    let of_plane = |plane: &[usize; 3]| {
        let [p, q, r] = *plane;
        let on = (0..points.len()).filter(|at| height(*plane, *at).abs() <= 10.0 * FLAT * size);
        around(points, on, cross(minus(points[q], points[p]), minus(points[r], points[p])))
    };
    planes.iter().map(of_plane).collect()
}

/// Four points far from each other: two, the one farthest from their line, and the one farthest from the plane of these.
fn apart(points: &[V]) -> Option<[usize; 4]> {
    let farthest = |far: &dyn Fn(&V) -> f64| (0..points.len()).max_by(|i, k| far(&points[*i]).total_cmp(&far(&points[*k])));
    let first = *points.first()?;
    let a = farthest(&|p| length(minus(*p, first)))?;
    let b = farthest(&|p| length(minus(*p, points[a])))?;
    let along = minus(points[b], points[a]);
    let beside = |p: &V| length(cross(along, minus(*p, points[a])));
    let c = farthest(&beside)?;
    if beside(&points[c]) <= FLAT * dot(along, along) {
        return None;
    }
    let normal = cross(along, minus(points[c], points[a]));
    Some([a, b, c, farthest(&|p| dot(normal, minus(*p, points[a])).abs())?])
}

/// The corners of the outline of some points, counter-clockwise about a normal.
fn around(points: &[V], of: impl Iterator<Item = usize>, normal: V) -> Vec<usize> {
    let [u, v] = across(normal);
    let flat: Vec<([f64; 2], usize)> = of.map(|k| ([dot(u, points[k]), dot(v, points[k])], k)).collect();
    let corners = hull(&flat.iter().map(|(at, _)| *at).collect::<Vec<_>>());
    corners.iter().filter_map(|corner| flat.iter().find(|(at, _)| at == corner).map(|(_, k)| *k)).collect()
}

fn length(v: V) -> f64 {
    dot(v, v).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[V], face: &[usize]) -> V {
        (1..face.len() - 1).fold([0.0; 3], |sum, k| {
            let n = cross(minus(points[face[k]], points[face[0]]), minus(points[face[k + 1]], points[face[0]]));
            std::array::from_fn(|i| sum[i] + 0.5 * n[i])
        })
    }

    #[test]
    fn a_box_with_points_within_and_on_its_faces_has_six_faces_turned_outwards() {
        let mut points: Vec<V> = (0..8).map(|k| [f64::from(k & 1) * 2.0, f64::from(k >> 1 & 1) * 3.0, f64::from(k >> 2) * 4.0]).collect();
        points.splice(0..0, [[1.0, 1.0, 1.0], [1.0, 1.5, 4.0], [2.0, 1.0, 1.0], [1.0, 0.0, 0.0]]);
        let faces = faces(&points);
        assert_eq!((faces.len(), faces.iter().map(Vec::len).max()), (6, Some(4)), "{faces:?}");
        // volume by the divergence theorem
        let volume: f64 = faces.iter().map(|face| dot(area(&points, face), points[face[0]]) / 3.0).sum();
        assert!((volume - 24.0).abs() < 1e-12, "{volume}");
    }

    #[test]
    fn points_of_one_plane_have_two_faces_and_those_of_a_line_none() {
        let square: Vec<V> = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.5], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| [x, y, x + y]).to_vec();
        let two = faces(&square);
        assert_eq!(two.iter().map(Vec::len).collect::<Vec<_>>(), [4, 4]);
        assert!(dot(area(&square, &two[0]), area(&square, &two[1])) < 0.0);
        assert!(faces(&[[0.0; 3], [1.0; 3], [2.0; 3]]).is_empty() && faces(&[]).is_empty());
    }
}
