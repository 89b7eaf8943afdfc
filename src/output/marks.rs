//! Signs beside the bodies: springs and dampers, what drives, stops, gears, the axes of space, the scale.

use super::font;
use super::pose::{Gear, Link, LinkKind, Placement};
use super::scene::{Anchor, Color, INK, Scene, Stroke};
use super::symbols::{Signs, direction, off};
use super::thin::Point;
use crate::results::ShownIn;
use std::f64::consts::{PI, TAU};

/// Of springs and dampers.
pub(super) const RUST: Color = [150, 60, 20];
/// Of what drives.
pub(super) const DRIVE: Color = [0, 112, 84];
/// Of stops.
const STOP: Color = [176, 20, 40];
/// Of belts and ropes.
const BELT: Color = [70, 70, 76];
/// A centre line: long, short.
const CENTRE: &[f64] = &[16.0, 5.0, 3.0, 5.0];
/// Nearer hinges are one for a clutch, in units of signs.
const AROUND: f64 = 40.0;
/// Radius at which the stops of a hinge end, in units of signs.
const SWING: f64 = 44.0;
/// Coils of a spring, whatever its length: one that is pulled is seen to be.
const COILS: u32 = 8;

impl Signs {
    /// A massless element between two points; in the first position.
    pub(super) fn link(self, scene: &mut Scene, link: &Link, [a, b]: [Point; 2]) {
        let kind = link.kind;
        let turned = link.turned.first().copied().filter(|t| t.iter().all(|x| x.is_finite())).unwrap_or_default();
        let about_hinge = kind == LinkKind::Clutch && direction(a, b).1 < AROUND * self.size;
        if kind != LinkKind::Brake && !about_hinge {
            let color = if kind == LinkKind::Actuator { DRIVE } else { RUST };
            [a, b].into_iter().for_each(|end| scene.circle(end, 4.0 * self.size, Some(color), None));
        }
        let (along, _) = direction(a, b);
        match kind {
            LinkKind::Spring => self.spring(scene, [a, b]),
            LinkKind::Damper => self.damper(scene, [a, b]),
            LinkKind::SpringDamper => {
                let aside = 12.0 * self.size;
                for (side, spring) in [(-aside, true), (aside, false)] {
                    let ends = [off(a, along, 0.0, side), off(b, along, 0.0, side)];
                    if spring { self.spring(scene, ends) } else { self.damper(scene, ends) }
                }
                for end in [a, b] {
                    scene.line(vec![off(end, along, 0.0, -aside), off(end, along, 0.0, aside)], Stroke::solid(RUST, self.pen(2.6)));
                }
            }
            LinkKind::Actuator => self.actuator(scene, [a, b], link.cylinder.first().copied().unwrap_or_default(), link.stages),
            LinkKind::Rod => scene.line(vec![a, b], Stroke::solid(RUST, self.pen(2.6))),
            LinkKind::Torsion => self.spiral(scene, a, turned),
            LinkKind::Shaft => {
                let (middle, _) = self.shaft(scene, [a, b], 24.0);
                self.spiral(scene, middle, turned);
            }
            LinkKind::Clutch => self.clutch(scene, [a, b], turned),
            LinkKind::Brake => self.brake(scene, [a, b], turned[0]),
        }
    }

    fn spring(self, scene: &mut Scene, [a, b]: [Point; 2]) {
        let (along, length) = direction(a, b);
        // The straight ends; the coils stay between.
        let end = (0.16 * length).min(22.0 * self.size);
        let step = (length - 2.0 * end) / f64::from(2 * COILS);
        let half = (10.0 * self.size).min(0.2 * length);
        let zigzag = (0..2 * COILS).map(|k| off(a, along, end + (f64::from(k) + 0.5) * step, if k % 2 == 0 { half } else { -half }));
        let points = [a, off(a, along, end, 0.0)].into_iter().chain(zigzag).chain([off(a, along, length - end, 0.0), b]);
        scene.line(points.collect(), Stroke::solid(RUST, self.pen(2.4)));
    }

    fn damper(self, scene: &mut Scene, [a, b]: [Point; 2]) {
        let (along, length) = direction(a, b);
        let stroke = Stroke::solid(RUST, self.pen(2.6));
        let at = |s: f64, t: f64| off(a, along, s * length, t * self.size);
        scene.line(vec![a, at(0.35, 0.0)], stroke);
        scene.line(vec![at(0.65, -10.0), at(0.35, -10.0), at(0.35, 10.0), at(0.65, 10.0)], stroke);
        scene.line(vec![at(0.55, 0.0), b], stroke);
        scene.line(vec![at(0.55, -7.0), at(0.55, 7.0)], Stroke::solid(RUST, self.pen(3.6)));
    }

