//! Whether a driver turns fully, and how dead points are told.

use crate::common::{model, study};
use crate::reference::program::{Run, run_text};
use grashof::mechanism::Coordinates;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run;

/// A four-bar with a crank of a length, and a study of it.
fn four_bar(crank: &str, speed: &str, over: &str) -> String {
    format!(
        "grashof: 1
name: four-bar
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ P: [0, 0], R: [600 mm, 300 mm] }}
bodies:
  crank: {{ bar: {{ length: {crank}, mass: 3 kg }} }}
  coupler: {{ bar: {{ length: 700 mm, mass: 6 kg }} }}
  rocker: {{ bar: {{ length: 300 mm, mass: 5 kg }} }}
joints:
  O: {{ revolute: [ground.P, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  C: {{ revolute: [ground.R, rocker.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
drivers: {{ turn: {{ joint: O, {speed} }} }}
measures: {{ theta: O.angle }}
start: {{ O.angle: 120 deg, coupler.angle: ~0 deg, rocker.angle: ~100 deg }}
studies:
  turn: {{ kinematics: {{ over: {over}, samples: 10 }} }}
"
    )
}

const SPEED: &str = "speed: 60 rpm";

fn outcome(text: &str) -> Outcome {
    let model = model(text, Some("turn"));
    let study = model.study.clone().expect("the study");
    run(Case::new(&model, &study, &parameters(&model)), &|| false).unwrap_or_else(|why| panic!("{}", why.reason()))
}

#[test]
fn a_part_of_a_turn_does_not_turn_fully_where_the_rest_cannot_be_reached() {
    for (crank, turns) in [("100 mm", 1.0), ("500 mm", 0.0)] {
        for over in ["10 deg", "-10 deg", "0.01 s", "1 turn", "-1.5 turn", "1 s"] {
            let found = outcome(&four_bar(crank, SPEED, over));
            assert_eq!(found.results, [turns], "a crank of {crank} over {over}: {:?}", found.stopped);
        }
    }
    // turning the other way
    assert_eq!(outcome(&four_bar("500 mm", "speed: -60 rpm", "10 deg")).results, [0.0]);
    // a law that is another beyond its range says nothing about the rest of the turn
    let law = "angle: \"120 deg + 20 deg*sin(1 rad/s*t)\"";
    assert!(outcome(&four_bar("100 mm", law, "0.5 s")).results[0].is_nan());
}

fn told(text: &str) -> Run {
    run_text(text, &["--no-plots"])
}

#[test]
fn nothing_is_said_of_turns_where_nothing_turns() {
    let slide = "grashof: 1
name: slide
space: planar
gravity: none
bodies: { car: { mass: 1 kg } }
joints: { S: { slider: [ground, car.origin], axis: [1, 0] } }
drivers: { push: { joint: S, speed: 1 m/s } }
start: { S.position: 0 m }
studies:
  turn: { kinematics: { over: 1 m, samples: 2 } }
";
    let found = told(slide).succeeded();
    assert!(found.json("turn")["scalars"]["turns_fully"].is_null(), "{}", found.json("turn"));
}

#[test]
fn dead_points_are_told_in_the_measure_of_the_range_and_no_time_is_negative() {
    for (over, words) in [
        ("1 turn", ["theta cannot go beyond", "on the way of the drivers", "against the way of the drivers", "at theta = "]),
        ("-1 turn", ["theta cannot go beyond", "on the way of the drivers", "against the way of the drivers", "at theta = "]),
        ("5 s", ["time cannot go beyond", "back from its start", "s after the start", "s before the start"]),
    ] {
        let found = told(&four_bar("500 mm", SPEED, over));
        let text = format!("{}{}", found.stdout, found.stderr);
        for word in words {
            assert!(text.contains(word), "over {over}: no `{word}` in:\n{text}");
        }
        let findings = found.json("turn")["findings"].to_string();
        let longest = findings.split(|c: char| !c.is_ascii_digit()).map(str::len).max();
        assert!(longest <= Some(6), "{findings}");
        assert!(!findings.contains("= -0.") && !text.contains("below -0."), "{text}");
    }
}

/// A body turns as the joint that drives it only where that counts from the drawn position.
#[test]
fn a_range_is_told_in_what_is_driven() {
    for (zero, name, end) in [("", "turned", 100.0), (", zero: 30 deg", "O.angle", 130.0)] {
        let text = format!(
            "\
grashof: 1
name: crank
space: planar
gravity: none
bodies: {{ a: {{ bar: {{ length: 2 m, mass: 1 kg }} }} }}
joints: {{ O: {{ revolute: [ground, a.start]{zero} }} }}
drivers: {{ d: {{ joint: O, speed: 60 rpm }} }}
start: {{ a.angle: 10 deg }}
measures: {{ turned: a.angle }}
studies: {{ turn: {{ kinematics: {{ over: 90 deg, samples: 3 }}, columns: [O.angle], scalars: {{ end: last(O.angle) }} }} }}
"
        );
        let outcome = study(&text, "turn", Coordinates::Joint);
        assert_eq!(outcome.independent, name);
        assert!((outcome.places.last().unwrap().to_degrees() - end).abs() < 1e-9, "{:?}", outcome.places);
        assert!((outcome.scalars[0].to_degrees() - end).abs() < 1e-9);
    }
}

/// A four-bar in space ends at its dead points, which are those of the plane, on whatever tree its driven hinge stands.
#[test]
fn dead_points_in_space_are_found_on_any_tree() {
    for cut in ["", ", cut: true"] {
        let text = format!(
            "grashof: 1
name: four-bar in space
space: spatial
gravity: none
ground: {{ O: [0, 0, 0], C: [0.3 m, 0, 0] }}
bodies:
  crank: {{ bar: {{ length: 0.3 m }} }}
  coupler: {{ bar: {{ length: 0.3 m }} }}
  rocker: {{ bar: {{ length: 0.25 m }} }}
joints:
  O: {{ revolute: [ground.O, crank.start]{cut} }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.start] }}
drivers: {{ drive: {{ joint: O, speed: 2 rad/s }} }}
start: {{ O.angle: 60 deg, A.angle: ~-60 deg, C.angle: ~80 deg }}
studies:
  turn: {{ kinematics: {{ over: 1 turn, samples: 6 }}, columns: [O.angle, A.omega, C.angle], scalars: {{ middle: mean(C.angle) }} }}
"
        );
        let found = run_text(&text, &["--no-plots"]);
        // the crank with coupler and rocker in a line, on each side
        let reach = |line: f64| ((0.3_f64.powi(2) + 0.3_f64.powi(2) - line.powi(2)) / (2.0 * 0.3 * 0.3)).acos().to_degrees();
        let words = format!("O.angle cannot go beyond {:.6} deg nor below {:.6} deg: dead point", reach(0.55), reach(0.05));
        assert!(found.code == 3 && found.stderr.contains(&words), "{cut}: {words}\n{}", found.stderr);
    }
}
