//! What is met at one instant in a period: stops and switches whose order does not count, and such whose order does.

use super::faults::told;
use super::{multipliers, near, regime, same_multipliers};
use grashof::studies::common::outcome::Outcome;

/// A mass on a spring, driven by a force of period 2 s.
const JOINT: &str = "damping: 0.4 N s/m";

/// Its stop.
const STOP: &str = ", limits: { to: 20 cm, restitution: 0.7 }";

/// Masses side by side, each on a spring of its own, by what else its joint has and the time (s) by which its force is late; further loads.
fn masses(all: &[(&str, f64)], loads: &str) -> String {
    let lines = |line: &dyn Fn(usize, &str, f64) -> String| {
        all.iter().enumerate().map(|(i, (joint, late))| line(i, joint, *late)).collect::<Vec<_>>().join("\n")
    };
    format!(
        "grashof: 1
name: masses side by side
space: planar
gravity: none
bodies:
{}
joints:
{}
springs:
{}
loads:
{}
{loads}
start:
{}
studies:
  regime: {{ periodic: {{ over: t, by: 2 s, of: S0.velocity }}, columns: [S0.position] }}
",
        lines(&|i, _, _| format!("  m{i}: {{ mass: 1 kg }}")),
        lines(&|i, joint, _| format!("  S{i}: {{ slider: [ground, m{i}.origin], axis: [1, 0], {JOINT}{joint} }}")),
        lines(&|i, _, _| format!("  spring{i}: {{ joint: S{i}, stiffness: 30 N/m }}")),
        lines(&|i, _, late| format!("  push{i}: {{ joint: S{i}, force: 12 N*cos(pi*1 rad/s*(t - {late:?} s)) }}")),
        lines(&|i, _, _| format!("  S{i}.position: 0.1 m\n  S{i}.velocity: 0 m/s")),
    )
}

/// A force of 3 N on a mass under a condition.
fn relay(i: usize, condition: &str) -> String {
    format!("  relay{i}: {{ joint: S{i}, force: \"if({condition}, 3 N, 0)\" }}\n")
}

/// The multipliers of a text are those of other ones, all together.
fn all_of(text: &str, parts: [&Outcome; 2]) {
    let mut matrix = nalgebra::DMatrix::zeros(4, 4);
    for (k, part) in parts.into_iter().enumerate() {
        let [a, b] = multipliers(part)[..] else { panic!("{:?}", multipliers(part)) };
        // real ones, or a pair
        let block = if a[1] == 0.0 { [a[0], 0.0, 0.0, b[0]] } else { [a[0], a[1], -a[1], a[0]] };
        matrix.view_mut((2 * k, 2 * k), (2, 2)).copy_from(&nalgebra::DMatrix::from_row_slice(2, 2, &block));
    }
    same_multipliers(&regime(text), &matrix, 1e-7);
}

/// The multipliers of a text are those of another one, each twice.
fn twice(text: &str, one: &str) {
    let one = regime(one);
    all_of(text, [&one, &one]);
}

#[test]
fn two_masses_that_strike_at_one_instant_are_two_times_one() {
    for rest in ["", ", friction: { coulomb: 1 N }"] {
        let stop = format!("{STOP}{rest}");
        twice(&masses(&[(stop.as_str(), 0.0); 2], ""), &masses(&[(stop.as_str(), 0.0)], ""));
    }
}

#[test]
fn two_forces_that_jump_at_one_instant_are_two_times_one() {
    let relays = [0, 1].map(|i| relay(i, &format!("S{i}.position > 0.15 m")));
    twice(&masses(&[("", 0.0); 2], &relays.concat()), &masses(&[("", 0.0)], &relays[0]));
}

#[test]
fn a_force_that_waits_for_the_last_of_two_has_an_order() {
    let relays = [0, 1].map(|i| relay(i, "S0.position > 0.15 m and S1.position > 0.15 m"));
    let words = ["at one instant", "S0.position", "S1.position", "no derivative", "smooth the switches"];
    told(&masses(&[("", 0.0); 2], &relays.concat()), true, &words);
}

