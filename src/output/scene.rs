//! The display list: what a picture consists of, in pixels of its nominal size, y downwards.
//!
//! Layout is done once, in these few primitives; `svg` and `raster` only write them down. Nothing but a veil lets through what is behind
//! it: pale colours are mixed with the white of the paper beforehand, so that overlapping strokes of one body do not darken each other.

use super::font;
use super::thin::Point;

/// Red, green, blue.
pub(super) type Color = [u8; 3];

pub(super) const WHITE: Color = [255, 255, 255];
pub(super) const INK: Color = [34, 34, 34];
pub(super) const GREY: Color = [120, 120, 120];
pub(super) const GRID: Color = [225, 225, 225];

/// Okabe and Ito (2008), distinguishable with every kind of colour vision; their yellow is too pale for lines on white.
pub(super) const PALETTE: [Color; 7] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233], [60, 60, 60]];

/// A picture.
#[derive(Clone, Debug, Default)]
pub(super) struct Scene {
    pub(super) width: f64,
    pub(super) height: f64,
    /// For readers that cannot see it.
    pub(super) title: String,
    pub(super) items: Vec<Item>,
}

/// One primitive.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Item {
    Path {
        points: Vec<Point>,
        closed: bool,
        fill: Option<Color>,
        stroke: Option<Stroke>,
    },
    Circle {
        at: Point,
        radius: f64,
        fill: Option<Color>,
        stroke: Option<Stroke>,
    },
    /// A convex area through which one sees: of `opacity` 1 nothing of what is behind it.
    Veil {
        points: Vec<Point>,
        color: Color,
        opacity: f64,
    },
    Text(Text),
}

/// How a line is drawn; ends and corners are round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stroke {
    pub(super) color: Color,
    pub(super) width: f64,
    /// Lengths of dash, gap, dash...; empty for a solid line.
    pub(super) dash: &'static [f64],
}

/// One line of text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Text {
    /// Left end, middle or right end of the base line.
    pub(super) at: Point,
    pub(super) text: String,
    /// The font size, as in CSS.
    pub(super) size: f64,
    pub(super) color: Color,
    pub(super) anchor: Anchor,
    /// Running upwards.
    pub(super) upright: bool,
    /// White around the letters, to be readable over lines.
    pub(super) halo: bool,
}

/// What of a text stands at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A rectangle: left, top, right, bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Stroke {
    pub(super) const fn solid(color: Color, width: f64) -> Self {
        Self { color, width, dash: &[] }
    }

    pub(super) const fn dashed(color: Color, width: f64, dash: &'static [f64]) -> Self {
        Self { color, width, dash }
    }
}

impl Rect {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub(super) fn center(&self) -> Point {
        [(self.left + self.right) / 2.0, (self.top + self.bottom) / 2.0]
    }

    /// Larger by `by` on all sides.
    pub(super) fn grown(&self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }

    pub(super) fn contains(&self, [x, y]: Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    /// Its point nearest to another.
    pub(super) fn nearest(&self, [x, y]: Point) -> Point {
        [x.clamp(self.left, self.right), y.clamp(self.top, self.bottom)]
    }

    /// The area shared with `other`.
    pub(super) fn overlap(&self, other: &Self) -> f64 {
        let width = self.right.min(other.right) - self.left.max(other.left);
        let height = self.bottom.min(other.bottom) - self.top.max(other.top);
        width.max(0.0) * height.max(0.0)
    }
}

impl Scene {
    /// A line through `points`.
    pub(super) fn line(&mut self, points: Vec<Point>, stroke: Stroke) {
        self.items.push(Item::Path { points, closed: false, fill: None, stroke: Some(stroke) });
    }

    /// A closed shape.
    pub(super) fn shape(&mut self, points: Vec<Point>, fill: Option<Color>, stroke: Option<Stroke>) {
        self.items.push(Item::Path { points, closed: true, fill, stroke });
    }

    /// A convex area through which one sees.
    pub(super) fn veil(&mut self, points: Vec<Point>, color: Color, opacity: f64) {
        self.items.push(Item::Veil { points, color, opacity });
    }

