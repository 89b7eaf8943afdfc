//! A display list as pixels by the area that each shape covers of each pixel.
//!
//! For each edge of a polygon the part of each pixel to its right is added up in differences along the row, so that one sum over a
//! row gives the covered areas (as font renderers do it). It takes a time that goes with the area of a shape, not with samples.

use crate::output::font;
use crate::output::raster::dashes;
use crate::output::scene::{Anchor, Color, Item, Stroke, Text, WHITE};
use crate::output::thin::Point;
use std::f64::consts::{PI, TAU};

/// Pixels, and how many of them go on one of the display list.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Red, green, blue, row by row.
    pub(super) pixels: Vec<u8>,
    scale: f64,
    /// Differences of areas; zero between shapes.
    areas: Vec<f32>,
}

/// Columns and rows that a shape may touch: from, below which.
#[derive(Clone, Copy, Debug)]
struct Window {
    x: [usize; 2],
    y: [usize; 2],
}

impl Canvas {
    /// White paper.
    pub(super) fn new(width: usize, height: usize, scale: f64) -> Self {
        Self { width, height, pixels: vec![255; 3 * width * height], scale, areas: Vec::new() }
    }

    /// Paints an item.
    pub(super) fn item(&mut self, item: &Item) {
        match item {
            Item::Path { points, closed, fill, stroke } => {
                let points = self.scaled(points);
                if let Some(color) = fill {
                    self.fill(std::slice::from_ref(&points), *color, 1.0);
                }
                if let Some(stroke) = stroke {
                    self.stroke(points, *closed, *stroke);
                }
            }
            Item::Circle { at, radius, fill, stroke } => {
                let at = at.map(|x| x * self.scale);
                let half = stroke.map_or(0.0, |stroke| 0.5 * stroke.width);
                if let Some(stroke) = stroke {
                    self.fill(&[disc(at, (radius + half) * self.scale)], stroke.color, 1.0);
                }
                // the inside of an open circle is the paper's
                if let Some(color) = fill.or(stroke.map(|_| WHITE)).filter(|_| *radius > half) {
                    self.fill(&[disc(at, (radius - half) * self.scale)], color, 1.0);
                }
            }
            Item::Veil { points, color, opacity } => self.fill(&[self.scaled(points)], *color, *opacity as f32),
            Item::Text(text) => self.text(text),
        }
    }

    fn scaled(&self, points: &[Point]) -> Vec<Point> {
        points.iter().map(|p| p.map(|x| (x * self.scale).clamp(-1e6, 1e6))).collect()
    }

    fn stroke(&mut self, mut points: Vec<Point>, closed: bool, stroke: Stroke) {
        let half = 0.5 * stroke.width * self.scale;
        let lengths: Vec<f64> = stroke.dash.iter().map(|length| length * self.scale).collect();
        points.dedup();
        if closed {
            while points.len() > 1 && points.last() == points.first() {
                points.pop();
            }
            points.extend(points.first().copied());
        }
        let solid = lengths.is_empty();
        let mut shapes = Vec::new();
        for line in dashes(&points, &lengths) {
            outline(&line, half, solid, closed && solid, &mut shapes);
        }
        self.fill(&shapes, stroke.color, 1.0);
    }

    /// Fills the union of polygons.
    fn fill(&mut self, shapes: &[Vec<Point>], color: Color, opacity: f32) {
        let Some(window) = self.window(shapes.iter().flatten()) else { return };
        let wide = window.x[1] - window.x[0] + 2;
        self.areas.clear();
        self.areas.resize(wide * (window.y[1] - window.y[0]), 0.0);
        for shape in shapes {
            let ends = shape.iter().zip(shape.iter().cycle().skip(1));
            let area: f64 = ends.clone().map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
            for (a, b) in ends {
                if area < 0.0 { self.edge(*b, *a, &window) } else { self.edge(*a, *b, &window) }
            }
        }
        for (row, areas) in self.areas.chunks_exact(wide).enumerate() {
            let from = 3 * ((window.y[0] + row) * self.width + window.x[0]);
            let mut area = 0.0;
            for (pixel, change) in self.pixels[from..].chunks_exact_mut(3).zip(&areas[..wide - 2]) {
                area += change;
                if area > 0.002 {
                    blend(pixel, color, opacity * area.min(1.0));
                }
            }
        }
    }

