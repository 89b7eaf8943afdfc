//! Driven motions through change points: what is said of them follows from the smooth branch, in closed form.

use crate::common::{columns, study};
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// A crank and a rocker of 10 cm and a coupler of 30 cm between them, 1, 1 and 2 kg, at 60 rpm, from an angle in degrees.
fn parallelogram(space: &str, from: f64, range: &str, reactions: &str) -> String {
    let planar = space == "planar";
    let point = |x: &str| if planar { format!("[{x}, 0]") } else { format!("[{x}, 0, 0]") };
    let gravity = if planar { "[0, -9.81 m/s^2]" } else { "[0, -9.81 m/s^2, 0]" };
    format!(
        "\
grashof: 1
name: parallelogram
space: {space}
gravity: {gravity}
ground: {{ O: {}, C: {} }}
bodies:
  crank: {{ bar: {{ length: 10 cm, mass: 1 kg }} }}
  coupler: {{ bar: {{ length: 30 cm, mass: 2 kg }} }}
  rocker: {{ bar: {{ length: 10 cm, mass: 1 kg }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.start] }}
drivers: {{ drive: {{ joint: O, speed: 60 rpm }} }}
start: {{ O.angle: {from} deg, C.angle: ~{from} deg, A.angle: ~{} deg }}
studies:
  forces:
    inverse: {{ {range} }}
    columns: [O.angle, C.angle, C.omega, drive.torque{reactions}]
    scalars:
      highest: max(drive.torque)
      lowest: min(drive.torque)
      level: mean(drive.torque)
      fast: max(C.omega)
      slow: min(C.omega)
      turned: max(C.alpha)
      never: integral(C.omega > 6.29 rad/s)
",
        point("0"),
        point("30 cm"),
        -from
    )
}

fn scalar(outcome: &Outcome, k: usize) -> f64 {
    outcome.scalars[k]
}

/// The torque carries the weights, which all move as the crank does: ½ (1 + 1) + 2 kg at 10 cm.
#[test]
fn a_parallelogram_moves_on_along_the_smooth_branch() {
    let torque = 0.3 * 9.81;
    let cases = [
        ("planar", 10.0, "over: 2 turn, samples: 36", ", A, C"),
        ("planar", 5.0, "over: 2 turn, samples: 36", ""),
        ("planar", 10.0, "over: -2 turn, samples: 7", ""),
        ("planar", 10.0, "over: 2 s, samples: 7", ", A"),
        // rows stand in change points
        ("planar", 10.0, "over: 30 turn, samples: 1080", ""),
        ("spatial", 10.0, "over: 2 turn, samples: 36", ", A, C"),
        // it begins in one
        ("planar", 0.0, "over: 2 turn, samples: 36", ", A"),
    ];
    for (space, from, range, reactions) in cases {
        let text = parallelogram(space, from, range, reactions);
        let outcome = study(&text, "forces", Coordinates::Joint);
        let what = format!("{space} {from} {range}{reactions}");
        let right = [torque, -torque, 0.0, TAU, TAU, 0.0, 0.0];
        let tolerance = [1e-8, 1e-8, 1e-8, 1e-8, 1e-8, 1e-6, 0.0];
        for (k, (right, tolerance)) in right.iter().zip(tolerance).enumerate() {
            let found = scalar(&outcome, k);
            assert!((found - right).abs() <= tolerance, "{what}: scalar {k} is {found:e}, right is {right:e}");
        }
        for row in &outcome.rows {
            let off = (row[1] - row[0]).abs();
            assert!(off < 1e-9, "{what}: the rocker at {} is off by {off:e}", row[0]);
        }
        // forces along the bars grow without bound, and nothing else does
        let unresolved: Vec<&str> = outcome.findings.iter().filter(|f| f.code == "unresolved").map(|f| f.message.as_str()).collect();
        assert_eq!(unresolved.is_empty(), reactions.is_empty(), "{what}: {unresolved:?}");
        for message in unresolved {
            assert!(message.contains(" without bound at the change point"), "{what}: {message}");
            let mut named = message.split('`').skip(1).step_by(2);
            assert!(named.all(|name| name.starts_with("A.f") || name.starts_with("C.f")), "{what}: {message}");
        }
    }
}

