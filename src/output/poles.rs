//! The range of an axis beside values without bound.
//!
//! A curve has a pole at an end where its study reports a dead point, its value there is not defined, and the values before grow towards
//! it. Numbers of whole runs have one between two runs where they change their sign and their reciprocals pass through zero in a straight
//! line; and those are without bound that are beyond all sizes in mechanics and beyond all others of their curve. What is near a pole or
//! without bound would spoil the scale of all else: the axis then ends half of the other values' range beyond them.

use super::plot::Curve;

/// Part of the curve's length within which values count as near a pole, and how much they must grow there.
const ZONE: f64 = 0.1;
const GROWTH: f64 = 3.0;
/// How far reciprocals beside a pole may be off a straight line, as a part of their range over four runs.
const BENT: f64 = 0.05;
/// The size from which on a number of a run may be without bound, and how many times the largest of the others it must be.
const BOUNDLESS: f64 = 1e12;
const BEYOND: f64 = 1e9;

type Points = [(f64, f64)];

/// Which points of a curve are near its poles or without bound.
fn near(curve: &Curve) -> Vec<bool> {
    let points = &curve.points;
    let mut near = vec![false; points.len()];
    let Some(length) = points.first().zip(points.last()).map(|(first, last)| (last.0 - first.0).abs()) else { return near };
    // of points that lead away from a pole, of which the first with a value is `first`: how many are near it
    let from = |first: usize, at: &dyn Fn(usize) -> (f64, f64), count: usize| {
        let falls = |k: &usize| at(k + 1).1.abs() < at(*k).1.abs() && (at(*k).0 - at(0).0).abs() <= ZONE * length;
        let last = (first..count - 1).find(|k| !falls(k)).unwrap_or(first);
        if at(first).1.abs() >= GROWTH * at(last).1.abs() && last > first + 1 { last } else { 0 }
    };
    let n = points.len();
    let ahead = |k: usize| points[k];
    let back = |k: usize| points[n - 1 - k];
    let known = |at: &dyn Fn(usize) -> (f64, f64)| (0..n).find(|k| at(*k).1.is_finite()).filter(|first| *first > 0);
    let begin = known(&ahead).filter(|_| curve.poles[0]).map_or(0, |first| from(first, &ahead, n));
    let end = known(&back).filter(|_| curve.poles[1]).map_or(0, |first| from(first, &back, n));
    near[..begin].fill(true);
    near[n - end..].fill(true);
    if curve.runs {
        let most = bound(points);
        // a gap may stand where the pole is
        let kept: Vec<usize> = (0..n).filter(|k| points[*k].1.abs() < most).collect();
        let own: Vec<(f64, f64)> = kept.iter().map(|k| points[*k]).collect();
        for k in (0..own.len()).filter(|k| is_pole(&own, *k)) {
            let before = from(0, &|i| own[k - i], k + 1);
            let behind = from(0, &|i| own[k + 1 + i], own.len() - k - 1);
            kept[k + 1 - before..k + 1 + behind].iter().for_each(|k| near[*k] = true);
        }
        (0..n).filter(|k| points[*k].1.abs() >= most).for_each(|k| near[k] = true);
    }
    near
}

