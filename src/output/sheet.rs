//! A drawing in pixels: its extent, its scale, and its parts as they lie on the sheet.

use super::pose::{Drawing, Form, FormKind, Gear, Link, Placement, Width};
use super::scene::{Color, GREY, pale};
use super::symbols::shaded;
use super::thin::Point;

/// Fills of bodies, muted: the joints and paths are what one looks for.
const BODIES: [Color; 7] =
    [[163, 190, 218], [232, 200, 148], [176, 208, 168], [208, 182, 216], [226, 178, 166], [164, 208, 206], [208, 204, 170]];

/// From metres to pixels, both axes by one scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet {
    pub(super) scale: f64,
    pub(super) origin: Point,
}

impl Sheet {
    pub(super) fn point(&self, [x, y]: [f64; 2]) -> Point {
        [self.origin[0] + self.scale * x, self.origin[1] - self.scale * y]
    }

    pub(super) fn points(&self, points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().filter(|p| is_usable(p)).map(|p| self.point(*p)).collect()
    }

    /// The placement in pixels; directions keep their lengths.
    pub(super) fn placement(&self, placement: &Placement) -> Option<Placement> {
        let turned = |[x, y]: [f64; 2]| if is_usable(&[x, y]) { [x, -y] } else { [0.0; 2] };
        let along = |reach: f64| reach * placement.along[0].hypot(placement.along[1]) * self.scale;
        let way = placement.way.filter(|way| way.iter().all(is_usable)).map(|way| way.map(|end| self.point(end)));
        is_usable(&placement.at).then(|| Placement {
            at: self.point(placement.at),
            along: turned(placement.along),
            way,
            carrier: placement
                .carrier
                .filter(|(ends, _)| ends.iter().all(is_usable))
                .map(|(ends, round)| (ends.map(|end| self.point(end)), round)),
            across: placement.across.map(turned),
            sense: placement.sense,
            clear: placement.clear * self.scale,
            upper: placement.upper,
            stops: placement.stops.map(|stop| stop.filter(is_usable)),
            quarter: placement.quarter,
            beyond: placement.beyond.map(along),
            back: along(placement.back),
            swing: placement.swing,
        })
    }

    /// A shape in pixels, if it can be drawn.
    pub(super) fn form(&self, form: &Form) -> Option<FormKind> {
        let radius = |r: f64| (r.is_finite() && r < 1e9).then_some(r * self.scale);
        let at = |p: &[f64; 2]| is_usable(p).then(|| self.point(*p));
        Some(match &form.kind {
            FormKind::Bar { from, to, width } => {
                let width = match width {
                    Width::Given(width) => Width::Given((width * self.scale).clamp(3.0, 2000.0)),
                    drawn => *drawn,
                };
                FormKind::Bar { from: at(from)?, to: at(to)?, width }
            }
            FormKind::Plate { points } => FormKind::Plate { points: self.points(points) },
            FormKind::Area { points, shade } => FormKind::Area { points: self.points(points), shade: *shade },
            FormKind::Wheel { outline, face } => FormKind::Wheel { outline: self.points(outline), face: self.points(face) },
            FormKind::Disc { center, radius: r, spoke } => {
                FormKind::Disc { center: at(center)?, radius: radius(*r)?, spoke: spoke.as_ref().and_then(at) }
            }
            FormKind::Gear { center, radius: r, teeth, outline, spoke, rim } => FormKind::Gear {
                center: at(center)?,
                radius: radius(*r)?,
                teeth: *teeth,
                outline: self.points(outline),
                spoke: spoke.as_ref().and_then(at),
                rim: rim.and_then(radius),
            },
            FormKind::Mass { center, radius: r } => FormKind::Mass { center: at(center)?, radius: radius(*r)? },
        })
    }

    /// The ends of a link in the first position.
    pub(super) fn ends(&self, link: &Link) -> Option<[Point; 2]> {
        let ends = link.poses.first().filter(|ends| ends.iter().all(is_usable))?;
        Some(ends.map(|end| self.point(end)))
    }

