//! The signs of mechanism drawings, in pixels.

use super::font;
use super::pose::{LinkKind, Placement, SymbolKind};
use super::scene::{Anchor, Color, GREY, INK, Scene, Stroke, pale};
use super::thin::Point;

/// The width of a bar.
pub(super) const BAR: f64 = 20.0;
/// Half length and half height of a sliding box.
const BOX: [f64; 2] = [24.0, 16.0];

/// How a part is drawn in one position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Looks {
    pub(super) fill: Color,
    pub(super) edge: Color,
    /// Whether it is the first position.
    pub(super) strong: bool,
}

/// `a + s along + t across`, across being a quarter turn from along, downwards for a level direction to the right.
fn off(a: Point, along: Point, s: f64, t: f64) -> Point {
    [a[0] + s * along[0] - t * along[1], a[1] + s * along[1] + t * along[0]]
}

fn direction(a: Point, b: Point) -> (Point, f64) {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    if length > 1e-9 { ([(b[0] - a[0]) / length, (b[1] - a[1]) / length], length) } else { ([1.0, 0.0], 0.0) }
}

/// The convex hull, counter-clockwise in pixels (Andrew 1979).
pub(super) fn hull(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let half = |points: &mut dyn Iterator<Item = &Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 1e-9 {
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

/// A bar or plate around `points`; gives its closed outline, along the joints.
pub(super) fn body(scene: &mut Scene, points: &[Point], looks: &Looks) -> Vec<Point> {
    let mut outline = hull(points);
    let rim = if looks.strong { 4.0 } else { 3.0 };
    match outline[..] {
        [] => {}
        [only] => scene.circle(only, BAR * 0.7, Some(looks.fill), Some(Stroke::solid(looks.edge, rim / 2.0))),
        _ => {
            // A thick line in the colour of the edge, and a thinner one over it, make an evenly rounded outline.
            scene.shape(outline.clone(), None, Some(Stroke::solid(looks.edge, BAR)));
            // Plates are large: paler, and in later positions little more than their outline.
            let fill = if outline.len() < 3 { looks.fill } else { pale(looks.fill, if looks.strong { 0.7 } else { 0.4 }) };
            scene.shape(outline.clone(), Some(fill), Some(Stroke::solid(fill, BAR - rim)));
        }
    }
    outline.extend(outline.first().copied());
    outline
}

/// Where the name of a body belongs, the middle of its longest side, and how far from there it must keep.
pub(super) fn middle(points: &[Point]) -> Option<(Point, f64)> {
    let hull = hull(points);
    if hull.len() > 2 {
        // In a plate that is large enough the name stands inside.
        let count = hull.len() as f64;
        let center = hull.iter().fold([0.0; 2], |sum, p| [sum[0] + p[0] / count, sum[1] + p[1] / count]);
        return Some((center, 0.0));
    }
    match hull[..] {
        [only] => Some((only, BAR)),
        [a, b] => Some(([(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0], BAR / 2.0 + 5.0)),
        _ => None,
    }
}

/// The bearing of the frame below a pivot.
pub(super) fn ground(scene: &mut Scene, at: Point) {
    let (half, height) = (20.0, 34.0);
    let foot = at[1] + height;
    scene.shape(vec![at, [at[0] - half, foot], [at[0] + half, foot]], Some([238, 238, 238]), Some(Stroke::solid(INK, 2.2)));
    hatched(scene, [at[0] - half - 8.0, foot], [at[0] + half + 8.0, foot]);
}

/// A line with the hatch of solid ground on its right side, seen from `a` to `b`; in pixels that is below a line to the right.
fn hatched(scene: &mut Scene, a: Point, b: Point) {
    let (along, length) = direction(a, b);
    let count = (length / 11.0).round().max(1.0) as u32;
    for index in 1..=count {
        let s = length * f64::from(index) / f64::from(count);
        scene.line(vec![off(a, along, s, 0.0), off(a, along, s - 10.0, 10.0)], Stroke::solid(GREY, 1.6));
    }
    scene.line(vec![a, b], Stroke::solid(INK, 2.6));
}

/// The line at `distance` on the lower side of `way`, or on the right of an upright one.
pub(super) fn lower_side(way: [Point; 2], distance: f64) -> [Point; 2] {
    let [(x, y), (u, v)] = way.map(|[x, y]| (x, y));
    let backwards = u - x < -1e-6 || (u - x).abs() <= 1e-6 && v > y;
    let [a, b] = if backwards { [way[1], way[0]] } else { way };
    let (along, _) = direction(a, b);
    [off(a, along, 0.0, distance), off(b, along, 0.0, distance)]
}

/// A hatched line at `distance` on the lower side of `way`.
pub(super) fn hatched_below(scene: &mut Scene, way: [Point; 2], distance: f64) {
    let [a, b] = lower_side(way, distance);
    hatched(scene, a, b);
}

/// The way of a slide: as long as what is `seen` of its motion, and `more` at both ends.
pub(super) fn way(placement: &Placement, seen: &[Point], more: f64) -> [Point; 2] {
    let reach = |p: &Point| (p[0] - placement.at[0]) * placement.along[0] + (p[1] - placement.at[1]) * placement.along[1];
    let low = seen.iter().map(reach).fold(0.0, f64::min) - more;
    let high = seen.iter().map(reach).fold(0.0, f64::max) + more;
    [off(placement.at, placement.along, low, 0.0), off(placement.at, placement.along, high, 0.0)]
}

/// What a slide slides on: hatched ground, or a thin line on another body.
pub(super) fn slideway(scene: &mut Scene, placement: &Placement, way: [Point; 2], grounded: bool) {
    if grounded {
        hatched_below(scene, way, BOX[1] + 2.0);
    } else {
        scene.line(vec![way[0], placement.at, way[1]], Stroke::solid(INK, 3.0));
    }
}

/// The box of a slide.
pub(super) fn slider(scene: &mut Scene, placement: &Placement, looks: &Looks) {
    let corner = |s: f64, t: f64| off(placement.at, placement.along, s * BOX[0], t * BOX[1]);
    let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let fill = if looks.strong { pale(GREY, 0.28) } else { [250; 3] };
    scene.shape(corners, Some(fill), Some(Stroke::solid(looks.edge, 2.4)));
}

/// A slot between two points: a white groove with a dark edge.
pub(super) fn slot(scene: &mut Scene, way: [Point; 2], looks: &Looks) {
    scene.line(way.to_vec(), Stroke::solid(looks.edge, 15.0));
    scene.line(way.to_vec(), Stroke::solid(looks.fill, 11.0));
}

/// The sign at the point of a joint.
pub(super) fn pin(scene: &mut Scene, kind: SymbolKind, placement: &Placement, looks: &Looks) {
    let (radius, width) = if looks.strong { (7.5, 2.8) } else { (6.0, 2.0) };
    let edge = Some(Stroke::solid(looks.edge, width));
    match kind {
        SymbolKind::Hinge => scene.circle(placement.at, radius, Some(looks.fill), edge),
        SymbolKind::Ball => {
            scene.circle(placement.at, radius + 2.0, Some(looks.fill), edge);
            scene.circle(placement.at, radius - 2.5, Some(looks.edge), None);
        }
        SymbolKind::Slot => scene.circle(placement.at, 6.5, Some(looks.edge), None),
        // Its box is drawn below the bodies.
        SymbolKind::Slide => {}
        SymbolKind::Weld => {
            let corner = |s: f64, t: f64| off(placement.at, placement.along, s * 8.0, t * 8.0);
            let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            scene.shape(corners, Some(looks.edge), None);
        }
    }
}

/// A spring, a damper or a thin rod between two points.
pub(super) fn link(scene: &mut Scene, kind: LinkKind, [a, b]: [Point; 2], color: Color) {
    let (along, length) = direction(a, b);
    let stroke = Stroke::solid(color, 2.6);
    let at = |s: f64, t: f64| off(a, along, s, t);
    // The straight ends; the sign itself stays between.
    let end = (0.2 * length).min(26.0);
    [a, b].into_iter().for_each(|end| scene.circle(end, 4.0, Some(color), None));
    match kind {
        LinkKind::Rod => scene.line(vec![a, b], stroke),
        LinkKind::Spring => {
            let coils = ((length - 2.0 * end) / 13.0).round().clamp(3.0, 14.0);
            let step = (length - 2.0 * end) / (2.0 * coils);
            let zigzag = (0..2 * coils as u32).map(|k| at(end + (f64::from(k) + 0.5) * step, if k % 2 == 0 { 10.0 } else { -10.0 }));
            let points = [a, at(end, 0.0)].into_iter().chain(zigzag).chain([at(length - end, 0.0), b]);
            scene.line(points.collect(), stroke);
        }
        LinkKind::Damper => {
            let (low, high) = (0.35 * length, 0.65 * length);
            scene.line(vec![a, at(low, 0.0)], stroke);
            scene.line(vec![at(high, -11.0), at(low, -11.0), at(low, 11.0), at(high, 11.0)], stroke);
            scene.line(vec![at(0.55 * length, 0.0), b], stroke);
            scene.line(vec![at(0.55 * length, -8.0), at(0.55 * length, 8.0)], Stroke::solid(color, 3.6));
        }
    }
}

/// A bar of round length at the lower left, for `scale` pixels to the metre.
pub(super) fn scale_bar(scene: &mut Scene, scale: f64, letters: f64) {
    let longest = 200.0 / scale;
    let power = 10f64.powf(longest.log10().floor());
    let length = [5.0, 2.0, 1.0].into_iter().map(|m| m * power).find(|length| *length <= longest * (1.0 + 1e-9)).unwrap_or(power);
    let (left, y) = (30.0, scene.height - 26.0);
    let right = left + length * scale;
    scene.line(vec![[left, y], [right, y]], Stroke::solid(INK, 2.5));
    for x in [left, right] {
        scene.line(vec![[x, y - 7.0], [x, y + 7.0]], Stroke::solid(INK, 2.5));
    }
    let (length, unit) = if length < 0.0099 { (length * 1e3, "mm") } else { (length, "m") };
    let text = format!("{} {unit}", super::scalars::significant(length, 6));
    scene.text([right + 14.0, y + letters * font::CAPITAL / 2.0], text, letters, Anchor::Start);
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
    fn a_way_covers_what_is_seen() {
        let placement = Placement { at: [10.0, 0.0], along: [1.0, 0.0], way: None };
        assert_eq!(way(&placement, &[[0.0, 0.0], [30.0, 0.0]], 5.0), [[-5.0, 0.0], [35.0, 0.0]]);
    }
}
