//! Forces as arrows, with the scale that a picture tells.

use super::font;
use super::lettering::{Lettering, Obstacle};
use super::pose::{Drawing, Force, ForceKind};
use super::scalars::significant;
use super::scene::{Anchor, Color, PALETTE, Scene};
use super::sheet::{Sheet, is_usable};
use super::symbols::{Signs, direction, off};
use super::thin::Point;
use super::units::pretty;
use crate::results::ShownIn;
use std::f64::consts::TAU;

/// The longest arrow, as part of the size of a mechanism.
const LONGEST: f64 = 0.25;
/// The longest arrow that tells a scale, pixels.
const SAMPLE: f64 = 110.0;
/// Radius of the arrow of the largest torque, pixels.
const LARGEST: f64 = 48.0;
/// Radius of the arrow that tells how large that is, pixels.
const TURNED: f64 = 19.0;
/// Times by which the largest force of one kind is beyond that of the other so that they have scales of their own.
const SPECKS: f64 = 10.0;
/// Shorter arrows are not seen, pixels.
const SEEN: f64 = 3.0;
/// Room for the axes of space at the right, pixels.
const AXES: f64 = 150.0;
/// Where the foot of a picture begins at the left, pixels.
const MARGIN: f64 = 30.0;
/// Length of the head of an arrow, pixels.
const HEAD: f64 = 13.0;

/// What reactions lack.
const WITHOUT: &str = "without pulls of ropes and teeth";

/// Kinds with the names of their forces and of their torques.
const KINDS: [(ForceKind, &str, &str); 2] = [(ForceKind::Load, "loads", "torques"), (ForceKind::Reaction, "reactions", "moments")];

pub(super) fn color(kind: ForceKind) -> Color {
    PALETTE[if kind == ForceKind::Load { 1 } else { 0 }]
}

fn length(force: &Force) -> f64 {
    force.along[0].hypot(force.along[1])
}

/// How large forces and torques are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scales {
    /// Force per length of the arrows of each kind, N/m.
    force: [f64; 2],
    /// The largest torque of each kind, whose arrow has the largest radius, N m.
    torque: [f64; 2],
    /// Whether they are those of a whole motion, not of the positions of a picture.
    pub(super) of_motion: bool,
}

/// The scales of a drawing; those of forces that the study leaves open are a round number that suits a mechanism of this size, m: one for both
/// kinds, unless the arrows of one would be specks.
pub(super) fn scales(drawing: &Drawing, size: f64) -> Scales {
    let most = KINDS.map(|(kind, ..)| {
        let own = drawing.forces.iter().filter(|force| force.kind == kind && force.turning.is_none());
        own.map(|force| force.size).filter(|x| x.is_finite()).fold(0.0, f64::max)
    });
    let both = most[0].max(most[1]);
    let suits = |kind| {
        let own = most[kind as usize];
        let most = if own * SPECKS >= both { both } else { own };
        if most > 0.0 { round_above(most / (LONGEST * size)) } else { 1.0 }
    };
    let asked = |kind| drawing.forces.iter().find(|force| force.kind == kind).and_then(|force| force.scale);
    let torque = |kind| {
        let own = drawing.forces.iter().filter(|force| force.kind == kind).filter_map(|force| force.turning);
        own.map(f64::abs).filter(|x| x.is_finite()).fold(0.0, f64::max)
    };
    let force = KINDS.map(|(kind, ..)| asked(kind).unwrap_or_else(|| suits(kind)));
    Scales { force, torque: KINDS.map(|(kind, ..)| torque(kind)), of_motion: false }
}

/// The least of 1, 2 and 5 times a power of ten that is not below a number.
fn round_above(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|m| m * power).find(|round| *round >= x * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// The tips of all arrows, m.
pub(super) fn tips<'d>(drawing: &'d Drawing, scales: Scales) -> impl Iterator<Item = [f64; 2]> + 'd {
    drawing.forces.iter().map(move |force| {
        let scale = scales.force[force.kind as usize];
        [force.at[0] + force.along[0] / scale, force.at[1] + force.along[1] / scale]
    })
}

/// Draws the arrows of a drawing that are seen, of which names keep clear.
pub(super) fn draw(drawing: &Drawing, sheet: &Sheet, signs: Signs, scales: Scales, scene: &mut Scene, letters: &mut Lettering) {
    for (force, tip) in drawing.forces.iter().zip(tips(drawing, scales)) {
        let Some((from, to)) = ends(force, tip, sheet) else { continue };
        let outline = outline(force, signs, scales, [from, to]);
        if force.turning.is_some() {
            let reach = |i: usize| outline.iter().map(|p| (p[i] - from[i]).abs()).fold(0.0, f64::max);
            if reach(0).max(reach(1)) < SEEN {
                continue;
            }
            letters.avoid(from, [0, 1].map(|i| 3.0 * signs.size + reach(i)), [0.0; 2]);
        } else if direction(from, to).1 >= SEEN {
            letters.avoid_line(&[from, to], Obstacle::Body);
        } else {
            continue;
        }
        scene.shape(outline, Some(color(force.kind)), None);
    }
}

