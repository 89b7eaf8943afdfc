//! One panel of a figure: its axes, its grid and its curves.

use super::clip;
use super::heads::heads;
use super::legend::{self, Entry, Legend};
use super::plot::{Axis, Mark, Scale};
use super::scalars::significant;
use super::scene::{Anchor, Color, GREY, GRID, INK, Item, Rect, Scene, Stroke, Text, pale};
use super::thin::{self, Point};
use super::ticks::{self, Tick};
use super::{font, retraced, units};

/// Font sizes: readable when the picture is shown at half its size.
pub(super) const TICK: f64 = 20.0;
const LABEL: f64 = 22.0;
/// Numbers beyond cannot be told from overflow; their differences would be infinite.
const HUGE: f64 = 1e290;
/// Dots of a curve that are large, at most.
const MANY_DOTS: usize = 200;

/// An axis with its numbers: SI values become shown values, `(si - offset) factor`, and those become positions.
#[derive(Clone, Debug)]
pub(super) struct Ruler {
    scale: Scale,
    name: String,
    unit: String,
    shown: units::Shown,
    offset: f64,
    low: f64,
    high: f64,
    pub(super) ticks: Vec<Tick>,
}

impl Ruler {
    /// An axis for `values`; `plain` forbids to shift the origin.
    pub(super) fn over(values: impl Iterator<Item = f64>, axis: &Axis, unit: &str, plain: bool) -> Self {
        let usable = |x: &f64| x.abs() < HUGE && (axis.scale == Scale::Linear || *x > 1e-290);
        let range = values
            .filter(usable)
            .fold(None, |range: Option<(f64, f64)>, x| Some(range.map_or((x, x), |(low, high)| (low.min(x), high.max(x)))));
        let (low, high) = range.unwrap_or(if axis.scale == Scale::Log { (1.0, 10.0) } else { (0.0, 1.0) });
        let mut ruler = Self {
            scale: axis.scale,
            name: axis.label.clone(),
            unit: unit.to_owned(),
            shown: units::plain(unit),
            offset: 0.0,
            low,
            high,
            ticks: Vec::new(),
        };
        let (span, largest) = (high - low, low.abs().max(high.abs()));
        if ruler.scale == Scale::Log {
            if high < 1.001 * low {
                (ruler.low, ruler.high) = (low / 3.0, high * 3.0);
            }
            return ruler;
        }
        if span <= 1e-12 * largest {
            // Nothing but rounding: a constant, shown in the middle of a range of its own size.
            let around = if largest > 1e-290 { 0.25 * largest } else { 1.0 };
            (ruler.low, ruler.high) = (low - around, high + around);
        } else if span < 1e-4 * largest && !plain {
            // Long equal digits at every mark: a round number is taken off and named in the label.
            let round = 10f64.powf(span.log10().ceil());
            ruler.offset = (((low + high) / 2.0) / round).round() * round;
        }
        ruler.rescale();
        ruler
    }

    fn rescale(&mut self) {
        let largest = [self.low, self.high].into_iter().map(|x| (x - self.offset).abs()).fold(0.0, f64::max);
        self.shown = units::scaled(&self.unit, largest);
    }

    /// Both axes in one unit, as equal scales need it.
    pub(super) fn share(x: &mut Self, y: &mut Self) {
        if x.unit == y.unit {
            let largest = [x.low, x.high, y.low, y.high].into_iter().map(f64::abs).fold(0.0, f64::max);
            (x.shown, y.shown) = (units::scaled(&x.unit, largest), units::scaled(&x.unit, largest));
        }
    }

    /// Widens the range by `part` of itself at both ends.
    pub(super) fn pad(&mut self, part: f64) {
        match self.scale {
            Scale::Linear => {
                let by = part * (self.high - self.low);
                (self.low, self.high) = (self.low - by, self.high + by);
            }
            Scale::Log => {
                let by = (self.high / self.low).powf(part);
                (self.low, self.high) = (self.low / by, self.high * by);
            }
        }
    }

    /// Sets the ends that are given, in the unit of the axis.
    pub(super) fn limit(&mut self, range: [Option<f64>; 2]) {
        let usable = |x: &f64| x.is_finite() && (self.scale == Scale::Linear || *x > 0.0);
        let [low, high] = range.map(|end| end.filter(usable));
        if low.is_none() && high.is_none() {
            return;
        }
        (self.low, self.high) = (low.unwrap_or(self.low), high.unwrap_or(self.high));
        if self.low > self.high {
            // one end may lie beyond all curves
            (self.low, self.high) = if low.is_some() && high.is_some() { (self.high, self.low) } else { (self.low, self.low) };
        }
        if self.low == self.high {
            self.high += if self.low == 0.0 { 1.0 } else { self.low.abs() };
        }
        self.offset = 0.0;
        if self.scale == Scale::Linear {
            self.rescale();
        }
    }

