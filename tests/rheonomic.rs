//! What time moves without a driver: couplings, stretches, rests and laws of springs with `t` in them. A coupling is the driver of
//! the same motion, a spring on a moving place has its closed form, and energies balance with the work that time does.

use crate::common;
use grashof::mechanism::Coordinates;
use grashof::results::March;
use grashof::studies::common::outcome::Outcome;

fn study(text: &str, name: &str) -> Outcome {
    common::study(text, name, Coordinates::Joint)
}

fn march(outcome: &Outcome) -> &March {
    outcome.certificate.march.as_ref().expect("a motion in time")
}

/// A study of dynamics with these settings, and its columns.
fn dynamics(until: f64, settings: &str, columns: &str) -> String {
    format!("studies: {{ d: {{ dynamics: {{ until: {until} s, every: 0.05 s, {settings} }}, columns: [{columns}] }} }}")
}

/// Rows of two outcomes, to a part of the largest entry of each column.
#[track_caller]
fn same(what: &str, a: &Outcome, b: &Outcome, within: f64) {
    assert_eq!(a.rows.len(), b.rows.len(), "{what}: {:?} {:?}", a.places, b.places);
    for k in 0..a.rows[0].len() {
        let size = a.rows.iter().fold(1e-3, |m: f64, row| m.max(row[k].abs()));
        for ((x, y), t) in a.rows.iter().zip(&b.rows).zip(&a.places) {
            assert!((x[k] - y[k]).abs() <= within * size, "{what}, column {k} at {t}: {} {}", x[k], y[k]);
        }
    }
}

/// A pendulum that hangs on a slider with a spring; how the slider is moved is missing.
fn cart(moved: &str, studies: &str) -> String {
    format!(
        "grashof: 1
name: a pendulum on a moved slider
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ G: [0, 0], H: [-0.5 m, 0.1 m] }}
bodies:
  cart: {{ mass: 2 kg }}
  bar: {{ bar: {{ length: 0.7 m, mass: 1.5 kg }} }}
joints:
  A: {{ slider: [ground.G, cart.origin], axis: [1, 0] }}
  B: {{ revolute: [cart.origin, bar.start], damping: 0.05 N m s }}
springs: {{ pull: {{ between: [ground.H, bar.end], stiffness: 30 N/m, length: 0.4 m }} }}
{moved}
start: {{ bar.angle: -60 deg }}
{studies}
"
    )
}

const COLUMNS: &str = "A.position, A.velocity, A.acceleration, B.angle, B.omega, B.alpha, B.fx, B.fy, A.fy, A.m, frame.fx, energy";
const SHAKE: &str = "0.1 m*sin(2 rad/s*t)";

#[test]
fn a_coupling_moves_as_the_driver_of_the_same_motion_in_every_scheme_and_all_coordinates() {
    let driver = format!("drivers: {{ shake: {{ joint: A, position: {SHAKE} }} }}");
    let coupling = format!("couplings: {{ shake: {{ zero: A.position - {SHAKE} }} }}");
    let reference = study(&cart(&driver, &dynamics(2.0, "integrator: dop853, tolerance: 1e-12", COLUMNS)), "d");
    assert!(march(&reference).drivers.abs() > 0.1);
    let schemes = [
        ("integrator: auto, tolerance: 1e-10", 1e-7),
        ("integrator: dop853, tolerance: 1e-11", 1e-8),
        ("integrator: radau5, tolerance: 1e-10", 1e-7),
        ("integrator: bdf, tolerance: 1e-10", 1e-5),
        ("integrator: generalized-alpha, tolerance: 1e-7", 1e-3),
        ("integrator: rk4, step: 2 ms", 1e-7),
        ("integrator: newmark, step: 1 ms", 1e-3),
        ("integrator: hht, step: 1 ms", 1e-2),
        ("integrator: central-difference, step: 1 ms", 1e-3),
    ];
    for (scheme, error) in schemes {
        for coordinates in ["joint", "cartesian", "minimal"] {
            let settings = format!("{scheme}, coordinates: {coordinates}");
            let [a, b] = [&driver, &coupling].map(|moved| study(&cart(moved, &dynamics(2.0, &settings, COLUMNS)), "d"));
            // the same row, whatever it is called
            same(&settings, &a, &b, 1e-9);
            same(&settings, &reference, &b, error);
            let (of_driver, of_coupling) = (march(&a).drivers, march(&b).drivers);
            assert!((of_driver - of_coupling).abs() <= 1e-9 * of_driver.abs(), "{settings}: {of_driver} {of_coupling}");
        }
    }
    let balanced = march(&study(&cart(&coupling, &dynamics(2.0, "tolerance: 1e-11", COLUMNS)), "d")).clone();
    assert!(balanced.energy_drift < 1e-9 * balanced.energy_scale, "{balanced:?}");
}

