//! The legend: inside the panel where it hides no curve, else above it, or beside it if it is long.

use super::font;
use super::scene::{Anchor, Color, Rect, Scene, Stroke, WHITE};
use super::thin::Point;

const SIZE: f64 = 20.0;
const ROW: f64 = 29.0;
/// The line sample and the space after it.
const SAMPLE: f64 = 56.0;
const GAP: f64 = 12.0;
const PADDING: f64 = 12.0;
/// More entries than that stand beside the panel.
const MOST_INSIDE: usize = 8;

/// One line of a legend.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) label: String,
    pub(super) color: Color,
    pub(super) dash: &'static [f64],
    /// Whether it is of points without a line.
    pub(super) dots: bool,
}

/// A legend and where it stands.
#[derive(Clone, Debug)]
pub(super) enum Legend {
    /// With its left top corner at a point of the picture.
    Inside(Vec<Entry>, Point),
    /// In rows above the panel.
    Above(Vec<Entry>),
    /// In a column to the right.
    Beside(Vec<Entry>),
}

impl Entry {
    fn width(&self) -> f64 {
        SAMPLE + GAP + font::width(&self.label, SIZE)
    }

    fn draw(&self, scene: &mut Scene, [x, y]: Point) {
        if self.dots {
            [0.2, 0.5, 0.8].iter().for_each(|part| scene.circle([x + part * SAMPLE, y], 5.0, Some(self.color), None));
        } else {
            scene.line(vec![[x, y], [x + SAMPLE, y]], Stroke::dashed(self.color, 3.0, self.dash));
        }
        scene.text([x + SAMPLE + GAP, y + SIZE * font::CAPITAL / 2.0], &self.label, SIZE, Anchor::Start);
    }
}

/// The place for `entries` in a panel that shows the curves `pixels`.
pub(super) fn choose(mut entries: Vec<Entry>, panel: Rect, pixels: &[Vec<Point>]) -> Legend {
    if entries.is_empty() {
        return Legend::Inside(entries, [0.0; 2]);
    }
    for entry in &mut entries {
        entry.label = font::fitted(&entry.label, SIZE, panel.width() - SAMPLE - GAP);
    }
    let (width, height) = block(&entries);
    if entries.len() <= MOST_INSIDE && width < 0.6 * panel.width() && height < 0.7 * panel.height() {
        let margin = 10.0;
        let columns = [panel.right - margin - width, panel.left + margin, panel.center()[0] - width / 2.0];
        let rows = [panel.top + margin, panel.bottom - margin - height, panel.center()[1] - height / 2.0];
        let corners = rows.iter().flat_map(|y| columns.iter().map(move |x| [*x, *y]));
        let free = |[x, y]: &Point| {
            let area = Rect { left: *x, top: *y, right: x + width, bottom: y + height }.grown(6.0);
            !pixels.iter().any(|line| crosses(line, area))
        };
        // Corners before the sides, and never the very middle.
        let order = [0, 1, 3, 4, 2, 5, 6, 7];
        let corners: Vec<_> = corners.collect();
        if let Some(corner) = order.into_iter().filter_map(|index| corners.get(index)).find(|corner| free(corner)) {
            return Legend::Inside(entries, *corner);
        }
    }
    if rows(&entries, panel.width()).len() <= 3 {
        return Legend::Above(entries);
    }
    for entry in &mut entries {
        entry.label = font::fitted_between(&entry.label, SIZE, 0.3 * panel.width());
    }
    Legend::Beside(entries)
}

/// The size of a column of entries, with padding.
fn block(entries: &[Entry]) -> (f64, f64) {
    let widest = entries.iter().map(Entry::width).fold(0.0, f64::max);
    (widest + 2.0 * PADDING, entries.len() as f64 * ROW + PADDING)
}

/// Whether a line passes through `area`, looked at every few pixels.
pub(super) fn crosses(line: &[Point], area: Rect) -> bool {
    line.first().is_some_and(|point| area.contains(*point))
        || line.windows(2).any(|ends| {
            let [a, b] = [ends[0], ends[1]];
            let count = ((b[0] - a[0]).hypot(b[1] - a[1]) / 4.0).ceil().clamp(1.0, 2000.0) as u32;
            (1..=count).any(|step| {
                let s = f64::from(step) / f64::from(count);
                area.contains([a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])])
            })
        })
}

/// The entries in rows no wider than `room`.
fn rows(entries: &[Entry], room: f64) -> Vec<Vec<&Entry>> {
    let mut rows: Vec<Vec<&Entry>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in entries {
        used += entry.width() + 28.0;
        match rows.last_mut().filter(|_| used <= room + 28.0) {
            Some(row) => row.push(entry),
            None => {
                rows.push(vec![entry]);
                used = entry.width() + 28.0;
            }
        }
    }
    rows
}

impl Legend {
    pub(super) fn is_inside(&self) -> bool {
        matches!(self, Self::Inside(..))
    }

    /// What it takes above a panel about `room` wide.
    pub(super) fn height(&self, room: f64) -> f64 {
        if let Self::Above(entries) = self { rows(entries, room).len() as f64 * ROW + 6.0 } else { 0.0 }
    }

    /// What it takes beside the panel.
    pub(super) fn width(&self) -> f64 {
        if let Self::Beside(entries) = self { block(entries).0 } else { 0.0 }
    }

    /// Draws it in or around `panel`, on whose right an axis takes `side`.
    pub(super) fn draw(&self, scene: &mut Scene, panel: Rect, side: f64) {
        match self {
            Self::Inside(entries, _) if entries.is_empty() => {}
            Self::Inside(entries, [x, y]) => {
                let (width, height) = block(entries);
                let area = Rect { left: *x, top: *y, right: x + width, bottom: y + height };
                scene.rect(area, Some(WHITE), Some(Stroke::solid([205, 205, 205], 1.0)));
                for (index, entry) in entries.iter().enumerate() {
                    entry.draw(scene, [x + PADDING, y + PADDING / 2.0 + (index as f64 + 0.5) * ROW]);
                }
            }
            Self::Above(entries) => {
                let rows = rows(entries, panel.width());
                for (index, row) in rows.iter().enumerate() {
                    let y = panel.top - 6.0 - (rows.len() - index) as f64 * ROW + ROW / 2.0;
                    let mut x = panel.left;
                    for entry in row {
                        entry.draw(scene, [x, y]);
                        x += entry.width() + 28.0;
                    }
                }
            }
            Self::Beside(entries) => {
                let most = ((panel.height() / ROW) as usize).max(2);
                let left = panel.right + PADDING + side;
                let shown = if entries.len() > most { most - 1 } else { entries.len() };
                // Of too many, evenly chosen ones: their colours are a scale.
                let chosen = (0..shown).map(|k| k * (entries.len() - 1) / (shown - 1).max(1));
                for (row, entry) in chosen.filter_map(|index| entries.get(index)).enumerate() {
                    entry.draw(scene, [left, panel.top + (row as f64 + 0.5) * ROW]);
                }
                if shown < entries.len() {
                    let y = panel.top + (shown as f64 + 0.5) * ROW + SIZE * font::CAPITAL / 2.0;
                    scene.text([left, y], format!("({shown} of {} named)", entries.len()), SIZE, Anchor::Start);
                }
            }
        }
    }
}
