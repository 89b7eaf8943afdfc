//! Motion in time: states, events, stops, friction and the study `dynamics`.

use super::super::*;
use crate::expression::{Dimension, Id};

const BASE: &str = "\
grashof: 1
name: motor and slider
space: planar
gravity: [0, -9.81 m/s^2]
parameters:
  R: 2 ohm
  brake: 1 N m
  share: 0.5
  reach: 10 cm
  half: reach/2
ground: { O: [0, 0], S: [1 m, 0] }
bodies:
  rotor: { disc: { radius: 5 cm, mass: 1 kg } }
  block: { mass: 2 kg }
joints:
  O: { revolute: [ground.O, rotor.origin] }
  S: { slider: [ground.S, block.origin], axis: [1, 0] }
states:
  current: { start: 0 A, rate: (12 V - R*current - 0.1 V s/rad*O.omega)/0.005 H }
  warmth: { rate: (share - warmth)/1 s }
measures:
  power: R*current^2
  slope: rate(current)
loads:
  motor: { joint: O, torque: 0.1 N m/A*current - brake }
events:
  high: { when: O.angle - 90 deg, crossing: rising }
studies:
  run:
    dynamics: { until: 1 s }
";

fn read(text: &str) -> Model {
    let document = Document::read(text, "motion.yaml").unwrap_or_else(|report| panic!("{report}"));
    let report = document.check_all(&Selection::default());
    assert!(report.diagnostics.is_empty(), "{report}");
    document.model(&Selection { study: Some("run"), ..Selection::default() }).unwrap_or_else(|report| panic!("{report}"))
}

/// The base with one text replaced.
fn with(from: &str, to: &str) -> String {
    assert!(BASE.contains(from), "{from}");
    BASE.replacen(from, to, 1)
}

fn parameters(model: &Model) -> Vec<f64> {
    let values: Vec<Id> = model.parameters.iter().map(|p| p.value).collect();
    model.pool.resolve_parameters(&values)
}

/// The value of an expression where some quantities have values and the others are 0.
fn at(model: &Model, id: Id, given: &[(Quantity, f64)]) -> f64 {
    let program = model.pool.program(&[id], &parameters(model), &std::sync::Arc::from([]));
    let value = |q: &Quantity| given.iter().find(|(known, _)| known == q).map_or(0.0, |(_, x)| *x);
    let inputs: Vec<f64> = model.inputs.iter().map(value).collect();
    let mut registers = vec![0.0; program.registers()];
    let mut modes = vec![0; model.pool.switches().len()];
    program.set_modes(&inputs, &mut registers, &mut modes);
    let mut out = [0.0];
    program.eval(&inputs, &modes, &mut registers, &mut out);
    out[0]
}

fn coordinate(joint: usize, order: usize) -> Quantity {
    Quantity::Joint { joint, slot: 0, order }
}

/// `code line:column` of every finding.
fn findings(text: &str) -> Vec<String> {
    let report = match Document::read(text, "motion.yaml") {
        Ok(document) => document.check_all(&Selection::default()),
        Err(report) => report,
    };
    report.diagnostics.iter().map(|d| format!("{} {}:{}", d.code, d.line(), d.column())).collect()
}

/// Codes that always come with a remedy.
const WITH_REMEDY: [&str; 9] =
    ["wrong-option", "no-crossing", "fixed-parameter", "unstable", "out-of-range", "too-large", "not-rising", "cycle", "missing-key"];

/// Codes of the findings, and the report.
fn codes(text: &str) -> (Vec<&'static str>, String) {
    let report = match Document::read(text, "motion.yaml") {
        Ok(document) => document.check_all(&Selection::default()),
        Err(report) => report,
    };
    let bare = report.diagnostics.iter().find(|d| WITH_REMEDY.contains(&d.code) && d.help.is_none());
    assert!(bare.is_none(), "no remedy\n{report}");
    (report.diagnostics.iter().map(|d| d.code).collect(), report.to_string())
}

