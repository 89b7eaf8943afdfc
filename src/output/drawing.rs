//! The drawing of a mechanism: links, joints and paths in the plane, in one or several positions.

use super::lettering::{Label, Lettering, Name, Named, Obstacle};
use super::marks;
use super::measure::encloses;
use super::naming;
use super::painting::{Painted, painted};
use super::picture::Picture;
use super::pose::{Drawing, Form, FormKind, LinkKind, Placement, Symbol, SymbolKind, Width};
use super::raster::RenderError;
use super::scene::{Color, GREY, INK, Item, PALETTE, Rect, Scene, Stroke, pale};
use super::sheet::{Sheet, body_color, extent, is_usable, near, size_of_signs};
use super::symbols::{self, Looks, Signs};
use super::thin::Point;
use super::{font, forces, moves, retraced, thin};

const WIDTH: f64 = 1000.0;
const LETTERS: f64 = 20.0;
/// Positions up to which springs and dampers are drawn in all of them.
const FEW: usize = 3;
/// Part of the sheet that names may cover: beyond it none can be read.
const NAMED: f64 = 0.25;
/// Of massless rods.
const ROD: Color = [200, 200, 196];
/// Distance from the eye by which wheels must differ to be one behind the other, pixels.
const SAME_DEPTH: f64 = 1e-6;

/// Draws `drawing` as SVG and PNG, 1000 pixels wide and as high as its shape asks for.
///
/// # Errors
/// None that data could cause.
pub fn render_drawing(drawing: &Drawing) -> Result<Picture, RenderError> {
    Picture::of(&layout(drawing))
}

/// Where the names of a drawing stand in its picture.
#[must_use]
pub fn labels(drawing: &Drawing) -> Vec<Label> {
    lettered(drawing, &plan(drawing)).letters.labels()
}

/// How a drawing lies on its sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    pub(super) sheet: Sheet,
    pub(super) signs: Signs,
    pub(super) height: f64,
    /// How large arrows of loads and reactions are.
    pub(super) forces: forces::Scales,
}

/// The plan by which all of a drawing is seen.
pub(super) fn plan(drawing: &Drawing) -> Plan {
    let bare = extent(drawing);
    let size_of = |[left, bottom, right, top]: [f64; 4]| {
        let size = (right - left).max(top - bottom);
        if size > 1e-12 { size } else { 1.0 }
    };
    let forces = forces::scales(drawing, size_of(bare));
    let tips = forces::tips(drawing, forces).filter(is_usable);
    let [left, bottom, right, top] = tips.fold(bare, |e, [x, y]| [e[0].min(x), e[1].min(y), e[2].max(x), e[3].max(y)]);
    let size = size_of([left, bottom, right, top]);
    let head = if drawing.title.is_empty() { 70.0 } else { 106.0 };
    let (side, foot) = (100.0, 118.0);
    // Neither a flat nor a tall mechanism may grow beyond the sheet.
    let scale =
        ((WIDTH - 2.0 * side) / (right - left).max(1e-3 * size)).min(640.0 / (top - bottom).max(1e-3 * size)).min(640.0 / size * 1.25);
    let height = ((top - bottom) * scale + head + foot).max(320.0).ceil();
    let middle = [(left + right) / 2.0, (top + bottom) / 2.0];
    let center = [WIDTH / 2.0, head + (height - head - foot) / 2.0];
    let sheet = Sheet { scale, origin: [center[0] - scale * middle[0], center[1] + scale * middle[1]] };
    Plan { sheet, signs: Signs { size: size_of_signs(drawing, scale) }, height, forces }
}

/// The empty sheet of a plan with its title.
pub(super) fn frame(drawing: &Drawing, plan: &Plan) -> Scene {
    let mut scene = Scene { width: WIDTH, height: plan.height, title: drawing.title.clone(), items: Vec::new() };
    if !drawing.title.is_empty() {
        scene.headline(&drawing.title);
    }
    scene
}

