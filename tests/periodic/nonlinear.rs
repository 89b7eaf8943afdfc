//! Self-excited and hardening oscillators, spatial motion, a parameter along which a regime is followed.

use super::{FLOQUET, MAX, MIN, PERIOD, end, list, multipliers, near, regime, told};

/// Van der Pol's oscillator x'' = μ (1 − x²) x' − x.
fn van_der_pol(mu: f64, start: &str, extra: &str) -> String {
    format!(
        "grashof: 1
name: van der Pol
space: planar
gravity: none
parameters: {{ mu: {mu} kg/s }}
bodies: {{ mass: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, mass.origin], axis: [1, 0] }} }}
springs: {{ spring: {{ joint: S, stiffness: 1 N/m }} }}
measures: {{ x: S.position, growth: mu*(1 - x^2/1 m^2)/1 kg }}
loads: {{ pump: {{ joint: S, force: growth*1 kg*S.velocity }} }}
start: {{ {start} }}
studies:
  regime:
    periodic: {{ over: t, through: x, of: x{extra} }}
    columns: [time, x, S.velocity]
    scalars: {{ exponent: integral(growth) }}
"
    )
}

#[test]
fn the_oscillation_of_van_der_pol() {
    // for μ = 1 period and amplitude have been computed to many digits (Amore, Boyd & Fernández, J. Math. Phys. 59 (2018)
    // 012702)
    let (period, amplitude) = (6.663_286_859_323_13, 2.008_619_860_874_84);
    let stable = regime(&van_der_pol(1.0, "S.position: 0.1 m, S.velocity: 0 m/s", ""));
    near("period", stable.results[PERIOD], period, 1e-10);
    near("largest", stable.results[MAX], amplitude, 1e-10);
    near("smallest", stable.results[MIN], -amplitude, 1e-10);
    // Liouville: with the trivial multiplier 1 the other one is the determinant
    near("floquet", stable.results[FLOQUET], stable.scalars[0].exp(), 1e-11);
    assert_eq!(multipliers(&stable).len(), 1);
    told(&stable, "stable-regime");
    assert!(list(&stable, "periods_run")[0] >= 2.0);

    // backwards in time the same oscillation repels: x(−t) solves the equation with −μ
    let speed = stable.rows[0][2];
    near("it begins on the surface", stable.rows[0][1], 0.0, 1e-10);
    let start = format!("S.position: 0 m, S.velocity: {} m/s", 0.9998 * speed);
    let unstable = regime(&van_der_pol(-1.0, &start, ", settle: 0 s"));
    near("period", unstable.results[PERIOD], period, 1e-8);
    near("floquet", unstable.results[FLOQUET] * stable.results[FLOQUET], 1.0, 1e-7);
    told(&unstable, "unstable-regime");
    assert_eq!(list(&unstable, "periods_run")[0], 0.0);

    // followed from a weak oscillation to a strong one
    let followed = regime(&van_der_pol(1.0, "S.position: 0.1 m, S.velocity: 0 m/s", ", from: { vary: mu, at: 0.2 kg/s, steps: 4 }"));
    near("followed period", followed.results[PERIOD], period, 1e-10);
}

/// A hardening spring, x'' + 0.1 x' + x + x³ = 0.5 cos ωt, with two stable regimes at ω = 1.6 and one between them.
fn hardening(omega: f64, start: &str, study: &str) -> String {
    format!(
        "grashof: 1
name: hardening spring
space: planar
gravity: none
parameters: {{ omega: {omega} rad/s }}
bodies: {{ mass: {{ mass: 1 kg }} }}
joints: {{ S: {{ slider: [ground, mass.origin], axis: [1, 0], damping: 0.1 N s/m }} }}
springs: {{ spring: {{ joint: S, force: 1 N/m*stretch + 1 N/m^3*stretch^3 }} }}
loads: {{ push: {{ joint: S, force: 0.5 N*cos(omega*t) }} }}
start: {{ {start} }}
measures: {{ x: S.position, v: S.velocity }}
studies:
{study}
"
    )
}

