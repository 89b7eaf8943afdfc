//! Coordinates, spaces and integrators agree; energies balance.

use super::certified;
use crate::reference::Verdict;
use crate::reference::program::{Run, Table, run_text};

/// Pseudo-random numbers in [0, 1): x ← 6364136223846793005 x + 1442695040888963407 (Knuth).
struct Random(u64);

impl Random {
    fn next(&mut self, from: f64, to: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        from + (to - from) * ((self.0 >> 11) as f64 / (1u64 << 53) as f64)
    }
}

/// A linkage O-A-E-B-C of four bars between two fixed pivots, two degrees of freedom, with gravity, a damped spring, a damped
/// hinge and a periodic torque; started at random, or with the first bar driven.
fn five_bar(space: &str, driven: bool, seed: u64) -> String {
    let random = &mut Random(seed);
    let (a, c) = (random.next(1.6, 2.2), random.next(0.9, 1.5));
    let (rate_a, rate_c) = (random.next(-2.0, 2.0), random.next(-2.0, 2.0));
    let (left, right, first, second, base) = (0.2, 0.22, 0.35, 0.33, 0.3);
    // E by the circles about A and B, above their line
    let (ax, ay) = (left * f64::cos(a), left * f64::sin(a));
    let (bx, by) = (base + right * f64::cos(c), right * f64::sin(c));
    let d = (bx - ax).hypot(by - ay);
    let along = (d * d + first * first - second * second) / (2.0 * d);
    let up = (first * first - along * along).sqrt();
    let (ex, ey) = (ax + (along * (bx - ax) - up * (by - ay)) / d, ay + (along * (by - ay) + up * (bx - ax)) / d);
    let (turn_a, turn_b) = ((ey - ay).atan2(ex - ax) - a, (ey - by).atan2(ex - bx) - c);
    let (point, axis) = if space == "planar" { ("", "") } else { (", 0", ", axis: [0, 0, 1]") };
    let start = if driven { String::new() } else { format!("O.angle: {a} rad, O.omega: {rate_a} rad/s, ") };
    let drive =
        if driven { format!("drivers: {{ drive: {{ joint: O, angle: {a} rad + 0.3 rad*sin(4 rad/s*t) }} }}\n") } else { String::new() };
    format!(
        "grashof: 1
name: five-bar
space: {space}
gravity: [0, -9.81 m/s^2{point}]
ground: {{ O: [0, 0{point}], C: [{base} m, 0{point}] }}
bodies:
  left: {{ bar: {{ length: {left} m, mass: 0.4 kg }} }}
  one: {{ bar: {{ length: {first} m, mass: 0.6 kg }} }}
  two: {{ bar: {{ length: {second} m, mass: 0.5 kg }} }}
  right: {{ bar: {{ length: {right} m, mass: 0.45 kg }} }}
joints:
  O: {{ revolute: [ground.O, left.start]{axis}, damping: 0.02 N m s/rad }}
  A: {{ revolute: [left.end, one.start]{axis} }}
  C: {{ revolute: [ground.C, right.start]{axis} }}
  B: {{ revolute: [right.end, two.start]{axis} }}
  E: {{ revolute: [one.end, two.end]{axis} }}
springs:
  strut: {{ between: [one.end, ground.C], stiffness: 40 N/m, length: 0.3 m, damping: 0.5 N s/m }}
loads:
  pull: {{ joint: C, torque: 0.2 N m*sin(7 rad/s*t) }}
{drive}start: {{ {start}C.angle: {c} rad, C.omega: {rate_c} rad/s, A.angle: ~{turn_a} rad, B.angle: ~{turn_b} rad }}
studies:
"
    )
}

const COLUMNS: &str = "[time, left.end.x, left.end.y, left.end.vx, right.end.x, right.end.y, right.end.vy, one.end.x, one.end.y, one.end.vx, one.end.vy, strut.force, energy.total]";

fn go(model: &str, dynamics: &str) -> (Run, Table) {
    let text = format!("{model}  run:\n    dynamics: {{ {dynamics} }}\n    columns: {COLUMNS}\n");
    let run = run_text(&text, &["--no-plots"]).succeeded();
    let table = run.table("run");
    (run, table)
}

