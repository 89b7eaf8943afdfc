//! The drawing of a mechanism: links, joints and paths in the plane, in one or several positions.

use super::font;
use super::lettering::{Lettering, Obstacle};
use super::picture::Picture;
use super::pose::{Drawing, Placement, Symbol, SymbolKind};
use super::raster::RenderError;
use super::scene::{Color, INK, PALETTE, Rect, Scene, Stroke, pale};
use super::symbols::{self, Looks};
use super::thin::{self, Point};

const WIDTH: f64 = 1000.0;
const LETTERS: f64 = 20.0;
/// Part of the sheet that names may cover: beyond it none can be read.
const NAMED: f64 = 0.25;
/// Fills of bodies, muted: the joints and paths are what one looks for.
const BODIES: [Color; 7] =
    [[163, 190, 218], [232, 200, 148], [176, 208, 168], [208, 182, 216], [226, 178, 166], [164, 208, 206], [208, 204, 170]];

/// Of springs and dampers.
const RUST: Color = [150, 60, 20];

/// Draws `drawing` as SVG and PNG, 1000 pixels wide and as high as its shape asks for.
///
/// # Errors
/// None that data could cause.
pub fn render_drawing(drawing: &Drawing) -> Result<Picture, RenderError> {
    Picture::of(&layout(drawing))
}

/// From metres to pixels, both axes by one scale.
#[derive(Clone, Copy, Debug)]
struct View {
    scale: f64,
    origin: Point,
}

impl View {
    fn point(&self, [x, y]: [f64; 2]) -> Point {
        [self.origin[0] + self.scale * x, self.origin[1] - self.scale * y]
    }

    fn points(&self, points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().filter(|p| is_usable(p)).map(|p| self.point(*p)).collect()
    }

    /// The placement in pixels, its direction of length one.
    fn placement(&self, placement: &Placement) -> Option<Placement> {
        let [dx, dy] = placement.along;
        let length = dx.hypot(dy);
        let along = if length > 0.0 && length.is_finite() { [dx / length, -dy / length] } else { [1.0, 0.0] };
        let way = placement.way.filter(|way| way.iter().all(is_usable)).map(|way| way.map(|end| self.point(end)));
        is_usable(&placement.at).then(|| Placement { at: self.point(placement.at), along, way })
    }
}

fn is_usable(point: &[f64; 2]) -> bool {
    point.iter().all(|x| x.abs() < 1e12)
}

/// The smallest box around everything, in metres: left, bottom, right, top.
fn extent(drawing: &Drawing) -> [f64; 4] {
    let bodies = drawing.bodies.iter().flat_map(|body| body.poses.iter().flatten().copied());
    let joints = drawing.joints.iter().flat_map(|joint| joint.poses.iter());
    let joints = joints.flat_map(|pose| std::iter::once(pose.at).chain(pose.way.into_iter().flatten()));
    let links = drawing.links.iter().flat_map(|link| link.poses.iter().flatten().copied());
    let traces = drawing.traces.iter().flat_map(|trace| trace.points.iter().copied());
    let all = bodies.chain(joints).chain(links).chain(traces).filter(is_usable);
    let [left, bottom, right, top] = all.fold([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY], |e, [x, y]| {
        [e[0].min(x), e[1].min(y), e[2].max(x), e[3].max(y)]
    });
    if left > right { [0.0, 0.0, 1.0, 1.0] } else { [left, bottom, right, top] }
}

fn layout(drawing: &Drawing) -> Scene {
    let [left, bottom, right, top] = extent(drawing);
    let size = (right - left).max(top - bottom);
    let size = if size > 1e-12 { size } else { 1.0 };
    let head = if drawing.title.is_empty() { 70.0 } else { 106.0 };
    let (side, foot) = (100.0, 118.0);
    // Neither a flat nor a tall mechanism may grow beyond the sheet.
    let scale =
        ((WIDTH - 2.0 * side) / (right - left).max(1e-3 * size)).min(640.0 / (top - bottom).max(1e-3 * size)).min(640.0 / size * 1.25);
    let height = ((top - bottom) * scale + head + foot).max(320.0).ceil();
    let middle = [(left + right) / 2.0, (top + bottom) / 2.0];
    let center = [WIDTH / 2.0, head + (height - head - foot) / 2.0];
    let view = View { scale, origin: [center[0] - scale * middle[0], center[1] + scale * middle[1]] };

    let mut scene = Scene { width: WIDTH, height, title: drawing.title.clone(), items: Vec::new() };
    let sheet = Rect { left: 8.0, top: if drawing.title.is_empty() { 8.0 } else { 50.0 }, right: WIDTH - 8.0, bottom: height - 58.0 };
    let mut letters = Lettering::new(sheet);
    if !drawing.title.is_empty() {
        scene.headline(&drawing.title);
    }
    let count = poses(drawing);
    for pose in (0..count).rev() {
        let strength = if pose == 0 { 1.0 } else { 0.45 - 0.28 * (pose - 1) as f64 / (count - 1).max(1) as f64 };
        draw_pose(drawing, pose, strength, &view, &mut scene, &mut letters);
    }
    traces(drawing, &view, &mut scene, &mut letters);
    name_all(drawing, &view, &sheet, &mut letters);
    letters.draw(&mut scene);
    symbols::scale_bar(&mut scene, scale, LETTERS);
    scene
}

