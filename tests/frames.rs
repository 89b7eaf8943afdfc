//! A motion is the same wherever it takes place and however fast it travels as a whole: what a mechanism does at the origin it does
//! at 1,000 km from there, and at 1 km/s, in the same steps and to the rounding of its coordinates.

use crate::common::study;
use grashof::mechanism::Coordinates;

/// Shift, m, and velocity, m/s.
const FRAMES: [[f64; 2]; 3] = [[1e6, 0.0], [0.0, 1e3], [1e6, 1e3]];

/// A mechanism with X, its place, and U, its velocity, among its parameters, and columns that neither may change.
struct Mechanism {
    text: &'static str,
    columns: &'static str,
    measures: &'static str,
    /// Whether it may travel.
    travels: bool,
}

const PENDULUM: Mechanism = Mechanism {
    text: "grashof: 1\nname: double pendulum\nspace: planar\ngravity: [0, -9.81 m/s^2]\nparameters: { X: 0 m, U: 0 m/s }\n\
           ground: { O: [X, 0.7*X] }\n\
           bodies: { a: { bar: { length: 1 m, mass: 1 kg } }, b: { bar: { length: 1 m, mass: 1 kg } } }\n\
           joints: { P: { revolute: [ground.O, a.start] }, Q: { revolute: [a.end, b.start] } }\n\
           start: { P.angle: -20 deg, P.omega: 0, Q.angle: -30 deg, Q.omega: 1 rad/s }\n",
    columns: "P.angle, Q.angle, Q.omega, P, Q",
    measures: "",
    travels: false,
};

const FOUR_BAR: Mechanism = Mechanism {
    text: "grashof: 1\nname: four-bar\nspace: spatial\ngravity: [0, -9.81 m/s^2, 0]\nparameters: { X: 0 m, U: 0 m/s }\n\
           ground: { A0: [X, -X, 2*X], B0: [X + 1 m, -X, 2*X] }\n\
           bodies:\n  crank: { bar: { length: 30 cm, mass: 1 kg } }\n  rod: { bar: { length: 90 cm, mass: 1 kg } }\n  \
           rocker: { bar: { length: 60 cm, mass: 1 kg } }\n\
           joints:\n  A: { revolute: [ground.A0, crank.start] }\n  B: { revolute: [crank.end, rod.start] }\n  \
           C: { spherical: [rod.end, rocker.end] }\n  D: { revolute: [ground.B0, rocker.start] }\n\
           start: { A.angle: 40 deg, A.omega: 5 rad/s, D.angle: ~100 deg }\n",
    columns: "A.angle, A.omega, D.angle, A.fx, A.fy, B.mx, D.fx, D.fy",
    measures: "",
    travels: false,
};

const CART: Mechanism = Mechanism {
    text: "grashof: 1\nname: cart with a pendulum\nspace: planar\ngravity: [0, -9.81 m/s^2]\nparameters: { X: 0 m, U: 0 m/s }\n\
           ground: { O: [X, -0.4*X] }\n\
           bodies: { cart: { plate: { size: [20 cm, 10 cm], mass: 1 kg } }, a: { bar: { length: 60 cm, mass: 0.5 kg } } }\n\
           joints:\n  rail: { slider: [ground.O, cart.origin], axis: [0.8, 0.6] }\n  Q: { revolute: [cart.origin, a.start] }\n\
           loads: { push: { joint: rail, force: 2 N*sin(3 rad/s*t) } }\n\
           start: { rail.position: 0.1 m, rail.velocity: U + 0.3 m/s, Q.angle: -30 deg, Q.omega: 1 rad/s }\n",
    columns: "Q.angle, Q.omega, m0, m1, rail, Q",
    measures: "measures: { m0: rail.velocity - U, m1: rail.position - U*t }\n",
    travels: true,
};

