//! Friction by a coefficient where rows are redundant: it follows the least reactions, which do not know how axes lie.

use super::{close, done, last};
use std::fmt::Write as _;

/// A direction of the plane in space: turned about three axes, or not at all.
fn placed(p: [f64; 2], angles: [f64; 3]) -> [f64; 3] {
    turned([p[0], p[1], 0.0], angles)
}

fn turned(p: [f64; 3], angles: [f64; 3]) -> [f64; 3] {
    (0..3).fold(p, |mut p, axis| {
        let (sin, cos) = angles[axis].sin_cos();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        (p[i], p[j]) = (cos * p[i] - sin * p[j], sin * p[i] + cos * p[j]);
        p
    })
}

/// A four-bar from the pose in which all angles are 0, with friction in its four pins: in the plane, or in space turned by `angles`.
fn four_bar(angles: Option<[f64; 3]>, study: &str) -> String {
    let list = |p: &[f64]| format!("[{}]", p.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", "));
    let at = |p: [f64; 2]| angles.map_or_else(|| list(&p), |angles| list(&placed(p, angles)));
    let (space, axis) = match angles {
        None => ("planar", String::new()),
        Some(angles) => ("spatial", format!(", axis: {}", list(&turned([0.0, 0.0, 1.0], angles)))),
    };
    let (a, b, c, d) = ([0.0, 0.0], [0.05, 0.08], [0.3, 0.2], [0.3, 0.0]);
    let mut text = format!(
        "grashof: 1\nname: four-bar with friction\nspace: {space}\ngravity: {}\nground: {{ A: {}, D: {} }}\nbodies:\n",
        at([0.0, -9.81]),
        at(a),
        at(d)
    );
    for (name, mass, from, to) in [("crank", 1.0, a, b), ("coupler", 2.0, b, c), ("rocker", 1.5, d, c)] {
        let way = [to[0] - from[0], to[1] - from[1]];
        let inertia = mass * (way[0] * way[0] + way[1] * way[1]) / 12.0;
        // the same about every axis, so that it is the same however the mechanism is turned
        let inertia = if angles.is_some() { list(&[inertia; 3]) } else { inertia.to_string() };
        let half = way.map(|x| x / 2.0);
        writeln!(text, "  {name}: {{ mass: {mass}, com: {}, inertia: {inertia}, points: {{ to: {} }} }}", at(half), at(way)).unwrap();
    }
    text += "joints:\n";
    let pins = [("A", "ground.A, crank"), ("B", "crank.to, coupler"), ("C", "coupler.to, rocker.to"), ("D", "ground.D, rocker")];
    for (name, pair) in pins {
        writeln!(text, "  {name}: {{ revolute: [{pair}]{axis}, friction: {{ coulomb: 0.2, radius: 1 cm }} }}").unwrap();
    }
    text + study
}

/// A turn about no special axis.
const TILT: [f64; 3] = [0.7, -1.1, 2.3];

#[test]
fn a_tilted_loop_moves_as_in_the_plane() {
    let study = |settings: &str| {
        format!(
            "drivers: {{}}\nstart: {{ A.angle: 0 rad, A.omega: 5 rad/s }}\nstudies:\n  it:\n    dynamics: {{ until: 80 ms, every: 20 ms, {settings} }}\n    columns: [A.angle, A.omega, B.angle, D.friction]\n"
        )
    };
    let plane = done(&four_bar(None, &study("tolerance: 1e-10")), "it");
    for (settings, within) in [
        ("tolerance: 1e-10", 1e-8),
        ("tolerance: 1e-10, coordinates: cartesian", 1e-8),
        ("tolerance: 1e-10, coordinates: minimal", 1e-8),
        ("integrator: radau5, tolerance: 1e-9", 1e-6),
        ("integrator: bdf, tolerance: 1e-9", 1e-5),
        ("integrator: newmark, step: 0.1 ms", 1e-4),
    ] {
        for angles in [[0.0; 3], TILT] {
            let space = done(&four_bar(Some(angles), &study(settings)), "it");
            for (k, (found, right)) in last(&space).iter().zip(last(&plane)).enumerate() {
                close(&format!("column {k}, {settings}, {angles:?}"), *found, *right, within * right.abs().max(1.0));
            }
        }
    }
}

#[test]
fn a_driven_tilted_loop_asks_for_the_torque_of_the_plane() {
    let study = "drivers: { turn: { joint: A, speed: 5 rad/s } }\nstart: { A.angle: 0 rad }\nstudies:\n  it:\n    inverse: { over: 1 turn, samples: 12 }\n    columns: [turn.torque, C.friction, D.friction]\n";
    let plane = done(&four_bar(None, study), "it");
    for angles in [[0.0; 3], TILT] {
        let space = done(&four_bar(Some(angles), study), "it");
        for (row, (found, right)) in space.rows.iter().zip(&plane.rows).enumerate() {
            for (k, (found, right)) in found.iter().zip(right).enumerate() {
                close(&format!("row {row}, column {k}, {angles:?}"), *found, *right, 1e-8 * right.abs().max(1.0));
            }
        }
    }
}

/// A slider-crank with friction at the rod's hinge and in the guide, in space turned by `angles`: its other hinges stand on the tree, so
/// that the rows of one force differ in size.
fn slider_crank(angles: [f64; 3]) -> String {
    let list = |p: [f64; 3]| format!("[{}]", turned(p, angles).map(|x| format!("{x:?}")).join(", "));
    let (to, end) = ([0.06, 0.08, 0.0], [0.06 + f64::sqrt(0.25 - 0.0064), 0.0, 0.0]);
    let rod = [end[0] - to[0], -to[1], 0.0];
    let half = |p: [f64; 3]| list(p.map(|x| x / 2.0));
    let axis = list([0.0, 0.0, 1.0]);
    format!(
        "grashof: 1
name: slider-crank with friction
space: spatial
gravity: {}
ground: {{ O: [0, 0, 0], S: {} }}
bodies:
  crank: {{ mass: 1, com: {}, inertia: 0.002, points: {{ to: {} }} }}
  rod: {{ mass: 2, com: {}, inertia: 0.04, points: {{ to: {} }} }}
  block: {{ mass: 3, inertia: 0.01 }}
joints:
  O: {{ revolute: [ground.O, crank], axis: {axis} }}
  B: {{ revolute: [crank.to, rod], axis: {axis}, friction: {{ coulomb: 0.3, radius: 2 cm }} }}
  C: {{ revolute: [rod.to, block.origin], axis: {axis} }}
  S: {{ slider: [ground.S, block.origin], axis: {}, friction: {{ coulomb: 0.1 }} }}
start: {{ O.angle: 0 rad, O.omega: 6 rad/s }}
studies:
  it:
    dynamics: {{ until: 0.5 s, every: 0.25 s, tolerance: 1e-11 }}
    columns: [O.angle, O.omega, B.friction, S.friction]
",
        list([3.0, -9.81, 0.0]),
        list(end),
        half(to),
        list(to),
        half(rod),
        list(rod),
        list([1.0, 0.0, 0.0]),
    )
}

#[test]
fn friction_does_not_know_how_axes_lie() {
    let level = done(&slider_crank([0.0; 3]), "it");
    for angles in [TILT, [-0.4, 0.9, 0.3]] {
        let tilted = done(&slider_crank(angles), "it");
        for (k, (found, right)) in last(&tilted).iter().zip(last(&level)).enumerate() {
            close(&format!("column {k}, {angles:?}"), *found, *right, 1e-8 * right.abs().max(1.0));
        }
    }
}
