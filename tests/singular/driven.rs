//! Minimal coordinates beside rows that time moves, or forces by reactions.

use super::{SCHEMES, end, with_study};

/// Two bars on hinges, the first of which follows a law of time; with friction by the reactions of the second, or without.
fn double(friction: &str) -> String {
    format!(
        "grashof: 1\nname: double pendulum\nspace: planar\ngravity: [0, -9.81 m/s^2]\nbodies:\n\
         \x20 upper: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\n  lower: {{ bar: {{ length: 1 m, mass: 1 kg }} }}\njoints:\n\
         \x20 P: {{ revolute: [ground, upper.start] }}\n  Q: {{ revolute: [upper.end, lower.start]{friction} }}\n\
         drivers: {{ drive: {{ joint: P, angle: 0.5 rad*sin(3 rad/s*t) }} }}\nstart: {{ Q.angle: 0.3 rad, Q.omega: 0 rad/s }}\n"
    )
}

/// A rod on a ball joint whose carriage follows a law of time, held by a link from an arm: one of the turns of the rod depends on the
/// others.
const ROD: &str = "grashof: 1
name: rod on a driven ball joint
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies:
  carriage: { mass: 1 kg }
  rod: { bar: { length: 1 m, width: 10 cm, height: 6 cm, mass: 2 kg } }
  arm: { bar: { length: 50 cm, width: 5 cm, height: 5 cm, mass: 1 kg } }
ground: { R: [0, 0, 0], P: [1.2 m, 0, 0.3 m] }
joints:
  R: { slider: [ground.R, carriage.origin], axis: [0, 1, 0] }
  B: { spherical: [carriage.origin, rod.start] }
  H: { revolute: [ground.P, arm.start], axis: [0, 1, 0] }
  D: { distance: [rod.end, arm.end], length: 40 cm }
drivers: { push: { joint: R, position: 0.2 m*sin(3 rad/s*t) } }
start: { R.position: ~0, H.angle: ~200 deg }
";

/// A four-bar whose crank turns evenly, with a pendulum on its coupler.
const FOUR_BAR: &str = "grashof: 1
name: pendulum on a driven four-bar
space: planar
gravity: [0, -9.81 m/s^2]
bodies:
  crank: { bar: { length: 30 cm, mass: 1 kg } }
  coupler: { bar: { length: 1 m, mass: 1 kg } }
  rocker: { bar: { length: 80 cm, mass: 1 kg } }
  bob: { bar: { length: 40 cm, mass: 2 kg } }
ground: { O: [0, 0], C: [90 cm, 0] }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.start] }
  C: { revolute: [rocker.end, ground.C] }
  H: { revolute: [coupler.end, bob.start] }
drivers: { turn: { joint: O, angle: 1 rad + 5 rad/s*t } }
start: { A.angle: ~0 rad, B.angle: ~-90 deg, H.angle: 10 deg, H.omega: 0 rad/s }
";

#[test]
fn driven_mechanisms_move_alike_in_minimal_and_joint_coordinates() {
    let friction = ", friction: { coulomb: 0.3, radius: 5 cm, stick_speed: 10 mrad/s }";
    let models = [
        (double(""), "Q.angle, Q.omega, lower.end.x", 1.0),
        (double(friction), "Q.angle, Q.omega, lower.end.x", 1.0),
        (ROD.to_owned(), "H.angle, H.omega, rod.end.x, rod.end.y", 0.8),
        (FOUR_BAR.to_owned(), "H.angle, H.omega, bob.end.x, bob.end.y", 1.5),
    ];
    for (text, columns, until) in models {
        let study = |scheme: &str, tolerance: f64, chart: &str| {
            let dynamics = format!("until: {until} s, every: 0.1 s, tolerance: {tolerance:e}, integrator: {scheme}, coordinates: {chart}");
            with_study(&text, &dynamics, columns)
        };
        let (right, _) = end(&study("dop853", 1e-11, "joint"));
        for (scheme, tolerance, off) in SCHEMES {
            let error = ["joint", "minimal"].map(|chart| {
                let (found, _) = end(&study(scheme, tolerance, chart));
                right.iter().zip(&found).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs() / (1.0 + x.abs())))
            });
            println!("{columns} {scheme}: {error:?}");
            // errors of the independent turns reach the others by the chart
            assert!(error[1] < 10.0 * off * tolerance, "{scheme}: {error:?}\n{text}");
        }
    }
}

/// Given steps, whose errors no control hides: closing a loop at another time than that of a stage costs an order.
#[test]
fn schemes_keep_their_order_where_turns_depend_on_driven_rows() {
    let study = |scheme: &str, chart: &str| {
        let dynamics = format!("until: 0.5 s, every: 0.25 s, integrator: {scheme}, coordinates: {chart}");
        with_study(ROD, &dynamics, "H.angle, H.omega, rod.end.x, rod.end.y")
    };
    let (right, _) = end(&study("dop853, tolerance: 1e-12", "joint"));
    for (scheme, order, h) in [
        ("bdf", 2.0, 0.5),
        ("newmark", 2.0, 0.5),
        ("hht", 2.0, 0.5),
        ("generalized-alpha, rho: 0.8", 2.0, 0.5),
        ("central-difference", 2.0, 0.5),
        ("rk4", 4.0, 4.0),
        ("radau5", 5.0, 2.0),
    ] {
        let errors = [h, 0.5 * h].map(|h| {
            let (found, _) = end(&study(&format!("{scheme}, step: {h} ms"), "minimal"));
            right.iter().zip(&found).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()))
        });
        let found = (errors[0] / errors[1]).log2();
        println!("{scheme}: {errors:?} {found}");
        assert!((found - order).abs() < 0.3, "{scheme}: order {found}, {errors:?}");
    }
}