#[test]
fn two_parallelograms_pass_their_change_points_at_once() {
    let mut text = parallelogram("planar", 10.0, "over: 2 turn, samples: 36", "");
    for (from, to) in [
        ("C: [30 cm, 0] }", "C: [30 cm, 0], D: [60 cm, 0] }"),
        ("joints:\n", "  second: { bar: { length: 30 cm, mass: 2 kg } }\n  last: { bar: { length: 10 cm, mass: 1 kg } }\njoints:\n"),
        (
            "drivers:",
            "  E: { revolute: [rocker.end, second.start] }\n  F: { revolute: [second.end, last.end] }\n  D: { revolute: [ground.D, last.start] }\ndrivers:",
        ),
        ("start: {", "start: { D.angle: ~10 deg, E.angle: ~-10 deg, "),
    ] {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let outcome = study(&text, "forces", Coordinates::Joint);
    let torque = 0.55 * 9.81;
    for (k, right) in [torque, -torque, 0.0, TAU].into_iter().enumerate() {
        assert!((scalar(&outcome, k) - right).abs() < 1e-8, "{k}: {:e}", scalar(&outcome, k));
    }
    assert!(outcome.findings.iter().all(|f| f.code != "unresolved"), "{:?}", outcome.findings);
}

/// Crank and rod of 20 cm: the slide moves by 2 r cos θ, through the pivot of the crank, where the rod may turn about it alone. No force
/// grows there. With k = r ω² the slide of 1 kg is pushed by (−2 k cos θ, 4 k sin θ − g), the rod of 2 kg by the crank by
/// (−5 k cos θ, 3 k sin θ + g).
#[test]
fn an_equal_slider_crank_goes_on_through_its_pivot() {
    let (k, g) = (0.2 * TAU * TAU, 9.81);
    let sine = 3.0 * g / (16.0 * k);
    let right =
        [0.4 * TAU, -0.4 * TAU, 2.0 * k, 4.0 * k + g, (25.0 * k * k * (1.0 - sine * sine) + (3.0 * k * sine + g).powi(2)).sqrt(), 0.0];
    for from in [5, 10, 45, 70] {
        let mut text = String::from("grashof: 1\nname: equal slider-crank\nspace: planar\ngravity: [0, -9.81 m/s^2]\n");
        let angle = f64::from(from) * PI / 180.0;
        write!(
            text,
            "\
bodies:
  crank: {{ bar: {{ length: 20 cm, mass: 1 kg }} }}
  rod: {{ bar: {{ length: 20 cm, mass: 2 kg }} }}
  slide: {{ mass: 1 kg, inertia: 0.001 kg m^2 }}
joints:
  O: {{ revolute: [ground, crank.start] }}
  A: {{ revolute: [crank.end, rod.start] }}
  B: {{ revolute: [rod.end, slide.origin] }}
  W: {{ slider: [ground, slide.origin], axis: [1, 0] }}
drivers: {{ drive: {{ joint: O, speed: 60 rpm }} }}
start: {{ O.angle: {from} deg, rod.angle: ~-{from} deg, W.position: ~{} cm }}
studies:
  forces:
    inverse: {{ over: 1 turn, samples: 36 }}
    columns: [O.angle, W.velocity, drive.torque, A.f, B.f]
    scalars:
      fast: max(W.velocity)
      back: min(W.velocity)
      quickest: max(W.acceleration)
      pushed: max(B.f)
      carried: max(A.f)
      level: mean(drive.torque)
",
            40.0 * angle.cos()
        )
        .unwrap();
        assert_eq!(columns(&text, "forces").len(), 5);
        let outcome = study(&text, "forces", Coordinates::Joint);
        for (k, right) in right.iter().enumerate() {
            let found = scalar(&outcome, k);
            assert!((found - right).abs() < 2e-7, "from {from} deg scalar {k} is {found:.10}, right is {right:.10}");
        }
        assert!(outcome.findings.iter().all(|f| f.code != "unresolved"), "{:?}", outcome.findings);
    }
}
