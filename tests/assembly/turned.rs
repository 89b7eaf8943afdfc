//! A body in space whose orientation follows from the joints on it stands as it is drawn where it can, and is told where it cannot.

use crate::common::{assembled, model, vector};
use grashof::dynamics::Dynamics;
use grashof::geometry::{Space, Spatial};
use grashof::kinematics::assemble::Assembled;
use grashof::kinematics::survey::survey;
use grashof::mechanism::{Coordinates, Mechanism};
use grashof::studies::common::case::parameters;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// A delta robot: three arms, each with two rods to a plate; the angles of its arms in degrees, and its start.
fn delta(angles: [f64; 3], start: &str) -> String {
    let [a, b, c] = angles;
    let arm = |name: &str| format!("  {name}: {{ bar: {{ length: L, mass: 1 kg }}, points: {{ p: [L, d, 0], q: [L, -d, 0] }} }}\n");
    let rods = |name: &str| {
        let lower = name.to_lowercase();
        format!(
            "  {name}: {{ revolute: [ground.{name}, {lower}.start], axis: [0, 1, 0] }}
  L{lower}p: {{ distance: [{lower}.p, plate.{lower}p], length: l }}
  L{lower}q: {{ distance: [{lower}.q, plate.{lower}q], length: l }}
"
        )
    };
    format!(
        "grashof: 1
name: delta robot
space: spatial
gravity: none
parameters: {{ R: 0.2 m, L: 0.3 m, l: 0.7 m, rp: 0.06 m, d: 0.04 m }}
ground:
  A: {{ at: [R, 0, 0], rpy: [0, 0, 0] }}
  B: {{ at: [R*cos(120 deg), R*sin(120 deg), 0], rpy: [0, 0, 120 deg] }}
  C: {{ at: [R*cos(240 deg), R*sin(240 deg), 0], rpy: [0, 0, 240 deg] }}
bodies:
{}  plate:
    disc: {{ radius: rp, thickness: 1 cm, mass: 0.8 kg }}
    points:
      ap: [rp, d, 0]
      aq: [rp, -d, 0]
      bp: [rp*cos(120 deg) - d*sin(120 deg), rp*sin(120 deg) + d*cos(120 deg), 0]
      bq: [rp*cos(120 deg) + d*sin(120 deg), rp*sin(120 deg) - d*cos(120 deg), 0]
      cp: [rp*cos(240 deg) - d*sin(240 deg), rp*sin(240 deg) + d*cos(240 deg), 0]
      cq: [rp*cos(240 deg) + d*sin(240 deg), rp*sin(240 deg) - d*cos(240 deg), 0]
joints:
{}start: {{ A.angle: {a} deg, B.angle: {b} deg, C.angle: {c} deg{start} }}
",
        ["a", "b", "c"].map(arm).concat(),
        ["A", "B", "C"].map(rods).concat()
    )
}

/// Place and rotation of a body at the start.
fn pose(mechanism: &Mechanism<Spatial<f64>>, start: &Assembled, body: &str) -> (Vector3<f64>, Matrix3<f64>) {
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.time(0.0, &start.modes);
    dynamics.position(&start.q, &start.modes);
    let body = mechanism.bodies.iter().position(|b| b.name == body).expect("the body");
    let place = dynamics.pose(body);
    (Vector3::from_vec(vector::<Spatial<f64>>(place.p)), Matrix3::from_fn(|i, k| Spatial::entry(place.r, i, k)))
}

/// The angle of a rotation, rad.
fn angle(r: &Matrix3<f64>) -> f64 {
    Rotation3::from_matrix_unchecked(*r).angle()
}

#[test]
fn a_plate_on_six_rods_stands_as_it_is_drawn() {
    for angles in [[20.0, 45.244_132, 20.0], [20.0; 3], [0.0, 10.0, 30.0], [35.0, 5.0, 40.0]] {
        // the spheres about the ends of the arms, moved by the plate's radius
        let spheres = std::array::from_fn::<_, 3, _>(|k| {
            let (theta, about) = (f64::to_radians(angles[k]), f64::to_radians(120.0 * k as f64));
            let out = 0.2 + 0.3 * theta.cos() - 0.06;
            Vector3::new(out * about.cos(), out * about.sin(), -0.3 * theta.sin())
        });
        for start in ["", ", plate.z: ~-0.7 m", ", plate.z: ~-0.7 m, plate.x: ~0 m, plate.y: ~0 m"] {
            let text = delta(angles, start);
            for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
                let (mechanism, begun) = assembled::<Spatial<f64>>(&text, coordinates);
                let (place, turned) = pose(&mechanism, &begun, "plate");
                assert!(angle(&turned) < 1e-9, "{angles:?}{start}: turned by {} deg", angle(&turned).to_degrees());
                for sphere in &spheres {
                    assert!(((place - sphere).norm() - 0.7).abs() < 1e-9, "{angles:?}{start}: {place}");
                }
                assert_eq!(begun.turned, Vec::new());
            }
        }
    }
}

/// A frame that three ball joints hold turned about z.
fn frame(degrees: f64, start: &str) -> String {
    format!(
        "grashof: 1
name: frame on three balls
space: spatial
gravity: none
parameters: {{ turn: {degrees:?} deg }}
ground: {{ O: [0, 0, 0], X: [cos(turn)*1 m, sin(turn)*1 m, 0], Y: [-sin(turn)*1 m, cos(turn)*1 m, 0] }}
bodies: {{ f: {{ mass: 1 kg, inertia: [1 kg m^2, 1 kg m^2, 1 kg m^2], points: {{ p: [1 m, 0, 0], q: [0, 1 m, 0] }} }} }}
joints:
  O: {{ spherical: [ground.O, f.origin] }}
  X: {{ spherical: [ground.X, f.p] }}
  Y: {{ spherical: [ground.Y, f.q] }}
start: {{ {start} }}
"
    )
}

#[test]
fn a_body_that_its_joints_turn_far_is_told() {
    let told = |text: &str| {
        let model = model(text, None);
        let survey = survey(&model, &parameters(&model)).unwrap_or_else(|failure| panic!("{}", failure.reason()));
        survey.findings.into_iter().filter(|f| f.code == "turned-start").map(|f| f.message).collect::<Vec<_>>()
    };
    for degrees in [60.0, -100.0, 150.0] {
        let found = told(&frame(degrees, ""));
        let words = [format!("turn it by {:.0} deg", f64::abs(degrees)), "body `f`".into(), "`f.rpy: [~0 deg".into()];
        assert!(found.len() == 1 && words.iter().all(|word| found[0].contains(word)), "{degrees}: {found:?}");
        assert_eq!(told(&frame(degrees, &format!("f.rpy: [~0 deg, ~0 deg, ~{degrees} deg]"))), Vec::<String>::new());
    }
    assert_eq!(told(&frame(30.0, "")), Vec::<String>::new());
}
