//! Springs that have no direction.

use grashof::Model;

/// A spring whose ends meet has no direction, and is named by every study that needs its stiffness; motions by explicit schemes do not.
#[test]
fn a_spring_whose_ends_meet_has_no_stiffness() {
    let text = "
grashof: 1
name: two-masses
space: planar
gravity: none
bodies:
  a: { mass: 1 kg, inertia: 1 kg m^2 }
  b: { mass: 1 kg, inertia: 1 kg m^2 }
joints:
  A: { slider: [ground, a], axis: [1, 0] }
  B: { slider: [ground, b], axis: [1, 0] }
springs:
  one: { joint: A, stiffness: 100 N/m, damping: 1 N s/m }
  two: { between: [a, b], stiffness: 50 N/m, damping: 0.5 N s/m }
start: { A.velocity: 1 m/s }
studies:
  undamped: { modes: { at: start } }
  damped: { modes: { at: start, damped: true } }
  sparse: { modes: { at: start, methods: [lanczos] } }
  linear: { linearize: { at: start } }
  rest: { statics: { from: start }, columns: [A.position] }
  implicit: { dynamics: { until: 1 s, integrator: bdf }, columns: [A.position] }
  explicit: { dynamics: { until: 1 s, integrator: dop853 }, columns: [A.position] }
";
    for study in ["undamped", "damped", "sparse", "linear", "rest", "implicit"] {
        // an implicit scheme needs it where they stay together
        let still = text.replace("A.velocity: 1 m/s", "A.velocity: 0");
        let model = Model::parse(if study == "implicit" { &still } else { text }).unwrap_or_else(|e| panic!("{e}"));
        let error = model.study(study).unwrap().run().unwrap_err().to_string();
        assert!(error.contains("the ends of the spring `two` meet"), "{study}: {error}");
    }
    let model = Model::parse(text).unwrap_or_else(|e| panic!("{e}"));
    let results = model.study("explicit").unwrap().run().unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(results.stopped, None);
}
