//! What a study says of its motion does not depend on where it writes rows: extremes, integrals, means, first places and switches
//! against closed forms, for any number of samples.

use crate::common::{model, study};
use grashof::mechanism::Coordinates;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run;
use std::f64::consts::{PI, TAU};

const SAMPLES: [usize; 6] = [1, 2, 3, 10, 100, 3600];

/// A crank of 5 cm at 300 rpm with a link of 15 cm.
fn slider_crank(turns: usize, samples: usize) -> Outcome {
    let text = format!(
        "\
grashof: 1
name: slider-crank
space: planar
gravity: none
ground: {{ O: [0, 0] }}
bodies:
  crank: {{ bar: {{ length: 5 cm, mass: 0 }} }}
  link: {{ bar: {{ length: 15 cm, mass: 0.6 kg }} }}
  piston: {{ mass: 0.5 kg }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, link.start] }}
  B: {{ revolute: [link.end, piston.origin] }}
  W: {{ slider: [ground.O, piston.origin], axis: [1, 0] }}
drivers: {{ drive: {{ joint: O, speed: 300 rpm }} }}
start: {{ O.angle: 0 deg, link.angle: ~0 deg }}
studies:
  turn:
    inverse: {{ over: {turns} turn, samples: {samples} }}
    columns: [O.angle, W.position, drive.torque]
    scalars:
      highest: max(W.position)
      lowest: min(W.position)
      fastest: max(W.velocity)
      way: integral(abs(W.velocity))
      forward: mean(W.velocity > 0)
      torque: max(drive.torque)
      work: mean(abs(drive.torque))
      beyond: first(W.position < 12 cm)
      end: last(O.angle)
"
    );
    study(&text, "turn", Coordinates::Joint)
}

#[test]
fn a_slider_crank_is_the_same_on_any_grid() {
    let (r, l, omega) = (0.05, 0.15, 10.0 * PI);
    let velocity = |a: f64| -omega * r * a.sin() * (1.0 + r * a.cos() / (l * l - (r * a.sin()).powi(2)).sqrt());
    let fastest = (0..4_000_000).map(|i| velocity(TAU * f64::from(i) / 4e6)).fold(0.0, f64::max);
    // 12 cm: r cos a + √(l² − r² sin² a) = x
    let first = (f64::midpoint(0.12 * 0.12 + r * r, -l * l) / (r * 0.12)).acos();
    for turns in [1, 3, 10] {
        let fine = slider_crank(turns, 360);
        for samples in SAMPLES {
            let found = slider_crank(turns, samples);
            assert_eq!(found.scalars, fine.scalars, "{turns} turns, {samples} samples");
            assert_eq!(found.certificate.switches, fine.certificate.switches);
            let places = |o: &Outcome| o.extremes.iter().flatten().flat_map(|e| [e.min.at, e.max.at]).collect::<Vec<_>>();
            assert_eq!(places(&found), places(&fine));
            assert!(found.rows.len() > samples && found.rows.len() <= samples + 1 + 2 * found.certificate.switches);
        }
        let turns = turns as f64;
        let right = [0.2, 0.1, fastest, 4.0 * r * omega * turns, 0.5];
        for (k, (found, right)) in fine.scalars.iter().zip(right).enumerate() {
            assert!((found / right - 1.0).abs() < 1e-9, "scalar {k}: {found} for {right}");
        }
        assert!((fine.scalars[7] - first).abs() < 1e-10, "{} for {first}", fine.scalars[7]);
        assert!((fine.scalars[8] / (TAU * turns) - 1.0).abs() < 1e-14);
        assert!(fine.findings.is_empty(), "{:?}", fine.findings);
    }
}