/// The scale and the axes.
pub(super) fn margin(drawing: &Drawing, plan: &Plan, scene: &mut Scene) {
    let end = marks::scale_bar(scene, plan.sheet.scale, drawing.length.as_ref(), LETTERS);
    forces::legend(drawing, plan.sheet.scale, plan.forces, scene, end + 40.0, LETTERS);
    if let Some(axes) = drawing.axes {
        marks::triad(scene, axes.map(|[x, y]| [x, -y]), LETTERS);
    }
}

/// The first position of a drawing by a plan with its forces, without names and paths.
pub(super) fn position(drawing: &Drawing, plan: &Plan) -> Vec<Item> {
    let letters = Lettering::new(Rect { left: 0.0, top: 0.0, right: WIDTH, bottom: plan.height }, LETTERS);
    let scene = Scene { width: WIDTH, height: plan.height, ..Scene::default() };
    let mut pen = Pen { drawing, sheet: plan.sheet, signs: plan.signs, letters, scene };
    pen.pose(0, 1.0);
    forces::draw_all(drawing, &plan.sheet, plan.signs, plan.forces, &mut pen.scene);
    pen.scene.items
}

/// The names of a drawing where they stand, with their leader lines.
pub(super) fn names(drawing: &Drawing, plan: &Plan) -> Vec<Item> {
    let Pen { letters, .. } = lettered(drawing, plan);
    let mut scene = Scene::default();
    letters.draw(&mut scene);
    scene.items
}

fn layout(drawing: &Drawing) -> Scene {
    let plan = plan(drawing);
    let Pen { letters, mut scene, .. } = lettered(drawing, &plan);
    letters.draw(&mut scene);
    margin(drawing, &plan, &mut scene);
    scene
}

/// The sheet with all positions, and the names that belong on it.
fn lettered<'a>(drawing: &'a Drawing, plan: &Plan) -> Pen<'a> {
    let scene = frame(drawing, plan);
    let paper = Rect { left: 8.0, top: if drawing.title.is_empty() { 8.0 } else { 50.0 }, right: WIDTH - 8.0, bottom: plan.height - 58.0 };
    let mut pen = Pen { drawing, sheet: plan.sheet, signs: plan.signs, letters: Lettering::new(paper, LETTERS), scene };
    let count = poses(drawing);
    for pose in (0..count).rev() {
        let strength = if pose == 0 { 1.0 } else { 0.45 - 0.28 * (pose - 1) as f64 / (count - 1).max(1) as f64 };
        pen.pose(pose, strength);
    }
    pen.traces();
    forces::draw(drawing, &plan.sheet, plan.signs, plan.forces, &mut pen.scene, &mut pen.letters);
    moves::draw(drawing, &plan.sheet, plan.signs, &mut pen.scene, &mut pen.letters);
    let names = naming::all(drawing, &pen.sheet, pen.signs.size);
    pen.names(names, paper);
    pen
}

fn poses(drawing: &Drawing) -> usize {
    let bodies = drawing.bodies.iter().map(|body| body.poses.len());
    let joints = drawing.joints.iter().map(|joint| joint.poses.len());
    bodies.chain(joints).chain(drawing.links.iter().map(|link| link.poses.len())).max().unwrap_or(0)
}

/// Colour and dashes of a path; no two of 30 are alike, those that are near each other differ in both, and none has a colour of arrows.
pub(super) fn path_stroke(index: usize) -> (Color, &'static [f64]) {
    const COLORS: [usize; 5] = [3, 2, 4, 5, 6];
    const DASHES: [&[f64]; 6] =
        [&[9.0, 5.0], &[18.0, 6.0], &[3.0, 6.0], &[16.0, 5.0, 3.0, 5.0], &[26.0, 8.0], &[12.0, 4.0, 3.0, 4.0, 3.0, 4.0]];
    (PALETTE[COLORS[index % COLORS.len()]], DASHES[index % DASHES.len()])
}

/// The sheet while it is drawn on.
struct Pen<'a> {
    drawing: &'a Drawing,
    sheet: Sheet,
    signs: Signs,
    letters: Lettering,
    scene: Scene,
}