    /// Tubes that slide in each other, the first as long as a part of what is between a and b, the last one a rod.
    fn actuator(self, scene: &mut Scene, [a, b]: [Point; 2], tube: f64, stages: usize) {
        let (along, length) = direction(a, b);
        let half = (11.0 * self.size).min(0.2 * length);
        let at = |s: f64, t: f64| off(a, along, s * length, t * half);
        let tube = if tube.is_finite() { tube.clamp(0.0, 1.0) } else { 0.0 };
        let last = stages.max(2) - 1;
        let mouth = |k: usize| tube + (1.0 - tube) * k as f64 / last as f64;
        let foot = (0.08 * tube).min(10.0 * self.size / length.max(1.0));
        let (edge, rod) = (Stroke::solid(DRIVE, self.pen(2.4)), Stroke::solid(DRIVE, self.pen(5.0)));
        scene.line(vec![a, at(foot, 0.0)], rod);
        scene.line(vec![at(mouth(last - 1), 0.0), b], rod);
        for k in (0..last).rev() {
            let (from, to) = (if k == 0 { foot } else { mouth(k - 1) }, mouth(k));
            let wide = 1.0 - 0.8 * k as f64 / last as f64;
            scene.shape(vec![at(from, -wide), at(to, -wide), at(to, wide), at(from, wide)], Some([226, 240, 235]), Some(edge));
        }
    }

    /// A spring about a hinge: from the first body outside to the second one inside, wound by the angle between them.
    fn spiral(self, scene: &mut Scene, at: Point, [a, b]: [f64; 2]) {
        let (inner, outer) = (10.0 * self.size, 24.0 * self.size);
        let from = a;
        let to = b + 2.0 * TAU - TAU * ((b - a) / TAU).floor();
        let points = (0..=60).map(|k| {
            let s = f64::from(k) / 60.0;
            let (angle, radius) = (from + s * (to - from), outer + s * (inner - outer));
            [at[0] + radius * angle.cos(), at[1] - radius * angle.sin()]
        });
        scene.line(points.collect(), Stroke::solid(RUST, self.pen(2.0)));
    }

    /// A line between two hinges with a gap in its middle; gives the middle, and the direction.
    fn shaft(self, scene: &mut Scene, [a, b]: [Point; 2], gap: f64) -> (Point, Point) {
        let (along, length) = direction(a, b);
        let half = gap * self.size;
        for ends in [[a, off(a, along, 0.5 * length - half, 0.0)], [b, off(a, along, 0.5 * length + half, 0.0)]] {
            if 0.5 * length > half {
                scene.line(ends.to_vec(), Stroke::dashed(RUST, self.pen(1.8), CENTRE));
            }
        }
        (off(a, along, 0.5 * length, 0.0), along)
    }

    /// Two plates: in the middle between two hinges, or around one, the inner one turning with the second body.
    fn clutch(self, scene: &mut Scene, [a, b]: [Point; 2], turned: [f64; 2]) {
        if direction(a, b).1 < AROUND * self.size {
            for (angle, radius) in [(turned[0], 23.0), (turned[1], 16.0)] {
                self.shoes(scene, a, angle, radius);
            }
            return;
        }
        let (middle, along) = self.shaft(scene, [a, b], 4.0);
        for side in [-4.0 * self.size, 4.0 * self.size] {
            let end = |t: f64| off(middle, along, side, t * self.size);
            scene.line(vec![end(-14.0), end(14.0)], Stroke::solid(RUST, self.pen(4.0)));
        }
    }

    /// Two shoes on both sides of a hinge, on the first body, or one above what slides from a to b.
    fn brake(self, scene: &mut Scene, [a, b]: [Point; 2], turned: f64) {
        let (along, length) = direction(a, b);
        if length < 1.0 {
            self.shoes(scene, a, turned, 20.0);
            for side in [0.0, PI] {
                let at = |radius: f64| off(a, [(turned + side).cos(), -(turned + side).sin()], radius * self.size, 0.0);
                scene.line(vec![at(20.0), at(30.0)], Stroke::solid(RUST, self.pen(2.4)));
            }
            return;
        }
        let up = if along[0] < 0.0 { 1.0 } else { -1.0 };
        let [half, height] = self.slide_box();
        let at = |s: f64, t: f64| off(b, along, s, up * (height + t * self.size));
        scene.line(vec![at(-0.7 * half, 4.0), at(0.7 * half, 4.0)], Stroke::solid(RUST, self.pen(5.0)));
        scene.line(vec![at(0.0, 4.0), at(0.0, 16.0)], Stroke::solid(RUST, self.pen(2.4)));
    }

