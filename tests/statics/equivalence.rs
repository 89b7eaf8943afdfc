//! The same mechanism in the plane and in space, and bodies that turn freely.

use super::{all_are, list, near, planar, rest, sorted};
use grashof::studies::common::outcome::Outcome;

const G: f64 = 9.81;

fn spatial(entries: &str, scalars: &str) -> Outcome {
    rest(&format!(
        "grashof: 1\nname: test\nspace: spatial\ngravity: [0, 0, -9.81 m/s^2]\n{entries}\nstudies:\n  rest: {{ statics: {{ from: start }}, scalars: {{ {scalars} }} }}\n"
    ))
}

#[test]
fn planar_and_spatial_linkages_rest_alike() {
    let entries = |ground: &str, axis: &str| {
        format!(
            "ground: {ground}
bodies:
  crank: {{ bar: {{ length: 0.3 m, mass: 1 kg }} }}
  coupler: {{ bar: {{ length: 0.5 m, mass: 2 kg }} }}
  rocker: {{ bar: {{ length: 0.45 m, mass: 1.5 kg }} }}
joints:
  O: {{ revolute: [ground.O, crank.start]{axis} }}
  A: {{ revolute: [crank.end, coupler.start]{axis} }}
  B: {{ revolute: [coupler.end, rocker.end]{axis} }}
  C: {{ revolute: [ground.C, rocker.start]{axis} }}
springs: {{ s: {{ between: [ground.post, crank.end], stiffness: 40 N/m, length: 0.2 m }} }}
start: {{ O.angle: 60 deg, A.angle: ~-30 deg, C.angle: ~80 deg }}"
        )
    };
    let flat = planar("[0, -9.81 m/s^2]", &entries("{ O: [0, 0], C: [0.6 m, 0], post: [-0.2 m, 0.5 m] }", ""), "");
    // in the x-z plane, with axes towards −y; the loop has three rows too many
    let space = spatial(&entries("{ O: [0, 0, 0], C: [0.6 m, 0, 0], post: [-0.2 m, 0, 0.5 m] }", ", axis: [0, -1, 0]"), "");
    let (flat, space) = (sorted(&flat, "O.angle"), sorted(&space, "O.angle"));
    assert!(flat.len() >= 2);
    all_are(&space, &flat, 1e-8);
}

#[test]
fn a_top_hangs_and_stands() {
    // a body on a ball joint, its centre of mass 20 cm along z of the body
    let top = |start: &str| {
        spatial(
            &format!(
                "bodies: {{ top: {{ mass: 2 kg, com: [0, 0, 0.2 m], inertia: [0.02 kg m^2, 0.03 kg m^2, 0.04 kg m^2] }} }}
joints: {{ P: {{ spherical: [ground, top.origin] }} }}
start: {{ {start} }}"
            ),
            "height: last(com.z), weight: last(P.fz)",
        )
    };
    let fallen = top("top.rotation: { axis: [1, 2, 0.5], angle: 40 deg }");
    near(fallen.scalars[0], -0.2, 1e-12);
    near(fallen.scalars[1], 2.0 * G, 1e-11);
    // it still turns about the vertical
    assert_eq!(fallen.results, [0.0]);
    let code = fallen.findings.iter().find(|f| f.code == "equilibrium").map(|f| f.message.clone()).unwrap_or_default();
    assert!(code.contains("indifferent"), "{code}");
}

