//! Near a singular position round-off of the constraints decides on eigenvalues and on how a motion begins: where it does, it is told.
//!
//! A crank r and a rod as long, bars of m₁ and m₂, with a block m₃ on a line through the crank's joint, singular at a right angle, where the
//! block is at that joint and the rod on the crank:
//!
//! ```text
//! x = 2 r cos θ,   M = r² (m₁/3 + m₂/12 + m₂ (2.25 sin² θ + 0.25 cos² θ) + 4 m₃ sin² θ)
//! K = k + 4 c − (m₁ + m₂) g r/2 sin θ
//! ```
//!
//! with springs k on the crank and c between the arms. The moment of c is borne by the line alone, with a force as large as the block is near.

use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;
use std::f64::consts::FRAC_PI_2;

pub(super) fn equal_arms(from_singular: f64) -> String {
    format!(
        "
grashof: 1
name: equal arms
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ O: [0, 0] }}
bodies:
  crank: {{ bar: {{ length: 1 m, mass: 1 kg }} }}
  rod: {{ bar: {{ length: 1 m, mass: 2 kg }} }}
  block: {{ mass: 3 kg, inertia: 0.1 kg m^2 }}
joints:
  O: {{ revolute: [ground.O, crank.start] }}
  A: {{ revolute: [crank.end, rod.start] }}
  B: {{ revolute: [rod.end, block.origin] }}
  S: {{ slider: [ground.O, block.origin] }}
springs:
  k: {{ joint: O, stiffness: 100 N m/rad }}
  c: {{ joint: A, stiffness: 50 N m/rad }}
start: {{ O.angle: {angle:?} rad, rod.angle: ~{rod:?} rad, O.omega: 1 rad/s }}
studies:
  modes: {{ modes: {{ at: start }} }}
  lanczos: {{ modes: {{ at: start, lowest: 1, methods: [lanczos] }} }}
  linear: {{ linearize: {{ at: start }} }}
  motion: {{ dynamics: {{ until: 1 ms, every: 1 ms }}, columns: [O.angle] }}
",
        angle = FRAC_PI_2 - from_singular,
        rod = from_singular - FRAC_PI_2,
    )
}

fn told(outcome: &Outcome) -> bool {
    outcome.findings.iter().any(|f| f.code == "nearly-singular")
}

#[test]
fn eigenvalues_that_round_off_decides_on_are_told() {
    let (mut worst, mut silent) = (0.0, 0);
    for from_singular in [0.5, 0.1, 0.03, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4] {
        let (sin, cos) = (FRAC_PI_2 - from_singular).sin_cos();
        let mass = 1.0 / 3.0 + 2.0 / 12.0 + 2.0 * (2.25 * sin * sin + 0.25 * cos * cos) + 12.0 * sin * sin;
        let right = (300.0 - 1.5 * 9.81 * sin) / mass;
        for name in ["modes", "lanczos"] {
            let outcome = study(&equal_arms(from_singular), name, Coordinates::Joint);
            let found = outcome.lists.iter().find(|list| list.name == "eigenvalues").expect("eigenvalues").values[0];
            let off = (found - right).abs() / right;
            assert!(off < 1e-5 || told(&outcome), "{name} at {from_singular:e}: {found} for {right} in silence");
            worst = f64::max(worst, off);
            silent += usize::from(!told(&outcome));
        }
    }
    assert!(worst > 1e-5 && silent >= 10, "{worst:e}, {silent}");
}

/// The eigenvalue that is told to be as good, 1/s².
fn other(outcome: &Outcome) -> f64 {
    let finding = outcome.findings.iter().find(|f| f.code == "nearly-singular").expect("a finding");
    let (_, rest) = finding.message.split_once(" 1/s^2 is ").expect("an eigenvalue");
    rest.split_once(". ").expect("a sentence").0.parse().expect("a number")
}

#[test]
fn full_and_sparse_matrices_tell_the_same_other_eigenvalue() {
    for from_singular in [3e-4, 2e-4] {
        let [full, sparse] = ["modes", "lanczos"].map(|name| study(&equal_arms(from_singular), name, Coordinates::Joint));
        let own = full.lists.iter().find(|list| list.name == "eigenvalues").expect("eigenvalues").values[0];
        // by how much it is another one: to first order in the second
        let [full, sparse] = [&full, &sparse].map(|outcome| other(outcome) - own);
        assert!((full - sparse).abs() < 0.1 * full.abs(), "{from_singular:e}: {full:e} {sparse:e}");
    }
}

#[test]
fn linear_models_and_motions_tell_that_round_off_decides() {
    for (from_singular, expected) in [(0.1, false), (1e-6, true)] {
        for name in ["linear", "motion", "modes", "lanczos"] {
            let outcome = study(&equal_arms(from_singular), name, Coordinates::Joint);
            assert_eq!(told(&outcome), expected, "{name} at {from_singular:e}: {:?}", outcome.findings);
        }
    }
}
