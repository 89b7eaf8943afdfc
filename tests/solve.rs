//! `solve`: a parameter is varied until a scalar meets its target; against closed forms, and what is told where there is none.

use crate::closed_form::crank_rocker::{CrankRocker, Parameters};
use crate::reference::motor;
use crate::reference::program::{Run, model, run, run_text};
use std::f64::consts::{PI, TAU};

/// A four-bar whose rocker swings between the angles at which crank and coupler are in line; `{}` stands for its `solve`.
const FOUR_BAR: &str = "\
grashof: 1
name: four-bar
space: planar
gravity: none
parameters: { l1: 15 cm, l2: 1 m, l3: 55 cm, base: 1 m, speed: 60 rpm }
ground: { O: [0, 0], C: [base, 0] }
bodies:
  crank: { bar: { length: l1 } }
  coupler: { bar: { length: l2 } }
  rocker: { bar: { length: l3 } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: O, speed: speed } }
start: { O.angle: 90 deg, coupler.angle: ~25 deg, rocker.angle: ~90 deg }
measures: { phi3: rocker.angle }
studies:
  swing:
    kinematics: { over: 1 turn, samples: 60 }
    columns: [crank.angle, phi3]
    scalars: { swing: max(phi3) - min(phi3), found: l3 }
    {}
";

/// A rotor with a viscous bearing, spun up by a constant torque.
const ROTOR: &str = "\
grashof: 1
name: rotor
space: planar
gravity: none
parameters: { torque: 1 N m, inertia: 2 kg m^2, friction: 0.5 N m s/rad, wanted: 3 rad/s }
bodies: { rotor: { mass: 1 kg, inertia: inertia } }
joints: { pivot: { revolute: [ground, rotor.origin], damping: friction } }
loads: { drive: { joint: pivot, torque: torque } }
start: { pivot.angle: 0, pivot.omega: 0 }
studies:
  spin-up:
    dynamics: { until: 2 s, every: 0.1 s, tolerance: 1e-11 }
    columns: [time, rotor.omega]
    scalars: { omega: last(rotor.omega), found: torque }
    {}
";

fn four_bar(solve: &str, arguments: &[&str]) -> Run {
    run_text(&FOUR_BAR.replace("{}", solve), arguments)
}

fn number(run: &Run, study: &str, path: &str) -> f64 {
    run.json(study).pointer(path).and_then(serde_json::Value::as_f64).unwrap_or(f64::NAN)
}

/// Angle by which the rocker of length c swings: at its ends the distance from O to B is b + a and b − a (crank a, coupler b).
fn swing(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let angle = |r: f64| ((c * c + d * d - r * r) / (2.0 * c * d)).acos();
    angle(b + a) - angle(b - a)
}

/// The zero of a function that changes sign between two places.
fn zero(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        if f(a) * f(middle) > 0.0 { a = middle } else { b = middle }
    }
    0.5 * (a + b)
}

#[test]
fn a_length_for_a_swing() {
    let run = four_bar("solve: { vary: l3, between: [30 cm, 80 cm], target: { swing: 40 deg } }", &["--no-plots"]).succeeded();
    let right = zero(|c| swing(0.15, 1.0, c, 1.0) - 40f64.to_radians(), 0.3, 0.8);
    let found = number(&run, "swing", "/parameters/l3");
    assert!((found / right - 1.0).abs() < 1e-10, "{found} is not {right}");
    assert_eq!(number(&run, "swing", "/scalars/found"), found);
    assert!((number(&run, "swing", "/scalars/swing") - 40f64.to_radians()).abs() < 1e-12);
    // the certificate tells the same
    let solve = "/certificate/solve";
    assert!(number(&run, "swing", &format!("{solve}/residual")).abs() < 1e-12);
    let bracket = [0, 1].map(|i| number(&run, "swing", &format!("{solve}/bracket/{i}")));
    assert!(bracket[0] <= found && found <= bracket[1] && bracket[1] - bracket[0] < 1e-13, "{bracket:?}");
    let runs = number(&run, "swing", &format!("{solve}/runs"));
    assert!(runs <= 16.0, "{runs} runs");
    // in the unit of the file
    let shown = 100.0 * right;
    assert!(run.stdout.contains(&format!("  solved: l3 = {shown:.8} cm ({runs} runs), swing = 0.6981317008 rad")), "{}", run.stdout);
    // the columns are those of the run at the solution
    let phi3 = run.table("swing").column("phi3");
    let widest = phi3.iter().copied().fold(f64::MIN, f64::max) - phi3.iter().copied().fold(f64::MAX, f64::min);
    assert!((widest - 40f64.to_radians()).abs() < 1e-2);
}

