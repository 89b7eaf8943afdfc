//! What goes wrong is told: no equilibrium, forces that jump, forces that are no numbers; commands and sweeps.

use crate::reference::program::{Run, run_text};

/// Runs a planar model with the study `rest`.
fn run(rest: &str) -> Run {
    run_text(
        &format!("grashof: 1\nname: fault\nspace: planar\n{rest}\nstudies:\n  rest: {{ statics: {{ from: start }} }}\n"),
        &["--no-plots"],
    )
}

/// A mass of 1 kg on a slider along x without gravity, under a load.
fn car(load: &str, start: &str) -> Run {
    run(&format!(
        "gravity: none
bodies: {{ car: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, car.origin], axis: [1, 0] }} }}
loads: {{ push: {{ joint: S, force: \"{load}\" }} }}
start: {{ S.position: {start} }}"
    ))
}

/// What stays unbalanced is told however small it is.
#[test]
fn a_small_force_is_no_zero() {
    for (force, shown) in [("2e-14 N", "2e-14 N"), ("3e-9 N", "3e-9 N")] {
        told(&car(force, "0 m"), &[&format!("{shown} on `S.position` stays unbalanced")]);
    }
}

/// The message has all the words, the exit code is right, and nothing was written.
fn told(run: &Run, words: &[&str]) {
    assert_eq!(run.code, 3, "{}{}", run.stdout, run.stderr);
    for word in words {
        assert!(run.stderr.contains(word), "no `{word}` in:\n{}", run.stderr);
    }
    assert!(run.stderr.contains("help:"), "no remedy in:\n{}", run.stderr);
    assert!(run.files().is_empty());
}

#[test]
fn what_falls_for_ever_has_no_equilibrium() {
    let falls = run("gravity: [0, -9.81 m/s^2]\nbodies: { ball: { ball: { radius: 10 cm, mass: 2 kg } } }\nstart: { ball.y: 1 m }");
    told(&falls, &["there is no equilibrium", "moves on and on", "19.62 N on `ball.y`", "hold it"]);
}

/// A bead slides off a swinging rod for ever; the rod upright with the bead above it is in balance, but nothing falls there.
#[test]
fn an_equilibrium_into_which_nothing_falls_is_told() {
    let bead = |end: &str| {
        run(&format!(
            "gravity: [0, -9.81 m/s^2]
bodies: {{ rod: {{ bar: {{ length: 1 m, mass: 1 kg }} }}, bead: {{ plate: {{ size: [5 cm, 5 cm], mass: 0.2 kg }} }} }}
joints:
  P: {{ revolute: [ground, rod.start] }}
  S: {{ slider: [rod.end, bead.origin], axis: [1, 0]{end} }}
start: {{ P.angle: -30 deg }}"
        ))
    };
    let found = bead("").succeeded();
    assert!(found.stdout.contains("does not come to rest from its start"), "{}", found.stdout);
    let held = bead(", limits: { to: 20 cm, stiffness: 1e4 N/m }").succeeded();
    assert!(!held.stdout.contains("does not come to rest from its start"), "{}", held.stdout);
    assert!(held.stdout.contains("P.angle = -90 deg"), "{}", held.stdout);
}

#[test]
fn a_motor_that_nothing_holds_has_no_equilibrium() {
    let spins = |mass: &str| {
        run(&format!(
            "gravity: [0, -9.81 m/s^2]
tables: {{ curve: {{ points: [[0 rad/s, 20 N m], [10 rad/s, 0 N m]] }} }}
bodies: {{ arm: {{ bar: {{ length: 1 m, mass: {mass} }} }} }}
joints: {{ P: {{ revolute: [ground, arm.start] }} }}
motors: {{ motor: {{ joint: P, curve: curve }} }}
start: {{ P.angle: -90 deg }}"
        ))
    };
    // at best the weight of 3 kg takes 14.715 N m of 20
    told(&spins("3 kg"), &["there is no equilibrium", "moves on and on", "5.285 N m on `P.angle`"]);
    assert_eq!(spins("5 kg").code, 0);
}

#[test]
fn a_force_that_jumps_where_the_mechanism_wants_to_stay() {
    told(&car("1 N - 2 N*sign(S.position)", "0.7 m"), &["the forces jump", "on `S.position`", "clamp"]);
    // over a small range it is found
    let smooth = car("1 N - 2 N*clamp(S.position/1 mm, -1, 1)", "0.7 m");
    assert_eq!(smooth.code, 0, "{}", smooth.stderr);
    assert!(smooth.stdout.contains("S.position = 0.0005 m: stable"), "{}", smooth.stdout);
}

#[test]
fn a_force_that_is_not_a_number() {
    told(&car("-2 N*sqrt(S.position/1 m)", "-0.1 m"), &["load `push` is not defined at the start: sqrt of -0.1"]);
    // and where the search must not go: the equilibrium at 0 is the edge
    let edge = car("1 N - 2 N*sqrt(S.position/1 m)", "0.9 m");
    assert!(edge.stdout.contains("S.position = 0.25 m: stable"), "{}{}", edge.stdout, edge.stderr);
}

#[test]
fn a_rigid_stop_is_not_gone_through_in_silence() {
    let falls = |from: &str| {
        run(&format!(
            "gravity: [0, -9.81 m/s^2]
bodies: {{ arm: {{ bar: {{ length: 1 m, mass: 2 kg }} }} }}
joints: {{ P: {{ revolute: [ground, arm.start], limits: {{ from: {from}, restitution: 0.5 }} }} }}
start: {{ P.angle: 0 deg }}"
        ))
    };
    told(&falls("-60 deg"), &["rigid stop of joint `P`", "stiffness"]);
    let free = falls("-100 deg");
    assert_eq!(free.code, 0, "{}", free.stderr);
    // the other equilibrium is within the stops, too
    assert!(free.stdout.contains("P.angle = 90 deg"), "{}", free.stdout);
}

#[test]
fn a_sweep_tells_which_runs_have_none() {
    let run = run_text(
        "grashof: 1
name: lifts
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { torque: 0 N m }
bodies: { arm: { bar: { length: 1 m, mass: 2 kg } } }
joints: { P: { revolute: [ground, arm.start] } }
loads: { lift: { joint: P, torque: torque } }
start: { P.angle: -80 deg }
studies:
  rest: { statics: { from: start }, sweep: { torque: [0 N m, 4.905 N m, 12 N m] }, scalars: { angle: last(P.angle) } }
",
        &["--no-plots"],
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
    let table = run.table("rest");
    assert_eq!(table.names, ["torque", "stable", "angle", "reason"]);
    assert!((table.rows[1][2] + std::f64::consts::FRAC_PI_3).abs() < 1e-12, "{:?}", table.rows);
    assert_eq!((table.rows[0][1], table.rows[1][1]), (1.0, 1.0));
    assert!(table.rows[2][2].is_nan() && table.reasons[2].contains("no equilibrium"), "{:?}", table.reasons);
}

#[test]
fn the_report_has_the_equilibria() {
    let run = run("gravity: [0, -9.81 m/s^2]
bodies: { arm: { bar: { length: 1 m, mass: 2 kg } } }
joints: { P: { revolute: [ground, arm.start] } }
start: { P.angle: 0 deg }");
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains("  at rest: P.angle = -90 deg: stable\n"), "{}", run.stdout);
    assert!(run.stdout.contains("  also in balance: P.angle = 90 deg: unstable, it falls along `P.angle`\n"), "{}", run.stdout);
    let json = run.json("rest");
    assert_eq!(json["scalars"]["stable"], 1.0);
    let list = |name: &str| -> Vec<Option<f64>> {
        json["scalars"][name].as_array().into_iter().flatten().map(serde_json::Value::as_f64).collect()
    };
    assert_eq!(list("equilibria.stable"), [Some(1.0), Some(0.0)]);
    assert_eq!(list("equilibria.P.angle").len(), 2);
    assert_eq!(run.table("rest").rows.len(), 1);
}

#[test]
fn friction_that_may_hold_is_named() {
    let slope = run("gravity: [0, -9.81 m/s^2]
bodies: { block: { mass: 1 kg } }
joints: { S: { slider: [ground, block.origin], axis: [1, -0.1], friction: { coulomb: 5 N, stick_speed: 1 mm/s } } }");
    told(&slope, &["moves on and on", "the friction of joints does not count here"]);
}
