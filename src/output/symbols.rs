//! The signs of mechanism drawings, in pixels.

use super::outlines::hull;
use super::pose::{FormKind, Placement, SymbolKind, Width};
use super::scene::{Color, GREY, INK, Scene, Stroke, pale};
use super::thin::Point;
use std::f64::consts::TAU;

/// The width of a bar in a drawing of full size.
pub(super) const BAR: f64 = 20.0;
/// Width of the rod of a cylinder, as a part of that of the cylinder.
const ROD: f64 = 0.55;
/// Half length and half height of a sliding box.
const BOX: [f64; 2] = [24.0, 16.0];
/// How far the parts of an area reach over their edges, pixels.
const SEAM: f64 = 0.6;
/// Teeth that are closer are not drawn, pixels.
const CLOSE: f64 = 5.0;

/// How a part is drawn in one position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Looks {
    pub(super) fill: Color,
    pub(super) edge: Color,
    /// Whether it is the first position.
    pub(super) strong: bool,
    /// How strongly it is drawn, 1 at most.
    pub(super) strength: f64,
}

impl Looks {
    /// The colour of an area in so much light, 1 at most.
    fn lit(&self, shade: f64) -> Color {
        shaded(pale(self.fill, if self.strong { 0.85 } else { 0.5 }), 1.0 - 0.5 * (1.0 - shade) * self.strength)
    }
}

/// The signs in the size that a mechanism leaves room for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Signs {
    /// 1 for a mechanism of a few large parts, less for smaller ones.
    pub(super) size: f64,
}

/// `a + s along + t across`, across being a quarter turn from along, downwards for a level direction to the right.
pub(super) fn off(a: Point, along: Point, s: f64, t: f64) -> Point {
    [a[0] + s * along[0] - t * along[1], a[1] + s * along[1] + t * along[0]]
}

/// The unit direction from a to b, and their distance.
pub(super) fn direction(a: Point, b: Point) -> (Point, f64) {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    if length > 1e-9 { ([(b[0] - a[0]) / length, (b[1] - a[1]) / length], length) } else { ([1.0, 0.0], 0.0) }
}

/// A colour with less light.
pub(super) fn shaded(color: Color, shade: f64) -> Color {
    color.map(|c| (f64::from(c) * shade).round().clamp(0.0, 255.0) as u8)
}

impl Signs {
    /// A shape of a body, in pixels; gives the line along it that names keep clear of.
    pub(super) fn form(self, scene: &mut Scene, form: &FormKind, looks: &Looks) -> Vec<Point> {
        let rim = self.rim(looks);
        let thin = Some(Stroke::solid(looks.edge, rim / 2.0));
        match form {
            FormKind::Bar { from, to, width } => self.rounded(scene, vec![*from, *to], self.bar(*width), looks),
            FormKind::Plate { points } => self.rounded(scene, hull(points), BAR * self.size, looks),
            FormKind::Area { points, shade } => {
                scene.shape(points.clone(), Some(looks.lit(*shade)), thin);
                points.iter().chain(points.first()).copied().collect()
            }
            FormKind::Wheel { outline, face } => {
                let opacity = if looks.strong { 0.5 } else { 0.16 };
                scene.veil(outline.clone(), looks.fill, opacity);
                [outline, face].into_iter().for_each(|rim| scene.shape(rim.clone(), None, thin));
                outline.iter().chain(outline.first()).copied().collect()
            }
            FormKind::Disc { center, radius, spoke } => {
                scene.circle(*center, radius.max(1.0), Some(pale(looks.fill, if looks.strong { 0.7 } else { 0.4 })), thin);
                if let Some(spoke) = spoke {
                    scene.line(vec![*center, *spoke], Stroke::solid(looks.edge, rim / 2.0));
                }
                circle(*center, *radius)
            }
            FormKind::Gear { center, radius, teeth, outline, spoke, rim: outer } => {
                let color = pale(looks.fill, if looks.strong { 0.7 } else { 0.4 });
                if let Some(outer) = outer {
                    // the ring between its rim and its teeth, in one line with a seam
                    let inner = outline.iter().chain(outline.first()).rev().copied();
                    scene.shape(around(*center, *outer, 96).into_iter().rev().chain(inner).collect(), Some(color), None);
                }
                let fill = spoke.map(|_| color);
                let edge = Some(Stroke::solid(looks.edge, rim / 3.0));
                if TAU * radius / *teeth as f64 > CLOSE {
                    scene.shape(outline.clone(), fill, edge);
                } else {
                    scene.circle(*center, radius.max(1.0), fill, edge);
                }
                if let Some(outer) = outer {
                    // a line, as what is within it stays to be seen
                    scene.shape(around(*center, *outer, 96), None, thin);
                }
                if let Some(spoke) = spoke {
                    scene.line(vec![*center, *spoke], Stroke::solid(looks.edge, rim / 2.0));
                }
                circle(*center, outer.unwrap_or(*radius))
            }
            FormKind::Mass { center, radius } => {
                // no pin
                let radius = radius.max(1.4 * self.pin_radius(true));
                scene.circle(
                    *center,
                    radius,
                    Some(pale([78, 78, 84], looks.strength)),
                    Some(Stroke::solid(pale(INK, looks.strength), 1.2)),
                );
                circle(*center, radius)
            }
        }
    }