fn refused(text: &str, code: &str) {
    let (found, report) = codes(text);
    assert_eq!(found, [code], "{report}");
}

#[test]
fn a_state_has_the_dimension_of_its_start() {
    let model = read(BASE);
    let [current, warmth] = &model.states[..] else { panic!() };
    assert_eq!((current.name.as_str(), current.dimension), ("current", Dimension::CURRENT));
    assert_eq!((warmth.dimension, model.pool.value(warmth.start, &[])), (Dimension::NONE, 0.0));
    let given = [(Quantity::State(0), 3.0), (coordinate(0, 1), 10.0)];
    assert_eq!(at(&model, current.rate, &given), (12.0 - 2.0 * 3.0 - 0.1 * 10.0) / 0.005);
    assert_eq!(at(&model, warmth.rate, &[(Quantity::State(1), 0.2)]), 0.3);
    // measures follow states, and their rates are those of the states
    assert_eq!(at(&model, model.measures[0].value, &given), 18.0);
    assert_eq!(at(&model, model.measures[1].value, &given), at(&model, current.rate, &given));
    assert_eq!(model.measures[1].dimension, Dimension::CURRENT.div(Dimension::TIME));
    let LoadOn::Joint { effort, .. } = model.loads[0].on else { panic!() };
    assert!((at(&model, effort, &given) - (0.3 - 1.0)).abs() < 1e-15);
    let names: Vec<&str> = model.study.as_ref().unwrap().columns.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["time", "current", "warmth", "power", "slope"]);
}

#[test]
fn a_start_may_be_of_parameters_and_a_rate_of_what_loads_may_use() {
    let model = read(&with("start: 0 A, rate", "start: 2*R*3 A/1 ohm, rate"));
    assert_eq!(model.pool.value(model.states[0].start, &parameters(&model)), 12.0);
    read(&with("(share - warmth)/1 s", "S.velocity/1 m + sin(t*1 rad/s)/1 s - warmth/1 s + current/(1 A s)"));
    read(&with("(share - warmth)/1 s", "power/1 J - warmth/1 s"));
    read(&with("(share - warmth)/1 s", "rate(S.position)/1 m"));
    read(&with("start: 0 A", "start: 0 A").replacen("(share - warmth)/1 s", "2", 1));
    // in any order, through measures
    read(&with("  slope: rate(current)\n", "  slope: rate(energy_in)\n  energy_in: current^2 + 0 A^2\n"));
}

#[test]
fn drivers_know_nothing_of_the_motion() {
    for angle in ["current/1 A", "s.stretch", "s.force/1 N m", "d.torque/1 N m", "e.power/1 W", "m.torque/1 N m", "O.angle"] {
        let more = format!(
            "drivers: {{ d: {{ joint: O, angle: {angle} }}, e: {{ joint: S, position: 0 }} }}\n\
             springs: {{ s: {{ joint: O, stiffness: 1 N m }} }}\nmotors: {{ m: {{ joint: O }} }}\nevents:"
        );
        refused(&with("events:", &more), "wrong-level");
    }
}