    /// Thick arcs on both sides of a hinge.
    fn shoes(self, scene: &mut Scene, at: Point, angle: f64, radius: f64) {
        for side in [angle, angle + PI] {
            let on = |k: i32| {
                let (sin, cos) = (side + f64::from(k) * 0.1).sin_cos();
                [at[0] + radius * self.size * cos, at[1] - radius * self.size * sin]
            };
            scene.line((-7..=7).map(on).collect(), Stroke::solid(RUST, self.pen(4.4)));
        }
    }

    /// The arrow of what drives a joint: about a hinge, or along a slide above its box. Gives its line.
    pub(super) fn drive(self, scene: &mut Scene, placement: &Placement, slides: bool) -> Vec<Point> {
        let both = placement.sense == 0.0;
        let points: Vec<Point> = if slides {
            let (along, _) = direction([0.0; 2], placement.along);
            let (reach, height) = (26.0 * self.size, self.slide_box()[1] + 12.0 * self.size);
            // above the box, whichever way the slide points
            let side = if along[0] >= 0.0 { -height } else { height };
            let sense = if both { 1.0 } else { placement.sense };
            vec![off(placement.at, along, -sense * reach, side), off(placement.at, along, sense * reach, side)]
        } else {
            let radius = 22.0 * self.size;
            let [u, v] = placement.across;
            let (from, to) = if placement.sense < 0.0 { (2.6, -1.1) } else { (-1.1, 2.6) };
            let at = |k: u32| {
                let (s, c) = (from + (to - from) * f64::from(k) / 40.0_f64).sin_cos();
                [placement.at[0] + radius * (c * u[0] + s * v[0]), placement.at[1] + radius * (c * u[1] + s * v[1])]
            };
            (0..=40).map(at).collect()
        };
        scene.line(points.clone(), Stroke::solid(DRIVE, self.pen(3.0)));
        self.head(scene, &points, DRIVE);
        if both {
            self.head(scene, &points.iter().rev().copied().collect::<Vec<_>>(), DRIVE);
        }
        points
    }

    /// The damping of a joint: a small dashpot behind the box of a slide, beside a rod that goes through it, or behind what slides, or bent
    /// about a hinge where the arrow of a drive has its gap. Gives its middle line.
    pub(super) fn dashpot(self, scene: &mut Scene, placement: &Placement, slides: bool, grounded: bool) -> Vec<Point> {
        let size = self.size;
        let (along, _) = direction([0.0; 2], placement.along);
        let [u, v] = placement.across;
        let side = if along[0] >= 0.0 { -1.0 } else { 1.0 } * if placement.back > self.slide_box()[0] { 8.0 } else { 18.0 };
        // s from what moves to what holds it, t across
        let at = |s: f64, t: f64| -> Point {
            if slides {
                return off(placement.at, along, -self.slide_box()[0].max(placement.back) - 38.0 * size * s, size * (side + 6.0 * t));
            }
            let ((sin, cos), radius) = ((3.0 + 1.8 * s).sin_cos(), size * (27.0 + 7.5 * t));
            [placement.at[0] + radius * (cos * u[0] + sin * v[0]), placement.at[1] + radius * (cos * u[1] + sin * v[1])]
        };
        let run = |from: f64, to: f64, t: f64| (0..=10).map(move |k| (from + (to - from) * f64::from(k) / 10.0, t));
        let mut line = |places: Vec<(f64, f64)>, width: f64| {
            let points: Vec<Point> = places.into_iter().map(|(s, t)| at(s, t)).collect();
            scene.line(points, Stroke::solid(RUST, self.pen(width)));
        };
        // a rod with its piston, the pot around it, and what that is fixed to
        line(run(0.0, 0.55, 0.0).collect(), 2.4);
        line(vec![(0.55, -0.65), (0.55, 0.65)], 3.2);
        line(run(0.35, 0.8, -1.0).chain(run(0.8, 0.35, 1.0)).collect(), 2.4);
        line(run(0.8, 1.0, 0.0).collect(), 2.4);
        line(vec![(1.0, -0.9), (1.0, 0.9)], 2.4);
        // what it begins at
        line(vec![(0.0, 0.0), (0.0, if slides { -f64::signum(side) } else { -2.4 })], 2.4);
        if slides && grounded {
            // the hatch of the ground
            for t in [-0.9, -0.3, 0.3, 0.9] {
                line(vec![(1.0, t), (1.2, t + 0.5)], 1.4);
            }
        }
        run(0.0, 1.0, 0.0).map(|(s, t)| at(s, t)).collect()
    }

