//! Systems whose map is known in closed form.

use super::{FLOQUET, MAX, MEAN, MIN, PERIOD, list, multipliers, near, regime, told};
use std::f64::consts::{PI, TAU};

/// A damped mass on a spring, driven by a force of the circular frequency 3 rad/s.
fn oscillator(extra: &str) -> String {
    format!(
        "grashof: 1
name: driven oscillator
space: planar
gravity: none
parameters: {{ omega: 3 rad/s }}
bodies: {{ mass: {{ mass: 2 kg }} }}
joints: {{ S: {{ slider: [ground, mass.origin], axis: [1, 0], damping: 0.8 N s/m }} }}
springs: {{ spring: {{ joint: S, stiffness: 10 N/m }} }}
loads: {{ push: {{ joint: S, force: 5 N*cos(omega*t) }} }}
start: {{ S.position: 0 m, S.velocity: 0 m/s }}
measures: {{ x: S.position, v: S.velocity }}
studies:
  regime:
    periodic: {{ over: t, by: 2*pi/omega, of: x{extra} }}
    columns: [time, x, v]
    scalars: {{ mean_square: mean(x^2), whole: integral(1) }}
"
    )
}

#[test]
fn a_driven_oscillator_has_its_amplitude_and_exponents() {
    let (m, c, k, w, f) = (2.0, 0.8, 10.0, 3.0_f64, 5.0);
    let amplitude = f / (k - m * w * w).hypot(c * w);
    for extra in ["", ", settle: 0 s", ", settle: 4 s", ", coordinates: cartesian", ", samples: 50, tolerance: 1e-11"] {
        let found = regime(&oscillator(extra));
        near("period", found.results[PERIOD], TAU / w, 1e-12);
        near("mean", found.results[MEAN], 0.0, 1e-10);
        near("max", found.results[MAX], amplitude, 1e-9);
        near("min", found.results[MIN], -amplitude, 1e-9);
        near("mean square", found.scalars[0], 0.5 * amplitude * amplitude, 1e-9);
        near("length", found.scalars[1], TAU / w, 1e-12);
        // e^{λT}, λ = −c/2m ± i sqrt(k/m − (c/2m)²)
        let (decay, turn) = (c / (2.0 * m), (k / m - (c / (2.0 * m)).powi(2)).sqrt() * TAU / w);
        let modulus = (-decay * TAU / w).exp();
        near("floquet", found.results[FLOQUET], modulus, 1e-10);
        for [re, im] in multipliers(&found) {
            near("real part", re, modulus * turn.cos(), 1e-10);
            near("imaginary part", im.abs(), (modulus * turn.sin()).abs(), 1e-10);
        }
        assert!(list(&found, "closure")[0] < 1e-9);
        told(&found, "stable-regime");
    }
}

/// A mass on a spring with an unbalanced rotor and an absorber that is tuned to it: the mass stands still.
#[test]
fn a_tuned_absorber_holds_its_mass_still() {
    let text = |tuning: &str, periodic: &str| {
        format!(
            "grashof: 1
name: tuned absorber
space: planar
gravity: none
bodies: {{ house: {{ mass: 9 kg }}, rotor: {{ mass: 1 kg, com: [1 cm, 0], inertia: 0.02 kg m^2 }}, absorber: {{ mass: 1 kg }} }}
joints:
  Y: {{ slider: [ground, house.origin], axis: [0, 1], damping: 5 N s/m }}
  R: {{ revolute: [house.origin, rotor.origin] }}
  Z: {{ slider: [house.origin, absorber.origin], axis: [0, 1] }}
springs: {{ mount: {{ joint: Y, stiffness: 2000 N/m }}, tuned: {{ joint: Z, stiffness: {tuning} }} }}
drivers: {{ spin: {{ joint: R, speed: 10 rad/s }} }}
start: {{ Y.position: 0 m, Y.velocity: 0 m/s, Z.position: 0 m, Z.velocity: 0 m/s, R.angle: 0 deg }}
studies:
  regime: {{ periodic: {{ {periodic} }} }}
"
        )
    };
    for settle in [", settle: 0 s", ""] {
        let found = regime(&text("100 N/m", &format!("over: R.angle, by: 1 turn, of: Z.position{settle}")));
        near("amplitude of the absorber", found.results[MAX], 0.01, 1e-9);
        near("amplitude of the absorber", found.results[MIN], -0.01, 1e-9);
        told(&found, "stable-regime");
        let still = regime(&text("100 N/m", &format!("over: t, by: 2*pi/(10 rad/s), of: Y.position{settle}")));
        near("the mass", still.results[MAX], 0.0, 1e-9);
        told(&still, "stable-regime");
    }
    // beside the tuning: amplitudes by the complex stiffnesses of both
    let found = regime(&text("101 N/m", "over: t, by: 2*pi/(10 rad/s), of: Z.position, settle: 0 s"));
    let (k, square) = (101.0_f64, 100.0_f64);
    let house = 0.01 * square / (2000.0 - 10.0 * square - square * k / (k - square)).hypot(5.0 * 10.0);
    near("amplitude of the absorber", found.results[MAX], house * square / (k - square), 1e-9);
}

