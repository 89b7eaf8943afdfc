//! The drawing of the first position as DXF of release 12 (ASCII), which CAD programs read: true size in mm, a layer to each kind.

mod entities;

use super::drawing::{names, plan};
use super::outlines::hull;
use super::pose::{Drawing, FormKind, Symbol, SymbolKind};
use super::scene::{Item, Scene as Sheet};
use super::sheet::is_usable;
use super::symbols::{BAR, Looks, longer};
use super::thin::{self, Point};
use entities::{Entities, Layer};

/// How signs look here: only their lines are used.
const LINES: Looks = Looks { fill: [255; 3], edge: [0; 3], strong: true, strength: 1.0 };
/// Height of a capital letter, which CAD programs ask for, as part of the font size.
const CAPITAL: f64 = 0.7;
/// What clears the way of a leader line on a sheet.
const PAPER: [u8; 3] = [255; 3];

/// The text of a DXF file of the first position of a drawing.
#[must_use]
pub fn write_dxf(drawing: &Drawing) -> String {
    let plan = plan(drawing);
    let (sheet, signs) = (plan.sheet, plan.signs);
    // from pixels downwards to mm upwards
    let mm = 1e3 / sheet.scale;
    let back = |[x, y]: Point| [(x - sheet.origin[0]) * mm, (sheet.origin[1] - y) * mm];
    let mut out = Entities::default();
    for body in &drawing.bodies {
        for form in body.poses.first().into_iter().flatten().filter_map(|form| sheet.form(form)) {
            match form {
                FormKind::Bar { from, to, width } => rounded(&mut out, Layer::Bodies, &[back(from), back(to)], signs.bar(width) * mm),
                FormKind::Plate { points } => {
                    let points: Vec<Point> = points.into_iter().map(back).collect();
                    rounded(&mut out, Layer::Bodies, &points, BAR * signs.size * mm);
                }
                FormKind::Gear { center, outline, spoke, rim, .. } => {
                    out.path(Layer::Bodies, &outline.into_iter().map(back).collect::<Vec<_>>(), true);
                    rim.into_iter().for_each(|rim| out.circle(Layer::Bodies, back(center), rim * mm));
                    spoke.into_iter().for_each(|spoke| out.path(Layer::Bodies, &[center, spoke].map(back), false));
                }
                other => signed(&mut out, Layer::Bodies, &back, mm, |scene| _ = signs.form(scene, &other, &LINES)),
            }
        }
    }
    for symbol in &drawing.joints {
        let Some(placement) = symbol.poses.first().and_then(|placement| sheet.placement(placement)) else { continue };
        let way = placement.way.unwrap_or([placement.at; 2]);
        if symbol.kind == SymbolKind::Slot {
            rounded(&mut out, Layer::Joints, &longer(way, &placement, 11.0 * signs.size).map(back), 13.0 * signs.size * mm);
        }
        let guide = longer(way, &placement, signs.slide_box()[0] + 14.0 * signs.size);
        if symbol.kind == SymbolKind::Slide && !symbol.way_grounded && !symbol.telescopes {
            rounded(&mut out, Layer::Joints, &guide.map(back), signs.guide_width() * mm);
        }
        let ground = |scene: &mut Sheet| {
            if symbol.kind == SymbolKind::Slide && symbol.way_grounded {
                signs.slideway(scene, guide, None, &placement);
            } else if symbol.kind != SymbolKind::Slide && stands(symbol) {
                signs.ground(scene, placement.at, symbol.above);
            }
        };
        signed(&mut out, Layer::Ground, &back, mm, ground);
        let pin = |scene: &mut Sheet| {
            if symbol.kind == SymbolKind::Slide {
                signs.slider(scene, &placement, &LINES);
            } else if symbol.kind == SymbolKind::Plane {
                signs.plane(scene, &placement, LINES.fill, &LINES);
            }
            signs.pin(scene, symbol.kind, &placement, &LINES);
            if symbol.turns {
                signs.thread(scene, &placement, &LINES);
            }
            if symbol.rings {
                signs.ring(scene, &placement, &LINES);
            }
        };
        signed(&mut out, Layer::Joints, &back, mm, pin);
    }
    for link in &drawing.links {
        let Some(ends) = sheet.ends(link) else { continue };
        signed(&mut out, Layer::Links, &back, mm, |scene| signs.link(scene, link, ends));
    }
    for gear in drawing.gears.iter().map(|gear| sheet.gear(gear)) {
        gear.circles
            .iter()
            .chain(&gear.rims)
            .for_each(|circle| out.path(Layer::Gears, &circle.iter().copied().map(back).collect::<Vec<_>>(), false));
        gear.line.iter().chain(&gear.rope).for_each(|line| out.path(Layer::Gears, &line.map(back), false));
        out.path(Layer::Gears, &gear.belt.iter().copied().map(back).collect::<Vec<_>>(), true);
    }
    for trace in &drawing.traces {
        for piece in trace.points.split(|point| !is_usable(point)) {
            let points = thin::thinned(sheet.points(piece), false);
            out.path(Layer::Paths, &points.into_iter().map(back).collect::<Vec<_>>(), false);
        }
    }
    for item in names(drawing, &plan) {
        match item {
            Item::Text(text) => out.text(Layer::Names, back(text.at), CAPITAL * text.size * mm, &text.text),
            Item::Path { points, stroke, .. } if stroke.is_none_or(|stroke| stroke.color != PAPER) => {
                out.path(Layer::Names, &points.into_iter().map(back).collect::<Vec<_>>(), false);
            }
            Item::Circle { at, radius, .. } => out.circle(Layer::Names, back(at), radius * mm),
            Item::Path { .. } | Item::Veil { .. } => {}
        }
    }
    out.file()
}

