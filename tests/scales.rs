//! Very different inertias in one mechanism: light structures, rows that are nearly dependent, and inertias that grow by orders of
//! magnitude on the way.

use crate::common::study;
use crate::reference::program::run_text;
use grashof::mechanism::Coordinates;

/// A light parallelogram through its flat positions keeps its energy beside a mechanism that is 1e8 times as heavy.
#[test]
fn light_mechanisms_know_no_heavy_ones_beside_them() {
    let text = "grashof: 1
name: side by side
space: planar
gravity: [0, -9.81 m/s^2]
ground: { O: [0, 0], C: [0.2 m, 0], Z: [5 m, 0] }
bodies:
  c: { bar: { length: 0.1 m, mass: 1 g } }
  l: { bar: { length: 0.2 m, mass: 1 g } }
  r: { bar: { length: 0.1 m, mass: 1 g } }
  z: { bar: { length: 1 m, mass: 1e5 kg } }
joints:
  O: { revolute: [ground.O, c.start] }
  A: { revolute: [c.end, l.start] }
  B: { revolute: [l.end, r.end] }
  C: { revolute: [ground.C, r.start] }
  Z: { revolute: [ground.Z, z.start] }
start: { O.angle: 90 deg, O.omega: 20 rad/s, l.angle: ~0 deg, r.angle: ~90 deg, Z.angle: -90 deg }
studies:
  run: { dynamics: { until: 5 s, every: 0.1 s, tolerance: 1e-12, coordinates: cartesian }, columns: [O.angle, O.omega] }
";
    // two bars about their ends and one that is only shifted, of 1 g
    let energy = |row: &[f64]| 1e-3 * (0.5 * 0.01 * (1.0 + 2.0 / 3.0) * row[1] * row[1] + 9.81 * 0.1 * 2.0 * row[0].sin());
    let found = study(text, "run", Coordinates::Joint);
    let start = energy(&found.rows[0]);
    let off = found.rows.iter().map(|row| (energy(row) - start).abs()).fold(0.0, f64::max);
    assert!(off < 1e-8 * start, "{off:e} J of {start:e} J");
}

/// A truss of two bars with a slope of 1e-4 at rest carries F/(2 slope): its rows are nearly dependent all along.
#[test]
fn shallow_trusses_carry_what_is_put_on_them() {
    for (height, within) in [("10 mm", 1e-9), ("1 mm", 1e-9), ("0.1 mm", 1e-8)] {
        for settings in ["", ", coordinates: cartesian", ", integrator: radau5"] {
            let text = format!(
                "grashof: 1
name: shallow truss
space: planar
gravity: none
parameters: {{ height: {height} }}
ground: {{ A: [-1 m, 0], B: [1 m, 0] }}
bodies:
  l: {{ mass: 1 kg, inertia: 0.1 kg*m^2, points: {{ end: [1 m, height] }} }}
  r: {{ mass: 1 kg, inertia: 0.1 kg*m^2, points: {{ end: [-1 m, height] }} }}
joints:
  A: {{ revolute: [ground.A, l.origin] }}
  B: {{ revolute: [ground.B, r.origin] }}
  C: {{ revolute: [l.end, r.end] }}
loads: {{ f: {{ at: l.end, force: [0, -10 N] }} }}
start: {{ l.angle: ~0 deg, r.angle: ~0 deg }}
measures: {{ part: A.fx*2*height/(10 N*1 m) }}
studies:
  run: {{ dynamics: {{ until: 0.1 s, every: 0.05 s{settings} }}, columns: [part, A.fy, l.angle] }}
"
            );
            let found = study(&text, "run", Coordinates::Joint);
            let last = found.rows.last().expect("a row");
            let off = (last[0].abs() - 1.0).abs().max((last[1].abs() / 5.0 - 1.0).abs()).max(last[2].abs());
            assert!(off < within, "{height}{settings}: {last:?}");
        }
    }
}

