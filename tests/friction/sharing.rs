//! Several contacts that hold one motion at rest: what they hold together, and what each of them is said to carry.

use super::{close, done, last};

/// A bar of 1 m and 2 kg that a bearing and a brake hold level: its weight asks for 10 N m.
fn braked(bearing: f64, brake: f64, load: &str, study: &str) -> String {
    format!(
        "grashof: 1
name: parking brake beside the friction of a bearing
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ a: {{ bar: {{ length: 1 m, mass: 2 kg }} }} }}
joints: {{ A: {{ revolute: [ground, a.start], friction: {{ coulomb: {bearing} N m }} }} }}
clutches: {{ brake: {{ joint: A, torque: {brake} N m }} }}
loads: {{ push: {{ joint: A, torque: {load} }} }}
start: {{ A.angle: 0 deg }}
studies: {{ rest: {{ {study}, columns: [A.angle, A.friction, brake.torque] }} }}
"
    )
}

#[test]
fn what_two_contacts_hold_together_stays_where_it_is_put() {
    let statics = "statics: { from: start }";
    for (bearing, brake) in [(6.0, 6.0), (6.0, 4.5), (1.0, 9.5), (100.0, 0.1), (0.1, 100.0)] {
        for study in [statics, "dynamics: { until: 1 s }"] {
            let outcome = done(&braked(bearing, brake, "0 N m", study), "rest");
            let [angle, friction, torque] = *last(&outcome) else { panic!("three columns") };
            let what = format!("{bearing} and {brake} N m, {study}");
            close(&what, angle, 0.0, 1e-12);
            close(&what, friction + torque, 10.0, 1e-8);
            assert!(friction.abs() <= bearing + 1e-8 && torque.abs() <= brake + 1e-8, "{what}: {friction} and {torque}");
            assert!(outcome.findings.iter().any(|f| f.code == "friction-not-unique"), "{what}");
        }
    }
    // one that is not needed carries nothing
    let outcome = done(&braked(6.0, 6.0, "9.5 N m", statics), "rest");
    close("one is enough", last(&outcome)[1].abs().min(last(&outcome)[2].abs()), 0.0, 1e-12);
    // 9.9 N m are too little
    for study in [statics, "dynamics: { until: 1 s }"] {
        let outcome = done(&braked(5.0, 4.9, "0 N m", study), "rest");
        assert!(last(&outcome)[0] < -0.01, "{study}");
    }
}

/// A ladder whose ends slide on the floor and on the wall against constant friction F and H rests up to cos θ (W/2 − H) = F sin θ.
#[test]
fn the_region_of_a_ladder_is_that_of_both_frictions() {
    let text = |floor: f64, wall: f64| {
        format!(
            "grashof: 1
name: ladder
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ foot: {{ mass: 0 }}, head: {{ mass: 0 }}, ladder: {{ bar: {{ length: 4 m, mass: 20 kg }} }} }}
joints:
  F: {{ slider: [ground, foot.origin], axis: [1, 0], friction: {{ coulomb: {floor} N }} }}
  H: {{ slider: [ground, head.origin], axis: [0, 1], friction: {{ coulomb: {wall} N }} }}
  a: {{ revolute: [foot.origin, ladder.start] }}
  b: {{ revolute: [head.origin, ladder.end] }}
start: {{ F.position: -1.5 m, H.position: ~3.7 m, ladder.angle: ~68 deg }}
studies: {{ rest: {{ statics: {{ from: start }}, columns: [F.position, F.friction, H.friction] }} }}
"
        )
    };
    for (floor, wall) in [(60.0_f64, 0.001_f64), (60.0, 60.0), (25.0, 40.0), (200.0, 5.0)] {
        let outcome = done(&text(floor, wall), "rest");
        let tells = |f: &&grashof::results::Finding| f.code == "held-by-friction";
        let message = &outcome.findings.iter().find(tells).unwrap_or_else(|| panic!("{floor} and {wall}: no region")).message;
        let ends: Vec<f64> = message.split(" m").filter_map(|part| part.rsplit("= ").next()?.trim().parse().ok()).collect();
        assert!(ends.len() == 2, "{message}");
        close(&format!("{floor} and {wall}"), last(&outcome)[0], -1.5, 1e-9);
        assert!(last(&outcome)[1].abs() <= floor * (1.0 + 1e-8) && last(&outcome)[2].abs() <= wall * (1.0 + 1e-8));
        for x in ends {
            let angle = (x.abs() / 4.0).acos();
            close(&format!("{floor} and {wall}: {message}"), angle.cos() * (100.0 - wall), floor * angle.sin(), 1e-3);
        }
    }
}