    fn window<'p>(&self, points: impl Iterator<Item = &'p Point>) -> Option<Window> {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for p in points {
            for i in 0..2 {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
            }
        }
        let end = [self.width, self.height];
        let range = |i: usize| [low[i].floor().clamp(0.0, end[i] as f64) as usize, high[i].ceil().clamp(0.0, end[i] as f64) as usize];
        let (x, y) = (range(0), range(1));
        (x[0] < x[1] && y[0] < y[1]).then_some(Window { x, y })
    }

    /// Adds what lies to the right of an edge; an edge downwards takes it away.
    fn edge(&mut self, a: Point, b: Point, window: &Window) {
        let (sense, top, bottom) = if a[1] < b[1] { (-1.0, a, b) } else { (1.0, b, a) };
        let (rows, wide) = (window.y, window.x[1] - window.x[0]);
        if top[1] == bottom[1] || bottom[1] <= rows[0] as f64 {
            return;
        }
        let slope = (bottom[0] - top[0]) / (bottom[1] - top[1]);
        let first = top[1].max(rows[0] as f64);
        let inside = |x: f64| (x - window.x[0] as f64).clamp(0.0, wide as f64);
        for row in first.floor() as usize..bottom[1].ceil().min(rows[1] as f64) as usize {
            let (y0, y1) = (first.max(row as f64), bottom[1].min((row + 1) as f64));
            let (x0, x1) = (inside(top[0] + slope * (y0 - top[1])), inside(top[0] + slope * (y1 - top[1])));
            let start = (row - rows[0]) * (wide + 2);
            spread(&mut self.areas[start..start + wide + 2], x0.min(x1), x0.max(x1), sense * (y1 - y0));
        }
    }

    fn text(&mut self, text: &Text) {
        let size = text.size * self.scale;
        let width = font::width(&text.text, size);
        let back = match text.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5 * width,
            Anchor::End => width,
        };
        let from = [(text.at[0] * self.scale - back).round() as i64, (text.at[1] * self.scale).round() as i64];
        let (width, height) = (self.width as i64, self.height as i64);
        font::paint(&text.text, size, |x, y, coverage| {
            let (x, y) = (from[0] + i64::from(x), from[1] + i64::from(y));
            if (0..width).contains(&x) && (0..height).contains(&y) {
                let at = 3 * (y * width + x) as usize;
                blend(&mut self.pixels[at..at + 3], text.color, coverage.min(1.0));
            }
        });
    }
}

fn blend(pixel: &mut [u8], color: Color, part: f32) {
    for (old, new) in pixel.iter_mut().zip(color) {
        *old = (f32::from(*old) + part * (f32::from(new) - f32::from(*old)) + 0.5) as u8;
    }
}

/// Adds to the differences of a row the area to the right of a straight edge from x0 to x1 ≥ x0, which covers `height` of the row.
fn spread(row: &mut [f32], x0: f64, x1: f64, height: f64) {
    let first = x0 as usize;
    let last = (x1.ceil() as usize).max(first + 1);
    if last == first + 1 {
        let right = height * (0.5 * (x0 + x1) - first as f64);
        row[first] += (height - right) as f32;
        row[first + 1] += right as f32;
        return;
    }
    // the area to the right of the edge within the columns up to x, as a function of x
    let per = height / (x1 - x0);
    let mut before = 0.0;
    let mut covered = 0.0;
    for (column, change) in row.iter_mut().enumerate().take(last).skip(first) {
        let (from, to) = (x0.max(column as f64), x1.min((column + 1) as f64));
        // the mean height of the part of the column behind the edge
        let area = covered + per * (to - from) * ((column + 1) as f64 - 0.5 * (from + to));
        covered += per * (to - from);
        *change += (area - before) as f32;
        before = area;
    }
    row[last] += (height - before) as f32;
}

fn disc(at: Point, radius: f64) -> Vec<Point> {
    // within a twentieth of a pixel of the circle
    let count = (10.0 * radius.sqrt()).clamp(12.0, 400.0).ceil();
    (0..count as usize).map(|k| on_circle(at, radius, TAU * k as f64 / count)).collect()
}

fn on_circle(at: Point, radius: f64, angle: f64) -> Point {
    let (s, c) = angle.sin_cos();
    [at[0] + radius * c, at[1] + radius * s]
}

