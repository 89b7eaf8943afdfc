//! What couplings exert: torques of gears, forces of racks, ropes and expressions, against what they have to move.

use crate::common::{self, close};
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

const G: f64 = 9.81;

/// A pinion (0.2 kg m²) with a wheel (3 kg m²), a rack (2 kg), a bucket (5 kg) on a rope from the wheel, a follower (0.5 kg) on a cam.
fn train(rest: &str, studies: &str) -> String {
    format!(
        "grashof: 1
name: train
space: planar
gravity: [0, -{G} m/s^2]
ground: {{ A: [0, 0], B: [14 cm, 0], R: [0, -4 cm], S: [30 cm, 0], H: [24 cm, -20 cm] }}
bodies:
  pinion: {{ mass: 1 kg, inertia: 0.2 kg m^2 }}
  wheel: {{ mass: 1 kg, inertia: 3 kg m^2 }}
  bar: {{ mass: 2 kg }}
  bucket: {{ mass: 5 kg }}
  follower: {{ mass: 0.5 kg }}
joints:
  A: {{ revolute: [ground.A, pinion.origin] }}
  B: {{ revolute: [ground.B, wheel.origin] }}
  R: {{ slider: [ground.R, bar.origin], axis: [1, 0] }}
  H: {{ slider: [ground.H, bucket.origin], axis: [0, 1] }}
  S: {{ slider: [ground.S, follower.origin], axis: [0, 1] }}
couplings:
  mesh: {{ gear: [A, B], ratio: -0.4 }}
  rack: {{ rack: [A, R], radius: 4 cm }}
  rope: {{ rope: [B, H], radius: 10 cm }}
  cam: {{ zero: S.position - 1 cm*(1 - cos(B.angle)) }}
measures: {{ carried: 2*mesh.torque }}
{rest}
studies:
  run:
    {studies}
    columns: [time, A.alpha, B.angle, B.omega, mesh.torque, mesh.power, rack, rope.force, rope.power, cam.force, carried]
"
    )
}

/// Efforts at each row of a motion by α of the pinion, and angle and rate of the wheel.
fn hold(of: &str, outcome: &Outcome, within: f64) {
    assert!(outcome.rows.len() > 5);
    for row in outcome.rows.iter() {
        let [alpha, beta, rate] = [row[1], row[2], row[3]];
        let acceleration = -0.4 * alpha;
        let rack = 2.0 * 0.04 * alpha;
        let rope = 5.0 * (0.1 * acceleration + G);
        let slope = 0.01 * beta.sin();
        let cam = 0.5 * (slope * acceleration + 0.01 * beta.cos() * rate * rate + G);
        // the wheel carries its inertia, the rope and the cam
        let mesh = 3.0 * acceleration + 0.1 * rope + slope * cam;
        let right = [mesh, mesh * rate, rack, rope, rope * 0.1 * rate, cam, 2.0 * mesh];
        close(of, &row[4..], &right, within);
    }
}

#[test]
fn couplings_exert_what_their_second_side_asks_for() {
    let driven =
        train("drivers: { d: { joint: A, angle: 1 rad/s^2*t^2 + 0.3 rad*sin(5 rad/s*t) } }", "inverse: { over: 2 s, samples: 20 }");
    let free = train("start: { A.omega: 3 rad/s }", "dynamics: { until: 1 s, every: 0.1 s, tolerance: 1e-10 }");
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        hold("inverse", &common::study(&driven, "run", coordinates), 1e-9);
        hold("dynamics", &common::study(&free, "run", coordinates), 1e-6);
    }
    hold("minimal", &common::study(&free.replace("tolerance", "coordinates: minimal, tolerance"), "run", Coordinates::Joint), 1e-6);
    let held = train("drivers: { d: { joint: A, angle: 0.7 rad } }", "inverse: { over: 1 s, samples: 8 }");
    hold("at rest", &common::study(&held, "run", Coordinates::Joint), 1e-9);
}

/// Two meshes of the same two wheels share their torque in any way.
#[test]
fn torques_that_rigid_bodies_leave_open_are_told() {
    let text = train("drivers: { d: { joint: A, speed: 1 rad/s } }", "inverse: { over: 1 s, samples: 2 }")
        .replace("couplings:\n", "couplings:\n  second: { gear: [A, B], ratio: -0.4 }\n");
    let outcome = common::study(&text, "run", Coordinates::Joint);
    let told: Vec<&str> = outcome.findings.iter().filter(|f| f.code == "reactions-not-unique").map(|f| f.message.as_str()).collect();
    assert!(told.len() == 1 && told[0].contains("`mesh.torque`") && !told[0].contains("rope"), "{told:?}");
}

/// Measures, and the expressions of couplings, may name one another in any order; one that needs itself is told.
#[test]
fn expressions_of_couplings_may_use_measures_of_others() {
    let text = |lifted: &str| {
        format!(
            "grashof: 1
name: two followers
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 2 kg }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0] }}, B: {{ slider: [ground, b.origin], axis: [0, 1] }} }}
drivers: {{ d: {{ joint: A, speed: 1 m/s }} }}
couplings: {{ cam: {{ zero: B.position - lifted }} }}
measures: {{ doubled: 2*cam.force, lifted: {lifted} }}
studies: {{ k: {{ inverse: {{ over: 1 s, samples: 2 }}, columns: [doubled, d.force] }} }}
"
        )
    };
    let outcome = common::study(&text("0.5*A.position"), "k", Coordinates::Joint);
    for row in outcome.rows.iter() {
        close("two followers", row, &[2.0 * 20.0, 0.5 * 20.0], 1e-12);
    }
    let refused = crate::reference::program::run_text(&text("0.5*A.position + 0*doubled/(1 N/m)"), &["--no-plots"]);
    assert_eq!(refused.code, 2, "{}", refused.stdout);
    assert!(refused.stderr.contains("cycle"), "{}", refused.stderr);
}