/// An oscillator of 10 kg, 1000 N/m and 0.05 N·s/m settles by 0.1 % a period.
#[test]
fn what_settles_slowly_is_found_without_waiting_for_it() {
    let text = "grashof: 1
name: slow
space: planar
gravity: none
bodies: { mass: { mass: 10 kg } }
joints: { S: { slider: [ground, mass.origin], axis: [1, 0], damping: 0.05 N s/m } }
springs: { spring: { joint: S, stiffness: 1000 N/m } }
loads: { push: { joint: S, force: 1 N*sin(12 rad/s*t) } }
start: { S.position: 0 m, S.velocity: 0 m/s }
studies: { regime: { periodic: { over: t, by: 2*pi/(12 rad/s), of: S.position } } }
";
    let found = regime(text);
    near("amplitude", found.results[MAX], 1.0 / (1000.0 - 1440.0_f64).hypot(0.05 * 12.0), 1e-9);
    near("floquet", found.results[FLOQUET], (-0.0025 * TAU / 12.0_f64).exp(), 1e-9);
    told(&found, "stable-regime");
    assert_eq!(list(&found, "periods_run"), [1000.0]);
}

#[test]
fn a_rotor_under_constant_torque_settles_by_its_damping() {
    let text = "grashof: 1
name: rotor
space: planar
gravity: none
bodies: { rotor: { mass: 1 kg, inertia: 0.5 kg m^2 } }
joints: { O: { revolute: [ground, rotor.origin], damping: 0.3 N m s/rad } }
loads: { drive: { joint: O, torque: 3 N m } }
start: { O.angle: 0.4 rad, O.omega: 1 rad/s }
studies:
  regime:
    periodic: { over: O.angle, by: 1 turn, of: O.omega }
    columns: [O.angle, time, O.omega]
    scalars: { by_angle: mean(time) }
";
    let found = regime(text);
    let omega: f64 = 3.0 / 0.3;
    near("period", found.results[PERIOD], TAU / omega, 1e-11);
    near("mean", found.results[MEAN], omega, 1e-9);
    near("floquet", found.results[FLOQUET], (-0.3 / 0.5 * TAU / omega).exp(), 1e-10);
    assert_eq!(multipliers(&found).len(), 1);
    near("mean of the time over the angle", found.scalars[0], 0.5 * TAU / omega, 1e-9);
    assert_eq!(found.independent, "O.angle");
    assert_eq!(found.places.len(), 361);
    near("first place", found.places[0], 0.4, 1e-12);
    near("last place", found.places[360], 0.4 + TAU, 1e-12);
    for (place, row) in found.places.iter().zip(&found.rows) {
        near("the angle of a row", row[0], *place, 1e-11);
    }
    let wound = regime(&text.replace("space: planar", "space: spatial").replace("inertia: 0.5 kg m^2", "inertia: [0.4, 0.4, 0.5]"));
    near("in space", wound.results[FLOQUET], found.results[FLOQUET], 1e-11);
    let turned = regime(&text.replace("torque: 3", "torque: -3").replace("by: 1 turn", "by: -1 turn"));
    near("the other way", turned.results[MEAN], -omega, 1e-9);
    near("its last place", turned.places[360], 0.4 - TAU, 1e-12);
}

