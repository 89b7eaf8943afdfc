//! Starts in change points: the branches are told, guesses choose between them, and the motion goes on.

use crate::common::{assembled, model, study};
use grashof::dynamics::Dynamics;
use grashof::geometry::Planar;
use grashof::mechanism::Coordinates;
use grashof::results::Failure;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run;
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
        let outcome = study(&text, "swing", Coordinates::Joint);
        assert_eq!(told(&outcome), 1, "{:?}", outcome.findings);
        for row in &outcome.rows {
            assert!((row[1] - row[0]).abs() < 1e-6 && (row[2] - outcome.rows[0][2]).abs() < 1e-8, "{coordinates}: {row:?}");
        }
    }
}

/// Settings of motions in time from a change point.
const SETTINGS: [&str; 6] = [
    "every: 0.1 s",
    "every: 0.1 s, coordinates: cartesian",
    "every: 0.1 s, coordinates: minimal",
    "every: 0.1 s, integrator: radau5",
    "every: 0.1 s, integrator: bdf",
    "every: 0.1 s, coordinates: minimal, integrator: radau5",
];

/// Flat and at rest under gravity both branches are open; the forces move the parallelogram most as such, θ̈ = −1.2 g/a cos θ, which
/// is a bar of 12.5 cm on a hinge.
#[test]
fn a_parallelogram_falls_from_rest() {
    let bar = "grashof: 1\nname: bar\nspace: planar\ngravity: [0, -9.81 m/s^2]
bodies: { bar: { bar: { length: 12.5 cm, mass: 1 } } }
joints: { O: { revolute: [ground.origin, bar.start] } }
start: { O.angle: 0 deg }
studies: { swing: { dynamics: { until: 0.5 s, every: 0.1 s, tolerance: 1e-12 }, columns: [bar.angle] } }\n";
    let right = study(bar, "swing", Coordinates::Joint);
    // it comes to rest flat again at 0.34 s
    let text = parallelogram("coupler.angle: ~0", "").replace("gravity: none", "gravity: [0, -9.81 m/s^2]").replace("0.5 s", "0.3 s");
    for settings in SETTINGS {
        let outcome = study(&text.replace("every: 0.1 s", settings), "swing", Coordinates::Joint);
        assert_eq!((outcome.rows.len(), told(&outcome)), (4, 1), "{settings}: {:?}", outcome.stopped);
        for (row, right) in outcome.rows.iter().zip(&right.rows) {
            let off = (row[0] - right[0]).abs().max((row[1] - right[0]).abs());
            assert!(off < 2e-6, "{settings}: {row:?} instead of {right:?}");
        }
    }
}

/// A torque on the rocker of a flat rhombus moves rocker and coupler alone, whose inertia is the smaller one; a guess of a position
/// names the other branch.
#[test]
fn the_branch_from_rest_is_the_one_that_forces_move_most() {
    let rhombus = parallelogram("coupler.angle: ~0", "loads: { push: { joint: C, torque: 0.01 N*m } }").replace("30 cm", "10 cm");
    for settings in SETTINGS {
        let text = rhombus.replace("every: 0.1 s", settings);
        let outcome = study(&text, "swing", Coordinates::Joint);
        for (t, row) in outcome.places.iter().zip(&outcome.rows) {
            let right = 0.5 * 0.01 / (2.0 / 3.0 * 0.01) * t * t;
            assert!((row[1] - right).abs() < 1e-7 && row[0].abs() < 1e-7, "{settings}: {row:?} instead of {right}");
        }
        let named = study(
            &text.replace("O.angle: 0 deg, coupler.angle: ~0", "O.angle: 0 deg, A.angle: ~-0.1 rad, C.angle: ~0.1 rad"),
            "swing",
            Coordinates::Joint,
        );
        for (t, row) in named.places.iter().zip(&named.rows) {
            let right = 0.5 * 0.01 / (5.0 / 3.0 * 0.01) * t * t;
            assert!((row[1] - right).abs() < 1e-7 && (row[0] - right).abs() < 1e-7, "{settings}: {row:?} instead of {right}");
        }
    }
}