    /// The head of an arrow at the end of a line.
    pub(super) fn head(self, scene: &mut Scene, points: &[Point], color: Color) {
        let Some(tip) = points.last() else { return };
        let size = 9.0 * self.size.max(0.6);
        let behind = points.iter().rev().find(|p| (p[0] - tip[0]).hypot(p[1] - tip[1]) > 0.8 * size);
        let Some(behind) = behind else { return };
        let (along, _) = direction(*behind, *tip);
        let end = off(*tip, along, 0.45 * size, 0.0);
        scene.shape(vec![end, off(end, along, -1.3 * size, 0.6 * size), off(end, along, -1.3 * size, -0.6 * size)], Some(color), None);
    }

    /// Stops: bars across the way where the box or what slides ends, as high as that, or radial ones beside a hinge, between which an arc is
    /// its range. Places and lengths in pixels.
    pub(super) fn stops(self, scene: &mut Scene, placement: &Placement, slides: bool) {
        let stroke = Stroke::solid(STOP, self.pen(5.0));
        if let ([Some(first), _], Some(swing)) = (placement.stops, placement.swing) {
            let quarter = placement.quarter[0];
            let on = |k: u32| -> Point {
                let turned = swing * f64::from(k) / 96.0;
                let (s, c) = turned.sin_cos();
                // of more than a turn a spiral
                let radius = SWING * self.size * if swing > TAU { 1.0 + 0.2 * turned / TAU } else { 1.0 };
                std::array::from_fn(|i| placement.at[i] + radius * (c * first[i] + s * quarter[i]))
            };
            scene.line((0..=96).map(on).collect(), Stroke::solid(STOP, self.pen(1.6)));
        }
        for (k, sense) in [-1.0, 1.0].into_iter().enumerate() {
            let (Some(stop), beyond, quarter) = (placement.stops[k], placement.beyond[k], placement.quarter[k]) else { continue };
            if slides {
                let (along, _) = direction([0.0; 2], placement.along);
                let half = self.slide_box();
                let at = |t: f64| off(stop, along, sense * (half[0].max(beyond) + 4.0 * self.size), t * half[1].max(placement.clear));
                scene.line(vec![at(-1.0), at(1.0)], stroke);
            } else {
                let aside = sense * (self.size * super::symbols::BAR * 0.5 + 3.0);
                let at = |s: f64| std::array::from_fn(|i| placement.at[i] + s * self.size * stop[i] + aside * quarter[i]);
                scene.line(vec![at(16.0), at(SWING)], stroke);
            }
        }
    }

    /// Pitch circles and lines, and where they touch; belts and ropes.
    pub(super) fn gear(self, scene: &mut Scene, gear: &Gear) {
        let stroke = Stroke::dashed(INK, self.pen(1.3), CENTRE);
        gear.circles.iter().for_each(|circle| scene.line(circle.clone(), stroke));
        gear.rims.iter().for_each(|rim| scene.line(rim.clone(), Stroke::solid(INK, self.pen(2.5))));
        gear.line.iter().for_each(|line| scene.line(line.to_vec(), stroke));
        if !gear.belt.is_empty() {
            scene.shape(gear.belt.clone(), None, Some(Stroke::solid(BELT, self.pen(4.0))));
        }
        gear.rope.iter().for_each(|rope| scene.line(rope.to_vec(), Stroke::solid(BELT, self.pen(4.0))));
        gear.mesh.iter().for_each(|at| scene.circle(*at, 4.5 * self.size.max(0.6), Some(DRIVE), None));
    }
}