/// Largest difference of a column on the common grid, each column by its largest value.
fn apart(found: &Table, right: &Table, step: f64, count: usize) -> f64 {
    let (a, b) = (found.on_grid(0.0, step, count), right.on_grid(0.0, step, count));
    let mut worst: f64 = 0.0;
    for name in &right.names {
        let (x, y) = (found.column(name), right.column(name));
        let size = b.iter().fold(1.0_f64, |m, i| m.max(y[*i].abs()));
        worst = a.iter().zip(&b).fold(worst, |m, (i, k)| m.max((x[*i] - y[*k]).abs() / size));
    }
    worst
}

/// Tolerance of the runs, and how much the motion may amplify it: a linkage that whips by is sensitive to its start.
const TOLERANCE: f64 = 1e-10;
const AMPLIFIED: f64 = 50.0;

#[test]
fn all_coordinates_in_the_plane_and_in_space() {
    let mut verdict = Verdict::default();
    for driven in [false, true] {
        for seed in 1..=4 {
            let dynamics = |coordinates: &str, tolerance: f64| {
                format!("until: 0.6 s, every: 20 ms, tolerance: {tolerance:e}, coordinates: {coordinates}")
            };
            // more exact than what is compared with it
            let (one, right) = go(&five_bar("planar", driven, seed), &dynamics("joint", 0.1 * TOLERANCE));
            for (space, coordinates) in
                [("planar", "cartesian"), ("planar", "minimal"), ("spatial", "joint"), ("spatial", "cartesian"), ("spatial", "minimal")]
            {
                // only the independent coordinates are in the error test there, and a poor chart makes much more of their errors
                let asked = if coordinates == "minimal" { 0.01 * TOLERANCE } else { TOLERANCE };
                let (other, found) = go(&five_bar(space, driven, seed), &dynamics(coordinates, asked));
                let what = format!("{space} {coordinates}{}", if driven { ", driven" } else { "" });
                verdict.close(&what, format_args!("seed {seed}"), apart(&found, &right, 0.02, 30), 0.0, 2.0 * AMPLIFIED * TOLERANCE);
                let steps = [&one, &other].map(|r| certified(r, "run", "steps"));
                verdict.holds(steps[1] < 5.0 * steps[0], format!("{what}, seed {seed}: {} steps beside {}", steps[1], steps[0]));
            }
        }
    }
    verdict.give("coordinates");
}

#[test]
fn integrators_agree() {
    let mut verdict = Verdict::default();
    for seed in [5, 6] {
        let model = five_bar("planar", false, seed);
        let (_, right) = go(&model, "until: 0.5 s, every: 20 ms, tolerance: 1e-11, integrator: dop853");
        for (dynamics, within) in [
            ("integrator: rk4, step: 0.1 ms", 1e-7),
            ("integrator: rk4, tolerance: 1e-10", 1e-7),
            ("integrator: newmark, step: 0.05 ms", 2e-5),
            ("integrator: central-difference, step: 0.05 ms", 2e-5),
        ] {
            let (_, found) = go(&model, &format!("until: 0.5 s, every: 20 ms, {dynamics}"));
            verdict.close(dynamics, format_args!("seed {seed}"), apart(&found, &right, 0.02, 25), 0.0, within);
        }
    }
    verdict.give("integrators");
}

