//! Solids as triangles: boxes, round bars, balls, prisms over an outline.

use super::mesh::{Mesh, V, length, minus, plus};
use crate::output::view::across;
use std::f64::consts::{PI, TAU};

/// Faces around something round, around a wire, and along one of its coils.
const AROUND: usize = 24;
const WIRE: usize = 6;
const TURN: usize = 20;

/// An outline in the plane.
pub(super) type Outline = Vec<[f64; 2]>;

impl Mesh {
    /// A box along the axes.
    pub(super) fn cuboid(&mut self, center: V, size: V) {
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for side in [-1.0, 1.0] {
                let corner = |s: f64, t: f64| {
                    let mut p = center;
                    p[axis] += side * 0.5 * size[axis];
                    p[u] += side * s * 0.5 * size[u];
                    p[v] += t * 0.5 * size[v];
                    p
                };
                self.face(&[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
            }
        }
    }

    /// A round bar between two different places.
    pub(super) fn tube(&mut self, from: V, to: V, radius: f64) {
        let axis = minus(to, from);
        if length(axis).is_nan() || length(axis) <= 0.0 || radius.is_nan() || radius <= 0.0 {
            return;
        }
        let [u, v] = across(axis);
        let around = |k: usize| {
            let (s, c) = (TAU * (k % AROUND) as f64 / AROUND as f64).sin_cos();
            std::array::from_fn(|i| c * u[i] + s * v[i])
        };
        let at = |center: V, k: usize| plus(center, radius, around(k));
        for k in 0..AROUND {
            let (n, m) = (around(k), around(k + 1));
            self.curved(&[at(from, k), at(from, k + 1), at(to, k + 1), at(to, k)], &[n, m, m, n]);
        }
        self.face(&(0..AROUND).map(|k| at(to, k)).collect::<Vec<_>>());
        self.face(&(0..AROUND).rev().map(|k| at(from, k)).collect::<Vec<_>>());
    }

    /// A wire wound about z from 0 to 1 m, with so many coils.
    pub(super) fn coil(&mut self, coils: usize, radius: f64, wire: f64) {
        let steps = coils * TURN;
        let place = |k: usize| {
            let (s, c) = (TAU * k as f64 / TURN as f64).sin_cos();
            ([c, s, 0.0], [radius * c, radius * s, k as f64 / steps as f64])
        };
        // across the wire: outwards, and along z, as its slope is small
        let normal = |k: usize, side: usize| {
            let (out, _) = place(k);
            let (s, c) = (TAU * (side % WIRE) as f64 / WIRE as f64).sin_cos();
            [c * out[0], c * out[1], s]
        };
        let at = |k: usize, side: usize| plus(place(k).1, wire, normal(k, side));
        for k in 0..steps {
            for side in 0..WIRE {
                let corners = [(k, side), (k + 1, side), (k + 1, side + 1), (k, side + 1)];
                self.curved(&corners.map(|(k, side)| at(k, side)), &corners.map(|(k, side)| normal(k, side)));
            }
        }
    }

    /// A ball.
    pub(super) fn ball(&mut self, center: V, radius: f64) {
        if radius.is_nan() || radius <= 0.0 {
            return;
        }
        let rings = AROUND / 2;
        let normal = |ring: usize, k: usize| {
            let (polar, azimuth) = (PI * ring as f64 / rings as f64, TAU * (k % AROUND) as f64 / AROUND as f64);
            [polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos()]
        };
        for ring in 0..rings {
            for k in 0..AROUND {
                let mut normals = vec![normal(ring, k), normal(ring + 1, k), normal(ring + 1, k + 1), normal(ring, k + 1)];
                // at the poles two corners are one
                if ring == 0 {
                    normals.pop();
                } else if ring + 1 == rings {
                    normals.remove(2);
                }
                let corners: Vec<V> = normals.iter().map(|n| plus(center, radius, *n)).collect();
                self.curved(&corners, &normals);
            }
        }
    }

    /// What stands over an outline between two heights.
    pub(super) fn prism(&mut self, outline: &[[f64; 2]], [low, high]: [f64; 2]) {
        let mut outline: Outline = outline.iter().filter(|p| p.iter().all(|x| x.is_finite())).copied().collect();
        outline.dedup();
        if outline.len() > 1 && outline.first() == outline.last() {
            outline.pop();
        }
        if outline.len() < 3 {
            return;
        }
        if area(&outline) < 0.0 {
            outline.reverse();
        }
        for triangle in triangles(&outline) {
            let [a, b, c] = triangle.map(|k| outline[k]);
            self.face(&[[a[0], a[1], high], [b[0], b[1], high], [c[0], c[1], high]]);
            self.face(&[[a[0], a[1], low], [c[0], c[1], low], [b[0], b[1], low]]);
        }
        for (k, a) in outline.iter().enumerate() {
            let b = outline[(k + 1) % outline.len()];
            self.face(&[[a[0], a[1], low], [b[0], b[1], low], [b[0], b[1], high], [a[0], a[1], high]]);
        }
    }
}

/// Twice the area of an outline, positive if it is counter-clockwise.
fn area(outline: &[[f64; 2]]) -> f64 {
    outline.iter().zip(outline.iter().cycle().skip(1)).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

/// Triangles of a counter-clockwise outline, by cutting off ears.
fn triangles(outline: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let turn = |a: usize, b: usize, c: usize| area(&[outline[a], outline[b], outline[c]]);
    let mut left: Vec<usize> = (0..outline.len()).collect();
    let mut found = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n).find(|k| {
            let [a, b, c] = [left[(k + n - 1) % n], left[*k], left[(k + 1) % n]];
            let within = |p: &usize| turn(a, b, *p) > 0.0 && turn(b, c, *p) > 0.0 && turn(c, a, *p) > 0.0;
            turn(a, b, c) > 0.0 && !left.iter().any(within)
        });
        // an outline that crosses itself has none at last
        let k = ear.unwrap_or(0);
        found.push([left[(k + n - 1) % n], left[k], left[(k + 1) % n]]);
        left.remove(k);
    }
    found.extend(<[usize; 3]>::try_from(left));
    found.retain(|[a, b, c]| turn(*a, *b, *c) > 0.0);
    found
}