fn poses(drawing: &Drawing) -> usize {
    let bodies = drawing.bodies.iter().map(|body| body.poses.len());
    let joints = drawing.joints.iter().map(|joint| joint.poses.len());
    bodies.chain(joints).chain(drawing.links.iter().map(|link| link.poses.len())).max().unwrap_or(0)
}

fn trace_color(index: usize) -> Color {
    // Vermilion first: it stands out most from the muted bodies.
    PALETTE[(index + 1) % PALETTE.len()]
}

fn traces(drawing: &Drawing, view: &View, scene: &mut Scene, letters: &mut Lettering) {
    for (index, trace) in drawing.traces.iter().enumerate() {
        for piece in trace.points.split(|point| !is_usable(point)) {
            let pixels = thin::thinned(view.points(piece), false);
            letters.avoid_line(&pixels, Obstacle::Path);
            match pixels[..] {
                [] => {}
                [only] => scene.circle(only, 4.0, Some(trace_color(index)), None),
                _ => scene.line(pixels, Stroke::dashed(trace_color(index), 2.2, &[9.0, 5.0])),
            }
        }
    }
}

/// Ways lie under boxes, boxes under bodies, and pins on top, as in the machine.
fn draw_pose(drawing: &Drawing, pose: usize, strength: f64, view: &View, scene: &mut Scene, letters: &mut Lettering) {
    let strong = pose == 0;
    let looks =
        |color: Color| Looks { fill: pale(color, strength), edge: pale(color.map(|c| (f64::from(c) * 0.5) as u8), strength), strong };
    let ink = Looks { fill: [255; 3], edge: pale(INK, strength), strong };
    let placed = |symbol: &Symbol| symbol.poses.get(pose).and_then(|placement| view.placement(placement));
    let joints: Vec<_> = drawing.joints.iter().filter_map(|symbol| Some((symbol, placed(symbol)?))).collect();

    for (symbol, placement) in &joints {
        if strong && symbol.grounded && !matches!(symbol.kind, SymbolKind::Slide | SymbolKind::Slot) {
            symbols::ground(scene, placement.at);
            letters.avoid(placement.at, [28.0, 22.0], [0.0, 22.0]);
        }
        if symbol.kind == SymbolKind::Slide {
            let seen: Vec<_> = symbol.poses.iter().filter_map(|other| view.placement(other)).map(|other| other.at).collect();
            let way = placement.way.unwrap_or_else(|| symbols::way(placement, if symbol.grounded { &seen } else { &[] }, 60.0));
            if strong {
                symbols::slideway(scene, placement, way, symbol.grounded);
                letters.avoid(placement.at, [26.0, 20.0], [0.0; 2]);
                let below = if symbol.grounded { symbols::lower_side(way, 24.0) } else { way };
                letters.avoid_line(&below, Obstacle::Body);
            }
            symbols::slider(scene, placement, &ink);
        }
    }
    for (index, body) in drawing.bodies.iter().enumerate() {
        let points = view.points(body.poses.get(pose).map_or(&[], Vec::as_slice));
        // A body of one point is shown by the joint there, if there is one.
        let single = points.len() == 1 && joints.iter().any(|(_, placement)| near(placement.at, points[0]));
        if !single {
            let outline = symbols::body(scene, &points, &looks(BODIES[index % BODIES.len()]));
            letters.avoid_line(&outline, if strong { Obstacle::Body } else { Obstacle::Shade });
        }
    }
    for (symbol, placement) in joints.iter().filter(|(symbol, _)| symbol.kind == SymbolKind::Slot) {
        let way = placement.way.unwrap_or_else(|| symbols::way(placement, &[], 34.0));
        symbols::slot(scene, way, &ink);
        if strong {
            if symbol.grounded {
                symbols::hatched_below(scene, way, 12.0);
            }
            letters.avoid_line(&way, Obstacle::Body);
        }
    }
    // Springs of all positions over each other would be a thicket.
    for link in drawing.links.iter().filter(|_| strong) {
        if let Some(&[a, b]) = link.poses.first().filter(|ends| ends.iter().all(is_usable)) {
            let ends = [view.point(a), view.point(b)];
            symbols::link(scene, link.kind, ends, RUST);
            letters.avoid_line(&ends, Obstacle::Body);
        }
    }
    for (symbol, placement) in &joints {
        symbols::pin(scene, symbol.kind, placement, &ink);
        if strong {
            letters.avoid(placement.at, [9.0, 9.0], [0.0; 2]);
        }
    }
}

