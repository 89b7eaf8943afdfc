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

#[test]
fn modes_without_damping_have_none_beside_a_free_motion() {
    // a chain of three masses of which nothing holds the whole; between two of them a damper beside the spring, or none
    for (damper, damped) in [("", 0), (", damping: 3 N s/m", 2)] {
        let text = format!(
            "grashof: 1
name: three masses
space: planar
gravity: none
bodies: {{ a: {{ mass: 1 kg }}, b: {{ mass: 2 kg }}, c: {{ mass: 1.7 kg }} }}
joints:
  A: {{ slider: [ground, a.origin], axis: [1, 0] }}
  B: {{ slider: [a.origin, b.origin], axis: [1, 0] }}
  C: {{ slider: [b.origin, c.origin], axis: [1, 0] }}
springs: {{ p: {{ joint: B, stiffness: 1237 N/m{damper} }}, q: {{ joint: C, stiffness: 311 N/m }} }}
studies: {{ all: {{ modes: {{ damped: true }} }} }}
"
        );
        let outcome = study(&text, "all", Coordinates::Joint);
        let free: Vec<usize> =
            (0..list(&outcome, "frequencies").len()).filter(|i| list(&outcome, "eigenvalues_imaginary")[*i] == 0.0).collect();
        assert!(!free.is_empty());
        for (i, real) in list(&outcome, "eigenvalues_real").iter().enumerate() {
            let ratio = list(&outcome, "damping_ratios")[i];
            assert_eq!(free.contains(&i), ratio.is_nan(), "{i}: {ratio}");
            assert!(!free.contains(&i) || *real == 0.0, "{i}: {real}");
            assert!(damped > 0 || ratio.is_nan() || ratio == 0.0, "{i}: {ratio}");
        }
        let decay = list(&outcome, "damping_ratios").iter().filter(|ratio| **ratio > 1e-6).count();
        assert_eq!(decay, damped);
    }
}
