//! Slides that the areas of the bodies hide.

use crate::common::study;
use grashof::mechanism::Coordinates;

/// In an Oldham coupling the discs hide the slides between them; a block on a rail stays in sight.
#[test]
fn slides_between_areas_are_known_to_be_hidden() {
    let text = |shape: &str| {
        format!(
            "grashof: 1
name: oldham
space: planar
gravity: none
ground: {{ A: [0, 0], B: [2 cm, 0] }}
bodies:
  left: {{ {shape}, mass: 1 kg, inertia: 1e-3 kg m^2 }}
  cross: {{ drawn: {{ circle: 4 cm }}, mass: 0.2 kg, inertia: 2e-4 kg m^2 }}
  right: {{ drawn: {{ circle: 5 cm }}, mass: 1 kg, inertia: 1e-3 kg m^2 }}
joints:
  A: {{ revolute: [ground.A, left.origin] }}
  B: {{ revolute: [ground.B, right.origin] }}
  P: {{ slider: [left.origin, cross.origin], axis: [1, 0] }}
  Q: {{ slider: [right.origin, cross.origin], axis: [0, 1] }}
drivers: {{ d: {{ joint: A, speed: 10 rad/s }} }}
studies: {{ turn: {{ kinematics: {{ over: 0.1 s, samples: 10 }} }} }}
"
        )
    };
    for (shape, hidden) in [("drawn: { circle: 5 cm }", true), ("points: { rail: [5 cm, 0] }", false)] {
        let (_, scene) = study(&text(shape), "turn", Coordinates::Joint).scenes.remove(0);
        let drawing = grashof::output::drawing("m", "turn", "mechanism", &scene);
        let of = |name: &str| drawing.joints.iter().find(|joint| joint.name == name).expect("a joint").hidden;
        assert_eq!([of("P"), of("Q"), of("A")], [hidden, true, false], "{shape}");
    }
}
