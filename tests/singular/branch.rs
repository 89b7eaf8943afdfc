//! Where two branches come near each other without crossing, motions and equilibria keep to theirs.
//!
//! A rod hardly longer than the crank r turns past the point where block and crank's joint would meet: on its branch
//!
//! ```text
//! x = r cos θ + √(l² − r² sin² θ) ≥ l − r
//! ```
//!
//! and a four-bar 0.5 - l - 0.5 on 1 m, which with l = 1 m would be a parallelogram, has a dead point beside its flat pose for l > 1, where
//! crank and coupler or coupler and rocker are in line: cos θ = (0.25 + 1 − (l − 0.5)²).

use super::run_to_its_end_or_not;
use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;
use std::f64::consts::TAU;

const R: f64 = 0.5;

fn rod_and_crank(longer: f64, space: &str) -> String {
    let (dimensions, axis) = if space == "planar" { ("planar", "axis: [1, 0]") } else { ("spatial", "axis: [1, 0, 0]") };
    let about = if space == "planar" { "" } else { ", axis: [0, 0, 1]" };
    let inertia = if space == "planar" { "0.01 kg m^2" } else { "[0.01 kg m^2, 0.01 kg m^2, 0.01 kg m^2]" };
    format!(
        "
grashof: 1
name: rod and crank
space: {dimensions}
gravity: none
bodies:
  crank: {{ bar: {{ length: {R} m, mass: 1 kg }} }}
  rod: {{ bar: {{ length: {:?} m, mass: 1 kg }} }}
  ram: {{ mass: 1 kg, inertia: {inertia} }}
joints:
  O: {{ revolute: [ground, crank.start]{about} }}
  A: {{ revolute: [crank.end, rod.start]{about} }}
  B: {{ revolute: [rod.end, ram.origin]{about} }}
  W: {{ slider: [ground, ram.origin], {axis} }}
drivers: {{ D: {{ joint: O, speed: 1 rad/s }} }}
start: {{ O.angle: 0 deg, A.angle: ~0 deg, W.position: ~1 m }}
studies:
  path: {{ kinematics: {{ over: 4 turn, samples: 25 }}, columns: [O.angle, W.position], scalars: {{ least: min(W.position) }} }}
  forces: {{ inverse: {{ over: 1 turn, samples: 4 }}, columns: [O.angle, W.position], scalars: {{ least: min(W.position) }} }}
  time: {{ dynamics: {{ until: 12.6 s, every: 0.7 s }}, columns: [O.angle, W.position], scalars: {{ least: min(W.position) }} }}
",
        R + longer
    )
}

#[test]
fn driven_motions_keep_to_their_branch() {
    for longer in [2e-4, 5e-5, 2e-5, 1e-5, 1e-6, 1e-7] {
        for name in ["path", "forces", "time"] {
            let outcome = study(&rod_and_crank(longer, "planar"), name, Coordinates::Joint);
            assert_eq!(outcome.stopped, None, "{name} with {longer:e}");
            for row in outcome.rows.iter() {
                let l = R + longer;
                let right = R * row[0].cos() + (l * l - (R * row[0].sin()).powi(2)).sqrt();
                assert!((row[1] - right).abs() < 1e-6, "{name} with {longer:e} at {}: {} for {right}", row[0], row[1]);
            }
            let least = outcome.scalars[0];
            assert!((least / longer - 1.0).abs() < 1e-2, "{name}: {least:e} for {longer:e}");
        }
    }
}

/// Hinges of a plane in space have redundant rows, and no determinant.
#[test]
fn driven_motions_with_redundant_rows_keep_to_their_branch() {
    for longer in [2e-4, 5e-5, 2e-5] {
        let outcome = study(&rod_and_crank(longer, "spatial"), "path", Coordinates::Joint);
        let least = outcome.scalars[0];
        assert!((least / longer - 1.0).abs() < 1e-2, "{least:e} for {longer:e}");
    }
}

