//! Loads that jump by time: what they overload for a part of a step gives way at once, and what a start holds wrongly is put right there.

use super::{close, done, forms, tried};
use crate::reference::Verdict;

/// What lasts for less than a step of 0.1 s, from 1 s on.
const PULSE: &str = "exp(-(t - 1 s)/0.1 s)";

/// The way of a mass of 1 kg under 2 N exp(−s/0.1 s) against friction of 1 N, until it stops: v = 0.2 (1 − exp(−10 s)) − s.
fn knocked() -> f64 {
    let s = (0..200).fold(0.2, |s: f64, _| 0.2 * (1.0 - (-10.0 * s).exp()));
    0.2 * s - 0.02 * (1.0 - (-10.0 * s).exp()) - 0.5 * s * s
}

#[test]
fn each_knock_moves_a_block_that_friction_holds() {
    let mut verdict = Verdict::default();
    for (settings, tolerance) in forms() {
        let text = format!(
            "grashof: 1
name: knocks
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg, inertia: 1 kg m^2 }} }}
joints: {{ A: {{ slider: [ground, a.origin], axis: [1, 0], friction: {{ coulomb: 1 N }} }} }}
loads: {{ pull: {{ joint: A, force: \"2 N*exp(-mod(t, 1 s)/0.1 s)\" }} }}
studies: {{ run: {{ dynamics: {{ until: 3.9 s, every: 0.3 s, {settings} }}, columns: [time, A.position] }} }}
"
        );
        let outcome = done(&text, "run");
        let last = outcome.rows.iter().last().map_or(f64::NAN, |row| row[1]);
        verdict.close("A.position", &settings, last, 4.0 * knocked(), 10.0 * tolerance);
    }
    verdict.give("each_knock_moves_a_block_that_friction_holds");
}

#[test]
fn no_contact_carries_more_than_it_can_behind_a_jump() {
    let text = |settings: &str| {
        format!(
            "grashof: 1
name: contacts
space: planar
gravity: none
ground: {{ G: [0, 0], H: [1 m, 0] }}
bodies: {{ s: {{ mass: 1 kg }}, a: {{ mass: 1 kg }}, b: {{ mass: 1 kg }}, c: {{ mass: 1 kg }}, d: {{ mass: 1 kg }} }}
joints:
  S: {{ slider: [ground, s.origin], axis: [1, 0], limits: {{ from: 0 m, restitution: 0 }} }}
  A: {{ slider: [ground.G, a.origin], axis: [1, 0] }}
  B: {{ slider: [ground.H, b.origin], axis: [1, 0] }}
  C: {{ slider: [ground.G, c.origin], axis: [1, 0] }}
  D: {{ slider: [ground.H, d.origin], axis: [1, 0] }}
clutches: {{ ow: {{ between: [A, B], one_way: true }}, cl: {{ between: [C, D], force: 1 N }} }}
loads:
  ps: {{ joint: S, force: \"if(t > 1 s, 1 N*{PULSE} - 0.5 N, -0.5 N)\" }}
  pa: {{ joint: A, force: \"if(t > 1 s, 1 N - 2 N*{PULSE}, 1 N)\" }}
  pc: {{ joint: C, force: \"if(t > 1 s, 4 N*{PULSE}, 1 N)\" }}
studies:
  run: {{ dynamics: {{ until: 2 s, every: 5 ms, {settings} }}, columns: [time, S.position, S.stop, ow.force, cl.force] }}
"
        )
    };
    let mut verdict = Verdict::default();
    // steps of usual tolerances are longer than the overload
    let usual = ["tolerance: 1e-8", "tolerance: 1e-8, coordinates: cartesian", "tolerance: 1e-7, integrator: radau5"];
    for (settings, tolerance) in forms().chain(usual.map(|settings| (settings.to_owned(), 1e-6))) {
        let outcome = done(&text(&settings), "run");
        for row in outcome.rows.iter() {
            let (place, s) = (format!("{settings}, {} s", row[0]), row[0] - 1.0);
            // it lifts at once: a = exp(−10 s) − 0.5, and falls back at s = 0.2557 s
            let lifted = if s > 0.0 { 0.1 * s - 0.01 * (1.0 - (-10.0 * s).exp()) - 0.25 * s * s } else { 0.0 };
            if s < 0.25 {
                verdict.close("S.position", &place, row[1], lifted, 10.0 * tolerance);
            }
            verdict.close("S.stop", &place, row[2].min(0.0), 0.0, 1e-6);
            verdict.close("ow.force", &place, row[3].min(0.0), 0.0, 1e-6);
            verdict.close("cl.force", &place, row[4].max(1.0), 1.0, 1e-6);
        }
    }
    verdict.give("no_contact_carries_more_than_it_can_behind_a_jump");
}

#[test]
fn a_clutch_that_a_start_closes_at_a_speed_takes_its_blow_however_long_the_first_step() {
    let mut verdict = Verdict::default();
    for (settings, tolerance) in forms() {
        for until in [0.1, 2.0, 20.0] {
            let text = format!(
                "grashof: 1
name: closed by the start
space: planar
gravity: none
ground: {{ A: [0, 0], B: [1 m, 0] }}
bodies: {{ a: {{ mass: 1 kg, inertia: 1 kg m^2 }}, b: {{ mass: 1 kg, inertia: 1 kg m^2 }} }}
joints: {{ A: {{ revolute: [ground.A, a.origin] }}, B: {{ revolute: [ground.B, b.origin] }} }}
clutches: {{ cl: {{ between: [A, B], one_way: true }} }}
loads: {{ pull: {{ joint: A, torque: -10 N m }} }}
start: {{ A.omega: 0.2 rad/s, B.omega: 0 rad/s }}
studies: {{ run: {{ dynamics: {{ until: {until} s, every: {until} s, {settings} }}, columns: [time, A.omega, B.omega] }} }}
"
            );
            let outcome = done(&text, "run");
            let row = outcome.rows.iter().last().map_or(vec![f64::NAN; 3], |row| row.to_vec());
            let place = format!("{settings}, {until} s");
            verdict.close("A.omega", &place, row[1], 0.1 - 10.0 * until, 100.0 * tolerance);
            verdict.close("B.omega", &place, row[2], 0.1, 100.0 * tolerance);
        }
    }
    verdict.give("a_clutch_that_a_start_closes_at_a_speed_takes_its_blow_however_long_the_first_step");
}

#[test]
fn a_driven_guide_whose_force_changes_its_side_does_not_jam() {
    let text = "grashof: 1
name: driven guide
space: planar
gravity: none
ground: { G0: [0.008, 0.192] }
bodies:
  b0: { mass: 0.834, com: [0.094, -0.001], inertia: 0.149, points: { Q: [-0.025, -0.094] } }
  b1: { mass: 2.341, com: [0.096, 0.043], inertia: 0.087, points: { Q: [-0.094, -0.038] } }
joints:
  J0: { revolute: [ground.G0, b0.Q] }
  J1: { slider: [b0.origin, b1.Q], axis: [0, 1], friction: { coulomb: 0.165 } }
drivers:
  dJ0: { joint: J0, angle: -0.977 rad + 0.875 rad*sin(1.856 rad/s*t + 1 rad) - 0.875 rad*sin(1) }
  dJ1: { joint: J1, position: -0.118 m + 0.227 m*sin(1.17 rad/s*t + 1 rad) - 0.227 m*sin(1) }
studies:
  inv: { inverse: { over: 3 s, samples: 30 }, columns: [time, J1.f, J1.friction, dJ1.force] }
";
    let outcome = tried(text, "inv").unwrap_or_else(|failure| panic!("{}", failure.reason()));
    assert!(outcome.stopped.is_none() && outcome.rows.iter().count() >= 31);
    for row in outcome.rows.iter() {
        assert!((row[2].abs() - 0.165 * row[1]).abs() <= 1e-9 * (1.0 + row[1]), "{row:?}");
    }
}

/// Three wheels of 1 kg m², the first of which turns at 9 rad/s and closes its one-way clutch to the second, which friction holds; the
/// third turns with it, is left behind by its own one-way clutch, or slips. What sticks does not withstand the blow, and what a start
/// drives closes as well.
#[test]
fn a_clutch_that_a_start_closes_takes_along_what_friction_holds() {
    let text = |second: &str, driver: &str, settings: &str| {
        let wheels: String = ["A", "B", "C"].map(|name| format!("  {name}: {{ mass: 1 kg, inertia: 1 kg m^2 }}\n")).concat();
        let friction = ", friction: { coulomb: 1 N m }";
        let hinge = |name: &str, held: &str| format!("  P{name}: {{ revolute: [ground.{name}, {name}.origin]{held} }}\n");
        format!(
            "grashof: 1
name: blow on what sticks
space: planar
gravity: none
ground: {{ A: [0, 0], B: [1 m, 0], C: [2 m, 0] }}
bodies:
{wheels}joints:
{}{}{}clutches:
  first: {{ between: [PA, PB], one_way: true }}
  second: {{ between: {second} }}
{driver}
studies:
  run: {{ dynamics: {{ until: 0.5 s, every: 0.1 s, {settings} }}, columns: [PA.omega, PB.omega, PC.omega, first.torque, second.torque] }}
",
            hinge("A", ""),
            hinge("B", friction),
            hinge("C", friction)
        )
    };
    let free = "start: { PA.omega: 9 rad/s }";
    let driven = "drivers: { drive: { joint: PA, speed: 9 rad/s } }\nstart: { PB.omega: 0 rad/s }";
    // speeds behind the blow, how fast they fall, and torques of the clutches
    let cases = [
        ("[PB, PC], one_way: true", free, [3.0; 3], [2.0 / 3.0; 3], [2.0 / 3.0, 1.0 / 3.0]),
        ("[PC, PB], one_way: true", free, [4.5, 4.5, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0]),
        ("[PB, PC], torque: 5 N m", free, [4.5, 4.5, 0.0], [3.0, 3.0, -4.0], [3.0, 5.0]),
        ("[PB, PC], one_way: true", driven, [9.0; 3], [0.0; 3], [2.0, 1.0]),
    ];
    let mut verdict = Verdict::default();
    for (settings, tolerance) in forms() {
        for (second, driver, speeds, slowing, torques) in cases {
            // in minimal coordinates a driven wheel cannot close a clutch at a speed: the run does not begin
            if driver == driven && settings.contains("minimal") {
                continue;
            }
            let outcome = done(&text(second, driver, &settings), "run");
            for (row, t) in outcome.rows.iter().zip([0.0, 0.1, 0.2, 0.3, 0.4, 0.5]) {
                let right = [0, 1, 2].map(|k| speeds[k] - slowing[k] * t);
                for (name, (found, right)) in ["A", "B", "C", "first", "second"].iter().zip(row.iter().zip(right.iter().chain(&torques))) {
                    verdict.close(name, format!("{settings}, {second}, {driver}, {t} s"), *found, *right, 100.0 * tolerance);
                }
            }
        }
    }
    verdict.give("blows on what sticks");
}

/// Friction and a load that switches with the same rate turn round at one instant: nothing is between, where one of them alone has turned.
#[test]
fn friction_turns_round_with_a_load_that_switches_with_its_rate() {
    let text = "grashof: 1
name: extremes at a reversal with friction
space: planar
gravity: [0, -9.81 m/s^2]
ground: { O: [0, 0], C: [0.2544 m, 0.02 m] }
bodies:
  crank: { bar: { length: 0.0536 m, mass: 0.314 kg } }
  coupler: { bar: { length: 0.2752 m, mass: 1.727 kg } }
  rocker: { bar: { length: 0.2139 m, mass: 1.431 kg } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end], friction: { coulomb: 0.374 N m } }
  C: { revolute: [ground.C, rocker.start], friction: { coulomb: 0.422 N m } }
loads: { l: { joint: A, torque: \"-0.3 N m*sign(rocker.omega)\" } }
drivers: { d: { joint: O, angle: 1 rad*sin(6.046 rad/s*t) } }
start: { coupler.angle: ~54.9 deg, rocker.angle: ~100 deg }
measures: { near: \"if(t > 0.255 s and t < 0.262 s, d.torque, -9 N m)\" }
studies:
  i: { inverse: { over: 0.3 s, samples: 20 }, scalars: { hi: max(near) } }
  d: { dynamics: { until: 0.3 s, tolerance: 1e-10 }, scalars: { hi: max(near) } }
";
    let [inverse, dynamics] = ["i", "d"].map(|name| done(text, name).scalars[0]);
    close("largest torque at the reversal", dynamics, inverse, 1e-6);
}
