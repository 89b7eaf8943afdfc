//! Attitudes: quaternions (w, x, y, z) from body to world, angular velocities in the body's frame.
//!
//! q̇ = ½ q∘(0, ω). Every pose is a function of q/|q|: the norm has no meaning.

/// a∘b.
pub(crate) fn product(a: &[f64], b: [f64; 4]) -> [f64; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// R(q): columns are the body's axes in the world.
pub(crate) fn rotation(q: &[f64]) -> [[f64; 3]; 3] {
    let s = 2.0 / q.iter().map(|x| x * x).sum::<f64>();
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    [
        [1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)],
    ]
}

/// R x.
pub(crate) fn turned(r: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    r.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2])
}

/// Rᵀ x.
pub(crate) fn turned_back(r: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|j| r[0][j] * x[0] + r[1][j] * x[1] + r[2][j] * x[2])
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// [a]×, so that [a]× b = a × b.
pub(crate) fn skew(a: [f64; 3]) -> [[f64; 3]; 3] {
    [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]]
}

pub(crate) fn multiplied(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    a.map(|row| [0, 1, 2].map(|j| (0..3).map(|k| row[k] * b[k][j]).sum()))
}

/// Gyroscopic torque ω × Jω and its derivative [ω]× J − [Jω]×, J = diag(inertia).
pub(crate) fn gyroscopic(inertia: [f64; 3], omega: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let momentum = [0, 1, 2].map(|i| inertia[i] * omega[i]);
    let (left, right) = (skew(omega), skew(momentum));
    let slope = [0, 1, 2].map(|i| [0, 1, 2].map(|j| left[i][j] * inertia[j] - right[i][j]));
    (cross(omega, momentum), slope)
}

/// q̇ = ½ q∘(0, ω).
pub(crate) fn rate(q: &[f64], omega: &[f64], qdot: &mut [f64]) {
    qdot.copy_from_slice(&product(q, [0.0, 0.5 * omega[0], 0.5 * omega[1], 0.5 * omega[2]]));
}

/// q∘exp(δ/2): a turn by δ about the body's own axes.
pub(crate) fn retract(q: &mut [f64], delta: &[f64]) {
    let half = 0.5 * delta.iter().map(|d| d * d).sum::<f64>().sqrt();
    // sin(x)/x to round-off; the series where the quotient has no digits
    let s = 0.5 * if half < 1e-4 { 1.0 - half * half / 6.0 } else { half.sin() / half };
    let turned = product(q, [half.cos(), s * delta[0], s * delta[1], s * delta[2]]);
    q.copy_from_slice(&turned);
}

/// The solution of q = q̂ + ½ q∘(0, u): as q̂ = q∘(1, −u/2), q = q̂∘(1, u/2)/(1 + |u|²/4).
pub(crate) fn displace(q: &mut [f64], u: &[f64]) {
    let scale = 1.0 / (1.0 + 0.25 * u.iter().map(|u| u * u).sum::<f64>());
    let moved = product(q, [scale, 0.5 * scale * u[0], 0.5 * scale * u[1], 0.5 * scale * u[2]]);
    q.copy_from_slice(&moved);
}