#[test]
fn faults_of_states() {
    for (from, to, code) in [
        ("{ rate: (share - warmth)/1 s }", "{ start: 0 V, rate: 1 V }", "wrong-dimension"),
        ("(share - warmth)/1 s", "share - warmth", "wrong-dimension"),
        ("(share - warmth)/1 s", "O.alpha*1 s", "wrong-level"),
        ("(share - warmth)/1 s", "O.fx/(1 N s)", "wrong-level"),
        ("(share - warmth)/1 s", "rate(O.omega)*1 s", "wrong-level"),
        ("(share - warmth)/1 s", "rate(warmth)", "cycle"),
        ("(share - warmth)/1 s", "rate(current)/1 A", "cycle"),
        ("(share - warmth)/1 s", "slope/1 A", "cycle"),
        ("(share - warmth)/1 s", "nobody", "unknown-name"),
        ("(share - warmth)/1 s", "mean(warmth)", "wrong-level"),
        ("{ rate: (share - warmth)/1 s }", "{ start: O.angle, rate: 0 }", "wrong-level"),
        ("{ rate: (share - warmth)/1 s }", "{ start: 1 }", "missing-key"),
        ("warmth: { rate: (share - warmth)/1 s }", "power: { rate: share/1 s }", "duplicate-name"),
        ("reach: 10 cm", "reach: current*1 m/1 A", "wrong-level"),
        ("axis: [1, 0]", "axis: [1, current/1 A]", "wrong-level"),
        ("events:", "start: { current: 1 A }\nevents:", "wrong-start"),
        ("events:", "drivers: { d: { joint: O, angle: current/1 A } }\nevents:", "wrong-level"),
        ("events:", "couplings: { d: { zero: S.position - 1 m*warmth } }\nevents:", "wrong-level"),
        ("events:", "springs: { d: { stretch: S.position - 1 m*warmth, stiffness: 1 N/m } }\nevents:", "wrong-level"),
        ("events:", "springs: { d: { joint: S, force: stretch*warmth*1 N/m } }\nevents:", "wrong-level"),
        ("current - brake", "current.x - brake", "unknown-name"),
    ] {
        refused(&with(from, to), code);
    }
}

#[test]
fn without_a_unit_at_the_start_the_remedy_says_so() {
    let help = |text: &str| {
        let report = Document::read(text, "motion.yaml").unwrap().check_all(&Selection::default());
        report.diagnostics[0].help.clone().unwrap_or_default()
    };
    let rate = "(12 V - R*current - 0.1 V s/rad*O.omega)/0.005 H";
    // the fault lies inside of the rate
    assert!(help(&with("start: 0 A, ", "")).contains("`current` counts as a plain number"));
    // the fault is the rate as a whole
    assert!(help(&with("start: 0 A, ", "start: 3, ").replacen(rate, "5 A/s", 1)).contains("`start: 3 A`"));
}

#[test]
fn studies_of_prescribed_motion_follow_no_states() {
    let driven = with("states:", "drivers: { d: { joint: O, speed: 1 rpm }, e: { joint: S, position: t*1 m/s } }\nstates:");
    let study =
        |kind: &str, more: &str| driven.replacen("dynamics: { until: 1 s }", &format!("{kind}: {{ over: 1 s, samples: 4 }}{more}"), 1);
    refused(&study("inverse", ""), "wrong-level");
    refused(&study("kinematics", "\n    columns: [time, power]"), "wrong-level");
    refused(&study("kinematics", "\n    scalars: { x: max(current) }"), "wrong-level");
    let model = read(&study("kinematics", ""));
    let names: Vec<&str> = model.study.as_ref().unwrap().columns.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["O.angle", "time"][1..]);
}

#[test]
fn events_are_decoded() {
    let more = "  low: { when: power - 3 W, crossing: falling, action: stop, set: { brake: brake + 0.1 N m/A*current, share: 2*share } }\n  \
                knock: { when: S.position, restitution: { joint: S, e: share } }\n";
    let model = read(&with("studies:", &format!("{more}studies:")));
    let [high, low, knock] = &model.events[..] else { panic!() };
    assert_eq!((high.crossing, high.stop, high.set.len()), (Crossing::Rising, false, 0));
    assert!((at(&model, high.when, &[(coordinate(0, 0), 2.0)]) - (2.0 - 90_f64.to_radians())).abs() < 1e-15);
    assert_eq!((low.crossing, low.stop), (Crossing::Falling, true));
    let names: Vec<&str> = low.set.iter().map(|(i, _)| model.parameters[*i].name.as_str()).collect();
    assert_eq!(names, ["brake", "share"]);
    // a parameter in the expression is its present value
    assert!((at(&model, low.set[0].1, &[(Quantity::State(0), 4.0)]) - 1.4).abs() < 1e-15);
    assert_eq!(at(&model, low.set[1].1, &[]), 1.0);
    let Some(Restitution { joint: 1, e }) = knock.restitution else { panic!() };
    assert_eq!((at(&model, e, &[]), knock.crossing), (0.5, Crossing::Both));
}