/// The arrows of all forces of a drawing, each as one item with a number of points that does not change with the force, so that it can be
/// followed from picture to picture; one of no force has no area.
pub(super) fn draw_all(drawing: &Drawing, sheet: &Sheet, signs: Signs, scales: Scales, scene: &mut Scene) {
    for (force, tip) in drawing.forces.iter().zip(tips(drawing, scales)) {
        if let Some((from, to)) = ends(force, tip, sheet) {
            scene.shape(outline(force, signs, scales, [from, to]), Some(color(force.kind)), None);
        }
    }
}

/// Where an arrow begins and ends, pixels, if it can be drawn.
fn ends(force: &Force, tip: [f64; 2], sheet: &Sheet) -> Option<(Point, Point)> {
    (is_usable(&force.at) && is_usable(&tip)).then(|| (sheet.point(force.at), sheet.point(tip)))
}

/// The outline of an arrow from `from` to `to`, or of one that turns about `from`.
fn outline(force: &Force, signs: Signs, scales: Scales, [from, to]: [Point; 2]) -> Vec<Point> {
    let Some(turning) = force.turning else { return arrow(signs, [from, to]) };
    let most = scales.torque[force.kind as usize];
    let part = if most > 0.0 { (turning.abs() / most).min(1.0) } else { 0.0 };
    let across = force.across.map(|[x, y]| [x, -y]);
    turned(signs, from, across, part * LARGEST * signs.size, if turning < 0.0 { -1.0 } else { 1.0 })
}

/// An arrow; one that is shorter than its head is a smaller one.
pub(super) fn arrow(signs: Signs, [from, to]: [Point; 2]) -> Vec<Point> {
    let (along, length) = direction(from, to);
    let size = HEAD * signs.size.max(0.6);
    let part = (length / (2.0 * size)).min(1.0);
    let (base, shaft, wing) = (length - part * size, part * 0.5 * signs.pen(3.4), part * 0.5 * size);
    let at = |s: f64, t: f64| off(from, along, s, t);
    vec![at(0.0, -shaft), at(base, -shaft), at(base, -wing), to, at(base, wing), at(base, shaft), at(0.0, shaft)]
}

/// A torque: an arrow of seven tenths of a turn about its place, by two directions across its axis in pixels, counter-clockwise for a
/// positive one, of a radius in pixels; as wide as other arrows unless it is small. Seen from the side it is a line.
pub(super) fn turned(signs: Signs, at: Point, [u, v]: [Point; 2], radius: f64, sense: f64) -> Vec<Point> {
    const STEPS: u32 = 30;
    let head = HEAD * signs.size.max(0.6);
    let part = (radius / (1.2 * head)).min(1.0);
    let (half, head) = (part * 0.5 * signs.pen(3.0), part * head);
    let point = |angle: f64| {
        let (s, c) = angle.sin_cos();
        [at[0] + radius * (c * u[0] + s * v[0]), at[1] + radius * (c * u[1] + s * v[1])]
    };
    let angle = |k: u32| 0.4 * TAU + sense * 0.7 * TAU * f64::from(k) / f64::from(STEPS);
    let beside = |k: u32, far: f64| {
        let (along, _) = direction(point(angle(k) - 1e-3), point(angle(k) + 1e-3));
        off(point(angle(k)), along, 0.0, far)
    };
    let end = point(angle(STEPS));
    let (along, _) = direction(point(angle(STEPS) - sense * 1e-3), end);
    let head = [off(end, along, 0.0, -0.5 * head), off(end, along, head, 0.0), off(end, along, 0.0, 0.5 * head)];
    let line = |far: f64| (0..=STEPS).map(move |k| beside(k, sense * far));
    line(-half).chain(head).chain(line(half).rev()).collect()
}

/// A value in the unit that is asked for, else in SI, from a thousand on in the larger of two units; below a million without exponent.
fn told(value: f64, asked: Option<&ShownIn>, [unit, larger]: [&str; 2], digits: usize) -> String {
    let (size, unit) = match asked {
        Some(asked) => (asked.size, pretty(&asked.unit)),
        None if value >= 1e3 => (1e3, larger.into()),
        None => (1.0, unit.into()),
    };
    let whole = (1..6).find(|digits| value / size < 10f64.powi(*digits)).map_or(0, |digits| digits as usize);
    let rounded: f64 = significant(value / size, digits).parse().unwrap_or(value / size);
    format!("{} {unit}", significant(rounded, digits.max(whole + 1)))
}

