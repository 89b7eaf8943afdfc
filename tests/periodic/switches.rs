//! Switches, jumps of forces and impacts within a period: the map of a period by differences beside its derivative.

use super::{FLOQUET, PERIOD, derivative, end, multipliers, near, regime, same_multipliers};
use std::f64::consts::TAU;

/// A mass on a spring with loads, events and a friction, driven by a force of period 2 s; the study, and one period from any start.
struct Driven<'a> {
    load: &'a str,
    joint: &'a str,
    events: &'a str,
}

const NONE: &str = "joint: S, force: 0 N";

impl Driven<'_> {
    fn text(&self, start: [f64; 2], study: &str) -> String {
        format!(
            "grashof: 1
name: driven mass
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ mass: {{ mass: 1 kg }} }}
joints:
  S:
    slider: [ground, mass.origin]
    axis: [1, 0]
{}
springs: {{ spring: {{ joint: S, stiffness: 30 N/m }} }}
measures: {{ x: S.position, v: S.velocity }}
loads:
  push: {{ joint: S, force: 12 N*cos(pi*1 rad/s*t) }}
  other: {{ {} }}
start: {{ S.position: {:?} m, S.velocity: {:?} m/s }}
events: {{ {} }}
studies:
  {study}
",
            self.joint, self.load, start[0], start[1], self.events
        )
    }

    /// The regime, whose multipliers are those of differences of the map.
    fn check(&self, within: f64) -> grashof::studies::common::outcome::Outcome {
        let found = regime(&self.text([0.1, 0.0], "regime: { periodic: { over: t, by: 2 s, of: v }, columns: [x, v] }"));
        let lap = "lap: { dynamics: { until: 2 s, tolerance: 1e-13 }, columns: [x, v] }";
        let x = &found.rows[0];
        let map = |x: &[f64]| end(&self.text([x[0], x[1]], lap));
        let next = map(x);
        near("x a period later", next[0], x[0], 1e-9);
        near("v a period later", next[1], x[1], 1e-9);
        same_multipliers(&found, &derivative(map, x, &[2e-4, 2e-3]), within);
        found
    }
}

/// The determinant of a map of two coordinates.
fn determinant(found: &grashof::studies::common::outcome::Outcome) -> f64 {
    let m = multipliers(found);
    m[0][0] * m[1][0] - m[0][1] * m[1][1]
}

#[test]
fn an_impact_oscillator() {
    let stop = Driven {
        load: NONE,
        joint: "    damping: 0.4 N s/m",
        events: "hit: { when: x - 0.2 m, crossing: rising, restitution: { joint: S, e: 0.7 } }",
    };
    let found = stop.check(1e-7);
    let hits = found.events.len() as i32;
    assert!(hits > 0, "no impact in a period");
    // an impact turns the way round and shrinks the velocity, so the area by e²; damping does the rest
    near("determinant", determinant(&found), 0.7_f64.powi(2 * hits) * (-0.4 * found.results[PERIOD]).exp(), 1e-9);
    assert!(found.certificate.march.as_ref().is_some_and(|m| m.impacts < 0.0));
    // a rigid stop is the same
    let joint = "    damping: 0.4 N s/m\n    limits: { to: 20 cm, restitution: 0.7 }";
    let rigid = Driven { load: NONE, joint, events: "" }.check(1e-7);
    near("floquet", rigid.results[FLOQUET], found.results[FLOQUET], 1e-9);
}

#[test]
fn a_force_that_jumps_at_a_place() {
    // it acts beyond a place in one direction only: two surfaces, one by position and one by velocity
    let relay = Driven { load: "joint: S, force: \"if(x > 0.15 m and v > 0, 3 N, 0)\"", joint: "    damping: 0.5 N s/m", events: "" };
    let found = relay.check(1e-7);
    assert!(found.switches.len() >= 2);
}

#[test]
fn a_force_behind_switches_that_let_each_other_jump() {
    for load in [
        "joint: S, force: \"if(if(x > 0.1 m, x, 1 m) > 0.2 m, 3 N, 0)\"",
        "joint: S, force: \"if(if((x > 0.1 m) == 1, x, 1 m) > 0.2 m, 3 N, 0)\"",
    ] {
        let jumps = Driven { load, joint: "    damping: 0.5 N s/m", events: "" };
        let found = jumps.check(1e-7);
        assert!(found.switches.len() >= 3, "{load}");
    }
}

#[test]
fn dry_friction_that_is_steep_at_rest() {
    let dry = Driven { load: NONE, joint: "    friction: { coulomb: 3 N, stick_speed: 2 cm/s }", events: "" };
    let found = dry.check(1e-7);
    assert!(found.switches.len() >= 4);
}

#[test]
fn a_stop_on_a_joint_with_friction() {
    // a blow turns the friction round, which the motion itself does elsewhere
    let joint = "    damping: 0.4 N s/m\n    friction: { coulomb: 1 N }\n    limits: { to: 20 cm, restitution: 0.7 }";
    let rubs = Driven { load: NONE, joint, events: "" };
    rubs.check(1e-7);
}

#[test]
fn friction_by_a_coefficient_under_a_load_that_varies() {
    let friction_by_reactions = Driven {
        load: "at: mass.origin, force: [0, -6 N - 20 N/m*x - 2 N s/m*v]",
        joint: "    friction: { coulomb: 0.25, stick_speed: 2 cm/s }",
        events: "",
    };
    let found = friction_by_reactions.check(1e-7);
    assert!(found.switches.len() >= 4);
}