/// A kite that begins folded: crank and coupler turn as one while the rocker rests, or B is the mirror image of O in the line A C.
#[test]
fn a_kite_has_two_branches() {
    let kite = |guess: &str| {
        parallelogram(guess, DRIVER)
            .replace("coupler: { bar: { length: 30 cm", "coupler: { bar: { length: 10 cm")
            .replace("rocker: { bar: { length: 10 cm", "rocker: { bar: { length: 30 cm")
    };
    for (guess, turns) in [("C.omega: ~0", false), ("C.omega: ~-60 rpm", true), ("rocker.angle: ~179 deg", true)] {
        for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
            let outcome = study(&kite(guess), "k", coordinates);
            assert_eq!((outcome.rows.len(), told(&outcome)), (73, 1), "{guess}: {:?}", outcome.stopped);
            for row in &outcome.rows {
                let (a, c) = ([0.1 * row[0].cos(), 0.1 * row[0].sin()], [0.3, 0.0]);
                let along = [c[0] - a[0], c[1] - a[1]];
                let part = -(a[0] * along[0] + a[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
                let foot = [a[0] + part * along[0], a[1] + part * along[1]];
                let b = if turns { [2.0 * foot[0], 2.0 * foot[1]] } else { [0.0, 0.0] };
                let off = (0.3 * row[1].cos() - (b[0] - c[0])).abs().max((0.3 * row[1].sin() - (b[1] - c[1])).abs());
                assert!(off < 1e-9, "{guess}, {coordinates:?}: {row:?}");
            }
        }
    }
}

/// Rods of 10 cm, side by side on links of 20 cm.
fn row_of_four_bars(n: usize) -> String {
    let mut text = String::from("grashof: 1\nname: row\nspace: planar\ngravity: none\nground: {");
    (0..=n).for_each(|i| text += &format!(" g{i}: [{} cm, 0],", 20 * i));
    text += " }\nbodies:\n";
    (0..=n).for_each(|i| text += &format!("  r{i}: {{ bar: {{ length: 10 cm, mass: 1 }} }}\n"));
    (0..n).for_each(|i| text += &format!("  l{i}: {{ bar: {{ length: 20 cm, mass: 1 }} }}\n"));
    text += "joints:\n";
    (0..=n).for_each(|i| text += &format!("  g{i}: {{ revolute: [ground.g{i}, r{i}.start] }}\n"));
    for i in 0..n {
        text += &format!("  a{i}: {{ revolute: [r{i}.end, l{i}.start] }}\n  b{i}: {{ revolute: [l{i}.end, r{}.end] }}\n", i + 1);
    }
    text + "start: { g0.angle: 0 deg, g0.omega: 1 rad/s }\nstudies: { s: { dynamics: { until: 0.1 s, every: 0.1 s }, columns: [r0.angle] } }\n"
}

#[test]
fn a_row_of_four_bars_has_two_branches_for_each() {
    for n in 1..=4 {
        let (m, start) = assembled::<Planar<f64>>(&row_of_four_bars(n), Coordinates::Joint);
        let change = start.change.expect("a change point");
        assert_eq!(change.branches.len(), 1 << n);
        // each loop: the next rod turns alike, or (d + a)/(d − a) = 3 times as fast the other way round
        let rod = |v: &[f64], i: usize| {
            let mut d = Dynamics::new(&m);
            d.time(0.0, &start.modes);
            d.position(&start.q, &start.modes);
            d.velocity(v, &start.modes);
            d.work.twists[1 + i].w
        };
        let mut seen = Vec::new();
        for branch in &change.branches {
            let v = &branch.ways[0];
            let ratios: Vec<f64> = (0..n).map(|i| rod(v, i + 1) / rod(v, i)).collect();
            assert!(ratios.iter().all(|r| (r - 1.0).abs() < 1e-9 || (r + 3.0).abs() < 1e-8 || (r + 1.0 / 3.0).abs() < 1e-9), "{ratios:?}");
            seen.push(ratios.iter().map(|r| *r > 0.0).collect::<Vec<_>>());
        }
        seen.sort();
        seen.dedup();
        assert_eq!(seen.len(), 1 << n);
    }
}

/// A driver that begins to move from rest leads along the branch that is named.
#[test]
fn a_driver_begins_from_rest() {
    for law in ["90 deg*(t/1 s)^2", "-90 deg*(t/1 s)^3", "90 deg*(10*(t/1 s)^3 - 15*(t/1 s)^4 + 6*(t/1 s)^5)"] {
        let driver = format!("drivers: {{ d: {{ joint: O, angle: \"{law}\" }} }}");
        for (guess, right) in [("coupler.angle: ~0", None), ("C.omega: ~-1 rad/s, O.omega: ~1 rad/s", Some(crossed as fn(f64) -> f64))] {
            let sign = if law.starts_with('-') { -1.0 } else { 1.0 };
            let guess = if sign < 0.0 {
                guess.replace("~-1", "~+1").replace("O.omega: ~1", "O.omega: ~-1").replace("~+1", "~1")
            } else {
                guess.into()
            };
            let text = parallelogram(&guess, &driver).replace("over: 1 turn", "over: 1 s");
            for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
                let outcome = study(&text, "k", coordinates);
                assert_eq!((outcome.rows.len(), told(&outcome)), (73, 1), "{law}: {:?}", outcome.stopped);
                for row in &outcome.rows {
                    let right = right.map_or(row[0], |right| right(row[0]));
                    assert!((row[1] - right).abs() < 1e-9, "{law}, {guess}, {coordinates:?}: {row:?}, right is {right}");
                }
            }
            let outcome = study(&text, "swing", Coordinates::Joint);
            for row in &outcome.rows {
                let right = right.map_or(row[0], |right| right(row[0]));
                assert!((row[1] - right).abs() < 1e-6, "{law}, {guess}: {row:?}, right is {right}");
            }
        }
    }
}

/// The starts that are proposed beside a dead point are some from which the driver moves the linkage.
#[test]
fn a_dead_point_names_starts_beside_it() {
    let text = "grashof: 1\nname: four-bar\nspace: planar\ngravity: none
ground: { O: [0, 0], C: [35 cm, 0] }
bodies: { crank: { bar: { length: 10 cm } }, coupler: { bar: { length: 40 cm } }, rocker: { bar: { length: 25 cm } } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: B, speed: 60 rpm } }
start: { O.angle: 0 deg, coupler.angle: ~40 deg, rocker.angle: ~90 deg }
studies: { k: { kinematics: { over: 1 deg, samples: 2 }, columns: [crank.angle] } }\n";
    let refused = |text: &str| {
        let model = model(text, Some("k"));
        run(Case::new(&model, &model.study.clone().expect("a study"), &parameters(&model)), &|| false).map(|_| ())
    };
    let Err(Failure::Study { code: "dead-point", message, help, .. }) = refused(text) else { panic!("a dead point") };
    assert!(message.contains("`B` has its least value, 36.87 deg"), "{message}");
    let starts: Vec<&str> = help.split('`').skip(1).step_by(2).collect();
    assert_eq!(starts.len(), 2, "{help}");
    for start in starts {
        let moved = refused(&text.replace("O.angle: 0 deg", start));
        assert!(moved.is_ok(), "{start}: {moved:?}");
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