    /// Widens two even axes so that their zeros are level, where both have one.
    pub(super) fn level(a: &mut Self, b: &mut Self) {
        let crosses = |ruler: &Self| ruler.scale == Scale::Linear && ruler.offset == 0.0 && ruler.low < 0.0 && ruler.high > 0.0;
        if !crosses(a) || !crosses(b) {
            return;
        }
        let below = |ruler: &Self| -ruler.low / (ruler.high - ruler.low);
        let parts = [below(a), below(b)];
        let (below, above) = (parts[0].max(parts[1]), 1.0 - parts[0].min(parts[1]));
        for ruler in [a, b] {
            let height = ruler.high - ruler.low;
            (ruler.low, ruler.high) = (-below * height, above * height);
        }
    }

    /// Widens one of two even axes so that their units are equally long in `rect`.
    pub(super) fn equalize(x: &mut Self, y: &mut Self, rect: Rect) {
        if x.scale == Scale::Log || y.scale == Scale::Log {
            return;
        }
        let (dense_x, dense_y) = ((x.high - x.low) / rect.width(), (y.high - y.low) / rect.height());
        let density = dense_x.max(dense_y);
        for (ruler, length) in [(x, rect.width()), (y, rect.height())] {
            let (middle, half) = ((ruler.low + ruler.high) / 2.0, density * length / 2.0);
            (ruler.low, ruler.high) = (middle - half, middle + half);
        }
    }

    fn show(&self, x: f64) -> f64 {
        (x - self.offset) * self.shown.factor
    }

    /// Chooses the marks for an axis of `length` pixels: one for about every `spacing`, fewer while a label takes more `room`.
    pub(super) fn mark(&mut self, length: f64, spacing: f64, room: impl Fn(&str) -> f64) {
        let (low, high) = (self.show(self.low), self.show(self.high));
        let mut most = (length / spacing).max(2.0) as usize;
        loop {
            self.ticks = match self.scale {
                Scale::Linear => ticks::linear(low, high, most, self.shown.unit == "deg"),
                Scale::Log => ticks::log(low, high, most),
            };
            let labelled = || self.ticks.iter().filter(|tick| !tick.label.is_empty());
            let at: Vec<f64> = labelled().map(|tick| self.part(tick.at) * length).collect();
            let needed: Vec<f64> = labelled().map(|tick| room(&tick.label)).collect();
            let crowded = (1..at.len()).any(|k| at[k] - at[k - 1] < (needed[k] + needed[k - 1]) / 2.0);
            if !crowded || most <= 2 {
                return;
            }
            most -= 1;
        }
    }

    /// Where a shown value lies: 0 at the low end, 1 at the high end.
    fn part(&self, shown: f64) -> f64 {
        let (low, high) = (self.show(self.low), self.show(self.high));
        match self.scale {
            Scale::Linear => (shown - low) / (high - low),
            Scale::Log => (shown / low).log10() / (high / low).log10(),
        }
    }

    /// Where an SI value lies, NaN if the axis cannot show it.
    pub(super) fn place(&self, x: f64) -> f64 {
        if x.abs() < HUGE && (self.scale == Scale::Linear || x > 1e-290) { self.part(self.show(x)) } else { f64::NAN }
    }

    /// The width of the longest label, in pixels.
    pub(super) fn widest(&self) -> f64 {
        self.ticks.iter().map(|tick| font::width(&tick.label, TICK)).fold(0.0, f64::max)
    }

    /// What the axis says, cut to `room` pixels.
    fn label(&self, room: f64) -> String {
        let offset = match self.offset {
            0.0 => String::new(),
            offset => {
                let sign = if offset < 0.0 { '+' } else { '−' };
                format!(" {sign} {} {}", significant(offset.abs(), 12), units::pretty(&self.unit)).trim_end().to_owned()
            }
        };
        let unit = match (self.shown.unit.as_str(), self.name.is_empty()) {
            ("", _) => String::new(),
            (unit, true) if offset.is_empty() => unit.to_owned(),
            (unit, true) => format!("in {unit}"),
            (unit, false) => format!(" in {unit}"),
        };
        // The unit is what must not be lost.
        let rest = offset + &unit;
        font::fitted(&self.name, LABEL, room - font::width(&rest, LABEL)) + &rest
    }
}

