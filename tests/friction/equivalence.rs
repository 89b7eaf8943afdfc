//! Coordinates, spaces and schemes agree; energies balance; tangents are derivatives.

use super::{close, done, drift, last};
use crate::common::{Noise, State, mechanism, slope};
use grashof::dynamics::{Differentiable, Dynamics, Linearizer, Point, friction_pattern};
use grashof::geometry::{Planar, Space, Spatial};
use grashof::mechanism::Coordinates;
use grashof_solvers::{Block, Tangent};

/// A slider-crank with friction in its guide and in the pin of its rod.
fn slider_crank(space: &str, guide: &str, driver: &str, study: &str) -> String {
    let (zero, axis) = if space == "planar" { ("", "") } else { (", 0", ", axis: [0, 0, 1]") };
    let slide = if space == "planar" { "[1, 0]" } else { "[1, 0, 0]" };
    // in space the rod has a ball at one end and a universal joint at the other, so that no row is redundant
    let (a, b) = if space == "planar" {
        (
            "revolute: [crank.end, rod.start], friction: { coulomb: 0.15, radius: 1 cm }".to_string(),
            "revolute: [rod.end, piston.origin]".to_string(),
        )
    } else {
        (
            "revolute: [crank.end, rod.start], axis: [0, 0, 1], friction: { coulomb: 0.15, radius: 1 cm }".to_string(),
            "spherical: [rod.end, piston.origin]".to_string(),
        )
    };
    let inertia = if space == "planar" { "1e-3 kg m^2" } else { "[1e-3 kg m^2, 1e-3 kg m^2, 1e-3 kg m^2]" };
    format!(
        "grashof: 1
name: slider-crank with friction
space: {space}
gravity: [0, -9.81 m/s^2{zero}]
ground: {{ O: [0, 0{zero}] }}
bodies:
  crank: {{ bar: {{ length: 10 cm, mass: 0.4 kg }} }}
  rod: {{ bar: {{ length: 30 cm, mass: 0.6 kg }} }}
  piston: {{ mass: 0.5 kg, inertia: {inertia} }}
joints:
  O: {{ revolute: [ground.O, crank.start]{axis}, damping: 0.002 N m s/rad }}
  A: {{ {a} }}
  B: {{ {b} }}
  W: {{ slider: [ground.O, piston.origin], axis: {slide}, friction: {{ coulomb: 0.2, stick_speed: 1 cm/s{guide} }} }}
{driver}
start: {{ O.angle: 20 deg, {speed}W.position: ~39 cm{rod} }}
studies:
  turn: {{ {study}, columns: [time, O.angle, O.omega, W.position, W.f, W.friction, A.friction, O.f] }}
",
        speed = if driver.is_empty() { "O.omega: 25 rad/s, " } else { "" },
        rod = if space == "planar" { ", rod.angle: ~-7 deg" } else { ", A.angle: ~-27 deg" },
    )
}

#[test]
fn coordinates_and_schemes_agree_on_a_slider_crank_with_friction() {
    let of =
        |settings: &str| done(&slider_crank("planar", "", "", &format!("dynamics: {{ until: 0.3 s, every: 20 ms, {settings} }}")), "turn");
    let reference = of("integrator: dop853, tolerance: 1e-11");
    assert!(drift(&reference) < 1e-8, "{}", drift(&reference));
    for (settings, tolerance) in [
        ("integrator: dop853, tolerance: 1e-10, coordinates: cartesian", 1e-7),
        ("integrator: dop853, tolerance: 1e-10, coordinates: minimal", 1e-7),
        ("tolerance: 1e-9", 1e-6),
        ("integrator: radau5, tolerance: 1e-9", 1e-6),
        ("integrator: radau5, tolerance: 1e-8, coordinates: minimal", 1e-5),
        ("integrator: bdf, tolerance: 1e-8", 1e-4),
        ("integrator: rk4, step: 0.5 ms", 1e-5),
        ("integrator: central-difference, step: 0.25 ms", 1e-3),
        ("integrator: newmark, step: 0.25 ms", 1e-3),
        ("integrator: generalized-alpha, rho: 0.9, step: 0.25 ms, level: position, coordinates: cartesian", 1e-3),
    ] {
        let other = of(settings);
        for (k, (found, right)) in last(&other).iter().zip(last(&reference)).enumerate() {
            close(&format!("column {k}, {settings}"), *found, *right, tolerance * right.abs().max(1.0));
        }
        let energy = if settings.contains("step") { 1e-4 } else { 1e-6 };
        assert!(drift(&other) < energy, "{settings}: {}", drift(&other));
    }
}

