//! Equilibria from singular starts, and next to singular positions: the branch that the file names is kept, and what round-off decides is told.
//!
//! Equal arms held at the angle θ of the crank (`near`), the spring c between them alone: the line bears at the block
//!
//! ```text
//! N = m₃ g + m₂ g/2 − 2 c θ / cos θ
//! ```

use super::{near, told};
use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;
use std::f64::consts::FRAC_PI_2;

fn tells(outcome: &Outcome, code: &str) -> bool {
    outcome.findings.iter().any(|f| f.code == code)
}

/// The parallelogram of `told` with weights, at this start.
fn weighed(start: &str) -> String {
    told::parallelogram("0 deg")
        .replace("gravity: none", "gravity: [0, -9.81 m/s^2]")
        .replace("  k2: { joint: B0, stiffness: 70 N m/rad }\n", "")
        .replace("columns: [A0.angle]", "columns: [A0.angle, coupler.angle]")
        .replace("coupler.angle: ~0 deg, right.angle: ~0 deg", start)
}

/// On the parallelogram 250 θ = −8 g cos θ; on the other branch the right crank begins with three times the rate of the left one.
#[test]
fn equilibria_lie_on_the_branch_that_guessed_rates_name() {
    for (rates, parallel) in [("1", true), ("3", false)] {
        let start = format!("A0.omega: ~1 rad/s, coupler.angle: ~0 deg, right.angle: ~0 deg, right.omega: ~{rates} rad/s");
        let outcome = study(&weighed(&start), "rest", Coordinates::Joint);
        let [angle, coupler] = outcome.rows[0][..2] else { panic!("two columns") };
        assert!(tells(&outcome, "change-point"), "{:?}", outcome.findings);
        assert!(angle < -0.1, "{angle}");
        assert_eq!(coupler.abs() < 1e-6, parallel, "{angle} {coupler}");
        assert!(!parallel || (250.0 * angle + 8.0 * 9.81 * angle.cos()).abs() < 1e-7, "{angle}");
    }
}

#[test]
fn a_start_on_which_branches_cross_is_told_where_nothing_names_one() {
    let outcome = study(&weighed("coupler.angle: ~0 deg, right.angle: ~0 deg"), "rest", Coordinates::Joint);
    assert!(tells(&outcome, "change-point"), "{:?}", outcome.findings);
    let modes = study(&weighed("coupler.angle: ~0 deg, right.angle: ~0 deg"), "at-rest", Coordinates::Joint);
    assert!(tells(&modes, "change-point"), "{:?}", modes.findings);
}

#[test]
fn reactions_that_round_off_decides_on_are_told() {
    for from_singular in [0.3, 0.1, 1e-2, 1e-3, 1e-4, 3e-5, 1e-5, 1e-6, 1e-7] {
        let text = near::equal_arms(from_singular).replace("O.omega: 1 rad/s", "O.omega: ~0 rad/s").replace(
            "studies:\n",
            "drivers: { d: { joint: O, speed: 0 rad/s } }\nstudies:\n  rest: { statics: { from: start }, columns: [S.fy] }\n",
        );
        let outcome = study(&text, "rest", Coordinates::Joint);
        let angle = FRAC_PI_2 - from_singular;
        let right = 4.0 * 9.81 - 100.0 * angle / angle.cos();
        let off = (outcome.rows[0][0] / right - 1.0).abs();
        assert!(off < 1e-5 || tells(&outcome, "nearly-singular"), "at {from_singular:e}: {off:e} off in silence");
        // digits that are open, whether this position has them or not: 1e-16 of the position by its distance, and that by the distance again
        if !(1e-6..1e-3).contains(&from_singular) {
            assert_eq!(tells(&outcome, "nearly-singular"), from_singular < 1e-6, "at {from_singular:e}: {:?}", outcome.findings);
        }
    }
}
