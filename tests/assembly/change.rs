//! Starts in change points: the branches are told, guesses choose between them, and the motion goes on.

use crate::common::{assembled, model, study};
use grashof::analysis::outcome::{Failure, Outcome};
use grashof::analysis::run::run;
use grashof::analysis::sweep::parameters;
use grashof::dynamics::Dynamics;
use grashof::geometry::Planar;
use grashof::mechanism::Coordinates;
use std::f64::consts::TAU;

/// A parallelogram of 10 and 30 cm that begins flat.
fn parallelogram(start: &str, driver: &str) -> String {
    format!(
        "grashof: 1
name: parallelogram
space: planar
gravity: none
ground: {{ O: [0, 0], C: [30 cm, 0] }}
bodies:
  crank: {{ bar: {{ length: 10 cm, mass: 1 }} }}
  coupler: {{ bar: {{ length: 30 cm, mass: 1 }} }}
  rocker: {{ bar: {{ length: 10 cm, mass: 1 }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.start] }}
{driver}
start: {{ O.angle: 0 deg, {start} }}
studies:
  k: {{ kinematics: {{ over: 1 turn, samples: 72 }}, columns: [crank.angle, rocker.angle] }}
  swing: {{ dynamics: {{ until: 0.5 s, every: 0.1 s }}, columns: [crank.angle, rocker.angle, energy.kinetic] }}
"
    )
}

const DRIVER: &str = "drivers: { d: { joint: O, speed: 60 rpm } }";

/// The rocker of the crossed parallelogram: tan ψ/2 = −(d + a)/(d − a) tan θ/2.
fn crossed(crank: f64) -> f64 {
    let turns = (crank / TAU).round();
    -2.0 * ((0.5 * (crank - turns * TAU)).tan() * 2.0).atan() - turns * TAU
}

fn told(outcome: &Outcome) -> usize {
    outcome.findings.iter().filter(|f| f.code == "change-point").count()
}

#[test]
fn a_parallelogram_runs_from_its_flat_position() {
    for (guess, right) in [
        ("coupler.angle: ~0, rocker.angle: ~0", None),
        ("rocker.omega: ~60 rpm", None),
        ("rocker.omega: ~-100 rpm", Some(crossed as fn(f64) -> f64)),
    ] {
        for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
            let outcome = study(&parallelogram(guess, DRIVER), "k", coordinates);
            assert_eq!((outcome.rows.len(), told(&outcome)), (73, 1), "{guess}: {:?}", outcome.findings);
            for row in &outcome.rows {
                let right = right.map_or(row[0], |right| right(row[0]));
                assert!((row[1] - right).abs() < 1e-9, "{guess}, {coordinates:?}: {row:?}, right is {right}");
            }
        }
    }
}

#[test]
fn without_a_driver_it_begins_on_a_branch_too() {
    for coordinates in ["joint", "cartesian", "minimal"] {
        let text = parallelogram("O.omega: 3 rad/s", "").replace("every: 0.1 s", &format!("every: 0.1 s, coordinates: {coordinates}"));
        let (m, start) = assembled::<Planar<f64>>(&text, Coordinates::Joint);
        let mut d = Dynamics::new(&m);
        d.terms(0.0, &start.q, &start.v, &start.modes);
        // both cranks turn about their ends, and the coupler is carried along: (2/3 + 1) m a² ω²/2
        assert!((d.kinetic_energy() - 5.0 / 6.0 * 0.01 * 9.0).abs() < 1e-12, "{}", d.kinetic_energy());
        if coordinates == "minimal" {
            // independent coordinates do not determine the others there
            let model = model(&text, Some("swing"));
            let refused = run(&model, &model.study.clone().expect("a study"), &parameters(&model), Coordinates::Joint, &|| false);
            assert!(matches!(refused, Err(Failure::Study { code: "change-point", .. })));
            continue;
        }
        let outcome = study(&text, "swing", Coordinates::Joint);
        assert_eq!(told(&outcome), 1, "{:?}", outcome.findings);
        for row in &outcome.rows {
            assert!((row[1] - row[0]).abs() < 1e-6 && (row[2] - outcome.rows[0][2]).abs() < 1e-8, "{coordinates}: {row:?}");
        }
    }
}

/// Rows that are redundant everywhere make no change point.
#[test]
fn redundant_rows_are_no_change_point() {
    let twice = parallelogram("rocker.angle: ~0", DRIVER)
        .replace("O.angle: 0 deg", "O.angle: 60 deg")
        .replace("  C: {", "  D: { distance: [ground.O, crank.end], length: 10 cm }\n  C: {");
    assert_eq!(told(&study(&twice, "k", Coordinates::Joint)), 0);
}
