//! Inertia tensors: given in the axes of the inertial frame, which `origin` turns, they are R I Rᵀ in the axes of the link.

use super::rotation::{Matrix, roll_pitch_yaw};
use urdf_rs::{Inertia, Vec3};

/// A symmetric tensor, kg m².
pub(super) type Tensor = Matrix;

/// Turns the tensor of an inertial frame into the axes of the link: R I Rᵀ.
pub(super) fn turned(inertia: &Inertia, rpy: &Vec3) -> Tensor {
    let Inertia { ixx, ixy, ixz, iyy, iyz, izz } = *inertia;
    let tensor = [[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]];
    if rpy.0 == [0.0; 3] {
        return tensor;
    }
    let r = roll_pitch_yaw(rpy.0);
    let mut out = [[0.0; 3]; 3];
    for i in 0..3 {
        // the upper half alone: the result is symmetric to the bit
        for j in i..3 {
            let sum = (0..9).map(|k| r[i][k / 3] * tensor[k / 3][k % 3] * r[j][k % 3]).sum();
            (out[i][j], out[j][i]) = (sum, sum);
        }
    }
    out
}

/// Ixx, Iyy, Izz, Ixy, Ixz, Iyz.
pub(super) fn figures(t: &Tensor) -> [f64; 6] {
    [t[0][0], t[1][1], t[2][2], t[0][1], t[0][2], t[1][2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tensor_turned_by_a_quarter_about_z_exchanges_x_and_y() {
        let inertia = Inertia { ixx: 1.0, ixy: 0.1, ixz: 0.2, iyy: 2.0, iyz: 0.3, izz: 2.5 };
        let turned = turned(&inertia, &Vec3([0.0, 0.0, std::f64::consts::FRAC_PI_2]));
        let expected = [2.0, 1.0, 2.5, -0.1, -0.3, 0.2];
        for (found, expected) in figures(&turned).into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}