#[test]
fn a_coupling_of_time_that_bends_the_motion_of_several_bodies_balances() {
    // time beside positions: all terms of γ, in every coordinates
    let coupling = "couplings: { bend: { zero: (bar.end.y + 0.6 m)*cos(3 rad/s*t) + 0.3*A.position*sin(2 rad/s*t) - 0.02 m*(t/(1 s))^2 - (0.6 m - 0.7 m*sin(60 deg)) } }";
    let columns = "A.position, A.velocity, B.angle, B.omega, B.fx, A.fy, energy";
    let run = |settings: &str| study(&cart(coupling, &dynamics(0.4, settings, columns)), "d");
    let reference = run("integrator: dop853, tolerance: 1e-12");
    let found = march(&reference);
    assert!(found.drivers.abs() > 1e-2 && found.energy_drift < 1e-9 * found.energy_scale, "{found:?}");
    for settings in ["coordinates: cartesian", "coordinates: minimal", "integrator: radau5", "integrator: bdf, coordinates: minimal"] {
        same(settings, &reference, &run(&format!("{settings}, tolerance: 1e-11")), 1e-7);
    }
}

#[test]
fn driven_studies_take_a_coupling_of_time() {
    let pendulum = "B.angle + 60 deg - 0.4*sin(3 rad/s*t)";
    let [driven, coupled] = [
        format!("drivers: {{ turn: {{ joint: B, angle: -60 deg + 0.4*sin(3 rad/s*t) }}, shake: {{ joint: A, position: {SHAKE} }} }}"),
        format!("couplings: {{ turn: {{ zero: {pendulum} }}, shake: {{ zero: A.position - {SHAKE} }} }}"),
    ]
    .map(|moved| {
        let studies = format!("studies: {{ i: {{ inverse: {{ over: 2 s, samples: 50 }}, columns: [{COLUMNS}] }}, k: {{ kinematics: {{ over: 2 s, samples: 50 }}, columns: [A.velocity, B.alpha] }} }}");
        cart(&moved, &studies)
    });
    for name in ["i", "k"] {
        let [a, b] = [&driven, &coupled].map(|text| study(text, name));
        same(name, &a, &b, 1e-11);
    }
    let certificate = study(&coupled, "i").certificate;
    assert!(certificate.power_balance < 1e-10, "{certificate:?}");
}

/// The same motion by a driver, by its own coupling, and by one whose time is tied to the position: every kind of study.
#[test]
fn equilibria_vibrations_regimes_and_matrices_are_those_of_the_driver() {
    let motion = "0.1 m*sin(2 rad/s*t)/(2 + cos(2 rad/s*t))";
    let studies = "studies:
  s: { statics: { from: start }, columns: [B.angle, A.position] }
  m: { modes: { at: statics, damped: true } }
  l: { linearize: { at: statics } }
  p: { periodic: { over: t, by: pi*1 s, of: B.angle }, columns: [B.angle, B.fx] }";
    let [driver, plain, tied] = [
        format!("drivers: {{ shake: {{ joint: A, position: {motion} }} }}"),
        format!("couplings: {{ shake: {{ zero: A.position - {motion} }} }}"),
        "couplings: { shake: { zero: A.position*(2 + cos(2 rad/s*t)) - 0.1 m*sin(2 rad/s*t) } }".into(),
    ]
    .map(|moved: String| cart(&moved, studies));
    for name in ["s", "m", "l", "p"] {
        let right = study(&driver, name);
        for text in [&plain, &tied] {
            let found = study(text, name);
            assert_eq!((found.lists.len(), found.scalars.len()), (right.lists.len(), right.scalars.len()));
            if !right.rows.is_empty() {
                same(name, &right, &found, 1e-7);
            }
            for (a, b) in right.lists.iter().zip(&found.lists) {
                common::close(&format!("{name}, {}", a.name), &b.values, &a.values, 1e-6);
            }
            if let (Some(a), Some(b)) = (&right.linear, &found.linear) {
                let numbers = |of: &grashof::results::LinearSystem| of.matrices.iter().flat_map(|m| m.1.concat()).collect::<Vec<_>>();
                common::close(&format!("{name}, matrices"), &numbers(b), &numbers(a), 1e-7);
            }
        }
    }
}