/// A heavy bar that hangs on a truss of six light ones begins to fall with 1.5 g/L, and swings with the square root of it.
#[test]
fn light_structures_carry_heavy_bodies() {
    let text = "grashof: 1
name: heavy bar on a light truss
space: planar
gravity: [0, -9.81 m/s^2]
ground: { A: [0, 0], B: [0, -0.11 m] }
bodies:
  t0: { bar: { from: [0 m, 0 m], to: [1 m, -0.14 m], mass: 10 g } }
  t1: { bar: { from: [0 m, -0.11 m], to: [1 m, -0.14 m], mass: 10 g } }
  t2: { bar: { from: [0 m, -0.11 m], to: [2 m, -0.15 m], mass: 10 g } }
  t3: { bar: { from: [1 m, -0.14 m], to: [2 m, -0.15 m], mass: 10 g } }
  t4: { bar: { from: [1 m, -0.14 m], to: [3 m, -0.08 m], mass: 10 g } }
  t5: { bar: { from: [2 m, -0.15 m], to: [3 m, -0.08 m], mass: 10 g } }
  bob: { bar: { from: [3 m, -0.08 m], to: [3.5 m, -0.08 m], mass: 30 kg } }
joints:
  j0: { revolute: [ground.A, t0.start], cut: true }
  j1: { revolute: [ground.B, t1.start], cut: true }
  k0: { revolute: [t0.end, t1.end], cut: true }
  j2: { revolute: [ground.B, t2.start], cut: true }
  j3: { revolute: [t0.end, t3.start], cut: true }
  k1: { revolute: [t2.end, t3.end], cut: true }
  j4: { revolute: [t0.end, t4.start], cut: true }
  j5: { revolute: [t2.end, t5.start], cut: true }
  k2: { revolute: [t4.end, t5.end], cut: true }
  hang: { revolute: [t4.end, bob.start], cut: true }
start: { hang.angle: 0 deg }
studies:
  dop853: { dynamics: { until: 10 ms, every: 10 ms, tolerance: 1e-10 }, columns: [hang.alpha, hang.fy] }
  bdf: { dynamics: { until: 10 ms, every: 10 ms, tolerance: 1e-6, integrator: bdf }, columns: [hang.alpha, hang.fy] }
  radau5: { dynamics: { until: 10 ms, every: 10 ms, integrator: radau5 }, columns: [hang.alpha, hang.fy] }
  vibration: { linearize: { at: statics }, columns: [hang.angle] }
";
    for name in ["dop853", "bdf", "radau5"] {
        let found = study(text, name, Coordinates::Joint);
        let [alpha, force] = [found.rows[0][0] / -29.43 - 1.0, found.rows[0][1] / 73.575 - 1.0];
        assert!(alpha.abs().max(force.abs()) < 1e-8, "{name}: {alpha:e} {force:e}");
        assert!(found.findings.is_empty(), "{name}: {:?}", found.findings);
    }
    // in balance, where accelerations are round-off, and near it
    for angle in ["-90 deg", "-97 deg", "-90.001 deg"] {
        let found = study(&text.replace("hang.angle: 0 deg", &format!("hang.angle: {angle}")), "dop853", Coordinates::Joint);
        assert!(found.findings.is_empty(), "{angle}: {:?}", found.findings);
    }
    let found = study(text, "vibration", Coordinates::Joint);
    assert!(found.findings.iter().all(|f| f.code != "not-at-rest"), "{:?}", found.findings);
    let poles = found.lists.iter().find(|list| list.name == "poles_imaginary").expect("poles");
    let swing = poles.values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    assert!((swing / 29.43_f64.sqrt() - 1.0).abs() < 1e-6, "{swing}");
}

