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