    /// A part of an area, with those of its edges that belong to the outline; gives the line around it.
    pub(super) fn part(self, scene: &mut Scene, points: &[Point], edges: &[bool], shade: f64, looks: &Looks) -> Vec<Point> {
        // parts that meet leave no seam
        let fill = looks.lit(shade);
        scene.shape(points.to_vec(), Some(fill), Some(Stroke::solid(fill, SEAM)));
        let closed: Vec<Point> = points.iter().chain(points.first()).copied().collect();
        let stroke = Stroke::solid(looks.edge, self.rim(looks) / 2.0);
        // edges that follow each other are one line
        let mut line: Vec<Point> = Vec::new();
        for (ends, drawn) in closed.windows(2).zip(edges) {
            if *drawn && line.is_empty() {
                line.push(ends[0]);
            }
            match drawn {
                true => line.push(ends[1]),
                false if !line.is_empty() => scene.line(std::mem::take(&mut line), stroke),
                false => {}
            }
        }
        if !line.is_empty() {
            scene.line(line, stroke);
        }
        closed
    }

    /// How wide a bar is drawn, in pixels.
    pub(super) fn bar(self, width: Width) -> f64 {
        match width {
            Width::Drawn(around) => ROD.powi(around as i32) * BAR * self.size,
            Width::Given(width) => width,
        }
    }

    fn rim(self, looks: &Looks) -> f64 {
        (if looks.strong { 4.0 } else { 3.0 }) * self.size.max(0.6)
    }

    /// A rounded bar or plate; gives its closed outline, along the joints.
    fn rounded(self, scene: &mut Scene, mut outline: Vec<Point>, width: f64, looks: &Looks) -> Vec<Point> {
        let rim = self.rim(looks).min(0.4 * width);
        match outline[..] {
            [] => {}
            [only] => scene.circle(only, BAR * self.size * 0.7, Some(looks.fill), Some(Stroke::solid(looks.edge, rim / 2.0))),
            _ => {
                // A thick line in the colour of the edge, and a thinner one over it, make an evenly rounded outline.
                scene.shape(outline.clone(), None, Some(Stroke::solid(looks.edge, width)));
                // Plates are large: paler, and in later positions little more than their outline.
                let fill = if outline.len() < 3 { looks.fill } else { pale(looks.fill, if looks.strong { 0.7 } else { 0.4 }) };
                scene.shape(outline.clone(), Some(fill), Some(Stroke::solid(fill, width - rim)));
            }
        }
        outline.extend(outline.first().copied());
        outline
    }

    /// The bearing of the frame below a pivot, or above it.
    pub(super) fn ground(self, scene: &mut Scene, at: Point, above: bool) {
        let side = if above { -1.0 } else { 1.0 };
        let (half, height) = (side * 20.0 * self.size, 34.0 * self.size);
        let (foot, more) = (at[1] + side * height, side * 8.0 * self.size);
        scene.shape(vec![at, [at[0] - half, foot], [at[0] + half, foot]], Some([238, 238, 238]), Some(Stroke::solid(INK, self.pen(2.2))));
        self.hatched(scene, [at[0] - half - more, foot], [at[0] + half + more, foot]);
    }