/// A body slides away along an arm that is turned by a law of time: what the arm does is the law, and what its drive does is
/// (I + m r²) α + 2 m r ṙ ω. On the way the inertia about the hinge grows to 10¹⁰ times that at the start, which rows are scaled by.
#[test]
fn rows_feel_inertias_that_grow() {
    let [near, far, farthest] = ["1 m/s", "100 m/s", "10 km/s"];
    let explicit = [near, far, farthest];
    for (integrator, coordinates, speeds) in [
        ("dop853", "joint", &explicit[..]),
        ("dop853", "minimal", &explicit),
        ("radau5", "joint", &[near, far]),
        ("bdf", "joint", &[near, far]),
    ] {
        for speed in speeds {
            let text = format!(
                "grashof: 1
name: sliding away
space: planar
gravity: none
bodies:
  arm: {{ mass: 1 kg, inertia: 0.02 kg*m^2 }}
  load: {{ mass: 1 kg, inertia: 0.001 kg*m^2 }}
joints:
  hinge: {{ revolute: [ground, arm.origin] }}
  way: {{ slider: [arm.origin, load.origin], axis: [1, 0] }}
drivers: {{ drive: {{ joint: hinge, angle: 0.2*sin(t/(1 s)) }} }}
start: {{ way.position: 1 m, way.velocity: {speed} }}
measures:
  off: hinge.alpha + 0.2*sin(t/(1 s))*1 rad/s^2
  wanted: (0.021 kg*m^2 + 1 kg*way.position^2)*hinge.alpha + 2 kg*way.velocity*hinge.omega*way.position
studies:
  run:
    dynamics: {{ until: 10 s, every: 1 s, integrator: {integrator}, coordinates: {coordinates}, tolerance: 1e-9 }}
    columns: [off, wanted, drive.torque, way.position]
"
            );
            let found = study(&text, "run", Coordinates::Joint);
            let last = found.rows.last().expect("a row");
            assert!(last[3] > 1.0, "it has slid away");
            let largest = found.rows.iter().fold(0.0, |m: f64, row| m.max(row[1].abs()));
            for row in &found.rows {
                let off = row[0].abs().max((row[2] - row[1]).abs() / largest);
                assert!(off < 1e-12, "{integrator}, {coordinates}, {speed}: off by {off:e} in {row:?}");
            }
        }
    }
}

/// A thin bar in space has no inertia about itself: where nothing holds that turn a motion is refused, however the bar stands; its tensor
/// is then not zero there but round-off. Where it is held, or the bar has a thickness, it moves.
#[test]
fn thin_bars_that_turn_about_themselves_are_refused_in_any_pose() {
    let model = |bar: &str, joint: &str, rpy: &str, keys: &str| {
        format!(
            "grashof: 1
name: thin bar
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies:
  b: {{ bar: {{ length: 0.7 m, mass: 2 kg{bar} }} }}
  c: {{ bar: {{ length: 0.5 m, mass: 1 kg, width: 1 cm, height: 1 cm }} }}
joints:
  J: {{ {joint} }}
  K: {{ revolute: [b.end, c.start], axis: [1, 0, 0] }}
start: {{ {rpy} }}
studies:
  s: {{ dynamics: {{ until: 10 ms, every: 5 ms{keys} }} }}
"
        )
    };
    let ball = "spherical: [ground, b.start]";
    for rpy in ["", "b.rpy: [0.3, 0.8, -0.4]", "b.rpy: [1.1, -0.2, 0.7]", "b.rpy: [-2.1, 0.4, 3]"] {
        for keys in ["", ", integrator: radau5", ", coordinates: cartesian", ", coordinates: minimal"] {
            // the hinge along the bar leaves its turn without inertia, the one across gives it that of the other bar
            let found = run_text(&model("", ball, rpy, keys), &["--no-plots"]);
            let words = "body `b` can turn about its own axis and has no inertia about it";
            assert!(found.code == 2 && found.stderr.contains(words), "{rpy}{keys}: {} {}", found.code, found.stderr);
        }
        let thick = run_text(&model(", width: 1 cm, height: 1 cm", ball, rpy, ""), &["--no-plots"]);
        assert_eq!(thick.code, 0, "{rpy}: {}", thick.stderr);
        let across = run_text(&model("", ball, rpy, "").replace("axis: [1, 0, 0]", "axis: [0, 1, 0]"), &["--no-plots"]);
        assert_eq!(across.code, 0, "{rpy}: {}", across.stderr);
    }
}

