//! Integrals of all columns of a curve.

use super::continuous::Curve;
use super::panel::{NODES, Panel, node};
use super::resolve::NEXT_TO;
use std::borrow::Cow;

/// Goal: error of a column's integral relative to the integral of its magnitude.
pub const TOLERANCE: f64 = 1e-12;

/// Work stops after so many evaluations.
const MOST_EVALUATIONS: usize = 30_000;

/// Panels narrower than this part of the whole are not halved again.
const NARROWEST: f64 = 1e-13;

/// How well integrals are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Evaluations of the curve.
    pub evaluations: usize,
    /// Largest estimated error of a column, relative to the integral of its magnitude.
    pub error: f64,
    /// Whether every panel met its share of the goal.
    pub converged: bool,
}

/// ∫ column dx of each column over `panels`, which together cover the range of a curve, into `out` (columns).
///
/// Gauss-Kronrod rules of 7 and 15 points on panels that are halved until each column's error estimate is below [`TOLERANCE`]
/// times ∫|column|, shared among the panels by width. Weights and the error estimate are those of QUADPACK (Piessens et al.,
/// Springer 1983, routine QK15). `noise` (columns) is the round-off of values, below which no column is followed; infinite for a
/// column that nobody asks for. A column that is NaN somewhere has the integral NaN. Work is bounded: see [`Quality::converged`].
pub(crate) fn integrals<C: Curve>(curve: &mut C, panels: &[Panel], noise: &[f64], out: &mut [f64]) -> Result<Quality, C::Error> {
    out.fill(0.0);
    let most = MOST_EVALUATIONS.max(4 * NODES * panels.len());
    let mut quality = Quality { evaluations: 0, error: 0.0, converged: true };
    let whole: f64 = panels.iter().map(Panel::width).sum();
    let mut waiting: Vec<(Cow<'_, Panel>, Vec<Column>)> = panels.iter().map(|p| (Cow::Borrowed(p), columns(p))).collect();
    let mut magnitude = vec![0.0; out.len()];
    for (_, columns) in &waiting {
        magnitude.iter_mut().zip(columns).for_each(|(m, c)| *m += c.magnitude);
    }
    let mut error = vec![0.0; magnitude.len()];
    while let Some((panel, sums)) = waiting.pop() {
        let share = TOLERANCE * panel.width() / whole;
        // NaN compares as good enough
        let beyond = |c: &Column, m: f64, noise: f64| {
            c.error > share * m && c.error > 50.0 * f64::EPSILON * c.magnitude && c.error > noise * panel.width()
        };
        let poor = sums.iter().zip(&magnitude).zip(noise).any(|((c, m), noise)| beyond(c, *m, *noise));
        let exhausted = quality.evaluations + 2 * NODES > most || panel.width() < NARROWEST * whole;
        if poor && !exhausted {
            let middle = 0.5 * (panel.from + panel.to);
            let halves = [(middle, panel.to), (panel.from, middle)].map(|(from, to)| Panel::of(curve, from, to, panel.piece));
            quality.evaluations += 2 * NODES;
            match halves {
                [Ok(second), Ok(first)] => {
                    waiting.extend([second, first].map(|half| {
                        let sums = columns(&half);
                        (Cow::Owned(half), sums)
                    }));
                    continue;
                }
                // next to a dead point places can no longer be reached: the panel counts as it is
                [Err(_), _] | [_, Err(_)] if panel.width() < NEXT_TO * whole => {}
                [Err(lost), _] | [_, Err(lost)] => return Err(lost),
            }
        }
        quality.converged &= !poor;
        for ((out, error), column) in out.iter_mut().zip(&mut error).zip(&sums) {
            *out += column.integral;
            *error += column.error;
        }
    }
    let asked = error.iter().zip(&magnitude).zip(noise).filter(|((e, m), noise)| **m > 0.0 && **e > **noise * whole);
    quality.error = asked.map(|((e, m), _)| e / m).fold(0.0, f64::max);
    Ok(quality)
}

/// What one panel gives for one column.
struct Column {
    integral: f64,
    magnitude: f64,
    error: f64,
}

/// The columns of a panel.
fn columns(panel: &Panel) -> Vec<Column> {
    let half = 0.5 * panel.width();
    let column = |c: usize| {
        let values = panel.column(c);
        let sum = |f: &dyn Fn(f64, (f64, f64, f64)) -> f64| -> f64 { (0..NODES).map(|j| f(values[j], node(j))).sum() };
        let kronrod = sum(&|y, (_, w, _)| w * y);
        let gauss = sum(&|y, (_, _, w)| w * y);
        let magnitude = sum(&|y, (_, w, _)| w * y.abs());
        let spread = sum(&|y, (_, w, _)| w * (y - 0.5 * kronrod).abs());
        // the 15-point rule is far better than the difference to the 7-point one
        let difference = (kronrod - gauss).abs();
        let error = if spread > 0.0 { spread * (200.0 * difference / spread).powf(1.5).min(1.0) } else { difference };
        Column { integral: half * kronrod, magnitude: half * magnitude, error: half * error }
    };
    (0..panel.values.len() / NODES).map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::super::continuous::closed::Closed;
    use super::*;
    use std::f64::consts::{PI, TAU};

    /// Eight panels on a piece.
    fn split<C: Curve<Error = std::convert::Infallible>>(curve: &mut C, ends: &[f64], piece: usize) -> Vec<Panel> {
        let at = |k: usize| ends[0] + (ends[1] - ends[0]) * k as f64 / 8.0;
        (0..8).map(|k| Panel::of(curve, at(k), at(k + 1), piece).unwrap()).collect()
    }

    fn integrate(columns: usize, breaks: &[f64], function: impl FnMut(f64, usize, &mut [f64])) -> (Vec<f64>, Quality) {
        let mut out = vec![0.0; columns];
        let mut curve = Closed::new(columns, function);
        let panels: Vec<Panel> = breaks.windows(2).enumerate().flat_map(|(piece, ends)| split(&mut curve, ends, piece)).collect();
        let first = panels.len() * NODES;
        let mut quality = integrals(&mut curve, &panels, &vec![0.0; columns], &mut out).unwrap();
        quality.evaluations += first;
        (out, quality)
    }

    #[test]
    fn the_rule_is_exact_for_polynomials_of_degree_22() {
        let mut powers = Closed::new(23, |x: f64, _, out: &mut [f64]| out.iter_mut().enumerate().for_each(|(k, y)| *y = x.powi(k as i32)));
        let panel = Panel::of(&mut powers, 0.0, 1.0, 0).unwrap();
        for (k, column) in columns(&panel).iter().enumerate() {
            assert!((column.integral - 1.0 / (k + 1) as f64).abs() < 2e-16, "x^{k}: {:e}", column.integral);
        }
    }

    #[test]
    fn smooth_columns_and_high_harmonics() {
        let (out, quality) = integrate(4, &[0.0, TAU], |x, _, out| {
            out[0] = x.sin().powi(2);
            out[1] = x.cos().exp();
            out[2] = 1.0 + (50.0 * x).cos() + (31.0 * x).sin();
            out[3] = 3.0;
        });
        // ∫ exp(cos x) = 2π I₀(1)
        let expected = [PI, TAU * 1.266_065_877_752_008_3, TAU, 3.0 * TAU];
        for (x, y) in out.iter().zip(expected) {
            assert!((x / y - 1.0).abs() < 1e-13, "{x} for {y}");
        }
        assert!(quality.converged && quality.error < TOLERANCE && quality.evaluations < 4000, "{quality:?}");
    }

    #[test]
    fn kinks_and_jumps_at_breaks_cost_nothing() {
        let breaks = [0.0, 1.0, PI, 4.0];
        let (out, quality) = integrate(2, &breaks, |x, piece, out| {
            out[0] = (x - 1.0).abs() + (x - PI).abs();
            out[1] = [1.0, -2.0, x][piece];
        });
        let kinks = 0.5 + 4.5 + 0.5 * PI * PI + 0.5 * (4.0 - PI) * (4.0 - PI);
        let jumps = 1.0 - 2.0 * (PI - 1.0) + 0.5 * (16.0 - PI * PI);
        assert!((out[0] / kinks - 1.0).abs() < 1e-14 && (out[1] / jumps - 1.0).abs() < 1e-14, "{out:?}");
        assert_eq!(quality.evaluations, 24 * NODES, "{quality:?}");
    }

    #[test]
    fn a_peak_a_kink_and_a_jump_inside_of_a_piece_are_found() {
        let (out, quality) = integrate(3, &[-1.0, 1.0], |x, _, out| {
            out[0] = 1e-2 / (x * x + 1e-4);
            out[1] = (x - 0.3).abs();
            out[2] = if x < 0.3 { 1.0 } else { 2.0 };
        });
        let expected = [2.0 * 100f64.atan(), 0.5 * (1.69 + 0.49), 1.3 + 1.4];
        for (x, y) in out.iter().zip(expected) {
            assert!((x / y - 1.0).abs() < 1e-12, "{x} for {y}");
        }
        assert!(quality.evaluations < 5000, "{quality:?}");
    }

    #[test]
    fn noise_an_integral_of_zero_and_nan_end_in_bounded_work() {
        let mut k = 0u64;
        let (out, quality) = integrate(4, &[0.0, TAU], |x, _, out| {
            k = k.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let noise = (k >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
            out[0] = x.cos() * (1.0 + 1e-13 * noise);
            out[1] = 0.0;
            out[2] = if x > 1.0 { f64::NAN } else { 1.0 };
            out[3] = noise;
        });
        assert!(out[0].abs() < 1e-12 && out[1] == 0.0 && out[2].is_nan());
        assert!(!quality.converged && quality.evaluations <= MOST_EVALUATIONS + 8 * NODES, "{quality:?}");
    }

    #[test]
    fn nothing_to_integrate() {
        assert_eq!(integrate(1, &[], |_, _, _| {}).0, [0.0]);
        assert_eq!(integrate(1, &[2.0, 2.0], |_, _, out| out[0] = 1.0).0, [0.0]);
        assert_eq!(integrate(0, &[0.0, 2.0], |_, _, _| {}).0, [0.0; 0]);
    }
}