/// A mass that strikes at the instant at which a force begins to act on another one; the force of that one is late by so much.
#[test]
fn a_stop_and_a_switch_at_one_instant() {
    let [stop, switch] = [masses(&[(STOP, 0.0)], ""), masses(&[("", 0.0)], &relay(0, "S0.position > 0.15 m"))];
    let [struck, switched] = [&stop, &switch].map(|text| regime(text));
    // the first time at which each is where it strikes or switches, upwards
    let when = |found: &Outcome, at: f64| {
        let of = |i: &&usize| (found.rows[**i][0] - at).abs() < 1e-9 && found.rows[**i - 1][0] < at - 1e-6;
        found.places[*found.switches.iter().find(of).expect("a switch")]
    };
    let late = when(&struck, 0.2) - when(&switched, 0.15);
    let both = |condition: &str| masses(&[(STOP, 0.0), ("", late)], &relay(1, condition));
    all_of(&both("S1.position > 0.15 m"), [&struck, &switched]);
    // a force that waits for the blow
    let words = ["at one instant", "`S1.position > 0.15 m`", "upper stop of joint `S0`", "no derivative"];
    told(&both("S1.position > 0.15 m and (S0.velocity < 0 or S0.position < 0.19 m)"), true, &words);
}

/// A plate of 2 kg that is driven against two stops at its ends, 1 m apart, as are springs and forces, by the radius of inertia in parts
/// of half a metre; `guide` holds its middle.
fn plate(radius: f64, guide: &str) -> String {
    format!(
        "grashof: 1
name: plate on two stops
space: planar
gravity: none
bodies:
  p: {{ mass: 2 kg, inertia: {:?} kg m^2, points: {{ L: [-0.5 m, 0], R: [0.5 m, 0] }} }}
  l: {{ mass: 0 kg }}
  r: {{ mass: 0 kg }}
ground: {{ L: [-0.5 m, 0], R: [0.5 m, 0] }}
joints:
  X: {{ {guide}: [ground, p.origin], axis: [0, 1] }}
  GL: {{ slider: [ground.L, l.origin], axis: [0, 1], {JOINT}, limits: {{ to: 20 cm, restitution: 0.7 }} }}
  GR: {{ slider: [ground.R, r.origin], axis: [0, 1], {JOINT}, limits: {{ to: 20 cm, restitution: 0.7 }} }}
  SL: {{ pin-in-slot: [p.L, l.origin], axis: [1, 0] }}
  SR: {{ pin-in-slot: [p.R, r.origin], axis: [1, 0] }}
springs: {{ l_spring: {{ joint: GL, stiffness: 30 N/m }}, r_spring: {{ joint: GR, stiffness: 30 N/m }} }}
loads:
  l_push: {{ joint: GL, force: 12 N*cos(pi*1 rad/s*t) }}
  r_push: {{ joint: GR, force: 12 N*cos(pi*1 rad/s*t) }}
start: {{ p.y: 0.1 m, p.vy: 0 m/s }}
studies:
  regime: {{ periodic: {{ over: t, by: 2 s, of: p.vy }}, columns: [p.y] }}
",
        2.0 * (0.5 * radius) * (0.5 * radius)
    )
}

#[test]
fn a_plate_whose_ends_know_nothing_of_each_other() {
    // a blow at one end leaves the other one alone where the radius of inertia is half the way between them
    twice(&plate(1.0, "pin-in-slot"), &masses(&[(STOP, 0.0)], ""));
}

#[test]
fn a_plate_whose_ends_throw_each_other_has_an_order() {
    for radius in [0.6, 1.2] {
        let words = ["are met at one instant", "joint `GL`", "joint `GR`", "no derivative", "`stiffness` instead of a `restitution`"];
        told(&plate(radius, "pin-in-slot"), true, &words);
    }
}

#[test]
fn a_plate_that_cannot_turn_meets_both_stops_as_one() {
    let [plate, mass] = [plate(0.6, "slider"), masses(&[(STOP, 0.0)], "")].map(|text| regime(&text));
    near("floquet", plate.results[super::FLOQUET], mass.results[super::FLOQUET], 1e-7);
}
