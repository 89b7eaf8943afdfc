//! Starts just beside a change point, where rows are nearly dependent: motion, reactions and eigenvalues are those of the branch.
//!
//! The parallelogram 2-1-2 of 1, 2 and 3 kg at rest at the angle ε, with springs of 100 and 150 N m/rad on its cranks. All turn alike, and
//! the coupler only shifts:
//!
//! ```text
//! (4/3 + 8 + 4) ε̈ = −8 g cos ε − 250 ε,   ω² ≈ 250/(40/3)
//! ```
//!
//! The coupler's weight comes evenly upon both cranks, F_y = −g − 2 ε̈ cos ε each at rest, and the force along it is what the right crank lacks:
//! 4 ε̈ = −3 g cos ε − 150 ε + 2 (F_y cos ε − F_x sin ε).

use super::told;
use crate::common::{as_far_as_it_goes, study};
use grashof::mechanism::Coordinates;

fn parallelogram(angle: f64) -> String {
    told::parallelogram(&format!("{angle:e} rad"))
        .replace("gravity: none", "gravity: [0, -9.81 m/s^2]")
        .replace("  k2: { joint: B0, stiffness: 70 N m/rad }\n", "")
        .replace(
            "studies:\n",
            "studies:\n  fall: { dynamics: { until: 1e-5 s, every: 1e-5 s }, columns: [A0.alpha, coupler.alpha, B1.fx, B1.fy] }\n",
        )
}

#[test]
fn motion_and_forces_beside_a_change_point_are_those_of_the_branch() {
    // what a position is off comes over as its part of the angle
    for (coordinates, nearest, off) in [(Coordinates::Joint, 1e-7, 1e-8), (Coordinates::Cartesian, 1e-6, 1e-3)] {
        for angle in [1e-3, 1e-4, 1e-5, 3e-6, 1e-6, 1e-7].into_iter().filter(|angle| *angle >= nearest) {
            let outcome = study(&parallelogram(angle), "fall", coordinates);
            let (sin, cos) = angle.sin_cos();
            let alpha = -(8.0 * 9.81 * cos + 250.0 * angle) / (40.0 / 3.0);
            let across = -9.81 - 2.0 * alpha * cos;
            let along = (2.0 * across * cos - 3.0 * 9.81 * cos - 150.0 * angle - 4.0 * alpha) / (2.0 * sin);
            for (found, right) in outcome.rows[0].iter().zip([alpha, 0.0, along, across]) {
                let error = (found - right).abs() / right.abs().max(1.0);
                assert!(error < off, "{coordinates:?}, {angle:e}: {found} is {error:e} off {right}");
            }
        }
    }
}

#[test]
fn eigenvalues_beside_a_change_point_are_those_of_the_branch() {
    for angle in [1e-3, 1e-5, 1e-6, 3e-7] {
        let outcome = study(&parallelogram(angle), "linear", Coordinates::Joint);
        let poles = &outcome.lists.iter().find(|list| list.name == "poles_imaginary").expect("poles").values;
        let right = (250.0f64 / (40.0 / 3.0)).sqrt();
        assert!(poles.len() == 2 && poles.iter().all(|pole| (pole.abs() / right - 1.0).abs() < 1e-3), "{angle:e}: {poles:?}");
    }
}

/// However near a start is, and whatever the coordinates: constraints stay closed, or a motion that is none is told.
#[test]
fn no_linkage_is_taken_apart_in_silence() {
    for coordinates in ["joint", "cartesian", "minimal"] {
        for angle in [1e-5, 1e-7, 1e-8, 2e-9, 1e-9, 3e-10] {
            let text = parallelogram(angle).replace("1e-5 s, every: 1e-5 s", &format!("0.1 s, every: 0.02 s, coordinates: {coordinates}"));
            let outcome = as_far_as_it_goes(&text, "fall", Coordinates::Joint);
            let open = outcome.certificate.constraint;
            let told = outcome.stopped.is_some() || outcome.findings.iter().any(|f| f.code == "open-constraints");
            assert!(open < 1e-4 || told, "{coordinates}, {angle:e}: open by {open:e}");
        }
    }
}
