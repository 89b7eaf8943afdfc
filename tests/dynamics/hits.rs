//! Joints on rigid stops and the events that tell of them: a begin at rest, and one event for one hit.

use crate::common::{model, study};
use crate::reference::Verdict;
use crate::reference::program::run_text;
use grashof::mechanism::Coordinates;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run_in;

/// A ball over a floor that gives back half of its speed.
fn ball(floor: f64, start: f64, events: &str, dynamics: &str) -> String {
    format!(
        "grashof: 1
name: ball
space: planar
gravity: [0, -9.81 m/s^2]
parameters: {{ count: 0 }}
bodies: {{ ball: {{ ball: {{ radius: 3 cm, mass: 0.5 kg }} }} }}
joints: {{ fall: {{ slider: [ground, ball.origin], axis: [0, 1], limits: {{ from: {floor} m, restitution: 0.5 }} }} }}
start: {{ fall.position: {start} m, fall.velocity: 0 m/s }}
measures: {{ counted: count }}
events: {{ {events} }}
studies:
  run: {{ dynamics: {{ {dynamics} }}, columns: [time, fall.position, counted] }}
"
    )
}

fn last(outcome: &Outcome) -> Vec<f64> {
    outcome.rows.last().expect("a row").to_vec()
}

#[test]
fn a_joint_that_begins_on_its_stop_is_no_finding() {
    for floor in [0.0, 0.3, -17.0] {
        for integrator in ["auto", "radau5", "bdf", "dop853, coordinates: minimal"] {
            let found =
                study(&ball(floor, floor, "", &format!("until: 2 s, every: 0.5 s, integrator: {integrator}")), "run", Coordinates::Joint);
            let told: Vec<&str> = found.findings.iter().map(|f| f.code.as_ref()).collect();
            assert!(told.is_empty(), "floor at {floor} m, {integrator}: {told:?}");
            assert_eq!(found.certificate.march.as_ref().map(|m| m.counts.unresolved), Some(0), "{floor}, {integrator}");
            assert!((last(&found)[1] - floor).abs() < 1e-12, "{floor}, {integrator}: {:?}", last(&found));
        }
    }
}

#[test]
fn a_bar_that_begins_on_its_stop_beside_a_loop_is_no_finding() {
    let text = "grashof: 1
name: four-bar on a stop
space: planar
gravity: [0, -9.81 m/s^2]
ground: { P: [0, 0], R: [1 m, 0] }
bodies:
  crank: { bar: { length: 30 cm, mass: 3 kg } }
  coupler: { bar: { length: 1 m, mass: 6 kg } }
  rocker: { bar: { length: 55 cm, mass: 6 kg } }
joints:
  O: { revolute: [ground.P, crank.start], limits: { from: 20 deg, restitution: 0.3 } }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.R, rocker.start] }
start: { O.angle: 20 deg, O.omega: 0 rad/s, coupler.angle: ~20 deg, rocker.angle: ~110 deg }
loads: { press: { joint: O, torque: -20 N m } }
studies:
  run: { dynamics: { until: 1 s, every: 0.5 s }, columns: [time, O.angle] }
";
    let found = study(text, "run", Coordinates::Joint);
    assert!(found.findings.iter().all(|f| f.code != "unresolved-condition"), "{:?}", found.findings);
    assert!((last(&found)[1] - 20.0_f64.to_radians()).abs() < 1e-12, "{:?}", last(&found));
}

#[test]
fn one_hit_is_one_event_whatever_directions_count() {
    // from 0.5 m: hits after 0.3193, 0.6386 and 0.7982 s
    for (until, hits) in [(0.5, 1), (0.75, 2), (0.79, 2), (0.8, 3)] {
        for crossing in ["both", "falling"] {
            for when in ["fall.position", "-fall.position"] {
                let crossing = if when.starts_with('-') && crossing == "falling" { "rising" } else { crossing };
                let told = format!("hit: {{ when: {when}, crossing: {crossing} }}");
                let set = format!("hit: {{ when: {when}, crossing: {crossing}, set: {{ count: count + 1 }} }}");
                let found = study(&ball(0.0, 0.5, &told, &format!("until: {until} s, every: 0.5 s")), "run", Coordinates::Joint);
                assert_eq!(found.events.len(), hits, "{told} up to {until} s: {:?}", found.events);
                let found = study(&ball(0.0, 0.5, &set, &format!("until: {until} s, every: 0.5 s")), "run", Coordinates::Joint);
                assert_eq!((found.events.len(), last(&found)[2]), (hits, hits as f64), "{set} up to {until} s: {:?}", found.events);
            }
        }
    }
}