/// The axes of space with their names, at the lower right; `axes` in pixels, each as long as one unit is seen.
pub(super) fn triad(scene: &mut Scene, axes: [Point; 3], letters: f64) {
    let signs = Signs { size: 0.7 };
    let origin = [scene.width - 70.0, scene.height - 58.0];
    for (axis, name) in axes.into_iter().zip(["x", "y", "z"]) {
        let tip = [origin[0] + 36.0 * axis[0], origin[1] + 36.0 * axis[1]];
        if (tip[0] - origin[0]).hypot(tip[1] - origin[1]) < 4.0 {
            scene.circle(origin, 3.0, Some(INK), None);
            continue;
        }
        scene.line(vec![origin, tip], Stroke::solid(INK, 1.8));
        signs.head(scene, &[origin, tip], INK);
        let (along, _) = direction(origin, tip);
        let at = off(tip, along, 14.0, 0.0);
        scene.text([at[0], at[1] + 0.8 * letters * font::CAPITAL / 2.0], name, 0.8 * letters, Anchor::Middle);
    }
}

/// A bar of round length at the lower left, for `scale` pixels to the metre, in the unit that is asked for or in m or mm. Gives where it
/// ends, pixels.
pub(super) fn scale_bar(scene: &mut Scene, scale: f64, asked: Option<&ShownIn>, letters: f64) -> f64 {
    let size = asked.map_or(1.0, |asked| asked.size);
    let longest = 200.0 / (scale * size);
    let power = 10f64.powf(longest.log10().floor());
    let length = [5.0, 2.0, 1.0].into_iter().map(|m| m * power).find(|length| *length <= longest * (1.0 + 1e-9)).unwrap_or(power);
    let (left, y) = (30.0, scene.height - 26.0);
    let right = left + length * size * scale;
    scene.line(vec![[left, y], [right, y]], Stroke::solid(INK, 2.5));
    for x in [left, right] {
        scene.line(vec![[x, y - 7.0], [x, y + 7.0]], Stroke::solid(INK, 2.5));
    }
    let (length, unit) = match asked {
        Some(asked) => (length, asked.unit.as_str()),
        None if length < 0.0099 => (length * 1e3, "mm"),
        None => (length, "m"),
    };
    let text = format!("{} {unit}", super::scalars::significant(length, 6));
    scene.text([right + 14.0, y + letters * font::CAPITAL / 2.0], text.clone(), letters, Anchor::Start);
    right + 14.0 + font::width(&text, letters)
}

#[cfg(test)]
mod tests {
    use super::super::scene::Item;
    use super::*;

    #[test]
    fn stops_stand_where_the_box_or_what_slides_meets_them() {
        let ends = |beyond: [f64; 2], clear: f64| {
            let mut scene = Scene::default();
            let stops = [Some([10.0, 0.0]), Some([90.0, 0.0])];
            let placement = Placement { along: [1.0, 0.0], stops, beyond, clear, ..Placement::default() };
            Signs { size: 1.0 }.stops(&mut scene, &placement, true);
            let end = |item: &Item| if let Item::Path { points, .. } = item { points[1] } else { panic!("{item:?}") };
            scene.items.iter().map(end).collect::<Vec<_>>()
        };
        let half = Signs { size: 1.0 }.slide_box();
        assert_eq!(ends([0.0, 1.0], 0.0), [[10.0 - half[0] - 4.0, half[1]], [90.0 + half[0] + 4.0, half[1]]]);
        assert_eq!(ends([200.0, 300.0], 40.0), [[10.0 - 204.0, 40.0], [90.0 + 304.0, 40.0]]);
    }