#[test]
fn faults_of_events() {
    let event = |what: &str| with("  high: { when: O.angle - 90 deg, crossing: rising }", &format!("  high: {{ {what} }}"));
    for (what, code) in [
        ("when: O.angle > 90 deg", "no-crossing"),
        ("when: 3", "no-crossing"),
        ("when: share - 1", "no-crossing"),
        ("when: nobody", "unknown-name"),
        ("when: O.angle, crossing: up", "unknown-word"),
        ("when: O.angle, set: { nobody: 1 }", "unknown-parameter"),
        ("when: O.angle, set: { brake: 1 N }", "wrong-dimension"),
        ("when: O.angle, set: { reach: 1 m }", "fixed-parameter"),
        ("when: O.angle, restitution: { joint: S, e: 1.5 }", "out-of-range"),
        ("when: O.angle, restitution: { joint: S, e: -0.1 }", "out-of-range"),
        ("when: O.angle, restitution: { joint: nobody, e: 1 }", "unknown-joint"),
        ("when: O.angle, restitution: { joint: S, e: 1 m }", "wrong-dimension"),
        ("when: O.angle, restitution: { joint: S, e: O.alpha*1 s^2 }", "wrong-level"),
    ] {
        refused(&event(what), code);
    }
    // what the mechanism is built of cannot change
    let set = |name: &str| event(&format!("when: O.angle, set: {{ {name}: {name} }}"));
    for (from, to) in [
        ("mass: 2 kg", "mass: 2 kg*share"),
        ("axis: [1, 0]", "axis: [1, 0], damping: share*1 N s/m"),
        ("states:", "drivers: { d: { joint: O, angle: share*sin(t*1 rad/s) } }\nstates:"),
        ("states:", "couplings: { d: { zero: O.angle - share*S.position/1 m } }\nstates:"),
        ("states:", "springs: { d: { stretch: O.angle*share, stiffness: 1 N m } }\nstates:"),
        ("states:", "springs: { d: { joint: O, stiffness: share*1 N m } }\nstates:"),
    ] {
        refused(&set("share").replacen(from, to, 1), "fixed-parameter");
    }
    for (from, to) in [
        ("axis: [1, 0]", "axis: [1, 0], friction: { coulomb: share*1 N }"),
        ("axis: [1, 0]", "axis: [1, 0], limits: { to: share*1 m, stiffness: 1 N/m }"),
        ("states:", "springs: { d: { joint: O, force: stretch*share*1 N m } }\nstates:"),
        ("states:", "start: { O.angle: share }\nstates:"),
    ] {
        read(&set("share").replacen(from, to, 1));
    }
    refused(
        &event("when: O.angle, restitution: { joint: O, e: 1 }").replacen(
            "states:",
            "drivers: { d: { joint: O, speed: 1 rpm } }\nstates:",
            1,
        ),
        "wrong-joint",
    );
    let pin = "  P: { distance: [rotor.origin, block.origin] }\nstates:";
    refused(&event("when: O.angle, restitution: { joint: P, e: 1 }").replacen("states:", pin, 1), "wrong-joint");
}

