//! Shafts that run steadily, or unevenly by the joint between them, under a torque and a damper.

use super::faults::told;
use super::{PERIOD, multipliers, near, regime};
use std::f64::consts::TAU;

#[test]
fn a_disc_that_turns_steadily_has_a_regime_without_accelerations() {
    // 3 N m against 0.1 N m s: 30 rad/s, from which deviations shrink like exp(−c t/I)
    for (space, inertia) in [("planar", "0.1"), ("spatial", "[0.1, 0.1, 0.1]")] {
        for start in [20.0, 30.0] {
            let text = format!(
                "grashof: 1
name: disc
space: {space}
gravity: none
bodies: {{ a: {{ mass: 1 kg, inertia: {inertia} }} }}
joints: {{ A: {{ revolute: [ground, a.origin], damping: 0.1 N m s/rad }} }}
loads: {{ motor: {{ joint: A, torque: 3 N m }} }}
start: {{ A.angle: 0 deg, A.omega: {start} rad/s }}
studies:
  regime: {{ periodic: {{ over: A.angle, by: 1 turn, of: A.omega }} }}
"
            );
            let found = regime(&text);
            near("period", found.results[PERIOD], TAU / 30.0, 1e-11);
            assert_eq!(multipliers(&found).len(), 1);
            near("multiplier", multipliers(&found)[0][0], (-TAU / 30.0_f64).exp(), 1e-9);
        }
    }
}

#[test]
fn a_weak_spring_that_winds_up_is_no_steady_motion() {
    // the weaker one changes the torque by two millionths in a turn
    for stiffness in [1e-6, 1e-3] {
        let text = format!(
            "grashof: 1
name: disc
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg, inertia: 0.1 kg m^2 }} }}
joints: {{ A: {{ revolute: [ground, a.origin], damping: 0.1 N m s/rad }} }}
springs: {{ coil: {{ joint: A, stiffness: {stiffness} N m/rad }} }}
loads: {{ motor: {{ joint: A, torque: 3 N m }} }}
start: {{ A.angle: 0 deg, A.omega: 30 rad/s }}
studies:
  regime: {{ periodic: {{ over: A.angle, by: 1 turn, of: A.omega, settle: 0 s }} }}
"
        );
        told(&text, false, &["not-periodic", "counts the turns"]);
    }
}

#[test]
fn a_shaft_behind_a_universal_joint_has_one_regime_in_all_descriptions() {
    // rows of the joint that nearly vanish at the start of the period are no constraints of their own
    let text = "grashof: 1
name: shafts
space: spatial
gravity: none
ground: { P: [0.22945265618534655, 0.1932653061713073, 0] }
bodies:
  a: { mass: 1, inertia: [0.01, 0.02, 0.02] }
  b: { mass: 1, inertia: [0.02, 0.02, 0.02], points: { e: [0.3, 0, 0] } }
joints:
  A: { revolute: [ground, a.origin], axis: [1, 0, 0], damping: 0.1 N m s/rad }
  U: { universal: [a.origin, b.origin], axes: [[0, 1, 0], [0, 0, 1]] }
  B: { KIND: [ground.P, b.e], axis: [0.7648421872844885, 0.644217687237691, 0], to: [1, 0, 0]CUT }
loads: { motor: { joint: A, torque: 3 N m } }
start: { A.angle: 0 deg, A.omega: 20 rad/s }
studies:
  regime: { periodic: { over: A.angle, by: 1 turn, of: A.omega } }
";
    let found: Vec<(f64, Vec<[f64; 2]>)> =
        [("cylindrical", ""), ("cylindrical", ", cut: true"), ("revolute", ""), ("revolute", ", cut: true")]
            .map(|(kind, cut)| regime(&text.replace("KIND", kind).replace("CUT", cut)))
            .iter()
            .map(|found| (found.results[PERIOD], multipliers(found)))
            .collect();
    for (period, multipliers) in &found {
        near("period", *period, found[0].0, 1e-9);
        assert_eq!(multipliers.len(), 1, "{multipliers:?}");
        near("multiplier", multipliers[0][0], found[0].1[0][0], 1e-7);
    }
    // what the motor gives in a turn the damper takes: c ∫ω² dt = 3 N m · 2π, and ω swings about its mean
    let mean = TAU / found[0].0;
    assert!((20.0..30.0).contains(&mean), "{mean}");
}