/// The characteristic values of Mathieu's equation for q = 1 by the recurrences of its Fourier coefficients (NIST Digital Library of
/// Mathematical Functions, 28.4.5 to 28.4.8), each with the trace of the map of a period π that belongs to it: the edges of its
/// stability chart.
fn edges() -> Vec<(f64, f64)> {
    const N: usize = 14;
    let lowest = |first: f64, coupling: f64, order: fn(usize) -> usize| {
        let matrix = nalgebra::DMatrix::from_fn(N, N, |i, j| match i.abs_diff(j) {
            0 if i == 0 => first,
            0 => (order(i) * order(i)) as f64,
            1 if i.min(j) == 0 => coupling,
            1 => 1.0,
            _ => 0.0,
        });
        let mut values: Vec<f64> = matrix.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        values
    };
    // a₀, a₂; b₂; a₁; b₁
    let even = lowest(0.0, 2.0_f64.sqrt(), |i| 2 * i);
    let odd = lowest(4.0, 1.0, |i| 2 * i + 2);
    let (a1, b1) = (lowest(2.0, 1.0, |i| 2 * i + 1), lowest(0.0, 1.0, |i| 2 * i + 1));
    vec![(even[0], 2.0), (even[1], 2.0), (odd[0], 2.0), (a1[0], -2.0), (b1[0], -2.0)]
}

/// A pendulum whose pivot moves by Y cos 2t obeys Mathieu's equation x'' + (a − 2q cos 2t) x = 0 near its lowest position, with
/// a = g/l and 2q = −4Y/l.
#[test]
fn a_pendulum_on_a_shaken_pivot_keeps_to_the_chart_of_mathieu() {
    let text = |a: f64| {
        format!(
            "grashof: 1
name: shaken pendulum
space: planar
gravity: [0, {} m/s^2]
bodies: {{ block: {{ mass: 1 kg }}, arm: {{ bar: {{ length: 1 m }}, attached: {{ bob: {{ at: end, mass: 1 kg }} }} }} }}
joints: {{ S: {{ slider: [ground, block.origin], axis: [0, 1] }}, P: {{ revolute: [block.origin, arm.start] }} }}
drivers: {{ shake: {{ joint: S, position: 0.5 m*cos(2 rad/s*t) }} }}
start: {{ S.position: 0.5 m, P.angle: -90 deg, P.omega: 0 rad/s }}
studies: {{ regime: {{ periodic: {{ over: t, by: pi*1 s, of: P.omega, settle: 0 s }}, columns: [time, P.angle] }} }}
",
            -a
        )
    };
    for (a, trace) in edges() {
        let found = regime(&text(a));
        near("period", found.results[PERIOD], PI, 1e-14);
        let m = multipliers(&found);
        near(&format!("trace for a = {a}"), m.iter().map(|m| m[0]).sum(), trace, 1e-9);
        // no damping: the area is kept (Liouville); two that meet carry the root of their error
        near("determinant", m[0][0] * m[1][0] - m[0][1] * m[1][1], 1.0, 1e-9);
    }
    // inside of a tongue the pendulum leaves its position, between two of them it does not
    told(&regime(&text(1.0)), "unstable-regime");
    told(&regime(&text(3.0)), "neutral-regime");
}

/// A linear filter behind a driven quantity: its multiplier is e^{−T/τ}, and a mechanism without freedom has no other.
#[test]
fn a_driven_crank_with_a_filter_has_the_multiplier_of_the_filter() {
    let text = "grashof: 1
name: crank with an instrument
space: planar
gravity: none
bodies: { crank: { bar: { length: 10 cm, mass: 1 kg } } }
joints: { O: { revolute: [ground, crank.start] } }
drivers: { drive: { joint: O, speed: 120 rpm } }
states: { reading: { start: 0 m, rate: (crank.end.y - reading)/80 ms } }
studies:
  regime: { periodic: { over: O.angle, by: 1 turn, of: reading } }
";
    let found = regime(text);
    let (period, w) = (0.5, 2.0 * TAU);
    near("period", found.results[PERIOD], period, 1e-12);
    near("floquet", found.results[FLOQUET], (-period / 0.08_f64).exp(), 1e-11);
    near("amplitude", found.results[MAX], 0.1 / 1f64.hypot(w * 0.08), 1e-10);
    assert_eq!(found.independent, "O.angle");
}