#[test]
fn a_stop_pushes_and_never_pulls() {
    let model = read(&with("axis: [1, 0]", "axis: [1, 0], limits: { from: -reach, to: reach, stiffness: 1000 N/m, damping: 50 N s/m }"));
    let force = model.joints[1].limit.unwrap().force;
    let at = |x: f64, v: f64| at(&model, force, &[(coordinate(1, 0), x), (coordinate(1, 1), v)]);
    for (x, v, expected) in [
        (0.0, 3.0, 0.0),
        (0.1, 3.0, 0.0),
        (0.12, 0.0, -20.0),
        (0.12, 0.2, -30.0),
        (0.12, -1.0, 0.0),
        (-0.12, 0.0, 20.0),
        (-0.12, -0.2, 30.0),
        (-0.12, 1.0, 0.0),
    ] {
        assert!((at(x, v) - expected).abs() < 1e-12, "{x} {v}: {}", at(x, v));
    }
    let model = read(&with("origin] }\n  S", "origin], limits: { to: 30 deg, stiffness: 2 N m/rad } }\n  S"));
    let force = model.joints[0].limit.unwrap().force;
    assert!((self::at(&model, force, &[(coordinate(0, 0), 1.0)]) - 2.0 * (30_f64.to_radians() - 1.0)).abs() < 1e-15);
    assert_eq!(self::at(&model, force, &[(coordinate(0, 0), -9.0)]), 0.0);
}

#[test]
fn friction_is_a_force_or_a_coefficient() {
    let of = |what: &str| read(&with("axis: [1, 0]", &format!("axis: [1, 0], friction: {{ {what} }}")));
    let model = of("coulomb: 4 N");
    let friction = model.joints[1].friction.clone().unwrap();
    assert_eq!((friction.pressed, friction.bristle), (None, None));
    let force = friction.effort;
    for (v, expected) in [(0.0, 0.0), (5e-4, -4.0), (2.0, -4.0), (-2.0, 4.0)] {
        assert_eq!(at(&model, force, &[(coordinate(1, 1), v)]), expected);
    }
    let model = of("coulomb: 4 N, stick_speed: 2 m/s");
    let effort = |model: &Model| model.joints[1].friction.clone().unwrap().effort;
    assert_eq!(at(&model, effort(&model), &[(coordinate(1, 1), 1.0)]), -2.0);
    for coefficient in ["coulomb: 0.3", "coulomb: share, stick_speed: 1 mm/s"] {
        let friction = of(coefficient).joints[1].friction.clone().unwrap();
        assert_eq!(friction.pressed, Some(Pressure::Guide { length: None }));
    }
    assert!(of("coulomb: 0").joints[1].friction.is_none());
    // at the speed of Stribeck 1/e of what the static friction has more is left
    let model = of("coulomb: 4 N, static: 6 N, stribeck_speed: 2 m/s");
    let found = at(&model, effort(&model), &[(coordinate(1, 1), -2.0)]);
    assert!((found - (4.0 + 2.0 * (-1.0_f64).exp())).abs() < 1e-15, "{found}");
    let model = of("coulomb: 4 N, bristle: { stiffness: 100 N/m, damping: 5 N s/m }");
    let friction = model.joints[1].friction.clone().unwrap();
    let state = (Quantity::Bristle { joint: 1 }, 0.5);
    // y' = (σ₀/F) (v − |v| y), F y + (F σ₁/σ₀) y'
    assert_eq!(at(&model, friction.bristle.unwrap().rate, &[(coordinate(1, 1), 2.0), state]), 25.0);
    assert_eq!(at(&model, friction.effort, &[(coordinate(1, 1), 2.0), state]), -(2.0 + 5.0));
}