    /// Width of a line of a sign.
    pub(super) fn pen(self, width: f64) -> f64 {
        width * self.size.max(0.55)
    }

    /// A line with the hatch of solid ground on its right side, seen from `a` to `b`; in pixels that is below a line to the right.
    fn hatched(self, scene: &mut Scene, a: Point, b: Point) {
        let (along, length) = direction(a, b);
        let step = 11.0 * self.size;
        let count = (length / step).round().clamp(1.0, 500.0) as u32;
        for index in 1..=count {
            let s = length * f64::from(index) / f64::from(count);
            scene.line(vec![off(a, along, s, 0.0), off(a, along, s - 0.9 * step, 0.9 * step)], Stroke::solid(GREY, self.pen(1.6)));
        }
        scene.line(vec![a, b], Stroke::solid(INK, self.pen(2.6)));
    }

    /// A piece of ground at the end of a link that comes along a direction.
    pub(super) fn anchor(self, scene: &mut Scene, at: Point, along: Point) {
        let half = 13.0 * self.size;
        self.hatched(scene, off(at, along, 0.0, half), off(at, along, 0.0, -half));
    }

    /// A hatched line at `distance` on the lower side of `way`, or on its upper one.
    pub(super) fn hatched_below(self, scene: &mut Scene, way: [Point; 2], distance: f64, upper: bool) {
        let side = if upper { -1.0 } else { 1.0 };
        let [a, b] = lower_side(way, side * distance * self.size);
        if upper { self.hatched(scene, b, a) } else { self.hatched(scene, a, b) }
    }

    /// What a slide slides on: hatched ground, as far below the way, or above it, as what slides reaches, or a guide on the body with `looks`,
    /// as wide as the box.
    pub(super) fn slideway(self, scene: &mut Scene, way: [Point; 2], body: Option<&Looks>, placement: &Placement) {
        match body {
            None => self.hatched_below(scene, way, (BOX[1] + 2.0).max(placement.clear / self.size), placement.upper),
            Some(looks) => {
                scene.line(way.to_vec(), Stroke::solid(looks.edge, self.guide_width() + 2.0 * self.pen(2.0)));
                scene.line(way.to_vec(), Stroke::solid(pale(looks.fill, 0.25), self.guide_width()));
            }
        }
    }

    /// Width of a guide on a body, pixels.
    pub(super) fn guide_width(self) -> f64 {
        2.0 * self.slide_box()[1] + 6.0 * self.size
    }

    /// Half length and half height of a sliding box, pixels.
    pub(super) fn slide_box(self) -> [f64; 2] {
        BOX.map(|x| x * self.size)
    }

    /// The box of a slide.
    pub(super) fn slider(self, scene: &mut Scene, placement: &Placement, looks: &Looks) {
        let half = self.slide_box();
        let fill = if looks.strong { pale(GREY, 0.28) } else { [250; 3] };
        scene.shape(corners(placement, half), Some(fill), Some(Stroke::solid(looks.edge, self.pen(2.4))));
    }

    /// The thread of a screw along its axis, over its box: a line that winds about it.
    pub(super) fn thread(self, scene: &mut Scene, placement: &Placement, looks: &Looks) {
        /// Turns that are drawn, and points of one.
        const TURNS: u32 = 4;
        const POINTS: u32 = 12;
        let (along, _) = direction([0.0; 2], placement.along);
        let [half, height] = [1.25 * self.slide_box()[0], 0.45 * self.slide_box()[1]];
        let wave = (0..=TURNS * POINTS).map(|k| {
            let turn = f64::from(k) / f64::from(POINTS) * TAU;
            off(placement.at, along, half * (2.0 * f64::from(k) / f64::from(TURNS * POINTS) - 1.0), height * turn.sin())
        });
        scene.line(wave.collect(), Stroke::solid(looks.edge, self.pen(1.8)));
    }