#[test]
fn the_crank_begins_to_turn_where_grashof_says() {
    // a + longest = sum of the others: 0.15 + 1 = 1 + l3. Shorter by 1e-5 m the crank lacks a hundredth of a radian, which the motion
    // steps over as at a change point.
    let run = four_bar("solve: { vary: l3, between: [5 cm, 50 cm], target: { turns_fully: 1 } }", &["--no-plots"]).succeeded();
    assert!((number(&run, "swing", "/parameters/l3") - 0.15).abs() < 1e-5, "{}", run.stdout);
}

#[test]
fn a_torque_for_a_speed() {
    // ω(t) = T/c (1 − exp(−c t/J))
    let text = ROTOR.replace("{}", "solve: { vary: torque, between: [0.1 N m, 10 N m], target: { omega: wanted } }");
    let run = run_text(&text, &["--no-plots", "--verify"]).succeeded();
    let right = 3.0 * 0.5 / -(-0.5f64 * 2.0 / 2.0).exp_m1();
    let found = number(&run, "spin-up", "/parameters/torque");
    assert!((found / right - 1.0).abs() < 1e-10, "{found} is not {right}");
    assert!((number(&run, "spin-up", "/certificate/solve/residual")).abs() < 1e-10);
    // what is verified is the run that was found
    assert!(run.stdout.contains("verify: ") && run.stdout.contains("digits against"), "{}", run.stdout);
    assert_eq!(run.table("spin-up").column("rotor.omega").last().copied(), Some(number(&run, "spin-up", "/scalars/omega")));
}

/// The bound and the target may be expressions, also of the parameter that is varied.
#[test]
fn a_target_that_moves() {
    // ω(2 s) = T k, k = (1 − exp(−1/2))/c, so that T k = T − 0.5 (SI)
    let text = ROTOR
        .replace("{}", "solve: { vary: torque, between: [wanted*0.1 N m s/rad, 10 N m], target: { omega: torque/(1 N m s) - 0.5 rad/s } }");
    let run = run_text(&text, &["--no-plots"]).succeeded();
    let right = 0.5 / (1.0 - -(-0.5f64).exp_m1() / 0.5);
    assert!((number(&run, "spin-up", "/parameters/torque") / right - 1.0).abs() < 1e-9, "{}", run.stdout);
}

/// The speed at which the motor carries the mean load: the curve is linear between its points, the load a constant and a rate.
#[test]
fn the_operating_point_of_the_crank_rocker() {
    let run = run(&model("crank_rocker.yaml"), &["--study", "operating-point", "--no-plots"]).succeeded();
    let work = CrankRocker::new(Parameters::default()).work_per_turn();
    let gear = 73.0 / 12.0;
    let surplus = |omega: f64| gear * motor::torque(gear * omega) - (work / TAU + 4.26 * omega);
    let right = zero(surplus, 230.0 * PI / 30.0, 246.0 * PI / 30.0);
    let found = number(&run, "operating-point", "/parameters/speed");
    assert!((found / right - 1.0).abs() < 1e-10, "{found} is not {right}");
    let torque = number(&run, "operating-point", "/scalars/load_torque");
    assert!(number(&run, "operating-point", "/scalars/surplus").abs() < 1e-11 * torque);
}