#[test]
fn an_event_that_the_motion_goes_through_counts_both_ways() {
    let events = "middle: { when: fall.position - 5 cm, crossing: both }";
    let found = study(&ball(0.0, 0.5, events, "until: 0.62 s, every: 0.5 s"), "run", Coordinates::Joint);
    assert_eq!(found.events.len(), 3, "down, up, down: {:?}", found.events);
}

#[test]
fn a_stop_and_an_impact_at_one_place_are_refused() {
    let told = |when: &str| {
        let text =
            ball(0.2, 0.5, &format!("floor: {{ when: {when}, crossing: falling, restitution: {{ joint: fall, e: 0.9 }} }}"), "until: 1 s");
        let model = model(&text, Some("run"));
        let study = model.study.clone().expect("the study");
        run_in(Case::new(&model, &study, &parameters(&model)), Coordinates::Joint, &|| false).map(|_| ()).map_err(|why| why.reason())
    };
    for when in ["fall.position - 20 cm", "2*(20 cm - fall.position)", "(fall.position/20 cm)^2 - 1"] {
        let why = told(when).expect_err(when);
        for word in ["`floor`", "lower stop of joint `fall`", "`restitution`"] {
            assert!(why.contains(word), "no {word} in: {why}");
        }
    }
    // another place is met before the stop
    assert_eq!(told("fall.position - 21 cm"), Ok(()));
}

/// A plate over two stops at its ends with their restitutions, half a metre below.
fn plate([left, right]: [f64; 2], dynamics: &str, columns: &str) -> String {
    format!(
        "grashof: 1
name: plate on two stops
space: planar
gravity: [0, -10 m/s^2]
bodies:
  p: {{ plate: {{ size: [1 m, 0.1 m], mass: 2 kg }}, points: {{ L: [-0.5 m, 0], R: [0.5 m, 0] }} }}
  l: {{ mass: 0 kg }}
  r: {{ mass: 0 kg }}
ground: {{ L: [-0.5 m, 0], R: [0.5 m, 0] }}
joints:
  X: {{ pin-in-slot: [ground, p.origin], axis: [0, 1] }}
  GL: {{ slider: [ground.L, l.origin], axis: [0, 1], limits: {{ from: 0 m, restitution: {left} }} }}
  GR: {{ slider: [ground.R, r.origin], axis: [0, 1], limits: {{ from: 0 m, restitution: {right} }} }}
  SL: {{ pin-in-slot: [p.L, l.origin], axis: [1, 0] }}
  SR: {{ pin-in-slot: [p.R, r.origin], axis: [1, 0] }}
start: {{ p.y: 0.5 m, p.angle: 0 deg }}
studies:
  fall: {{ dynamics: {{ {dynamics} }}, columns: [time, {columns}] }}
"
    )
}

/// A plate that falls on two stops at its ends, hit at one instant: each end is left with its own restitution, as if it were alone.
#[test]
fn stops_that_are_hit_at_one_instant_know_no_order() {
    let mut verdict = Verdict::default();
    let speed = f64::sqrt(10.0);
    for (left, right) in [(0.5, 0.5), (1.0, 1.0), (0.0, 0.0), (0.25, 0.75), (0.75, 0.25)] {
        for coordinates in ["joint", "cartesian", "minimal"] {
            let text = plate([left, right], &format!("until: 0.32 s, coordinates: {coordinates}"), "p.vy, p.omega");
            let table = run_text(&text, &["--no-plots"]).succeeded().table("fall");
            let last = table.rows.last().map_or([f64::NAN; 3], |row| [row[0], row[1], row[2]]);
            // the hit is at 0.3162 s; 4 ms later the plate has lost as much speed as it had gained in them
            let falls = if left == 0.0 { 0.0 } else { 10.0 * (0.32 - f64::sqrt(0.1)) };
            let what = format!("{left} and {right}, {coordinates}");
            verdict.close("vy", &what, last[1], 0.5 * (left + right) * speed - falls, 1e-7);
            verdict.close("omega", &what, last[2], (right - left) * speed, 1e-7);
        }
    }
    verdict.give("plate");
}

