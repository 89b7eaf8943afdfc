//! Statics, modes and linear models in a change point are told to be those of no branch; beside it they are those of a branch.
//!
//! The flat parallelogram: links 2-1-2 over 1 m of ground, springs of 100, 150 and 70 N m/rad. On its parallelogram branch
//! λ = (100 + 150 + 70)/(4/3 + 8 + 4) = 24 1/s².

use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

pub(super) fn parallelogram(angle: &str) -> String {
    format!(
        "
grashof: 1
name: flat
space: planar
gravity: none
ground: {{ A0: [0, 0], A1: [1 m, 0] }}
bodies:
  left: {{ bar: {{ length: 2 m, mass: 1 kg }} }}
  coupler: {{ bar: {{ length: 1 m, mass: 2 kg }} }}
  right: {{ bar: {{ length: 2 m, mass: 3 kg }} }}
joints:
  A0: {{ revolute: [ground.A0, left.start] }}
  B0: {{ revolute: [left.end, coupler.start] }}
  B1: {{ revolute: [coupler.end, right.end] }}
  A1: {{ revolute: [ground.A1, right.start] }}
springs:
  k0: {{ joint: A0, stiffness: 100 N m/rad }}
  k1: {{ joint: A1, stiffness: 150 N m/rad }}
  k2: {{ joint: B0, stiffness: 70 N m/rad }}
start: {{ A0.angle: {angle}, coupler.angle: ~0 deg, right.angle: ~{angle} }}
studies:
  rest: {{ statics: {{ from: start }}, columns: [A0.angle] }}
  modes: {{ modes: {{ at: start }} }}
  at-rest: {{ modes: {{ at: statics }} }}
  linear: {{ linearize: {{ at: start }}, columns: [A0.angle] }}
"
    )
}

fn told(outcome: &Outcome) -> bool {
    outcome.findings.iter().any(|f| f.code == "in-change-point" && f.message.contains("leave 2 motions in it, but 1 motion beside it"))
}

#[test]
fn linear_motions_in_a_change_point_are_told_to_belong_to_no_branch() {
    let flat = parallelogram("0 deg");
    for name in ["rest", "modes", "at-rest", "linear"] {
        assert!(told(&study(&flat, name, Coordinates::Joint)), "{name}");
    }
    // also where the mechanism comes to rest in one
    for name in ["rest", "at-rest"] {
        assert!(told(&study(&parallelogram("20 deg"), name, Coordinates::Joint)), "{name}");
    }
    let beside = parallelogram("0.5 deg");
    for name in ["modes", "linear"] {
        let outcome = study(&beside, name, Coordinates::Joint);
        assert!(outcome.findings.iter().all(|f| f.code != "in-change-point"), "{name}");
    }
    let beside = study(&beside, "modes", Coordinates::Joint);
    let frequencies = &beside.lists.iter().find(|list| list.name == "frequencies").unwrap().values;
    assert!(frequencies.len() == 1 && (frequencies[0].powi(2) / 24.0 - 1.0).abs() < 1e-3, "{frequencies:?}");
}

/// A second coupler at half height has rows that are redundant in all positions.
#[test]
fn redundant_rows_are_no_change_point() {
    let braced = |angle: &str| {
        parallelogram(angle)
            .replace("length: 2 m, mass: 1 kg }", "length: 2 m, mass: 1 kg }, points: { m: [1 m, 0] }")
            .replace("length: 2 m, mass: 3 kg }", "length: 2 m, mass: 3 kg }, points: { m: [1 m, 0] }")
            .replace("joints:\n", "  mid: { bar: { length: 1 m, mass: 1 kg } }\njoints:\n  M0: { revolute: [left.m, mid.start] }\n  M1: { revolute: [mid.end, right.m] }\n")
            .replace("coupler.angle: ~0 deg", "coupler.angle: ~0 deg, mid.angle: ~0 deg")
    };
    let is_told = |angle: &str| study(&braced(angle), "modes", Coordinates::Joint).findings.iter().any(|f| f.code == "in-change-point");
    assert_eq!(["60 deg", "0 deg"].map(is_told), [false, true]);
}