#[test]
fn faults_of_stops_and_friction() {
    for (what, code) in [
        ("limits: { to: 1 m }", "missing-key"),
        ("limits: { stiffness: 1 N/m }", "missing-key"),
        ("limits: { from: 1 m, to: -1 m, stiffness: 1 N/m }", "not-rising"),
        ("limits: { to: 1 m, stiffness: 1 N m }", "wrong-dimension"),
        ("limits: { to: 1 m, stiffness: 0 N/m }", "not-positive"),
        ("limits: { to: 1 m, stiffness: 1 N/m, damping: -1 N s/m }", "negative"),
        ("limits: { to: S.velocity*1 s, stiffness: 1 N/m }", "wrong-level"),
        ("friction: { coulomb: 4 N m }", "wrong-dimension"),
        ("friction: { coulomb: -4 N }", "negative"),
        ("friction: { coulomb: -0.1 }", "negative"),
        ("friction: { coulomb: 4 N, stick_speed: 0 m/s }", "not-positive"),
        ("friction: { coulomb: 4 N, stick_speed: 1 rad/s }", "wrong-dimension"),
        ("friction: { stick_speed: 1 m/s }", "missing-key"),
        ("friction: { coulomb: 4 N, static: 5 N }", "missing-key"),
        ("friction: { coulomb: 4 N, stribeck_speed: 5 m/s }", "missing-key"),
        ("friction: { coulomb: 4 N, static: 3 N, stribeck_speed: 5 m/s }", "negative"),
        ("friction: { coulomb: 4 N, static: 0.3 m, stribeck_speed: 5 m/s }", "wrong-dimension"),
        ("friction: { coulomb: 4 N, length: 5 cm }", "unknown-key"),
        ("friction: { coulomb: 0.2, radius: 5 cm }", "unknown-key"),
        ("friction: { coulomb: 0.2, length: 0 m }", "not-positive"),
        ("friction: { coulomb: 4 N, bristle: { damping: 1 N s/m } }", "missing-key"),
        ("friction: { coulomb: 4 N, bristle: { stiffness: 1 N } }", "wrong-dimension"),
        ("friction: { coulomb: 4 N, stick_speed: 1 m/s, bristle: { stiffness: 1 N/m } }", "unknown-key"),
        ("friction: { coulomb: 0 N, bristle: { stiffness: 1 N/m } }", "not-positive"),
        ("limits: { to: 1 m, stiffness: 1 N/m, restitution: 0.5 }", "two-kinds"),
        ("limits: { to: 1 m, restitution: 1.5 }", "out-of-range"),
        ("limits: { to: 1 m, restitution: 0.5, damping: 1 N s/m }", "unknown-key"),
        ("limits: { to: 1 m, stiffness: 1 N/m, rest_speed: 1 m/s }", "unknown-key"),
        ("limits: { to: 1 m, restitution: 0.5, rest_speed: 0 m/s }", "not-positive"),
    ] {
        refused(&with("axis: [1, 0]", &format!("axis: [1, 0], {what}")), code);
    }
}

fn forward(keys: &str) -> Forward {
    let model = read(&with("until: 1 s", keys));
    let Some(Study { kind: Kind::Dynamics(forward), .. }) = model.study else { panic!("{keys}") };
    forward
}

#[test]
fn the_keys_of_dynamics() {
    let f = forward("until: 1 s");
    assert!(matches!(f.control, Control::Tolerance(None)) && f.every.is_none() && f.locate);
    assert_eq!((f.integrator, f.level, f.chart, f.order), (Integrator::Auto, None, Chart::Auto, None));
    let f = forward(
        "until: 2 s, every: 10 ms, integrator: newmark, alpha: 1/6, beta: 1/2, step: 1 ms, coordinates: minimal, switches: step-over",
    );
    assert!(matches!(f.control, Control::Step(_)) && f.every.is_some() && !f.locate);
    assert_eq!((f.integrator, f.chart), (Integrator::Newmark, Chart::Minimal));
    assert!(f.alpha.is_some() && f.beta.is_some() && f.rho.is_none());
    let f = forward("until: 2 s, integrator: generalized-alpha, rho: 0.8, step: 1 ms, level: position, coordinates: cartesian");
    assert_eq!((f.integrator, f.level, f.chart), (Integrator::GeneralizedAlpha, Some(Level::Position), Chart::Cartesian));
    let f = forward("until: 2 s, integrator: bdf, order: 3, step: 1 ms, level: velocity");
    assert_eq!((f.order, f.level), (Some(3), Some(Level::Velocity)));
    for (word, integrator) in [
        ("hht", Integrator::Hht),
        ("radau5", Integrator::Radau5),
        ("dop853", Integrator::Dop853),
        ("rk4", Integrator::Rk4),
        ("ida", Integrator::Ida),
    ] {
        assert_eq!(forward(&format!("until: 1 s, integrator: {word}, tolerance: 0.1")).integrator, integrator);
    }
    assert_eq!(forward("until: 1 s, integrator: central-difference, step: 1 ms").integrator, Integrator::CentralDifference);
    assert_eq!(forward("until: 1 s, integrator: hht, alpha: -1/3").level, None);
    assert_eq!(forward("until: 1 s, integrator: newmark, alpha: 0.3025, beta: 0.6, level: position").level, Some(Level::Position));
}

