//! Coefficients of tables: straight lines and cubic splines.
//!
//! The cubic spline is found by its slopes sₖ at the points xₖ. With hₖ = xₖ₊₁ − xₖ and dₖ = (yₖ₊₁ − yₖ)/hₖ, the second
//! derivative is continuous at an inner point if
//!
//! ```text
//! hₖ sₖ₋₁ + 2(hₖ₋₁ + hₖ) sₖ + hₖ₋₁ sₖ₊₁ = 3(hₖ dₖ₋₁ + hₖ₋₁ dₖ)
//! ```
//!
//! (de Boor, *A Practical Guide to Splines*, 1978, chapter IV). At the ends the third derivative is continuous at the
//! second and the last but one point ("not-a-knot"), which keeps the fourth order of the inner error and gives cubics back
//! exactly; a natural end would force y'' = 0 where a motor curve has none. Periodic tables wrap the inner equation.

/// Lines c₀ + c₁ s per segment.
pub(super) fn lines(x: &[f64], y: &[f64]) -> Vec<[f64; 4]> {
    (0..x.len() - 1).map(|k| [y[k], (y[k + 1] - y[k]) / (x[k + 1] - x[k]), 0.0, 0.0]).collect()
}

/// Cubics c₀ + c₁ s + c₂ s² + c₃ s³ per segment. Two points give a line, three a parabola.
pub(super) fn cubics(x: &[f64], y: &[f64], periodic: bool) -> Vec<[f64; 4]> {
    let n = x.len() - 1;
    let h: Vec<f64> = (0..n).map(|k| x[k + 1] - x[k]).collect();
    let d: Vec<f64> = (0..n).map(|k| (y[k + 1] - y[k]) / h[k]).collect();
    let slopes = match (n, periodic) {
        (1, false) => vec![d[0]; 2],
        (2, false) => {
            // the parabola through three points
            let bend = (d[1] - d[0]) / (h[0] + h[1]);
            vec![d[0] - bend * h[0], d[0] + bend * h[0], d[1] + bend * h[1]]
        }
        (_, false) => open_slopes(&h, &d),
        (_, true) => periodic_slopes(&h, &d),
    };
    (0..n)
        .map(|k| {
            let (s0, s1) = (slopes[k], slopes[k + 1]);
            [y[k], s0, (3.0 * d[k] - 2.0 * s0 - s1) / h[k], (s0 + s1 - 2.0 * d[k]) / (h[k] * h[k])]
        })
        .collect()
}

/// Slopes with not-a-knot ends, at least three segments.
fn open_slopes(h: &[f64], d: &[f64]) -> Vec<f64> {
    let n = h.len();
    let mut rows: Vec<[f64; 4]> = vec![[0.0; 4]; n + 1]; // below, diagonal, above, right-hand side
    for k in 1..n {
        rows[k] = [h[k], 2.0 * (h[k - 1] + h[k]), h[k - 1], 3.0 * (h[k] * d[k - 1] + h[k - 1] * d[k])];
    }
    let end = |h0: f64, h1: f64, d0: f64, d1: f64| {
        let sum = h0 + h1;
        (h1, sum, ((h0 + 2.0 * sum) * h1 * d0 + h0 * h0 * d1) / sum)
    };
    let (diagonal, beside, right) = end(h[0], h[1], d[0], d[1]);
    rows[0] = [0.0, diagonal, beside, right];
    let (diagonal, beside, right) = end(h[n - 1], h[n - 2], d[n - 1], d[n - 2]);
    rows[n] = [beside, diagonal, 0.0, right];
    tridiagonal(rows)
}

/// Slopes of the periodic spline.
fn periodic_slopes(h: &[f64], d: &[f64]) -> Vec<f64> {
    let n = h.len();
    if n <= 2 {
        // one segment: its ends are equal, so it is a constant; two: each point is both neighbours of the other
        let slopes = if n == 1 { [0.0, 0.0] } else { two_slopes(h, d) };
        let mut all = slopes[..n].to_vec();
        all.push(slopes[0]);
        return all;
    }
    // unknowns s₀ … sₙ₋₁; the corner entries by a rank-one correction (Sherman-Morrison)
    let before = |k: usize| if k == 0 { n - 1 } else { k - 1 };
    let mut rows: Vec<[f64; 4]> = (0..n)
        .map(|k| {
            let p = before(k);
            [h[k], 2.0 * (h[p] + h[k]), h[p], 3.0 * (h[k] * d[p] + h[p] * d[k])]
        })
        .collect();
    let (top, bottom) = (rows[0][0], rows[n - 1][2]);
    let gamma = -rows[0][1];
    rows[0][1] -= gamma;
    rows[n - 1][1] -= top * bottom / gamma;
    let mut unit = rows.clone();
    for row in &mut unit {
        row[3] = 0.0;
    }
    unit[0][3] = gamma;
    unit[n - 1][3] = bottom;
    let (plain, correction) = (tridiagonal(rows), tridiagonal(unit));
    let factor = (plain[0] + top * plain[n - 1] / gamma) / (1.0 + correction[0] + top * correction[n - 1] / gamma);
    let mut slopes: Vec<f64> = plain.iter().zip(&correction).map(|(s, c)| s - factor * c).collect();
    slopes.push(slopes[0]);
    slopes
}

/// Slopes of a periodic spline of two segments: both neighbours of a point are the other one.
fn two_slopes(h: &[f64], d: &[f64]) -> [f64; 2] {
    let sum = h[0] + h[1];
    // 2(h₀+h₁) s₀ + (h₀+h₁) s₁ = r and the same with s₀, s₁ exchanged
    let right = [3.0 * (h[0] * d[1] + h[1] * d[0]), 3.0 * (h[1] * d[0] + h[0] * d[1])];
    [(2.0 * right[0] - right[1]) / (3.0 * sum), (2.0 * right[1] - right[0]) / (3.0 * sum)]
}

/// Solves rows [below, diagonal, above, right-hand side] by elimination; the systems here are diagonally dominant or nearly so.
fn tridiagonal(mut rows: Vec<[f64; 4]>) -> Vec<f64> {
    let n = rows.len();
    for k in 1..n {
        let factor = rows[k][0] / rows[k - 1][1];
        rows[k][1] -= factor * rows[k - 1][2];
        rows[k][3] -= factor * rows[k - 1][3];
    }
    let mut solution = vec![0.0; n];
    for k in (0..n).rev() {
        let beyond = if k + 1 < n { rows[k][2] * solution[k + 1] } else { 0.0 };
        solution[k] = (rows[k][3] - beyond) / rows[k][1];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn not_a_knot_gives_a_cubic_back() {
        let f = |x: f64| 2.0 - x + 3.0 * x * x - 0.5 * x * x * x;
        let x = [-1.0, -0.2, 0.5, 1.7, 2.0, 3.5];
        let y = x.map(f);
        for (k, piece) in cubics(&x, &y, false).into_iter().enumerate() {
            let s = 0.6 * (x[k + 1] - x[k]);
            let value = piece[0] + s * (piece[1] + s * (piece[2] + s * piece[3]));
            assert!((value - f(x[k] + s)).abs() < 1e-13, "{k}");
        }
    }

    #[test]
    fn three_points_give_their_parabola() {
        let x = [0.0, 1.0, 3.0];
        let pieces = cubics(&x, &x.map(|x| x * x), false);
        for (k, piece) in pieces.into_iter().enumerate() {
            assert!((piece[1] - 2.0 * x[k]).abs() < 1e-14 && (piece[2] - 1.0).abs() < 1e-14 && piece[3].abs() < 1e-14);
        }
    }
}
