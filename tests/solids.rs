//! Bodies in space that are drawn as solids, from model files and from URDF.

use crate::common;
use grashof::mechanism::Coordinates;
use grashof::model::{Import, import};
use grashof::results::scene::Shape;

/// The shapes of a body in the drawing of a study.
fn shapes(text: &str, study: &str, body: &str) -> Vec<Shape> {
    let mut outcome = common::study(text, study, Coordinates::Joint);
    let bodies = outcome.scenes.remove(0).1.bodies;
    bodies.into_iter().find(|other| other.name == body).unwrap_or_else(|| panic!("no {body}")).shapes
}

fn near(a: &[f64], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
}

/// The shapes of an arm on a hinge that is drawn so, with a point P.
fn arm(drawn: &str) -> Vec<Shape> {
    let text = format!(
        "grashof: 1
name: arm
space: spatial
gravity: none
parameters: {{ r: 4 cm, nothing: 0 m }}
bodies: {{ arm: {{ mass: 1 kg, inertia: 1 kg m^2, points: {{ P: [0, 0, 50 cm] }}, drawn: {drawn} }} }}
joints: {{ A: {{ revolute: [ground, arm.origin], axis: [0, 0, 1] }} }}
studies: {{ turn: {{ dynamics: {{ until: 1 s, every: 0.5 s }} }} }}
"
    );
    shapes(&text, "turn", "arm")
}

#[test]
fn solids_stand_where_the_model_puts_them() {
    let all = arm("[{ box: [10 cm, 20 cm, 30 cm] }, { box: [10 cm, 10 cm, 10 cm], at: [1 m, 0, 0], rpy: [0, 0, 45 deg] }, \
         { cylinder: r, length: 40 cm, at: [20 cm, 0, 0], rpy: [0, 90 deg, 0] }, { ball: 2*r, at: [1 m, 0, 1 m] }]");
    let [Shape::Box { center, size }, Shape::Hull { points }, Shape::Cylinder { .. }, ball, Shape::Bar { from, to, width: None }] =
        &all[..]
    else {
        panic!("{all:?}")
    };
    // a thin bar leads to the point outside of all, from the solid nearest to it
    assert!(near(from, [0.0; 3]) && near(to, [0.0, 0.0, 0.5]), "{all:?}");
    assert!(near(center, [0.0; 3]) && near(size, [0.1, 0.2, 0.3]), "{all:?}");
    let corner = 0.05 * 2f64.sqrt();
    assert!(points.iter().any(|p| near(p, [1.0 + corner, 0.0, 0.05])) && points.len() == 8, "{all:?}");
    let Shape::Cylinder { from, to, radius } = &all[2] else { panic!("{all:?}") };
    assert!(near(from, [0.0; 3]) && near(to, [0.4, 0.0, 0.0]) && (radius - 0.04).abs() < 1e-15, "{all:?}");
    assert!(matches!(ball, Shape::Sphere { center, radius } if near(center, [1.0, 0.0, 1.0]) && (radius - 0.08).abs() < 1e-15), "{all:?}");
}

#[test]
fn one_solid_needs_no_list() {
    for solid in ["{ ball: r, at: [0, 0, 50 cm] }", "{ at: [0, 0, 25 cm], cylinder: r, length: 50 cm }"] {
        assert_eq!(format!("{:?}", arm(solid)), format!("{:?}", arm(&format!("[{solid}]"))));
    }
}

#[test]
fn solids_without_size_are_left_out_and_flat_ones_are_flat() {
    let all = arm("[{ ball: nothing }, { cylinder: 0 m, length: 1 m }, { box: [0, 0, 0] }, \
         { cylinder: 1 m, length: nothing, rpy: [0, 90 deg, 0] }]");
    let [Shape::Disc { radius: 1.0, axis: Some(axis), .. }] = &all[..] else { panic!("{all:?}") };
    assert!(near(axis, [1.0, 0.0, 0.0]), "{all:?}");
}

#[test]
fn links_of_a_robot_are_drawn_as_their_visuals() {
    let link = |name: &str, visual: &str| {
        let inertial = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
        format!("<link name='{name}'>{inertial}{visual}</link>")
    };
    let visual = |origin: &str, shape: &str| format!("<visual><origin {origin}/><geometry>{shape}</geometry></visual>");
    let shown = [
        visual("xyz='0.2 0 0' rpy='0 1.5707963267948966 0'", "<cylinder radius='0.04' length='0.4'/>"),
        visual("xyz='0 0 1' rpy='0 1.5707963267948966 0'", "<capsule radius='0.05' length='0.2'/>"),
        visual("xyz='0 0.1 0'", "<box size='0.1 0.2 0.3'/>"),
    ];
    let urdf = format!(
        "<robot name='arm'>{}{}<joint name='A' type='continuous'><parent link='base'/><child link='arm'/><axis xyz='0 0 1'/></joint></robot>",
        link("base", ""),
        link("arm", &shown.concat())
    );
    let imported = import(urdf.as_bytes(), "arm.urdf", &Import::default()).unwrap_or_else(|report| panic!("{report}"));
    let text = imported.text.replace("studies:\n", "studies:\n  turn: { dynamics: { until: 1 s, every: 0.5 s } }\n");
    let all = shapes(&text, "turn", "arm");
    let tube = |shape: &Shape, ends: [[f64; 3]; 2], r: f64| matches!(shape, Shape::Cylinder { from, to, radius } if near(from, ends[0]) && near(to, ends[1]) && *radius == r);
    let ball = |shape: &Shape, at: [f64; 3]| matches!(shape, Shape::Sphere { center, radius } if near(center, at) && *radius == 0.05);
    let [cylinder, capsule, first, second, block] = &all[..] else { panic!("{all:?}") };
    assert!(tube(cylinder, [[0.0; 3], [0.4, 0.0, 0.0]], 0.04), "{all:?}");
    assert!(tube(capsule, [[-0.1, 0.0, 1.0], [0.1, 0.0, 1.0]], 0.05), "{all:?}");
    assert!(ball(first, [-0.1, 0.0, 1.0]) && ball(second, [0.1, 0.0, 1.0]), "{all:?}");
    assert!(matches!(block, Shape::Box { center, size } if near(center, [0.0, 0.1, 0.0]) && near(size, [0.1, 0.2, 0.3])), "{all:?}");
}
