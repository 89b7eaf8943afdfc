//! What goes wrong is told: where or when, what was found, what helps; exit codes; files whole.

use crate::reference::program::{Run, Table, run_text};

/// Runs a planar model with the given rest of the file.
fn run(rest: &str) -> Run {
    run_text(&format!("grashof: 1\nname: fault\nspace: planar\n{rest}"), &["--no-plots"])
}

/// A mass of 1 kg on a slider along x without gravity.
fn car(load: &str, start: &str, dynamics: &str) -> Run {
    run(&format!(
        "gravity: none
bodies: {{ car: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, car.origin], axis: [1, 0] }} }}
loads: {{ push: {{ joint: S, force: \"{load}\" }} }}
start: {{ {start} }}
studies:
  run: {{ dynamics: {{ {dynamics} }}, columns: [time, S.position, S.velocity] }}
"
    ))
}

/// The message has all the words, and the exit code is right.
fn told(run: &Run, code: i32, words: &[&str]) {
    assert_eq!(run.code, code, "{}", run.stderr);
    for word in words {
        assert!(run.stderr.contains(word), "no `{word}` in:\n{}", run.stderr);
    }
    assert!(run.stderr.contains("help:"), "no remedy in:\n{}", run.stderr);
}

/// Rows up to a time are kept, and the JSON says that the study failed.
fn kept(run: &Run, until: f64, within: f64) -> Table {
    let table = run.table("run");
    let end = table.rows.last().expect("rows")[0];
    assert!((end - until).abs() <= within, "the rows end at {end} s, not at {until} s\n{}", run.stderr);
    assert_eq!(run.json("run")["status"], "failed");
    table
}

#[test]
fn a_force_that_is_not_defined() {
    // from the start on
    let start = car("-2 N*sqrt(S.position/1 m)", "S.position: -0.1 m, S.velocity: 0 m/s", "until: 1 s");
    told(&start, 3, &["load `push`", "is not defined at the start", "sqrt of -0.1"]);
    assert!(start.files().is_empty());
    // and on the way: x = 0.1 m is left behind at 0.1 s
    let run = car("-2 N*sqrt(S.position/1 m - 0.1)", "S.position: 0.2 m, S.velocity: -1 m/s", "until: 1 s, every: 10 ms");
    told(&run, 3, &["load `push`", "is not defined at t = 0.0", "sqrt of -"]);
    kept(&run, 0.0975, 5e-3);
}

#[test]
fn a_force_without_bound() {
    // from 1 m into the pole of x'' = −1/x²: after π/√8 s
    let run = car("-1 N m^2/S.position^2", "S.position: 1 m, S.velocity: 0 m/s", "until: 3 s, every: 10 ms");
    let right = std::f64::consts::PI / 8.0_f64.sqrt();
    told(&run, 3, &["t = 1.1107", "grows without bound"]);
    kept(&run, right, 1e-6);
}

#[test]
fn a_fixed_step_that_is_too_long_from_the_start_on() {
    let run = run("gravity: [0, -9.81 m/s^2]
bodies: { upper: { bar: { length: 1 m, mass: 1 kg } }, lower: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, upper.start] }, Q: { revolute: [upper.end, lower.start] } }
start: { P.angle: 0 deg, Q.angle: 10 deg, P.omega: 30 rad/s, Q.omega: -90 rad/s }
studies:
  run: { dynamics: { until: 2 s, integrator: generalized-alpha, rho: 0.8, step: 0.5 s, coordinates: cartesian } }
");
    told(&run, 3, &["t = 0.0", "does not converge", "shorter `step`"]);
    assert!(run.files().is_empty());
}

