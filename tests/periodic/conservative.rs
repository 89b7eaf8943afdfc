//! Motions that keep their energy: one of a family each, with the period of its amplitude.

use super::{MAX, MIN, PERIOD, multipliers, near, regime, told};
use std::f64::consts::{FRAC_PI_3, PI, TAU};

/// A mass of 1 kg on a spring of 1 N/m, drawn by 10 cm.
fn spring(periodic: &str) -> String {
    format!(
        "grashof: 1
name: spring and mass
space: planar
gravity: none
bodies: {{ mass: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, mass.origin], axis: [1, 0] }} }}
springs: {{ spring: {{ joint: S, stiffness: 1 N/m }} }}
start: {{ S.position: 0.1 m, S.velocity: 0 m/s }}
studies:
  regime: {{ periodic: {{ {periodic}, of: S.position }} }}
"
    )
}

/// A bar that hangs from its end, 60 degrees aside or turned at a speed.
fn bar(omega: f64, periodic: &str) -> String {
    format!(
        "grashof: 1
name: bar
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ bar: {{ bar: {{ length: 1 m, mass: 1 kg }} }} }}
joints: {{ O: {{ revolute: [ground, bar.start] }} }}
start: {{ O.angle: -30 deg, O.omega: {omega} rad/s }}
studies:
  regime: {{ periodic: {{ {periodic} }} }}
"
    )
}

/// ω² of small swings of the bar, 1/s²: 3 g/(2 l).
const SMALL: f64 = 1.5 * 9.81;

/// The period of a pendulum with an amplitude: 2π/ω over the arithmetic-geometric mean of 1 and cos(amplitude/2).
fn swing(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, (0.5 * amplitude).cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    TAU / SMALL.sqrt() / a
}

#[test]
fn a_spring_and_a_mass_swing_with_the_amplitude_of_the_start() {
    // by where it comes through, and by its own period, with which all of its motions are periodic
    for periodic in ["over: t, through: S.position".to_owned(), format!("over: t, by: {TAU} s")] {
        let found = regime(&spring(&periodic));
        near("period", found.results[PERIOD], TAU, 1e-9);
        near("amplitude", found.results[MAX], 0.1, 1e-10);
        near("amplitude", found.results[MIN], -0.1, 1e-10);
        told(&found, "family-of-motions");
        assert!(!found.findings.iter().any(|f| f.message.contains("stable regime")), "{:?}", found.findings);
    }
}

#[test]
fn a_pendulum_has_the_period_of_its_amplitude() {
    let found = regime(&bar(0.0, "over: t, through: O.angle + 90 deg, of: O.angle"));
    near("period", found.results[PERIOD], swing(FRAC_PI_3), 1e-9);
    near("amplitude", found.results[MAX] + 0.5 * PI, FRAC_PI_3, 1e-9);
    told(&found, "family-of-motions");
    let [multiplier] = multipliers(&found)[..] else { panic!("one multiplier across the motion") };
    near("multiplier", multiplier[0], 1.0, 1e-8);
}

#[test]
fn a_period_that_is_asked_for_has_its_amplitude() {
    let found = regime(&bar(0.0, "over: t, by: 1.7 s, of: O.angle, settle: 0 s"));
    near("period", swing(found.results[MAX] + 0.5 * PI), 1.7, 1e-9);
    told(&found, "family-of-motions");
}

/// A torque that depends on the angle gives nothing in a turn, whatever the speed.
#[test]
fn a_wheel_under_a_torque_of_its_angle_has_a_regime_for_every_speed() {
    let text = "grashof: 1
name: wheel
space: planar
gravity: none
bodies: { wheel: { mass: 1 kg, inertia: 0.1 kg m^2 } }
joints: { O: { revolute: [ground, wheel.origin] } }
loads: { push: { joint: O, torque: 1 N m*sin(O.angle) } }
start: { O.angle: 0 deg, O.omega: 20 rad/s }
studies: { regime: { periodic: { over: O.angle, by: 1 turn, of: O.omega } } }
";
    let found = regime(text);
    // J ω²/2 + cos φ is the same at all angles
    near("slowest", found.results[MIN], 20.0, 1e-9);
    near("fastest", found.results[MAX], (400.0 + 40.0_f64).sqrt(), 1e-9);
    told(&found, "family-of-motions");
    let finding = found.findings.iter().find(|f| f.code == "family-of-motions").unwrap();
    assert!(finding.message.contains("every speed is a regime") && !finding.message.contains("fold"), "{}", finding.message);
}

#[test]
fn a_pendulum_that_turns_over_keeps_its_energy() {
    let found = regime(&bar(20.0, "over: O.angle, by: 1 turn, of: O.omega"));
    // ω² + ω₀²·2 sin φ is the same at all angles
    let energy = 400.0 + 2.0 * SMALL * (-PI / 6.0).sin();
    near("fastest", found.results[MAX], (energy + 2.0 * SMALL).sqrt(), 1e-9);
    near("slowest", found.results[MIN], (energy - 2.0 * SMALL).sqrt(), 1e-9);
    told(&found, "family-of-motions");
}
