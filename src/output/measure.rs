//! Distances between rectangles and lines.

use super::scene::Rect;
use super::thin::{Point, distance};

/// The distance of a rectangle from a line or a point; 0 if they meet, or if the line returns to its first point around the rectangle.
pub(super) fn gap(area: &Rect, line: &[Point]) -> f64 {
    let from = |p: &Point| {
        let q = area.nearest(*p);
        (p[0] - q[0]).hypot(p[1] - q[1])
    };
    if line.len() > 3 && line.first() == line.last() && encloses(line, area.center()) {
        return 0.0;
    }
    let corners = [[area.left, area.top], [area.right, area.top], [area.right, area.bottom], [area.left, area.bottom]];
    let of = |ends: &[Point]| {
        let line = [ends[0], ends[1]];
        if meets(area, line) { 0.0 } else { corners.iter().map(|c| distance(*c, line[0], line[1])).fold(f64::INFINITY, f64::min) }
    };
    line.windows(2).map(of).chain(line.iter().map(from)).fold(f64::INFINITY, f64::min)
}

/// Whether a straight line comes into a rectangle.
pub(super) fn meets(area: &Rect, line: [Point; 2]) -> bool {
    let diagonals = [[[area.left, area.top], [area.right, area.bottom]], [[area.left, area.bottom], [area.right, area.top]]];
    area.contains(line[0]) || area.contains(line[1]) || diagonals.iter().any(|diagonal| crosses(*diagonal, line))
}

/// Whether two straight lines cross.
pub(super) fn crosses([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let side = |a: Point, b: Point, p: Point| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0.0;
    side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
}

/// Whether a point is within an outline: its edges above the point are crossed an odd number of times.
pub(super) fn encloses(outline: &[Point], p: Point) -> bool {
    let edges = outline.iter().zip(outline.iter().cycle().skip(1));
    let crossed = |a: &Point, b: &Point| (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    edges.filter(|(a, b)| crossed(a, b)).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_the_shortest_ways() {
        let area = Rect { left: 0.0, top: 0.0, right: 4.0, bottom: 2.0 };
        assert_eq!(gap(&area, &[[7.0, 6.0]]), 5.0);
        assert_eq!(gap(&area, &[[-3.0, -1.0], [9.0, -1.0]]), 1.0);
        assert_eq!(gap(&area, &[[-3.0, 1.0], [9.0, 1.0]]), 0.0);
        assert_eq!(gap(&area, &[[6.0, 0.0], [6.0, 9.0], [9.0, 0.0]]), 2.0);
        let around = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0], [-9.0, -9.0]];
        assert_eq!((gap(&area, &around), gap(&area, &around[..4])), (0.0, 5.0));
        assert!(gap(&area, &[]).is_infinite());
    }
}