/// A plate on a ball joint above its middle, hung on three springs; in a plane of symmetry it is a planar pendulum with two springs
/// whose one pulls twice.
#[test]
fn a_body_on_three_springs() {
    let springs = |height: f64, lean: f64| {
        spatial(
            &format!(
                "ground: {{ A: [1 m, 0, {height} m], B: [-0.5 m, 0.8 m, {height} m], C: [-0.5 m, -0.8 m, {height} m] }}
bodies:
  plate: {{ box: {{ size: [1 m, 1 m, 10 cm], mass: 4 kg }}, points: {{ A: [1 m, 0, 0], B: [-0.5 m, 0.8 m, 0], C: [-0.5 m, -0.8 m, 0], top: [0, 0, 0.3 m] }} }}
joints: {{ P: {{ spherical: [ground, plate.top] }} }}
springs:
  a: {{ between: [ground.A, plate.A], stiffness: 50 N/m, length: {lean} m }}
  b: {{ between: [ground.B, plate.B], stiffness: 50 N/m, length: 0.4 m }}
  c: {{ between: [ground.C, plate.C], stiffness: 50 N/m, length: 0.4 m }}
start: {{ plate.rotation: {{ axis: [1, 2, 3], angle: 12 deg }} }}"
            ),
            "x: last(com.x), y: last(com.y), z: last(com.z)",
        )
    };
    let flat = |height: f64, lean: f64| {
        planar(
            "[0, -9.81 m/s^2]",
            &format!(
                "ground: {{ A: [1 m, {height} m], B: [-0.5 m, {height} m] }}
bodies: {{ plate: {{ mass: 4 kg, inertia: 1 kg m^2, points: {{ A: [1 m, 0], B: [-0.5 m, 0], top: [0, 0.3 m] }} }} }}
joints: {{ P: {{ revolute: [ground, plate.top] }} }}
springs: {{ a: {{ between: [ground.A, plate.A], stiffness: 50 N/m, length: {lean} m }}, b: {{ between: [ground.B, plate.B], stiffness: 100 N/m, length: 0.4 m }} }}
start: {{ P.angle: 8 deg }}"
            ),
            "x: last(com.x), y: last(com.y)",
        )
    };
    for lean in [0.4, 0.1, 0.5] {
        let (space, plane) = (springs(0.2, lean), flat(0.2, lean));
        near(space.scalars[0], plane.scalars[0], 1e-9);
        near(space.scalars[1], 0.0, 1e-9);
        near(space.scalars[2], plane.scalars[1], 1e-9);
        assert_eq!((space.results[0], plane.results[0]), (1.0, 1.0), "{lean}");
        assert_eq!(list(&space, "equilibria.stable")[0], 1.0);
    }
}

#[test]
fn a_lid_hangs_on_two_hinges() {
    // every row of the second hinge is redundant: the hinges bear the weight together, and the lid is held by a torsion spring
    let outcome = spatial(
        "ground: { L: [0, 0, 0], R: [0, 0.6 m, 0] }
bodies: { lid: { box: { size: [0.4 m, 0.6 m, 2 cm], mass: 3 kg }, points: { L: [-0.2 m, -0.3 m, 0], R: [-0.2 m, 0.3 m, 0] } } }
joints:
  left: { revolute: [ground.L, lid.L], axis: [0, 1, 0] }
  right: { revolute: [ground.R, lid.R], axis: [0, 1, 0] }
springs: { s: { joint: left, stiffness: 2 N m/rad, rest: -100 deg } }
start: { left.angle: -30 deg }",
        "weight: last(left.fz) + last(right.fz), angle: last(left.angle)",
    );
    // positive angles sink: m g a cos φ = k (φ − φ0)
    let wanted = super::zero(|x| 3.0 * G * 0.2 * x.cos() - 2.0 * (x + 100_f64.to_radians()), 0.0, 1.5);
    near(outcome.scalars[1], wanted, 1e-11);
    near(outcome.scalars[0], 3.0 * G, 1e-9);
    assert_eq!(outcome.results, [1.0]);
}

/// A chain with any of its joints cut hangs as it does on the tree.
#[test]
fn cut_chains_hang_straight() {
    for cut in ["Q", "R", "P"] {
        let joint =
            |name: &str, between: &str| format!("{name}: {{ revolute: [{between}]{} }}", if name == cut { ", cut: true" } else { "" });
        let found = planar(
            "[0, -9.81 m/s^2]",
            &format!(
                "bodies: {{ a: {{ bar: {{ length: 1 m, mass: 1 kg }} }}, b: {{ bar: {{ length: 1 m, mass: 1 kg }} }}, c: {{ bar: {{ length: 0.5 m, mass: 2 kg }} }} }}
joints: {{ {}, {}, {} }}
start: {{ P.angle: -60 deg, b.angle: ~-50 deg, c.angle: ~-120 deg }}",
                joint("P", "ground, a.start"),
                joint("Q", "a.end, b.start"),
                joint("R", "b.end, c.start")
            ),
            "y: last(c.end.y), x: last(c.end.x), pull: last(P.fy)",
        );
        near(found.scalars[0], -2.5, 1e-12);
        near(found.scalars[1], 0.0, 1e-9);
        near(found.scalars[2], 4.0 * G, 1e-10);
        assert_eq!(found.results, [1.0]);
    }
}