    /// A ring about the axis of a slide, over its box: its body can turn as well.
    pub(super) fn ring(self, scene: &mut Scene, placement: &Placement, looks: &Looks) {
        let (radius, [u, v]) = (1.3 * self.slide_box()[1], placement.across);
        let on = |k: u32| {
            let (s, c) = (TAU * f64::from(k) / 48.0).sin_cos();
            [placement.at[0] + radius * (c * u[0] + s * v[0]), placement.at[1] + radius * (c * u[1] + s * v[1])]
        };
        scene.line((0..=48).map(on).collect(), Stroke::solid(looks.edge, self.pen(2.4)));
    }

    /// A piece of the plane in which two bodies slide on each other, of the body that it belongs to.
    pub(super) fn plane(self, scene: &mut Scene, placement: &Placement, fill: Color, looks: &Looks) {
        let (half, [u, v]) = (30.0 * self.size, placement.across);
        let corner = |[s, t]: [f64; 2]| std::array::from_fn(|i| placement.at[i] + half * (s * u[i] + t * v[i]));
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner);
        scene.shape(corners.to_vec(), Some(pale(fill, 0.4)), Some(Stroke::solid(looks.edge, self.pen(2.0))));
    }

    /// A slide that areas hide: the outline of its box, and the line of its way.
    pub(super) fn hidden(self, scene: &mut Scene, placement: &Placement, looks: &Looks) {
        let half = self.slide_box();
        let (along, _) = direction([0.0; 2], placement.along);
        scene.shape(corners(placement, half), None, Some(Stroke::solid(looks.edge, self.pen(1.8))));
        let way = [-2.2, 2.2].map(|s| off(placement.at, along, s * half[0], 0.0));
        scene.line(way.to_vec(), Stroke::dashed(looks.edge, self.pen(1.4), &[10.0, 3.0, 2.0, 3.0]));
    }

    /// What a slot is cut into, where its body has no area of its own.
    pub(super) fn slot_frame(self, scene: &mut Scene, way: [Point; 2], looks: &Looks) {
        scene.line(way.to_vec(), Stroke::solid(looks.edge, 34.0 * self.size));
        scene.line(way.to_vec(), Stroke::solid(looks.fill, 30.0 * self.size));
    }

    /// A slot between two points: a white groove with a dark edge.
    pub(super) fn slot(self, scene: &mut Scene, way: [Point; 2], looks: &Looks) {
        scene.line(way.to_vec(), Stroke::solid(looks.edge, 15.0 * self.size));
        scene.line(way.to_vec(), Stroke::solid(looks.fill, 11.0 * self.size));
    }

    /// Radius of a pin, pixels.
    pub(super) fn pin_radius(self, strong: bool) -> f64 {
        (if strong { 7.5 } else { 6.0 }) * self.size
    }

    /// The sign at the point of a joint.
    pub(super) fn pin(self, scene: &mut Scene, kind: SymbolKind, placement: &Placement, looks: &Looks) {
        let (radius, width) = (self.pin_radius(looks.strong), self.pen(if looks.strong { 2.8 } else { 2.0 }));
        let edge = Some(Stroke::solid(looks.edge, width));
        match kind {
            SymbolKind::Hinge => {
                let [dx, dy] = placement.along.map(|x| x * 2.4 * radius);
                if looks.strong && dx.hypot(dy) > 1.2 * radius {
                    let ends = vec![[placement.at[0] - dx, placement.at[1] - dy], [placement.at[0] + dx, placement.at[1] + dy]];
                    scene.line(ends, Stroke::dashed(looks.edge, self.pen(1.6), &[10.0, 3.0, 2.0, 3.0]));
                }
                scene.circle(placement.at, radius, Some(looks.fill), edge);
            }
            SymbolKind::Ball => {
                scene.circle(placement.at, radius + 2.0 * self.size, Some(looks.fill), edge);
                scene.circle(placement.at, radius - 2.5 * self.size, Some(looks.edge), None);
            }
            SymbolKind::Cross => {
                scene.circle(placement.at, radius + 2.0 * self.size, Some(looks.fill), edge);
                for [dx, dy] in placement.across {
                    let end = |s: f64| [placement.at[0] + s * dx, placement.at[1] + s * dy];
                    let reach = 2.2 * radius;
                    scene.line(vec![end(-reach), end(reach)], Stroke::solid(looks.edge, self.pen(3.0)));
                }
            }
            SymbolKind::Slot => scene.circle(placement.at, 6.5 * self.size, Some(looks.edge), None),
            // Their box and their piece are drawn below the bodies.
            SymbolKind::Slide | SymbolKind::Plane => {}
            SymbolKind::Weld => scene.shape(corners(placement, [6.0 * self.size; 2]), Some(looks.edge), None),
        }
    }
}

