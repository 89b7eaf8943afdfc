//! Loads that jump with the period, also where it begins and ends.

use super::{multipliers, near, regime};
use crate::common::study;
use grashof::mechanism::Coordinates;
use std::f64::consts::TAU;

/// Mass, damping and stiffness, kg, N s/m, N/m.
const OSCILLATOR: [f64; 3] = [2.432, 0.664, 47.503];

/// A damped mass on a spring under a load: its regime and a run of `periods` from rest.
fn driven(load: &str, by: &str, periods: f64) -> String {
    let [m, c, k] = OSCILLATOR;
    format!(
        "grashof: 1
name: loads that jump
space: planar
gravity: none
bodies: {{ mass: {{ mass: {m} kg }} }}
joints: {{ S: {{ slider: [ground, mass.origin], axis: [1, 0], damping: {c} N s/m }} }}
springs: {{ spring: {{ joint: S, stiffness: {k} N/m }} }}
loads: {{ push: {{ joint: S, force: \"{load}\" }} }}
studies:
  regime: {{ periodic: {{ over: t, by: {by}, of: S.position }}, columns: [S.position, S.velocity] }}
  run: {{ dynamics: {{ until: {periods}*{by}, tolerance: 1e-11 }}, columns: [S.position, S.velocity] }}
"
    )
}

/// Frequencies whose periods round to both sides, and cycles that jump inside, at the end, and at both.
#[test]
fn regimes_of_loads_that_jump_where_the_period_ends() {
    let [m, c, k] = OSCILLATOR;
    for omega in [5.3, 7.852, 8.2, 11.31, 4.7] {
        let period = TAU / omega;
        let loads = [
            format!("5 N*sign(sin({omega} rad/s*t))"),
            format!("if(sin({omega} rad/s*t) > 0, 5 N, -2 N)"),
            format!("if(mod(t, {period} s) < {} s, 5 N, 0 N)", 0.3 * period),
            format!("if(mod(t + {} s, {period} s) < {} s, 5 N, 0 N)", 0.3 * period, 0.3 * period),
            format!("5 N*mod(t, {period} s)/{period} s"),
            format!("1 N*floor(4*mod(t, {period} s)/{period} s)"),
            format!("5 N*abs(sin({} rad/s*t))", 0.5 * omega),
        ];
        // so many that what is left of the start is 1e-10
        let periods = (23.0 * 2.0 * m / c / period).ceil();
        let (decay, turn) = (c / (2.0 * m), (k / m - (c / (2.0 * m)).powi(2)).sqrt() * period);
        let modulus = (-decay * period).exp();
        for (load, by) in loads.iter().flat_map(|load| [(load, format!("2*pi/({omega} rad/s)")), (load, format!("{period} s"))]) {
            let text = driven(load, &by, periods);
            let found = regime(&text);
            let run = study(&text, "run", Coordinates::Joint);
            let place = format!("{load} by {by}");
            let (first, last) = (found.rows.iter().next().expect("a row"), run.rows.last().expect("a row"));
            near(&format!("position, {place}"), first[0], last[0], 1e-8);
            near(&format!("velocity, {place}"), first[1], last[1], 1e-8);
            for [re, im] in multipliers(&found) {
                near(&format!("real part, {place}"), re, modulus * turn.cos(), 1e-9);
                near(&format!("imaginary part, {place}"), im.abs(), (modulus * turn.sin()).abs(), 1e-9);
            }
        }
    }
}
