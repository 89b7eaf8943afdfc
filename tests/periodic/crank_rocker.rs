//! The crank-rocker under its motor, whose load ends in a jump.

use super::{FLOQUET, MEAN, PERIOD, derivative, end, list, near, regime};

const MODEL: &str = include_str!("../../models/crank_rocker.yaml");

/// The model with a study in the place of its own ones, and a start at any speed of the crank that ends after a turn.
fn model(study: &str, omega: f64) -> String {
    let (before, _) = MODEL.split_once("\nstudies:\n").expect("studies");
    let lap = format!(
        "\nvariants:\n  lap: {{ start: {{ O.omega: {omega:?} rad/s }}, events: {{ turn: {{ when: theta - 1 turn, crossing: rising, action: stop }} }} }}"
    );
    format!("{}\nstudies:\n  {study}\n", before.replacen("\nvariants:", &lap, 1))
}

#[test]
fn multiplier_is_the_slope_of_the_return_map() {
    for flywheel in ["0", "27.84", "400"] {
        let study = format!(
            "regime: {{ variant: motor, set: {{ I_f: {flywheel} kg m^2 }}, periodic: {{ over: theta, by: 1 turn, of: omega }}, columns: [theta, time, omega] }}"
        );
        let found = regime(&model(&study, 0.0));
        let omega = found.rows[0][2];
        let lap = format!(
            "lap: {{ variant: [motor, lap], set: {{ I_f: {flywheel} kg m^2 }}, dynamics: {{ until: 2 s, tolerance: 1e-13 }}, columns: [omega] }}"
        );
        let map = |x: &[f64]| end(&model(&lap, x[0]));
        near("speed a turn later", map(&[omega])[0], omega, 1e-9);
        let slope = derivative(map, &[omega], &[5e-3])[(0, 0)];
        near("multiplier", found.results[FLOQUET], slope.abs(), 1e-8);
        near("closure", list(&found, "closure")[0], 0.0, 1e-9);
        assert!(list(&found, "newton_steps")[0] <= 8.0);
    }
}

#[test]
fn the_regime_is_the_same_in_other_coordinates() {
    let study = |extra: &str| {
        format!("regime: {{ variant: motor, periodic: {{ over: theta, by: 1 turn, of: omega{extra} }}, columns: [theta, omega] }}")
    };
    let joint = regime(&model(&study(""), 0.0));
    let cartesian = regime(&model(&study(", coordinates: cartesian"), 0.0));
    for which in 0..5 {
        near("result", cartesian.results[which], joint.results[which], 3e-9 * joint.results[which].abs());
    }
}

#[test]
fn a_long_run_comes_to_the_regime() {
    let study =
        "regime: { variant: motor, set: { gear: 73/48 }, periodic: { over: theta, by: 1 turn, of: omega }, columns: [theta, omega] }";
    let found = regime(&model(study, 0.0));
    let lap = "lap: { variant: motor, set: { gear: 73/48 }, events: null, dynamics: { until: 40 s, every: 40 s, tolerance: 1e-11 }, columns: [theta, omega] }".replace(" events: null,", "");
    let last = end(&model(&lap, 0.0));
    // the speed at the angle where the run has ended
    let angle = last[0].rem_euclid(std::f64::consts::TAU);
    let k = found.places.partition_point(|p| *p < angle);
    let (a, b) = (&found.rows[k - 1], &found.rows[k]);
    let between = a[1] + (b[1] - a[1]) * (angle - a[0]) / (b[0] - a[0]);
    near("speed", between, last[1], 2e-3);
    assert!(found.results[MEAN] * found.results[PERIOD] > 6.2, "a turn");
}
