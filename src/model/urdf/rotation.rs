//! Rotations by roll, pitch and yaw.

/// A rotation or a tensor by its rows.
pub(super) type Matrix = [[f64; 3]; 3];

/// The rotation about the fixed axes x, then y, then z by roll, pitch and yaw, rad: R = R_z(yaw) R_y(pitch) R_x(roll), by rows.
///
/// Source: wiki.ros.org/urdf/XML/joint, `origin`.
#[must_use]
pub fn roll_pitch_yaw([roll, pitch, yaw]: [f64; 3]) -> [[f64; 3]; 3] {
    let ((sr, cr), (sp, cp), (sy, cy)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
    [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
}

/// R x.
pub(super) fn apply(r: &Matrix, x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| r[i][k] * x[k]).sum())
}

/// A B.
pub(super) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Unit axis and angle in [0, π] of a rotation, by its quaternion; z and 0 for none.
///
/// Of the four forms of a quaternion's components by the matrix the one with the largest divisor is taken
/// (Shepperd 1978, "Quaternion from rotation matrix").
#[must_use]
pub fn axis_angle(r: &[[f64; 3]; 3]) -> ([f64; 3], f64) {
    let trace = r[0][0] + r[1][1] + r[2][2];
    let diagonal = [trace, r[0][0], r[1][1], r[2][2]];
    let largest = (0..4).max_by(|&i, &k| diagonal[i].total_cmp(&diagonal[k])).unwrap_or(0);
    let skew = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
    // four times the product of the largest component with each
    let mut q = if largest == 0 {
        [1.0 + trace, skew[0], skew[1], skew[2]]
    } else {
        let i = largest - 1;
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let mut q = [skew[i], 0.0, 0.0, 0.0];
        q[1 + i] = 1.0 + 2.0 * r[i][i] - trace;
        q[1 + j] = r[i][j] + r[j][i];
        q[1 + k] = r[i][k] + r[k][i];
        q
    };
    if q[0] < 0.0 {
        q = q.map(|x| -x);
    }
    let size = (q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
    if size == 0.0 {
        return ([0.0, 0.0, 1.0], 0.0);
    }
    ([q[1] / size, q[2] / size, q[3] / size], 2.0 * size.atan2(q[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// R with R u = u for the axis and trace 1 + 2 cos of the angle.
    #[test]
    fn axis_and_angle_give_the_rotation_back() {
        for rpy in [[0.3, -0.7, 2.0], [3.1, 0.1, -0.2], [0.0, 0.0, 3.12], [-3.0, 1.5, 3.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1e-9]] {
            let r = roll_pitch_yaw(rpy);
            let (u, angle) = axis_angle(&r);
            let (s, c) = angle.sin_cos();
            let cross = [[0.0, -u[2], u[1]], [u[2], 0.0, -u[0]], [-u[1], u[0], 0.0]];
            for i in 0..3 {
                for j in 0..3 {
                    // Rodrigues
                    let made = c * f64::from(i == j) + s * cross[i][j] + (1.0 - c) * u[i] * u[j];
                    assert!((made - r[i][j]).abs() < 1e-14, "{rpy:?}");
                }
            }
        }
    }
}
