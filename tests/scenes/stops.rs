//! Stops of a slide stand where the body that slides ends, whatever its outline.

use crate::common::study;
use grashof::mechanism::Coordinates;

/// A body between stops at −6 and 6 cm, with the point `P` on the way 1 cm from its origin.
fn sliding(body: &str, joint: &str) -> String {
    format!(
        "grashof: 1
name: stops
space: planar
gravity: none
ground: {{ W: [0, 0] }}
bodies: {{ body: {{ {body}, points: {{ P: [1 cm, 0] }} }} }}
joints: {{ W: {{ slider: {joint}, axis: [1, 0], limits: {{ from: -6 cm, to: 6 cm, restitution: 0.8 }} }} }}
start: {{ W.velocity: 0.5 m/s }}
studies: {{ slide: {{ dynamics: {{ until: 0.1 s, every: 10 ms }}, columns: [W.position] }} }}
"
    )
}

#[test]
fn stops_stand_where_the_body_ends() {
    for (body, joint, beyond, sense) in [
        ("plate: { size: [10 cm, 4 cm], mass: 1 kg }", "[ground.W, body.P]", [0.06, 0.04], 1.0),
        // its coordinate goes the other way
        ("plate: { size: [10 cm, 4 cm], mass: 1 kg }", "[body.P, ground.W]", [0.04, 0.06], -1.0),
        ("disc: { radius: 3 cm, mass: 1 kg }", "[ground.W, body.P]", [0.04, 0.02], 1.0),
        // a rod goes through what guides it
        ("bar: { length: 20 cm, mass: 1 kg }", "[ground.W, body.P]", [0.0; 2], 1.0),
    ] {
        let (name, scene) = study(&sliding(body, joint), "slide", Coordinates::Joint).scenes.remove(0);
        let drawing = grashof::output::drawing("stops", "slide", &name, &scene);
        let placement = drawing.joints[0].poses[0];
        let near = |x: f64, y: f64| (x - y).abs() < 1e-12;
        assert!(placement.beyond.iter().zip(beyond).all(|(x, y)| near(*x, y)), "{body}, {joint}: {:?}", placement.beyond);
        // stops are where the point of the joint is when it meets them, and the way reaches as far as the body does
        let stops = placement.stops.map(|stop| sense * stop.expect("a stop")[0]);
        let way = placement.way.expect("a way").map(|end| sense * end[0]);
        assert!(near(stops[0], -0.06) && near(stops[1], 0.06), "{stops:?}");
        assert!(near(way[0], -0.06 - beyond[0]) && near(way[1], 0.06 + beyond[1]), "{way:?}");
    }
}

/// On a stop of its hinge a bar lies in the direction of the sign of that stop, whichever axis, alignment and order of bodies the hinge has,
/// in space as in the plane.
#[test]
fn stops_of_hinges_lie_where_the_bar_is_then() {
    for (space, hinge) in [
        ("planar", "revolute: [ground, bar.start]"),
        ("planar", "revolute: [bar.start, ground]"),
        ("spatial", "revolute: [ground, bar.start], axis: [0, 1, 0]"),
        ("spatial", "revolute: [bar.start, ground], axis: [0, 1, 0]"),
        ("spatial", "revolute: [ground, bar.start], axis: [0.3, -0.2, 0.8], to: [0, 0, 1]"),
        ("spatial", "revolute: [bar.start, ground], axis: [0, 0, 1], to: [0.3, -0.2, 0.8]"),
        ("spatial", "revolute: [ground, bar.start], axis: [0, 0, 1], zero: 25 deg"),
    ] {
        for (end, k) in [("-35 deg", 0), ("70 deg", 1)] {
            let text = format!(
                "grashof: 1
name: stops
space: {space}
gravity: none
bodies: {{ bar: {{ bar: {{ length: 0.5 m, mass: 1 kg }} }} }}
joints: {{ J: {{ {hinge}, limits: {{ from: -35 deg, to: 70 deg, restitution: 0 }} }} }}
start: {{ J.angle: {end} }}
studies: {{ rest: {{ dynamics: {{ until: 10 ms, every: 10 ms }}, columns: [J.angle] }} }}
"
            );
            let (_, scene) = study(&text, "rest", Coordinates::Joint).scenes.remove(0);
            let drawing = grashof::output::drawing("stops", "rest", "mechanism", &scene);
            let placement = drawing.joints[0].poses[0];
            let grashof::output::FormKind::Bar { from, to, .. } = drawing.bodies[1].poses[0][0].kind else { panic!("a bar") };
            // of a hinge to the ground the ends are those about the opposite axis
            let stop = if placement.stops[k].is_some_and(|stop| is_along(stop, from, to)) { k } else { 1 - k };
            let told = placement.stops[stop].unwrap();
            assert!(is_along(told, from, to), "{hinge}, {end}: {:?} {from:?} {to:?}", placement.stops);
            assert!(stop == k || space == "planar" && hinge.contains(", ground]"), "{hinge}, {end}");
        }
    }
}

fn is_along(direction: [f64; 2], from: [f64; 2], to: [f64; 2]) -> bool {
    (0..2).all(|i| (to[i] - from[i] - 0.5 * direction[i]).abs() < 1e-9)
}
