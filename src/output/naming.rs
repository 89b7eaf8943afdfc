//! What is named in a drawing, and where: joints, one label to a place, bodies and links.

use super::marks::RUST;
use super::outlines::hull;
use super::pose::{Drawing, FormKind, LinkKind, SymbolKind};
use super::scene::{Color, INK};
use super::sheet::{Sheet, body_color, corners, near};
use super::symbols::{BAR, shaded};
use super::thin::Point;

/// Names of one place that stand side by side.
const TOGETHER: usize = 3;

/// A name, the place that it belongs to, and how far from there it keeps.
#[derive(Clone, Debug)]
pub(super) struct Name {
    pub(super) text: String,
    pub(super) at: Point,
    pub(super) reach: f64,
    pub(super) color: Color,
}

/// All names of the strong position, `size` being that of the signs. Joints first: their names have the least choice.
pub(super) fn all(drawing: &Drawing, sheet: &Sheet, size: f64) -> Vec<Name> {
    let mut names = joints(drawing, sheet, size);
    for (index, body) in drawing.bodies.iter().enumerate().skip(1) {
        let forms: Vec<FormKind> = body.poses.first().into_iter().flatten().filter_map(|form| sheet.form(form)).collect();
        if let Some((at, reach)) = middle(&forms, size) {
            names.push(Name { text: body.name.clone(), at, reach, color: shaded(body_color(index), 0.5) });
        }
    }
    for link in &drawing.links {
        if let Some([a, b]) = sheet.ends(link) {
            let at = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
            let reach = if link.kind == LinkKind::Torsion { 28.0 } else { 19.0 } * size.max(0.6);
            names.push(Name { text: link.name.clone(), at, reach, color: RUST });
        }
    }
    names
}

fn joints(drawing: &Drawing, sheet: &Sheet, size: f64) -> Vec<Name> {
    let mut places: Vec<(Vec<&str>, Point, f64)> = Vec::new();
    for symbol in drawing.joints.iter().filter(|symbol| !symbol.name.is_empty()) {
        let Some(placement) = symbol.poses.first().and_then(|placement| sheet.placement(placement)) else { continue };
        let reach = if symbol.kind == SymbolKind::Slide { 24.0 } else { 13.0 } * size.max(0.6);
        match places.iter_mut().find(|(_, at, _)| near(*at, placement.at)) {
            Some((names, _, other)) => {
                names.push(&symbol.name);
                *other = other.max(reach);
            }
            None => places.push((vec![&symbol.name], placement.at, reach)),
        }
    }
    let joined = |names: Vec<&str>| {
        let more = if names.len() > TOGETHER { ", ..." } else { "" };
        names[..names.len().min(TOGETHER)].join(", ") + more
    };
    places.into_iter().map(|(names, at, reach)| Name { text: joined(names), at, reach, color: INK }).collect()
}

/// Where the name of a body belongs, and how far from there it must keep: beside a bar, within a plate that is large enough.
fn middle(forms: &[FormKind], size: f64) -> Option<(Point, f64)> {
    let center = |points: &[Point]| {
        let count = points.len() as f64;
        points.iter().fold([0.0; 2], |sum, p| [sum[0] + p[0] / count, sum[1] + p[1] / count])
    };
    let beside = BAR * size / 2.0 + 5.0;
    match forms {
        [] => None,
        [FormKind::Bar { .. }, ..] => Some((center(&corners(&forms[0])), beside)),
        [FormKind::Disc { center, .. }, ..] => Some((*center, 13.0)),
        [FormKind::Mass { center, radius }] => Some((*center, radius.max(5.0 * size) + 4.0)),
        [FormKind::Plate { points }, ..] => {
            let hull = hull(points);
            match hull[..] {
                [] => None,
                [only] => Some((only, BAR * size)),
                [_, _] => Some((center(&hull), beside)),
                _ => Some((center(&hull), 0.0)),
            }
        }
        [FormKind::Area { .. } | FormKind::Mass { .. }, ..] => {
            let points: Vec<Point> = forms.iter().flat_map(corners).collect();
            (!points.is_empty()).then(|| (center(&points), 0.0))
        }
    }
}