#[test]
fn chatter_on_a_switch() {
    let run = car("-2 N*sign(S.velocity)", "S.position: 0 m, S.velocity: 1 m/s", "until: 1 s, every: 10 ms");
    told(&run, 3, &["t = 0.5", "sign", "clamp", "step-over"]);
    let table = kept(&run, 0.5, 1e-6);
    assert!((table.rows.last().unwrap()[1] - 0.25).abs() < 1e-6);
    // what the message proposes works
    let smooth = car("-2 N*clamp(S.velocity/1 mm*1 s, -1, 1)", "S.position: 0 m, S.velocity: 1 m/s", "until: 1 s, every: 10 ms");
    let end = smooth.succeeded().table("run").rows.pop().unwrap();
    assert!((end[1] - 0.25).abs() < 1e-5 && end[2].abs() < 1e-9, "{end:?}");
    let over = "until: 1 s, step: 1 ms, integrator: rk4, switches: step-over";
    let over = car("-2 N*sign(S.velocity)", "S.position: 0 m, S.velocity: 1 m/s", over);
    assert_eq!(over.code, 0, "{}", over.stderr);
    let end = over.table("run").rows.pop().unwrap();
    assert!((end[1] - 0.25).abs() < 2e-3 && end[2].abs() < 2e-3, "{end:?}");
}