/// Tells the scale of each kind at the foot of a picture, from `left` on.
pub(super) fn legend(drawing: &Drawing, pixels: f64, scales: Scales, scene: &mut Scene, left: f64, letters: f64) {
    let (mut x, y) = (left, scene.height - 26.0);
    let room = scene.width - if drawing.axes.is_some() { AXES } else { 10.0 };
    for (kind, name, _) in KINDS {
        if drawing.forces.iter().all(|force| force.kind != kind || length(force) * pixels < SEEN * scales.force[kind as usize]) {
            continue;
        }
        let scale = scales.force[kind as usize];
        let size = drawing.force.as_ref().map_or(1.0, |unit| unit.size);
        let value = round_above(0.4 * SAMPLE * scale / (pixels * size)) * size;
        let to = x + value * pixels / scale;
        scene.shape(arrow(Signs { size: 0.8 }, [[x, y], [to, y]]), Some(color(kind)), None);
        let text = format!("{name}: {}", told(value, drawing.force.as_ref(), ["N", "kN"], 4));
        scene.text([to + 16.0, y + letters * font::CAPITAL / 2.0], text.clone(), letters, Anchor::Start);
        // these act along coordinates, and no bearing feels them
        if kind == ForceKind::Reaction && !drawing.gears.is_empty() {
            let small = 0.67 * letters;
            let from = f64::min(x, room - font::width(WITHOUT, small));
            scene.text([from, scene.height - 0.4 * small], WITHOUT.to_owned(), small, Anchor::Start);
        }
        x = to + 16.0 + font::width(&text, letters) + 30.0;
    }
    // as long as there is room for them beside the axes of space, else together in a line above, from the left margin on if need be
    let worded = |(kind, _, name): (ForceKind, &str, &str)| {
        let most = told(scales.torque[kind as usize], drawing.torque.as_ref(), ["N m", "kN m"], 3);
        let whose = if scales.of_motion { "at most" } else { "largest here" };
        (kind, [format!("{name}: {whose} {most}"), format!("{name} to {most}")])
    };
    let all: Vec<_> = KINDS.into_iter().filter(|(kind, ..)| scales.torque[*kind as usize] > 0.0).map(worded).collect();
    let width = |form: usize| all.iter().map(|(_, texts)| 2.0 * TURNED + 42.0 + font::width(&texts[form], letters)).sum::<f64>() - 30.0;
    let beside = [0, 1].into_iter().find(|form| x + width(*form) <= room);
    let form = beside.unwrap_or(if width(0) <= room - MARGIN { 0 } else { 1 });
    let level = if beside.is_some() { y } else { y - 2.5 * TURNED };
    let mut from = if beside.is_some() { x } else { (room - width(form)).min(left).max(MARGIN) };
    for (kind, texts) in &all {
        from = turning(scene, *kind, &texts[form], [from, level], letters) + 30.0;
    }
}

/// An arrow that turns with a text behind it, from a place on; where the text ends.
fn turning(scene: &mut Scene, kind: ForceKind, text: &str, [x, y]: Point, letters: f64) -> f64 {
    let level = [[1.0, 0.0], [0.0, -1.0]];
    scene.shape(turned(Signs { size: TURNED / LARGEST }, [x + TURNED, y], level, TURNED, 1.0), Some(color(kind)), None);
    let from = x + 2.0 * TURNED + 12.0;
    scene.text([from, y + letters * font::CAPITAL / 2.0], text.to_owned(), letters, Anchor::Start);
    from + font::width(text, letters)
}

#[cfg(test)]
mod tests {
    use super::super::scene::Item;
    use super::*;

    #[test]
    fn arrows_keep_their_number_of_points_and_end_at_their_tips() {
        let signs = Signs { size: 1.0 };
        for to in [[80.0, 0.0], [1.0, 1.0], [0.0, 0.0]] {
            let points = arrow(signs, [[0.0; 2], to]);
            assert_eq!((points.len(), points[3]), (7, to));
        }
        assert!(arrow(signs, [[5.0; 2]; 2]).iter().all(|p| *p == [5.0; 2]));
        let level = [[1.0, 0.0], [0.0, -1.0]];
        let torque = |radius: f64, sense: f64| turned(signs, [5.0; 2], level, radius, sense);
        assert!([30.0, 3.0, 0.0].iter().all(|radius| torque(*radius, -1.0).len() == torque(36.0, 1.0).len()));
        assert!(torque(0.0, 1.0).iter().all(|p| *p == [5.0; 2]));
    }

