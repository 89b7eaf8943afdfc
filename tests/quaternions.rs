//! Quaternions of bodies as quantities: columns that do not jump, couplings and stretches made of them, and their rates.

use crate::common;
use grashof::geometry::Spatial;
use grashof::mechanism::Coordinates;
use grashof::studies::common::outcome::Outcome;

fn study(text: &str, name: &str) -> Outcome {
    common::study(text, name, Coordinates::Joint)
}

#[track_caller]
fn same(what: &str, a: &Outcome, b: &Outcome, within: f64) {
    // beside the rows of the grid there are those of switches, which not all coordinates have
    let grid = |o: &Outcome| -> Vec<(f64, Vec<f64>)> {
        let rows = o.places.iter().copied().zip(o.rows.iter().map(<[f64]>::to_vec));
        rows.filter(|(t, _)| (10.0 * t - (10.0 * t).round()).abs() < 1e-9).collect()
    };
    let (a, b) = (grid(a), grid(b));
    assert_eq!((a.len(), b.len()), (21, 21), "{what}");
    for ((t, x), (_, y)) in a.iter().zip(&b) {
        for (k, (x, y)) in x.iter().zip(y).enumerate() {
            assert!((x - y).abs() <= within * (1.0 + y.abs()), "{what}, column {k} at {t}: {x} {y}");
        }
    }
}

/// A body on a point of the ground with what holds it, in a study of its motion.
fn top(held: &str, settings: &str, columns: &str) -> String {
    format!(
        "grashof: 1
name: a body about a point
space: spatial
gravity: [1 m/s^2, -2 m/s^2, -9.81 m/s^2]
bodies: {{ a: {{ mass: 2 kg, inertia: [0.3, 0.2, 0.25, 0.02, -0.01, 0.03], com: [0.1 m, 0.2 m, -0.05 m] }} }}
{held}
measures: {{ rw: rate(a.qw), rx: rate(a.qx), ry: rate(a.qy), rz: rate(a.qz) }}
studies: {{ d: {{ dynamics: {{ until: 2 s, every: 0.1 s, {settings} }}, columns: [{columns}] }} }}
"
    )
}

const COLUMNS: &str = "a.com.x, a.com.y, a.com.z, a.wx, a.wy, a.wz, a.qw, a.qx, a.qy, a.qz, rw, rx, ry, rz, energy";
const ALL: [&str; 4] = [
    "tolerance: 1e-11",
    "tolerance: 1e-11, coordinates: cartesian",
    "tolerance: 1e-11, coordinates: minimal",
    "tolerance: 1e-10, integrator: radau5",
];

#[test]
fn a_ball_joint_without_two_components_is_a_hinge() {
    let start = "start: { a.wz: 9 rad/s }";
    let hinge = format!("joints: {{ J: {{ revolute: [ground, a.origin], axis: [0, 0, 1] }} }}\n{start}");
    let reference = study(&top(&hinge, "tolerance: 1e-12", COLUMNS), "d");
    // several turns: the quaternion goes on through both of its signs
    let least = reference.rows.iter().fold(1.0, |m: f64, row| m.min(row[6]));
    assert!(least < -0.9, "{least}");
    for settings in ALL {
        let ball = format!(
            "joints: {{ J: {{ spherical: [ground, a.origin] }} }}\ncouplings: {{ x: {{ zero: a.qx }}, y: {{ zero: a.qy }} }}\n{start}"
        );
        same(settings, &study(&top(&ball, settings, COLUMNS), "d"), &reference, 1e-7);
    }
}

#[test]
fn a_ball_joint_with_an_axis_at_right_angles_is_a_universal_joint() {
    // z of the body stays normal to the world's x: R₁₃ = 0
    let start = "start: { a.wx: 1 rad/s, a.wz: 4 rad/s }";
    let cross = format!("joints: {{ J: {{ universal: [ground, a.origin], axes: [[1, 0, 0], [0, 0, 1]] }} }}\n{start}");
    let reference = study(&top(&cross, "tolerance: 1e-12", COLUMNS), "d");
    for settings in ALL {
        let coupled = format!(
            "joints: {{ J: {{ spherical: [ground, a.origin] }} }}\ncouplings: {{ right_angle: {{ zero: 2*(a.qx*a.qz + a.qw*a.qy) }} }}\n{start}"
        );
        same(settings, &study(&top(&coupled, settings, COLUMNS), "d"), &reference, 1e-7);
    }
}

#[test]
fn a_coupling_of_a_quaternion_and_time_is_a_driver() {
    // sin((θ − ωt)/2) = 0, through five half turns
    let joint = "joints: { J: { revolute: [ground, a.origin], axis: [0, 0, 1] } }";
    let driven = format!("{joint}\ndrivers: {{ d: {{ joint: J, speed: 8 rad/s }} }}");
    let coupled = format!("{joint}\ncouplings: {{ d: {{ zero: a.qz*cos(4 rad/s*t) - a.qw*sin(4 rad/s*t) }} }}");
    let columns = "a.qw, a.qz, a.wz, a.com.ax, J.fx, J.fy, J.mx, energy";
    let reference = study(&top(&driven, "tolerance: 1e-12", columns), "d");
    for settings in ALL {
        same(settings, &study(&top(&coupled, settings, columns), "d"), &reference, 1e-7);
    }
    // steps that are short enough for the integral of the work
    let work = |held: &str| study(&top(held, "step: 5 ms, integrator: rk4", columns), "d").certificate.march.expect("a motion").drivers;
    let (found, right) = (work(&coupled), work(&driven));
    assert!((found - right).abs() < 1e-9 && right < -1.0, "{found} {right}");
}