fn near(a: Point, b: Point) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) < 1.0
}

/// The names of the strong position, unless they would cover more of the sheet than can be read, and those of paths.
fn name_all(drawing: &Drawing, view: &View, sheet: &Rect, letters: &mut Lettering) {
    let names = names(drawing, view);
    let area: f64 = names.iter().map(|(name, ..)| font::width(name, LETTERS) * LETTERS).sum();
    if area <= NAMED * sheet.width() * sheet.height() {
        names.into_iter().for_each(|(name, at, reach, color)| letters.name(name, at, reach, LETTERS, color));
    }
    for (index, trace) in drawing.traces.iter().enumerate() {
        let pixels = view.points(&trace.points);
        if let Some(highest) = pixels.iter().min_by(|a, b| a[1].total_cmp(&b[1])) {
            letters.name(&trace.name, *highest, 6.0, LETTERS, trace_color(index));
        }
    }
}

/// Names with their places, the distance that they keep from these, and their colours. Joints first: their names have the least choice.
fn names<'d>(drawing: &'d Drawing, view: &View) -> Vec<(&'d str, Point, f64, Color)> {
    let mut names = Vec::new();
    for symbol in &drawing.joints {
        if let Some(placement) = symbol.poses.first().and_then(|placement| view.placement(placement)) {
            names.push((symbol.name.as_str(), placement.at, if symbol.kind == SymbolKind::Slide { 24.0 } else { 13.0 }, INK));
        }
    }
    for (index, body) in drawing.bodies.iter().enumerate() {
        let points = view.points(body.poses.first().map_or(&[], Vec::as_slice));
        if let Some((at, reach)) = symbols::middle(&points) {
            let color = BODIES[index % BODIES.len()].map(|c| (f64::from(c) * 0.5) as u8);
            names.push((body.name.as_str(), at, reach, color));
        }
    }
    for link in &drawing.links {
        let ends = link.poses.first().map(|ends| ends.map(|end| view.point(end)));
        if let Some([a, b]) = ends.filter(|ends| ends.iter().flatten().all(|x| x.is_finite())) {
            names.push((link.name.as_str(), [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0], 19.0, RUST));
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::super::pose::{Outline, Trace};
    use super::*;

    #[test]
    fn odd_mechanisms_make_a_picture_all_the_same() {
        let nan = f64::NAN;
        let symbol = |at| Symbol { kind: SymbolKind::Slide, poses: vec![Placement { at, ..Placement::default() }], ..Symbol::default() };
        for at in [[0.0, 0.0], [nan, 1.0], [1e300, 0.0]] {
            let body = Outline { name: "b".into(), poses: vec![vec![at], vec![], vec![at, at, at]] };
            let trace = Trace { name: "p".into(), points: vec![at, [0.5, 0.5], [nan, nan]] };
            let drawing = Drawing { bodies: vec![body], joints: vec![symbol(at)], traces: vec![trace], ..Drawing::default() };
            let svg = super::super::svg::write_svg(&layout(&drawing));
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
        assert!(layout(&Drawing::default()).height > 0.0);
    }

    #[test]
    fn more_names_than_can_be_read_are_left_out() {
        let names = |count: u32| {
            let body = |k| Outline { name: format!("rod {k}"), poses: vec![vec![[f64::from(k), 0.0], [f64::from(k), 1.0]]] };
            let drawing = Drawing { bodies: (0..count).map(body).collect(), ..Drawing::default() };
            let is_name =
                |item: &&super::super::scene::Item| matches!(item, super::super::scene::Item::Text(text) if text.text.starts_with("rod"));
            layout(&drawing).items.iter().filter(is_name).count()
        };
        assert_eq!((names(5), names(5000)), (5, 0));
    }

    #[test]
    fn both_axes_have_one_scale() {
        let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let drawing = Drawing { bodies: vec![Outline { name: String::new(), poses: vec![square] }], ..Drawing::default() };
        let scene = layout(&drawing);
        let super::super::scene::Item::Path { points, .. } = &scene.items[0] else { panic!("a body first") };
        let (width, height) = (points[1][0] - points[0][0], points[2][1] - points[1][1]);
        assert!((width.abs() - height.abs()).abs() < 1e-9, "{points:?}");
    }
}
