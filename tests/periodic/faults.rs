//! Why there is no regime, in words.

use crate::common::model;
use grashof::results::Failure;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::run::run;

/// Why a study gives nothing.
fn failure(text: &str) -> Failure {
    let model = model(text, Some("regime"));
    let study = model.study.clone().unwrap();
    match run(Case::new(&model, &study, &parameters(&model)), &|| false) {
        Err(failure) => failure,
        Ok(outcome) => panic!("a regime: {:?}", outcome.results),
    }
}

/// The failure is numerical (exit code 3), or one of what was asked (2), and has all the words.
pub(super) fn told(text: &str, numerical: bool, words: &[&str]) {
    let failure = failure(text);
    assert_eq!(matches!(failure, Failure::Numerical { .. }), numerical, "{failure:?}");
    let mut all = failure.reason();
    if let Failure::Study { help, .. } | Failure::Numerical { help, .. } = &failure {
        all.push_str(help);
    }
    if let Failure::Study { code, .. } = &failure {
        all.push_str(code);
    }
    for word in words {
        assert!(all.contains(word), "no `{word}` in: {all}");
    }
}

/// A wheel with an eccentric mass, 0.5 kg m², under loads.
fn wheel(loads: &str, rest: &str, periodic: &str) -> String {
    format!(
        "grashof: 1
name: wheel
space: planar
gravity: [0, -9.81 m/s^2]
parameters: {{ torque: 1 N m }}
bodies: {{ wheel: {{ mass: 4 kg, com: [10 cm, 0], inertia: 0.5 kg m^2 }} }}
joints: {{ O: {{ revolute: [ground, wheel.origin], damping: 0.3 N m s/rad }} }}
loads: {{ {loads} }}
start: {{ O.angle: -90 deg, O.omega: 0 rad/s }}
{rest}
studies:
  regime: {{ periodic: {{ {periodic} }}, columns: [O.angle, O.omega] }}
"
    )
}

const TURN: &str = "over: O.angle, by: 1 turn, of: O.omega";

#[test]
fn a_mechanism_that_stalls() {
    told(&wheel("drive: { joint: O, torque: torque }", "", TURN), true, &["`O.angle`", "does not advance", "it has gone", "stalls"]);
}

#[test]
fn a_mechanism_that_runs_away() {
    let text = wheel("drive: { joint: O, torque: 9 N m + 0.31 N m s/rad*O.omega }", "", TURN);
    told(&text, true, &["no regime is found"]);
}

#[test]
fn forces_in_time_beside_a_period_by_angle() {
    told(
        &wheel("drive: { joint: O, torque: 9 N m + 1 N m*sin(3 rad/s*t) }", "", TURN),
        false,
        &["time acts", "`O.angle`", "over: t", "forced-period"],
    );
}

#[test]
fn forces_that_are_not_periodic() {
    let loads = "drive: { joint: O, torque: 9 N m + 1 N m*sin(3 rad/s*t) }";
    told(&wheel(loads, "", "over: t, by: 2 s, of: O.omega, settle: 0 s"), false, &["one period later", "not-periodic"]);
    // what changes when the regime has long been found
    let late = "drive: { joint: O, torque: \"9 N m + if(t < 150 s, 1, 0.5)*1 N m*sin(2*pi*t/2 s)\" }";
    told(&wheel(late, "", "over: t, by: 2 s, of: O.omega, settle: 0 s"), false, &["100 periods later", "not-periodic"]);
}

#[test]
fn a_period_in_time_where_nothing_depends_on_it() {
    told(
        &wheel("drive: { joint: O, torque: 9 N m }", "", "over: t, by: 0.31 s, of: O.omega, settle: 1 s"),
        true,
        &["no regime", "nothing in the model depends on time"],
    );
}

#[test]
fn a_run_that_does_not_settle() {
    // no period of the wheel takes so long
    told(
        &wheel("drive: { joint: O, torque: 9 N m }", "", "over: t, by: 0.31 s, of: O.omega"),
        true,
        &["has not settled after 1000 periods", " % a period", "Newton's method finds no regime", "nothing in the model depends on time"],
    );
}

#[test]
fn events_that_set_parameters() {
    let events = "events: { low: { when: O.angle, set: { torque: torque + 1 N m } } }";
    told(&wheel("drive: { joint: O, torque: 8 N m + torque }", events, TURN), false, &["`low`", "sets a parameter", "events-that-set"]);
}

#[test]
fn an_event_that_stops() {
    let events = "events: { done: { when: O.omega - 4 rad/s, crossing: rising, action: stop } }";
    told(&wheel("drive: { joint: O, torque: 9 N m }", events, TURN), true, &["`done`", "ends the motion"]);
}

#[test]
fn a_spring_that_winds_up() {
    let coil = "springs: { coil: { joint: O, stiffness: 0.002 N m/rad } }";
    told(&wheel("drive: { joint: O, torque: 9 N m }", coil, TURN), false, &["another", "counts the turns", "not-periodic"]);
}

#[test]
fn a_measure_that_turns_back() {
    let rest = "measures: { phase: O.angle + 1.5*sin(O.angle) }";
    told(
        &wheel("drive: { joint: O, torque: 20 N m }", rest, "over: phase, by: 1 turn, of: O.omega"),
        false,
        &["`phase` turns back", "turns-back"],
    );
}

#[test]
fn an_oscillation_that_dies_out() {
    told(&wheel("", "", "over: t, through: O.omega - 1 rad/s, of: O.omega"), true, &["`through`", "rise"]);
}

/// A mass on a spring, drawn by 10 cm.
fn spring(damping: &str, periodic: &str) -> String {
    format!(
        "grashof: 1
name: spring and mass
space: planar
gravity: none
bodies: {{ mass: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, mass.origin], axis: [1, 0]{damping} }} }}
springs: {{ spring: {{ joint: S, stiffness: 1 N/m }} }}
start: {{ S.position: 0.1 m, S.velocity: 0 m/s }}
studies:
  regime: {{ periodic: {{ {periodic}, of: S.position }} }}
"
    )
}

#[test]
fn a_motion_that_keeps_its_energy_has_a_period_of_its_own() {
    let words = ["no force takes or gives energy", "one for every energy", "`over: t, through: ...`", "`settle: 0 s`"];
    told(&spring("", "over: t, by: 5 s"), true, &words);
}

#[test]
fn a_damped_motion_without_a_drive_comes_to_rest() {
    for periodic in ["over: t, by: 5 s", "over: t, through: S.position"] {
        told(&spring(", damping: 0.2 N s/m", periodic), true, &["rest", "stands still", "nothing drives it", "`statics`"]);
    }
    // held by friction
    told(&spring(", friction: { coulomb: 0.02 N }", "over: t, by: 5 s"), true, &["rest", "stands still"]);
    // no motion of the spring has this period but rest
    told(&spring("", "over: t, by: 5 s, settle: 0 s"), true, &["rest", "stands still"]);
}