/// A rod without mass between two balls turns about itself, and nothing resists that; between a ball and a universal joint it does not turn.
#[test]
fn a_rod_without_mass_that_turns_about_itself_is_refused() {
    let model = |end: &str, keys: &str| {
        format!(
            "grashof: 1
name: rod without mass
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: {{ C: [0.2 m, 0.3 m, 0.05 m] }}
bodies:
  a: {{ bar: {{ length: 0.1 m, mass: 0.4 kg, width: 1 cm, height: 1 cm }} }}
  r: {{ bar: {{ length: 0.3 m, mass: 0 kg }} }}
  c: {{ bar: {{ length: 0.3 m, mass: 0.6 kg, width: 1 cm, height: 1 cm }} }}
joints:
  A: {{ revolute: [ground, a.start], axis: [0, 0, 1] }}
  B: {{ {end} }}
  D: {{ spherical: [r.end, c.end] }}
  C: {{ revolute: [ground.C, c.start], axis: [1, 0.2, 0.1], to: [0, 0, 1] }}
start: {{ A.angle: 0.3 rad, A.omega: 3 rad/s, C.angle: ~-1 rad }}
studies: {{ s: {{ dynamics: {{ until: 50 ms, every: 5 ms{keys} }} }} }}
"
        )
    };
    for keys in ["", ", coordinates: cartesian", ", integrator: radau5"] {
        let found = run_text(&model("spherical: [a.end, r.start]", keys), &["--no-plots"]);
        let words = "body `r` can turn about its own axis and has no inertia about it";
        assert!(found.code == 2 && found.stderr.contains(words), "{keys}: {} {}", found.code, found.stderr);
        let held = run_text(&model("universal: [a.end, r.start], axes: [[0, 0, 1], [0, 1, 0]]", keys), &["--no-plots"]);
        assert_eq!(held.code, 0, "{keys}: {}", held.stderr);
    }
}

/// A thin bar whose turn is held is not blamed for a link that is too light for the digits of what hangs on it; a hinge along a thin bar is
/// found as a ball joint is, and among many bars the one that turns is named.
#[test]
fn only_thin_bars_that_turn_are_blamed() {
    let study = "studies: { s: { dynamics: { until: 1 ms, every: 1 ms } } }\n";
    let light = format!(
        "grashof: 1
name: light link
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: {{ Z: [0, 3 m, 0] }}
bodies:
  long: {{ bar: {{ length: 5 m, width: 0.1 m, height: 0.1 m, mass: 20 kg }} }}
  link: {{ bar: {{ length: 5 cm, width: 1 mm, height: 1 mm, mass: 1 g }} }}
  z: {{ bar: {{ length: 1 m, mass: 1 kg }} }}
joints:
  A: {{ spherical: [ground, link.start] }}
  B: {{ spherical: [link.end, long.start] }}
  Z: {{ revolute: [ground.Z, z.start], axis: [0, 1, 0] }}
{study}"
    );
    let run = run_text(&light, &["--no-plots"]);
    assert!(!run.stderr.contains("`z`"), "{}", run.stderr);
    let n = 60;
    let each = |f: &dyn Fn(usize) -> String| (0..n).map(f).collect::<String>();
    let chain = format!(
        "grashof: 1
name: chain of thin bars
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies:
{}joints:
{}{study}",
        each(&|i| format!("  b{i}: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\n")),
        each(&|i| {
            let before = if i == 0 { "ground".to_owned() } else { format!("b{}.end", i - 1) };
            if i == 41 {
                format!("  J{i}: {{ revolute: [{before}, b{i}.start], axis: [1, 2, 0.7], to: [1, 0, 0] }}\n")
            } else {
                format!("  J{i}: {{ revolute: [{before}, b{i}.start], axis: [0, {}, 1] }}\n", i % 3)
            }
        }),
    );
    for coordinates in ["joint", "cartesian"] {
        let text = chain.replace("every: 1 ms }", &format!("every: 1 ms, coordinates: {coordinates} }}"));
        let run = run_text(&text, &["--no-plots"]);
        assert!(run.code == 2 && run.stderr.contains("body `b41` can turn about its own axis"), "{coordinates}: {}", run.stderr);
    }
}

