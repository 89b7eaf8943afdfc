//! Places and values in closed form.

use super::super::continuous::closed::Closed;
use super::*;
use std::f64::consts::{PI, TAU};

/// Extremes of closed columns on n intervals, and the evaluations beyond the samples.
fn of(columns: usize, breaks: &[f64], n: usize, function: impl FnMut(f64, usize, &mut [f64])) -> (Vec<Option<Extremes>>, usize) {
    let mut curve = Closed::new(columns, function);
    let (places, pieces, values) = curve.sampled(breaks, n);
    let samples = Samples { places: &places, pieces: &pieces, values: &values, between: None };
    let found = extrema(&mut curve, samples, breaks);
    (found, curve.evaluations)
}

fn single(breaks: &[f64], n: usize, function: impl Fn(f64, usize) -> f64) -> Extremes {
    of(1, breaks, n, |x, piece, out| out[0] = function(x, piece)).0[0].unwrap()
}

fn assert_near(found: Extremum, value: f64, at: f64, tolerance: f64) {
    assert!((found.at - at).abs() < tolerance, "place {} for {at}: {:e}", found.at, found.at - at);
    assert!((found.value - value).abs() <= 1e-13 * value.abs().max(1.0), "value {} for {value}", found.value);
}

#[test]
fn places_lie_between_the_samples() {
    for n in [30, 100, 360, 3600, 20_000] {
        let e = single(&[0.0, TAU], n, |x, _| (x - 1.234_567_8).sin());
        assert_near(e.max, 1.0, 1.234_567_8 + 0.5 * PI, 1e-11);
        assert_near(e.min, -1.0, 1.234_567_8 + 1.5 * PI, 1e-11);
        // e^{sin x} has its extremes where the sine has them
        let e = single(&[0.0, TAU], n, |x, _| (x - 0.3).sin().exp());
        assert_near(e.max, 1f64.exp(), 0.3 + 0.5 * PI, 1e-10);
    }
}