#[test]
fn a_spring_along_a_component_is_the_load_of_its_energy() {
    // U = ½ k qz² with qz = sin(θ/2): the torque is −k/4 sin θ
    let joint = "joints: { J: { revolute: [ground, a.origin], axis: [0, 0, 1] } }\nstart: { J.angle: 2 rad, J.omega: 30 rad/s }";
    let sprung = format!("{joint}\nsprings: {{ k: {{ stretch: a.qz, stiffness: 40 N m }} }}");
    let loaded = format!("{joint}\nloads: {{ k: {{ joint: J, torque: -10 N m*sin(J.angle) }} }}");
    let columns = "J.angle, J.omega, J.alpha";
    let reference = study(&top(&loaded, "tolerance: 1e-12", columns), "d");
    for settings in ALL {
        let found = study(&top(&sprung, settings, columns), "d");
        same(settings, &found, &reference, 1e-7);
        let march = found.certificate.march.as_ref().expect("a motion");
        assert!(march.energy_drift < 1e-8 * march.energy_scale, "{settings}: {march:?}");
    }
}

/// Its sign is that with w ≥ 0 at the start, in all coordinates, however far a joint is turned there.
#[test]
fn the_sign_of_a_quaternion_is_that_of_its_start() {
    let at = |turn: f64| {
        format!(
            "joints: {{ J: {{ revolute: [ground, a.origin], axis: [0, 0, 1] }} }}\nstart: {{ J.angle: {turn} deg, J.omega: 0.5 rad/s }}"
        )
    };
    for turn in [0.0_f64, 100.0, 170.0, 190.0, 350.0, 530.0, -200.0] {
        for settings in ALL {
            let found = study(&top(&at(turn), settings, "J.angle, a.qw, a.qx, a.qy, a.qz"), "d");
            let sign = (turn.to_radians() / 2.0).cos().signum();
            for row in &found.rows {
                let (s, c) = (row[0] / 2.0).sin_cos();
                assert!(
                    (row[1] - sign * c).abs() < 1e-9 && (row[4] - sign * s).abs() < 1e-9 && row[2].abs() + row[3].abs() < 1e-12,
                    "{turn} {settings}: {row:?}"
                );
            }
        }
    }
}

#[test]
fn a_quaternion_goes_on_through_events_that_set_parameters() {
    let held = "parameters: { k: 1 N m }
joints: { J: { revolute: [ground, a.origin], axis: [0, 0, 1] } }
loads: { push: { joint: J, torque: k } }
events: { half: { when: J.angle - 5 rad, set: { k: 2*k } } }
start: { J.omega: 4 rad/s }";
    for settings in ALL {
        let found = study(&top(held, settings, "J.angle, a.qw, a.qz"), "d");
        assert_eq!(found.events.len(), 1);
        for row in &found.rows {
            let (s, c) = (row[0] / 2.0).sin_cos();
            assert!((row[1] - c).abs() < 1e-9 && (row[2] - s).abs() < 1e-9, "{settings}: {row:?}");
        }
        assert!(found.rows.iter().any(|row| row[1] < -0.9), "{settings}");
    }
}

#[test]
fn a_start_is_found_where_a_component_has_no_slope_as_drawn() {
    let held = "joints: { J: { spherical: [ground, a.origin] } }\ncouplings: { turned: { zero: a.qw - cos(0.35 rad) } }";
    for settings in ALL {
        let found = study(&top(held, settings, "a.qw, a.qx, a.qy, a.qz"), "d");
        for row in &found.rows {
            let length: f64 = row.iter().map(|x| x * x).sum();
            assert!((row[0] - 0.35_f64.cos()).abs() < 1e-9 && (length - 1.0).abs() < 1e-12, "{settings}: {row:?}");
        }
    }
}

/// The readings of a mechanism with every joint are the unit quaternions of its bodies.
#[test]
fn quaternions_are_those_of_the_poses() {
    for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
        let m = common::mechanism::<Spatial<f64>>(include_str!("common/spatial.yaml"), coordinates);
        for seed in 1..4 {
            let s = common::State::random(&m, seed);
            let mut d = grashof::dynamics::Dynamics::new(&m);
            s.evaluate(&mut d);
            for (body, pose) in d.poses().into_iter().enumerate() {
                let [w, x, y, z] = d.work.quaternions[body].0;
                let unit = nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(w, x, y, z));
                assert!((w * w + x * x + y * y + z * z - 1.0).abs() < 1e-13);
                assert!((unit.to_rotation_matrix().matrix() - pose.r).amax() < 1e-13, "{} {coordinates:?}", m.bodies[body].name);
            }
        }
    }
}
