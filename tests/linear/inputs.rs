//! Slopes by inputs: those of each output whatever else is asked for.

use crate::common::{close, study};
use grashof::mechanism::Coordinates;

#[test]
fn an_input_has_the_same_slopes_whatever_outputs_stand_beside() {
    // a double pendulum, whose accelerations are linear in a small torque; the moment of a hinge without friction is zero but for round-off
    let text = |columns: &str| {
        format!(
            "grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters: {{ u: 0.7 N }}
bodies:
  a: {{ bar: {{ length: 1 m, mass: 1.3 kg }} }}
  b: {{ bar: {{ length: 0.7 m, mass: 1 kg }} }}
joints:
  A: {{ revolute: [ground, a.start] }}
  B: {{ revolute: [a.end, b.start] }}
loads: {{ L: {{ joint: B, torque: 10 um*u }} }}
start: {{ A.angle: 0.3 rad, B.angle: 0.4 rad, A.omega: 1.1 rad/s, B.omega: -0.6 rad/s }}
studies: {{ l: {{ linearize: {{ inputs: [u] }}, columns: {columns} }} }}
"
        )
    };
    // M q̈ = … + [0, 1e-5 u]ᵀ with M of two bars on absolute angle and relative angle
    let (l1, l2, m1, m2, relative) = (1.0, 0.7, 1.3, 1.0, 0.4_f64);
    let m22 = m2 * l2 * l2 / 3.0;
    let m12 = m22 + 0.5 * m2 * l1 * l2 * relative.cos();
    let m11 = (m1 / 3.0 + m2) * l1 * l1 + m22 + m2 * l1 * l2 * relative.cos();
    let determinant = m11 * m22 - m12 * m12;
    let slopes = [-m12 * 1e-5 / determinant, m11 * 1e-5 / determinant];
    for columns in ["[A.angle]", "[A.m]", "[A.m, A.alpha]", "[B.m, B.alpha, A.angle, A.m]"] {
        let linear = study(&text(columns), "l", Coordinates::Joint).linear.expect("matrices");
        let matrix = |name: &str| linear.matrices.iter().find(|(own, _)| own == name).map(|(_, rows)| rows.concat()).expect("the matrix");
        let b: Vec<f64> = matrix("B").iter().map(|x| 1e5 * x).collect();
        close(columns, &b, &[0.0, 0.0, 1e5 * slopes[0], 1e5 * slopes[1]], 1e-6);
        for (output, slope) in linear.outputs.iter().zip(matrix("D")) {
            let right = if output == "A.alpha" {
                slopes[0]
            } else if output == "B.alpha" {
                slopes[1]
            } else {
                0.0
            };
            assert!((slope - right).abs() < 1e-10, "{columns} {output}: {slope:e}, {right:e}");
        }
    }
}