#[test]
fn runs_that_cannot_be_made_narrow_the_bracket() {
    // below 0.15 m the crank stops at dead points, and above 1.99 m nothing can be assembled at 90 deg
    let right = zero(|c| swing(0.15, 1.0, c, 1.0) - 120f64.to_radians(), 0.1501, 0.5);
    let run = four_bar("solve: { vary: l3, between: [5 cm, 50 cm], target: { swing: 120 deg } }", &["--no-plots"]).succeeded();
    let found = number(&run, "swing", "/parameters/l3");
    assert!((found / right - 1.0).abs() < 1e-9, "{found} is not {right}");
    assert!(run.stderr.contains("gave no value; at 5 cm: "), "{}", run.stderr);
    assert_eq!(run.json("swing")["findings"][0]["code"], "solve-failed-runs");
    // and from the other side, where the bounds fall
    let run = four_bar("solve: { vary: l3, between: [3 m, 20 cm], target: { swing: 40 deg } }", &["--no-plots", "-q"]).succeeded();
    let right = zero(|c| swing(0.15, 1.0, c, 1.0) - 40f64.to_radians(), 0.3, 0.8);
    assert!((number(&run, "swing", "/parameters/l3") / right - 1.0).abs() < 1e-9);
    assert!(run.stderr.is_empty());
}

#[test]
fn the_first_of_several_is_found() {
    // the swing falls and rises again with the length of the rocker: the same at both ends
    let solve = "solve: { vary: l3, between: [30 cm, 170 cm], target: { swing: 19 deg } }";
    let run = four_bar(solve, &["--no-plots"]).succeeded();
    let f = |c: f64| swing(0.15, 1.0, c, 1.0) - 19f64.to_radians();
    let right = zero(f, 0.3, 1.45);
    assert!((number(&run, "swing", "/parameters/l3") / right - 1.0).abs() < 1e-9);
    assert_eq!(run.json("swing")["findings"][0]["code"], "solve-several");
    assert!(run.stderr.contains("several values of `l3`"), "{}", run.stderr);
    // from the other bound it is the other one
    let run = four_bar(&solve.replace("[30 cm, 170 cm]", "[170 cm, 30 cm]"), &["--no-plots"]).succeeded();
    assert!((number(&run, "swing", "/parameters/l3") / zero(f, 1.45, 1.7) - 1.0).abs() < 1e-9);
}

#[test]
fn what_cannot_be_met_is_told() {
    let run = four_bar("solve: { vary: l3, between: [50 cm, 60 cm], target: { swing: 120 deg } }", &[]);
    assert_eq!(run.code, 3, "{}", run.stderr);
    let ends = [0.5, 0.6].map(|c| format!("{:.4}", swing(0.15, 1.0, c, 1.0).to_degrees()));
    for part in ["does not meet its target 120 deg", &ends[0][..5], &ends[1][..5], "between", "swing: 120 deg"] {
        assert!(run.stderr.contains(part), "{part} in\n{}", run.stderr);
    }
    assert!(run.files().is_empty());
    // no run at all
    let run = four_bar("solve: { vary: l3, between: [3 m, 4 m], target: { swing: 120 deg } }", &[]);
    assert!(run.code != 0 && run.files().is_empty(), "{}", run.stderr);
    assert!(run.stderr.contains("error"), "{}", run.stderr);
    // a jump over the target
    let solve = "solve: { vary: speed, between: [10 rpm, 100 rpm], target: { step: 0.5 } }";
    let text = FOUR_BAR.replace("found: l3", "step: speed > 50 rpm").replace("{}", solve);
    let run = run_text(&text, &["-q"]);
    assert_eq!(run.code, 3);
    assert!(run.stderr.contains("`step` jumps over its target 0.5 at `speed` = 50 rpm, from 0 to 1"), "{}", run.stderr);
}

