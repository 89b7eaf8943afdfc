//! Curves that go over their own way again: drawn twice, the dashes of one pass fill the gaps of the other.

use super::thin::Point;
use std::collections::HashMap;

/// Distance between places that are looked at, pixels, and from an earlier one at which a curve goes over its own way.
const STEP: f64 = 0.75;
const NEAR: f64 = 0.8;
/// Way, pixels, behind which a place is another one, and over which a curve must stay on its own way: where it crosses itself, it goes on.
const APART: f64 = 6.0;
const LEAST: f64 = 12.0;

/// The parts of a curve that do not go over an earlier part of it.
pub(super) fn once(points: &[Point]) -> Vec<Vec<Point>> {
    let places = evenly(points);
    let again = again(&places);
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let mut part: Vec<Point> = Vec::new();
    let least = (LEAST / STEP) as usize;
    let mut k = 0;
    while k < places.len() {
        let run = again[k..].iter().take_while(|again| **again).count();
        if run < least {
            part.extend(&places[k..(k + run + 1).min(places.len())]);
            k += run + 1;
        } else {
            parts.push(std::mem::take(&mut part));
            k += run;
        }
    }
    parts.push(part);
    parts.retain(|part| !part.is_empty());
    parts
}

/// Places along a curve, its points among them.
fn evenly(points: &[Point]) -> Vec<Point> {
    let mut places: Vec<Point> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let way = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let count = (way[0].hypot(way[1]) / STEP).ceil().max(1.0);
        places.extend((1..=count as usize).map(|k| [0, 1].map(|i| pair[0][i] + way[i] * k as f64 / count)));
    }
    places
}

/// For each place whether the curve was there before.
fn again(places: &[Point]) -> Vec<bool> {
    let mut known: HashMap<[i64; 2], Vec<(f64, Point)>> = HashMap::new();
    let cell = |at: Point| at.map(|x| (x / NEAR).floor() as i64);
    let (mut gone, mut last) = (0.0, places.first().copied().unwrap_or_default());
    let mut found = Vec::with_capacity(places.len());
    for &at in places {
        gone += (at[0] - last[0]).hypot(at[1] - last[1]);
        last = at;
        let [i, k] = cell(at);
        let around = (-1..=1).flat_map(|a| (-1..=1).map(move |b| [i + a, k + b]));
        let mut before = around.filter_map(|cell| known.get(&cell)).flatten();
        let again = before.any(|(way, p)| gone - way > APART && (p[0] - at[0]).hypot(p[1] - at[1]) < NEAR);
        found.push(again);
        if !again {
            known.entry([i, k]).or_default().push((gone, at));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::thin::length;

    fn lengths(points: &[Point]) -> Vec<f64> {
        once(points).iter().map(|part| length(part)).collect()
    }

    fn circle(turns: f64) -> Vec<Point> {
        (0..=1000).map(|k| (std::f64::consts::TAU * turns * f64::from(k) / 1000.0).sin_cos()).map(|(s, c)| [100.0 * c, 100.0 * s]).collect()
    }

    #[test]
    fn what_is_retraced_is_left_out() {
        let [there, back, beyond] = [[0.0, 0.0], [100.0, 0.0], [-50.0, 0.0]];
        let close = |found: &[f64], right: &[f64]| {
            assert!(found.len() == right.len() && found.iter().zip(right).all(|(a, b)| (a - b).abs() < 8.0), "{found:?} {right:?}");
        };
        close(&lengths(&[there, back]), &[100.0]);
        close(&lengths(&[there, back, there]), &[100.0]);
        close(&lengths(&[there, back, beyond]), &[100.0, 50.0]);
        close(&lengths(&circle(1.0)), &[628.0]);
        close(&lengths(&circle(3.0)), &[628.0]);
    }

    #[test]
    fn a_curve_that_crosses_itself_goes_on() {
        let eight: Vec<Point> =
            (0..=1000).map(|k| f64::from(k) * std::f64::consts::TAU / 1000.0).map(|t| [100.0 * t.sin(), 60.0 * (2.0 * t).sin()]).collect();
        assert_eq!(once(&eight).len(), 1);
        assert!((lengths(&eight)[0] - length(&eight)).abs() < 2.0);
        assert!(once(&[]).is_empty());
        assert_eq!(once(&[[1.0, 2.0]]), [[[1.0, 2.0]]]);
    }
}