/// A crank at 1 turn/s with a load, and one scalar over 1 s.
fn timed(load: &str, scalar: &str, samples: usize) -> Outcome {
    let text = format!(
        "\
grashof: 1
name: crank with a load
space: planar
gravity: none
ground: {{ O: [0, 0] }}
tables:
  cam: {{ points: [[0, 0], [1, 0], [2, 1], [3, 1], [4, 0], [{TAU}, 0]], beyond: periodic }}
bodies: {{ crank: {{ bar: {{ length: 5 cm, mass: 1 kg }} }} }}
joints: {{ O: {{ revolute: [ground.O, crank.start] }} }}
loads: {{ load: {{ joint: O, torque: \"{load}\" }} }}
drivers: {{ drive: {{ joint: O, speed: 1 turn/s }} }}
start: {{ O.angle: 0 deg }}
studies:
  s:
    inverse: {{ over: 1 s, samples: {samples} }}
    columns: [time, drive.torque]
    scalars: {{ found: \"{scalar}\" }}
"
    );
    study(&text, "s", Coordinates::Joint)
}

/// ∫₀ˣ |sin|.
fn arches(x: f64) -> f64 {
    let whole = (x / PI).floor();
    2.0 * whole + 1.0 - (x - PI * whole).cos()
}

/// Measure of sin > 0 in [0, x].
fn raised(x: f64) -> f64 {
    (x / TAU).floor() * PI + (x % TAU).min(PI)
}

#[test]
fn loads_that_change_between_rows_are_seen() {
    let square = (raised(700.3) - raised(0.3)) / 700.0;
    let none = "0 N m";
    // a load, what is asked, the closed form, the number of switches
    let cases = [
        ("2 N m*sin(5000 rad/s*t)", "max(drive.torque)/1 N m", 2.0, 0),
        ("1 N m*sin(11309.733552923256 rad/s*t)", "max(abs(drive.torque))/1 N m", 1.0, 3599),
        (none, "integral(sin(5000 rad/s*t)^2)/1 s", 0.5 - 10000_f64.sin() / 20000.0, 0),
        (none, "integral(abs(sin(50 rad/s*t)))/1 s", arches(50.0) / 50.0, 15),
        ("if(sin(700 rad/s*t + 0.3) > 0, 1 N m, 0 N m)", "-integral(drive.torque)/(1 N m s)", square, 222),
        ("if(t > 0.4321 s and t < 0.432100001 s, 7 N m, 0 N m)", "-min(drive.torque)/1 N m", 7.0, 2),
        ("if(t > 0.4321 s and t < 0.4322 s, 7 N m, 0 N m)", "-integral(drive.torque)/(1 N m s)", 7e-4, 2),
        (none, "mean(cam(3*O.angle) == 0)", 1.0 - 3.0 / TAU, 14),
        (none, "max(cam(3*O.angle))", 1.0, 14),
        (none, "integral(cam(O.angle))/1 s", 2.0 / TAU, 4),
        (none, "first(sin(O.angle) < -0.5)/1 s", 7.0 / 12.0, 2),
    ];
    for (load, scalar, right, switches) in cases {
        for samples in [1, 7, 360] {
            let o = timed(load, scalar, samples);
            assert!((o.scalars[0] - right).abs() < 1e-9, "{load} / {scalar}, {samples} samples: {} for {right}", o.scalars[0]);
            assert_eq!(o.certificate.switches, switches, "{load} / {scalar}, {samples} samples");
            assert!(o.findings.is_empty(), "{load} / {scalar}: {:?}", o.findings);
        }
    }
}

#[test]
fn what_is_too_fast_to_be_followed_is_said() {
    for scalar in ["max(sin(1e10 rad/s*t))", "mean(1/(O.angle - 2))"] {
        let o = timed("0 N m", scalar, 10);
        assert!(o.findings.iter().any(|f| f.code == "unresolved" && f.message.contains("`found`")), "{scalar}: {:?}", o.findings);
    }
    // a switch at every place is given up, too
    let o = timed("0 N m", "mean(sin(1e8 rad/s*t) > 0)", 10);
    assert!(o.findings.iter().any(|f| f.code == "unresolved" && f.message.contains("the switch")), "{:?}", o.findings);
}

/// As many columns count as unresolved as are named, those of equal expressions each, in a motion in time and a driven one.
#[test]
fn every_column_that_is_not_resolved_counts_and_is_named() {
    let text = "grashof: 1
name: fast
space: planar
gravity: none
bodies: { a: { mass: 1 kg } }
joints: { S: { slider: [ground, a.origin], axis: [1, 0] } }
drivers: { d: { joint: S, speed: 1 m/s } }
measures: { p: sin(1e10 rad/s*t), q: sin(1e10 rad/s*t), r: cos(1e10 rad/s*t) }
studies:
  i: { inverse: { over: 1 s, samples: 4 }, columns: [time, p, q, r, S.position] }
  d: { dynamics: { until: 1 s, every: 0.25 s }, columns: [time, p, q, r, S.position] }
";
    for name in ["i", "d"] {
        let outcome = crate::common::study(text, name, Coordinates::Joint);
        let named = |column: &str| outcome.findings.iter().filter(|f| f.code == "unresolved" && f.message.contains(column)).count();
        assert_eq!(["`p`", "`q`", "`r`", "`S.position`"].map(named), [1, 1, 1, 0], "{name}: {:?}", outcome.findings);
        assert_eq!(outcome.certificate.resolved.map(|r| r.open), Some(3), "{name}");
    }
}

#[test]
fn a_motion_in_time_is_the_same_for_any_rows_and_long_steps() {
    let run = |every: &str| {
        let text = format!(
            "\
grashof: 1
name: free mass
space: planar
gravity: none
bodies: {{ mass: {{ mass: 1 kg, inertia: 1 kg m^2 }} }}
joints: {{ P: {{ slider: [ground, mass.origin], axis: [1, 0] }} }}
start: {{ P.velocity: 1 m/s }}
studies:
  k:
    dynamics: {{ until: 1 s{every} }}
    columns: [time, P.position]
    scalars: {{ most: max(sin(50 rad/s*t)), least: min(sin(50 rad/s*P.position/(1 m/s))), fast: max(sin(5000 rad/s*t)), area: integral(sin(50 rad/s*t)^2)/1 s }}
"
        );
        study(&text, "k", Coordinates::Joint)
    };
    let right = [1.0, -1.0, 1.0, 0.5 - 100_f64.sin() / 200.0];
    let any = run("");
    for every in ["", ", every: 1 s", ", every: 0.3 s", ", every: 1 ms"] {
        let o = run(every);
        assert_eq!(o.scalars, any.scalars, "{every}");
        for (found, right) in o.scalars.iter().zip(right) {
            assert!((found - right).abs() < 1e-9, "{every}: {found} for {right}");
        }
        assert!(o.findings.is_empty(), "{:?}", o.findings);
    }
}

#[test]
fn rates_without_bound_at_a_dead_point_are_said_and_stop_nothing() {
    let swing = |samples: usize| {
        let text = format!(
            "\
grashof: 1
name: double rocker
space: planar
gravity: none
ground: {{ O: [0, 0], C: [1 m, 0] }}
bodies:
  crank: {{ bar: {{ length: 15 cm }} }}
  coupler: {{ bar: {{ length: 1 m }} }}
  rocker: {{ bar: {{ length: 10 cm }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.start] }}
drivers: {{ drive: {{ joint: O, speed: 60 rpm }} }}
start: {{ O.angle: 90 deg, coupler.angle: ~0 deg, rocker.angle: ~90 deg }}
studies:
  swing:
    kinematics: {{ over: 1 turn, samples: {samples} }}
    columns: [crank.angle, rocker.angle, rocker.omega]
    scalars: {{ from: min(crank.angle), to: max(crank.angle), swing: max(rocker.angle) - min(rocker.angle) }}
"
        );
        let model = model(&text, Some("swing"));
        let asked = model.study.clone().expect("the study");
        run(Case::new(&model, &asked, &parameters(&model)), &|| false).unwrap_or_else(|f| panic!("{}", f.reason()))
    };
    // coupler and rocker in line
    let end = |reach: f64| ((0.15_f64.powi(2) + 1.0 - reach * reach) / 0.3).acos();
    let any = swing(36);
    assert!((any.scalars[0] - end(0.9)).abs() < 1e-9 && (any.scalars[1] - end(1.1)).abs() < 1e-9, "{:?}", any.scalars);
    for samples in SAMPLES {
        assert_eq!(swing(samples).scalars, any.scalars, "{samples} samples");
    }
    assert!(any.findings.iter().any(|f| f.code == "unresolved" && f.message.contains("`rocker.omega`")), "{:?}", any.findings);
}

/// Conditions that are met for a small part of each turn, between the places of any first look.
#[test]
fn short_windows_of_each_turn_are_met() {
    for turns in [1, 3, 7, 20, 40] {
        let text = format!(
            "grashof: 1
name: windows
space: planar
gravity: none
bodies: {{ wheel: {{ mass: 30 kg, inertia: 20 kg m^2 }} }}
joints: {{ O: {{ revolute: [ground, wheel.origin] }} }}
drivers: {{ d: {{ joint: O, speed: 50 rad/s }} }}
start: {{ O.angle: 0 deg }}
studies:
  k: {{ kinematics: {{ over: {turns} turn, samples: 3 }}, columns: [O.angle], scalars: {{ hair: \"mean(cos(O.angle - 1) > 1 - 1e-7)\", narrow: \"mean(cos(O.angle - 1) > 0.9999)\" }} }}
"
        );
        let outcome = study(&text, "k", Coordinates::Joint);
        for (found, level) in outcome.scalars.iter().zip([1.0 - 1e-7, 0.9999]) {
            let right = f64::acos(level) / PI;
            assert!((found - right).abs() < 1e-9, "{turns} turns, {level}: {found} for {right}");
        }
    }
}

#[test]
fn forces_that_balance_have_no_findings() {
    // two sliders against each other: what shakes the ground is the round-off of forces of hundreds of newtons
    let text = "grashof: 1
name: symmetric double slider
space: planar
gravity: [0, -9.81 m/s^2]
ground: { O: [0, 0] }
bodies:
  c: { disc: { radius: 5 cm, mass: 1 kg }, points: { p: [4 cm, 0], q: [-4 cm, 0] } }
  r1: { bar: { length: 15 cm, mass: 0.3 kg } }
  r2: { bar: { length: 15 cm, mass: 0.3 kg } }
  s1: { mass: 0.5 kg }
  s2: { mass: 0.5 kg }
joints:
  O: { revolute: [ground.O, c.origin] }
  A1: { revolute: [c.p, r1.start] }
  A2: { revolute: [c.q, r2.start] }
  B1: { revolute: [r1.end, s1.origin] }
  B2: { revolute: [r2.end, s2.origin] }
  W1: { slider: [ground.O, s1.origin], axis: [1, 0] }
  W2: { slider: [ground.O, s2.origin], axis: [-1, 0] }
loads: { m: { joint: O, torque: 0.5 N m } }
start: { O.angle: 10 deg, O.omega: 0 rad/s, W1.position: ~19 cm, W2.position: ~19 cm, r1.angle: ~0 deg, r2.angle: ~180 deg }
studies:
  turned: { dynamics: { until: 1 s, every: 5 ms }, columns: [time, c.omega, shaking, com, momentum.x, frame, W1, W2, O] }
";
    let outcome = study(text, "turned", Coordinates::Joint);
    let unresolved: Vec<&str> = outcome.findings.iter().filter(|f| f.code == "unresolved").map(|f| &*f.message).collect();
    assert!(unresolved.is_empty(), "{unresolved:?}");
    assert_eq!(outcome.certificate.resolved.map(|resolution| resolution.open), Some(0));
}

/// 1/(w + (θ - 1.2345)²) is over a part p of its height 1/w within √(w (1/p - 1)) of its middle: slopes alone are seen beside it.
#[test]
fn conditions_that_hold_in_a_narrow_peak_are_met() {
    for w in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8] {
        for part in [0.5, 0.99, 0.9999] {
            let text = format!(
                "
grashof: 1
name: narrow peak
space: planar
gravity: none
bodies: {{ a: {{ bar: {{ length: 1 m }} }} }}
joints: {{ A: {{ revolute: [ground, a.start] }} }}
drivers: {{ D: {{ joint: A, speed: 1 rad/s }} }}
measures: {{ m: '1/({w:e} + (A.angle/1 rad - 1.2345)^2)' }}
studies:
  it:
    kinematics: {{ over: 3 turn, samples: 1 }}
    columns: [A.angle]
    scalars: {{ begin: first(m > {over:e}), long: integral(m > {over:e}) }}
",
                over = part / w
            );
            let outcome = study(&text, "it", Coordinates::Joint);
            let half = f64::sqrt(w * (1.0 / part - 1.0));
            let [begin, long] = outcome.scalars[..2] else { panic!("two scalars") };
            assert!((begin - (1.2345 - half)).abs() < 1e-6 * half + 1e-12, "{w:e}, {part}: begins at {begin}");
            assert!((long / (2.0 * half) - 1.0).abs() < 1e-5, "{w:e}, {part}: {long} for {}", 2.0 * half);
        }
    }
}
