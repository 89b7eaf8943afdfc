//! The range of an axis beside dead points, where rates and forces grow without bound.
//!
//! A curve has a pole at an end where its study reports a dead point, its value there is not defined, and the values before grow towards
//! it. What is near a pole would spoil the scale of all else: the axis then ends half of the other values' range beyond them.

use super::plot::Curve;

/// Part of the curve's length within which values count as near a pole, and how much they must grow there.
const ZONE: f64 = 0.1;
const GROWTH: f64 = 3.0;

/// How many points of a curve are near the poles at its begin and its end.
fn near(curve: &Curve) -> [usize; 2] {
    let points = &curve.points;
    let Some(length) = points.first().zip(points.last()).map(|(first, last)| (last.0 - first.0).abs()) else { return [0; 2] };
    let from = |pole: bool, at: &dyn Fn(usize) -> (f64, f64)| {
        let Some(first) = (0..points.len()).find(|k| at(*k).1.is_finite()).filter(|first| pole && *first > 0) else { return 0 };
        let falls = |k: &usize| at(k + 1).1.abs() < at(*k).1.abs() && (at(*k).0 - at(0).0).abs() <= ZONE * length;
        let last = (first..points.len() - 1).find(|k| !falls(k)).unwrap_or(first);
        if at(first).1.abs() >= GROWTH * at(last).1.abs() && last > first + 1 { last } else { 0 }
    };
    [from(curve.poles[0], &|k| points[k]), from(curve.poles[1], &|k| points[points.len() - 1 - k])]
}

/// The range of curves without what is near their poles, if that would spoil the scale.
pub(super) fn bounded<'c>(curves: impl Iterator<Item = &'c Curve>) -> Option<[f64; 2]> {
    let wider = |range: [f64; 2], y: f64| [range[0].min(y), range[1].max(y)];
    let (mut whole, mut rest) = ([f64::INFINITY, f64::NEG_INFINITY], [f64::INFINITY, f64::NEG_INFINITY]);
    for curve in curves {
        let [begin, end] = near(curve);
        for (k, point) in curve.points.iter().enumerate().filter(|(_, point)| point.1.is_finite()) {
            whole = wider(whole, point.1);
            if k >= begin && k + end < curve.points.len() {
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
}