/// A curve with its looks.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) points: Vec<(f64, f64)>,
    pub(super) ordered: bool,
    pub(super) color: Color,
    pub(super) dash: &'static [f64],
    /// Whether it is drawn over the axis on the right.
    pub(super) right: bool,
    /// Whether its points alone are drawn.
    pub(super) dots: bool,
}

impl Line {
    /// Few values are the results of single runs: the line between is only a guide.
    fn is_short(&self) -> bool {
        self.points.len() <= 25 || self.dots
    }

    /// The radius of its dots, in pixels: many would cover each other.
    fn dot(&self) -> f64 {
        if self.points.len() > MANY_DOTS { 2.5 } else { 5.0 }
    }
}

/// What arrows at an edge mean, and the size of these words.
const LEAVES: [&str; 2] = ["arrows: without bound", "towards a dead point"];
const NOTE: f64 = 0.8 * TICK;
/// What dashed lines across the panels mean.
const SWITCHES: &str = "dashed: switches";
/// What is farther out of the picture, in pixels, is here.
const FAR: f64 = 1e7;

/// One panel of a figure.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub(super) rect: Rect,
    pub(super) y: Ruler,
    /// The axis on the right.
    pub(super) right: Option<Ruler>,
    pub(super) lines: Vec<Line>,
    /// Of the legend, until it is placed.
    pub(super) entries: Vec<Entry>,
    pub(super) legend: Legend,
    pub(super) marks: Vec<Mark>,
    /// Whether values without bound leave the axis on the left, and that on the right.
    pub(super) clipped: [bool; 2],
    /// Whether they do so towards a dead point.
    pub(super) dead: bool,
    /// The base line of the label of y, in pixels; the same for all panels.
    pub(super) label: f64,
    /// What the axis on the right takes, in pixels.
    pub(super) side: f64,
}

impl Panel {
    fn point(&self, x: &Ruler, y: &Ruler, at: (f64, f64)) -> Point {
        let (right, up) = (x.place(at.0), y.place(at.1));
        [self.rect.left + right * self.rect.width(), self.rect.bottom - up * self.rect.height()]
    }

    /// The pieces of a curve in pixels.
    fn pieces(&self, line: &Line, x: &Ruler, breaks: &[f64]) -> Vec<Vec<Point>> {
        // Few values get a dot each, and so none of them may go.
        let thinned = |points| match (line.dots, line.is_short()) {
            (true, _) => thin::dots(points),
            (_, true) => points,
            _ => thin::thinned(points, line.ordered),
        };
        let y = self.right.as_ref().filter(|_| line.right).unwrap_or(&self.y);
        let shown = |at: &(f64, f64)| {
            let known = self.point(x, y, *at).iter().all(|x| x.is_finite());
            if known { *at } else { (at.0, f64::NAN) }
        };
        let points: Vec<_> = line.points.iter().map(shown).collect();
        let pieces = thin::pieces(&points, line.ordered, breaks).into_iter();
        // where a line to a value without bound leaves the panel would be lost in round-off
        let pixel = |at| self.point(x, y, at).map(|x| x.clamp(-FAR, FAR));
        let pixels = pieces.map(|piece| piece.into_iter().map(pixel).collect::<Vec<Point>>());
        // an axis whose ends are given may end within its curves
        let area = self.rect.grown(0.5);
        let inside = pixels.flat_map(|piece| if line.dots { clip::points(&piece, area) } else { clip::line(&piece, area) });
        inside.map(thinned).collect()
    }

    /// The values of a curve of few, in pixels; not where it is cut at an edge.
    fn values(&self, line: &Line, x: &Ruler) -> Vec<Point> {
        let y = self.right.as_ref().filter(|_| line.right).unwrap_or(&self.y);
        let all: Vec<Point> = line.points.iter().map(|at| self.point(x, y, *at)).filter(|at| at.iter().all(|x| x.is_finite())).collect();
        clip::points(&all, self.rect.grown(0.5)).concat()
    }

    /// All curves in pixels.
    pub(super) fn pixels(&self, x: &Ruler, breaks: &[f64]) -> Vec<Vec<Point>> {
        let marks = self.marks.iter().map(|mark| vec![self.point(x, &self.y, mark.at)]);
        self.lines.iter().flat_map(|line| self.pieces(line, x, breaks)).chain(marks).collect()
    }