#[test]
fn a_regime_is_followed_to_where_a_run_from_rest_does_not_lead() {
    let rest = "S.position: 0 m, S.velocity: 0 m/s";
    let of = |extra: &str| format!("  regime: {{ periodic: {{ over: t, by: 2*pi/omega, of: x{extra} }}, columns: [time, x, v] }}");
    let low = regime(&hardening(1.6, rest, &of("")));
    let high = regime(&hardening(1.6, rest, &of(", from: { vary: omega, at: 0.6 rad/s, steps: 20 }")));
    assert!(low.results[MAX] < 0.6 && high.results[MAX] > 1.3, "{} and {}", low.results[MAX], high.results[MAX]);
    for found in [&low, &high] {
        told(found, "stable-regime");
        // damping alone decides the determinant
        let m = multipliers(found);
        let determinant = if m[0][1] == 0.0 { m[0][0] * m[1][0] } else { m[0][0].powi(2) + m[0][1].powi(2) };
        near("determinant", determinant, (-0.1 * found.results[PERIOD]).exp(), 1e-10);
        // a run of twenty periods from the regime stays on it
        let row = &found.rows[0];
        let start = format!("S.position: {} m, S.velocity: {} m/s", row[1], row[2]);
        let lap = "  lap: { dynamics: { until: 40*pi/omega, tolerance: 1e-12 }, columns: [x, v] }";
        let last = end(&hardening(1.6, &start, lap));
        near("x after twenty periods", last[0], row[1], 1e-9);
        near("v after twenty periods", last[1], row[2], 1e-9);
    }
}

/// A bar on a ball joint, swung in a plane by a periodic torque, with a torque against its turning; beside the same on a hinge.
#[test]
fn a_bar_on_a_ball_swings_as_on_a_hinge() {
    let text = |joint: &str, axes: &str, kind: &str, push: &str, start: &str| {
        format!(
            "grashof: 1
name: bar
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies: {{ bob: {{ mass: 2 kg, com: [0, 0, -50 cm], inertia: [0.2 kg m^2, 0.2 kg m^2, 0.3 kg m^2] }} }}
joints: {{ P: {{ {kind}: [ground, bob.origin]{axes} }} }}
loads:
  air: {{ at: bob.origin, torque: [-0.9 N m s/rad*bob.wx, -0.9 N m s/rad*bob.wy, -0.9 N m s/rad*bob.wz] }}
  push: {{ at: bob.origin, torque: [0, {push}, 0] }}
{start}
studies:
  regime: {{ periodic: {{ over: t, by: 2 s, of: bob.wy }}, columns: [time, bob.wy, bob.com.x, bob.com.z] }}
# {joint}
"
        )
    };
    let push = "6 N m*sin(pi*1 rad/s*t) + 2 N m*cos(pi*1 rad/s*t)^2";
    let ball = regime(&text("ball", "", "spherical", push, ""));
    let hinge = regime(&text("hinge", ", axis: [0, 1, 0]", "revolute", push, "start: { P.angle: 0 deg, P.omega: 0 rad/s }"));
    for which in [PERIOD, MAX, MIN] {
        near("result", ball.results[which], hinge.results[which], 1e-9);
    }
    let (all, plane) = (multipliers(&ball), multipliers(&hinge));
    assert_eq!((all.len(), plane.len()), (6, 2));
    let distance = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    for m in &plane {
        assert!(all.iter().any(|a| distance(a, m) < 1e-8), "{m:?} of the plane is not in {all:?}");
    }
    // every direction of the push that turns with the bar about the vertical is not there, but area shrinks by the damping:
    // the determinant is exp(−∫ tr M⁻¹C dt), the inertia about the pivot being diagonal in the body
    let about = [0.2 + 2.0 * 0.25, 0.2 + 2.0 * 0.25, 0.3];
    let shrinks = (-2.0 * 0.9 * about.iter().map(|i: &f64| i.recip()).sum::<f64>()).exp();
    let moduli = list(&ball, "multipliers_modulus");
    near("determinant", moduli.iter().map(|m| m.ln()).sum::<f64>(), shrinks.ln(), 1e-7);
}