/// Whether a joint stands on a bearing of its own.
fn stands(symbol: &Symbol) -> bool {
    symbol.grounded && !matches!(symbol.kind, SymbolKind::Slot | SymbolKind::Plane)
}

/// Adds the lines of signs.
fn signed(out: &mut Entities, layer: Layer, back: &dyn Fn(Point) -> Point, mm: f64, draw: impl FnOnce(&mut Sheet)) {
    let mut scene = Sheet::default();
    draw(&mut scene);
    for item in scene.items {
        match item {
            Item::Path { points, closed, .. } => out.path(layer, &points.into_iter().map(back).collect::<Vec<_>>(), closed),
            Item::Circle { at, radius, .. } => out.circle(layer, back(at), radius * mm),
            Item::Veil { .. } | Item::Text(_) => {}
        }
    }
}

/// Adds the outline of a rounded bar or plate: lines, and arcs at its corners.
fn rounded(out: &mut Entities, layer: Layer, points: &[Point], width: f64) {
    let (corners, radius) = (hull(points), 0.5 * width);
    let n = corners.len();
    if n < 2 {
        corners.iter().for_each(|at| out.circle(layer, *at, radius));
        return;
    }
    let outwards = |k: usize| {
        let (a, b) = (corners[k % n], corners[(k + 1) % n]);
        (b[1] - a[1]).atan2(b[0] - a[0]) - 0.5 * std::f64::consts::PI
    };
    for k in 0..n {
        let off = |p: Point| [p[0] + radius * outwards(k).cos(), p[1] + radius * outwards(k).sin()];
        out.path(layer, &[off(corners[k]), off(corners[(k + 1) % n])], false);
        out.arc(layer, corners[k], radius, [outwards(k + n - 1), outwards(k)].map(f64::to_degrees));
    }
}

#[cfg(test)]
mod tests {
    use super::super::pose::{Form, Outline, Placement, Width};
    use super::*;

    #[test]
    fn a_ring_is_its_teeth_and_a_circle() {
        let outline = vec![[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        let kind = FormKind::Gear { center: [0.0; 2], radius: 1.0, teeth: 300, outline, spoke: None, rim: Some(1.25) };
        let ring = Outline { name: String::new(), poses: vec![vec![Form::flat(kind, 0.0)]] };
        let text = write_dxf(&Drawing { bodies: vec![Outline::default(), ring], ..Drawing::default() });
        let count = |entity: &str| text.lines().filter(|line| line.trim() == entity).count();
        assert_eq!((count("POLYLINE"), count("VERTEX"), count("CIRCLE")), (1, 4, 1), "{text}");
        assert!(text.lines().any(|line| line.trim().parse() == Ok(1250.0)), "{text}");
    }

    #[test]
    fn a_bar_is_drawn_in_its_true_length() {
        let bar = Form::flat(FormKind::Bar { from: [0.0, 0.0], to: [0.25, 0.0], width: Width::Given(0.02) }, 0.0);
        let body = Outline { name: "arm".into(), poses: vec![vec![bar]] };
        let hinge =
            Symbol { name: "A\u{3b8}".into(), poses: vec![Placement { at: [0.25, 0.0], ..Placement::default() }], ..Symbol::default() };
        let drawing = Drawing { bodies: vec![Outline::default(), body], joints: vec![hinge], ..Drawing::default() };
        let text = write_dxf(&drawing);
        let pairs: Vec<(&str, &str)> =
            text.lines().zip(text.lines().skip(1)).step_by(2).map(|(code, value)| (code.trim(), value)).collect();
        let count = |kind: &str| pairs.iter().filter(|pair| **pair == ("0", kind)).count();
        assert_eq!((count("LINE"), count("ARC"), count("CIRCLE"), count("TEXT")), (2, 2, 1, 2));
        let lines = pairs.windows(6).filter(|w| w[0] == ("0", "LINE"));
        let number = |pair: &(&str, &str)| pair.1.parse::<f64>().unwrap();
        for w in lines {
            assert!((number(&w[2]) - number(&w[4])).abs() - 250.0 < 1e-6 && (number(&w[3]).abs() - 10.0).abs() < 1e-6, "{w:?}");
        }
        assert!(text.contains("A\\U+03B8") && text.ends_with("EOF\n") && text.is_ascii());
    }

    #[test]
    fn planes_and_rings_have_their_lines() {
        let placement = Placement { along: [0.0, 1.0], across: [[1.0, 0.0], [0.0, 0.4]], ..Placement::default() };
        let of = |kind, rings| {
            let joint = Symbol { kind, rings, poses: vec![placement], ..Symbol::default() };
            let text = write_dxf(&Drawing { joints: vec![joint], ..Drawing::default() });
            text.lines().filter(|line| line.trim() == "POLYLINE").count()
        };
        assert_eq!(of(SymbolKind::Plane, false), 1);
        assert_eq!(of(SymbolKind::Slide, true), of(SymbolKind::Slide, false) + 1);
    }
}
