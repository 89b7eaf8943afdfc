//! Modes at the ends of what they are told of: in a kink of a law, without mass, and of damped motions fewer than there are.

use super::{codes, list};
use crate::common::study;
use grashof::Model;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

fn found(text: &str, name: &str) -> Outcome {
    study(text, name, Coordinates::Joint)
}

/// A mass that rests between a soft side (10 N/m, 1 N s/m) and a hard one (100 N/m, 3 N s/m), at the middle of a spring by a condition, a
/// table or a law of the speed.
fn between_sides(spring: &str, start: &str) -> String {
    format!(
        "grashof: 1
name: between a soft and a hard side
space: planar
gravity: none
tables: {{ kink: {{ points: [[-1 m, -100 N], [0 m, 0 N], [1 m, 10 N]], beyond: linear }} }}
bodies: {{ a: {{ mass: 1 kg }} }}
joints: {{ J: {{ slider: [ground, a.origin], axis: [1, 0] }} }}
springs: {{ s: {{ joint: J, {spring} }} }}
start: {{ J.position: {start} }}
studies:
  full: {{ modes: {{ at: start }} }}
  sparse: {{ modes: {{ at: start, methods: [lanczos] }} }}
  damped: {{ modes: {{ at: start, damped: true }} }}
  sparse_damped: {{ modes: {{ at: start, damped: true, methods: [lanczos] }} }}
  rest: {{ modes: {{ at: statics }} }}
  linear: {{ linearize: {{ at: start }} }}
"
    )
}

#[test]
fn a_pose_in_a_kink_has_the_modes_of_one_side_and_says_so() {
    let by_table = "force: kink";
    let by_condition = "force: \"if(stretch < 0 m, 100 N/m, 10 N/m)*stretch\"";
    let by_speed = "stiffness: 10 N/m } }\nloads: { d: { joint: J, force: \"-if(J.velocity < 0 m/s, 3 N s/m, 1 N s/m)*J.velocity\"";
    for (law, names, part) in [(by_table, "`kink(stretch)`", "90.00 %"), (by_condition, "`stretch < 0 m`", "90.00 %")] {
        for name in ["full", "sparse", "damped", "sparse_damped", "rest", "linear"] {
            let outcome = found(&between_sides(law, "0 m"), name);
            let told =
                outcome.findings.iter().find(|f| f.code == "one-sided").unwrap_or_else(|| panic!("{law}, {name}: {:?}", codes(&outcome)));
            assert!(told.message.contains(names) && told.message.contains(part), "{law}, {name}: {}", told.message);
        }
        for (side, name) in [("1 mm", "full"), ("-1 mm", "sparse"), ("1 mm", "linear")] {
            let outcome = found(&between_sides(law, side), name);
            assert!(!codes(&outcome).contains(&"one-sided"), "{law}, {side}, {name}");
        }
    }
    // a damper that differs counts where damping does
    for (name, is) in [("full", false), ("sparse", false), ("damped", true), ("linear", true)] {
        let outcome = found(&between_sides(by_speed, "0 m"), name);
        assert_eq!(codes(&outcome).contains(&"one-sided"), is, "{name}: {:?}", codes(&outcome));
    }
    // laws that go on alike have no kink, whatever changes in them
    let alike = found(&between_sides("force: \"if(stretch < 0 m, 10 N/m, 10 N/m)*stretch\"", "0 m"), "full");
    assert!(!codes(&alike).contains(&"one-sided"));
    // a force that jumps has no slope at all
    let jump = found(&between_sides("force: \"if(stretch < 0 m, -3 N, 10 N/m*stretch)\"", "0 m"), "full");
    let told = jump.findings.iter().find(|f| f.code == "one-sided").expect("a finding");
    assert!(told.message.contains("forces jump"), "{}", told.message);
}

/// A slotted frame moves the only mass, which another slot holds: what is left moves a lever without mass, and round-off of what is held.
#[test]
fn a_motion_that_passes_by_all_masses_is_refused() {
    let text = "grashof: 1
name: a lever without mass
space: planar
gravity: none
bodies:
  b0: { mass: 1, inertia: 1, points: { A: [0, 1] } }
  b1: { mass: 0, points: { A: [0, 1], S: [1, 0] } }
  b2: { mass: 0, points: { O: [1, 0], A: [1, 1] } }
joints:
  j0: { revolute: [ground, b0.origin] }
  j1: { revolute: [b0.A, b1.A] }
  j2: { revolute: [b0.origin, b2.O] }
  l0: { pin-in-slot: [b2.A, b1.origin], axis: [1, 0] }
  l1: { pin-in-slot: [ground, b0.A], axis: [0, 1] }
springs: { s1: { between: [b1.S, ground], length: 0.5, stiffness: 7 } }
start: { j2.angle: 0 }
studies:
  full: { modes: { at: start } }
  sparse: { modes: { at: start, methods: [lanczos] } }
  linear: { linearize: { at: start } }
";
    for name in ["full", "sparse", "linear"] {
        let failure = Model::parse(text).unwrap_or_else(|e| panic!("{e}")).study(name).unwrap().run().expect_err(name).to_string();
        assert!(failure.contains("moves no mass") || failure.contains("are not determined"), "{name}: {failure}");
    }
}