#[test]
fn a_restitution_that_depends_on_the_speed() {
    let stop = Driven {
        load: NONE,
        joint: "    damping: 0.4 N s/m",
        events: "hit: { when: x - 0.2 m, crossing: rising, restitution: { joint: S, e: 1/(1 + v/1 m/s) } }",
    };
    assert!(!stop.check(1e-7).events.is_empty());
}

/// A wheel with an eccentric mass that a torque turns and a brake holds in one half of each turn: the return map of one coordinate.
#[test]
fn a_wheel_that_is_braked_in_half_of_each_turn() {
    let text = |omega: f64, study: &str| {
        format!(
            "grashof: 1
name: braked wheel
space: planar
gravity: [0, -9.81 m/s^2]
bodies: {{ wheel: {{ mass: 3 kg, com: [5 cm, 0], inertia: 0.2 kg m^2 }} }}
joints: {{ O: {{ revolute: [ground, wheel.origin], damping: 0.2 N m s/rad }} }}
measures: {{ theta: O.angle, omega: O.omega }}
loads: {{ drive: {{ joint: O, torque: 5 N m }}, brake: {{ joint: O, torque: \"if(sin(theta + 0.3*omega/1 rad/s) > 0, -3 N m, 0)\" }} }}
start: {{ O.angle: 20 deg, O.omega: {omega:?} rad/s }}
events: {{ turn: {{ when: theta - 380 deg, crossing: rising, action: stop }} }}
studies:
  {study}
"
        )
    };
    // the event of the model ends the lap alone
    let study = "regime: { periodic: { over: theta, by: 1 turn, of: omega }, columns: [theta, omega] }";
    let found = regime(&text(8.0, study).replace("events:", "# events:"));
    let omega = found.rows[0][1];
    let lap = "lap: { dynamics: { until: 20 s, tolerance: 1e-13 }, columns: [omega] }";
    let slope = derivative(|x| end(&text(x[0], lap)), &[omega], &[1e-2])[(0, 0)];
    near("multiplier", found.results[FLOQUET], slope.abs(), 1e-8);
    near("mean speed", found.results[1], TAU / found.results[PERIOD], 1e-9);
}

/// A cam with straight flanks carries a mass on a spring, which moves the follower too: velocities of both jump at each corner.
/// A cam by a table under a mass on a spring, from an angle in degrees; the study.
fn cam(between: &str, [angle, omega, x, v]: [f64; 4], study: &str) -> String {
    format!(
        "grashof: 1
name: cam under a mass on a spring
space: planar
gravity: none
tables:
  lift:
    points: [[0 deg, 0 mm], [90 deg, 0 mm], [180 deg, 10 mm], [270 deg, 10 mm], [360 deg, 0 mm]]
    between: {between}
    beyond: periodic
bodies: {{ cam: {{ mass: 1 kg, inertia: 1e-3 kg m^2 }}, follower: {{ mass: 20 kg }}, load: {{ mass: 5 kg }} }}
joints:
  O: {{ revolute: [ground, cam.origin] }}
  F: {{ slider: [ground, follower.origin], axis: [0, 1] }}
  L: {{ slider: [ground, load.origin], axis: [0, 1] }}
couplings: {{ c: {{ zero: F.position - lift(O.angle) - 0.2*L.position }} }}
springs: {{ s: {{ joint: L, stiffness: 2000 N/m, damping: 20 N s/m }} }}
measures: {{ theta: O.angle, omega: O.omega }}
loads: {{ push: {{ joint: O, torque: 0.02 N m }}, brake: {{ joint: O, torque: -0.001 N m s*omega }} }}
{}start: {{ O.angle: {angle:?} deg, O.omega: {omega:?} rad/s, L.position: {x:?} m, L.velocity: {v:?} m/s }}
studies: {{ {study}, columns: [omega, L.position, L.velocity] }} }}
",
        if study.starts_with("lap") {
            format!("events: {{ turned: {{ when: theta - {} deg, action: stop }} }}\n", angle + 360.0)
        } else {
            String::new()
        }
    )
}

const TURN: &str = "regime: { periodic: { over: theta, by: 1 turn, of: omega, tolerance: 1e-11 }";

#[test]
fn neighbours_pass_the_corners_of_a_coupling() {
    for between in ["linear", "cubic"] {
        let found = regime(&cam(between, [10.0, 17.0, -0.0035, -0.094], TURN));
        let x = &found.rows[0];
        let map = |x: &[f64]| end(&cam(between, [10.0, x[0], x[1], x[2]], "lap: { dynamics: { until: 2 s, tolerance: 1e-13 }"));
        map(x).iter().zip(x).for_each(|(next, x)| near("a turn later", *next, *x, 1e-8));
        same_multipliers(&found, &derivative(map, x, &[1e-2, 1e-5, 1e-3]), 1e-6);
    }
}

#[test]
fn a_regime_is_the_same_wherever_its_turn_begins() {
    for between in ["linear", "cubic"] {
        let of = |angle: f64| regime(&cam(between, [angle, 17.0, -0.0035, -0.094], TURN));
        let [first, others @ ..] = [10.0, 0.0, 90.0, 200.0, 270.0].map(of);
        for other in others {
            near("period", other.results[PERIOD], first.results[PERIOD], 1e-9);
            let all = |found: &grashof::studies::common::outcome::Outcome| multipliers(found).as_flattened().to_vec();
            all(&other).iter().zip(all(&first)).for_each(|(other, first)| near("multiplier", *other, first, 1e-6));
        }
    }
}
