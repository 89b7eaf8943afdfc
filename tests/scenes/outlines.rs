//! Bodies as they are drawn by the user, and hinges with dampers.

use crate::common::study;
use grashof::mechanism::Coordinates;
use grashof::results::Scene;
use grashof::results::scene::Shape;

/// A swinging cross with a slot to the right, `more` beside it.
fn cross(points: &str, joint: &str, more: &str) -> Scene {
    let text = format!(
        "grashof: 1
name: cross
space: planar
gravity: none
bodies:
  cross:
    mass: 1 kg
    inertia: 0.1 kg m^2
    points: {{ {points} }}
    drawn: [[10 cm, 1 cm], [4 cm, 1 cm], [4 cm, -1 cm], [10 cm, -1 cm], [10 cm, -10 cm], [-10 cm, -10 cm], [-10 cm, 10 cm], [10 cm, 10 cm]]
joints: {{ B: {{ revolute: [ground, cross.{joint}] }} }}
{more}studies: {{ go: {{ dynamics: {{ until: 0.1 s, every: 0.1 s }} }} }}
"
    );
    study(&text, "go", Coordinates::Joint).scenes.remove(0).1
}

#[test]
fn an_outline_stays_as_it_is_drawn() {
    // a point in the slot, one on a corner but for rounding, and one far away are no parts of the body
    for points in ["s: [10 cm, 0]", "s: [10.01 cm, 10 cm]", "s: [30 cm, 0]"] {
        let scene = cross(points, "origin", "");
        let [Shape::Polygon { points }] = &scene.bodies[1].shapes[..] else { panic!("{:?}", scene.bodies[1].shapes) };
        assert_eq!(points.len(), 8);
    }
    // a joint beside it is reached by a bar from the nearest place of its edge
    let scene = cross("s: [30 cm, 5 cm]", "s", "");
    let [Shape::Bar { from, to, .. }, Shape::Polygon { .. }] = &scene.bodies[1].shapes[..] else { panic!("{:?}", scene.bodies[1].shapes) };
    assert!((from[0] - 0.1).abs() < 1e-12 && (from[1] - 0.05).abs() < 1e-12, "{from:?}");
    assert_eq!(to[..], [0.3, 0.05]);
}

#[test]
fn what_only_damps_a_hinge_is_its_dashpot() {
    for (spring, damped, links) in
        [("damping: 1 N m s/rad", true, 0), ("stiffness: 1 N m/rad, damping: 1 N m s/rad", true, 1), ("stiffness: 1 N m/rad", false, 1)]
    {
        let scene = cross("s: [0, 0]", "origin", &format!("springs: {{ oil: {{ joint: B, {spring} }} }}\n"));
        assert_eq!((scene.joints[0].damped, scene.links.len()), (damped, links), "{spring}");
    }
}
