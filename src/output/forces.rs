//! Forces as arrows, with the scale that a picture tells.

use super::font;
use super::lettering::{Lettering, Obstacle};
use super::pose::{Drawing, Force, ForceKind};
use super::scalars::significant;
use super::scene::{Anchor, Color, PALETTE, Scene, Stroke};
use super::sheet::{Sheet, is_usable};
use super::symbols::{Signs, off};
use super::thin::Point;
use std::f64::consts::TAU;

/// The longest arrow, as part of the size of a mechanism.
const LONGEST: f64 = 0.25;
/// The longest arrow that tells a scale, pixels.
const SAMPLE: f64 = 110.0;
/// Shorter arrows are not seen, pixels.
const SEEN: f64 = 3.0;

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

/// Draws the arrows of a drawing, of which names keep clear.
pub(super) fn draw(drawing: &Drawing, sheet: &Sheet, signs: Signs, scales: [f64; 2], scene: &mut Scene, letters: &mut Lettering) {
    for (force, tip) in drawing.forces.iter().zip(tips(drawing, scales)) {
        if !is_usable(&force.at) || !is_usable(&tip) {
            continue;
        }
        let (from, to, color) = (sheet.point(force.at), sheet.point(tip), color(force.kind));
        if force.turning != 0.0 {
            turned(scene, signs, from, force.turning.signum(), color);
            letters.avoid(from, [30.0 * signs.size; 2], [0.0; 2]);
        } else if (to[0] - from[0]).hypot(to[1] - from[1]) >= SEEN {
            arrow(scene, signs, [from, to], color);
            letters.avoid_line(&[from, to], Obstacle::Body);
        }
    }
}

fn arrow(scene: &mut Scene, signs: Signs, [from, to]: [Point; 2], color: Color) {
    scene.line(vec![from, to], Stroke::solid(color, signs.pen(3.4)));
    signs.head(scene, &[from, to], color);
}

/// A torque: three quarters of a turn about its place, counter-clockwise for a positive one.
fn turned(scene: &mut Scene, signs: Signs, at: Point, sense: f64, color: Color) {
    let radius = 27.0 * signs.size;
    let points: Vec<Point> = (0..=30)
        .map(|k| {
            let angle = 0.6 * TAU - sense * 0.7 * TAU * f64::from(k) / 30.0;
            off(at, [angle.cos(), angle.sin()], radius, 0.0)
        })
        .collect();
    scene.line(points.clone(), Stroke::solid(color, signs.pen(3.0)));
    signs.head(scene, &points, color);
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
        arrow(scene, Signs { size: 0.8 }, [[x, y], [to, y]], color(kind));
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