#[test]
fn a_mechanism_that_couplings_move_is_no_structure() {
    let turned = "B.angle + 60 deg - 0.4*sin(3 rad/s*t)";
    for (turned, structure) in [(turned, false), ("B.angle + 60 deg", true)] {
        let shake = if structure { "A.position".into() } else { format!("A.position - {SHAKE}") };
        let moved = format!("couplings: {{ turn: {{ zero: {turned} }}, shake: {{ zero: {shake} }} }}");
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("moved_by_couplings.yaml");
        std::fs::write(&path, cart(&moved, &dynamics(0.1, "tolerance: 1e-8", "A.position"))).expect("a file");
        let checked = std::process::Command::new(env!("CARGO_BIN_EXE_grashof")).arg("check").arg(&path).output().expect("it runs");
        let told = String::from_utf8_lossy(&checked.stdout).into_owned();
        assert_eq!(told.contains("it is a structure"), structure, "{told}");
    }
}

#[test]
fn switches_of_time_in_a_coupling_are_located() {
    let tau = "clamp((t - 0.21 s)/(0.5 s), 0, 1)";
    let rise = format!("0.2 m*{tau}^2*(3 - 2*{tau})");
    let [a, b] = [
        format!("drivers: {{ lift: {{ joint: A, position: \"{rise}\" }} }}"),
        format!("couplings: {{ lift: {{ zero: \"A.position - {rise}\" }} }}"),
    ]
    .map(|moved| study(&cart(&moved, &dynamics(1.0, "tolerance: 1e-11", COLUMNS)), "d"));
    assert_eq!([&a, &b].map(|o| o.certificate.switches), [2, 2]);
    assert_eq!(a.switches, b.switches);
    same("a rise between rests", &a, &b, 1e-9);
}

/// A mass m on a spring k and a damper d whose other end moves; all three ways to say so.
fn shaken(spring: &str, study: &str) -> String {
    format!(
        "grashof: 1
name: base excitation
space: planar
gravity: none
bodies: {{ m: {{ mass: 2 kg }} }}
joints: {{ S: {{ slider: [ground, m.origin], axis: [1, 0] }} }}
springs: {{ k: {{ {spring}, stiffness: 50 N/m, damping: 3 N s/m }} }}
measures: {{ speed: rate(k.stretch) }}
{study}
"
    )
}

/// Position, velocity and acceleration of m ẍ + d (ẋ − ẏ) + k (x − y) = 0 with y = a sin ωt, from rest at 0.
fn base_excitation(t: f64) -> [f64; 3] {
    let (m, d, k, a, w): (f64, f64, f64, f64, f64) = (2.0, 3.0, 50.0, 0.1, 4.0);
    // the regime c cos ωt + s sin ωt of m ẍ + d ẋ + k x = a (d ω cos ωt + k sin ωt)
    let (p, q) = (k - m * w * w, d * w);
    let det = p * p + q * q;
    let (c, s) = (a * (p * d * w - q * k) / det, a * (q * d * w + p * k) / det);
    let (delta, n) = (d / (2.0 * m), (k / m - (d / (2.0 * m)).powi(2)).sqrt());
    let (u, v) = (-c, (-s * w - delta * c) / n);
    let e = (-delta * t).exp();
    let free = |u: f64, v: f64| e * (u * (n * t).cos() + v * (n * t).sin());
    let (u1, v1) = (-delta * u + n * v, -delta * v - n * u);
    let (u2, v2) = (-delta * u1 + n * v1, -delta * v1 - n * u1);
    let (sin, cos) = (w * t).sin_cos();
    [free(u, v) + c * cos + s * sin, free(u1, v1) + w * (s * cos - c * sin), free(u2, v2) - w * w * (c * cos + s * sin)]
}

const SHAKEN: [&str; 3] = [
    "stretch: m.x - 0.1 m*sin(4 rad/s*t)",
    "joint: S, rest: 0.1 m*sin(4 rad/s*t)",
    // ten metres away, beyond the mass
    "between: [ground.origin, m.far], length: 10 m + 0.1 m*sin(4 rad/s*t)",
];

