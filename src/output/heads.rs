//! Small arrow heads along curves that turn back in x: such a curve shows by itself not which way it is run through.

use super::thin::{self, Point};

/// Length and width of a head, pixels.
const SIZE: [f64; 2] = [17.0, 12.0];
/// A curve that falls behind by less in x does not turn back, pixels.
const BACK: f64 = 4.0;
/// Pixels of a curve to a head.
const EACH: f64 = 300.0;
/// Heads of a curve, and of all curves of a panel, at most; but one for each.
const MOST: usize = 6;
const TOGETHER: usize = 24;

/// The heads, as triangles whose tip comes first, of a curve that consists of `pieces`, one of `count` in a panel; none if it does not turn
/// back.
pub(super) fn heads(pieces: &[Vec<Point>], count: usize) -> Vec<[Point; 3]> {
    let whole: f64 = pieces.iter().map(|piece| thin::length(piece)).sum();
    if !turns_back(pieces) || whole < 4.0 * SIZE[0] {
        return Vec::new();
    }
    let most = (TOGETHER / count.max(1)).clamp(1, MOST);
    let number = ((whole / EACH).round() as usize).clamp(1, most);
    (0..number).filter_map(|k| head(pieces, (k as f64 + 0.5) / number as f64 * whole)).collect()
}

/// Whether x runs both ways.
fn turns_back(pieces: &[Vec<Point>]) -> bool {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut forth, mut back) = (false, false);
    for [x, _] in pieces.iter().flatten() {
        (low, high) = (low.min(*x), high.max(*x));
        forth |= x - low > BACK;
        back |= high - x > BACK;
    }
    forth && back
}

/// The head in the middle of which a curve has run `along`; none where the curve ends there or makes a sharp turn.
fn head(pieces: &[Vec<Point>], mut along: f64) -> Option<[Point; 3]> {
    let piece = pieces.iter().find(|piece| {
        let length = thin::length(piece);
        along -= length;
        along <= 0.0
    })?;
    along += thin::length(piece);
    let [back, middle, front] = [-0.5, 0.0, 0.5].map(|part| point(piece, along + part * SIZE[0]));
    let (back, middle, front) = (back?, middle?, front?);
    let (dx, dy) = (front[0] - back[0], front[1] - back[1]);
    let chord = dx.hypot(dy);
    if chord < 0.7 * SIZE[0] {
        return None;
    }
    let at = |along: f64, across: f64| [middle[0] + (along * dx - across * dy) / chord, middle[1] + (along * dy + across * dx) / chord];
    let [length, width] = SIZE.map(|size| size / 2.0);
    Some([at(length, 0.0), at(-length, width), at(-length, -width)])
}

/// Where a line has run `along`.
fn point(line: &[Point], mut along: f64) -> Option<Point> {
    if along < 0.0 {
        return None;
    }
    for ends in line.windows(2) {
        let ([a, b], length) = ([ends[0], ends[1]], thin::length(ends));
        if along <= length && length > 0.0 {
            let part = along / length;
            return Some([a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]);
        }
        along -= length;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A circle about (500, 300), whose way is that of the hands of a clock in a picture.
    fn circle(sense: f64) -> Vec<Point> {
        (0..=200)
            .map(|k| sense * TAU * f64::from(k) / 200.0)
            .map(|angle| [500.0 + 200.0 * angle.cos(), 300.0 + 200.0 * angle.sin()])
            .collect()
    }

    #[test]
    fn heads_point_the_way_a_curve_is_run_through() {
        for sense in [1.0, -1.0] {
            let heads = heads(&[circle(sense)], 1);
            assert_eq!(heads.len(), 4);
            for [tip, a, b] in heads {
                let base = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
                let turn = (base[0] - 500.0) * (tip[1] - 300.0) - (base[1] - 300.0) * (tip[0] - 500.0);
                assert!(turn * sense > 0.0, "{tip:?} {base:?}");
                assert!(((tip[0] - base[0]).hypot(tip[1] - base[1]) - SIZE[0]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn curves_that_do_not_turn_back_have_none() {
        let wave: Vec<Point> = (0..400).map(|k| [f64::from(k), 100.0 * (f64::from(k) * 0.1).sin()]).collect();
        assert!(heads(std::slice::from_ref(&wave), 1).is_empty());
        let falling: Vec<Point> = wave.iter().rev().copied().collect();
        assert!(heads(&[falling], 1).is_empty());
        // nothing but rounding
        let upright: Vec<Point> = (0..400).map(|k| [300.0 + 0.5 * f64::from(k % 2), f64::from(k)]).collect();
        assert!(heads(&[upright], 1).is_empty() && heads(&[], 1).is_empty() && heads(&[vec![[1.0, 1.0]]], 1).is_empty());
    }

    #[test]
    fn many_curves_have_one_head_each_and_a_long_one_a_few() {
        assert_eq!(heads(&[circle(1.0)], 40).len(), 1);
        let rounds: Vec<Point> = (0..30).flat_map(|_| circle(1.0)).collect();
        assert_eq!(heads(&[rounds], 1).len(), MOST);
    }
}
