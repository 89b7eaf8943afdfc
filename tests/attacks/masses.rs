//! Bodies of masses far apart: a body without mass beside a heavy one must not change what the heavy one does.
//!
//! The laws: energy is kept, and joint coordinates, whose equations name only the joints, give the motion of cartesian
//! coordinates, in which every body carries its own mass.

use super::dice::Dice;
use super::motion::{apart, moved};
use super::{between, cases, seeded, share, tell};
use grashof::studies::common::outcome::Outcome;

/// A number between two powers of ten, evenly by its logarithm, with three digits.
fn decades(dice: &mut Dice, low: f64, high: f64) -> String {
    format!("{:.2e}", 10f64.powf(low + share(dice) * (high - low)))
}

/// Both are run.
const COORDINATES: [&str; 2] = ["joint", "cartesian"];
const TOLERANCE: f64 = 1e-8;
/// How much of its energy a motion may lose without a warning.
const ENERGY: f64 = 1e-4;
/// How far the two motions may be apart, as part of each column: a crank without mass is thrown through its dead points by what the heavy
/// body has, and an error of its angle there is as many times that of the tolerance.
const MOTION: f64 = 1e-3;

/// A mechanism and the columns to compare. `SIZE` stands for a unit of length.
type Made = (String, &'static str);

/// The kinds of mechanisms, with links of any mass.
const KINDS: [fn(&mut Dice) -> Made; 6] = [slider_crank, four_bar, two_slides, scotch_yoke, swinging_block, slider_crank_in_space];

/// A mechanism in the plane.
fn plane(dice: &mut Dice, rest: &str) -> String {
    let gravity = ["none", "[0, -9.81]"][dice.next(2)];
    format!("space: planar\ngravity: {gravity}\n{rest}")
}

/// Three masses.
fn masses(dice: &mut Dice) -> [String; 3] {
    std::array::from_fn(|_| decades(dice, -12.0, 3.0))
}

fn slider_crank(dice: &mut Dice) -> Made {
    let ([a, b, c], crank) = (masses(dice), between(dice, 0.1, 0.9));
    let text = plane(
        dice,
        &format!(
            "bodies:
  a: {{ bar: {{ length: {crank} SIZE, mass: {a} }} }}
  b: {{ bar: {{ length: 1 SIZE, mass: {b} }} }}
  c: {{ mass: {c} }}
joints:
  A: {{ revolute: [ground, a.start] }}
  B: {{ revolute: [a.end, b.start] }}
  C: {{ revolute: [b.end, c] }}
  S: {{ slider: [ground, c], axis: [1, 0] }}
start: {{ A.angle: 60 deg, A.omega: 5 rad/s, b.angle: ~-30 deg }}
"
        ),
    );
    (text, "a.angle, b.angle")
}

fn four_bar(dice: &mut Dice) -> Made {
    let ([a, b, c], [crank, rocker]) = (masses(dice), [between(dice, 0.2, 0.35), between(dice, 0.6, 0.9)]);
    let text = plane(
        dice,
        &format!(
            "ground: {{ D: [1 SIZE, 0] }}
bodies:
  a: {{ bar: {{ length: {crank} SIZE, mass: {a} }} }}
  b: {{ bar: {{ length: 1 SIZE, mass: {b} }} }}
  c: {{ bar: {{ length: {rocker} SIZE, mass: {c} }} }}
joints:
  A: {{ revolute: [ground, a.start] }}
  B: {{ revolute: [a.end, b.start] }}
  C: {{ revolute: [b.end, c.end] }}
  D: {{ revolute: [ground.D, c.start] }}
start: {{ A.angle: 60 deg, A.omega: 5 rad/s, c.angle: ~100 deg, b.angle: ~20 deg }}
"
        ),
    );
    (text, "a.angle, b.angle, c.angle")
}

fn two_slides(dice: &mut Dice) -> Made {
    let ([a, b, c], place) = (masses(dice), between(dice, 0.2, 0.9));
    let text = plane(
        dice,
        &format!(
            "bodies:
  a: {{ mass: {a} }}
  b: {{ bar: {{ length: 1 SIZE, mass: {b} }} }}
  c: {{ mass: {c} }}
joints:
  X: {{ slider: [ground, a], axis: [1, 0] }}
  Y: {{ slider: [ground, c], axis: [0, 1] }}
  A: {{ revolute: [a, b.start] }}
  B: {{ revolute: [b.end, c] }}
start: {{ X.position: {place} SIZE, X.velocity: 1 SIZE/s, b.angle: ~127 deg }}
"
        ),
    );
    (text, "b.angle")
}

fn scotch_yoke(dice: &mut Dice) -> Made {
    let ([a, y, b], crank) = (masses(dice), between(dice, 0.2, 0.9));
    let text = plane(
        dice,
        &format!(
            "bodies:
  a: {{ bar: {{ length: {crank} SIZE, mass: {a} }} }}
  y: {{ mass: {y} }}
  b: {{ mass: {b} }}
joints:
  A: {{ revolute: [ground, a.start] }}
  S: {{ slider: [ground, y], axis: [1, 0] }}
  T: {{ slider: [y, b], axis: [0, 1] }}
  B: {{ revolute: [a.end, b] }}
start: {{ A.angle: 60 deg, A.omega: 5 rad/s }}
"
        ),
    );
    (text, "a.angle")
}

fn swinging_block(dice: &mut Dice) -> Made {
    let ([a, b, c], crank) = (masses(dice), between(dice, 0.2, 0.6));
    let text = plane(
        dice,
        &format!(
            "ground: {{ D: [1 SIZE, 0] }}
bodies:
  a: {{ bar: {{ length: {crank} SIZE, mass: {a} }} }}
  b: {{ disc: {{ radius: 0.1 SIZE, mass: {b} }} }}
  c: {{ bar: {{ length: 2 SIZE, mass: {c} }} }}
joints:
  A: {{ revolute: [ground, a.start] }}
  B: {{ revolute: [a.end, b] }}
  D: {{ revolute: [ground.D, c.start] }}
  S: {{ slider: [c.start, b], axis: [1, 0] }}
start: {{ A.angle: 60 deg, A.omega: 5 rad/s }}
"
        ),
    );
    (text, "a.angle, c.angle")
}

fn slider_crank_in_space(dice: &mut Dice) -> Made {
    let ([a, b, c], crank) = (masses(dice), between(dice, 0.15, 0.4));
    let (gravity, [up, side]) = (["none", "[0, -9.81, 0]"][dice.next(2)], [between(dice, 0.05, 0.2), between(dice, 0.05, 0.2)]);
    let text = format!(
        "space: spatial
gravity: {gravity}
ground: {{ P: [0, {up} SIZE, {side} SIZE] }}
bodies:
  a: {{ bar: {{ length: {crank} SIZE, mass: {a}, width: 0.03 SIZE, height: 0.03 SIZE }} }}
  b: {{ bar: {{ length: 1 SIZE, mass: {b}, width: 0.03 SIZE, height: 0.03 SIZE }} }}
  c: {{ box: {{ size: [0.1 SIZE, 0.1 SIZE, 0.1 SIZE], mass: {c} }} }}
joints:
  A: {{ revolute: [ground, a.start], axis: [0, 0, 1] }}
  B: {{ spherical: [a.end, b.start] }}
  C: {{ universal: [b.end, c], axes: [[0, 0, 1], [0, 1, 0]] }}
  S: {{ slider: [ground.P, c], axis: [1, 0, 0] }}
start: {{ A.angle: 60 deg, A.omega: 5 rad/s }}
"
    );
    (text, "A.angle")
}

/// The largest change of energy as part of the energy at hand, and whether a warning tells that it is too much.
fn energy_lost(outcome: &Outcome) -> (f64, bool) {
    let lost = outcome.certificate.march.as_ref().map_or(f64::INFINITY, |march| march.energy_drift / march.energy_scale);
    (lost, outcome.findings.iter().any(|finding| finding.code == "energy"))
}

#[test]
fn masses_far_apart_move_alike_in_joint_and_cartesian_coordinates() {
    let wanted = cases(36);
    let mut dice = seeded(0x3A55_E5AB);
    let (mut findings, mut ran, mut stopped, mut told, mut rough) = (Vec::new(), 0, 0, 0, 0);
    let (mut lost, mut differ) = (0.0_f64, 0.0_f64);
    for case in 0..wanted {
        let (model, columns) = KINDS[case as usize % KINDS.len()](&mut dice);
        let size = ["cm", "m", "km"][dice.next(3)];
        let text = |coordinates: &str| {
            let dynamics = format!("until: 2 s, every: 50 ms, tolerance: {TOLERANCE}, coordinates: {coordinates}");
            format!("grashof: 1\nname: chance\n{model}studies: {{ move: {{ dynamics: {{ {dynamics} }}, columns: [time, {columns}] }} }}\n")
                .replace("SIZE", size)
        };
        let mut find = |what: String, coordinates: &str| {
            let path = std::env::temp_dir().join(format!("grashof-masses-{case}-{coordinates}.yaml"));
            std::fs::write(&path, text(coordinates)).unwrap();
            findings.push(format!("case {case}: {coordinates}: {what}: {}", path.display()));
        };
        let motions = COORDINATES.map(|coordinates| moved(&text(coordinates)));
        let mut doubtful = false;
        for (coordinates, outcome) in COORDINATES.iter().zip(&motions).filter_map(|(name, motion)| Some((name, motion.as_ref().ok()?))) {
            let (off, warned) = energy_lost(outcome);
            doubtful |= warned;
            if !warned {
                lost = lost.max(off);
                rough += u64::from(off > 100.0 * TOLERANCE);
            }
            if !warned && off > ENERGY {
                find(format!("loses {off:.1e} of its energy without a word"), coordinates);
            }
        }
        match &motions {
            [Ok(joint), Ok(cartesian)] => {
                let off = apart(joint, cartesian, 0.05);
                ran += 1;
                told += u64::from(doubtful);
                if !doubtful {
                    differ = differ.max(off);
                }
                if !doubtful && off > MOTION {
                    find(format!("{off:.1e} apart from joint coordinates"), COORDINATES[1]);
                }
            }
            [Err(a), Err(b)] if [a, b].iter().all(|reason| reason.contains("lost its inertia")) => stopped += 1,
            [a, b] => {
                for (coordinates, motion) in COORDINATES.iter().zip([a, b]) {
                    if let Err(reason) = motion {
                        find(reason.clone(), coordinates);
                    }
                }
            }
        }
    }
    let figures = format!("{ran} ran, {told} of them with a warning, {stopped} stopped; energy to {lost:.1e}, motions to {differ:.1e}");
    tell(&format!("masses: {wanted} mechanisms: {figures}; {rough} rough; {} findings", findings.len()));
    assert!(findings.is_empty(), "{} findings\n{}", findings.len(), findings.join("\n"));
    assert!(ran * 10 > wanted * 9 && told * 50 <= wanted && rough * 50 <= wanted, "{figures}; {rough} rough");
}