    /// Draws the panel; the numbers and the label of x only below the `lowest`.
    pub(super) fn draw(&self, scene: &mut Scene, x: &Ruler, breaks: &[f64], lowest: bool) {
        let Rect { top, bottom, left, right } = self.rect;
        let places: Vec<f64> =
            breaks.iter().map(|at| left + x.place(*at) * self.rect.width()).filter(|at| (left..=right).contains(at)).collect();
        self.axes(scene, x, lowest, !places.is_empty());
        for at in places {
            scene.line(vec![[at, top], [at, bottom]], Stroke::dashed(GREY, 1.2, &[6.0, 5.0]));
        }
        let mut empty = true;
        // A curve that fills the panel would lose its dashes, and hide all others.
        let dense = |piece: &Vec<Point>| thin::length(piece) > 20.0 * self.rect.width();
        for line in &self.lines {
            let pieces = self.pieces(line, x, breaks);
            empty &= pieces.is_empty();
            let directed = !line.is_short() && !pieces.iter().any(dense);
            let heads = if directed { heads(&pieces, self.lines.len()) } else { Vec::new() };
            for piece in pieces {
                if line.dots || (piece.len() == 1 && !line.is_short()) {
                    piece.iter().for_each(|at| scene.circle(*at, line.dot(), Some(line.color), None));
                }
                if piece.len() > 1 && !line.dots {
                    let stroke = if dense(&piece) { Stroke::solid(line.color, 1.5) } else { Stroke::dashed(line.color, 3.0, line.dash) };
                    if line.ordered || line.dash.is_empty() || dense(&piece) {
                        scene.line(piece, stroke);
                    } else {
                        let parts = retraced::once(&piece).into_iter().map(|part| thin::thinned(part, false));
                        parts.filter(|part| part.len() > 1).for_each(|part| scene.line(part, stroke));
                    }
                }
            }
            if line.is_short() && !line.dots {
                self.values(line, x).iter().for_each(|at| scene.circle(*at, line.dot(), Some(line.color), None));
            }
            heads.into_iter().for_each(|head| scene.shape(head.to_vec(), Some(line.color), None));
            if self.clipped[usize::from(line.right)] {
                self.leaving(scene, line, x, breaks);
            }
        }
        if self.clipped.contains(&true) {
            // beside the name of the axis there is room for half of it
            let words = &LEAVES[..if self.dead { 2 } else { 1 }];
            let lines: &[(&str, f64)] =
                if lowest { &[(words[0], 47.0), (words.get(1).unwrap_or(&""), 66.0)] } else { &[(&words.join(" "), 22.0)] };
            lines
                .iter()
                .filter(|(text, _)| !text.is_empty())
                .for_each(|(text, below)| scene.text([right, bottom + below], *text, NOTE, Anchor::End));
        }
        if empty {
            let [x, y] = self.rect.center();
            scene.text([x, y], "no values", LABEL, Anchor::Middle);
        }
        self.draw_marks(scene, x, breaks);
        self.legend.draw(scene, self.rect, self.side);
    }

    /// Arrows where a curve leaves the axis towards a pole.
    fn leaving(&self, scene: &mut Scene, line: &Line, x: &Ruler, breaks: &[f64]) {
        let Rect { top, bottom, .. } = self.rect;
        for end in self.pieces(line, x, breaks).iter().flat_map(|piece| [piece.first(), piece.last()]).flatten() {
            let [edge, way] = if end[1] < top + 1.0 {
                [top, 1.0]
            } else if end[1] > bottom - 1.0 {
                [bottom, -1.0]
            } else {
                continue;
            };
            let corners = [[0.0, 2.0], [-7.0, 16.0], [7.0, 16.0]].map(|[s, t]| [end[0] + s, edge + way * t]);
            scene.shape(corners.to_vec(), Some(line.color), None);
        }
    }

