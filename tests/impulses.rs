//! Impulses of drivers: at blows, where the law of one has a kink; and what a mechanism does where its driver turns round.

use crate::common::{close, model, study};
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;
use std::f64::consts::TAU;

fn codes(outcome: &Outcome) -> Vec<&str> {
    outcome.findings.iter().map(|f| &*f.code).collect()
}

/// A carriage that is driven, and a mass that slides on it between stops.
fn carriage(driver: &str, limits: &str, start: &str) -> String {
    format!(
        "grashof: 1
name: carriage
space: planar
gravity: none
tables: {{ lift: {{ points: [[0 s, 0 m], [1 s, 0 m], [2 s, 1 m], [3 s, 1 m]] }} }}
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 2 kg }} }}
joints:
  A: {{ slider: [ground, a.origin], axis: [1, 0] }}
  B: {{ slider: [a.origin, b.origin], axis: [1, 0]{limits} }}
drivers: {{ d: {{ joint: A, {driver} }} }}
start: {{ {start} }}
studies:
  s:
    dynamics: {{ until: 0.2 s, every: 0.05 s, tolerance: 1e-10 }}
    columns: [b.x]
    scalars: {{ drivers: work_drivers, stops: work_stops, gain: \"last(energy.total) - value(energy.total, 0 s)\" }}
  long:
    dynamics: {{ until: 3 s, every: 0.25 s, tolerance: 1e-10 }}
    columns: [b.x]
    scalars: {{ drivers: work_drivers, stops: work_stops, gain: \"last(energy.total) - value(energy.total, 0 s)\" }}
"
    )
}

#[test]
fn a_driven_carriage_picks_up_a_mass_at_rest() {
    // 2 kg come to 1 m/s: the driver's impulse does 2 J, of which the plastic blow takes 1 J
    let text =
        carriage("speed: 1 m/s", ", limits: { from: -5 cm, restitution: 0 }", "A.position: 0 m, B.position: 0 m, B.velocity: -1 m/s");
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        close("J", &study(&text, "s", coordinates).scalars, &[2.0, -1.0, 1.0], 1e-8);
    }
}

#[test]
fn a_stop_on_a_driven_joint_only_takes_energy() {
    let text = carriage(
        "position: \"10 cm*sin(6 rad/s*t)\"",
        ", limits: { from: -5 cm, to: 5 cm, restitution: 0.4 }",
        "B.position: 0 m, B.velocity: -0.6 m/s",
    );
    let outcome = study(&text, "long", Coordinates::Joint);
    let [drivers, stops, gain] = outcome.scalars[..] else { panic!("{:?}", outcome.scalars) };
    // an independent integration between the blows, each with its own balance of impulses
    close("J", &[drivers, stops], &[3.5266, -3.4417], 1e-4);
    close("gain", &[drivers + stops], &[gain], 1e-8);
}

#[test]
fn a_kink_in_the_law_of_a_driver_is_its_own_work() {
    let text = carriage("position: lift(t)", "", "B.position: 0 m, B.velocity: 0 m/s").replace("until: 3 s", "until: 1.5 s");
    let outcome = study(&text, "long", Coordinates::Joint);
    // 1 kg is set to 1 m/s, the other one stays where it is
    close("J", &outcome.scalars, &[0.5, 0.0, 0.5], 1e-8);
}

#[test]
fn a_step_that_ends_where_a_law_has_its_kink_crosses_it() {
    // at rest until half a second, to which steps of a tenth lead exactly
    let text = "grashof: 1
name: shaken
space: planar
gravity: [0, -9.81 m/s^2]
tables: { lift: { points: [[0 s, 0 m], [0.5 s, 0 m], [1 s, 0.5 m], [2 s, 0.5 m]] } }
bodies: { a: { mass: 1 kg }, p: { bar: { length: 1 m, mass: 1 kg } } }
joints: { A: { slider: [ground, a.origin], axis: [1, 0] }, P: { revolute: [a.origin, p.start] } }
drivers: { d: { joint: A, position: lift(t) } }
start: { P.angle: -90 deg, P.omega: 0 rad/s }
studies: { s: { dynamics: { until: 2 s, tolerance: 1e-10 }, columns: [P.angle], scalars: { kicked: \"value(P.omega, 0.500000001 s)\" } } }
";
    // the hinge comes to 1 m/s above a bar at rest, which stays behind: ω = −v (l/2)/(l²/3)
    for integrator in ["", ", integrator: radau5"] {
        let text = text.replace("1e-10 }", &format!("1e-10{integrator} }}"));
        close("ω", &study(&text, "s", Coordinates::Joint).scalars, &[-1.5], 1e-6);
    }
}

#[test]
fn velocities_that_jump_in_a_driven_motion_are_told() {
    let text = "grashof: 1
name: kink
space: planar
gravity: none
tables: { lift: { points: [[0 s, 0 m], [1 s, 0 m], [2 s, 1 m], [3 s, 1 m]] }, smooth: { points: [[0 s, 0 m], [1 s, 0 m], [2 s, 1 m]], between: cubic } }
bodies: { a: { mass: 2 kg } }
joints: { A: { slider: [ground, a.origin], axis: [1, 0] } }
drivers: { d: { joint: A, position: LAW(t) } }
studies: { s: { inverse: { over: 1.5 s, samples: 3 }, columns: [d.force] } }
";
    let kinked = study(&text.replace("LAW", "lift"), "s", Coordinates::Joint);
    assert_eq!(codes(&kinked), ["velocity-jump"]);
    assert!(kinked.findings[0].message.starts_with("velocities jump at time = 1 s: "), "{}", kinked.findings[0].message);
    assert_eq!(codes(&study(&text.replace("LAW", "smooth"), "s", Coordinates::Joint)), [""; 0]);
}

#[test]
fn a_negative_range_is_told_to_go_back_in_time() {
    let text = |over: &str| {
        format!(
            "grashof: 1\nname: bar\nspace: planar\ngravity: none\nbodies: {{ a: {{ bar: {{ length: 20 cm, mass: 1 kg }} }} }}\njoints: {{ O: {{ revolute: [ground, a.start] }} }}\ndrivers: {{ d: {{ joint: O, speed: -60 rpm }} }}\nstudies: {{ s: {{ kinematics: {{ over: {over}, samples: 2 }}, columns: [O.angle] }} }}\n"
        )
    };
    assert_eq!(codes(&study(&text("90 deg"), "s", Coordinates::Joint)), [""; 0]);
    let back = study(&text("-90 deg"), "s", Coordinates::Joint);
    assert_eq!(codes(&back), ["backwards"]);
    assert!(back.findings[0].message.contains("to O.angle = 90 deg;"), "{}", back.findings[0].message);
}

#[test]
fn the_slope_of_an_equivalent_inertia_is_blank_where_the_driver_turns_round() {
    let text = "grashof: 1
name: yoke
space: planar
gravity: none
bodies: { crank: { bar: { length: 10 cm, mass: 1 kg } }, ram: { mass: 2 kg } }
joints:
  O: { revolute: [ground, crank.start] }
  yoke: { pin-in-slot: [ram.origin, crank.end], axis: [0, 1] }
  W: { slider: [ground, ram.origin], axis: [1, 0] }
drivers: { drive: { joint: O, angle: 1 rad*sin(2*pi*t/1 s) } }
studies: { s: { inverse: { over: 1 s, samples: 4 }, columns: [O.angle, inertia_eq, inertia_eq_slope], scalars: { most: max(inertia_eq_slope) } } }
";
    let outcome = study(text, "s", Coordinates::Joint);
    for row in &outcome.rows {
        let (angle, slope) = (row[0], row[2]);
        // 2 m r² sin θ cos θ
        let right = 2.0 * 2.0 * 0.01 * angle.sin() * angle.cos();
        assert!(slope.is_nan() || (slope - right).abs() < 1e-6, "{angle}: {slope} for {right}");
    }
    assert!(outcome.rows.iter().any(|row| row[2].is_nan()), "the driver turns round at a quarter of {TAU}");
    close("most", &outcome.scalars, &[0.02], 1e-6);
}

#[test]
fn a_law_that_jumps_is_no_dead_point() {
    let text = "grashof: 1
name: jump
space: planar
gravity: none
bodies: { a: { mass: 2 kg } }
joints: { A: { slider: [ground, a.origin], axis: [1, 0] } }
drivers: { d: { joint: A, position: \"if(t < 1 s, 0 m, 5 cm)\" } }
studies: { s: { inverse: { over: 1.5 s, samples: 3 }, columns: [d.force] } }
";
    let model = model(text, Some("s"));
    let study = model.study.clone().unwrap();
    let case = grashof::studies::common::case::Case::new(&model, &study, &[]);
    let stopped = grashof::studies::run::run(case, &|| false).unwrap().stopped.unwrap();
    assert!(stopped.contains("the law of the driver `d` jumps at time = 1 s, from 0 to 0.05 (SI)"), "{stopped}");
}

#[test]
fn what_carries_a_drive_keeps_its_momentum_over_a_kink_of_the_law() {
    // 2 kg on the ground carry 1 kg, whose way on them turns round; nothing acts from outside
    let text = |dynamics: &str| {
        format!(
            "grashof: 1
name: turned back
space: planar
gravity: none
tables: {{ law: {{ points: [[0 s, 0 m], [0.5 s, 0.1 m], [1 s, -0.1 m]] }} }}
bodies: {{ a: {{ mass: 2 kg }}, b: {{ mass: 1 kg }} }}
joints:
  A: {{ slider: [ground, a.origin], axis: [1, 0] }}
  B: {{ slider: [a.origin, b.origin], axis: [1, 0] }}
drivers: {{ d: {{ joint: B, position: law(t) }} }}
start: {{ A.position: 0 m, A.velocity: 0.3 m/s }}
studies: {{ s: {{ dynamics: {{ until: 1 s, every: 0.1 s, {dynamics} }}, columns: [A.position, A.velocity, momentum.x] }} }}
"
        )
    };
    for coordinates in ["joint", "cartesian", "minimal"] {
        for scheme in ["tolerance: 1e-9", "integrator: radau5, tolerance: 1e-9", "integrator: rk4, step: 10 ms"] {
            let outcome = study(&text(&format!("coordinates: {coordinates}, {scheme}")), "s", Coordinates::Joint);
            // p = 3 v + q̇: at 0.5 s the rate q̇ jumps by −0.6 m/s, and v by 0.2 m/s
            let last = outcome.rows.last().expect("a row");
            close(&format!("{coordinates}, {scheme}"), &last[last.len() - 3..], &[0.15 + 0.25, 0.5, 1.1], 1e-9);
            assert_eq!(codes(&outcome), ["velocity-jump"], "{coordinates}, {scheme}");
        }
    }
}

#[test]
fn a_spring_over_what_moves_with_time_does_the_work_of_a_driver() {
    // of one mass on a spring whose other end goes to and fro: ∫ F ds of that end is what the energy gains
    let text = "grashof: 1
name: shaken
space: planar
gravity: none
bodies: { b: { mass: 1 kg } }
joints: { S: { slider: [ground, b.origin], axis: [1, 0] } }
springs: { k: { stretch: \"b.x + 0.1 m*sin(4 rad/s*t)\", stiffness: 10 N/m } }
studies:
  s:
    dynamics: { until: 0.6 s, every: 10 ms, tolerance: 1e-10 }
    columns: [time, b.x]
    scalars: { drivers: work_drivers, gain: \"last(energy.total) - value(energy.total, 0 s)\" }
";
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        let outcome = study(text, "s", coordinates);
        let [drivers, gain] = outcome.scalars[..] else { panic!("{:?}", outcome.scalars) };
        assert!(gain > 0.03 && (drivers - gain).abs() < 1e-9, "{drivers} {gain}");
        assert!(outcome.findings.is_empty(), "{:?}", outcome.findings);
    }
}