/// Two masses joined by a damped spring, free as a pair: μ = 0 twice and one pair; `lowest` counts the rows, of which there are up to twice
/// as many as coordinates.
#[test]
fn damped_modes_are_as_many_as_asked_for() {
    let text = |lowest: &str, methods: &str| {
        format!(
            "grashof: 1
name: free pair
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 1.3 kg }} }}
joints:
  A: {{ slider: [ground, a.origin], axis: [1, 0] }}
  B: {{ slider: [ground, b.origin], axis: [1, 0] }}
springs: {{ s: {{ stretch: b.x - a.x, stiffness: 100 N/m, damping: 3.3 N s/m }} }}
studies: {{ v: {{ modes: {{ at: start, damped: true{lowest}{methods} }} }} }}
"
        )
    };
    let reduced = 1.3 / 2.3;
    let decay: f64 = 0.5 * 3.3 / reduced;
    let rate = (100.0 / reduced - decay * decay).sqrt();
    for methods in ["", ", methods: [lanczos]"] {
        for (lowest, rows) in [("", 3), (", lowest: 3", 3), (", lowest: 8", 3), (", lowest: 2", 2), (", lowest: 1", 1)] {
            let outcome = found(&text(lowest, methods), "v");
            let [re, im] = ["eigenvalues_real", "eigenvalues_imaginary"].map(|name| list(&outcome, name).to_vec());
            assert_eq!(re.len(), rows, "{lowest}{methods}: {re:?}");
            assert!(re.iter().zip(&im).take(2).all(|(re, im)| (*re, *im) == (0.0, 0.0)), "{lowest}{methods}: {re:?} {im:?}");
            if rows == 3 {
                assert!((re[2] + decay).abs() < 1e-9 && (im[2] - rate).abs() < 1e-9, "{lowest}{methods}: {re:?} {im:?}");
            }
            assert_eq!(codes(&outcome).contains(&"lowest-modes"), rows < 3, "{lowest}{methods}: {:?}", codes(&outcome));
        }
    }
    // dampers to the ground slow the free motion down: one 0 for its place, and a decay
    for methods in ["", ", methods: [lanczos]"] {
        let slowed = text("", methods).replace("axis: [1, 0] }", "axis: [1, 0], damping: 0.1 N s/m }");
        let outcome = found(&slowed, "v");
        let re = list(&outcome, "eigenvalues_real");
        assert!(re.len() == 3 && re[0] == 0.0 && re[1] < -0.08 && re[1] > -0.09, "{methods}: {re:?}");
    }
}

/// The only eigenvalue is as large as the largest stiffness, and negative.
#[test]
fn one_unstable_spring_is_found_by_all_methods() {
    for stiffness in [3022.4011303203797, 1.0, 7e-5] {
        let text = format!(
            "grashof: 1
name: a spring that pushes away
space: planar
gravity: none
bodies: {{ b: {{ mass: 8.702149772957844 kg }} }}
joints: {{ J: {{ slider: [ground, b.origin], axis: [1, 0] }} }}
springs: {{ s: {{ joint: J, stiffness: -{stiffness} N/m }} }}
studies: {{ v: {{ modes: {{ at: start, methods: [library, jacobi, power, lanczos] }} }}, few: {{ modes: {{ at: start, methods: [lanczos] }} }} }}
"
        );
        for name in ["v", "few"] {
            let outcome = found(&text, name);
            let value = list(&outcome, "eigenvalues")[0];
            assert!((value + stiffness / 8.702149772957844).abs() < 1e-12 * stiffness, "{name}: {value}");
            assert_eq!(codes(&outcome), ["unstable"], "{name}");
        }
    }
}

/// Loads that balance each other but for round-off leave a pose in balance, at rest and in a search for rest.
#[test]
fn loads_that_balance_each_other_leave_nothing_unbalanced() {
    let slide = "space: planar
gravity: none
bodies: { b: { mass: 1 kg } }
joints: { S: { slider: [ground, b.origin], axis: [1, 0] } }
loads: { f1: { joint: S, force: 0.1 N }, f2: { joint: S, force: 0.2 N }, f3: { joint: S, force: -0.3 N } }
";
    let free = "space: planar
gravity: [6.993781928872858, -1.1819149746972415]
bodies: { b0: { mass: 0.391125431950041, inertia: 0.26067460983330515, points: { P2: [1, 0], P3: [0, 1] } } }
loads:
  f0: { at: b0.origin, force: [-1.356397000589312, 0.27335794071404507] }
  f1: { at: b0.P2, force: [-0.8684228972204657, -0.5724129797902562] }
  f2: { at: b0.P3, force: [-0.5106260800850104, 0.7613320440828915] }
start: { b0.angle: 0.523304350415581 }
";
    for model in [slide, free] {
        let text = format!(
            "grashof: 1\nname: in balance\n{model}studies: {{ v: {{ modes: {{ at: start }} }}, s: {{ statics: {{ from: start }} }} }}\n"
        );
        let outcome = found(&text, "v");
        assert!(!codes(&outcome).contains(&"unbalanced"), "{:?}", outcome.findings);
        found(&text, "s");
    }
}