#[test]
fn every_scheme_goes_the_same_way() {
    let mut verdict = Verdict::default();
    let plane = five_bar("planar", false, 5);
    // a rod on a ball joint with a free box tied to its end: quaternions of the tree, and as cartesian coordinates a ball that is cut
    let space = "grashof: 1
name: rod and box
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies:
  rod: { bar: { length: 0.5 m, width: 4 cm, height: 2 cm, mass: 1 kg } }
  crate: { box: { size: [10 cm, 20 cm, 30 cm], mass: 2 kg } }
joints: { S: { spherical: [ground, rod.start] } }
springs: { tie: { between: [rod.end, crate.origin], stiffness: 60 N/m, length: 0.2 m, damping: 0.3 N s/m } }
start: { rod.wx: 4 rad/s, rod.wy: -2 rad/s, rod.wz: 7 rad/s, crate.x: 0.6 m, crate.y: 0.3 m, crate.wx: 5 rad/s, crate.wy: 0.2 rad/s, crate.wz: 1 rad/s }
studies:
"
    .to_string();
    let columns = "[time, rod.end.x, rod.end.y, rod.end.vz, crate.x, crate.vy, crate.qw, crate.wy, tie.force, energy.total]";
    let spatial = |dynamics: &str| {
        let text = format!("{space}  run:\n    dynamics: {{ {dynamics} }}\n    columns: {columns}\n");
        run_text(&text, &["--no-plots"]).succeeded().table("run")
    };
    let exact = "until: 0.5 s, every: 20 ms, tolerance: 1e-11, integrator: dop853";
    let (in_plane, in_space) = (go(&plane, exact).1, spatial(exact));
    for (dynamics, within) in [
        ("integrator: bdf, tolerance: 1e-9", 1e-6),
        ("integrator: radau5, tolerance: 1e-9", 1e-6),
        ("integrator: auto, tolerance: 1e-9", 1e-6),
        ("integrator: bdf, tolerance: 1e-8, coordinates: cartesian", 1e-5),
        ("integrator: radau5, tolerance: 1e-8, coordinates: cartesian", 1e-5),
        ("integrator: hht, step: 0.1 ms", 1e-4),
        ("integrator: generalized-alpha, step: 0.1 ms, coordinates: cartesian", 1e-4),
        ("integrator: generalized-alpha, step: 0.1 ms, level: position, coordinates: cartesian", 1e-4),
    ] {
        let dynamics = format!("until: 0.5 s, every: 20 ms, {dynamics}");
        verdict.close("plane", &dynamics, apart(&go(&plane, &dynamics).1, &in_plane, 0.02, 25), 0.0, within);
        verdict.close("space", &dynamics, apart(&spatial(&dynamics), &in_space, 0.02, 25), 0.0, within);
    }
    verdict.give("schemes");
}

#[test]
fn energies_balance() {
    // motor, damped hinge, damped spring, table load with kinks, flywheel: everything that does work
    let text = "grashof: 1
name: engine
space: planar
gravity: [0, -9.81 m/s^2]
tables:
  curve: { points: [[0 rpm, 6 N m], [200 rpm, 9 N m], [400 rpm, 0 N m], [500 rpm, -9 N m]] }
  resistance: { points: [[0 mm, 0 N], [20 mm, 50 N], [60 mm, 90 N]] }
ground: { O: [0, 0], wall: [50 cm, 10 cm] }
bodies:
  crank: { bar: { length: 8 cm, mass: 1 kg }, attached: { wheel: { inertia: 0.02 kg m^2 } } }
  rod: { bar: { length: 25 cm, mass: 0.8 kg } }
  ram: { mass: 1.5 kg }
joints:
  O: { revolute: [ground.O, crank.start], damping: 0.05 N m s/rad }
  A: { revolute: [crank.end, rod.start] }
  B: { revolute: [rod.end, ram.origin] }
  W: { slider: [ground.O, ram.origin], axis: [1, 0], damping: 3 N s/m }
motors: { motor: { joint: O, curve: curve, gear: 2, inertia: 0.001 kg m^2 } }
springs: { strut: { between: [rod.com, ground.wall], stiffness: 300 N/m, length: 30 cm, damping: 4 N s/m } }
measures:
  depth: W.position - 17 cm
  pressing: if(W.velocity > 0 m/s and depth > 0 mm, resistance(depth), 0)
  pressing_power: -pressing*W.velocity
  lost: -0.05 N m s/rad*O.omega^2 - 3 N s/m*W.velocity^2 - 4 N s/m*rate(strut.stretch)^2
loads: { press: { joint: W, force: -pressing } }
start: { O.angle: 60 deg, O.omega: 5 rad/s, rod.angle: ~-16 deg }
studies:
  run:
    dynamics: { until: 2 s, every: 10 ms, tolerance: 1e-9 }
    columns: [time, O.omega, depth, energy]
    scalars: { put_in: integral(motor.power), pressed: integral(pressing_power), damped: integral(lost) }
";
    let run = run_text(text, &["--no-plots"]).succeeded();
    let energy = run.table("run").column("energy.total");
    let gain = energy.last().unwrap() - energy[0];
    let figure = |name: &str| certified(&run, "run", name);
    let scalar = |name: &str| super::scalar(&run, "run", name);
    let scale = figure("energy_scale");
    let mut verdict = Verdict::default();
    let works = ["drivers", "loads", "dampers", "stops", "impacts"].map(|of| figure(&format!("work_{of}"))).iter().sum::<f64>();
    verdict.close("gain", "the end", gain, works, 1e-7 * scale);
    verdict.close("drift", "", figure("energy_drift"), 0.0, 1e-7 * scale);
    verdict.close("work of motor and load", "", figure("work_loads"), scalar("put_in") + scalar("pressed"), 1e-7 * scale);
    verdict.close("work of dampers", "", figure("work_dampers"), scalar("damped"), 1e-7 * scale);
    verdict.holds(scale > 1.0 && scalar("put_in") > 1.0 && scalar("pressed") < -1.0 && scalar("damped") < -1.0, "everything works");
    verdict.close("positions", "", figure("constraint_residual"), 0.0, 1e-8);
    verdict.close("velocities", "", figure("velocity_residual"), 0.0, 1e-7);
    verdict.give("energy");
}