/// Of the same length the branches cross, and the motion goes straight on: the block rests on the joint of the crank for half a turn, or moves
/// by 4 r to and fro.
#[test]
fn change_points_are_passed_as_ever() {
    let outcome = study(&rod_and_crank(0.0, "planar"), "path", Coordinates::Joint);
    assert_eq!(outcome.stopped, None);
    let off = |row: &[f64]| (row[1] - 2.0 * R * row[0].cos()).abs();
    assert!(outcome.rows.iter().all(|row| off(row) < 1e-7), "{:?}", outcome.rows.iter().map(off).fold(0.0, f64::max));
}

fn nearly_a_parallelogram(l: f64, more: &str, studies: &str) -> String {
    format!(
        "
grashof: 1
name: nearly a parallelogram
space: planar
gravity: none
ground: {{ O: [0, 0], C: [1 m, 0] }}
bodies:
  crank: {{ bar: {{ length: 0.5 m, mass: 1 kg }} }}
  coupler: {{ bar: {{ length: {l:?} m, mass: 1 kg }} }}
  rocker: {{ bar: {{ length: 0.5 m, mass: 1 kg }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.start] }}
{more}
start: {{ O.angle: 0.5 rad, coupler.angle: ~0 deg, rocker.angle: ~0.5 rad }}
studies: {{ it: {studies} }}
"
    )
}

#[test]
fn a_dead_point_beside_a_flat_pose_is_not_passed() {
    for longer in [1e-3, 1e-5, 3e-6, 1e-7] {
        let l = 1.0 + longer;
        let text = nearly_a_parallelogram(
            l,
            "drivers: { D: { joint: O, speed: -1 rad/s } }",
            "{ kinematics: { over: 6 s, samples: 6 }, columns: [O.angle] }",
        );
        let outcome = run_to_its_end_or_not(&text, "it");
        let dead = (1.25 - (l - 0.5).powi(2)).acos();
        let last = outcome.rows.iter().map(|row| row[0]).fold(f64::INFINITY, f64::min);
        assert!(outcome.stopped.as_ref().is_some_and(|why| why.contains("dead point")), "{longer:e}: {:?}", outcome.stopped);
        assert!((last - dead).abs() < 1e-6, "{longer:e}: {last} for {dead}");
    }
}

/// A spring on the crank pulls it on beyond the flat pose: with l > 1 it comes to the dead point beside it and no farther, with l < 1 the rocker
/// turns back.
#[test]
fn equilibria_are_on_the_branch_of_the_start() {
    let rest = |l: f64| -> Outcome {
        let text = nearly_a_parallelogram(
            l,
            "springs: { k: { joint: O, stiffness: 10 N m/rad, rest: -0.7 rad } }",
            "{ statics: { from: start }, columns: [O.angle, rocker.angle] }",
        );
        study(&text, "it", Coordinates::Joint)
    };
    for longer in [1e-3, 1e-4, 1e-6] {
        let angle = rest(1.0 + longer).rows[0][0];
        let dead = (1.25 - (0.5 + longer).powi(2)).acos();
        assert!((angle - dead).abs() < 1e-6, "{longer:e}: {angle} for {dead}");
    }
    for shorter in [1e-3, 1e-4, 1e-6] {
        let l = 1.0 - shorter;
        let row = rest(l).rows[0].to_vec();
        // on the crossed branch the joints of the coupler lie on different sides of the ground
        let right = {
            let (a, c) = ([0.5 * (-0.7_f64).cos(), 0.5 * (-0.7_f64).sin()], [1.0, 0.0]);
            let (dx, dy) = (a[0] - c[0], a[1] - c[1]);
            let d = dx.hypot(dy);
            let between = ((0.25 + d * d - l * l) / d).acos();
            [dy.atan2(dx) + between, dy.atan2(dx) - between].map(|x| (x + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0)
        };
        assert!((row[0] + 0.7).abs() < 1e-9, "{shorter:e}: {row:?}");
        let crossed = right.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert!((row[1] - crossed).abs() < 1e-7, "{shorter:e}: {row:?} for one of {right:?}");
    }
    // through a change point the way is told
    let flat = rest(1.0);
    assert!(flat.findings.iter().any(|f| f.code == "crosses-change-point"), "{:?}", flat.findings);
}

/// Wherever steps fall, a path goes on through change points, on its branch.
#[test]
fn change_points_stop_no_path() {
    for (lengths, branch) in [([0.5, 1.0], 1.0), ([0.3, 1.1], 1.0), ([0.5, 1.0], -1.0), ([1.0, 1.0], 1.0)] {
        for start in [0.3, 0.5, 0.7, 1.1, 1.7, 2.5] {
            let [a, b] = lengths;
            // on the crossed branch the rocker begins on the other side
            let guess = if branch > 0.0 {
                format!("coupler.angle: ~0 deg, rocker.angle: ~{start} rad")
            } else {
                format!("coupler.angle: ~-50 deg, rocker.angle: ~-{start} rad")
            };
            let studies: String = [1, 2, 3, 7, 20]
                .map(|n| {
                    format!(
                        "  n{n}: {{ kinematics: {{ over: {n} turn, samples: 4 }}, columns: [crank.angle, rocker.angle, coupler.angle] }}\n"
                    )
                })
                .concat();
            let text = format!(
                "
grashof: 1
name: parallelogram
space: planar
gravity: none
ground: {{ O: [0, 0], C: [{b} m, 0] }}
bodies:
  crank: {{ bar: {{ length: {a} m, mass: 1 kg }} }}
  coupler: {{ bar: {{ length: {b} m, mass: 1 kg }} }}
  rocker: {{ bar: {{ length: {a} m, mass: 1 kg }} }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, coupler.start] }}
  B: {{ revolute: [coupler.end, rocker.end] }}
  C: {{ revolute: [ground.C, rocker.start] }}
drivers: {{ D: {{ joint: O, speed: 1 rad/s }} }}
start: {{ O.angle: {start} rad, {guess} }}
studies:
{studies}"
            );
            for turns in [1, 2, 3, 7, 20] {
                let outcome = study(&text, &format!("n{turns}"), Coordinates::Joint);
                let last = outcome.rows.iter().next_back().expect("a row");
                let from = &outcome.rows[0];
                assert!((last[0] - from[0] - f64::from(turns) * TAU).abs() < 1e-9, "{lengths:?} from {start}, {turns}");
                // whole turns of the crank lead back, and the rocker of the parallelogram goes with it, the other one against it
                assert!((last[1] - from[1] - branch * f64::from(turns) * TAU).abs() < 1e-5, "{lengths:?} from {start}, {turns}: {last:?}");
            }
        }
    }
}