/// The outline at a distance around a convex one that is counter-clockwise, a line, or a point.
pub(super) fn around(convex: &[[f64; 2]], distance: f64) -> Outline {
    let n = convex.len();
    if n == 1 {
        return arc(convex[0], distance, 0.0, TAU * (1.0 - 1.0 / AROUND as f64));
    }
    let outwards = |k: usize| {
        let (a, b) = (convex[k % n], convex[(k + 1) % n]);
        (b[1] - a[1]).atan2(b[0] - a[0]) - 0.5 * PI
    };
    let corner = |k: usize| {
        let (from, to) = (outwards(k + n - 1), outwards(k));
        arc(convex[k], distance, from, (to - from).rem_euclid(TAU))
    };
    (0..n).flat_map(corner).collect()
}

fn arc(center: [f64; 2], radius: f64, from: f64, turn: f64) -> Outline {
    let steps = (turn / TAU * AROUND as f64).ceil().max(1.0) as usize;
    let at = |k: usize| {
        let (s, c) = (from + turn * k as f64 / steps as f64).sin_cos();
        [center[0] + radius * c, center[1] + radius * s]
    };
    (0..=steps).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::gltf::mesh::cross;

    /// The volume within the triangles of a closed mesh.
    fn volume(mesh: &Mesh) -> f64 {
        let p = |i: u32| mesh.positions[i as usize];
        let triangle = |t: &[u32]| {
            let [a, b, c] = [p(t[0]), p(t[1]), p(t[2])];
            let n = cross(b, c);
            (a[0] * n[0] + a[1] * n[1] + a[2] * n[2]) / 6.0
        };
        mesh.indices.chunks_exact(3).map(triangle).sum()
    }

    fn of(build: impl Fn(&mut Mesh)) -> Mesh {
        let mut mesh = Mesh::default();
        build(&mut mesh);
        assert!(mesh.normals.iter().all(|n| (length(*n) - 1.0).abs() < 1e-9));
        mesh
    }

    #[test]
    fn solids_are_closed_and_turned_outwards() {
        assert!((volume(&of(|m| m.cuboid([1.0, 2.0, 3.0], [2.0, 3.0, 4.0]))) - 24.0).abs() < 1e-9);
        let tube = volume(&of(|m| m.tube([1.0, 0.0, 0.0], [1.0, 2.0, 2.0], 0.5)));
        assert!((tube / (PI * 0.25 * 8.0_f64.sqrt()) - 1.0).abs() < 0.02, "{tube}");
        let ball = volume(&of(|m| m.ball([0.0, 5.0, 0.0], 2.0)));
        assert!((ball / (4.0 / 3.0 * PI * 8.0) - 1.0).abs() < 0.05, "{ball}");
    }

    #[test]
    fn an_outline_may_be_hollow() {
        let corner = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        for outline in [corner.to_vec(), corner.iter().rev().copied().collect()] {
            assert!((volume(&of(|m| m.prism(&outline, [-1.0, 1.0]))) - 10.0).abs() < 1e-9);
        }
    }

    #[test]
    fn bars_have_round_ends() {
        let bar = around(&[[0.0, 0.0], [4.0, 0.0]], 1.0);
        assert!((0.5 * area(&bar) / (8.0 + PI) - 1.0).abs() < 0.01);
        let plate = around(&[[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]], 1.0);
        assert!((0.5 * area(&plate) / (6.0 + 12.0 + PI) - 1.0).abs() < 0.01);
    }
}