#[test]
fn a_solve_for_every_point_of_a_sweep() {
    let solve = "sweep: { base: [0.9 m, 1 m, 5 m, 1.1 m] }
    solve: { vary: l3, between: [30 cm, 80 cm], target: { swing: 40 deg } }";
    let one = four_bar(solve, &["-j", "1"]).succeeded();
    let two = four_bar(solve, &["-j", "2"]).succeeded();
    assert_eq!(one.files(), two.files());
    for name in one.files() {
        assert!(std::fs::read(one.directory.join(&name)).unwrap() == std::fs::read(two.directory.join(&name)).unwrap(), "{name}");
    }
    let table = one.table("swing");
    assert_eq!(table.names, ["base", "l3", "turns_fully", "swing", "found", "reason"]);
    for (row, reason) in table.rows.iter().zip(&table.reasons) {
        if row[0] == 5.0 {
            assert!(row[1].is_nan() && !reason.is_empty());
            continue;
        }
        let right = zero(|c| swing(0.15, 1.0, c, row[0]) - 40f64.to_radians(), 0.3, 0.8);
        assert!((row[1] / right - 1.0).abs() < 1e-9, "{row:?} {right}");
        assert_eq!(row[1], row[4]);
        assert!(reason.is_empty());
    }
    let json = one.json("swing");
    assert!(json["certificate"]["solve"][0]["runs"].is_u64() && json["certificate"]["solve"][2].is_null());
    assert_eq!(json["scalars"]["l3"].as_array().map(Vec::len), Some(4));
    assert_eq!(json["findings"].as_array().map(Vec::len), Some(1), "{}", json["findings"]);
}

#[test]
fn scalars_of_a_solved_study_can_be_taken() {
    let solve = "solve: { vary: l3, between: [30 cm, 80 cm], target: { swing: 40 deg } }
  other:
    take: { length: swing.found, wide: swing.swing }
    set: { l3: length }
    kinematics: { over: 1 turn, samples: 60 }
    scalars: { again: max(phi3) - min(phi3), difference: again - wide }";
    let run = four_bar(solve, &["--study", "other", "--no-plots"]).succeeded();
    assert_eq!(number(&run, "other", "/scalars/difference"), 0.0);
    assert_eq!(number(&run, "other", "/parameters/l3"), number(&run, "other", "/scalars/length"));
    assert!(!run.has("swing.csv"));
}

#[test]
fn the_varied_parameter_belongs_to_the_study() {
    let solve = "solve: { vary: l3, between: [30 cm, 80 cm], target: { swing: 40 deg } }";
    let run = four_bar(solve, &["--set", "l3=0.5"]).succeeded();
    assert!(run.stderr.contains("note: study `swing` is skipped: it varies `l3`"), "{}", run.stderr);
    assert_eq!(four_bar(solve, &["--set", "l3=0.5", "--study", "swing"]).code, 2);
    // another parameter reaches it
    let run = four_bar(solve, &["--set", "base=1.1", "--no-plots"]).succeeded();
    let right = zero(|c| swing(0.15, 1.0, c, 1.1) - 40f64.to_radians(), 0.3, 0.8);
    assert!((number(&run, "swing", "/parameters/l3") / right - 1.0).abs() < 1e-10);
}

/// The target is met for two ends of the bounds, for all values, or by far fewer digits than it has: each is told.
#[test]
fn what_a_solution_hides_is_told() {
    let rotor = |scalar: &str, solve: &str| {
        let text =
            ROTOR.replace("found: torque", &format!("found: torque, y: \"{scalar}\"")).replace("{}", &format!("solve: {{ {solve} }}"));
        run_text(&text, &["--no-plots"]).succeeded()
    };
    let ends = rotor("torque*(torque - 4 N m)/(1 N m)", "vary: torque, between: [0 N m, 4 N m], target: { y: 0 N m }");
    assert!(ends.stderr.contains("and others lie at 4 N m") && !ends.stderr.contains("is the same"), "{}", ends.stderr);
    let constant = rotor("inertia/(1 kg m^2)", "vary: torque, between: [0 N m, 4 N m], target: { y: 2 }");
    assert!(constant.stderr.contains("`y` is the same for all values of `torque`"), "{}", constant.stderr);
    let wide = rotor("1e6*torque/(1 N m)", "vary: torque, between: [-1e9 N m, 1.3e9 N m], target: { y: 1 }");
    assert!(wide.stderr.contains("`y` misses its target by 4.6e-2: `between` spans so much"), "{}", wide.stderr);
}
