//! Weights of Newmark's scheme that cannot be used with constraints at position level.

use super::fault::Fault;

/// The fault of weights that are unstable there.
pub(crate) fn newmark_fault(place: String, alpha: f64, beta: f64) -> Option<Fault> {
    let message = unstable_at_position_level(alpha, beta)?;
    let expected = "at `level: position` a beta of at least 1/2 and an alpha above beta/2";
    Some(Fault::new("unstable", place, message, expected).help("use `level: stabilized`, or for example `alpha: 0.3025, beta: 0.6`"))
}

/// Why Newmark's scheme cannot be used with constraints at position level; `None` where it can.
///
/// Where a constraint prescribes the displacement, q₊ = q + h v + h² ((1/2 − β) a + β a₊) and v₊ = v + h ((1 − γ) a + γ a₊)
/// leave for the error of the acceleration, with v eliminated, β a₊₊ + (γ + 1/2 − 2β) a₊ + (1/2 + β − γ) a = 0. Its
/// roots lie inside of the unit circle if γ > 1/2 and 2β > γ; with γ = 1/2 they lie on it if 4β > 1. At (1/6, 1/2) they are
/// −2 ± √3: the constraint forces grow 3.7 times a step. `alpha` is β, `beta` is γ.
fn unstable_at_position_level(alpha: f64, beta: f64) -> Option<String> {
    if beta >= 0.5 && 2.0 * alpha > beta {
        return None;
    }
    let (a, b, c) = (alpha, beta + 0.5 - 2.0 * alpha, 0.5 + alpha - beta);
    let real = b * b - 4.0 * a * c;
    let root = if a == 0.0 {
        f64::INFINITY
    } else if real >= 0.0 {
        (b.abs() + real.sqrt()) / (2.0 * a)
    } else {
        (c / a).sqrt()
    };
    let how = if root > 1.0 + 1e-9 { format!("{root:.2} times each step") } else { "step by step".to_owned() };
    Some(format!("`newmark` with alpha = {alpha:.4}, beta = {beta:.4}: errors of the constraint forces grow {how}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The recursion itself, step by step: q stays 0, the accelerations must not grow.
    fn growth(alpha: f64, beta: f64) -> f64 {
        let (mut v, mut a, steps) = (0.3, 1.0, 400);
        for _ in 0..steps {
            // 0 = v + (1/2 − β) a + β a₊ with h = 1
            let next: f64 = -(v + (0.5 - alpha) * a) / alpha;
            v += (1.0 - beta) * a + beta * next;
            a = next;
            if a.abs() > 1e100 {
                return f64::INFINITY;
            }
        }
        a.abs()
    }

    #[test]
    fn the_refused_weights_are_those_that_grow() {
        for (alpha, beta) in [(1.0 / 6.0, 0.5), (0.25, 0.5), (0.2, 0.6), (0.3, 0.45), (0.25, 0.55)] {
            assert!(unstable_at_position_level(alpha, beta).is_some() && growth(alpha, beta) > 10.0, "{alpha} {beta}");
        }
        for (alpha, beta) in [(0.26, 0.5), (0.3025, 0.6), (1.0, 1.5), (0.4, 0.7)] {
            assert!(unstable_at_position_level(alpha, beta).is_none() && growth(alpha, beta) < 10.0, "{alpha} {beta}");
        }
        assert!(unstable_at_position_level(1.0 / 6.0, 0.5).unwrap().contains("3.73 times"));
        assert!(unstable_at_position_level(0.0, 0.5).is_some());
    }
}
