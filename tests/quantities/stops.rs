//! Forces and works of end stops, and the point that moments of sliding joints are about.

use super::{Columns, near};
use grashof::mechanism::Coordinates;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::run::run;

const G: f64 = 10.0;

/// A ball on rigid stops and one on a buffer, lifted a little by a load; both end at rest.
fn falling(settings: &str) -> String {
    format!(
        "
grashof: 1
name: stops
space: planar
gravity: [0, -{G} m/s^2]
bodies:
  ball: {{ mass: 0.5 kg }}
  soft: {{ mass: 0.5 kg }}
joints:
  W: {{ slider: [ground, ball.origin], axis: [0, 1], limits: {{ from: 0 m, restitution: 0.5 }} }}
  S: {{ slider: [ground, soft.origin], axis: [0, 1], limits: {{ from: 0 m, to: 3 m, stiffness: 500 N/m, damping: 5 N s/m }} }}
loads:
  lift: {{ joint: W, force: 1 N }}
start: {{ W.position: 0.5 m, S.position: 0.5 m }}
studies:
  fall:
    dynamics: {{ until: 6 s, every: 10 ms, {settings} }}
    columns: [time, W.position, W.velocity, W.stop, S.position, S.velocity, S.stop, S.stop_power, energy.total]
    scalars:
      stops: work_stops
      loads: work_loads
      dampers: work_dampers
      impacts: work_impacts
      soft: integral(S.stop_power)
"
    )
}

#[test]
fn forces_of_stops_are_their_laws_and_carry_what_rests_on_them() {
    for settings in ["tolerance: 1e-10", "integrator: radau5, tolerance: 1e-9, coordinates: cartesian", "coordinates: minimal"] {
        let found = Columns::of(&falling(settings), "fall", Coordinates::Joint);
        let (x, v, stop) = (found.get("S.position"), found.get("S.velocity"), found.get("S.stop"));
        let (rigid, height, power) = (found.get("W.stop"), found.get("W.position"), found.get("S.stop_power"));
        for i in 0..x.len() {
            let push = if x[i] < -1e-9 { f64::max(0.0, -500.0 * x[i] - 5.0 * v[i]) } else { 0.0 };
            if x[i].abs() > 1e-9 {
                near("elastic stop", stop[i], push, 1e-9);
                near("its power", power[i], push * v[i], 1e-9);
            }
            if height[i] > 1e-6 {
                assert_eq!(rigid[i], 0.0, "a rigid stop in flight");
            }
        }
        let last = x.len() - 1;
        near("the rigid stop carries weight less lift", rigid[last], 0.5 * G - 1.0, 1e-9);
        near("the buffer carries the weight", stop[last], 0.5 * G, 1e-6);
    }
}

#[test]
fn works_of_stops_are_booked_apart_from_loads() {
    let found = Columns::of(&falling("tolerance: 1e-10"), "fall", Coordinates::Joint);
    let [stops, loads, dampers, impacts, soft] = found.outcome.scalars[..] else { panic!("five scalars") };
    // the rigid stop takes the potential energy and the work of the lift, the buffer all that is not stored in it
    let (rigid, sink) = (-0.5 * G * 0.5 + 0.5, 0.5 * G / 500.0);
    let stored = 0.5 * 500.0 * sink * sink;
    near("work of stops", stops, rigid - 0.5 * G * (0.5 + sink) + stored, 1e-6);
    near("work of loads", loads, -0.5, 1e-9);
    assert_eq!((dampers, impacts), (0.0, 0.0), "dampers and impacts do nothing");
    near("∫ of the power of the buffer, what it stores with it", soft, -0.5 * G * (0.5 + sink), 1e-7);
    let energy = found.get("energy.total");
    near("balance", energy[energy.len() - 1] - energy[0], stops + loads, 1e-8);
    assert_eq!(found.march().stops, stops);
}

/// The wall of an event is no end stop.
#[test]
fn events_with_impacts_are_booked_as_impacts() {
    let text = falling("tolerance: 1e-10")
        .replace(", limits: { from: 0 m, restitution: 0.5 }", "")
        .replace("W.stop, ", "")
        .replace("\nstart:", "\nevents: { wall: { when: W.position, crossing: falling, restitution: { joint: W, e: 0.5 } } }\nstart:");
    let found = Columns::of(&text, "fall", Coordinates::Joint);
    near("impacts", found.outcome.scalars[3], -0.5 * G * 0.5 + 0.5, 1e-6);
    let refused = super::refusal(&text.replace("S.stop,", "W.stop, S.stop,"), Some("fall"));
    assert!(refused.contains("`W` has no `stop`"), "{refused}");
}