const DRIVEN: Mechanism = Mechanism {
    text: "grashof: 1\nname: pendulum on a driven base\nspace: planar\ngravity: [0, -9.81 m/s^2]\nparameters: { X: 0 m, U: 0 m/s }\n\
           ground: { O: [X, -0.4*X] }\n\
           bodies: { cart: { plate: { size: [20 cm, 10 cm], mass: 1 kg } }, a: { bar: { length: 60 cm, mass: 0.5 kg } } }\n\
           joints:\n  rail: { slider: [ground.O, cart.origin], axis: [0.8, 0.6] }\n  Q: { revolute: [cart.origin, a.start] }\n\
           drivers: { base: { joint: rail, position: U*t + 10 cm*sin(4 rad/s*t) } }\n\
           start: { Q.angle: -30 deg, Q.omega: 1 rad/s }\n",
    columns: "Q.angle, Q.omega, base.force, Q",
    measures: "",
    travels: true,
};

const CRATE: Mechanism = Mechanism {
    text: "grashof: 1\nname: crate\nspace: spatial\ngravity: [0, 0, -9.81 m/s^2]\nparameters: { X: 0 m, U: 0 m/s }\n\
           bodies: { crate: { box: { size: [10 cm, 20 cm, 30 cm], mass: 2 kg } } }\n\
           start:\n  crate.x: X\n  crate.y: -0.4*X\n  crate.z: 1.5 m + X\n  crate.rotation: { axis: [0, 1, 0], angle: 20 deg }\n  \
           crate.vx: 2 m/s + U\n  crate.vy: 0.5*U\n  crate.vz: 3 m/s\n  crate.wx: 0.1 rad/s\n  crate.wy: 8 rad/s\n",
    columns: "crate.wx, crate.wy, crate.wz, m0, m1, m2",
    measures: "measures: { m0: crate.vx - U, m1: crate.x - X - U*t, m2: crate.z - X }\n",
    travels: true,
};

const THROWN: Mechanism = Mechanism {
    text: "grashof: 1\nname: two thrown boxes\nspace: spatial\ngravity: [0, 0, -9.81 m/s^2]\nparameters: { X: 0 m, U: 0 m/s }\n\
           bodies:\n  a: { box: { size: [10 cm, 20 cm, 30 cm], mass: 2 kg }, points: { p: [5 cm, 10 cm, 15 cm] } }\n  \
           b: { box: { size: [10 cm, 20 cm, 30 cm], mass: 1 kg }, points: { p: [-5 cm, -10 cm, -15 cm] } }\n\
           joints: { J: { spherical: [a.p, b.p] } }\n\
           springs: { s: { between: [a.origin, b.origin], stiffness: 200 N/m, length: 30 cm, damping: 1 N s/m } }\n\
           start:\n  a.x: X\n  a.y: -0.4*X\n  a.z: 1.5 m + X\n  a.vx: 2 m/s + U\n  a.vy: 0.5*U\n  a.vz: 3 m/s\n  \
           a.wx: 0.1 rad/s\n  a.wy: 3 rad/s\n  a.wz: 0\n  b.wx: 1 rad/s\n  b.wy: 0\n  b.wz: 2 rad/s\n",
    columns: "a.wx, a.wy, a.wz, b.wx, b.wy, b.wz, m0, s.stretch, J",
    measures: "measures: { m0: a.vx - U }\n",
    travels: true,
};

/// Rows and steps of a motion of two seconds.
fn motion(mechanism: &Mechanism, [x, u]: [f64; 2], dynamics: &str) -> (Vec<Vec<f64>>, usize) {
    let text = mechanism.text.replace("X: 0 m,", &format!("X: {x:e} m,")).replace("U: 0 m/s", &format!("U: {u:e} m/s"));
    let Mechanism { columns, measures, .. } = mechanism;
    let study_text =
        format!("{text}{measures}studies:\n  move: {{ dynamics: {{ until: 2 s, every: 0.25 s, {dynamics} }}, columns: [{columns}] }}\n");
    let outcome = study(&study_text, "move", Coordinates::Joint);
    let steps = outcome.certificate.march.expect("a motion in time").counts.steps;
    (outcome.rows.iter().map(<[f64]>::to_vec).collect(), steps)
}