#[test]
fn the_plane_is_a_plane_in_space() {
    for guide in ["", ", length: 8 cm"] {
        let of = |space: &str| done(&slider_crank(space, guide, "", "dynamics: { until: 0.2 s, every: 10 ms, tolerance: 1e-10 }"), "turn");
        let (planar, spatial) = (of("planar"), of("spatial"));
        for (found, right) in last(&spatial).iter().zip(last(&planar)) {
            close(guide, *found, *right, 1e-6 * right.abs().max(1.0));
        }
    }
}

#[test]
fn inverse_dynamics_asks_for_what_motion_in_time_needs() {
    // the same driven motion, once by inverse dynamics and once in time
    let driver = "drivers: { drive: { joint: O, speed: 120 rpm } }";
    let of = |study: &str| done(&slider_crank("planar", ", length: 8 cm", driver, study).replace("O.f]", "O.f, drive.torque]"), "turn");
    let inverse = of("inverse: { over: 0.5 s, samples: 50 }");
    let forward = of("dynamics: { until: 0.5 s, every: 10 ms, tolerance: 1e-11 }");
    let at = |outcome: &grashof::studies::common::outcome::Outcome, t: f64| {
        outcome.rows.iter().find(|r| (r[0] - t).abs() < 1e-9).expect("a row").to_vec()
    };
    for t in [0.1, 0.2, 0.3, 0.45] {
        for (k, (found, right)) in at(&inverse, t).iter().zip(at(&forward, t)).enumerate() {
            close(&format!("column {k} at {t} s"), *found, right, 1e-6 * right.abs().max(1.0));
        }
    }
    assert!(inverse.switches.len() > 2, "the sides on which the guide presses are located");
    assert!(inverse.certificate.power_balance < 1e-9);
}

/// r(q ⊕ δ, v, λ) and its derivatives of a mechanism, against differences.
fn tangents<G>(text: &str)
where
    G: Space<S = f64>,
{
    let m: Differentiable<G> = Differentiable::new(mechanism(text, Coordinates::Joint));
    let (nv, rows, nz) = (m.nv, m.rows.len(), m.state_starts.len());
    for seed in 1..4 {
        let s = State::random(&m, seed);
        let mut modes = s.modes.clone();
        modes.iter_mut().enumerate().for_each(|(i, mode)| *mode = if (seed as usize + i).is_multiple_of(2) { 1 } else { -1 });
        let z = Noise(seed).vector(nz);
        let mut d = Dynamics::new(&m);
        d.work.z.copy_from_slice(&z);
        let mut residual = |q: &[f64], v: &[f64], lambda: &[f64]| {
            let mut r = vec![0.0; nv];
            d.terms(s.t, q, v, &modes);
            d.residual(&s.a, lambda, &mut r);
            r
        };
        let mut linearizer = Linearizer::new(&m);
        let mut tangent = Tangent::new(&linearizer.pattern(nz));
        linearizer.tangents(&Point { t: s.t, q: &s.q, v: &s.v, z: &z, a: &s.a, lambda: &s.lambda, modes: &modes }, &mut tangent);
        for k in 0..nv {
            let unit = |e: f64| (0..nv).map(|i| if i == k { e } else { 0.0 }).collect::<Vec<_>>();
            let by_q = slope(1e-5, |e| {
                let mut q = s.q.clone();
                m.retract(&mut q, &unit(e));
                residual(&q, &s.v, &s.lambda)
            });
            let by_v = slope(1e-5, |e| residual(&s.q, &s.v.iter().zip(unit(e)).map(|(v, d)| v + d).collect::<Vec<_>>(), &s.lambda));
            for i in 0..nv {
                close("K", tangent.k.at(i, k), by_q[i], 1e-6 * (1.0 + by_q[i].abs()));
                close("C", tangent.c.at(i, k), by_v[i], 1e-6 * (1.0 + by_v[i].abs()));
            }
        }
        let (mut force, mut by_lambda) = (vec![0.0; nv], Block::new(&friction_pattern(&m)));
        let g: Vec<Vec<f64>> = (0..rows)
            .map(|j| {
                slope(1e-5, |e| {
                    residual(&s.q, &s.v, &s.lambda.iter().enumerate().map(|(i, l)| l + if i == j { e } else { 0.0 }).collect::<Vec<_>>())
                })
            })
            .collect();
        d.terms(s.t, &s.q, &s.v, &modes);
        d.friction(&s.lambda, &mut force, &mut by_lambda);
        for (j, g) in g.iter().enumerate() {
            for (i, g) in g.iter().enumerate() {
                close("R_λ", d.work.g.at(j, i) + by_lambda.at(i, j), *g, 1e-6 * (1.0 + g.abs()));
            }
        }
        assert!(by_lambda.values().iter().any(|x| x.abs() > 1e-3), "the friction depends on the reactions");
    }
}

