//! Closed forms: what is resolved, what it costs, and what is said to be open.

use super::super::continuous::closed::Closed;
use super::super::extremum::extrema;
use super::super::quadrature::integrals;
use super::*;
use std::f64::consts::{PI, TAU};

/// A curve with its resolution.
fn of<F: FnMut(f64, usize, &mut [f64])>(columns: usize, breaks: &[f64], width: f64, function: F) -> (Closed<F>, Resolved) {
    let mut curve = Closed::new(columns, function);
    let found = on(&mut curve, &stretches(breaks), breaks, width).unwrap();
    (curve, found)
}

#[test]
fn the_polynomials_are_the_curve_everywhere() {
    let f = |x: f64| (x.cos().exp(), 1.0 / (1.01 + (3.0 * x).sin()), (40.0 * x).sin());
    let (_, found) = of(3, &[0.0, TAU], 1e-9, |x, _, out| (out[0], out[1], out[2]) = f(x));
    assert!(found.open.is_empty() && found.evaluations < 12_000, "{}", found.evaluations);
    let basis = Basis::new();
    for k in 0..10_000 {
        let x = TAU * (f64::from(k) + 0.37) / 10_000.0;
        let panel = &found.panels[found.panels.partition_point(|p| p.to < x)];
        let s = (2.0 * x - panel.from - panel.to) / panel.width();
        let (a, b, c) = f(x);
        for (column, (y, size)) in [(a, 2.8), (b, 100.0), (c, 1.0)].into_iter().enumerate() {
            let p = super::super::chebyshev::value(&basis.series(&panel.column(column)), s);
            assert!((p - y).abs() < 1e-8 * size, "column {column} at {x}: {:e}", p - y);
        }
    }
}

#[test]
fn oscillations_that_vanish_on_every_grid_are_not_mistaken_for_zero() {
    // zero at each of 360, 720, 3600 equal intervals
    for waves in [180.0, 720.0, 3600.0] {
        let (mut curve, found) = of(1, &[0.0, 1.0], 1e-9, |x, _, out| out[0] = (TAU * waves * x).sin());
        assert!(found.open.is_empty(), "{waves}: {:?}", found.open);
        let e = extrema(&mut curve, found.samples(), &[0.0, 1.0])[0].unwrap();
        assert!((e.max.value - 1.0).abs() < 1e-12 && (e.min.value + 1.0).abs() < 1e-12, "{waves}: {e:?}");
        let mut sum = [0.0];
        integrals(&mut curve, &found.panels, &found.noise, &mut sum).unwrap();
        assert!(sum[0].abs() < 1e-11, "{waves}: {:e}", sum[0]);
    }
}

#[test]
fn peaks_far_narrower_than_the_first_panels_win() {
    // algebraic peaks are felt far away: half-width a part of 1e6 of the range
    let at = 0.123_456;
    let (mut curve, found) = of(1, &[0.0, 1.0], 1e-9, |x, _, out| out[0] = 1e-12 / ((x - at).powi(2) + 1e-12));
    let e = extrema(&mut curve, found.samples(), &[0.0, 1.0])[0].unwrap();
    assert!((e.max.value - 1.0).abs() < 1e-9 && (e.max.at - at).abs() < 1e-10, "{e:?}");
    assert!(found.open.is_empty());
}

