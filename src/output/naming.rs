//! What is named in a drawing, and where: joints, one label to a place, bodies and links.

use super::lettering::{Name, Named};
use super::marks::{DRIVE, RUST};
use super::measure::encloses;
use super::outlines::hull;
use super::pose::{Drawing, FormKind, LinkKind, Outline, SymbolKind};
use super::scene::INK;
use super::sheet::{Sheet, body_color, corners, near};
use super::symbols::{BAR, circle, off, shaded};
use super::thin::Point;

/// Directions from the middle of a ring to where its name may stand.
const RIM: [Point; 4] = [[0.6, -0.8], [0.6, 0.8], [-0.6, -0.8], [-0.6, 0.8]];
/// Parts of the way from the middle of an area to its edges where its name may stand, and edges that are looked at, at most.
const TO_EDGE: [f64; 2] = [0.5, 0.8];
const EDGES: usize = 6;
/// Names of one place that stand side by side, if there are more than one more.
const TOGETHER: usize = 3;
/// Between them.
pub(super) const COMMA: &str = ", ";

/// All names of the strong position, `size` being that of the signs. Joints first: their names have the least choice.
pub(super) fn all(drawing: &Drawing, sheet: &Sheet, size: f64) -> Vec<Name> {
    let mut names = joints(drawing, sheet, size);
    let bodies: Vec<Vec<(f64, FormKind)>> = drawing.bodies.iter().map(|body| forms(body, sheet)).collect();
    for (index, body) in drawing.bodies.iter().enumerate().skip(1) {
        let forms: Vec<FormKind> = bodies[index].iter().map(|(_, form)| form.clone()).collect();
        let Some((at, reach)) = middle(&forms, size) else { continue };
        let depth = bodies[index].iter().map(|(depth, _)| *depth).fold(f64::NEG_INFINITY, f64::max);
        // of what is equally near the later body is drawn above
        let over = |other: usize, d: f64| d > depth || (d == depth && other > index);
        let above = |other: usize| bodies[other].iter().filter(move |(d, form)| over(other, *d) && hides(form)).map(|(_, form)| line(form));
        let above: Vec<Vec<Point>> = (1..bodies.len()).filter(|other| *other != index).flat_map(above).collect();
        let seen = |at: &Point| !above.iter().any(|line| encloses(line, *at));
        let mut places: Vec<Point> = std::iter::once(at).chain(beside(&forms)).collect();
        // a bar is named where it is seen, and not at all where it is hidden; of a wider part the edge may be seen
        let wide = forms.iter().any(|form| line(form).len() > 2);
        if places.len() > 1 && (!wide || places.iter().any(seen)) {
            places.retain(seen);
        }
        if places.is_empty() {
            continue;
        }
        let at = places.remove(0);
        let of = Named::Part(forms.iter().map(line).collect());
        names.push(Name { text: body.name.clone(), at, also: places, above, reach, color: shaded(body_color(index), 0.5), of });
    }
    for link in &drawing.links {
        if let Some(ends) = sheet.ends(link) {
            let reach = if link.kind.turns() { 28.0 } else { 19.0 } * size.max(0.6);
            let (also, of) = (along(ends).to_vec(), Named::Part(vec![ends.to_vec()]));
            let color = if link.kind == LinkKind::Actuator { DRIVE } else { RUST };
            names.push(Name { text: link.name.clone(), at: between(ends, 0.5), also, above: Vec::new(), reach, color, of });
        }
    }
    names
}

/// The shapes of a body in the strong position, in pixels, with their depths.
fn forms(body: &Outline, sheet: &Sheet) -> Vec<(f64, FormKind)> {
    body.poses.first().into_iter().flatten().filter_map(|form| Some((form.depth, sheet.form(form)?))).collect()
}

/// The middle line of a bar, or the edge of an area, which returns to its first point.
pub(super) fn line(form: &FormKind) -> Vec<Point> {
    let outline = match form {
        FormKind::Plate { points } => hull(points),
        FormKind::Disc { center, radius, .. } | FormKind::Gear { center, radius, .. } | FormKind::Mass { center, radius } => {
            circle(*center, *radius)
        }
        FormKind::Bar { .. } | FormKind::Area { .. } | FormKind::Wheel { .. } => corners(form),
    };
    let closed = outline.first().copied().filter(|_| outline.len() > 2);
    outline.into_iter().chain(closed).collect()
}

/// Whether what is behind a shape is not seen.
fn hides(form: &FormKind) -> bool {
    !matches!(form, FormKind::Wheel { .. } | FormKind::Gear { rim: Some(_), .. })
}

/// Places along a bar that are as good for its name as its middle, towards the edges of an area, or on the rim of a ring.
fn beside(forms: &[FormKind]) -> Vec<Point> {
    match forms {
        [form @ (FormKind::Bar { .. } | FormKind::Plate { .. } | FormKind::Area { .. }), ..] => match &line(form)[..] {
            [a, b] => along([*a, *b]).to_vec(),
            edge if forms.len() == 1 => within(edge),
            _ => Vec::new(),
        },
        [FormKind::Gear { center, rim: Some(rim), .. }, ..] => RIM[1..].iter().map(|way| off(*center, *way, *rim, 0.0)).collect(),
        _ => Vec::new(),
    }
}

/// Places between the middle of an area and its edges; `edge` returns to its first point.
fn within(edge: &[Point]) -> Vec<Point> {
    let corners = &edge[..edge.len().saturating_sub(1)];
    let center = corners.iter().fold([0.0; 2], |sum, p| [sum[0] + p[0] / corners.len() as f64, sum[1] + p[1] / corners.len() as f64]);
    let middles = edge.windows(2).step_by(corners.len().div_ceil(EDGES).max(1)).map(|ends| between([ends[0], ends[1]], 0.5));
    let middles: Vec<Point> = middles.collect();
    TO_EDGE.iter().flat_map(|s| middles.iter().map(move |middle| between([center, *middle], *s))).collect()
}

fn along(ends: [Point; 2]) -> [Point; 6] {
    [0.35, 0.65, 0.2, 0.8, 0.1, 0.9].map(|s| between(ends, s))
}

fn between([a, b]: [Point; 2], s: f64) -> Point {
    [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])]
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
        if names.len() <= TOGETHER + 1 { names.join(COMMA) } else { names[..TOGETHER].join(COMMA) + COMMA + "..." }
    };
    places
        .into_iter()
        .map(|(names, at, reach)| Name { text: joined(names), at, also: Vec::new(), above: Vec::new(), reach, color: INK, of: Named::Pin })
        .collect()
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
        [FormKind::Gear { center, rim: Some(rim), .. }, ..] => Some((off(*center, RIM[0], *rim, 0.0), 4.0)),
        [FormKind::Disc { center, .. } | FormKind::Gear { center, .. }, ..] => Some((*center, 13.0)),
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
        [FormKind::Area { .. } | FormKind::Wheel { .. } | FormKind::Mass { .. }, ..] => {
            let points: Vec<Point> = forms.iter().flat_map(corners).collect();
            (!points.is_empty()).then(|| (center(&points), 0.0))
        }
    }
}