#[test]
fn faults_of_dynamics() {
    for (keys, code) in [
        ("until: 0 s", "not-positive"),
        ("until: 1 m", "wrong-dimension"),
        ("until: 1 s, every: -1 s", "not-positive"),
        ("until: 1 s, step: 0 s", "not-positive"),
        ("until: 1 s, tolerance: 0.2", "too-large"),
        ("until: 1 s, tolerance: 0", "not-positive"),
        ("until: 1 s, tolerance: -1", "not-positive"),
        ("until: 1 s, tolerance: 1e-8, step: 1 s", "two-kinds"),
        ("until: 1 s, integrator: euler", "unknown-word"),
        ("until: 1 s, rho: 0.8", "wrong-option"),
        ("until: 1 s, integrator: bdf, rho: 0.8", "wrong-option"),
        ("until: 1 s, integrator: generalized-alpha, rho: 1.1", "out-of-range"),
        ("until: 1 s, integrator: generalized-alpha, rho: -0.1", "out-of-range"),
        ("until: 1 s, integrator: hht, alpha: 0.1", "out-of-range"),
        ("until: 1 s, integrator: hht, alpha: -0.4", "out-of-range"),
        ("until: 1 s, integrator: hht, alpha: -0.1, beta: 0.5", "wrong-option"),
        ("until: 1 s, integrator: newmark, alpha: 1/4", "missing-key"),
        ("until: 1 s, integrator: newmark, beta: 1/2", "missing-key"),
        ("until: 1 s, integrator: newmark, alpha: -1/4, beta: 1/2", "negative"),
        ("until: 1 s, integrator: newmark, alpha: 1/6, beta: 1/2, level: position", "unstable"),
        ("until: 1 s, integrator: newmark, alpha: 1/4, beta: 1/2, level: position", "unstable"),
        ("until: 1 s, integrator: newmark, level: position", "unstable"),
        ("until: 1 s, integrator: dop853, level: velocity", "wrong-option"),
        ("until: 1 s, integrator: rk4, level: acceleration", "wrong-option"),
        ("until: 1 s, integrator: central-difference, step: 1 ms, level: acceleration", "wrong-option"),
        ("until: 1 s, integrator: bdf, level: position, coordinates: minimal", "wrong-option"),
        ("until: 1 s, integrator: central-difference", "missing-key"),
        ("until: 1 s, switches: step-over", "missing-key"),
        ("until: 1 s, integrator: bdf, order: 2", "missing-key"),
        ("until: 1 s, integrator: rk4, step: 1 ms, order: 2", "wrong-option"),
        ("until: 1 s, integrator: bdf, step: 1 ms, order: 6", "bad-count"),
    ] {
        refused(&with("until: 1 s", keys), code);
    }
}

#[test]
fn findings_stand_at_their_keys() {
    assert_eq!(findings(&with("until: 1 s", "until: 1 s, rho: 0.8")), ["wrong-option 30:29"]);
    assert_eq!(findings(&with("until: 1 s", "until: 1 s, tolerance: 0.2")), ["too-large 30:40"]);
    assert_eq!(findings(&with("(share - warmth)/1 s", "slope/1 A")), ["cycle 20:19"]);
}