/// Two thin bars that come into one line have no inertia about it in that instant, and a massless crank has none at its dead point: a run
/// that cannot pass says which motion it is. Bars with a thickness pass, bars that turn about their line bounce, and a massless crank that
/// comes to rest beside its dead point has been there with short steps and is left alone.
#[test]
fn inertia_that_vanishes_on_the_way_is_told() {
    let bars = |bar: &str, keys: &str| {
        format!(
            "grashof: 1
name: two bars thrown
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies:
  a: {{ bar: {{ length: 20 cm, mass: 1 kg{bar} }} }}
  b: {{ bar: {{ length: 20 cm, mass: 1 kg{bar} }} }}
joints: {{ J: {{ revolute: [a.end, b.start], axis: [0, 0, 1] }} }}
start: {{ a.vx: 8 m/s, a.vy: 3 m/s, a.vz: 6 m/s, J.angle: 60 deg, J.omega: 300 deg/s }}
studies: {{ fly: {{ dynamics: {{ until: 1.5 s, every: 20 ms{keys} }}, columns: [time, J.angle] }} }}
"
        )
    };
    // some pass by chance, in a step whose stages all lie beside that instant
    let mut told = 0;
    for (integrator, tolerance) in [("dop853", 1e-8), ("dop853", 1e-9), ("bdf", 1e-9), ("newmark", 1e-8)] {
        let keys = format!(", integrator: {integrator}, tolerance: {tolerance:e}");
        let run = run_text(&bars("", &keys), &["--no-plots"]);
        let stopped = run.stderr.contains("at t = 0.77") && run.stderr.contains("it has lost its inertia");
        assert!(run.code == 0 || run.code == 3 && stopped, "{keys}: {} {}", run.code, run.stderr);
        told += usize::from(run.code == 3);
        let thick = run_text(&bars(", width: 1 cm, height: 1 cm", &keys), &["--no-plots"]);
        assert_eq!(thick.code, 0, "{keys}: {}", thick.stderr);
    }
    assert!(told >= 1);
    let turned = bars("", ", tolerance: 1e-6").replace("start: {", "start: { a.wx: 1e-5 rad/s,");
    let bounces = run_text(&turned, &["--no-plots"]);
    assert_eq!(bounces.code, 0, "{}", bounces.stderr);
    let crank = "grashof: 1
name: massless crank
space: planar
gravity: none
bodies:
  crank: { bar: { length: 10 cm, mass: 0 } }
  rod: { bar: { length: 30 cm, mass: 0 } }
  block: { mass: 1 kg }
joints:
  A: { revolute: [ground, crank.start] }
  B: { revolute: [crank.end, rod.start] }
  C: { revolute: [rod.end, block] }
  S: { slider: [ground, block], axis: [1, 0] }
start: { A.angle: 60 deg, A.omega: 5 rad/s }
studies: { turn: { dynamics: { until: 3 s, every: 20 ms }, columns: [time, S.position] } }
";
    for (coordinates, name) in [("joint", "A.angle"), ("cartesian", "crank.angle"), ("minimal", "A.angle")] {
        let run = run_text(&crank.replace("every: 20 ms", &format!("every: 20 ms, coordinates: {coordinates}")), &["--no-plots"]);
        let told = run.stderr.contains(&format!("a motion of `{name}`")) && run.stderr.contains("it has lost its inertia");
        assert!(run.code == 3 && told, "{coordinates}: {} {}", run.code, run.stderr);
    }
    let rests = crank
        .replace("length: 10 cm, mass: 0", "length: 2 mm, mass: 0")
        .replace("length: 30 cm, mass: 0", "length: 6 mm, mass: 0")
        .replace("mass: 1 kg", "mass: 1 g")
        .replace("crank.start]", "crank.start], limits: { to: 170 deg, stiffness: 100 N m/rad, damping: 1e-5 N m s/rad }")
        .replace("A.omega: 5 rad/s }", "A.omega: 0 }\nloads: { p: { joint: S, force: -0.001 N } }")
        .replace("until: 3 s, every: 20 ms", "until: 0.8 s, every: 20 ms, integrator: radau5");
    let run = run_text(&rests, &["--no-plots"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
}

/// A crank and a rod of almost no mass lead a block to and fro at one speed: it turns back at once where they come into line, when all of its
/// energy is theirs for an instant. Its way is a sawtooth but for a part of about the ratio of masses.
#[test]
fn almost_massless_cranks_carry_energy_through_their_dead_points() {
    let (r, l, angle, omega) = (0.1_f64, 0.3_f64, 60_f64.to_radians(), 5.0);
    let (s, c) = angle.sin_cos();
    let root = (l * l - (r * s).powi(2)).sqrt();
    let (begin, speed) = (r * c + root, omega * r * s * (1.0 + r * c / root));
    let sawtooth = |t: f64| {
        let way = (begin - (l - r) - speed * t).rem_euclid(4.0 * r);
        l - r + if way < 2.0 * r { way } else { 4.0 * r - way }
    };
    let methods = [("dop853", "joint"), ("dop853", "cartesian"), ("bdf", "joint"), ("radau5", "joint"), ("dop853", "minimal")];
    for (integrator, coordinates) in methods {
        for mass in [1e-6, 1e-9, 1e-11] {
            let text = format!(
                "grashof: 1
name: almost massless crank
space: planar
gravity: none
bodies:
  crank: {{ bar: {{ length: 10 cm, mass: {mass:e} kg }} }}
  rod: {{ bar: {{ length: 30 cm, mass: {mass:e} kg }} }}
  block: {{ mass: 1 kg }}
joints:
  A: {{ revolute: [ground, crank.start] }}
  B: {{ revolute: [crank.end, rod.start] }}
  C: {{ revolute: [rod.end, block] }}
  S: {{ slider: [ground, block], axis: [1, 0] }}
start: {{ A.angle: 60 deg, A.omega: 5 rad/s }}
studies:
  turn:
    dynamics: {{ until: 3 s, every: 50 ms, tolerance: 1e-8, integrator: {integrator}, coordinates: {coordinates} }}
    columns: [time, S.position]
"
            );
            let found = study(&text, "turn", Coordinates::Joint);
            let off = found.rows.iter().map(|row| (row[1] - sawtooth(row[0])).abs()).fold(0.0, f64::max);
            assert!(off < 5e-8 + 10.0 * mass, "{integrator}, {coordinates}, {mass:e} kg: {off:e} m");
        }
    }
}

/// The same in space with unequal masses, and a block of almost no mass on a heavy rod: as in cartesian coordinates, whose light bodies can
/// all be shifted.
#[test]
fn slides_and_turns_of_very_different_inertia_move_as_in_cartesian_coordinates() {
    let space = "grashof: 1
name: light rod in space
space: spatial
gravity: [0, -9.81 m/s^2, 0]
ground: { O: [0, 0, 0], P: [0, 48 mm, 24 mm] }
bodies:
  crank: { bar: { length: 0.1 m, mass: 0.4 g, width: 5 mm, height: 5 mm } }
  rod: { bar: { length: 0.33 m, mass: 1e-8 kg, width: 5 mm, height: 5 mm } }
  block: { box: { size: [24 mm, 24 mm, 24 mm], mass: 1.6 kg } }
joints:
  A: { revolute: [ground.O, crank.start], axis: [0, 0, 1] }
  B: { spherical: [crank.end, rod.start] }
  C: { universal: [rod.end, block], axes: [[0, 0, 1], [0, 1, 0]] }
  S: { slider: [ground.P, block], axis: [1, 0, 0] }
";
    let plane = "grashof: 1
name: light block
space: planar
gravity: none
bodies:
  crank: { bar: { length: 0.18 m, mass: 1e-7 kg } }
  rod: { bar: { length: 0.28 m, mass: 6 kg } }
  block: { mass: 2e-12 kg }
joints:
  A: { revolute: [ground, crank.start] }
  B: { revolute: [crank.end, rod.start] }
  C: { revolute: [rod.end, block] }
  S: { slider: [ground, block], axis: [1, 0] }
";
    for model in [space, plane] {
        let [joint, cartesian] = ["joint", "cartesian"].map(|coordinates| {
            let dynamics = format!("until: 2 s, every: 50 ms, tolerance: 1e-8, coordinates: {coordinates}");
            let text = format!(
                "{model}start: {{ A.angle: 60 deg, A.omega: 5 rad/s }}
studies: {{ turn: {{ dynamics: {{ {dynamics} }}, columns: [A.angle, S.position] }} }}
"
            );
            study(&text, "turn", Coordinates::Joint)
        });
        let off = joint.rows.iter().zip(&cartesian.rows).flat_map(|(a, b)| a.iter().zip(b)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(joint.rows.len() == 41 && off < 2e-7, "{off:e}");
        assert!(joint.certificate.march.as_ref().is_some_and(|march| march.counts.steps < 2000), "{:?}", joint.certificate);
    }
}