/// The same plate until it rests: round-off of one blow does not tell the next ones apart, so that it never turns.
#[test]
fn a_plate_that_falls_flat_stays_flat() {
    let mut verdict = Verdict::default();
    for scheme in ["dop853", "radau5", "bdf, tolerance: 1e-6", "rk4, step: 1 ms", "dop853, coordinates: minimal"] {
        let text = plate([0.7; 2], &format!("until: 3 s, every: 10 ms, integrator: {scheme}"), "p.y, p.angle");
        let table = run_text(&text, &["--no-plots"]).succeeded().table("fall");
        let turned = table.rows.iter().fold(0.0, |m: f64, row| m.max(row[2].abs()));
        verdict.close("angle", scheme, turned, 0.0, 1e-6);
        verdict.close("height", scheme, table.rows.last().map_or(f64::NAN, |row| row[1]), 0.0, 1e-8);
    }
    verdict.give("flat plate");
}

#[test]
fn an_event_of_a_rate_is_met_at_the_blow_that_carries_it_over() {
    let text = |settings: &str| {
        format!(
            "grashof: 1
name: rate over its threshold
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ G1: [0.338, -0.123] }}
bodies:
  b1: {{ mass: 2.63, com: [0.044, 0.005], inertia: 0.137, points: {{ P: [0.276, 0] }} }}
  b2: {{ mass: 0.547, com: [0.284, -0.006], inertia: 0.25, points: {{ P: [0.235, 0] }} }}
joints: {{ J1: {{ revolute: [ground.G1, b1.origin] }}, J2: {{ revolute: [b1.P, b2.origin] }} }}
clutches: {{ cl: {{ between: [J1, J2], torque: 2.989 N m }} }}
start: {{ J2.omega: 0.924 }}
parameters: {{ n: 0 }}
events:
  over: {{ when: J2.omega + 0.22 rad/s, crossing: rising, set: {{ n: n + 1 }} }}
  blow: {{ when: J2.angle + 0.106 rad, crossing: falling, restitution: {{ joint: J2, e: 0.254 }} }}
studies: {{ run: {{ dynamics: {{ until: 1 s, {settings} }}, columns: [time, J2.omega] }} }}
"
        )
    };
    let mut verdict = Verdict::default();
    for coordinates in ["joint", "cartesian", "minimal"] {
        for scheme in ["dop853", "radau5", "bdf"] {
            let place = format!("{scheme}, {coordinates}");
            let outcome = study(&text(&format!("integrator: {scheme}, coordinates: {coordinates}")), "run", Coordinates::Joint);
            let of = |name: &str| outcome.events.iter().filter(|event| event.name == name).map(|event| event.at).collect::<Vec<_>>();
            let (over, blows) = (of("over"), of("blow"));
            verdict.close("events", &place, over.len() as f64, 2.0, 0.0);
            // the first two blows, which turn the joint round
            over.iter().zip(&blows).for_each(|(over, blow)| verdict.close("time", &place, *over, *blow, 1e-12));
        }
    }
    verdict.give("an_event_of_a_rate_is_met_at_the_blow_that_carries_it_over");
}

/// A mass at the height of 1 m, and an arm at 60 degrees, over what throws them back; events that count.
fn counted(body: &str, events: &str, dynamics: &str) -> String {
    format!(
        "grashof: 1
name: counted hits
space: planar
gravity: [0, -10 m/s^2]
parameters: {{ n: 0 }}
{body}
events: {{ {events} }}
measures: {{ counted: n }}
studies:
  run: {{ dynamics: {{ until: 2.5 s, {dynamics} }}, columns: [time, counted] }}
"
    )
}

/// Hits until the rebound is below 0.001 m/s or rad/s; rest until the end.
fn hits(speed: f64, e: f64) -> f64 {
    ((speed / 1e-3).ln() / (1.0 / e).ln()).ceil()
}