    fn axes(&self, scene: &mut Scene, x: &Ruler, lowest: bool, marked: bool) {
        let Rect { top, bottom, left, right } = self.rect;
        let grid = |major: bool| Stroke::solid(if major { GRID } else { pale(GRID, 0.5) }, 1.0);
        let across = |tick: &Tick| left + x.part(tick.at) * self.rect.width();
        let up = |tick: &Tick| bottom - self.y.part(tick.at) * self.rect.height();
        for major in [false, true] {
            for tick in x.ticks.iter().filter(|tick| tick.label.is_empty() != major) {
                scene.line(vec![[across(tick), top], [across(tick), bottom]], grid(major));
            }
            for tick in self.y.ticks.iter().filter(|tick| tick.label.is_empty() != major) {
                scene.line(vec![[left, up(tick)], [right, up(tick)]], grid(major));
            }
        }
        let zero = self.y.show(0.0);
        let height = bottom - self.y.part(zero) * self.rect.height();
        if self.y.scale == Scale::Linear && self.y.offset == 0.0 && height > top && height < bottom {
            scene.line(vec![[left, height], [right, height]], Stroke::solid([170, 170, 170], 1.2));
        }
        scene.rect(self.rect, None, Some(Stroke::solid(GREY, 1.2)));
        for tick in self.y.ticks.iter().filter(|tick| !tick.label.is_empty()) {
            scene.line(vec![[left - 6.0, up(tick)], [left, up(tick)]], Stroke::solid(GREY, 1.2));
            scene.text([left - 11.0, up(tick) + TICK * font::CAPITAL / 2.0], &tick.label, TICK, Anchor::End);
        }
        for tick in x.ticks.iter().filter(|tick| !tick.label.is_empty()) {
            scene.line(vec![[across(tick), bottom], [across(tick), bottom + 6.0]], Stroke::solid(GREY, 1.2));
            if lowest {
                scene.text([across(tick), bottom + 12.0 + TICK * font::CAPITAL], &tick.label, TICK, Anchor::Middle);
            }
        }
        if lowest {
            let words = LEAVES.iter().filter(|_| self.clipped.contains(&true)).chain(marked.then_some(&SWITCHES));
            let note = words.map(|text| font::width(text, NOTE) + 16.0).fold(0.0, f64::max);
            let room = self.rect.width() - 2.0 * note;
            if marked {
                scene.text([left, bottom + 66.0], SWITCHES, NOTE, Anchor::Start);
            }
            scene.text([(left + right) / 2.0, bottom + 66.0], x.label(room), LABEL, Anchor::Middle);
        }
        let upright = |at: Point, text: String| {
            Item::Text(Text { at, text, size: LABEL, color: INK, anchor: Anchor::Middle, upright: true, halo: false })
        };
        scene.items.push(upright([self.label, (top + bottom) / 2.0], self.y.label(self.rect.height() + 20.0)));
        let Some(axis) = &self.right else { return };
        for tick in axis.ticks.iter().filter(|tick| !tick.label.is_empty()) {
            let y = bottom - axis.part(tick.at) * self.rect.height();
            scene.line(vec![[right, y], [right + 6.0, y]], Stroke::solid(GREY, 1.2));
            scene.text([right + 11.0, y + TICK * font::CAPITAL / 2.0], &tick.label, TICK, Anchor::Start);
        }
        scene.items.push(upright([right + 11.0 + axis.widest() + 30.0, (top + bottom) / 2.0], axis.label(self.rect.height() + 20.0)));
    }

    fn draw_marks(&self, scene: &mut Scene, x: &Ruler, breaks: &[f64]) {
        let curves = self.pixels(x, breaks);
        for mark in &self.marks {
            let at = self.point(x, &self.y, mark.at);
            if !self.rect.contains(at) {
                continue;
            }
            scene.circle(at, 6.0, Some(INK), Some(Stroke::solid([255; 3], 2.0)));
            let (width, height) = (font::width(&mark.label, TICK), TICK * font::CAPITAL);
            let beside = |dx: f64, dy: f64| {
                let (x, y) = (at[0] + dx * (14.0 + width / 2.0), at[1] + dy * (14.0 + height / 2.0));
                Rect { left: x - width / 2.0, top: y - height / 2.0, right: x + width / 2.0, bottom: y + height / 2.0 }
            };
            let sides = [(1.0, -0.8), (-1.0, -0.8), (1.0, 0.8), (-1.0, 0.8), (0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (-1.0, 0.0)];
            let within = self.rect.grown(-6.0);
            let inside = |area: &Rect| within.contains([area.left, area.top]) && within.contains([area.right, area.bottom]);
            let free = |area: &Rect| inside(area) && !curves.iter().any(|line| legend::crosses(line, area.grown(4.0)));
            let places = || sides.into_iter().map(|(dx, dy)| beside(dx, dy));
            let area = places().find(free).or_else(|| places().find(inside)).unwrap_or_else(|| beside(0.0, -1.0));
            let (at, text) = ([area.left, area.bottom], mark.label.clone());
            scene.items.push(Item::Text(Text { at, text, size: TICK, color: INK, anchor: Anchor::Start, upright: false, halo: true }));
        }
    }
}
