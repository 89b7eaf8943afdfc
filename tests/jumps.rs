//! Laws that jump: a motion ends on their near side, whatever the kind of its study.

use crate::common::{close, model};
use grashof::results::Failure;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run;

fn study(text: &str, name: &str) -> Result<Outcome, Failure> {
    let model = model(text, Some(name));
    let study = model.study.clone().expect("the study");
    run(Case::new(&model, &study, &parameters(&model)), &|| false)
}

/// A bar of 1 m and 1 kg on a hinge, turned by a law of `t`.
fn crank(law: &str) -> String {
    format!(
        "grashof: 1
name: crank
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ a: {{ bar: {{ length: 1 m, mass: 1 kg }} }} }}
joints: {{ O: {{ revolute: [ground, a.start] }} }}
drivers: {{ d: {{ joint: O, angle: \"{law}\" }} }}
studies:
  k: {{ kinematics: {{ over: 1 s, samples: 4 }}, columns: [time, O.angle], scalars: {{ most: max(O.angle), end: last(O.angle) }} }}
  i: {{ inverse: {{ over: 1 s, samples: 4 }}, columns: [time, O.angle, d], scalars: {{ most: max(O.angle), end: last(O.angle) }} }}
  d: {{ dynamics: {{ until: 1 s, every: 0.25 s }}, columns: [time, O.angle, d], scalars: {{ most: max(O.angle), end: last(O.angle) }} }}
"
    )
}

#[test]
fn a_motion_ends_on_the_near_side_of_a_jump() {
    for (behind, word) in
        [("2 rad", "from 0.5 to 2 (SI)"), ("0.3 rad", "from 0.5 to 0.3 (SI)"), ("1 rad/s*t + 1e-3 rad", "from 0.5 to 0.501 (SI)")]
    {
        for name in ["k", "i", "d"] {
            let outcome = study(&crank(&format!("if(t < 0.5 s, 1 rad/s*t, {behind})")), name).unwrap();
            let stopped = outcome.stopped.as_deref().unwrap_or_default();
            assert!(stopped.contains("the law of the driver `d` jumps") && stopped.contains(word), "{name}: {stopped}");
            let places = outcome.rows.iter().map(|row| [row[0], row[1]]).collect::<Vec<_>>();
            close(name, places.as_flattened(), &[0.0, 0.0, 0.25, 0.25, 0.5, 0.5], 1e-12);
            close(name, &outcome.scalars, &[0.5, 0.5], 1e-12);
            let codes: Vec<&str> = outcome.findings.iter().map(|f| &*f.code).collect();
            assert!(codes.is_empty(), "{name}: {codes:?}");
            if let Some(march) = outcome.certificate.march {
                // ½ m g sin 0.5 and the turning with 1 rad/s that it begins with
                close("work", &[march.drivers], &[5.0 * 0.5_f64.sin()], 1e-8);
                assert!(march.energy_drift < 1e-8, "{}", march.energy_drift);
            }
        }
    }
}

#[test]
fn a_coupling_that_jumps_is_no_dead_point() {
    let laws = [
        ("if(t < 0.5 s, 0 m, 0.3 m)", "0.3"),
        ("if(A.position < 0.5 m, 0 m, -0.2 m)", "0.2"),
        // so low that a step of the path leaps over it
        ("if(t < 0.5 s, 0 m, 3 mm)", "by -0.003 (SI)"),
        ("if(A.position < 0.5 m, 0 m, -3 mm)", "by 0.003 (SI)"),
        ("if(A.position >= 0.5 m and A.position < 0.500001 m, 1 um, 0 m)", "by -1e-6 (SI)"),
        ("1 m*floor(A.position/0.5 m)/100", "by -0.01 (SI)"),
        ("0.02*(mod(A.position, 0.5 m) - A.position)", "by 0.01 (SI)"),
        ("0.5 um*(1 + sign(A.position - 0.5 m))", "by -1e-6 (SI)"),
    ];
    for (law, jump) in laws {
        let text = format!(
            "grashof: 1
name: two slides
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 1 kg }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0] }}, B: {{ slider: [ground, b.origin], axis: [1, 0] }} }}
drivers: {{ d: {{ joint: A, speed: 1 m/s }} }}
couplings: {{ c: {{ zero: \"B.position - 2*A.position - {law}\" }} }}
studies:
  k: {{ kinematics: {{ over: 1 s, samples: 2 }}, columns: [time, A.position, B.position], scalars: {{ most: max(B.position) }} }}
  i: {{ inverse: {{ over: 1 s, samples: 2 }}, columns: [time, A.position, B.position], scalars: {{ most: max(B.position) }} }}
"
        );
        for name in ["k", "i"] {
            let outcome = study(&text, name).unwrap();
            let stopped = outcome.stopped.as_deref().unwrap_or_default();
            assert!(stopped.contains("what the coupling `c` holds jumps") && stopped.contains(jump), "{law}: {stopped}");
            let rows: Vec<f64> = outcome.rows.iter().flat_map(<[f64]>::to_vec).collect();
            close(law, &rows, &[0.0, 0.0, 0.0, 0.5, 0.5, 1.0], 1e-12);
            close(law, &outcome.scalars, &[1.0], 1e-12);
            assert!(outcome.findings.iter().all(|f| f.code != "dead-point"), "{law}: {:?}", outcome.findings);
        }
    }
}

/// Where the formula of a law changes without a step it goes on, over many turns as well.
#[test]
fn a_coupling_with_many_kinks_does_not_jump() {
    for law in ["0.5*mod(A.angle, 1 turn)*(1 turn - mod(A.angle, 1 turn))/1 rad", "sin(A.angle)*sign(sin(A.angle))*1 rad"] {
        let outcome = moved_by(law, "{ A.angle: 0.25 rad }", "100 turn", 10);
        assert_eq!(outcome.stopped, None, "{law}");
        assert!((outcome.places.last().unwrap() - outcome.places[0] - 200.0 * std::f64::consts::PI).abs() < 1e-9, "{law}");
    }
}

/// Two bars side by side, the second of them moved by a law of the angle of the first, which turns at 1 rad/s.
fn moved_by(law: &str, start: &str, over: &str, samples: usize) -> Outcome {
    let text = format!(
        "grashof: 1
name: kinks
space: planar
gravity: none
ground: {{ A: [0, 0], B: [1 m, 0] }}
bodies:
  a: {{ mass: 1 kg, inertia: 0.1 kg m^2 }}
  b: {{ mass: 1 kg, inertia: 0.2 kg m^2 }}
joints: {{ A: {{ revolute: [ground.A, a.origin] }}, B: {{ revolute: [ground.B, b.origin] }} }}
drivers: {{ drive: {{ joint: A, speed: 1 rad/s }} }}
start: {start}
couplings: {{ law: {{ zero: \"B.angle - {law}\" }} }}
studies: {{ s: {{ kinematics: {{ over: {over}, samples: {samples} }}, columns: [A.angle, B.angle, B.omega] }} }}
"
    );
    study(&text, "s").unwrap()
}

#[test]
fn a_coupling_may_have_kinks_on_many_turns_and_of_any_slope() {
    for (slope, turns) in [(1.0, 120), (3.0, 8), (12.0, 8), (30.0, 120)] {
        let outcome =
            moved_by(&format!("{slope}*abs(mod(A.angle, 1) - 0.5)"), "{ A.angle: 0.25 rad }", &format!("{turns} turn"), 8 * turns);
        assert_eq!(outcome.stopped, None);
        // behind the start a kink at each half of a radian
        let range = f64::from(turns as u32) * std::f64::consts::TAU;
        assert_eq!(outcome.switches.len() as f64, (2.0 * (range + 0.25)).floor(), "{slope}, {turns}");
        assert!(outcome.findings.iter().all(|f| f.code == "velocity-jump"), "{:?}", outcome.findings);
        for row in outcome.rows.iter() {
            let past = row[0].rem_euclid(1.0) - 0.5;
            assert!((row[1] - slope * past.abs()).abs() < 1e-11 * (1.0 + slope) * range, "{slope}: {row:?}");
            let corner = past.abs().min(0.5 - past.abs()) < 1e-9;
            assert!(corner || (row[2] - slope * past.signum()).abs() < 1e-9 * slope, "{slope}: {row:?}");
        }
    }
}

#[test]
fn a_motion_keeps_its_rows_up_to_where_no_velocity_leads_on() {
    let outcome = moved_by("sqrt(abs(A.angle - 2))", "{ A.angle: 1 rad }", "1 turn", 60);
    assert!(outcome.stopped.as_deref().is_some_and(|why| why.contains("A.angle = 114.592 deg")), "{:?}", outcome.stopped);
    let last = outcome.rows.iter().last().unwrap();
    assert!((last[0] - 2.0).abs() < 1e-6 && last[1].abs() < 1e-3, "{last:?}");
    assert!(outcome.rows.iter().all(|row| (row[1] - (row[0] - 2.0).abs().sqrt()).abs() < 1e-6));
}

#[test]
fn a_jump_just_behind_the_start_leaves_no_motion() {
    for name in ["k", "i", "d"] {
        let Err(failure) = study(&crank("if(t <= 0 s, 0 rad, 1 rad)"), name) else { panic!("{name} has rows") };
        assert!(failure.reason().contains("the law of the driver `d` jumps"), "{name}: {}", failure.reason());
    }
}