#[test]
fn jumps_edges_and_round_off_end_in_bounded_work() {
    let mut k = 0u64;
    let (_, found) = of(5, &[0.0, 1.0, 2.0], 1e-9, |x, piece, out| {
        k = k.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let noise = (k >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
        out[0] = if x < 0.3 { 1.0 } else { 2.0 };
        out[1] = if x < 0.7 { f64::NAN } else { x.sin() };
        out[2] = 1e-15 * noise;
        out[3] = (PI * x).sin() * (1.0 + 1e-12 * noise);
        out[4] = if piece == 0 { x } else { (x - 1.0).sqrt() };
    });
    assert!(found.open.is_empty(), "{:?}", found.open);
    assert!(found.evaluations < 4000, "{}", found.evaluations);
    assert!(found.places.is_sorted() && found.pieces.is_sorted() && found.places.len() == found.pieces.len());
}

#[test]
fn what_cannot_be_resolved_is_said() {
    let mut k = 0u64;
    let (_, found) = of(4, &[0.0, 1.0], 1e-9, |x, _, out| {
        k = k.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        out[0] = x;
        // a pole, an endless oscillation, one that is too fast
        out[1] = 1.0 / (x - 0.317);
        out[2] = (1.0 / x).sin();
        out[3] = (1e7 * x).sin();
    });
    assert_eq!(found.open.iter().map(|o| o.column).collect::<Vec<_>>(), [1, 2, 3], "{:?}", found.open);
    assert!((found.open[0].at - 0.317).abs() < 1e-3, "{:?}", found.open);
    assert!(found.evaluations <= MOST_EVALUATIONS + 100);
}

#[test]
fn smooth_motions_cost_little() {
    let (_, found) = of(20, &[0.0, TAU], 1e-9, |x, _, out| {
        for (c, y) in out.iter_mut().enumerate() {
            *y = (x + c as f64).sin() / (1.3 + (2.0 * x - c as f64).cos());
        }
    });
    assert!(found.open.is_empty() && found.evaluations < 600, "{}", found.evaluations);
}

/// What steps of a width leave of a curve: a value is known nearly for less, and the curve is smooth on each step.
struct Stepped<F> {
    step: f64,
    function: F,
    evaluations: [usize; 2],
}

impl<F: Fn(f64) -> f64> Curve for Stepped<F> {
    type Error = std::convert::Infallible;

    fn columns(&self) -> usize {
        1
    }

    fn smooth(&self, _: f64, _: usize) -> f64 {
        self.step
    }

    fn eval(&mut self, x: f64, _: usize, out: &mut [f64]) -> Result<(), Self::Error> {
        self.evaluations[0] += 1;
        out[0] = (self.function)(x);
        Ok(())
    }

    fn look(&mut self, x: f64, _: usize, out: &mut [f64]) -> Result<(), Self::Error> {
        self.evaluations[1] += 1;
        out[0] = (self.function)(x) * (1.0 + 1e-9 * (1e9 * x).sin());
        Ok(())
    }
}

#[test]
fn on_a_step_every_second_place_is_enough_and_extremes_are_those_of_the_curve() {
    // forty equal waves on a slope, a hundred steps to a wave; each step a panel
    let f = |x: f64| (TAU * 40.0 * x).sin() + 1e-7 * x;
    let run = |step: f64, width: f64| {
        let mut curve = Stepped { step, function: f, evaluations: [0; 2] };
        let all: Vec<(f64, f64, usize)> = (0..4000).map(|i| (f64::from(i) / 4e3, f64::from(i + 1) / 4e3, 0)).collect();
        let found = on(&mut curve, &all, &[0.0, 1.0], width).unwrap();
        assert!(found.open.is_empty());
        let looks = curve.evaluations[1];
        curve.evaluations = [0; 2];
        let max = extrema(&mut curve, found.samples(), &[0.0, 1.0])[0].unwrap().max;
        (looks, curve.evaluations, max)
    };
    let (few, [exact, looks], max) = run(1.0 / 4e3, 1e-7);
    let (many, _, _) = run(0.0, 1e-7);
    assert!(few < 4000 * 8 + 100 && many > 4000 * 15, "{few} of {many}");
    // one value for each wave that could be the highest, and the place of the one that is
    assert!(looks == 0 && exact < 40 + 100, "{exact} {looks}");
    let top = 39.25 / 40.0;
    assert!((max.at - top).abs() < 1e-10 && (max.value - f(top)).abs() < 1e-13, "{max:?}");
    // what eight places do not resolve is looked at in all fifteen
    let wave = |x: f64| (TAU * 4000.0 * x).sin();
    let mut curve = Stepped { step: 1.0 / 4e3, function: wave, evaluations: [0; 2] };
    let stretches: Vec<(f64, f64, usize)> = (0..4000).map(|i| (f64::from(i) / 4e3, f64::from(i + 1) / 4e3, 0)).collect();
    let found = on(&mut curve, &stretches, &[0.0, 1.0], 1e-5).unwrap();
    assert!(found.open.is_empty() && curve.evaluations[1] > 4000 * 15, "{:?}", curve.evaluations);
}
