//! A universal joint with `rpy`: its axes cross at right angles with the second body turned, not with both as drawn.

use crate::common::{model, study};
use grashof::geometry::Spatial;
use grashof::mechanism::{Coordinates, build};
use grashof::studies::common::case::parameters;

const TURNED: &str = "grashof: 1
name: universal with rpy
space: spatial
gravity: none
bodies: { body: { mass: 1 kg, com: [0.2 m, 0, 0], inertia: [1, 1, 1] } }
joints: { J: { universal: [ground, body.origin], axes: [[FIRST], [0, 0, 1]], rpy: [90 deg, 0, 0] } }
start: { J.angle1: 0.3, J.angle2: 0.4, J.omega1: 1, J.omega2: -0.5 }
studies: { run: { dynamics: { until: 1 s, every: 0.1 s, coordinates: joint }, columns: [J.angle1, J.angle2, energy.kinetic] } }
";

#[test]
fn parallel_axes_are_refused_and_crossed_ones_run_alike() {
    // z of the turned body is −y of the ground
    let of = |first: &str| model(&TURNED.replace("FIRST", first), None);
    let parallel = of("0, -1, 0");
    let faults = build::<Spatial<f64>>(&parallel, &parameters(&parallel), Coordinates::Joint).expect_err("parallel axes");
    assert_eq!(faults[0].code, "axes-not-crossed");
    let text = TURNED.replace("FIRST", "0, 0, 1");
    let [joint, cut] =
        [text.clone(), text.replace("coordinates: joint", "coordinates: cartesian")].map(|t| study(&t, "run", Coordinates::Joint));
    assert_eq!(joint.rows[0][..2], [0.3, 0.4]);
    for (a, b) in joint.rows.iter().zip(&cut.rows) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6), "{a:?} {b:?}");
    }
}