#[test]
fn noise_in_the_values_hardly_moves_the_place() {
    for n in [360, 3600] {
        for offset in [0.0, 100.0] {
            let mut seed = 1u64;
            let mut noise = || {
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                1e-13 * ((seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
            };
            let (found, _) = of(1, &[0.0, TAU], n, |x, _, out| out[0] = (offset + (x - 1.0).cos()) * (1.0 + noise()));
            let error = (found[0].unwrap().max.at - 1.0).abs();
            assert!(error < if offset == 0.0 { 3e-10 } else { 3e-8 }, "{n} samples, offset {offset}: {error:e}");
        }
    }
}

#[test]
fn a_sharp_peak_between_two_samples_wins() {
    let n = 360;
    let h = TAU / n as f64;
    // half-width h: two intervals wide; samples reach 0.8 of it at best. A broad peak of height 0.95 is elsewhere
    for shift in [0.5, 0.1, 0.37] {
        let at = (100.0 + shift) * h;
        let narrow = move |x: f64| h * h / ((x - at) * (x - at) + h * h);
        let peak = move |x: f64| narrow(x) + 0.95 * (-(x - 4.0) * (x - 4.0)).exp();
        let e = single(&[0.0, TAU], n, |x, _| peak(x));
        // the peak's slope displaces the peak; a Newton step from it is exact to 1e-12
        let slope = 0.95 * -2.0 * (at - 4.0) * (-(at - 4.0) * (at - 4.0)).exp();
        let expected = at + slope * h * h / 2.0;
        assert!((e.max.at - expected).abs() < 1e-10, "{:e}", e.max.at - expected);
        assert!((e.max.value - peak(e.max.at)).abs() < 1e-15 && e.max.value > 1.0);
    }
}

#[test]
fn one_sided_values_at_breaks_and_ends_take_part() {
    let breaks = [0.0, 1.0, 2.5, 4.0];
    let jumps = |x: f64, piece: usize| [x, 5.0 - x, 0.1 * x][piece];
    let e = single(&breaks, 57, jumps);
    assert_eq!((e.max.value, e.max.at, e.max.piece), (4.0, 1.0, 1));
    assert_eq!((e.min.value, e.min.at, e.min.piece), (0.0, 0.0, 0));
    let e = single(&breaks, 57, |x, piece| if piece == 1 { 0.0 } else { -x });
    assert_eq!((e.max.value, e.max.at, e.max.piece), (0.0, 0.0, 0));
    assert_eq!((e.min.value, e.min.at), (-4.0, 4.0));
    // a kink at a break is the same from both sides: the first piece
    let e = single(&breaks, 57, |x, _| -(x - 2.5).abs());
    assert_eq!((e.max.value, e.max.at, e.max.piece), (0.0, 2.5, 1));
    // an extreme close to a break
    let e = single(&breaks, 57, |x, piece| if piece == 1 { -(x - 1.0001) * (x - 1.0001) } else { -9.0 });
    assert_near(e.max, 0.0, 1.0001, 1e-10);
}

#[test]
fn equal_extremes_give_the_first_place() {
    for teeth in [2.0, 7.0, 30.0] {
        let e = single(&[0.0, TAU], 3600, |x, _| (teeth * x - 0.5).sin());
        assert_near(e.max, 1.0, (0.5 * PI + 0.5) / teeth, 1e-11);
        assert_near(e.min, -1.0, (1.5 * PI + 0.5) / teeth, 1e-11);
    }
    let e = single(&[0.0, TAU], 360, |x, _| x.cos());
    assert_eq!((e.max.at, e.max.value), (0.0, 1.0));
}

#[test]
fn constants_dwells_and_noise_give_the_first_place() {
    let (found, evaluations) = of(3, &[0.0, 1.0, 2.0, 3.0], 3600, |x, piece, out| {
        out[0] = 7.0 * (1.0 + 1e-15 * (1e5 * x).sin());
        // a rise, a dwell, a return
        out[1] = [0.5 - 0.5 * (PI * x).cos(), 1.0, 0.5 + 0.5 * (PI * (x - 2.0)).cos()][piece];
        out[2] = 1e-17 * (1e5 * x * x).sin();
    });
    let (constant, cam) = (found[0].unwrap(), found[1].unwrap());
    assert_eq!((constant.max.at, constant.min.at), (0.0, 0.0));
    assert_eq!((cam.max.at, cam.max.value, cam.min.at), (1.0, 1.0, 0.0));
    assert!(found[2].is_some());
    assert!(evaluations < 1500, "{evaluations} evaluations");
}

#[test]
fn undefined_values_are_skipped() {
    let (found, _) = of(3, &[0.0, TAU], 360, |x, _, out| {
        out[0] = f64::NAN;
        out[1] = if x > 3.0 && x < 5.0 { f64::NAN } else { (x - 1.0).sin() };
        out[2] = if x < 1.0 { f64::NAN } else { -x };
    });
    assert!(found[0].is_none());
    assert_near(found[1].unwrap().max, 1.0, 1.0 + 0.5 * PI, 1e-10);
    let e = found[2].unwrap();
    assert!(e.max.at > 1.0 && e.max.at < 1.02 && e.min.at == TAU);
}

#[test]
fn kinks_inside_of_a_piece_are_found_roughly() {
    let e = single(&[0.0, 3.0], 300, |x, _| -(x - 1.2345).abs());
    assert!((e.max.at - 1.2345).abs() < 1e-6, "{:e}", e.max.at - 1.2345);
}

#[test]
fn flat_extremes_are_found_within_what_flatness_allows() {
    let e = single(&[0.0, 3.0], 300, |x, _| -(x - 1.2345).powi(4));
    assert!((e.max.at - 1.2345).abs() < 1e-4 && e.max.value > -1e-16, "{:?}", e.max);
}

#[test]
fn forty_columns_share_their_evaluations() {
    let (found, evaluations) = of(40, &[0.0, TAU], 3600, |x, _, out| {
        for (c, y) in out.iter_mut().enumerate() {
            *y = (x + 0.1 * (c / 4) as f64).sin() * (1.0 + (c % 4) as f64) + 0.2 * (3.0 * x + c as f64).cos();
        }
    });
    assert!(found.iter().all(Option::is_some));
    assert!(evaluations < 40 * 2 * 30, "{evaluations} evaluations");
}

#[test]
fn nothing_has_no_extremes() {
    let (found, _) = of(1, &[0.0, 0.0], 1, |_, _, out| out[0] = 2.0);
    assert_eq!(found[0].unwrap().max.value, 2.0);
    let mut curve = Closed::new(1, |_, _, _: &mut [f64]| {});
    let samples = Samples { places: &[], pieces: &[], values: &[], between: None };
    assert_eq!(extrema(&mut curve, samples, &[]), [None]);
}