/// Holds motions in all frames against that at the origin: `rounding` is what they may differ by, in parts of the largest value of a
/// column.
fn law(mechanism: &Mechanism, dynamics: &[&str], rounding: f64) {
    for dynamics in dynamics {
        let (rows, steps) = motion(mechanism, [0.0; 2], dynamics);
        for frame in FRAMES.into_iter().filter(|[_, u]| mechanism.travels || *u == 0.0) {
            let (others, others_steps) = motion(mechanism, frame, dynamics);
            let off = steps.abs_diff(others_steps);
            assert!(off * 50 <= steps, "{dynamics} at {frame:?}: {others_steps} steps, {steps} at the origin");
            assert_eq!(rows.len(), others.len());
            for column in 0..rows[0].len() {
                let size = rows.iter().fold(1.0, |m: f64, row| m.max(row[column].abs()));
                for (row, other) in rows.iter().zip(&others) {
                    let off = (row[column] - other[column]).abs() / size;
                    assert!(off <= rounding, "{dynamics} at {frame:?}: column {column} is off by {off:e}");
                }
            }
        }
    }
}

/// Explicit, implicit and multistep, in all coordinates; `bdf` takes differences of seven positions, whose rounding it sees at 1e-8.
const SCHEMES: [&str; 9] = [
    "integrator: dop853",
    "integrator: dop853, coordinates: cartesian",
    "integrator: dop853, coordinates: minimal",
    "integrator: radau5",
    "integrator: radau5, coordinates: cartesian",
    "integrator: bdf, tolerance: 1e-7",
    "integrator: bdf, tolerance: 1e-7, coordinates: cartesian",
    "integrator: rk4, tolerance: 1e-6, coordinates: cartesian",
    "integrator: generalized-alpha, tolerance: 1e-5",
];

#[test]
fn what_stands_on_the_ground_does_not_know_where() {
    law(&PENDULUM, &SCHEMES, 1e-11);
    law(&FOUR_BAR, &SCHEMES, 1e-8);
}

#[test]
fn what_runs_on_a_rail_does_not_know_where_nor_how_fast() {
    let (multistep, others): (Vec<&str>, Vec<&str>) = SCHEMES.iter().partition(|scheme| scheme.contains("bdf"));
    law(&CART, &others, 1e-7);
    // at 1e-7 it takes other steps where coordinates are rounded, and its own error is of that size
    law(&CART, &multistep, 3e-7);
}

#[test]
fn what_is_driven_does_not_know_where_nor_how_fast() {
    law(&DRIVEN, &SCHEMES, 1e-7);
}

#[test]
fn what_flies_does_not_know_where_nor_how_fast() {
    law(&CRATE, &SCHEMES, 1e-7);
    // where both bodies are sought on their own, what the start leaves open is found otherwise
    law(&THROWN, &SCHEMES.map(|s| if s.contains("cartesian") { "integrator: rk4, tolerance: 1e-6" } else { s }), 1e-6);
}

#[test]
fn a_tumbling_crate_costs_as_much_in_its_last_seconds_as_in_its_first() {
    let text = CRATE.text;
    let steps = |until: f64| {
        let text = format!("{text}studies:\n  flight: {{ dynamics: {{ until: {until} s, every: 10 s }}, columns: [crate.wx] }}\n");
        study(&text, "flight", Coordinates::Joint).certificate.march.expect("a motion in time").counts.steps
    };
    let (first, all) = (steps(20.0), steps(160.0));
    assert!((78..=82).contains(&(all * 10 / first)), "{first} steps for 20 s, {all} for 160 s");
}
