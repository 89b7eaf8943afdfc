//! Stiffnesses that are zero but for round-off: free motions, neither vibrations nor unstable ones.

use super::{codes, list, study};
use grashof::mechanism::Coordinates;

#[test]
fn a_wheel_on_a_rope_is_free_about_the_vertical() {
    let text = "grashof: 1
name: wheel on a rope
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: { ceiling: [0, 0, 2 m] }
bodies:
  wheel: { mass: 3 kg, inertia: [0.09 kg m^2, 0.09 kg m^2, 0.17 kg m^2], points: { handle: [0, 0, -12 cm] } }
joints:
  rope: { distance: [ground.ceiling, wheel.handle], length: 1 m }
start: { wheel.rpy: [0 deg, 90 deg, 0 deg], wheel.x: 12 cm, wheel.y: 0 m, wheel.z: ~1 m }
studies:
  hanging: { modes: { at: statics } }
  few: { modes: { at: statics, lowest: 3, methods: [lanczos] } }
  held: { modes: {} }
";
    for name in ["hanging", "few", "held"] {
        let outcome = study(text, name, Coordinates::Joint);
        let frequencies = list(&outcome, "frequencies");
        assert_eq!(frequencies.iter().filter(|f| **f == 0.0).count(), 1, "{name}: {frequencies:?}");
        assert_eq!(codes(&outcome).contains(&"unstable"), name == "held", "{name}: {:?}", codes(&outcome));
        assert!(codes(&outcome).contains(&"free-motion"), "{name}: {:?}", codes(&outcome));
    }
}
