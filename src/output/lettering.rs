//! Names beside what they name, where they cover least.

use super::font;
use super::scene::{Anchor, Color, Item, Rect, Scene, Text};
use super::thin::Point;

/// What a name may have to keep clear of, and how much that matters.
#[derive(Clone, Copy, Debug)]
pub(super) enum Obstacle {
    /// A part in its strong position.
    Body,
    /// A part in a pale position.
    Shade,
    /// A path.
    Path,
}

impl Obstacle {
    fn weight(self) -> f64 {
        match self {
            Self::Body => 14.0,
            Self::Shade => 3.0,
            Self::Path => 6.0,
        }
    }

    /// How far a name keeps from the middle of the line.
    fn reach(self) -> f64 {
        match self {
            Self::Path => 4.0,
            _ => super::symbols::BAR / 2.0 + 2.0,
        }
    }
}

/// The names placed so far, and all they keep clear of.
#[derive(Clone, Debug)]
pub(super) struct Lettering {
    sheet: Rect,
    samples: Vec<(Point, Obstacle)>,
    signs: Vec<Rect>,
    names: Vec<(Rect, Text)>,
}

impl Lettering {
    /// No names yet, to be placed within `sheet`.
    pub(super) fn new(sheet: Rect) -> Self {
        Self { sheet, samples: Vec::new(), signs: Vec::new(), names: Vec::new() }
    }

    /// Keeps clear of a line, sampled every few pixels.
    pub(super) fn avoid_line(&mut self, line: &[Point], obstacle: Obstacle) {
        self.samples.extend(line.first().map(|point| (*point, obstacle)));
        for ends in line.windows(2) {
            let [a, b] = [ends[0], ends[1]];
            let count = ((b[0] - a[0]).hypot(b[1] - a[1]) / 6.0).ceil().clamp(1.0, 1000.0) as u32;
            self.samples.extend((1..=count).map(|step| {
                let s = f64::from(step) / f64::from(count);
                ([a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])], obstacle)
            }));
        }
    }

    /// Keeps clear of a sign of the given half sizes, its middle shifted from `at`.
    pub(super) fn avoid(&mut self, at: Point, half: [f64; 2], shift: [f64; 2]) {
        let (x, y) = (at[0] + shift[0], at[1] + shift[1]);
        self.signs.push(Rect { left: x - half[0], top: y - half[1], right: x + half[0], bottom: y + half[1] });
    }

    /// Places `name` around the point `at`, at least `reach` from it; with no reach it may stand right on it.
    pub(super) fn name(&mut self, name: &str, at: Point, reach: f64, size: f64, color: Color) {
        let text = font::fitted(name, size, 0.4 * self.sheet.width());
        if text.is_empty() {
            return;
        }
        let (width, height) = (font::width(&text, size), size * font::CAPITAL);
        let around = |radius: f64, step: u32| {
            // From the right and upwards, where a name is looked for first.
            let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 16.0).sin_cos();
            let (dx, dy) = (cos * (radius + width / 2.0), -sin * (radius + height / 2.0));
            let (x, y) = (at[0] + dx, at[1] + dy);
            Rect { left: x - width / 2.0, top: y - height / 2.0, right: x + width / 2.0, bottom: y + height / 2.0 }
        };
        let radii = [reach, reach + 6.0, reach + 14.0, reach + 24.0, reach + 36.0, reach + 50.0];
        let places = radii.iter().enumerate().flat_map(|(ring, radius)| (0..16).map(move |step| (ring, *radius, step)));
        let rated = places.map(|(ring, radius, step)| {
            let area = if radius == 0.0 { centered(at, width, height) } else { around(radius, step) };
            // A diagonal place is as good as a level one; a distant one is a little worse.
            (self.cost(area) + 5.0 * ring as f64 + 0.1 * f64::from(step), area)
        });
        if let Some((_, area)) = rated.min_by(|a, b| a.0.total_cmp(&b.0)) {
            let at = [area.left, area.bottom];
            self.names.push((area, Text { at, text, size, color, anchor: Anchor::Start, upright: false, halo: true }));
        }
    }

    fn cost(&self, area: Rect) -> f64 {
        let outside = area.width() * area.height() - area.overlap(&self.sheet);
        let taken: f64 = self.names.iter().map(|(other, _)| area.grown(5.0).overlap(other)).sum();
        let signs: f64 = self.signs.iter().map(|sign| area.grown(2.0).overlap(sign)).sum();
        let lines = self.samples.iter().filter(|(point, obstacle)| area.grown(obstacle.reach()).contains(*point));
        outside + 10.0 * taken + signs + lines.map(|(_, obstacle)| obstacle.weight()).sum::<f64>()
    }

    /// Writes all names.
    pub(super) fn draw(self, scene: &mut Scene) {
        scene.items.extend(self.names.into_iter().map(|(_, text)| Item::Text(text)));
    }
}

fn centered([x, y]: Point, width: f64, height: f64) -> Rect {
    Rect { left: x - width / 2.0, top: y - height / 2.0, right: x + width / 2.0, bottom: y + height / 2.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_names_at_one_point_do_not_overlap() {
        let mut letters = Lettering::new(Rect { left: 0.0, top: 0.0, right: 400.0, bottom: 400.0 });
        letters.avoid_line(&[[0.0, 200.0], [400.0, 200.0]], Obstacle::Body);
        letters.name("first", [200.0, 200.0], 14.0, 20.0, [0; 3]);
        letters.name("second", [200.0, 200.0], 14.0, 20.0, [0; 3]);
        let [(a, _), (b, _)] = &letters.names[..] else { panic!("two names") };
        assert_eq!(a.overlap(b), 0.0);
        assert!(a.bottom < 200.0 || a.top > 200.0, "not on the line");
    }
}