/// Corners of a rectangle along the direction of a placement.
fn corners(placement: &Placement, half: [f64; 2]) -> Vec<Point> {
    let along = direction([0.0; 2], placement.along).0;
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[s, t]| off(placement.at, along, s * half[0], t * half[1])).to_vec()
}

/// So many points around a circle, and the first one again.
fn around(center: Point, radius: f64, count: u32) -> Vec<Point> {
    (0..=count).map(|k| TAU * f64::from(k) / f64::from(count)).map(|a| off(center, [a.cos(), a.sin()], radius, 0.0)).collect()
}

/// Points around a circle, the first one again at the end.
pub(super) fn circle(center: Point, radius: f64) -> Vec<Point> {
    around(center, radius, 16)
}

/// The line at `distance` on the lower side of `way`, or on the right of an upright one.
pub(super) fn lower_side(way: [Point; 2], distance: f64) -> [Point; 2] {
    let [(x, y), (u, v)] = way.map(|[x, y]| (x, y));
    let backwards = u - x < -1e-6 || (u - x).abs() <= 1e-6 && v > y;
    let [a, b] = if backwards { [way[1], way[0]] } else { way };
    let (along, _) = direction(a, b);
    [off(a, along, 0.0, distance), off(b, along, 0.0, distance)]
}

/// A way made longer by `more` at both ends; one without length gets the direction of its placement.
pub(super) fn longer(way: [Point; 2], placement: &Placement, more: f64) -> [Point; 2] {
    let (along, length) = direction(way[0], way[1]);
    let along = if length > 1e-6 { along } else { direction([0.0; 2], placement.along).0 };
    [off(way[0], along, -more, 0.0), off(way[1], along, more, 0.0)]
}

/// What of a way lies between two places along it, and by `inset` farther in; all of it where nothing would be left.
pub(super) fn within(way: [Point; 2], ends: [Point; 2], inset: f64) -> [Point; 2] {
    let (along, length) = direction(way[0], way[1]);
    let place = |p: Point| (p[0] - way[0][0]) * along[0] + (p[1] - way[0][1]) * along[1];
    let [a, b] = ends.map(place);
    let (low, high) = ((a.min(b) + inset).max(0.0), (a.max(b) - inset).min(length));
    if low < high { [off(way[0], along, low, 0.0), off(way[0], along, high, 0.0)] } else { way }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_ends_with_what_carries_it() {
        let way = [[0.0, 5.0], [100.0, 5.0]];
        assert_eq!(within(way, [[80.0, 5.0], [20.0, 5.0]], 5.0), [[25.0, 5.0], [75.0, 5.0]]);
        assert_eq!(within(way, [[-50.0, 5.0], [60.0, 5.0]], 5.0), [[0.0, 5.0], [55.0, 5.0]]);
        assert_eq!(within(way, [[200.0, 5.0], [300.0, 5.0]], 5.0), way);
    }

    #[test]
    fn a_way_without_length_is_drawn_along_its_slide() {
        let placement = Placement { at: [10.0, 0.0], along: [0.0, 2.0], ..Placement::default() };
        assert_eq!(longer([[10.0, 0.0]; 2], &placement, 5.0), [[10.0, -5.0], [10.0, 5.0]]);
        assert_eq!(longer([[0.0, 0.0], [30.0, 0.0]], &placement, 5.0), [[-5.0, 0.0], [35.0, 0.0]]);
    }
}
