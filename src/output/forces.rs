//! Forces as arrows, with the scale that a picture tells.

use super::font;
use super::lettering::{Lettering, Obstacle};
use super::pose::{Drawing, Force, ForceKind};
use super::scalars::significant;
use super::scene::{Anchor, Color, PALETTE, Scene};
use super::sheet::{Sheet, is_usable};
use super::symbols::{Signs, direction, off};
use super::thin::Point;
use std::f64::consts::TAU;

/// The longest arrow, as part of the size of a mechanism.
const LONGEST: f64 = 0.25;
/// The longest arrow that tells a scale, pixels.
const SAMPLE: f64 = 110.0;
/// Shorter arrows are not seen, pixels.
const SEEN: f64 = 3.0;
/// Length of the head of an arrow, pixels.
const HEAD: f64 = 13.0;

const KINDS: [(ForceKind, &str); 2] = [(ForceKind::Load, "loads"), (ForceKind::Reaction, "reactions")];

fn color(kind: ForceKind) -> Color {
    PALETTE[if kind == ForceKind::Load { 1 } else { 0 }]
}

fn length(force: &Force) -> f64 {
    force.along[0].hypot(force.along[1])
}

/// Force per length of the arrows of each kind, N/m; those that the study leaves open are a round number that suits a mechanism of this
/// size, m, the same for both.
pub(super) fn scales(drawing: &Drawing, size: f64) -> [f64; 2] {
    let open = drawing.forces.iter().filter(|force| force.scale.is_none());
    let most = open.map(length).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let suits = if most > 0.0 { round_above(most / (LONGEST * size)) } else { 1.0 };
    KINDS.map(|(kind, _)| drawing.forces.iter().find(|force| force.kind == kind).and_then(|force| force.scale).unwrap_or(suits))
}

/// The least of 1, 2 and 5 times a power of ten that is not below a number.
fn round_above(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|m| m * power).find(|round| *round >= x * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// The tips of all arrows, m.
pub(super) fn tips<'d>(drawing: &'d Drawing, scales: [f64; 2]) -> impl Iterator<Item = [f64; 2]> + 'd {
    drawing.forces.iter().map(move |force| {
        let scale = scales[force.kind as usize];
        [force.at[0] + force.along[0] / scale, force.at[1] + force.along[1] / scale]
    })
}

/// Draws the arrows of a drawing that are seen, of which names keep clear.
pub(super) fn draw(drawing: &Drawing, sheet: &Sheet, signs: Signs, scales: [f64; 2], scene: &mut Scene, letters: &mut Lettering) {
    for (force, tip) in drawing.forces.iter().zip(tips(drawing, scales)) {
        let Some((from, to)) = ends(force, tip, sheet) else { continue };
        if force.turning.is_some_and(|turning| turning != 0.0) {
            letters.avoid(from, [30.0 * signs.size; 2], [0.0; 2]);
        } else if force.turning.is_none() && direction(from, to).1 >= SEEN {
            letters.avoid_line(&[from, to], Obstacle::Body);
        } else {
            continue;
        }
        scene.shape(outline(force, signs, [from, to]), Some(color(force.kind)), None);
    }
}

/// The arrows of all forces of a drawing, each as one item with a number of points that does not change with the force, so that it can be
/// followed from picture to picture; one of no force has no area.
pub(super) fn draw_all(drawing: &Drawing, sheet: &Sheet, signs: Signs, scales: [f64; 2], scene: &mut Scene) {
    for (force, tip) in drawing.forces.iter().zip(tips(drawing, scales)) {
        if let Some((from, to)) = ends(force, tip, sheet) {
            scene.shape(outline(force, signs, [from, to]), Some(color(force.kind)), None);
        }
    }
}

/// Where an arrow begins and ends, pixels, if it can be drawn.
fn ends(force: &Force, tip: [f64; 2], sheet: &Sheet) -> Option<(Point, Point)> {
    (is_usable(&force.at) && is_usable(&tip)).then(|| (sheet.point(force.at), sheet.point(tip)))
}

fn outline(force: &Force, signs: Signs, [from, to]: [Point; 2]) -> Vec<Point> {
    match force.turning {
        Some(turning) => turned(signs, from, turning),
        None => arrow(signs, [from, to]),
    }
}