#[test]
fn a_driver_does_what_the_energy_gains() {
    let model = five_bar("planar", true, 9);
    let (run, table) = go(&model, "until: 1 s, every: 10 ms, tolerance: 1e-10");
    let energy = table.column("energy.total");
    let figure = |name: &str| certified(&run, "run", name);
    let gain = energy.last().unwrap() - energy[0];
    let works = figure("work_drivers") + figure("work_loads") + figure("work_dampers");
    assert!((gain - works).abs() < 1e-7 * figure("energy_scale"), "{gain} and {works}");
    assert!(figure("energy_drift") < 1e-7 * figure("energy_scale"), "{}", figure("energy_drift"));
}

/// Bodies without mass in cartesian coordinates: M is singular, the motion is that of joint coordinates.
#[test]
fn links_without_mass_move_alike_in_cartesian_coordinates() {
    let model = "gravity: [0, -9.81 m/s^2]
ground: { O: [0, 0], C: [30 cm, 0] }
bodies:
  crank: { bar: { length: 10 cm } }
  coupler: { bar: { length: 30 cm, mass: 1.2 kg } }
  rocker: { bar: { length: 25 cm } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
start: { O.angle: 60 deg, O.omega: 15 rad/s, coupler.angle: ~40 deg, rocker.angle: ~97 deg }";
    let mut verdict = Verdict::default();
    let angle = |dynamics: &str| {
        let run = run_text(
            &format!(
                "grashof: 1\nname: test\nspace: planar\n{model}\nstudies: {{ run: {{ dynamics: {{ until: 1 s, every: 1 s, {dynamics} }}, columns: [time, O.angle] }} }}"
            ),
            &["--no-plots"],
        );
        let table = run.succeeded().table("run");
        table.rows.last().map_or(f64::NAN, |row| row[1])
    };
    let right = angle("tolerance: 1e-12");
    for scheme in ["dop853", "radau5", "bdf"] {
        let found = angle(&format!("tolerance: 1e-9, integrator: {scheme}, coordinates: cartesian"));
        verdict.close(scheme, "cartesian", found, right, 1e-6);
    }
    verdict.give("links without mass");
}

/// A driven joint with an exact start is no independent coordinate of minimal ones, and no fault.
#[test]
fn a_driven_joint_may_have_an_exact_start() {
    let mut verdict = Verdict::default();
    let angle = |dynamics: &str| {
        let text = format!(
            "grashof: 1
name: driven arm
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ a: {{ bar: {{ length: 0.3 m, mass: 1 kg }} }}, b: {{ bar: {{ length: 0.2 m, mass: 1 kg }} }} }}
joints: {{ O: {{ revolute: [ground, a.start] }}, P: {{ revolute: [a.end, b.start] }} }}
drivers: {{ d: {{ joint: O, angle: 0.5 rad*sin(7 rad/s*t) }} }}
start: {{ O.angle: 0 rad, P.angle: 0 rad, P.omega: 3 rad/s }}
studies: {{ run: {{ dynamics: {{ until: 1 s, every: 1 s, tolerance: 1e-10, {dynamics} }}, columns: [time, P.angle] }} }}
"
        );
        let table = run_text(&text, &["--no-plots"]).succeeded().table("run");
        table.rows.last().map_or(f64::NAN, |row| row[1])
    };
    verdict.close("P.angle", "minimal", angle("coordinates: minimal"), angle("coordinates: joint"), 1e-7);
    verdict.give("driven arm");
}

