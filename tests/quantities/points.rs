//! Point masses: bodies of `mass` alone, without a rotation.

use super::{Columns, near};
use grashof::mechanism::{Coordinates, build};
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::run::run;

/// A bob on a rope that goes round on a circle: ω² = g/(l cos θ).
#[test]
fn a_conical_pendulum_of_a_point_mass() {
    let (l, theta) = (0.8_f64, 0.5_f64);
    let omega = (9.81 / (l * theta.cos())).sqrt();
    let text = format!(
        "
grashof: 1
name: conical pendulum
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies: {{ bob: {{ mass: 2 kg }} }}
joints: {{ rope: {{ distance: [ground, bob.origin], length: {l} m }} }}
start: {{ bob.x: {} m, bob.y: 0 m, bob.z: {} m, bob.vx: 0 m/s, bob.vy: {} m/s, bob.vz: ~0 m/s }}
studies:
  turn: {{ dynamics: {{ until: 5 s, every: 0.1 s, tolerance: 1e-11 }}, columns: [time, bob.x, bob.y, bob.z, rope.f, energy] }}
  implicit: {{ dynamics: {{ until: 5 s, every: 0.1 s, tolerance: 1e-10, integrator: radau5 }}, columns: [time, bob.x, bob.y, bob.z, rope.f] }}
",
        l * theta.sin(),
        -l * theta.cos(),
        l * theta.sin() * omega
    );
    for (study, coordinates) in [("turn", Coordinates::Joint), ("turn", Coordinates::Cartesian), ("implicit", Coordinates::Joint)] {
        let run = Columns::of(&text, study, coordinates);
        for (i, t) in run.get("time").into_iter().enumerate() {
            near("x", run.get("bob.x")[i], l * theta.sin() * (omega * t).cos(), 1e-7);
            near("y", run.get("bob.y")[i], l * theta.sin() * (omega * t).sin(), 1e-7);
            near("height", run.get("bob.z")[i], -l * theta.cos(), 1e-7);
            near("tension", run.get("rope.f")[i], 2.0 * 9.81 / theta.cos(), 1e-5);
        }
    }
}

/// Two bars on a bead: the bead may as well be a mass at the end of one of them.
fn beaded(space: &str, bead: &str, studies: &str) -> String {
    let (g, joint) = if space == "planar" { ("[0, -9.81 m/s^2]", "revolute") } else { ("[0, 0, -9.81 m/s^2]", "spherical") };
    let (body, joints) = match bead {
        "attached" => (String::new(), format!("A: {{ {joint}: [upper.end, lower.start] }}")),
        _ => (
            "bead: { mass: 2 kg }".to_owned(),
            format!("A: {{ {joint}: [upper.end, bead.origin] }}\n  B: {{ {joint}: [bead.origin, lower.start] }}"),
        ),
    };
    let attached = if bead == "attached" { ", attached: { bead: { at: end, mass: 2 kg } }" } else { "" };
    let thick = if space == "planar" { "" } else { ", width: 5 cm, height: 8 cm" };
    let start = if space == "planar" {
        "P.angle: -20 deg, lower.angle: -50 deg"
    } else {
        "upper.rpy: [0, 70 deg, 20 deg], lower.rpy: [10 deg, 20 deg, -40 deg], upper.wz: 1 rad/s, upper.wx: 0, upper.wy: 0, lower.wx: 0, \
         lower.wy: 0.5 rad/s, lower.wz: 0"
    };
    format!(
        "
grashof: 1
name: bead
space: {space}
gravity: {g}
bodies:
  upper: {{ bar: {{ length: 1 m, mass: 1 kg{thick} }}{attached} }}
  {body}
  lower: {{ bar: {{ length: 0.7 m, mass: 0.6 kg{thick} }} }}
joints:
  P: {{ {joint}: [ground, upper.start] }}
  {joints}
start: {{ {start} }}
studies:
  swing: {{ {studies}, columns: [time, upper.end.x, upper.end.y, lower.end.x, lower.end.y, P.f, energy.total] }}
"
    )
}

