//! Integrals of all columns of a curve.

use super::continuous::Curve;

/// Goal: error of a column's integral relative to the integral of its magnitude.
pub const TOLERANCE: f64 = 1e-12;

/// No panel begins wider than this part of the whole, so that narrow features between the nodes are seen.
const FIRST_PANELS: f64 = 16.0;

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

/// ∫ column dx over [from, to] for each column, into `out` (columns); `breaks` is `from, switches …, to`.
///
/// Gauss-Kronrod rules of 7 and 15 points on panels that never reach over a break and are halved until each column's error
/// estimate is below [`TOLERANCE`] times ∫|column|, shared among the panels by width. Nodes, weights and the error estimate are
/// those of QUADPACK (Piessens et al., Springer 1983, routine QK15). A column that is NaN somewhere has the integral NaN. Work is
/// bounded: see [`Quality::converged`].
pub fn integrals<C: Curve>(curve: &mut C, breaks: &[f64], out: &mut [f64]) -> Result<Quality, C::Error> {
    out.fill(0.0);
    let mut quality = Quality { evaluations: 0, error: 0.0, converged: true };
    let (Some(from), Some(to)) = (breaks.first(), breaks.last()) else { return Ok(quality) };
    let whole = to - from;
    let mut rule = Rule::new(curve.columns());
    let mut waiting = Vec::new();
    let mut magnitude = vec![0.0; curve.columns()];
    for (piece, ends) in breaks.windows(2).enumerate() {
        let width = ends[1] - ends[0];
        let panels = (FIRST_PANELS * width / whole).ceil().clamp(0.0, FIRST_PANELS) as usize;
        for k in 0..panels {
            let at = |k: usize| if k == panels { ends[1] } else { ends[0] + width * k as f64 / panels as f64 };
            let panel = rule.panel(curve, at(k), at(k + 1), piece)?;
            magnitude.iter_mut().zip(&panel.columns).for_each(|(m, c)| *m += c.magnitude);
            waiting.push(panel);
        }
    }
    quality.evaluations = waiting.len() * NODES;

    let mut error = vec![0.0; magnitude.len()];
    while let Some(panel) = waiting.pop() {
        let share = TOLERANCE * (panel.to - panel.from) / whole;
        // NaN compares as good enough
        let poor = panel.columns.iter().zip(&magnitude).any(|(c, m)| c.error > share * m && c.error > 50.0 * f64::EPSILON * c.magnitude);
        let exhausted = quality.evaluations + 2 * NODES > MOST_EVALUATIONS || panel.to - panel.from < NARROWEST * whole;
        if poor && !exhausted {
            let middle = 0.5 * (panel.from + panel.to);
            waiting.push(rule.panel(curve, middle, panel.to, panel.piece)?);
            waiting.push(rule.panel(curve, panel.from, middle, panel.piece)?);
            quality.evaluations += 2 * NODES;
            continue;
        }
        quality.converged &= !poor;
        for ((out, error), column) in out.iter_mut().zip(&mut error).zip(&panel.columns) {
            *out += column.integral;
            *error += column.error;
        }
    }
    let relative = error.iter().zip(&magnitude).filter(|(_, m)| **m > 0.0).map(|(e, m)| e / m);
    quality.error = relative.fold(0.0, f64::max);
    Ok(quality)
}

/// Number of nodes of the Kronrod rule.
const NODES: usize = 15;

/// Kronrod nodes x ≥ 0 with their weights, and the Gauss weight of every second one.
const RULE: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (0.949_107_912_342_758_5, 0.063_092_092_629_978_56, 0.129_484_966_168_869_7),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0),
    (0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_67),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9),
    (0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0),
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
];

/// What one panel gives for one column.
struct Column {
    integral: f64,
    magnitude: f64,
    error: f64,
}

struct Panel {
    from: f64,
    to: f64,
    piece: usize,
    columns: Vec<Column>,
}

/// The rule with its workspace.
struct Rule {
    /// Nodes on [−1, 1] with Kronrod and Gauss weights.
    nodes: [(f64, f64, f64); NODES],
    /// Values at the nodes (NODES × columns).
    values: Vec<f64>,
}

impl Rule {
    fn new(columns: usize) -> Self {
        let nodes = std::array::from_fn(|k| {
            let (x, kronrod, gauss) = RULE[k.min(NODES - 1 - k)];
            (if k < 7 { -x } else { x }, kronrod, gauss)
        });
        Self { nodes, values: vec![0.0; NODES * columns] }
    }

    fn panel<C: Curve>(&mut self, curve: &mut C, from: f64, to: f64, piece: usize) -> Result<Panel, C::Error> {
        let n = curve.columns();
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        for ((x, _, _), out) in self.nodes.iter().zip(self.values.chunks_exact_mut(n.max(1))) {
            curve.eval(middle + half * x, piece, out)?;
        }
        let column = |c: usize| {
            let values = || self.nodes.iter().zip(self.values.iter().skip(c).step_by(n));
            let kronrod: f64 = values().map(|((_, w, _), y)| w * y).sum();
            let gauss: f64 = values().map(|((_, _, w), y)| w * y).sum();
            let magnitude: f64 = values().map(|((_, w, _), y)| w * y.abs()).sum();
            let spread: f64 = values().map(|((_, w, _), y)| w * (y - 0.5 * kronrod).abs()).sum();
            // the 15-point rule is far better than the difference to the 7-point one
            let difference = (kronrod - gauss).abs();
            let error = if spread > 0.0 { spread * (200.0 * difference / spread).powf(1.5).min(1.0) } else { difference };
            Column { integral: half * kronrod, magnitude: half * magnitude, error: half * error }
        };
        Ok(Panel { from, to, piece, columns: (0..n).map(column).collect() })
    }
}

#[cfg(test)]
mod tests {
    use super::super::continuous::closed::Closed;
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn integrate(columns: usize, breaks: &[f64], function: impl FnMut(f64, usize, &mut [f64])) -> (Vec<f64>, Quality) {
        let mut out = vec![0.0; columns];
        let quality = integrals(&mut Closed::new(columns, function), breaks, &mut out).unwrap();
        (out, quality)
    }

    #[test]
    fn the_rule_is_exact_for_polynomials_of_degree_22() {
        let mut rule = Rule::new(23);
        let mut powers = Closed::new(23, |x: f64, _, out: &mut [f64]| out.iter_mut().enumerate().for_each(|(k, y)| *y = x.powi(k as i32)));
        let panel = rule.panel(&mut powers, 0.0, 1.0, 0).unwrap();
        for (k, column) in panel.columns.iter().enumerate() {
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
        assert!(quality.evaluations <= 18 * NODES, "{quality:?}");
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
        assert!(!quality.converged && quality.evaluations <= MOST_EVALUATIONS, "{quality:?}");
    }

    #[test]
    fn nothing_to_integrate() {
        assert_eq!(integrate(1, &[], |_, _, _| {}).0, [0.0]);
        assert_eq!(integrate(1, &[2.0, 2.0], |_, _, out| out[0] = 1.0).0, [0.0]);
        assert_eq!(integrate(0, &[0.0, 2.0], |_, _, _| {}).0, [0.0; 0]);
    }
}