/// Two bars on three ball joints: the coordinates of a chart turn back on the way, and it has to be left before.
#[test]
fn minimal_coordinates_leave_a_chart_before_it_degenerates() {
    let mut verdict = Verdict::default();
    let spin = |dynamics: &str| {
        let text = format!(
            "grashof: 1
name: two bars on ball joints
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: {{ O: [0, 0, 0], E: [1 m, 0, 0] }}
bodies:
  a: {{ bar: {{ length: 60 cm, width: 2 cm, height: 2 cm, mass: 1 kg }} }}
  b: {{ bar: {{ length: 70 cm, width: 2 cm, height: 2 cm, mass: 1 kg }} }}
joints: {{ A: {{ spherical: [ground.O, a.start] }}, B: {{ spherical: [a.end, b.start] }}, C: {{ spherical: [b.end, ground.E] }} }}
springs: {{ k: {{ between: [a.end, ground.E], stiffness: 5 N/m, length: 20 cm, damping: 0.1 N s/m }} }}
start: {{ a.rotation: {{ axis: [0, 1, 0], angle: ~40 deg }}, a.wx: ~3 rad/s, a.wz: ~1 rad/s }}
studies: {{ run: {{ dynamics: {{ until: 2 s, every: 2 s, {dynamics} }}, columns: [time, a.wx] }} }}
"
        );
        let table = run_text(&text, &["--no-plots"]).succeeded().table("run");
        table.rows.last().map_or(f64::NAN, |row| row[1])
    };
    let right = spin("tolerance: 1e-13, integrator: dop853");
    // changed at a thousandth of the quality at the start: 1e-5, 1e-4, 3e-3
    for (scheme, within) in [("dop853", 2e-6), ("radau5", 5e-6), ("bdf", 3e-4)] {
        let found = spin(&format!("tolerance: 1e-8, integrator: {scheme}, coordinates: minimal"));
        verdict.close("a.wx", scheme, found, right, within);
    }
    verdict.give("ball joints");
}

/// A mass under a force that turns round within some hundredths of a second has a speed in closed form, 5 w ln cosh((t − c)/w): between
/// the steps it is as good as the tolerance, also where these have just become short or long.
#[test]
fn rows_between_steps_follow_a_sudden_force() {
    for (tolerance, width) in [(1e-4, 0.01), (1e-4, 0.05), (1e-8, 0.01), (1e-8, 0.05)] {
        for place in [0.5, 0.47, 0.525] {
            let run = run_text(
                &format!(
                    "grashof: 1
name: sudden
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, a.origin], axis: [1, 0] }} }}
loads: {{ p: {{ joint: S, force: \"5 N*tanh((t - {place} s)/({width} s))\" }} }}
start: {{ S.position: 0.1 m }}
studies: {{ s: {{ dynamics: {{ until: 1 s, every: 1 ms, tolerance: {tolerance}, integrator: dop853 }}, columns: [time, S.velocity] }} }}
"
                ),
                &["--no-plots"],
            )
            .succeeded();
            let far = |x: f64| x.abs() + (-2.0 * x.abs()).exp().ln_1p();
            for row in &run.table("s").rows {
                let exact = 5.0 * width * (far((row[0] - place) / width) - far(place / width));
                let off = (row[1] - exact).abs() / tolerance;
                assert!(off < 12.0, "{off:.1} tolerances of {tolerance:e} at {} s, {width} s at {place} s", row[0]);
            }
        }
    }
}

/// Positions inside of the steps of `radau5` are as good as those at their ends: those of a mass on a spring are cosines.
#[test]
fn positions_between_steps_of_radau5_have_the_digits_of_its_steps() {
    for (tolerance, within) in [("1e-6", 2e-7), ("1e-8", 2e-9), ("1e-10", 2e-11)] {
        let text = format!(
            "grashof: 1
name: mass on a spring
space: planar
gravity: none
bodies: {{ m: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, m.origin], axis: [1, 0] }} }}
springs: {{ k: {{ joint: S, stiffness: 1 N/m }} }}
start: {{ S.position: 1 m, S.velocity: 0 }}
studies: {{ run: {{ dynamics: {{ until: 20 s, every: 5 ms, integrator: radau5, tolerance: {tolerance} }}, columns: [time, S.position] }} }}
"
        );
        let run = run_text(&text, &["--no-plots"]);
        let table = run.succeeded().table("run");
        let worst = table.rows.iter().map(|row| (row[1] - row[0].cos()).abs()).fold(0.0, f64::max);
        assert!(worst < within, "{tolerance}: {worst:e}");
    }
}
