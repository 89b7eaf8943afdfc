//! Lines cut at the edges of an area.

use super::scene::Rect;
use super::thin::Point;

/// The points within an area, together.
pub(super) fn points(line: &[Point], area: Rect) -> Vec<Vec<Point>> {
    let inside: Vec<Point> = line.iter().copied().filter(|point| area.contains(*point)).collect();
    if inside.is_empty() { Vec::new() } else { vec![inside] }
}

/// The parts of a line within an area.
pub(super) fn line(line: &[Point], area: Rect) -> Vec<Vec<Point>> {
    if line.iter().all(|point| area.contains(*point)) {
        return vec![line.to_vec()];
    }
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let mut end: Option<Point> = None;
    for ends in line.windows(2) {
        let Some([a, b]) = segment([ends[0], ends[1]], area) else { continue };
        match parts.last_mut().filter(|_| end == Some(a)) {
            Some(part) => part.push(b),
            None => parts.push(vec![a, b]),
        }
        end = Some(b);
    }
    parts
}

/// The part of a segment within an area (Liang and Barsky 1984).
fn segment([a, b]: [Point; 2], area: Rect) -> Option<[Point; 2]> {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (way, room) in [(-dx, a[0] - area.left), (dx, area.right - a[0]), (-dy, a[1] - area.top), (dy, area.bottom - a[1])] {
        if way == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if way < 0.0 {
            from = from.max(room / way);
        } else {
            to = to.min(room / way);
        }
    }
    let at = |s: f64| [a[0] + s * dx, a[1] + s * dy];
    (from <= to).then(|| [if from == 0.0 { a } else { at(from) }, if to == 1.0 { b } else { at(to) }])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_edges() {
        let area = Rect { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };
        let through = [[-5.0, 5.0], [5.0, 5.0], [5.0, 15.0], [8.0, 15.0], [8.0, 5.0]];
        assert_eq!(line(&through, area), [vec![[0.0, 5.0], [5.0, 5.0], [5.0, 10.0]], vec![[8.0, 10.0], [8.0, 5.0]]]);
        assert!(line(&[[-5.0, 5.0], [5.0, 20.0]], area).is_empty());
        assert_eq!(line(&[[1.0, 1.0], [2.0, 2.0]], area).len(), 1);
        assert_eq!(points(&through, area), [vec![[5.0, 5.0], [8.0, 5.0]]]);
    }
}