/// Σ of moments about the point of the second body: m + (com − p) × (weight − m a) + (P − p) × F = 0, the body does not turn.
#[test]
fn the_moment_of_a_slider_is_about_the_point_of_the_second_body() {
    let text = |cut: &str| {
        format!(
            "
grashof: 1
name: guide
space: planar
gravity: [0, -9.81 m/s^2]
ground: {{ A: [2 m, 1 m] }}
bodies:
  shoe: {{ mass: 2 kg, com: [0.3 m, 0.1 m], inertia: 0.05 kg m^2, points: {{ B: [-0.2 m, 0.15 m], P: [0.5 m, 0.4 m] }} }}
joints:
  S: {{ slider: [ground.A, shoe.B], axis: [3, 4]{cut} }}
drivers: {{ drive: {{ joint: S, position: 0.7 m*sin(2 rad/s*t) }} }}
loads: {{ push: {{ at: shoe.P, force: [3 N, -7 N] }} }}
studies:
  run:
    inverse: {{ over: 3 s, samples: 40 }}
    columns: [time, S.m, S.position, S.fx, S.fy, shoe.com.x, shoe.com.y, shoe.B.x, shoe.B.y, shoe.P.x, shoe.P.y, shoe.com.ax, shoe.com.ay,
      drive.force]
"
        )
    };
    for (cut, coordinates) in [("", Coordinates::Joint), (", cut: true", Coordinates::Joint), ("", Coordinates::Cartesian)] {
        let run = Columns::of(&text(cut), "run", coordinates);
        let [m, bx, by] = ["S.m", "shoe.B.x", "shoe.B.y"].map(|n| run.get(n));
        let [cx, cy, px, py] = ["shoe.com.x", "shoe.com.y", "shoe.P.x", "shoe.P.y"].map(|n| run.get(n));
        let [ax, ay] = ["shoe.com.ax", "shoe.com.ay"].map(|n| run.get(n));
        let [fx, fy, drive] = ["S.fx", "S.fy", "drive.force"].map(|n| run.get(n));
        for i in 0..m.len() {
            let inertial = [-2.0 * ax[i], 2.0 * (-9.81 - ay[i])];
            let about = (cx[i] - bx[i]) * inertial[1] - (cy[i] - by[i]) * inertial[0] + (px[i] - bx[i]) * -7.0 - (py[i] - by[i]) * 3.0;
            near("moment about the point of the second body", m[i], -about, 1e-11);
            near("force x", fx[i] + 0.6 * drive[i] + inertial[0] + 3.0, 0.0, 1e-11);
            near("force y", fy[i] + 0.8 * drive[i] + inertial[1] - 7.0, 0.0, 1e-11);
        }
        assert!(run.get("S.position").iter().any(|x| x.abs() > 0.5), "the two points of the joint are apart");
    }
}

/// A step of 0.2 s is far too long for a double pendulum that tumbles.
#[test]
fn badly_balanced_energy_is_a_finding() {
    let text = |settings: &str| {
        format!(
            "
grashof: 1
name: double pendulum
space: planar
gravity: [0, -9.81 m/s^2]
bodies:
  upper: {{ bar: {{ length: 1 m, mass: 1 kg }} }}
  lower: {{ bar: {{ length: 0.7 m, mass: 0.8 kg }} }}
joints:
  P: {{ revolute: [ground, upper.start] }}
  Q: {{ revolute: [upper.end, lower.start] }}
start: {{ P.angle: -20 deg, Q.angle: -30 deg }}
studies:
  swing: {{ dynamics: {{ until: 4 s, {settings} }} }}
"
        )
    };
    let energy = |settings: &str| {
        let text = text(settings);
        let model = crate::common::model(&text, Some("swing"));
        let study = model.study.clone().expect("the study");
        let outcome = run(Case::new(&model, &study, &parameters(&model)), &|| false).expect("a run");
        outcome.findings.into_iter().find(|f| f.code == "energy")
    };
    for bad in ["integrator: rk4, step: 0.2 s", "integrator: central-difference, step: 0.1 s"] {
        let found = energy(bad).unwrap_or_else(|| panic!("{bad}: no finding"));
        assert!(found.message.contains("J") && found.message.contains("shorter `step`"), "{}", found.message);
        assert_eq!(found.path, "studies.swing");
    }
    for good in ["tolerance: 1e-10", "tolerance: 1e-4", "tolerance: 1e-2", "integrator: rk4, step: 2 ms", "integrator: newmark, step: 1 ms"]
    {
        assert_eq!(energy(good), None, "{good}");
    }
}
