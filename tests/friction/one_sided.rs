//! What holds one way only, one-way clutches and rigid stops, in studies that know nothing of it: it is told, never passed in silence.

use super::{close, done, tried};
use crate::reference::program::run_text;

/// A bar of 1 m on a hinge, with more of the file.
fn bar(joint: &str, more: &str) -> String {
    format!(
        "grashof: 1
name: bar
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ a: {{ bar: {{ length: 1 m, mass: 2 kg }} }} }}
joints: {{ A: {{ revolute: [ground, a.start]{joint} }} }}
{more}"
    )
}

const BACKSTOP: &str = "clutches: { back: { joint: A, one_way: true } }\n";

/// A bar of 1 m above its hinge, on a one-way clutch to a shaft that something else holds.
fn on_a_shaft(angle: &str, more: &str, study: &str) -> String {
    format!(
        "grashof: 1
name: bar on a shaft
space: planar
gravity: [0, -10 m/s^2]
bodies: {{ a: {{ bar: {{ length: 1 m, mass: 2 kg }} }}, z: {{ mass: 1 kg, inertia: 1 kg m^2 }} }}
joints: {{ Z: {{ revolute: [ground, z.origin] }}, A: {{ revolute: [ground, a.start] }} }}
clutches: {{ back: {{ between: [Z, A], one_way: true }} }}
start: {{ A.angle: {angle} }}
{more}
{study}"
    )
}

/// Above its hinge at 60° a bar falls to the right, against the clutch, which holds it; at 120° it falls to the left, as the clutch lets it.
/// The other side of the clutch is the ground, a shaft that is driven at rest, or one on a spring, which gives way.
#[test]
fn statics_does_not_turn_against_a_one_way_clutch() {
    let study = "studies: { rest: { statics: { from: start }, scalars: { at: last(A.angle), holds: last(back.torque) } } }\n";
    let ground = |angle: &str| bar("", &format!("{BACKSTOP}start: {{ A.angle: {angle} }}\n{study}"));
    let shaft = |angle: &str| on_a_shaft(angle, "drivers: { hold: { joint: Z, angle: 0 deg } }", study);
    let scalars = |text: &str| done(text, "rest").scalars.clone();
    for text in [&ground as &dyn Fn(&str) -> String, &shaft] {
        let held = scalars(&text("60 deg"));
        close("held", held[0], 60.0_f64.to_radians(), 1e-12);
        close("holds", held[1], 2.0 * 10.0 * 0.5 * 0.5, 1e-9);
        close("free", scalars(&text("120 deg"))[0], 270.0_f64.to_radians(), 1e-6);
    }
    let sprung = run_text(&on_a_shaft("60 deg", "springs: { k: { joint: Z, stiffness: 100 N m/rad } }", study), &["--no-plots"]);
    assert_eq!(sprung.code, 3, "{}{}", sprung.stdout, sprung.stderr);
    assert!(sprung.stderr.contains("held on its way by") && sprung.stderr.contains("`back`"), "{}", sprung.stderr);
}

/// A wheel that is shaken drives another one over a one-way clutch.
#[test]
fn a_regime_tells_that_a_one_way_clutch_holds_for_a_part_of_the_period() {
    let text = "grashof: 1
name: shaken
space: planar
gravity: none
ground: { A: [0, 0], B: [1 m, 0] }
bodies: { a: { mass: 1 kg, inertia: 1 kg m^2 }, b: { mass: 1 kg, inertia: 1 kg m^2 } }
joints:
  A: { revolute: [ground.A, a.origin], damping: 0.2 N m s/rad }
  B: { revolute: [ground.B, b.origin], damping: 0.5 N m s/rad }
springs: { k: { joint: A, stiffness: 30 N m/rad } }
clutches: { ow: { between: [A, B], one_way: true } }
loads: { shake: { joint: A, torque: 20 N m*sin(4 rad/s*t) } }
studies: { lap: { periodic: { over: t, by: 1 turn/(4 rad/s), of: A.angle }, columns: [A.angle, B.omega] } }
";
    let failed = run_text(text, &["--no-plots"]);
    assert_eq!(failed.code, 3, "{}", failed.stdout);
    let told = &failed.stderr;
    assert!(told.contains("a joint is held by a one-way clutch in a part of the period") && !told.contains("rigid stop"), "{told}");
}

/// The law 30°·sin 2t turns back at t = π/4.
#[test]
fn a_driven_motion_ends_where_it_turns_back_against_a_one_way_clutch() {
    for kind in ["kinematics", "inverse"] {
        let more = format!(
            "{BACKSTOP}drivers: {{ d: {{ joint: A, angle: \"30 deg*sin(2 rad/s*t)\" }} }}
studies: {{ run: {{ {kind}: {{ over: 3 s, samples: 6 }}, columns: [A.angle], scalars: {{ most: max(A.angle) }} }} }}
"
        );
        let outcome = tried(&bar("", &more), "run").unwrap();
        let stopped = outcome.stopped.as_deref().unwrap_or_default();
        assert!(stopped.contains("turn back against") && stopped.contains("`back`"), "{stopped}");
        let last = outcome.places.last().copied().unwrap();
        assert!((last - std::f64::consts::FRAC_PI_4).abs() < 1e-7, "{kind}: {last}");
        assert!((outcome.scalars[0] - 30.0_f64.to_radians()).abs() < 1e-12);
    }
    // forwards there is nothing to tell
    let more = format!(
        "{BACKSTOP}drivers: {{ d: {{ joint: A, speed: 1 rad/s }} }}\nstudies: {{ run: {{ inverse: {{ over: 1 turn, samples: 4 }}, columns: [d] }} }}\n"
    );
    let outcome = tried(&bar("", &more), "run").unwrap();
    assert!(outcome.stopped.is_none() && outcome.findings.is_empty(), "{:?} {:?}", outcome.stopped, outcome.findings);
}

#[test]
fn small_deviations_tell_what_they_take_as_free() {
    let studies = "studies:\n  m: { modes: { at: start } }\n  l: { linearize: {} }\n";
    let told = |text: &str, study: &str| -> Vec<String> {
        let outcome = tried(text, study).unwrap();
        outcome.findings.iter().filter(|f| f.code == "taken-as-free").map(|f| f.message.clone()).collect()
    };
    for study in ["m", "l"] {
        // hanging, on its lower stop, and away from it
        for (from, stands) in [("-90 deg", true), ("-91 deg", false)] {
            let joint = format!(", limits: {{ from: {from}, restitution: 0 }}");
            let found = told(&bar(&joint, &format!("start: {{ A.angle: -90 deg }}\n{studies}")), study);
            assert_eq!(found.len(), usize::from(stands), "{study} at {from}: {found:?}");
            assert!(found.iter().all(|message| message.contains("joint `A` stands on its lower")), "{found:?}");
        }
        let found = told(&bar("", &format!("{BACKSTOP}start: {{ A.angle: -90 deg }}\n{studies}")), study);
        assert!(found.len() == 1 && found[0].contains("`back`") && found[0].contains("taken as open"), "{found:?}");
    }
    // one that runs free is open
    let runs = bar("", &format!("{BACKSTOP}start: {{ A.angle: -90 deg, A.omega: 1 rad/s }}\n{studies}"));
    assert_eq!(told(&runs, "l"), Vec::<String>::new());
}