/// A line as quadrilaterals, with sectors on the outer side of its corners and, if they are `round`, at its ends.
fn outline(line: &[Point], half: f64, round: bool, closed: bool, shapes: &mut Vec<Vec<Point>>) {
    let angles: Vec<f64> = line.windows(2).map(|ends| (ends[1][1] - ends[0][1]).atan2(ends[1][0] - ends[0][0])).collect();
    for (ends, angle) in line.windows(2).zip(&angles) {
        let (s, c) = angle.sin_cos();
        let side = |p: Point, side: f64| [p[0] - side * half * s, p[1] + side * half * c];
        shapes.push(vec![side(ends[0], 1.0), side(ends[1], 1.0), side(ends[1], -1.0), side(ends[0], -1.0)]);
    }
    let mut corner = |at: Point, before: f64, behind: f64| {
        let turn = (behind - before + PI).rem_euclid(TAU) - PI;
        // the outer side is away from the turn
        let outer = before - turn.signum() * 0.5 * PI;
        sector(at, half, outer, turn, shapes);
    };
    if half > 0.4 {
        line.iter().skip(1).zip(angles.windows(2)).for_each(|(at, pair)| corner(*at, pair[0], pair[1]));
        if let (true, Some(first), Some(last)) = (closed, angles.first(), angles.last()) {
            corner(line[0], *last, *first);
        }
    }
    if let (true, false, Some(first), Some(last)) = (round, closed, angles.first(), angles.last()) {
        sector(line[0], half, first + 0.5 * PI, PI, shapes);
        sector(line[line.len() - 1], half, last - 0.5 * PI, PI, shapes);
    } else if let (true, [only]) = (round, line) {
        shapes.push(disc(*only, half));
    }
}

/// A sector of a circle.
fn sector(at: Point, radius: f64, from: f64, turn: f64, shapes: &mut Vec<Vec<Point>>) {
    if turn.abs() < 1e-3 {
        return;
    }
    let count = (1.6 * turn.abs() * radius.sqrt()).ceil().max(1.0);
    let arc = (0..=count as usize).map(|k| on_circle(at, radius, from + turn * k as f64 / count));
    shapes.push(std::iter::once(at).chain(arc).collect());
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How dark a canvas is, in whole black pixels.
    fn ink(canvas: &Canvas) -> f64 {
        canvas.pixels.iter().map(|x| f64::from(255 - *x) / 255.0).sum::<f64>() / 3.0
    }

    #[test]
    fn shapes_cover_their_area() {
        let triangle = vec![[2.3, 1.2], [17.9, 6.4], [5.5, 18.1]];
        let area = 0.5 * ((17.9f64 - 2.3) * (18.1 - 1.2) - (6.4 - 1.2) * (5.5 - 2.3));
        for points in [triangle.clone(), triangle.into_iter().rev().collect()] {
            let mut canvas = Canvas::new(20, 20, 1.0);
            canvas.fill(&[points], [0; 3], 1.0);
            assert!((ink(&canvas) - area).abs() < 0.1, "{} not {area}", ink(&canvas));
        }
        let mut canvas = Canvas::new(20, 20, 1.0);
        canvas.item(&Item::Veil { points: vec![[0.0; 2], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]], color: [0; 3], opacity: 0.4 });
        assert!((ink(&canvas) - 40.0).abs() < 0.2, "{}", ink(&canvas));
        let mut canvas = Canvas::new(40, 40, 1.0);
        canvas.fill(&[disc([20.0, 20.0], 10.0)], [0; 3], 1.0);
        assert!((ink(&canvas) / (PI * 100.0) - 1.0).abs() < 0.02, "{}", ink(&canvas));
    }

    #[test]
    fn what_leaves_the_paper_is_cut_off() {
        let mut canvas = Canvas::new(10, 10, 1.0);
        canvas.fill(&[vec![[5.0, -20.0], [40.0, -20.0], [40.0, 30.0], [5.0, 30.0]]], [0; 3], 1.0);
        assert_eq!(ink(&canvas).round(), 50.0);
        canvas.fill(&[vec![[50.0, 0.0], [60.0, 0.0], [60.0, 5.0]]], [0; 3], 1.0);
        let slant = vec![[-100.0, -100.0], [100.0, 100.0], [-100.0, 100.0]];
        let mut canvas = Canvas::new(10, 10, 1.0);
        canvas.fill(&[slant], [0; 3], 1.0);
        assert!((ink(&canvas) - 50.0).abs() < 0.2, "{}", ink(&canvas));
    }

    #[test]
    fn corners_of_a_line_are_round() {
        let mut canvas = Canvas::new(60, 60, 1.0);
        canvas.item(&Item::Path {
            points: vec![[20.0, 40.0], [40.0, 40.0], [40.0, 20.0]],
            closed: false,
            fill: None,
            stroke: Some(Stroke::solid([0; 3], 10.0)),
        });
        // two bars less their common quarter, a quarter disc at the corner, two half discs at the ends
        let area = 400.0 - 25.0 + 1.25 * PI * 25.0;
        assert!((ink(&canvas) / area - 1.0).abs() < 0.02, "{} not {area}", ink(&canvas));
    }
}
