//! Orientations by roll, pitch and yaw: of bodies at the start, and of points.

use super::{Columns, apply, near, product, refusal, transposed, turned};
use grashof::mechanism::Coordinates;

const START: [f64; 3] = [20.0, -35.0, 110.0];
/// Axes of a point of the ground, of a point of the body, and of the second in the first at 0.
const FIRST: [f64; 3] = [40.0, 25.0, -70.0];
const SECOND: [f64; 3] = [-15.0, 60.0, 30.0];
const BETWEEN: [f64; 3] = [10.0, -80.0, 5.0];

fn list(angles: [f64; 3]) -> String {
    let [roll, pitch, yaw] = angles;
    format!("[{roll} deg, {pitch} deg, {yaw} deg]")
}

/// Where three points of a body stand, from its origin.
fn seen(run: &Columns, body: &str) -> [[f64; 3]; 3] {
    let last = |name: String| *run.get(&name).last().expect("a row");
    let column = |point: &str| ["x", "y", "z"].map(|axis| last(format!("{body}.{point}.{axis}")) - last(format!("{body}.{axis}")));
    transposed(&[column("E1"), column("E2"), column("E3")])
}

#[track_caller]
fn same(what: &str, found: &[[f64; 3]; 3], right: &[[f64; 3]; 3]) {
    for (found, right) in found.iter().flatten().zip(right.iter().flatten()) {
        near(what, *found, *right, 1e-9);
    }
}

const POINTS: &str = "E1: [1 m, 0, 0], E2: [0, 1 m, 0], E3: [0, 0, 1 m]";
const COLUMNS: &str = "crate.x, crate.y, crate.z, crate.E1.x, crate.E1.y, crate.E1.z, crate.E2.x, crate.E2.y, crate.E2.z, crate.E3.x, \
                       crate.E3.y, crate.E3.z";

fn free(start: &str) -> String {
    format!(
        "
grashof: 1
name: thrown
space: spatial
gravity: none
bodies: {{ crate: {{ box: {{ size: [10 cm, 20 cm, 30 cm], mass: 2 kg }}, points: {{ {POINTS} }} }} }}
start: {{ {start} }}
studies:
  stand: {{ statics: {{ from: start }}, columns: [{COLUMNS}] }}
"
    )
}

#[test]
fn a_body_starts_as_its_roll_pitch_and_yaw_say() {
    for start in [format!("crate.rpy: {}", list(START)), "crate.rpy: [~20 deg, ~-35 deg, ~110 deg]".to_owned()] {
        let run = Columns::of(&free(&start), "stand", Coordinates::Joint);
        same(&start, &seen(&run, "crate"), &turned(START));
    }
}

#[test]
fn wrong_orientations_are_refused() {
    for (start, words) in [
        ("crate.rpy: [~20 deg, 10 deg, 0]", "guess beside an exact"),
        ("crate.rpy: 20 deg", "`[roll, pitch, yaw]`"),
        ("crate.rpy: [1, 2, 3 m]", "found length (m)"),
        ("crate.x: [1 m, 2 m, 3 m]", "a list"),
        ("crate.rpy: [0, 0, 0], crate.rotation: { axis: [1, 0, 0], angle: 0 }", "given already"),
        ("crate.rpx: [0, 0, 0]", "`crate.rpy`"),
    ] {
        let refused = refusal(&free(start), None);
        assert!(refused.contains(words), "{start}: {refused}");
    }
    let planar = free("crate.x: 0 m").replace("spatial", "planar").replace("[10 cm, 20 cm, 30 cm]", "[10 cm, 20 cm]");
    let planar = planar.replace(POINTS, "P: { at: [1 m, 0], rpy: [0, 0, 10 deg] }");
    assert!(refusal(&planar, None).contains("`rpy` does not exist in the plane"), "{}", refusal(&planar, None));
}

fn hinged(points: &str, joint: &str) -> String {
    format!(
        "
grashof: 1
name: flap
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: {{ O: [0.3 m, -0.2 m, 1 m], H: {{ at: [0.3 m, -0.2 m, 1 m], rpy: {} }} }}
bodies:
  crate:
    mass: 0.5 kg
    com: [0.1 m, 0, -0.2 m]
    inertia: [0.02, 0.02, 0.01]
    points: {{ {POINTS}, {points} }}
joints:
  J: {{ {joint} }}
drivers: {{ drive: {{ joint: J, angle: 40 deg*t/1 s }} }}
studies:
  turn: {{ inverse: {{ over: 1 s, samples: 4 }}, columns: [{COLUMNS}, crate.ax, J.mx, J.m, drive.torque] }}
",
        list(FIRST)
    )
}