#[test]
fn a_spring_on_a_moving_place_is_base_excitation() {
    let columns = "m.x, m.vx, m.ax, k.stretch, speed, k.force, k.energy";
    for spring in SHAKEN {
        let text =
            shaken(spring, &dynamics(5.0, "tolerance: 1e-12", columns)).replace("mass: 2 kg", "mass: 2 kg, points: { far: [10 m, 0] }");
        let found = study(&text, "d");
        for (row, t) in found.rows.iter().zip(&found.places) {
            let [x, v, a] = base_excitation(*t);
            let (y, dy) = (0.1 * (4.0 * t).sin(), 0.4 * (4.0 * t).cos());
            let force = 50.0 * (x - y) + 3.0 * (v - dy);
            let right = [x, v, a, x - y, v - dy, force, 25.0 * (x - y).powi(2)];
            for (k, (found, right)) in row.iter().zip(right).enumerate() {
                assert!((found - right).abs() < 1e-9, "{spring}: column {k} at {t}: {found} {right}");
            }
        }
        // what the moving place puts in: ∫ F ẏ dt
        let march = march(&found);
        let n = 100_000;
        let power = |t: f64| {
            let [x, v, _] = base_excitation(t);
            let (y, dy) = (0.1 * (4.0 * t).sin(), 0.4 * (4.0 * t).cos());
            -(50.0 * (x - y) + 3.0 * (v - dy)) * dy
        };
        let h = 5.0 / f64::from(n);
        let work: f64 = (0..n).map(|i| h * power((f64::from(i) + 0.5) * h)).sum();
        assert!((march.drivers - work).abs() < 1e-8, "{spring}: {} {work}", march.drivers);
        assert!(march.energy_drift < 1e-10 * march.energy_scale && march.loads == 0.0, "{spring}: {march:?}");
    }
}

#[test]
fn the_regime_of_base_excitation_is_found() {
    let periodic = |period: &str| {
        format!("studies: {{ p: {{ periodic: {{ over: t, by: {period}, of: m.x }}, columns: [m.x], scalars: {{ most: max(m.x) }} }} }}")
    };
    let (m, d, k, w): (f64, f64, f64, f64) = (2.0, 3.0, 50.0, 4.0);
    let amplitude = 0.1 * ((k * k + (d * w).powi(2)) / ((k - m * w * w).powi(2) + (d * w).powi(2))).sqrt();
    for spring in &SHAKEN[..2] {
        let found = study(&shaken(spring, &periodic("pi/2*1 s")), "p");
        assert!((found.scalars[0] - amplitude).abs() < 1e-9, "{spring}: {} {amplitude}", found.scalars[0]);
        // another period is not one
        let why = refused(&shaken(spring, &periodic("1.3 s")), "p");
        assert!(why.contains("period"), "{why}");
    }
}

#[test]
fn at_rest_time_is_zero() {
    let spring = "stretch: m.x - 0.1 m*cos(4 rad/s*t)";
    let studies = "studies:
  s: { statics: { from: start }, columns: [m.x, k.energy] }
  m: { modes: { at: statics } }";
    let text = shaken(spring, studies);
    let rest = study(&text, "s");
    assert!((rest.rows[0][0] - 0.1).abs() < 1e-12 && rest.rows[0][1].abs() < 1e-20);
    let modes = study(&text, "m");
    let list = &modes.lists.iter().find(|l| l.name == "eigenvalues").expect("eigenvalues").values;
    assert!((list[0] - 25.0).abs() < 1e-9, "{list:?}");
}

#[test]
fn laws_that_change_with_time_are_the_loads_they_make() {
    let k = "(50 N/m*(1 + 0.5*sin(7 rad/s*t)))";
    let d = "(2 N s/m*(1 + 0.9*cos(3 rad/s*t)))";
    let f = "(4 N*sin(5 rad/s*t))";
    let load = |force: &str| format!("loads: {{ k: {{ joint: S, force: \"{force}\" }} }}");
    let spring = |law: &str| format!("springs: {{ k: {{ joint: S, {law} }} }}");
    let pairs = [
        (spring(&format!("stiffness: \"{k}\"")), load(&format!("-{k}*S.position"))),
        (spring(&format!("damping: \"{d}\", preload: \"{f}\"")), load(&format!("-{d}*S.velocity - {f}"))),
        (
            spring(&format!(
                "force: \"{k}*stretch + 300 N/m^3*stretch^3*(2 + cos(t/(1 s)))\", rest: 0.1 m*t/(1 s), damping: \"{d}\", preload: \"{f}\""
            )),
            load(&format!(
                "-{k}*(S.position - 0.1 m*t/(1 s)) - 300 N/m^3*(S.position - 0.1 m*t/(1 s))^3*(2 + cos(t/(1 s))) - {d}*(S.velocity - 0.1 m/s) - {f}"
            )),
        ),
    ];
    for (spring, load) in pairs {
        let [a, b] = [&spring, &load].map(|acting| {
            let text = shaken("joint: S", &dynamics(3.0, "tolerance: 1e-12", "S.position, S.velocity, S.acceleration"));
            let text = text
                .replace("measures: { speed: rate(k.stretch) }\n", "")
                .replace("springs: { k: { joint: S, stiffness: 50 N/m, damping: 3 N s/m } }", acting);
            study(&format!("{text}start: {{ S.position: 0.2 m, S.velocity: 0.3 m/s }}\n"), "d")
        });
        same(&spring, &a, &b, 1e-9);
        let [of_spring, of_load] = [march(&a), march(&b)];
        assert!(of_spring.energy_drift < 1e-9 * of_spring.energy_scale, "{spring}: {of_spring:?}");
        assert!(of_spring.drivers.abs() > 1e-3 && of_load.drivers == 0.0, "{spring}: {of_spring:?}");
    }
}