/// Two loops that come near another branch at once: det G changes its sign twice.
#[test]
fn loops_that_come_near_another_branch_at_once_keep_to_theirs() {
    let one = rod_and_crank(5e-5, "planar");
    let (_, joints) = one.split_once("joints:\n").expect("joints");
    let (joints, _) = joints.split_once("drivers").expect("drivers");
    let (_, bodies) = one.split_once("bodies:\n").expect("bodies");
    let (bodies, _) = bodies.split_once("joints").expect("joints");
    let mut second = joints.replace("ground", "ground.P");
    for name in ["crank", "rod", "ram"] {
        second = second.replace(&format!("{name}."), &format!("{name}2."));
    }
    for name in ["O", "A", "B", "W"] {
        second = second.replace(&format!("  {name}: "), &format!("  {name}2: "));
    }
    let mut more = bodies.to_string();
    for name in ["crank", "rod", "ram"] {
        more = more.replace(&format!("  {name}: "), &format!("  {name}2: "));
    }
    let text = one
        .replace("bodies:\n", &format!("ground: {{ P: [0, 2 m] }}\nbodies:\n{more}"))
        .replace("joints:\n", &format!("joints:\n{second}"))
        .replace("drivers: { ", "drivers: { E: { joint: O2, speed: 1 rad/s }, ")
        .replace("start: { ", "start: { O2.angle: 0 deg, A2.angle: ~0 deg, W2.position: ~1 m, ")
        .replace("over: 4 turn", "over: 10 s")
        .replace("columns: [O.angle, W.position]", "columns: [O.angle, W.position, W2.position]");
    let outcome = study(&text, "path", Coordinates::Joint);
    let l = R + 5e-5;
    for row in outcome.rows.iter() {
        let right = R * row[0].cos() + (l * l - (R * row[0].sin()).powi(2)).sqrt();
        assert!((row[1] - right).abs() < 1e-6 && (row[2] - right).abs() < 1e-6, "at {}: {row:?} for {right}", row[0]);
    }
}