#[test]
fn events_that_set_count_every_hit_of_a_stop_and_of_an_impact() {
    let mut verdict = Verdict::default();
    let mass = |limits: &str| {
        format!(
            "bodies: {{ mass: {{ mass: 2 kg }} }}
joints: {{ S: {{ slider: [ground, mass.origin], axis: [0, 1]{limits} }} }}
start: {{ S.position: 1 m }}"
        )
    };
    let arm = "bodies: { arm: { bar: { length: 1 m, mass: 1 kg } } }
joints: { A: { revolute: [ground, arm.start], limits: { from: 0 deg, restitution: 0.6 } } }
start: { A.angle: 60 deg }";
    let set = "set: { n: n + 1 }";
    for dynamics in
        ["integrator: auto", "integrator: radau5", "integrator: bdf", "integrator: rk4, step: 1 ms", "integrator: generalized-alpha"]
    {
        let mut case = |body: &str, events: &str, right: f64| {
            let found = study(&counted(body, events, dynamics), "run", Coordinates::Joint);
            verdict.close("hits", format!("{dynamics}, {events}, {body}"), last(&found)[1], right, 0.0);
        };
        for e in [0.5, 0.3, 0.05] {
            let right = hits(20f64.sqrt(), e);
            let limits = format!(", limits: {{ from: 0 m, restitution: {e} }}");
            case(&mass(&limits), &format!("hit: {{ when: S.position, {set} }}, seen: {{ when: S.position }}"), right);
            let impact = format!("struck: {{ when: S.position, crossing: falling, restitution: {{ joint: S, e: {e} }} }}");
            case(&mass(""), &format!("{impact}, hit: {{ when: S.position, crossing: falling, {set} }}"), right);
        }
        // the square of the speed at the first hit: 3 g sin 60° / l
        let speed = (30.0 * 60f64.to_radians().sin()).sqrt();
        case(arm, &format!("tip: {{ when: arm.end.y, {set} }}, turned: {{ when: A.omega, crossing: rising }}"), hits(speed, 0.6));
    }
    verdict.give("hits that are counted");
}

/// A hinge in space that an event, or a rigid stop, brings to rest and holds: what its rate decides is the same in all coordinates, though
/// constraints hold it to round-off only.
#[test]
fn what_is_held_has_no_rate_in_any_coordinates() {
    let event = "events: { E: { when: WHEN, crossing: rising, restitution: { joint: J, e: 0 } } }";
    let text = |limits: &str, event: &str| {
        format!(
            "grashof: 1
name: a held hinge
space: spatial
gravity: none
bodies:
  a: {{ bar: {{ length: 0.7 m, width: 3 cm, height: 2 cm, mass: 2 kg }} }}
  b: {{ bar: {{ length: 1 m, width: 3 cm, height: 2 cm, mass: 2 kg }} }}
joints:
  I: {{ revolute: [ground, a.start], axis: [0.3, 0.2, 0.8] }}
  J: {{ revolute: [a.end, b.start], axis: [0.2, 0.4, 0.9]{limits} }}
loads: {{ push: {{ joint: J, torque: 2 N m }} }}
start: {{ I.angle: 0.3 rad, I.omega: 1 rad/s, J.angle: 0 rad, J.omega: 1 rad/s }}
{event}
studies:
  run:
    dynamics: {{ until: 0.6 s, every: 20 ms }}
    columns: [time, J.angle]
    scalars: {{ up: integral(J.omega > 0 rad/s), rest: integral(J.omega == 0 rad/s), beyond: integral(J.angle > 0.2 rad) }}
"
        )
    };
    let stop = text(", limits: { to: 0.2 rad, restitution: 0 }", "");
    let right = study(&stop, "run", Coordinates::Joint).scalars;
    assert!((right[0] - 0.10624).abs() < 1e-5 && (right[0] + right[1] - 0.6).abs() < 1e-9, "{right:?}");
    for when in ["J.angle - 0.2 rad", "5*J.angle - 1 rad", "J.angle^2 - 0.04 rad^2"] {
        let text = text("", &event.replace("WHEN", when));
        for coordinates in ["joint", "cartesian", "minimal"] {
            let text = text.replace("every: 20 ms", &format!("every: 20 ms, coordinates: {coordinates}"));
            let found = study(&text, "run", Coordinates::Joint).scalars;
            let off = |k: usize| (found[k] - right[k]).abs();
            // of the square the zero is known to round-off, on either side of 0.2 rad
            let beyond = if when.contains('^') { 0.0 } else { off(2) };
            assert!(off(0) < 1e-7 && off(1) < 1e-7 && beyond < 1e-9, "{when}, {coordinates}: {found:?} instead of {right:?}");
        }
    }
}
