//! The quick return: crank O2-A, lever O1-B with the pin A on its line, rod B-C, slider C on a line y = height left of B.
//!
//! θ1 is the direction of A from O1, so θ1' = A × A'/|A|²; C follows from the height of B: height = y_B + rod sin θ3,
//! cos θ3 < 0.

use super::plane::{cross, dot};
use std::f64::consts::TAU;

/// What the model file calls its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Parameters {
    pub(crate) crank: f64,
    pub(crate) centre: f64,
    pub(crate) lever: f64,
    pub(crate) rod: f64,
    pub(crate) height: f64,
    pub(crate) speed: f64,
}

impl Default for Parameters {
    fn default() -> Self {
        Self { crank: 5.0, centre: 12.0, lever: 32.0, rod: 16.0, height: 32.0, speed: 1.0 }
    }
}

/// Names of the values of [`row`], without the independent angle and the time.
pub(crate) const COLUMNS: [&str; 9] = ["theta1", "theta3", "omega1", "omega3", "alpha1", "alpha3", "slider.x", "slider.vx", "slider.ax"];

/// The columns at the crank angle `theta`.
pub(crate) fn row(p: &Parameters, theta: f64) -> [f64; COLUMNS.len()] {
    let (sin, cos) = theta.sin_cos();
    let a = [p.crank * cos, p.centre + p.crank * sin];
    let v = [-p.crank * p.speed * sin, p.crank * p.speed * cos];
    let w = [-p.crank * p.speed * p.speed * cos, -p.crank * p.speed * p.speed * sin];
    let s2 = dot(a, a);
    let theta1 = a[1].atan2(a[0]);
    let omega1 = cross(a, v) / s2;
    let alpha1 = (cross(a, w) - 2.0 * dot(a, v) * omega1) / s2;

    let (sin1, cos1) = theta1.sin_cos();
    let vertical = [p.lever * sin1, p.lever * cos1 * omega1, p.lever * (cos1 * alpha1 - sin1 * omega1 * omega1)];
    let horizontal = [p.lever * cos1, -p.lever * sin1 * omega1, -p.lever * (sin1 * alpha1 + cos1 * omega1 * omega1)];
    let sin3 = (p.height - vertical[0]) / p.rod;
    let cos3 = -((1.0 - sin3) * (1.0 + sin3)).sqrt();
    let omega3 = -vertical[1] / (p.rod * cos3);
    let alpha3 = (-vertical[2] / p.rod + sin3 * omega3 * omega3) / cos3;
    [
        theta1,
        // continuous where the rod passes the horizontal
        sin3.atan2(cos3).rem_euclid(TAU),
        omega1,
        omega3,
        alpha1,
        alpha3,
        horizontal[0] + p.rod * cos3,
        horizontal[1] - p.rod * sin3 * omega3,
        horizontal[2] - p.rod * (sin3 * alpha3 + cos3 * omega3 * omega3),
    ]
}

/// Slow over fast stroke: the lever turns where it is tangent to the circle of the pin.
pub(crate) fn time_ratio(p: &Parameters) -> f64 {
    let beta = (p.crank / p.centre).asin();
    (std::f64::consts::PI + 2.0 * beta) / (std::f64::consts::PI - 2.0 * beta)
}