    /// Gears in pixels.
    pub(super) fn gear(&self, gear: &Gear) -> Gear {
        Gear {
            circles: gear.circles.iter().map(|circle| self.points(circle)).collect(),
            rims: gear.rims.iter().map(|rim| self.points(rim)).collect(),
            line: gear.line.filter(|line| line.iter().all(is_usable)).map(|line| line.map(|p| self.point(p))),
            mesh: gear.mesh.filter(is_usable).map(|p| self.point(p)),
            belt: self.points(&gear.belt),
            rope: gear.rope.filter(|rope| rope.iter().all(is_usable)).map(|rope| rope.map(|p| self.point(p))),
        }
    }
}

/// Fill of a body; 0 is the ground. Of many bodies those of a further round are darker, then lighter.
pub(super) fn body_color(index: usize) -> Color {
    let Some(index) = index.checked_sub(1) else { return GREY };
    let color = BODIES[index % BODIES.len()];
    match index / BODIES.len() {
        0 => color,
        round if round % 2 == 1 => shaded(color, 1.0 - 0.1 * round.div_ceil(2).min(4) as f64),
        round => pale(color, 1.0 - 0.25 * (round / 2).min(3) as f64),
    }
}

/// Whether two points in pixels are one.
pub(super) fn near(a: Point, b: Point) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) < 1.0
}

pub(super) fn is_usable(point: &[f64; 2]) -> bool {
    point.iter().all(|x| x.abs() < 1e12)
}

/// Points around a shape.
pub(super) fn corners(kind: &FormKind) -> Vec<[f64; 2]> {
    let around = |[x, y]: [f64; 2], r: f64| vec![[x - r, y], [x + r, y], [x, y - r], [x, y + r]];
    match kind {
        FormKind::Bar { from, to, .. } => vec![*from, *to],
        FormKind::Plate { points } | FormKind::Area { points, .. } | FormKind::Wheel { outline: points, .. } => points.clone(),
        FormKind::Disc { center, radius, .. } | FormKind::Mass { center, radius } => around(*center, *radius),
        FormKind::Gear { center, radius, rim, .. } => around(*center, rim.unwrap_or(*radius)),
    }
}

/// The smallest box around everything, in metres: left, bottom, right, top.
pub(super) fn extent(drawing: &Drawing) -> [f64; 4] {
    let bodies = drawing.bodies.iter().flat_map(|body| body.poses.iter().flatten()).flat_map(|form| corners(&form.kind));
    let joints = drawing.joints.iter().flat_map(|joint| joint.poses.iter());
    let joints = joints.flat_map(|pose| std::iter::once(pose.at).chain(pose.way.into_iter().flatten()));
    let links = drawing.links.iter().flat_map(|link| link.poses.iter().flatten().copied());
    let traces = drawing.traces.iter().flat_map(|trace| trace.points.iter().copied());
    let gears = drawing.gears.iter().flat_map(|gear| {
        gear.circles.iter().chain(&gear.rims).flatten().chain(&gear.belt).copied().chain(gear.line.into_iter().chain(gear.rope).flatten())
    });
    let all = bodies.chain(joints).chain(links).chain(traces).chain(gears).filter(is_usable);
    let [left, bottom, right, top] = all.fold([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY], |e, [x, y]| {
        [e[0].min(x), e[1].min(y), e[2].max(x), e[3].max(y)]
    });
    if left > right { [0.0, 0.0, 1.0, 1.0] } else { [left, bottom, right, top] }
}

/// Size of the signs: 1 where parts are long beside them, less where they are short, `scale` in pixels to the metre.
pub(super) fn size_of_signs(drawing: &Drawing, scale: f64) -> f64 {
    let first = drawing.bodies.iter().filter_map(|body| body.poses.first()).flatten();
    let mut lengths: Vec<f64> = first
        .filter_map(|form| match &form.kind {
            FormKind::Bar { .. } | FormKind::Plate { .. } => {
                let points = corners(&form.kind);
                let far = points.iter().flat_map(|p| points.iter().map(move |q| (p[0] - q[0]).hypot(p[1] - q[1]))).fold(0.0, f64::max);
                (far > 0.0 && far.is_finite()).then_some(far * scale)
            }
            _ => None,
        })
        .collect();
    lengths.sort_by(f64::total_cmp);
    // the shorter ones decide: a third of the parts may be smaller than the signs are made for
    lengths.get(lengths.len() / 3).map_or(1.0, |length| (length / 90.0).clamp(0.35, 1.0))
}
