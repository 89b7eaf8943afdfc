//! The branch of a linkage is the one that the guesses lie on; what a start leaves open does not depend on coordinates and cuts.

mod alike;
mod change;
mod flat;
mod nearer;
mod open;
mod sizes;
mod turned;
mod universal;

use crate::common;
use crate::common::Noise;
use grashof::mechanism::Coordinates;
use std::f64::consts::{FRAC_PI_2, TAU};

/// The difference of two angles in (−π, π].
fn apart(a: f64, b: f64) -> f64 {
    let x = (a - b).rem_euclid(TAU);
    if x > 0.5 * TAU { x - TAU } else { x }
}

/// A crank-rocker of 100, 300, 250 mm on a base of 300 mm at a crank angle, with a guess of one angle: angles of coupler and rocker.
fn four_bar(crank: f64, guess: &str) -> [f64; 2] {
    let text = format!(
        "grashof: 1
name: four-bar
space: planar
gravity: none
ground: {{ O: [0, 0], C: [30 cm, 0] }}
bodies: {{ crank: {{ bar: {{ length: 10 cm }} }}, coupler: {{ bar: {{ length: 30 cm }} }}, rocker: {{ bar: {{ length: 25 cm }} }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.start] }}
drivers: {{ d: {{ joint: O, speed: 60 rpm }} }}
start: {{ O.angle: {crank} rad, {guess} }}
studies: {{ k: {{ inverse: {{ over: 0.001 s, samples: 1 }}, columns: [coupler.angle, rocker.angle] }} }}
"
    );
    let row = common::study(&text, "k", Coordinates::Joint).rows[0].to_vec();
    [row[0], row[1]]
}

/// Angles of coupler and rocker on both branches, by the circles about the ends of crank and base.
fn branches(crank: f64) -> [[f64; 2]; 2] {
    let (a, c) = ((0.1 * crank.cos(), 0.1 * crank.sin()), (0.3, 0.0));
    let (dx, dy) = (c.0 - a.0, c.1 - a.1);
    let d = dx.hypot(dy);
    let along = (d * d + 0.3 * 0.3 - 0.25 * 0.25) / (2.0 * d);
    let up = (0.3 * 0.3 - along * along).sqrt();
    [1.0, -1.0].map(|side| {
        let b = (a.0 + (along * dx - side * up * dy) / d, a.1 + (along * dy + side * up * dx) / d);
        [(b.1 - a.1).atan2(b.0 - a.0), (b.1 - c.1).atan2(b.0 - c.0)]
    })
}

#[test]
fn one_guessed_angle_chooses_the_branch() {
    let mut noise = Noise(11);
    for (k, name) in ["coupler.angle", "rocker.angle"].into_iter().enumerate() {
        for _ in 0..12 {
            let crank = 0.5 * TAU * noise.next();
            let both = branches(crank);
            for right in both {
                let guess = right[k] + 0.25 * noise.next();
                let other = if right == both[0] { both[1] } else { both[0] };
                if apart(guess, right[k]).abs() > 0.8 * apart(guess, other[k]).abs() {
                    continue;
                }
                let found = four_bar(crank, &format!("{name}: ~{guess} rad"));
                let off = apart(found[0], right[0]).abs().max(apart(found[1], right[1]).abs());
                assert!(off < 1e-10, "crank at {crank}, {name} ~{guess}: {found:?} instead of {right:?}");
            }
        }
    }
}

/// A guess that one assembly meets exactly counts, though the drawn rod points straight away from its place.
#[test]
fn a_guess_that_can_be_met_is_met() {
    for (guess, rod) in [(0.24, -FRAC_PI_2), (-0.36, FRAC_PI_2)] {
        let text = format!(
            "grashof: 1
name: press
space: planar
gravity: none
ground: {{ O: [0, 0.5 m] }}
bodies: {{ crank: {{ bar: {{ length: 60 mm, mass: 12 kg }} }}, rod: {{ bar: {{ length: 300 mm, mass: 15 kg }} }}, ram: {{ mass: 80 kg }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, rod.start] }}
  B: {{ revolute: [rod.end, ram.origin] }}
  W: {{ slider: [ground.O, ram.origin], axis: [0, -1] }}
drivers: {{ d: {{ joint: O, speed: 60 rpm }} }}
start: {{ O.angle: 90 deg, W.position: ~{guess} m }}
studies: {{ k: {{ kinematics: {{ over: 1 turn, samples: 4 }}, columns: [W.position, rod.angle] }} }}
"
        );
        let row = common::study(&text, "k", Coordinates::Joint).rows[0].to_vec();
        assert!((row[0] - guess).abs() < 1e-12 && apart(row[1], rod).abs() < 1e-6, "{row:?}");
    }
}

/// A driver in a loop without freedom is no dead point; one at a dead point is.
#[test]
fn a_driver_that_nothing_lets_move_is_told_from_a_dead_point() {
    let start = |drivers: &str, rest: &str| {
        let text = format!(
            "grashof: 1
name: two bars and a pendulum
space: planar
gravity: none
ground: {{ O: [0, 0], C: [30 cm, 0], P: [1 m, 0] }}
bodies:
  a: {{ bar: {{ length: 20 cm }} }}
  b: {{ bar: {{ length: 25 cm }} }}
  p: {{ bar: {{ length: 10 cm }} }}
{rest}
  P: {{ revolute: [ground.P, p.start] }}
drivers: {{ {drivers} }}
studies: {{ k: {{ kinematics: {{ over: 1 ms, samples: 1 }} }} }}
"
        );
        let model = common::model(&text, None);
        let values = grashof::studies::common::case::parameters(&model);
        let found = grashof::kinematics::assemble::assemble::<grashof::geometry::Planar<f64>>(&model, &values, Coordinates::Joint);
        found.err().map(|failure| failure.reason()).unwrap_or_default()
    };
    let triangle = "joints:
  O: { revolute: [ground.O, a.start] }
  A: { revolute: [a.end, b.start] }
  C: { revolute: [b.end, ground.C] }";
    let held = start("d: { joint: O, speed: 1 rad/s }", triangle);
    assert!(held.contains("the driver `d` cannot move") && !held.contains("dead point"), "{held}");
    assert_eq!(start("d: { joint: P, speed: 1 rad/s }", triangle), "");
    let crank = "  c: { mass: 1 kg }
start: { O.angle: 0 deg }
joints:
  O: { revolute: [ground.O, a.start] }
  A: { revolute: [a.end, b.start] }
  B: { revolute: [b.end, c.origin] }
  S: { slider: [ground.O, c.origin], axis: [1, 0] }";
    let dead = start(
        "d: { joint: S, speed: 1 m/s }",
        &crank.replace("start: { O.angle: 0 deg }", "start: { O.angle: ~0 deg, S.position: 45 cm }"),
    );
    assert!(dead.contains("dead point"), "{dead}");
    let dead = start("d: { joint: S, speed: 1 m/s }, e: { joint: P, speed: 1 rad/s }", crank);
    assert!(dead.contains("dead point"), "{dead}");
}