    #[test]
    fn torques_turn_about_their_axes_and_are_as_large_as_they_are() {
        // about an axis in the picture's plane: a line across it, with a head
        let seen = |across: [[f64; 2]; 2], turning: f64| {
            let force = Force { turning: Some(turning), across, ..Force::default() };
            outline(&force, Signs { size: 1.0 }, Scales { force: [1.0; 2], torque: [4.0; 2], of_motion: false }, [[0.0; 2]; 2])
        };
        let span = |points: &[Point], i: usize| points.iter().fold(0.0_f64, |most, p| most.max(p[i].abs()));
        let (flat, round) = (seen([[1.0, 0.0], [0.0; 2]], 4.0), seen([[1.0, 0.0], [0.0, 1.0]], 4.0));
        assert!(span(&flat, 1) < 8.0 && span(&flat, 0) > 30.0 && span(&round, 1) > 30.0, "{flat:?}");
        assert!(span(&seen([[1.0, 0.0], [0.0, 1.0]], -2.0), 0) < 0.7 * span(&round, 0));
        // counter-clockwise: from 144 degrees over 270 to 36, where the tip is; y of the sheet goes down
        let area = |points: &[Point]| (0..31).map(|k| points[k][0] * points[k + 1][1] - points[k][1] * points[k + 1][0]).sum::<f64>();
        assert!(area(&round) < 0.0 && area(&seen([[1.0, 0.0], [0.0, 1.0]], -4.0)) > 0.0);
    }

    #[test]
    fn values_are_told_in_the_units_that_are_asked_for() {
        let millimetres = ShownIn { unit: "N mm".into(), size: 1e-3 };
        assert_eq!(told(0.8, Some(&millimetres), ["N m", "kN m"], 3), "800 N mm");
        assert_eq!(told(1234.0, None, ["N m", "kN m"], 3), "1.23 kN m");
        // the arrow that tells a scale has a round value in them
        let pounds = ShownIn { unit: "lbf".into(), size: 4.448_221_615_260_5 };
        let forces = vec![Force { along: [100.0, 0.0], size: 100.0, ..Force::default() }];
        let drawing = Drawing { force: Some(pounds), forces, ..Drawing::default() };
        let mut scene = Scene { width: 600.0, height: 400.0, ..Scene::default() };
        legend(&drawing, 300.0, scales(&drawing, 1.0), &mut scene, 20.0, 18.0);
        let texts: Vec<String> =
            scene.items.iter().filter_map(|item| if let Item::Text(text) = item { Some(text.text.clone()) } else { None }).collect();
        assert_eq!(texts, ["loads: 20 lbf"], "{texts:?}");
    }

    #[test]
    fn reactions_of_geared_joints_are_told_to_lack_pulls_where_there_is_room() {
        let reaction = Force { kind: ForceKind::Reaction, along: [100.0, 0.0], size: 100.0, ..Force::default() };
        let mut drawing = Drawing { forces: vec![reaction], ..Drawing::default() };
        let told = |drawing: &Drawing, left: f64| {
            let mut scene = Scene { width: 600.0, height: 400.0, ..Scene::default() };
            legend(drawing, 300.0, scales(drawing, 1.0), &mut scene, left, 18.0);
            let text = |item| if let Item::Text(text) = item { Some(text) } else { None };
            scene
                .items
                .into_iter()
                .filter_map(text)
                .find(|text| text.text == WITHOUT)
                .map(|text| text.at[0] + font::width(WITHOUT, text.size))
        };
        assert_eq!(told(&drawing, 20.0), None);
        drawing.gears.push(Default::default());
        assert!([20.0, 500.0].iter().all(|left| told(&drawing, *left).is_some_and(|end| end <= 590.0 + 1e-9)));
    }

    #[test]
    fn scales_are_round_and_those_that_are_asked_for() {
        let force = |kind, along: [f64; 2], scale| Force { kind, along, size: along[0].hypot(along[1]), scale, ..Force::default() };
        let forces = vec![force(ForceKind::Load, [0.0, -300.0], None), force(ForceKind::Reaction, [400.0, 300.0], None)];
        let mut drawing = Drawing { forces, ..Drawing::default() };
        // 500 N are at most a quarter of 2 m long, and so are loads beside them
        assert_eq!(scales(&drawing, 2.0).force, [1000.0, 1000.0]);
        (drawing.forces[0].along, drawing.forces[0].size) = ([0.0, -3.0], 3.0);
        assert_eq!(scales(&drawing, 2.0).force, [10.0, 1000.0]);
        drawing.forces[1].scale = Some(50.0);
        assert_eq!(scales(&drawing, 2.0).force, [10.0, 50.0]);
        assert_eq!(tips(&drawing, scales(&drawing, 2.0)).last(), Some([8.0, 6.0]));
        assert_eq!(scales(&Drawing::default(), 1.0), Scales { force: [1.0; 2], torque: [0.0; 2], of_motion: false });
    }
}
