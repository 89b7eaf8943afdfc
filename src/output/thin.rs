//! Curves made fit to be drawn: broken where they jump, and with no more points than can be seen.

use std::collections::HashSet;

/// Dots that are all drawn, wherever they stand.
const MOST_DOTS: usize = 2000;

/// A point in pixels.
pub(super) type Point = [f64; 2];

/// Splits `points` where a number is missing and where the curve jumps, that is, where two successive x are equal.
///
/// Over an independent variable (`ordered`) every pair of equal x is a jump. A path in the plane may stand still in x, so there
/// only the x of `breaks` count.
pub(super) fn pieces(points: &[(f64, f64)], ordered: bool, breaks: &[f64]) -> Vec<Vec<(f64, f64)>> {
    let mut pieces = Vec::new();
    let mut piece: Vec<(f64, f64)> = Vec::new();
    for &(x, y) in points {
        let jump = piece.last().is_some_and(|last| last.0 == x && last.1 != y && (ordered || breaks.contains(&x)));
        let missing = !(x.is_finite() && y.is_finite());
        if jump || missing {
            pieces.push(std::mem::take(&mut piece));
        }
        if !missing {
            piece.push((x, y));
        }
    }
    pieces.push(piece);
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

/// Whether x never turns back: then the curve is one over an independent variable.
pub(super) fn is_ordered(points: &[(f64, f64)]) -> bool {
    let mut x = points.iter().map(|point| point.0).filter(|x| x.is_finite());
    let Some(mut last) = x.next() else { return true };
    let (mut up, mut down) = (true, true);
    for x in x {
        up &= x >= last;
        down &= x <= last;
        last = x;
    }
    up || down
}

/// The fewest pixels that show the same line.
///
/// Long ordered curves first keep only entry, extremes and exit of each pixel column, so that no peak is lost; then points are
/// dropped that lie within a twentieth of a pixel of the line between those kept (Douglas and Peucker 1973).
pub(super) fn thinned(points: Vec<Point>, ordered: bool) -> Vec<Point> {
    let points = if ordered && points.len() > 2000 { columns(&points) } else { spread(points) };
    simplified(&points, 0.05)
}

/// Dots of which no more than one stands in a pixel, where there are many.
pub(super) fn dots(points: Vec<Point>) -> Vec<Point> {
    if points.len() <= MOST_DOTS {
        return points;
    }
    let mut taken = HashSet::new();
    points.into_iter().filter(|[x, y]| taken.insert((x.round() as i64, y.round() as i64))).collect()
}

/// Entry, extremes and exit of each half pixel column, in their order.
fn columns(points: &[Point]) -> Vec<Point> {
    let column = |point: &Point| (2.0 * point[0]).floor();
    let mut kept = Vec::new();
    for group in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |a: &&usize, b: &&usize| group[**a][1].total_cmp(&group[**b][1]);
        let indices: Vec<usize> = (0..group.len()).collect();
        let extremes = [indices.iter().min_by(by_height), indices.iter().max_by(by_height)];
        let mut chosen: Vec<usize> = extremes.into_iter().flatten().copied().chain([0, group.len() - 1]).collect();
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|index| group[index]));
    }
    kept
}

/// Drops points closer than a fifth of a pixel to the last one kept, the ends excepted.
fn spread(points: Vec<Point>) -> Vec<Point> {
    let Some(&end) = points.last() else { return points };
    let mut kept: Vec<Point> = Vec::new();
    for point in points {
        if kept.last().is_none_or(|last| (last[0] - point[0]).hypot(last[1] - point[1]) > 0.2) {
            kept.push(point);
        }
    }
    if kept.last() != Some(&end) {
        kept.push(end);
    }
    kept
}

/// Points that stay within `tolerance` of the line through those kept. A stack of spans, for recursion could run deep.
fn simplified(points: &[Point], tolerance: f64) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    (keep[0], keep[points.len() - 1]) = (true, true);
    // Spans are bounded, or a spiral of a million points would cost a million squared.
    let mut spans: Vec<(usize, usize)> = (0..points.len() - 1).step_by(500).map(|a| (a, (a + 500).min(points.len() - 1))).collect();
    while let Some((a, b)) = spans.pop() {
        (keep[a], keep[b]) = (true, true);
        let far = (a + 1..b).map(|i| (i, distance(points[i], points[a], points[b]))).max_by(|x, y| x.1.total_cmp(&y.1));
        if let Some((middle, _)) = far.filter(|(_, distance)| *distance > tolerance) {
            spans.extend([(a, middle), (middle, b)]);
        }
    }
    points.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

/// The length of a line.
pub(super) fn length(line: &[Point]) -> f64 {
    line.windows(2).map(|ends| (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1])).sum()
}

/// The distance of `p` from the line segment `a`-`b`.
pub(super) fn distance(p: Point, a: Point, b: Point) -> f64 {
    let (ab, ap) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length = ab[0] * ab[0] + ab[1] * ab[1];
    let s = if length > 0.0 { ((ap[0] * ab[0] + ap[1] * ab[1]) / length).clamp(0.0, 1.0) } else { 0.0 };
    (ap[0] - s * ab[0]).hypot(ap[1] - s * ab[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_points_keep_their_extremes() {
        let n = 1_000_000;
        let mut points: Vec<Point> = (0..n).map(|i| [f64::from(i) * 800.0 / f64::from(n), (f64::from(i) * 0.37).sin()]).collect();
        points[123_456][1] = 55.0;
        points[654_321][1] = -44.0;
        let thin = thinned(points.clone(), true);
        assert!(thin.len() < 8000, "{}", thin.len());
        let extreme = |points: &[Point]| points.iter().fold((0f64, 0f64), |(a, b), p| (a.min(p[1]), b.max(p[1])));
        assert_eq!(extreme(&thin), (-44.0, 55.0));
        assert_eq!((thin.first(), thin.last()), (points.first(), points.last()));
    }

    #[test]
    fn a_smooth_curve_stays_within_a_twentieth_of_a_pixel() {
        let points: Vec<Point> = (0..1000).map(|i| [f64::from(i), 200.0 * (f64::from(i) * 0.01).sin()]).collect();
        let thin = thinned(points.clone(), true);
        assert!(thin.len() < 300, "{}", thin.len());
        let off = |p: &Point| thin.windows(2).map(|s| distance(*p, s[0], s[1])).fold(f64::INFINITY, f64::min);
        assert!(points.iter().all(|p| off(p) < 0.051));
    }

    #[test]
    fn jumps_and_gaps_break_a_curve() {
        let nan = f64::NAN;
        let points = [(0.0, 1.0), (1.0, 2.0), (1.0, -2.0), (2.0, -1.0), (3.0, nan), (4.0, 0.0)];
        assert_eq!(pieces(&points, true, &[]).iter().map(Vec::len).collect::<Vec<_>>(), [2, 2, 1]);
        assert_eq!(pieces(&points, false, &[]).len(), 2, "a path may stand still in x");
        assert_eq!(pieces(&points, false, &[1.0]).len(), 3);
        assert!(pieces(&[(0.0, nan)], true, &[]).is_empty());
        assert!(is_ordered(&points) && !is_ordered(&[(0.0, 0.0), (1.0, 0.0), (0.5, 0.0)]));
    }
}