#[test]
fn tangents_of_friction_by_reactions_are_its_derivatives() {
    let study = "dynamics: { until: 1 s }";
    for guide in ["", ", length: 8 cm"] {
        tangents::<Planar<f64>>(&slider_crank("planar", guide, "", study));
        tangents::<Spatial<f64>>(&slider_crank("spatial", guide, "", study));
    }
    let bristle = ", static: 0.3, stribeck_speed: 1 m/s, bristle: { stiffness: 50, damping: 0.1 }";
    tangents::<Planar<f64>>(&slider_crank("planar", bristle, "", study).replace(", stick_speed: 1 cm/s", ""));
}

/// A block on a belt with friction by a load sticks in a zone of speeds about as narrow as the tolerance, in steps that are a hundred
/// thousand times as long as the time of that force: it slips, in a step of `radau5`, where it slips in the short ones of `bdf`.
#[test]
fn long_steps_of_radau5_in_narrow_zones_end_where_short_ones_of_bdf_do() {
    let block = |[stiffness, stick]: [f64; 2], integrator: &str, tolerance: f64| {
        format!(
            "grashof: 1
name: block on a belt
space: planar
gravity: none
bodies: {{ block: {{ mass: 2 kg }} }}
joints: {{ B: {{ slider: [ground, block.origin], axis: [1, 0] }} }}
measures: {{ w: B.velocity - 0.1 m/s }}
springs: {{ k: {{ joint: B, stiffness: {stiffness} N/m }} }}
loads: {{ rub: {{ joint: B, force: \"-(4 N + 4 N*exp(-abs(w)/(0.05 m/s)))*clamp(w/({stick:e} m/s), -1, 1)\" }} }}
start: {{ B.position: 0, B.velocity: 0.1 m/s }}
studies:
  run: {{ dynamics: {{ until: 3 s, integrator: {integrator}, tolerance: {tolerance:e} }}, columns: [time, B.position] }}
"
        )
    };
    for (model, tolerance) in [
        ([216.6, 6.7e-7], 1.8e-7),
        ([415.1, 1.25e-6], 2.1e-7),
        ([391.8, 2.7e-6], 1.5e-8),
        ([126.1, 8e-7], 2.6e-7),
        ([484.6, 4.1e-6], 5.1e-7),
        ([377.8, 9.8e-6], 1.1e-6),
        ([320.0, 5e-5], 1e-9),
    ] {
        let outcome = done(&block(model, "radau5", tolerance), "run");
        let right = last(&done(&block(model, "bdf", 0.01 * tolerance), "run"))[1];
        close(&format!("{model:?} at {tolerance:e}"), last(&outcome)[1], right, 3.0 * tolerance);
        let unbalanced = outcome.findings.iter().any(|finding| finding.code == "energy");
        assert!(!unbalanced, "{model:?} at {tolerance:e}: {:?}", outcome.findings);
    }
}