/// The second point's axes stand in the first's as R_j · R_z(40 deg), so the body as R_a R_z R_j R_bᵀ: turned about the first's z.
#[test]
fn joints_connect_the_axes_of_points() {
    let frame = format!("h: {{ at: [0.05 m, 0.1 m, 0], rpy: {} }}", list(SECOND));
    for cut in ["", ", cut: true"] {
        let text = hinged(&frame, &format!("revolute: [ground.H, crate.h], rpy: {}{cut}", list(BETWEEN)));
        for coordinates in [Coordinates::Joint, Coordinates::Cartesian] {
            let run = Columns::of(&text, "turn", coordinates);
            let turn = product(&turned(FIRST), &turned([0.0, 0.0, 40.0]));
            let right = product(&product(&turn, &turned(BETWEEN)), &transposed(&turned(SECOND)));
            same("pose", &seen(&run, "crate"), &right);
            // the joint's point lies on the ground's
            let last = |name: &str| *run.get(name).last().expect("a row");
            let arm = apply(&right, [0.05, 0.1, 0.0]);
            for (k, place) in [0.3, -0.2, 1.0].into_iter().enumerate() {
                near("place", last(["crate.x", "crate.y", "crate.z"][k]) + arm[k], place, 1e-9);
            }
        }
    }
}

/// A hinge whose points have axes is the hinge whose `axis` and `to` are their z axes in the bodies, as far as torques go.
#[test]
fn axes_of_points_are_another_way_of_saying_axis_and_rpy() {
    let z = apply(&turned(FIRST), [0.0, 0.0, 1.0]);
    let whole = product(&turned(FIRST), &transposed(&turned(SECOND)));
    // R = R_z(yaw) R_y(pitch) R_x(roll), read back
    let rpy = [whole[2][1].atan2(whole[2][2]), (-whole[2][0]).asin(), whole[1][0].atan2(whole[0][0])].map(f64::to_degrees);
    let named = hinged(&format!("h: {{ at: [0.05 m, 0.1 m, 0], rpy: {} }}", list(SECOND)), "revolute: [ground.H, crate.h]");
    let spelt = hinged(
        "h: [0.05 m, 0.1 m, 0]",
        &format!("revolute: [ground.O, crate.h], axis: [{}, {}, {}], rpy: {}", z[0], z[1], z[2], list(rpy)),
    );
    let [named, spelt] = [named, spelt].map(|text| Columns::of(&text, "turn", Coordinates::Joint));
    for name in ["crate.ax", "J.mx", "J.m", "drive.torque", "crate.E2.x"] {
        for (a, b) in named.get(name).into_iter().zip(spelt.get(name)) {
            near(name, a, b, 1e-9);
        }
    }
}

/// A load in the axes of a point: the same as in those of the body, turned by hand; and the body turns it with itself.
#[test]
fn loads_act_in_the_axes_of_points() {
    let text = |load: &str| {
        format!(
            "
grashof: 1
name: pushed
space: spatial
gravity: none
bodies:
  crate:
    box: {{ size: [10 cm, 20 cm, 30 cm], mass: 2 kg }}
    points: {{ {POINTS}, nozzle: {{ at: [5 cm, 3 cm, -10 cm], rpy: {} }} }}
loads: {{ push: {{ at: crate.nozzle, {load} }} }}
studies:
  fly: {{ dynamics: {{ until: 1 s, every: 0.1 s, tolerance: 1e-11 }}, columns: [{COLUMNS}, crate.wx_own, crate.alphaz] }}
",
            list(SECOND)
        )
    };
    let vector = |x: [f64; 3], unit: &str| format!("[{} {unit}, {} {unit}, {} {unit}]", x[0], x[1], x[2]);
    let (force, torque) = ([1.0, -2.0, 0.5], [0.02, 0.01, -0.03]);
    let own = text(&format!("force: {}, torque: {}, frame: crate.nozzle", vector(force, "N"), vector(torque, "N m")));
    let [turned_force, turned_torque] = [force, torque].map(|x| apply(&turned(SECOND), x));
    let by_hand = text(&format!("force: {}, torque: {}, frame: crate", vector(turned_force, "N"), vector(turned_torque, "N m")));
    let [own, by_hand] = [own, by_hand].map(|text| Columns::of(&text, "fly", Coordinates::Joint));
    for name in ["crate.x", "crate.z", "crate.E1.y", "crate.wx_own", "crate.alphaz"] {
        for (a, b) in own.get(name).into_iter().zip(by_hand.get(name)) {
            near(name, a, b, 1e-9);
        }
    }
    assert!(own.get("crate.wx_own").iter().any(|w| w.abs() > 0.1), "it turns");
}