/// An arrow; one that is shorter than its head is a smaller one.
fn arrow(signs: Signs, [from, to]: [Point; 2]) -> Vec<Point> {
    let (along, length) = direction(from, to);
    let size = HEAD * signs.size.max(0.6);
    let part = (length / (2.0 * size)).min(1.0);
    let (base, shaft, wing) = (length - part * size, part * 0.5 * signs.pen(3.4), part * 0.5 * size);
    let at = |s: f64, t: f64| off(from, along, s, t);
    vec![at(0.0, -shaft), at(base, -shaft), at(base, -wing), to, at(base, wing), at(base, shaft), at(0.0, shaft)]
}

/// A torque: an arrow of seven tenths of a turn about its place, counter-clockwise for a positive one.
fn turned(signs: Signs, at: Point, turning: f64) -> Vec<Point> {
    const STEPS: u32 = 30;
    let sense = if turning == 0.0 { 0.0 } else { turning.signum() };
    let (radius, half, head) = (27.0 * signs.size, 0.5 * signs.pen(3.0), HEAD * signs.size.max(0.6));
    let point = |angle: f64, radius: f64| off(at, [angle.cos(), angle.sin()], sense.abs() * radius, 0.0);
    let angle = |k: u32| 0.6 * TAU - sense * 0.7 * TAU * f64::from(k) / f64::from(STEPS);
    let (end, tip) = (angle(STEPS), angle(STEPS) - sense * head / radius);
    let outer = (0..=STEPS).map(|k| point(angle(k), radius + half));
    let head = [point(end, radius + 0.5 * head), point(tip, radius), point(end, radius - 0.5 * head)];
    outer.chain(head).chain((0..=STEPS).rev().map(|k| point(angle(k), radius - half))).collect()
}

/// Tells the scale of each kind at the foot of a picture, from `left` on.
pub(super) fn legend(drawing: &Drawing, pixels: f64, scales: [f64; 2], scene: &mut Scene, left: f64, letters: f64) {
    let (mut x, y) = (left, scene.height - 26.0);
    for (kind, name) in KINDS {
        if drawing.forces.iter().all(|force| force.kind != kind || length(force) * pixels < SEEN * scales[kind as usize]) {
            continue;
        }
        let most = SAMPLE * scales[kind as usize] / pixels;
        let value = round_above(0.4 * most);
        let to = x + value * pixels / scales[kind as usize];
        scene.shape(arrow(Signs { size: 0.8 }, [[x, y], [to, y]]), Some(color(kind)), None);
        let (shown, unit) = if value >= 1e3 { (value / 1e3, "kN") } else { (value, "N") };
        let text = format!("{name}: {} {unit}", significant(shown, 4));
        scene.text([to + 16.0, y + letters * font::CAPITAL / 2.0], text.clone(), letters, Anchor::Start);
        x = to + 16.0 + font::width(&text, letters) + 30.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_keep_their_number_of_points_and_end_at_their_tips() {
        let signs = Signs { size: 1.0 };
        for to in [[80.0, 0.0], [1.0, 1.0], [0.0, 0.0]] {
            let points = arrow(signs, [[0.0; 2], to]);
            assert_eq!((points.len(), points[3]), (7, to));
        }
        assert!(arrow(signs, [[5.0; 2]; 2]).iter().all(|p| *p == [5.0; 2]));
        let counts = [2.0, -1.0, 0.0].map(|turning| turned(signs, [0.0; 2], turning).len());
        assert!(counts.iter().all(|count| *count == counts[0]));
        assert!(turned(signs, [5.0; 2], 0.0).iter().all(|p| *p == [5.0; 2]));
    }

    #[test]
    fn scales_are_round_and_those_that_are_asked_for() {
        let force = |kind, along, scale| Force { kind, along, scale, ..Force::default() };
        let forces = vec![force(ForceKind::Load, [0.0, -300.0], None), force(ForceKind::Reaction, [400.0, 300.0], None)];
        let mut drawing = Drawing { forces, ..Drawing::default() };
        // 500 N are at most a quarter of 2 m long
        assert_eq!(scales(&drawing, 2.0), [1000.0, 1000.0]);
        drawing.forces[1].scale = Some(50.0);
        assert_eq!(scales(&drawing, 2.0), [1000.0, 50.0]);
        assert_eq!(tips(&drawing, [1000.0, 50.0]).last(), Some([8.0, 6.0]));
        assert_eq!(scales(&Drawing::default(), 1.0), [1.0, 1.0]);
    }
}
