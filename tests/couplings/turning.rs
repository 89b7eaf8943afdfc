//! Hinges off the tree that turn far in a step: their turns are counted, or the run says that it cannot.

use crate::common::{close, study};
use crate::reference::program::run_text;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

/// The first column.
fn first(outcome: &Outcome) -> Vec<f64> {
    (0..outcome.rows.len()).map(|row| outcome.rows[row][0]).collect()
}

/// Two discs beside each other in space, the second on a joint off the tree, of which the first turns at a constant rate.
fn discs(joint: &str, more: &str, dynamics: &str) -> String {
    format!(
        "grashof: 1
name: discs
space: spatial
gravity: none
ground: {{ B: [1 m, 0, 0] }}
bodies:
  a: {{ disc: {{ radius: 10 cm, mass: 2 kg, thickness: 1 cm }} }}
  b: {{ disc: {{ radius: 10 cm, mass: 2 kg, thickness: 1 cm }} }}
joints:
  A: {{ revolute: [ground, a.origin] }}
  B: {{ {joint}: [ground.B, b.origin], cut: true }}
{more}
studies: {{ run: {{ dynamics: {{ until: 3 s, every: 0.1 s{dynamics} }}, columns: [A.angle, a.qz] }} }}
"
    )
}

#[test]
fn gears_on_hinges_off_the_tree_turn_on_at_a_constant_rate() {
    let start = "start: { A.angle: 0 rad, A.omega: 100 rad/s }";
    for (joint, gear) in [
        ("revolute", "couplings: { g: { gear: [A, B], ratio: -1 } }"),
        ("revolute", "couplings: { g: { gear: [A, B], ratio: 2.5 } }"),
        ("cylindrical", "couplings: { g: { zero: A.angle + B.angle }, h: { zero: B.position } }"),
        ("universal", "couplings: { g: { zero: A.angle - B.angle1 }, h: { zero: B.angle2 } }"),
    ] {
        let axes = if joint == "universal" { ", axes: [[0, 0, 1], [1, 0, 0]]" } else { "" };
        for dynamics in
            ["", ", tolerance: 1e-5", ", integrator: radau5", ", integrator: bdf", ", step: 4 ms, integrator: generalized-alpha"]
        {
            for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
                let text = discs(joint, &format!("{gear}\n{start}"), dynamics).replace("b.origin], cut", &format!("b.origin]{axes}, cut"));
                let outcome = study(&text, "run", coordinates);
                let right: Vec<f64> = outcome.places.iter().map(|t| 100.0 * t).collect();
                assert_eq!(right.len(), 31);
                close(&format!("{joint} {dynamics} {coordinates:?}"), &first(&outcome), &right, 2e-6);
            }
        }
    }
}

#[test]
fn a_force_by_the_angle_of_a_hinge_off_the_tree_is_smooth_over_many_turns() {
    // a weak spring of many turns against a fast disc: θ = Ω/ω sin ωt with ω² = k/I
    let more = "springs: { s: { joint: B, stiffness: 0.01 N m/rad } }\nstart: { A.omega: 0 rad/s, B.angle: 0 rad, b.wz: 100 rad/s }";
    for tolerance in ["1e-5", "1e-8", "1e-10"] {
        let text = discs("revolute", more, &format!(", tolerance: {tolerance}")).replace("[A.angle, a.qz]", "[B.angle]");
        let outcome = study(&text, "run", Coordinates::Joint);
        let omega = f64::sqrt(0.01 / 0.01);
        let right: Vec<f64> = outcome.places.iter().map(|t| 100.0 / omega * (omega * t).sin()).collect();
        close(tolerance, &first(&outcome), &right, 1e-6);
    }
}

#[test]
fn a_fixed_step_over_most_of_a_turn_is_refused() {
    let more = "couplings: { g: { gear: [A, B], ratio: -1 } }\nstart: { A.angle: 0 rad, A.omega: 100 rad/s }";
    let run = run_text(&discs("revolute", more, ", step: 50 ms, integrator: rk4"), &["--no-plots", "--no-report"]);
    assert_eq!(run.code, 3, "{}", run.stderr);
    assert!(run.stderr.contains("joint `B` turns by more than a fifth of a turn"), "{}", run.stderr);
    assert!(run.stderr.contains("its turns cannot be counted: give a shorter `step`"), "{}", run.stderr);
}