#[test]
fn events_that_turn_the_motion_back_at_once() {
    let run = run("gravity: none
parameters: { q: 2 N }
bodies: { car: { mass: 1 kg } }
joints: { S: { slider: [ground, car.origin], axis: [1, 0] } }
loads: { push: { joint: S, force: q } }
events: { relay: { when: S.velocity - 1 m/s, set: { q: -q } } }
start: { S.position: 0 m, S.velocity: 0 m/s }
studies:
  run: { dynamics: { until: 2 s, every: 0.1 s }, columns: [time, S.velocity] }
");
    told(&run, 3, &["`relay`", "pile up", "hysteresis", "t = 0.5"]);
    kept(&run, 0.5, 1e-3);
}

#[test]
fn bodies_without_mass_or_inertia() {
    let leaf = run("gravity: [0, -9.81 m/s^2]
bodies: { upper: { bar: { length: 1 m, mass: 1 kg } }, lower: { bar: { length: 1 m } } }
joints: { P: { revolute: [ground, upper.start] }, Q: { revolute: [upper.end, lower.start] } }
start: { P.angle: 0 rad, Q.angle: 0 rad }
studies: { run: { dynamics: { until: 1 s } } }
");
    told(&leaf, 2, &["`lower`", "mass"]);
    let point = run("gravity: [0, -9.81 m/s^2]
bodies: { bob: { mass: 1 kg, points: { eye: [0, 10 cm] } } }
joints: { L: { distance: [ground, bob.origin], length: 1 m } }
start: { bob.x: 1 m, bob.y: 0 m }
studies: { run: { dynamics: { until: 1 s } } }
");
    told(&point, 2, &["`bob` can turn and has no inertia", "a point mass, which needs none"]);
    assert!(leaf.files().is_empty() && point.files().is_empty());
}

/// A four-bar with given lengths (cm) of crank, coupler and rocker on a base of 30 cm.
fn four_bar(lengths: [f64; 3], more: &str, start: &str) -> Run {
    let [crank, coupler, rocker] = lengths;
    run(&format!(
        "gravity: none
ground: {{ O: [0, 0], C: [30 cm, 0] }}
bodies:
  crank: {{ bar: {{ length: {crank} cm, mass: 1 kg }} }}
  coupler: {{ bar: {{ length: {coupler} cm, mass: 1 kg }} }}
  rocker: {{ bar: {{ length: {rocker} cm, mass: 1 kg }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.start] }}
{more}start: {{ {start} }}
studies:
  run: {{ dynamics: {{ until: 1 s, every: 5 ms }}, columns: [time, crank.angle, rocker.angle, rocker.omega] }}
"
    ))
}

#[test]
fn a_driver_into_a_dead_point() {
    let driver = "drivers: { drive: { joint: O, speed: 60 rpm } }\n";
    let run = four_bar([10.0, 30.0, 8.0], driver, "O.angle: 90 deg, coupler.angle: ~0 deg, rocker.angle: ~90 deg");
    // coupler and rocker are in line where |A-C| = 38 cm: cos θ = −0.74
    let right = ((-0.74_f64).acos() - std::f64::consts::FRAC_PI_2) / std::f64::consts::TAU;
    told(&run, 3, &["t = 0.1325", "drive"]);
    let table = kept(&run, right, 1e-4);
    assert!(table.rows.iter().all(|r| r.iter().all(|x| x.is_finite())));
}

#[test]
fn velocities_that_contradict_each_other() {
    let start = "O.angle: 90 deg, coupler.angle: ~40 deg, rocker.angle: ~97 deg, O.omega: 1 rad/s, C.omega: 5 rad/s";
    let run = four_bar([10.0, 30.0, 25.0], "", start);
    told(&run, 2, &["velocities contradict", "put `~`"]);
    assert!(run.files().is_empty());
}

#[test]
fn a_structure_stands_still() {
    let run = run("gravity: [0, -9.81 m/s^2]
ground: { O: [0, 0], C: [1 m, 0] }
bodies: { a: { bar: { length: 1 m, mass: 1 kg } }, b: { bar: { length: 1 m, mass: 1 kg } } }
joints: { O: { revolute: [ground.O, a.start] }, A: { revolute: [a.end, b.start] }, C: { revolute: [b.end, ground.C] } }
start: { a.angle: ~60 deg, b.angle: ~-60 deg }
studies: { run: { dynamics: { until: 1 s, every: 10 ms }, columns: [time, a.angle, O.fy] } }
");
    let run = run.succeeded();
    for row in run.table("run").rows {
        assert!((row[1] - std::f64::consts::FRAC_PI_3).abs() < 1e-12, "{row:?}");
        // half of the weight, from the ground on the bar
        assert!((row[2] - 9.81).abs() < 1e-9, "{row:?}");
    }
}

#[test]
fn a_motor_too_weak_to_lift_its_arm_comes_to_rest() {
    let run = run("gravity: [0, -9.81 m/s^2]
tables: { curve: { points: [[-100 rpm, 2 N m], [100 rpm, 2 N m], [200 rpm, 0 N m]] } }
bodies: { arm: { bar: { length: 1 m, mass: 1 kg } } }
joints: { O: { revolute: [ground, arm.start], damping: 0.5 N m s/rad } }
motors: { motor: { joint: O, curve: curve } }
start: { O.angle: -90 deg, O.omega: 0 rad/s }
studies: { run: { dynamics: { until: 40 s, every: 100 ms, tolerance: 1e-9 }, columns: [time, O.angle, O.omega] } }
");
    let run = run.succeeded();
    let end = run.table("run").rows.pop().unwrap();
    // 2 N m hold the arm where m g l/2 cos(angle) is as much
    assert!((end[1] + (2.0_f64 / (0.5 * 9.81)).acos()).abs() < 1e-6 && end[2].abs() < 1e-6, "{end:?}");
}

#[test]
fn more_rows_than_fit_are_refused() {
    for dynamics in ["until: 1 s, every: 1e-9 s", "until: 1 s, step: 1e-9 s, integrator: rk4"] {
        let run = car("0 N", "S.position: 0 m, S.velocity: 1 m/s", dynamics);
        told(&run, 2, &["1.000e9 rows of 3 numbers", "every:"]);
        assert!(run.files().is_empty());
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_rows() {
    use std::process::{Command, Stdio};
    use std::time::Duration;
    let directory = std::env::temp_dir().join(format!("grashof-interrupted-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&directory);
    std::fs::create_dir_all(&directory).unwrap();
    let model = "grashof: 1
name: long run
space: planar
gravity: [0, -9.81 m/s^2]
bodies: { upper: { bar: { length: 1 m, mass: 1 kg } }, lower: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, upper.start] }, Q: { revolute: [upper.end, lower.start] } }
start: { P.angle: 0 rad, Q.angle: 0 rad }
studies:
  first: { dynamics: { until: 10 ms } }
  long: { dynamics: { until: 1e5 s, every: 1 s, tolerance: 1e-10 }, columns: [time, P.angle, energy.total] }
";
    std::fs::write(directory.join("model.yaml"), model).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_grashof"))
        .current_dir(&directory)
        .args(["run", "model.yaml", "-o", "out", "--no-plots"])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // the first study is written: the second one is running
    for _ in 0..3000 {
        if directory.join("out/first.json").is_file() {
            break;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_millis(500));
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    if !sent.is_ok_and(|status| status.success()) {
        let _ = child.kill();
    }
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("interrupted") && stderr.contains("long"), "{stderr}");
    let csv = std::fs::read_to_string(directory.join("out/long.csv")).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert!(csv.ends_with('\n') && lines.len() > 2, "{} lines", lines.len());
    for line in &lines[1..] {
        assert!(line.split(',').count() == 3 && line.split(',').all(|x| x.parse::<f64>().is_ok_and(f64::is_finite)), "{line}");
    }
    let json = std::fs::read_to_string(directory.join("out/long.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["status"], "failed");
    assert_eq!(json["findings"][0]["code"], "stopped");
    let _ = std::fs::remove_dir_all(&directory);
}

/// A pendulum of 1e-12 m swings with a period of 2π√(l/g) = 2.006 µs; ten thousand seconds of that are of no use to anybody.
#[test]
fn a_run_that_would_not_end_says_what_is_so_fast() {
    let begun = std::time::Instant::now();
    let tiny = run("gravity: [0, -9.81 m/s^2]
bodies: { rod: { bar: { length: 1e-12 m }, attached: { weight: { at: end, mass: 1 kg } } } }
joints: { P: { revolute: [ground, rod.start] } }
start: { P.angle: -80 deg }
studies:
  run: { dynamics: { until: 1e4 s, every: 1 ms }, columns: [time, P.angle] }
");
    told(&tiny, 3, &["200000 steps were taken", "more than 1e7", "`P.angle` moves there with a period of 2.", "e-6 s", "`until: "]);
    assert_eq!(tiny.json("run")["status"], "failed");
    // what only holds an explicit scheme back settles in m/c = 1 ns
    let stiff = |integrator: &str| car("-1e9 N s/m*S.velocity", "S.velocity: 1 m/s", &format!("until: 10 s, every: 1 s{integrator}"));
    told(&stiff(", integrator: dop853"), 3, &["`S.position` moves there, which settles within 1.0e-9 s", "take `integrator: radau5`"]);
    assert_eq!(stiff(", integrator: radau5").code, 0);
    assert!(begun.elapsed() < std::time::Duration::from_secs(120), "{:?}", begun.elapsed());
}

/// With forces beyond the squares of numbers neither balancing nor the QR algorithm would end.
#[test]
fn eigenvalues_that_cannot_be_found_are_told() {
    for (kind, word) in [("modes: { at: start, damped: true }", "eigenvalues"), ("linearize: { at: start }", "poles")] {
        let run = run(&format!(
            "gravity: none
bodies: {{ car: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, car.origin], axis: [1, 0], damping: 1e308 N s/m }} }}
studies: {{ run: {{ {kind} }} }}
"
        ));
        told(&run, 3, &[word, "cannot be found"]);
    }
}

#[test]
fn a_motor_without_a_load_is_told_to_run_away() {
    let wheel = |torque: &str, dynamics: &str| {
        run(&format!(
            "gravity: [0, -9.81 m/s^2]
bodies: {{ wheel: {{ bar: {{ length: 10 cm, mass: 1 kg }} }} }}
joints: {{ O: {{ revolute: [ground, wheel.start] }} }}
loads: {{ drive: {{ joint: O, torque: {torque} }} }}
start: {{ O.angle: 0 deg, O.omega: 0 rad/s }}
studies:
  run: {{ dynamics: {{ {dynamics} }}, columns: [time, O.omega] }}
"
        ))
    };
    // too many turns, and speeds without bound
    for (torque, dynamics) in [("5 N m", "until: 1e6 s, every: 1e5 s"), ("1 N m + 1 N m s/rad*O.omega", "until: 100 s, every: 10 s")] {
        let found = wheel(torque, dynamics);
        told(&found, 3, &["`O.angle` turns with", "faster all the time", "without a load", "`damping`"]);
        for word in ["in the units that were meant", "is not a number", "force jumps"] {
            assert!(!found.stderr.contains(word), "{word} in:\n{}", found.stderr);
        }
    }
    // a wheel whose speed settles and whose load breaks down does not run away
    let broken = wheel("\"if(O.angle < 2000, 1 N m - 0.1 N m s/rad*O.omega, sqrt(-1)*1 N m)\"", "until: 1e3 s, every: 100 s");
    assert!(!broken.stderr.contains("faster"), "{}", broken.stderr);
}
