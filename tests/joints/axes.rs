//! The directions in which coordinates of joints count.

use super::{ALL, spatial};
use crate::common::study;

/// x of a planar joint is the first body's x axis made normal to the axis, y the axis × that.
#[test]
fn a_planar_joint_counts_x_along_the_projection_of_x() {
    let axes: [[f64; 3]; 16] = [
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -2.0, 0.0],
        [0.3, 0.1, 1.0],
        [1.0, 2.0, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0, 0.0, 1.0],
        [1.0, 0.99, 0.0],
        [1.0, 1.01, 0.0],
        [3.0, 1.0, 1.0],
        [20.0, 1.0, 0.0],
        [-3.0, 1.0, 2.0],
        // x but for rounding
        [1.0, 0.0, 1e-9],
    ];
    for axis in axes {
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let n = axis.map(|x| x / length);
        let i = usize::from(n[0].abs() > 1.0 - 1e-13);
        let mut x = n.map(|x| -n[i] * x);
        x[i] += 1.0;
        let size = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let x = x.map(|c| c / size);
        let y = [n[1] * x[2] - n[2] * x[1], n[2] * x[0] - n[0] * x[2], n[0] * x[1] - n[1] * x[0]];
        let text = spatial(&format!(
            "\
gravity: none
bodies: {{ a: {{ mass: 1 kg, inertia: [0.01, 0.01, 0.01] }} }}
joints: {{ P: {{ planar: [ground, a.origin], axis: {axis:?} }} }}
start: {{ P.x: 2 m, P.y: 3 m, P.angle: 0 rad }}
studies: {{ move: {{ dynamics: {{ until: 0.1 s, every: 0.1 s }}, columns: [a.x, a.y, a.z] }} }}
"
        ))
        .replacen("gravity: none\n", "", 1);
        for coordinates in ALL {
            let outcome = study(&text, "move", coordinates);
            for k in 0..3 {
                let (found, right) = (outcome.rows[0][k], 2.0 * x[k] + 3.0 * y[k]);
                assert!((found - right).abs() < 1e-9, "{axis:?} {coordinates:?}: component {k} is {found}, right is {right}");
            }
        }
    }
}
