//! Which coordinates are independent: those to which `start` gives exact values, in its order.

use super::{list, study};
use grashof::mechanism::Coordinates;

#[test]
fn the_first_coordinate_of_the_start_is_independent() {
    // b = 2 a + a², pushed by a constant torque τ on b: in b no stiffness, in a −τ b″ = 2·1.5 N m against J_a + J_b b′²
    let right = 1.5 * 2.0 / (0.01 + 0.02 * 2.6 * 2.6);
    for (start, named, stiff) in [
        ("A.angle: 0.3 rad, B.angle: 0.69 rad", "A.angle", right),
        ("B.angle: 0.69 rad, A.angle: 0.3 rad", "B.angle", 0.0),
        ("A.angle: 0.3 rad, B.angle: ~0.69 rad", "A.angle", right),
        ("A.angle: ~0.3 rad, B.angle: 0.69 rad", "B.angle", 0.0),
    ] {
        for joints in [
            ["A: { revolute: [ground.A, a.origin] }", "B: { revolute: [ground.B, b.origin] }"],
            ["B: { revolute: [ground.B, b.origin] }", "A: { revolute: [ground.A, a.origin] }"],
        ] {
            for methods in ["library", "lanczos"] {
                let text = format!(
                    "grashof: 1
name: two discs
space: planar
gravity: [0, -10]
ground: {{ A: [0, 0], B: [1, 0] }}
bodies: {{ a: {{ disc: {{ radius: 0.1 m, mass: 2 kg }} }}, b: {{ disc: {{ radius: 0.1 m, mass: 4 kg }} }} }}
joints: {{ {}, {} }}
couplings: {{ g: {{ zero: B.angle - 2*A.angle - A.angle^2 }} }}
loads: {{ L: {{ joint: B, torque: -1.5 N m }} }}
start: {{ {start} }}
studies: {{ d: {{ modes: {{ methods: [{methods}] }} }}, l: {{ linearize: {{}}, columns: [A.angle] }} }}
",
                    joints[0], joints[1]
                );
                let found = study(&text, "d", Coordinates::Joint);
                assert_eq!(found.shapes[0][0].0, named, "{start} {joints:?} {methods}");
                assert!(
                    (list(&found, "eigenvalues")[0] - stiff).abs() < 1e-9 * right,
                    "{start} {methods}: {:?}",
                    list(&found, "eigenvalues")
                );
                let linear = study(&text, "l", Coordinates::Joint).linear.expect("matrices");
                assert_eq!(linear.coordinates, [named], "{start} {joints:?}");
            }
        }
    }
}