/// The size from which on numbers of whole runs are without bound; infinite if none is.
pub(super) fn bound(points: &Points) -> f64 {
    let mut sizes: Vec<f64> = points.iter().map(|point| point.1.abs()).filter(|y| y.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let first = sizes.windows(2).find(|pair| pair[1] >= BOUNDLESS && pair[1] >= BEYOND * pair[0]);
    first.map_or(f64::INFINITY, |pair| pair[1])
}

/// Whether a pole lies between a number of a whole run and the next one.
pub(super) fn is_pole(points: &Points, k: usize) -> bool {
    let Some(&[a, b, c, d]) = k.checked_sub(1).and_then(|first| points.get(first..first + 4)) else { return false };
    let grows = a.1 * b.1 > 0.0 && b.1 * c.1 < 0.0 && c.1 * d.1 > 0.0 && a.1.abs() < b.1.abs() && d.1.abs() < c.1.abs();
    let straight = |at: (f64, f64)| {
        let [first, last] = [1.0 / a.1, 1.0 / d.1];
        let on_line = first + (last - first) * (at.0 - a.0) / (d.0 - a.0);
        (1.0 / at.1 - on_line).abs() <= BENT * (last - first).abs()
    };
    grows && straight(b) && straight(c)
}

/// The range of curves without what is near their poles or without bound, if that would spoil the scale.
pub(super) fn bounded<'c>(curves: impl Iterator<Item = &'c Curve>) -> Option<[f64; 2]> {
    let wider = |range: [f64; 2], y: f64| [range[0].min(y), range[1].max(y)];
    let (mut whole, mut rest) = ([f64::INFINITY, f64::NEG_INFINITY], [f64::INFINITY, f64::NEG_INFINITY]);
    for curve in curves {
        for (point, near) in curve.points.iter().zip(near(curve)).filter(|(point, _)| point.1.is_finite()) {
            whole = wider(whole, point.1);
            if !near {
                rest = wider(rest, point.1);
            }
        }
    }
    let span = rest[1] - rest[0];
    let spoilt = [rest[0] - whole[0], whole[1] - rest[1]].map(|more| span > 0.0 && more > span);
    let low = if spoilt[0] { rest[0] - 0.5 * span } else { whole[0] };
    let high = if spoilt[1] { rest[1] + 0.5 * span } else { whole[1] };
    spoilt.contains(&true).then_some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/x − c from 0 to 1.
    fn curve(poles: [bool; 2], c: f64) -> Curve {
        let points = (0..=200).map(|k| 0.005 * f64::from(k)).map(|x| (x, if x > 0.0 { 1.0 / x - c } else { f64::NAN })).collect();
        Curve { points, poles, ..Curve::default() }
    }

    #[test]
    fn a_pole_at_a_dead_point_does_not_spoil_the_scale() {
        let [low, high] = bounded([curve([true, false], 0.0)].iter()).expect("a range");
        assert!(low > 0.9 && high > 5.0 && high < 30.0, "{low} {high}");
    }

    #[test]
    fn extremes_that_are_no_poles_are_never_cut() {
        // no dead point is reported, the value there is defined, or it does not grow towards it
        assert_eq!(bounded([curve([false, false], 0.0)].iter()), None);
        let mut defined = curve([true, false], 0.0);
        defined.points.remove(0);
        assert_eq!(bounded([defined].iter()), None);
        let mut peak = curve([true, false], 0.0);
        peak.points[1].1 = 0.0;
        assert_eq!(bounded([peak].iter()), None);
        // one elsewhere on the curve counts as all else
        let mut two = curve([true, false], 0.0);
        two.points[100].1 = 500.0;
        assert_eq!(bounded([two].iter()), None);
    }

    fn runs(y: impl Fn(f64) -> f64) -> Curve {
        Curve { points: (0..=40).map(|k| 0.25 * f64::from(k)).map(|x| (x, y(x))).collect(), runs: true, ..Curve::default() }
    }

    #[test]
    fn numbers_of_runs_that_are_without_bound_leave_the_axis() {
        for size in [1e30, -1e16] {
            let [low, high] = bounded([runs(|x| if x > 7.5 { size } else { x })].iter()).expect("a range");
            assert_eq!([low, high], if size > 0.0 { [0.0, 11.25] } else { [-3.75, 7.5] });
        }
        let both = runs(|x| {
            if x < 2.0 {
                -1e30
            } else if x > 8.0 {
                1e30
            } else {
                x.sin()
            }
        });
        let [low, high] = bounded([both].iter()).expect("a range");
        assert!(low > -3.0 && high < 3.0, "{low} {high}");
        // many sizes, large numbers alone, what is nothing but for round-off, and curves of one run
        for y in [|x: f64| 10f64.powf(2.0 * x), |x: f64| 1e33 * x.cos(), |x: f64| if x > 5.0 { 5.0 } else { 1e-17 }] {
            assert_eq!(bounded([runs(y)].iter()), None);
        }
        assert_eq!(bounded([Curve { runs: false, ..runs(|x| if x > 7.5 { 1e30 } else { x }) }].iter()), None);
    }

    #[test]
    fn poles_between_runs_leave_the_axis() {
        for pole in [5.1, 5.001, 5.125] {
            let [low, high] = bounded([runs(|x| 1.0 / (x - pole))].iter()).expect("a range");
            assert!((-4.0..-1.0).contains(&low) && (1.0..4.0).contains(&high), "{pole}: {low} {high}");
        }
        // a tooth of a saw, a jump, a peak, and a resonance that is seen whole
        let tooth = |x: f64| if x < 5.1 { x } else { x - 10.2 };
        let jump = |x: f64| if x < 5.1 { 1.0 + 0.05 * x } else { -1.5 + 0.05 * x };
        for y in [tooth, jump, |x: f64| 1.0 / ((x - 5.1) * (x - 5.1)), |x: f64| (x - 5.0) / ((x - 5.0) * (x - 5.0) + 0.2)] {
            assert_eq!(bounded([runs(y)].iter()), None);
        }
    }
}