#[test]
fn a_bead_between_two_bars_is_a_mass_on_one_of_them() {
    for space in ["planar", "spatial"] {
        let study = "dynamics: { until: 2 s, every: 0.1 s, tolerance: 1e-11 }";
        let right = Columns::of(&beaded(space, "attached", study), "swing", Coordinates::Joint);
        for (study, coordinates) in [
            (study, Coordinates::Joint),
            (study, Coordinates::Cartesian),
            ("dynamics: { until: 2 s, every: 0.1 s, tolerance: 1e-10, integrator: radau5 }", Coordinates::Joint),
        ] {
            let found = Columns::of(&beaded(space, "bead", study), "swing", coordinates);
            for name in ["upper.end.x", "upper.end.y", "lower.end.x", "lower.end.y", "P.f", "energy.total"] {
                for (a, b) in found.get(name).into_iter().zip(right.get(name)) {
                    near(name, a, b, 2e-6);
                }
            }
        }
    }
}

/// Points on springs: the sum of forces moves the centre of mass, and three degrees of freedom a point are all there is.
#[test]
fn points_on_springs_have_three_coordinates_each() {
    let text = "
grashof: 1
name: three points
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies: { a: { mass: 1 kg }, b: { mass: 2 kg }, c: { mass: 3 kg, attached: { more: { mass: 1 kg } } } }
springs:
  ab: { between: [a.origin, b.origin], stiffness: 50 N/m, length: 1 m }
  bc: { between: [b.origin, c.origin], stiffness: 50 N/m, length: 1 m, damping: 0 N s/m }
start: { a.x: 0 m, a.y: 0 m, a.z: 0 m, b.x: 1.2 m, b.y: 0 m, b.z: 0 m, c.x: 1 m, c.y: 0.9 m, c.z: 0.3 m, a.vx: 1 m/s }
studies:
  fly: { dynamics: { until: 2 s, every: 0.1 s, tolerance: 1e-11 }, columns: [time, com.x, com.z, energy.total] }
";
    let model = crate::common::model(text, None);
    let mechanism = build::<grashof::geometry::Spatial<f64>>(&model, &parameters(&model), Coordinates::Joint).expect("a mechanism");
    assert_eq!((mechanism.nq, mechanism.nv), (9, 9));
    let run = Columns::of(text, "fly", Coordinates::Joint);
    let [x, z, e] = ["com.x", "com.z", "energy.total"].map(|name| run.get(name));
    for (i, t) in run.get("time").into_iter().enumerate() {
        near("centre of mass, x", x[i], (2.4 + 4.0) / 7.0 + t / 7.0, 1e-10);
        near("centre of mass, z", z[i], 1.2 / 7.0 - 0.5 * 9.81 * t * t, 1e-10);
        near("energy", e[i], e[0], 1e-8);
    }
}

/// What names or needs a rotation makes a body of it, which has no inertia: the message says what a point is.
#[test]
fn a_mass_that_is_turned_is_no_point() {
    let text = |more: &str| {
        format!(
            "
grashof: 1
name: turned
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ bob: {{ mass: 1 kg{more}
studies: {{ fall: {{ dynamics: {{ until: 1 s }} }} }}
"
        )
    };
    let reason = |text: &str| {
        let model = crate::common::model(text, Some("fall"));
        let study = model.study.clone().expect("the study");
        match run(Case::new(&model, &study, &parameters(&model)), &|| false) {
            Ok(outcome) => outcome.stopped.unwrap_or_default(),
            Err(grashof::results::Failure::Study { message, help, .. }) => format!("{message}; {help}"),
            Err(failure) => failure.reason(),
        }
    };
    assert_eq!(reason(&text(" } }")), "", "a point falls");
    for more in [
        " } }\nloads: { twist: { at: bob.origin, torque: 1 N m } }",
        ", points: { P: [1 m, 0] } } }",
        " } }\nmeasures: { phi: bob.angle }",
        " } }\nstart: { bob.omega: 1 rad/s }",
        " } }\njoints: { J: { revolute: [ground, bob.origin], damping: 1 N m s/rad } }",
    ] {
        let told = reason(&text(more));
        assert!(told.contains("`bob` can turn and has no inertia") && told.contains("`mass` alone"), "{more}: {told}");
    }
}