    /// A rectangle.
    pub(super) fn rect(&mut self, r: Rect, fill: Option<Color>, stroke: Option<Stroke>) {
        self.shape(vec![[r.left, r.top], [r.right, r.top], [r.right, r.bottom], [r.left, r.bottom]], fill, stroke);
    }

    /// A circle or disc.
    pub(super) fn circle(&mut self, at: Point, radius: f64, fill: Option<Color>, stroke: Option<Stroke>) {
        self.items.push(Item::Circle { at, radius, fill, stroke });
    }

    /// The title in the middle above all, smaller if it is long, and without its middle if it is longer.
    pub(super) fn headline(&mut self, title: &str) {
        let room = self.width - 40.0;
        let size = (24.0 * room / font::width(title, 24.0).max(1.0)).clamp(18.0, 24.0);
        self.text([self.width / 2.0, 36.0], font::fitted_between(title, size, room), size, Anchor::Middle);
    }

    /// A line of text, level and without halo.
    pub(super) fn text(&mut self, at: Point, text: impl Into<String>, size: f64, anchor: Anchor) {
        self.items.push(Item::Text(Text { at, text: text.into(), size, color: INK, anchor, upright: false, halo: false }));
    }
}

/// `color` thinned with white: 1 is the colour itself, 0 is white.
pub(super) fn pale(color: Color, strength: f64) -> Color {
    color.map(|c| (255.0 - (255.0 - f64::from(c)) * strength).round().clamp(0.0, 255.0) as u8)
}

/// The colour of curve `index` of `count`: the palette, or, for many curves, a scale from dark blue to orange.
fn curve_color(index: usize, count: usize) -> Color {
    if count <= PALETTE.len() {
        return PALETTE[index % PALETTE.len()];
    }
    // Monotone in lightness, as cividis is, so that it keeps its order in grey and for every kind of colour vision. The page of the
    // report has the same (`viewer/src/page.css`). Rejected: cividis itself, whose middle is grey and whose end is pale on white.
    const SCALE: [Color; 5] = [[0, 32, 96], [10, 98, 168], [24, 132, 112], [169, 134, 0], [222, 118, 44]];
    let position = index as f64 / (count - 1) as f64 * (SCALE.len() - 1) as f64;
    let low = (position as usize).min(SCALE.len() - 2);
    let mix = position - low as f64;
    let channel = |k: usize| (f64::from(SCALE[low][k]) * (1.0 - mix) + f64::from(SCALE[low + 1][k]) * mix).round() as u8;
    [channel(0), channel(1), channel(2)]
}

/// How curve `index` of a figure with `count` curves is drawn, in whatever panel: its colour (red, green, blue), and lengths of dash, gap,
/// dash...; empty for a solid line. No two of a figure are alike.
#[must_use]
pub(super) fn curve_style(index: usize, count: usize) -> ([u8; 3], &'static [f64]) {
    (curve_color(index, count), curve_dash(index))
}

/// The dashes of curve `index`: with them curves differ in print without colour, too, and neighbours on a scale of colours as well. Those of
/// the page of the report are half as long (`viewer/src/plot/chart.ts`).
fn curve_dash(index: usize) -> &'static [f64] {
    const DASHES: [&[f64]; 7] =
        [&[], &[14.0, 7.0], &[3.0, 7.0], &[18.0, 6.0, 3.0, 6.0], &[8.0, 5.0], &[24.0, 8.0], &[14.0, 5.0, 3.0, 5.0, 3.0, 5.0]];
    DASHES[index % DASHES.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_curves_of_a_figure_are_alike() {
        for count in [1, 7, 8, 20, 500] {
            let styles: Vec<_> = (0..count).map(|index| curve_style(index, count)).collect();
            assert!((0..count).all(|i| !styles[..i].contains(&styles[i])), "{count}");
        }
    }

    #[test]
    fn the_scale_of_many_curves_becomes_lighter() {
        // CIE 1931, of sRGB
        let light = |color: Color| {
            let [r, g, b] = color.map(|c| ((f64::from(c) / 255.0 + 0.055) / 1.055).powf(2.4));
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let lights: Vec<_> = (0..40).map(|index| light(curve_color(index, 40))).collect();
        assert!(lights.windows(2).all(|pair| pair[1] > pair[0]), "{lights:?}");
    }
}