/// How a run fails that cannot be: why, and until when it went.
fn refused(text: &str, name: &str) -> String {
    let model = common::model(text, Some(name));
    let asked = model.study.clone().expect("the study");
    let parameters = grashof::studies::common::case::parameters(&model);
    match grashof::studies::run::run(grashof::studies::common::case::Case::new(&model, &asked, &parameters), &|| false) {
        Ok(outcome) => outcome.stopped.expect("a reason to stop"),
        Err(failure) => failure.reason(),
    }
}

#[test]
fn what_moves_the_same_thing_differently_is_told() {
    // they agree at the start with their velocities, and part later
    let rows = |a: &str, b: &str| {
        [
            format!("couplings: {{ one: {{ zero: \"A.position - {a}\" }}, two: {{ zero: \"A.position - {b}\" }} }}"),
            format!("drivers: {{ one: {{ joint: A, position: \"{a}\" }} }}\ncouplings: {{ two: {{ zero: \"A.position - {b}\" }} }}"),
        ]
    };
    let part = rows("1 m*(1 - cos(t/(1 s)))", "2 m*(1 - cos(t/(1 s)))");
    let all = ["integrator: dop853", "integrator: radau5", "coordinates: cartesian", "coordinates: minimal", "integrator: rk4, step: 5 ms"];
    for moved in &part {
        for settings in all {
            let why = refused(&cart(moved, &dynamics(1.0, settings, "A.position")), "d");
            assert!(why.contains("contradict each other") && (why.contains("`one`") || why.contains("`two`")), "{settings}: {why}");
        }
    }
    // driven motion, where the rows have no driver that could be one too many
    let moved = part[0].replace("} }", "}, turn: { zero: B.angle + 60 deg } }");
    for kind in ["inverse", "kinematics"] {
        let studies = format!("studies: {{ k: {{ {kind}: {{ over: 1 s, samples: 10 }}, columns: [A.position] }} }}");
        let why = refused(&cart(&moved, &studies), "k");
        assert!(why.contains("contradict each other") && (why.contains("`one`") || why.contains("`two`")), "{kind}: {why}");
    }
    // redundant ones that agree go on
    for moved in rows("1 m*(1 - cos(t/(1 s)))", "2 m*sin(t/(2 s))^2") {
        let found = study(&cart(&moved, &dynamics(1.0, "tolerance: 1e-10", "A.position")), "d");
        assert!((found.rows[20][0] - (1.0 - 1.0_f64.cos())).abs() < 1e-9);
    }
    // at once
    for moved in rows("1 m*sin(t/(1 s))", "2 m*sin(t/(1 s))") {
        let why = refused(&cart(&moved, &dynamics(1.0, "tolerance: 1e-8", "A.position")), "d");
        assert!(why.contains("drivers and couplings contradict each other"), "{why}");
    }
}

#[test]
fn what_has_no_value_at_a_time_is_told_with_its_place() {
    let moved = format!("couplings: {{ shake: {{ zero: A.position - {SHAKE} }} }}");
    let text = cart(&moved, &dynamics(1.0, "tolerance: 1e-8", "A.position")).replace("length: 0.4 m", "length: 0.4 m*sqrt(1 - 2*t/(1 s))");
    let why = refused(&text, "d");
    assert!(why.contains("spring `pull` is not defined at t = 0.500000 s"), "{why}");
}

#[test]
fn a_start_moves_as_time_says() {
    // nothing is given: the velocity at the start is that of the coupling, and of the linear system around it
    let coupling = format!("couplings: {{ shake: {{ zero: A.position - {SHAKE} }} }}");
    let text = cart(&coupling, &dynamics(0.1, "tolerance: 1e-10", "A.position, A.velocity"));
    let found = study(&text, "d");
    assert!(found.rows[0][0].abs() < 1e-14 && (found.rows[0][1] - 0.2).abs() < 1e-13, "{:?}", &found.rows[0]);
}
