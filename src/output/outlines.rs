//! Outlines of points in the plane.

use super::thin::Point;

/// The convex hull, counter-clockwise where y points upwards (Andrew 1979).
pub(super) fn hull(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    // round-off of a set of this size
    let size = sorted.iter().flatten().fold(0.0_f64, |size, x| size.max(x.abs()));
    let flat = 1e-12 * size * size;
    // points above each other but for round-off go from below upwards, too
    let mut from = 0;
    for k in 1..=sorted.len() {
        if k == sorted.len() || sorted[k][0] - sorted[from][0] > 1e-12 * size {
            sorted[from..k].sort_by(|a, b| a[1].total_cmp(&b[1]));
            from = k;
        }
    }
    let half = |points: &mut dyn Iterator<Item = &Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > flat {
                    break;
                }
                chain.pop();
            }
            chain.push(*p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut sorted.iter());
    hull.extend(half(&mut sorted.iter().rev()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_of_a_square_with_points_within_is_the_square() {
        let points = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 2.0], [1.0, 0.0], [0.0, 0.0]];
        assert_eq!(hull(&points), [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        assert_eq!(hull(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]), [[0.0, 0.0], [2.0, 2.0]]);
    }

    #[test]
    fn corners_above_each_other_but_for_round_off_are_kept() {
        // a disc seen edge-on: two upright rows of points
        let ring = |x: f64| (0..12).map(move |k| (x, f64::from(k) * std::f64::consts::TAU / 12.0));
        let points: Vec<Point> = ring(-0.1).chain(ring(0.1)).map(|(x, a)| [x + 1e-17 * (7.0 * a).sin(), a.sin()]).collect();
        let corners = hull(&points);
        assert_eq!(corners.len(), 4, "{corners:?}");
        assert!(corners.iter().all(|p| (p[0].abs() - 0.1).abs() < 1e-12 && (p[1].abs() - 1.0).abs() < 1e-12), "{corners:?}");
    }
}