    #[test]
    fn clutches_are_plates_between_two_hinges_or_arcs_around_one() {
        let points = |kind: LinkKind, ends: [Point; 2]| -> Vec<Vec<Point>> {
            let mut scene = Scene::default();
            let link = Link { kind, turned: vec![[0.0, 1.0]], cylinder: vec![0.5], ..Link::default() };
            Signs { size: 1.0 }.link(&mut scene, &link, ends);
            let of = |item: Item| if let Item::Path { points, .. } = item { Some(points) } else { None };
            scene.items.into_iter().filter_map(of).collect()
        };
        let apart = points(LinkKind::Clutch, [[0.0, 0.0], [200.0, 0.0]]);
        let plates: Vec<_> = apart.iter().filter(|line| line[0][0] == line[1][0]).collect();
        assert!(apart.len() == 4 && plates.len() == 2 && plates.iter().all(|line| (line[0][0] - 100.0).abs() < 5.0), "{apart:?}");
        let distance = |line: &Vec<Point>| line[0][0].hypot(line[0][1]);
        let around = points(LinkKind::Clutch, [[0.0, 0.0], [0.0, 0.0]]);
        assert_eq!(around.iter().map(|line| distance(line).round()).collect::<Vec<_>>(), [23.0, 23.0, 16.0, 16.0]);
        assert_eq!(points(LinkKind::Brake, [[0.0, 0.0], [0.0, 0.0]]).len(), 4);
        // above the box, whichever way the slide goes
        for from in [-50.0, 50.0] {
            let shoe = points(LinkKind::Brake, [[from, 0.0], [0.0, 0.0]]);
            assert!(shoe.iter().flatten().all(|p| p[1] < -Signs { size: 1.0 }.slide_box()[1]), "{shoe:?}");
        }
        // the spiral of a shaft stands in its middle
        let shaft = points(LinkKind::Shaft, [[0.0, 0.0], [200.0, 0.0]]);
        assert!(shaft.len() == 3 && shaft[2].iter().all(|p| (p[0] - 100.0).hypot(p[1]) < 24.5), "{shaft:?}");
    }

    #[test]
    fn a_dashpot_lies_behind_a_box_or_in_the_gap_of_a_drive() {
        let at = [100.0, 100.0];
        let points = |placement: &Placement, slides: bool| {
            let mut scene = Scene::default();
            let line = Signs { size: 1.0 }.dashpot(&mut scene, placement, slides, true);
            let of = |item: &Item| if let Item::Path { points, .. } = item { points.clone() } else { panic!("{item:?}") };
            assert!(scene.items.len() >= 5 && line.len() > 2, "{:?}", scene.items);
            scene.items.iter().flat_map(of).collect::<Vec<_>>()
        };
        let slide = points(&Placement { at, along: [1.0, 0.0], ..Placement::default() }, true);
        // beside a rod that goes through the box
        let beside = |p: &Point| p[1] > 74.0 && p[1] < 100.0 - 0.45 * crate::output::symbols::BAR;
        assert!(slide.iter().all(|p| p[0] <= 100.0 - Signs { size: 1.0 }.slide_box()[0] && beside(p)), "{slide:?}");
        let block = points(&Placement { at, along: [-1.0, 0.0], back: 60.0, ..Placement::default() }, true);
        assert!(block.iter().all(|p| p[0] >= 160.0 && (p[1] - 100.0).abs() < 18.0), "{block:?}");
        // across of a hinge in the plane; the arrow of its drive is at 22 pixels, elsewhere around
        let across = [[0.0, 1.0], [1.0, 0.0]];
        let hinge = points(&Placement { at, across, ..Placement::default() }, false);
        let mut scene = Scene::default();
        let drive = Signs { size: 1.0 }.drive(&mut scene, &Placement { at, across, sense: 1.0, ..Placement::default() }, false);
        let far = |p: &Point| drive.iter().map(|q| (p[0] - q[0]).hypot(p[1] - q[1])).fold(f64::INFINITY, f64::min);
        assert!(hinge.iter().all(|p| far(p) > 6.0 && (p[0] - 100.0).hypot(p[1] - 100.0) < 35.0), "{hinge:?}");
        // as wide as the pin that it stands beside
        let reach = hinge.iter().map(|p| (p[0] - 100.0).hypot(p[1] - 100.0)).fold(0.0, f64::max);
        assert!(reach > 4.0 * Signs { size: 1.0 }.pin_radius(true), "{reach}");
    }

    #[test]
    fn the_bar_is_as_long_as_it_says() {
        let asked = |unit: &str, size: f64| Some(ShownIn { unit: unit.into(), size });
        for (scale, asked, text, metres) in [
            (1000.0, None, "0.2 m", 0.2),
            (1e5, None, "2 mm", 2e-3),
            (1000.0, asked("mm", 1e-3), "200 mm", 0.2),
            (100.0, asked("ft", 0.3048), "5 ft", 1.524),
        ] {
            let mut scene = Scene { width: 1000.0, height: 500.0, ..Scene::default() };
            scale_bar(&mut scene, scale, asked.as_ref(), 20.0);
            let [Item::Path { points, .. }, .., Item::Text(label)] = &scene.items[..] else { panic!("{:?}", scene.items) };
            assert_eq!(label.text, text);
            assert!((points[1][0] - points[0][0] - metres * scale).abs() < 1e-9, "{text}: {points:?}");
        }
    }
}
