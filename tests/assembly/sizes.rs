//! 1 rad counts as one length in every start of a mechanism: whatever its coordinates, springs, place in the world and order of the file.

use crate::common::{assembled, close};
use grashof::dynamics::Dynamics;
use grashof::geometry::Planar;
use grashof::mechanism::Coordinates;

const COORDINATES: [Coordinates; 3] = [Coordinates::Joint, Coordinates::Cartesian, Coordinates::Bounded(2)];

/// A plate on a link with one exact rate, `far` from the origin: pose and rates of it in the plane, and the length of errors.
fn plate(far: f64, others: &str, coordinates: Coordinates) -> ([f64; 3], f64) {
    let text = format!(
        "grashof: 1
name: plate on a link
space: planar
gravity: none
ground: {{ G: [{far} + 0.3, 0.1], H: [{far} + 3, 0], I: [{far}, 7] }}
bodies:
  a: {{ plate: {{ size: [0.1, 0.2], mass: 1 }}, points: {{ P: [0.2, 0.15] }} }}
  d: {{ plate: {{ size: [0.1, 0.2], mass: 1 }}, points: {{ Q: [0.2, 0.1] }} }}
joints: {{ L: {{ distance: [ground.G, a.P] }}, D: {{ revolute: [ground.H, d.origin] }} }}
start: {{ a.x: {far}, a.y: 0, a.angle: 0, a.vx: 1 m/s }}
{others}"
    );
    let (m, start) = assembled::<Planar<f64>>(&text, coordinates);
    let mut d = Dynamics::new(&m);
    d.terms(0.0, &start.q, &start.v, &start.modes);
    let twist = d.work.twists[1];
    let v = twist.at(d.work.places[1].p);
    ([v.x, v.y, twist.w], start.size)
}

#[test]
fn rates_that_are_left_open_know_neither_springs_nor_the_origin() {
    // least vy² + (s ω)² on −0.1 vx + 0.05 vy + 0.025 ω = 0, with s = 0.25 m the place of P on its body
    let s = 0.25_f64;
    let [y, turn] = [0.05, 0.025 / s];
    let scale = 0.1 / (y * y + turn * turn);
    let right = [1.0, y * scale, turn * scale / s];
    let springs = [
        "",
        "springs: { S: { between: [d.Q, a.P], stiffness: 1e-3 N/m, length: 0.1 } }\n",
        "springs: { S: { between: [ground.I, a.P], stiffness: 1e-3 N/m }, T: { between: [ground.H, a.P], stiffness: 1e-3 N/m } }\n",
        "loads: { f: { joint: D, torque: 1e-6 N*a.P.y } }\n",
    ];
    for far in [0.0, -40.0, 1e3] {
        for (k, others) in springs.into_iter().enumerate() {
            for coordinates in COORDINATES {
                let (rates, size) = plate(far, others, coordinates);
                let what = format!("{far} m away, {coordinates:?}: {others}");
                close(&what, &rates, &right, 1e-11);
                // errors count in what springs hold, too, as everywhere else
                let held = [0.25, 2.7_f64.hypot(0.1), 3.0_f64.hypot(7.0), 0.25][k];
                close(&what, &[size], &[held], 1e-9);
            }
        }
    }
}

#[test]
fn guesses_that_contradict_each_other_know_neither_springs_nor_the_order() {
    let bodies = [
        "c: { bar: { length: 10 cm, mass: 1 kg } }",
        "l: { bar: { length: 30 cm, mass: 1 kg } }",
        "p: { mass: 1 kg }",
        "d: { bar: { length: 10 cm, mass: 1 kg } }",
    ];
    // the crank θ is missed by θ − 40°, the slider at x(θ) by x − 39 cm in parts of 30 cm
    let miss = |angle: f64| {
        let x = 0.1 * angle.cos() + (0.09 - (0.1 * angle.sin()).powi(2)).sqrt();
        (angle - 40.0_f64.to_radians()).powi(2) + ((x - 0.39) / 0.3).powi(2)
    };
    let [mut low, mut high] = [0.5_f64, 0.8];
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if miss(low + third) < miss(high - third) { high -= third } else { low += third }
    }
    let spring = "springs: { S: { between: [c.end, d.end], stiffness: 1 N/m }, T: { between: [ground.K, l.end], stiffness: 1 N/m } }\n";
    for (far, springs) in [(0.0, ""), (0.0, spring), (1e2, ""), (1e2, spring)] {
        let mut joints = [
            "O: { revolute: [ground.O, c.start] }",
            "A: { revolute: [c.end, l.start] }",
            "B: { revolute: [l.end, p.origin] }",
            "W: { slider: [ground.O, p.origin], axis: [1, 0] }",
            "D: { revolute: [ground.H, d.start] }",
        ];
        let mut bodies = bodies;
        for turned in [false, true] {
            if turned {
                joints.reverse();
                bodies.reverse();
            }
            let text = format!(
                "grashof: 1\nname: slider-crank\nspace: planar\ngravity: none\nground: {{ O: [{far}, 0], H: [{far} + 3, 0], K: [{far}, 9] }}\nbodies: {{ {} }}\njoints: {{ {} }}\n{springs}start: {{ O.angle: ~40 deg, W.position: ~39 cm, D.angle: 0 deg }}\n",
                bodies.join(", "),
                joints.join(", ")
            );
            for coordinates in COORDINATES {
                let (_, start) = assembled::<Planar<f64>>(&text, coordinates);
                let angle = start.found.iter().find(|f| f.name == "O.angle").expect("asked").found;
                close(&format!("{coordinates:?}: {text}"), &[angle], &[0.5 * (low + high)], 2e-8);
            }
        }
    }
}
