//! The motor of the crank-rocker, by hand.

/// Torque of the motor over its speed in rpm, as in the model file.
const CURVE: [[f64; 2]; 7] =
    [[0.0, 215.6], [214.0, 161.7], [1275.0, 284.2], [1460.0, 98.0], [1500.0, 0.0], [1540.0, -98.0], [1725.0, -284.2]];

/// Torque at a speed in rad/s, N m.
pub(crate) fn torque(speed: f64) -> f64 {
    let rpm = speed * 60.0 / std::f64::consts::TAU;
    let Some(k) = CURVE.iter().position(|p| p[0] > rpm) else { return CURVE[6][1] };
    let Some(k) = k.checked_sub(1) else { return CURVE[0][1] };
    let [[x0, y0], [x1, y1]] = [CURVE[k], CURVE[k + 1]];
    y0 + (y1 - y0) * (rpm - x0) / (x1 - x0)
}