impl Pen<'_> {
    fn looks(color: Color, strength: f64) -> Looks {
        let edge = pale(symbols::shaded(color, 0.5), strength);
        Looks { fill: pale(color, strength), edge, strong: strength == 1.0, strength }
    }

    /// Ways lie under boxes, boxes under bodies, and pins on top, as in the machine.
    fn pose(&mut self, pose: usize, strength: f64) {
        let strong = pose == 0;
        let ink = Looks { fill: [255; 3], edge: pale(INK, strength), strong, strength };
        let placed = |symbol: &Symbol| symbol.poses.get(pose).and_then(|placement| self.sheet.placement(placement));
        let joints: Vec<_> = self.drawing.joints.iter().filter_map(|symbol| Some((symbol, placed(symbol)?))).collect();
        for (symbol, placement) in &joints {
            if !strong || !self.guides_in_front(symbol) {
                self.below(symbol, placement, &ink);
            }
        }
        self.forms(pose, strength, &joints);
        if !strong {
            self.lines(pose, strength);
        }
        for (symbol, placement) in joints.iter().filter(|(symbol, _)| symbol.kind == SymbolKind::Slot) {
            let more = 11.0 * self.signs.size;
            let way = symbols::longer(placement.way.unwrap_or([placement.at; 2]), placement, more);
            let own = if symbol.way_grounded { ink } else { Self::looks(body_color(symbol.way_body), strength) };
            if symbol.framed && !symbol.way_grounded {
                self.signs.slot_frame(&mut self.scene, way, &own);
            }
            self.signs.slot(&mut self.scene, way, &Looks { fill: ink.fill, ..own });
            if strong {
                if symbol.way_grounded {
                    self.signs.hatched_below(&mut self.scene, way, 12.0, false);
                }
                self.letters.avoid_line(&way, Obstacle::Body);
            }
        }
        if strong {
            self.links();
            let gears: Vec<_> = self.drawing.gears.iter().map(|gear| self.sheet.gear(gear)).collect();
            gears.iter().for_each(|gear| self.signs.gear(&mut self.scene, gear));
        }
        for (symbol, placement) in &joints {
            self.signs.pin(&mut self.scene, symbol.kind, placement, &ink);
            if symbol.turns && ink.strong {
                self.signs.thread(&mut self.scene, placement, &ink);
            }
            if symbol.rings && ink.strong {
                self.signs.ring(&mut self.scene, placement, &ink);
            }
            if symbol.hidden && ink.strong {
                self.signs.hidden(&mut self.scene, placement, &ink);
            }
            self.letters.pin(placement.at, strong);
            if strong {
                let half = 1.2 * self.signs.pin_radius(true);
                self.letters.avoid(placement.at, [half; 2], [0.0; 2]);
            }
        }
        // over the pins of other joints
        if strong {
            joints.iter().for_each(|(symbol, placement)| self.beside(symbol, placement));
        }
    }

    /// What lies under the bodies at a joint: bearings, ways, boxes.
    fn below(&mut self, symbol: &Symbol, placement: &Placement, ink: &Looks) {
        let size = self.signs.size;
        if symbol.kind == SymbolKind::Slide {
            let more = self.signs.slide_box()[0] + 14.0 * size;
            let mut way = symbols::longer(placement.way.unwrap_or([placement.at; 2]), placement, more);
            if let Some((ends, round)) = placement.carrier.filter(|_| !symbol.way_grounded) {
                // the guide ends round, as bars do
                let inset = 0.5 * self.signs.guide_width() - if round { 0.5 * symbols::BAR * size } else { 0.0 };
                way = symbols::within(way, ends, inset);
            }
            if ink.strong {
                let body = Self::looks(body_color(symbol.way_body), 1.0);
                if !symbol.telescopes {
                    self.signs.slideway(&mut self.scene, way, (!symbol.way_grounded).then_some(&body), placement);
                }
                let [half, height] = self.signs.slide_box();
                self.letters.avoid(placement.at, [half + 2.0, height + 4.0], [0.0; 2]);
                let side = if placement.upper { -1.0 } else { 1.0 };
                let below = if symbol.way_grounded {
                    symbols::lower_side(way, side * (24.0 * size).max(placement.clear + 6.0 * size))
                } else {
                    way
                };
                self.letters.avoid_line(&below, Obstacle::Body);
                if symbol.grounded && !symbol.way_grounded {
                    let (along, _) = symbols::direction([0.0; 2], placement.along);
                    let foot = [symbols::off(placement.at, along, -half, 0.0), symbols::off(placement.at, along, half, 0.0)];
                    self.signs.hatched_below(&mut self.scene, foot, 18.0, false);
                }
            }
            // a body with a shape beside its guide is seen to slide on it
            if symbol.boxed || (ink.strong && placement.clear == 0.0) {
                self.signs.slider(&mut self.scene, placement, ink);
            }
        } else if symbol.kind == SymbolKind::Plane {
            if ink.strong {
                let fill = if symbol.way_grounded { GREY } else { body_color(symbol.way_body) };
                self.signs.plane(&mut self.scene, placement, fill, ink);
            }
        } else if ink.strong && symbol.grounded && symbol.kind != SymbolKind::Slot {
            // a bearing that its bodies would hide stands in front of them
            if self.drawing.axes.is_some() && !self.is_covered(symbol, placement.at) {
                self.signs.ground(&mut self.scene, placement.at, false);
            }
            let side = if symbol.above { -1.0 } else { 1.0 };
            self.letters.avoid(placement.at, [28.0 * size, 22.0 * size], [0.0, side * 22.0 * size]);
        }
    }

    /// Whether a slide of the plane is guided by the ground: behind a wheel its guide would not be seen.
    fn guides_in_front(&self, symbol: &Symbol) -> bool {
        symbol.kind == SymbolKind::Slide && symbol.way_grounded && self.drawing.axes.is_none()
    }

    /// The guides of slides, and the bearings of hinges, that stand in front of bodies, behind which they would not be seen: in the plane of
    /// all with an outline, in space of the own ones.
    fn bearings(&mut self, joints: &[(&Symbol, Placement)]) {
        let ink = Looks { fill: [255; 3], edge: INK, strong: true, strength: 1.0 };
        for (symbol, placement) in joints {
            if self.guides_in_front(symbol) {
                self.below(symbol, placement, &ink);
            }
        }
        let slides = |symbol: &Symbol| matches!(symbol.kind, SymbolKind::Slide | SymbolKind::Slot | SymbolKind::Plane);
        for (symbol, placement) in joints.iter().filter(|(symbol, _)| symbol.grounded && !slides(symbol)) {
            if self.drawing.axes.is_none() || self.is_covered(symbol, placement.at) {
                self.signs.ground(&mut self.scene, placement.at, symbol.above);
            }
        }
    }

    /// Whether an area of one of the bodies of a joint lies around its place in the first position.
    fn is_covered(&self, symbol: &Symbol, at: Point) -> bool {
        let bodies = symbol.bodies.iter().filter_map(|body| self.drawing.bodies.get(*body)?.poses.first());
        let shapes = bodies.flatten().filter_map(|form| self.sheet.form(form));
        shapes.filter(|kind| matches!(kind, FormKind::Area { .. } | FormKind::Disc { .. })).any(|kind| encloses(&naming::line(&kind), at))
    }

    /// The shapes of all bodies, those farther from the eye first.
    fn forms(&mut self, pose: usize, strength: f64, joints: &[(&Symbol, Placement)]) {
        let rods = self.drawing.links.iter().filter(|link| link.kind == LinkKind::Rod).filter_map(|link| {
            let [from, to] = *link.poses.get(pose)?;
            Some((ROD, Form::flat(FormKind::Bar { from, to, width: Width::Drawn(0) }, 0.0)))
        });
        let bodies = self.drawing.bodies.iter().enumerate().flat_map(|(index, body)| {
            let forms = body.poses.get(pose).map_or(&[][..], Vec::as_slice);
            let color = body_color(index);
            let first = body.poses.first().map_or(&[][..], Vec::as_slice);
            let shown = forms
                .iter()
                .enumerate()
                .filter_map(move |(k, form)| if pose == 0 { Some(form.clone()) } else { form.as_ghost(first.get(k)) });
            shown.map(move |form| (color, form))
        });
        // wheels about one place are as deep, whatever the rounding: their order stays while they move
        let step = SAME_DEPTH / self.sheet.scale;
        let even = |(color, mut form): (Color, Form)| {
            if matches!(form.kind, FormKind::Wheel { .. }) {
                form.depth = (form.depth / step).round() * step;
            }
            (color, form)
        };
        let (colors, all): (Vec<Color>, Vec<Form>) =
            bodies.chain(rods).filter(|(_, form)| self.sheet.form(form).is_some()).map(even).unzip();
        let (sheet, signs) = (self.sheet, self.signs);
        let painted = painted(&all.iter().collect::<Vec<_>>(), |form| match sheet.form(form) {
            Some(FormKind::Bar { width, .. }) => signs.bar(width) / sheet.scale,
            _ => 0.0,
        });
        // in the plane what has an outline lies below 0
        let outlines = painted.partition_point(|shape| all[shape.form()].depth < 0.0);
        let end = painted.len();
        let front = (pose == 0).then_some(if self.drawing.axes.is_none() { outlines } else { end });
        for (k, shape) in painted.into_iter().enumerate() {
            if front == Some(k) {
                self.bearings(joints);
            }
            let form = &all[shape.form()];
            let looks = Self::looks(colors[shape.form()], strength);
            let Some(outline) = self.shape(form, &shape, &looks, joints) else { continue };
            self.letters.avoid_line(&outline, if strength == 1.0 { Obstacle::Body } else { Obstacle::Shade });
        }
        if front == Some(end) {
            self.bearings(joints);
        }
    }

    /// A shape, or a part of it; gives the line around it.
    fn shape(&mut self, form: &Form, shape: &Painted, looks: &Looks, joints: &[(&Symbol, Placement)]) -> Option<Vec<Point>> {
        let kind = match (shape, &form.kind) {
            (Painted::Part(_, facet), FormKind::Area { shade, .. }) => {
                let points: Vec<Point> = facet.corners.iter().map(|p| self.sheet.point([p[0], p[1]])).collect();
                return Some(self.signs.part(&mut self.scene, &points, &facet.edges, *shade, looks));
            }
            (Painted::Part(_, facet), FormKind::Bar { width, .. }) => {
                let [from, to] = [0, facet.corners.len() - 1].map(|k| [facet.corners[k][0], facet.corners[k][1]]);
                self.sheet.form(&Form::flat(FormKind::Bar { from, to, width: *width }, form.depth))?
            }
            _ => self.sheet.form(form)?,
        };
        // A body of one point is shown by the joint there, if there is one.
        let single = match &kind {
            FormKind::Plate { points } if points.len() == 1 => Some(points[0]),
            _ => None,
        };
        if single.is_some_and(|at| joints.iter().any(|(_, placement)| near(placement.at, at))) {
            return None;
        }
        Some(self.signs.form(&mut self.scene, &kind, looks))
    }

    /// The lines of actuators in a pale position, and of springs and dampers where there are few of those.
    fn lines(&mut self, pose: usize, strength: f64) {
        for link in &self.drawing.links {
            let (color, width) = match link.kind {
                LinkKind::Actuator => (marks::DRIVE, 3.0),
                LinkKind::Spring | LinkKind::Damper | LinkKind::SpringDamper if link.poses.len() <= FEW => (marks::RUST, 1.4),
                _ => continue,
            };
            if let Some(ends) = link.poses.get(pose).filter(|ends| ends.iter().all(is_usable)) {
                let line = ends.map(|end| self.sheet.point(end)).to_vec();
                self.letters.avoid_line(&line, Obstacle::Shade);
                self.scene.line(line, Stroke::solid(pale(color, strength), self.signs.pen(width)));
            }
        }
    }

    /// Springs and dampers; of all positions over each other they would be a thicket.
    fn links(&mut self) {
        for link in self.drawing.links.iter().filter(|link| link.kind != LinkKind::Rod) {
            let Some(ends) = self.sheet.ends(link) else { continue };
            self.anchors(link, ends);
            self.signs.link(&mut self.scene, link, ends);
            self.letters.avoid_line(&ends, Obstacle::Body);
            if link.kind.turns() && near(ends[0], ends[1]) {
                self.letters.avoid(ends[0], [26.0 * self.signs.size; 2], [0.0; 2]);
            } else if link.kind == LinkKind::Brake {
                let [half, height] = self.signs.slide_box();
                self.letters.avoid(ends[1], [0.7 * half, 12.0 * self.signs.size], [0.0, -height - 10.0 * self.signs.size]);
            }
        }
    }

    /// The ground at the ends of a spring or damper, where no joint has its bearing.
    fn anchors(&mut self, link: &super::pose::Link, ends: [Point; 2]) {
        if link.kind.turns() {
            return;
        }
        let joints = self.drawing.joints.iter().filter(|joint| joint.grounded);
        let bearings: Vec<Point> = joints.filter_map(|joint| Some(self.sheet.point(joint.poses.first()?.at))).collect();
        for (end, other) in [(0, 1), (1, 0)] {
            if link.grounded[end] && !bearings.iter().any(|at| near(*at, ends[end])) {
                let (along, _) = symbols::direction(ends[other], ends[end]);
                self.signs.anchor(&mut self.scene, ends[end], along);
                self.letters.avoid(ends[end], [16.0 * self.signs.size; 2], [0.0; 2]);
            }
        }
    }

    /// What stands beside a joint: the arrow of a drive, a dashpot, stops.
    fn beside(&mut self, symbol: &Symbol, placement: &Placement) {
        let slides = matches!(symbol.kind, SymbolKind::Slide | SymbolKind::Slot);
        let flipped = |[x, y]: Point| [x, -y];
        let stops = placement.stops.map(|stop| stop.map(|at| if slides { self.sheet.point(at) } else { flipped(at) }));
        let quarter = placement.quarter.map(flipped);
        self.signs.stops(&mut self.scene, &Placement { stops, quarter, ..*placement }, slides);
        if symbol.driven {
            let arrow = self.signs.drive(&mut self.scene, placement, slides && !symbol.turns);
            self.letters.avoid_line(&arrow, Obstacle::Sign);
        }
        if symbol.damped {
            let line = self.signs.dashpot(&mut self.scene, placement, slides, symbol.way_grounded);
            self.letters.avoid_line(&line, Obstacle::Sign);
        }
    }

    fn traces(&mut self) {
        for (index, trace) in self.drawing.traces.iter().enumerate() {
            let (color, dash) = path_stroke(index);
            for piece in trace.points.split(|point| !is_usable(point)) {
                for part in retraced::once(&self.sheet.points(piece)) {
                    let pixels = thin::thinned(part, false);
                    self.letters.avoid_line(&pixels, Obstacle::Path);
                    match pixels[..] {
                        [] => {}
                        [only] => self.scene.circle(only, 4.0, Some(color), None),
                        _ => self.scene.line(pixels, Stroke::dashed(color, 2.2, dash)),
                    }
                }
            }
        }
    }

    /// The names of the strong position, unless they would cover more of the sheet than can be read, and those of paths.
    fn names(&mut self, names: Vec<Name>, paper: Rect) {
        // the one path of a body that is named goes without a name of its own
        let known: Vec<String> = names.iter().flat_map(|name| name.text.split(naming::COMMA)).map(str::to_owned).collect();
        let area: f64 = names.iter().map(|name| font::width(&name.text, LETTERS) * LETTERS).sum();
        let mut all = if area <= NAMED * paper.width() * paper.height() { names } else { Vec::new() };
        let alone = self.drawing.traces.len() == 1;
        for (index, trace) in self.drawing.traces.iter().enumerate() {
            let named = known.contains(&trace.name);
            if named && alone {
                continue;
            }
            let pixels = self.sheet.points(&trace.points);
            if let Some(at) = pixels.iter().copied().min_by(|a, b| a[1].total_cmp(&b[1])) {
                let text = if named { format!("path of {}", trace.name) } else { trace.name.clone() };
                let color = path_stroke(index).0;
                all.push(Name { text, at, also: Vec::new(), above: Vec::new(), reach: 6.0, color, of: Named::Path(pixels) });
            }
        }
        self.letters.place(all);
    }
}

#[cfg(test)]
mod tests;
