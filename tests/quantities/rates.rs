//! Rates of rotation of a body in the axes of the world and in its own.

use super::{Columns, near};
use grashof::mechanism::Coordinates;

/// A crate that tumbles in air: a torque against each of its own rates.
const CRATE: &str = "
grashof: 1
name: tumbling
space: spatial
gravity: [0, 0, -9.81 m/s^2]
parameters: { drag: 0.02 N m s }
bodies:
  crate: { mass: 2 kg, inertia: [0.02, 0.03, 0.045] }
loads:
  air: { at: crate.origin, torque: [-drag*crate.wx_own, -2*drag*crate.wy_own, -3*drag*crate.wz_own], frame: crate }
start:
  crate.rpy: [20 deg, -35 deg, 110 deg]
  crate.wx_own: 0.4 rad/s
  crate.wy_own: 5 rad/s
  crate.wz_own: -0.3 rad/s
studies:
  fly:
    dynamics: { until: 1 s, every: 1 ms, tolerance: 1e-12 }
    columns: [time, crate.wx, crate.wy, crate.wz, crate.alphax, crate.alphay, crate.alphaz, crate.wx_own, crate.wy_own, crate.wz_own,
      crate.alphax_own, crate.alphay_own, crate.alphaz_own, crate.qw, crate.qx, crate.qy, crate.qz]
    scalars: { same: max(abs(rate(crate.wx_own) - crate.alphax_own)), begin: \"value(crate.wy_own, 0 s)\" }
";

const WORLD: [&str; 3] = ["crate.wx", "crate.wy", "crate.wz"];
const OWN: [&str; 3] = ["crate.wx_own", "crate.wy_own", "crate.wz_own"];
const ALPHA: [&str; 3] = ["crate.alphax", "crate.alphay", "crate.alphaz"];
const ALPHA_OWN: [&str; 3] = ["crate.alphax_own", "crate.alphay_own", "crate.alphaz_own"];

#[test]
fn own_rates_are_those_of_the_world_turned_back() {
    let run = Columns::of(CRATE, "fly", Coordinates::Joint);
    let [w, x, y, z] = ["crate.qw", "crate.qx", "crate.qy", "crate.qz"].map(|name| run.get(name));
    for (world, own) in [(WORLD, OWN), (ALPHA, ALPHA_OWN)] {
        let (world, own) = (run.vectors(world), run.vectors(own));
        for i in 0..world.len() {
            let turn = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w[i], x[i], y[i], z[i]));
            let back = turn.inverse() * nalgebra::Vector3::from(world[i]);
            (0..3).for_each(|k| near("turned back by R", own[i][k], back[k], 1e-12));
        }
    }
}

#[test]
fn angular_accelerations_are_differences_of_rates() {
    let run = Columns::of(CRATE, "fly", Coordinates::Joint);
    let h = 1e-3;
    for (rates, accelerations) in [(WORLD, ALPHA), (OWN, ALPHA_OWN)] {
        let (w, alpha) = (run.vectors(rates), run.vectors(accelerations));
        for i in (3..w.len() - 3).step_by(50) {
            for k in 0..3 {
                let by = |n: usize| w[i + n][k] - w[i - n][k];
                near("difference", alpha[i][k], (45.0 * by(1) - 9.0 * by(2) + by(3)) / (60.0 * h), 1e-7);
            }
        }
    }
    assert_eq!(run.outcome.scalars[0], 0.0, "`rate` of a rate in own axes is the acceleration in own axes");
    assert_eq!(run.outcome.scalars[1], 5.0, "a start in own axes");
}

/// I α + ω × I ω = torque, all in the axes of the body, where I is constant.
#[test]
fn own_rates_obey_euler_s_equations() {
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        let run = Columns::of(CRATE, "fly", coordinates);
        let (w, alpha) = (run.vectors(OWN), run.vectors(ALPHA_OWN));
        let i = [0.02, 0.03, 0.045];
        for (w, alpha) in w.iter().zip(&alpha) {
            for k in 0..3 {
                let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                let torque = -0.02 * (k + 1) as f64 * w[k];
                near("Euler", i[k] * alpha[k] + (i[b] - i[a]) * w[a] * w[b], torque, 1e-13);
            }
        }
    }
}

/// α of a driven plane body by closed form.
#[test]
fn planar_rates_are_those_of_the_driver() {
    let text = "
grashof: 1
name: swing
space: planar
gravity: none
bodies: { arm: { bar: { length: 1 m, mass: 1 kg } } }
joints: { O: { revolute: [ground, arm.start] } }
drivers: { drive: { joint: O, angle: 0.5*sin(3 rad/s*t) } }
studies:
  swing: { kinematics: { over: 2 s, samples: 50 }, columns: [time, arm.omega, arm.alpha] }
";
    let run = Columns::of(text, "swing", Coordinates::Joint);
    for (i, t) in run.get("time").into_iter().enumerate() {
        near("omega", run.get("arm.omega")[i], 1.5 * (3.0 * t).cos(), 1e-12);
        near("alpha", run.get("arm.alpha")[i], -4.5 * (3.0 * t).sin(), 1e-12);
    }
}
