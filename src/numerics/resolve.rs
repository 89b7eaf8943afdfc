//! A curve resolved: panels so narrow that the polynomial on each of them is the curve, to a stated part of each column's size.
//!
//! What an extreme, an integral or a first place is looked for on must not depend on where rows are asked for. Panels are halved
//! until the polynomial through fifteen values leaves out less than `width` of the largest magnitude of every column (or less than
//! its round-off, which is measured). Work goes level by level, so that a place that cannot be resolved takes nothing from the
//! others; what is left when the effort is spent is named in [`Resolved::open`].

use super::continuous::Curve;
use super::panel::{Basis, NODES, Panel, noise};
use super::samples::{Between, Samples};
use serde::{Deserialize, Serialize};

/// How far the columns of a motion are resolved: what extremes, means and integrals are taken of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Resolution {
    /// Part of a column's largest magnitude that may be left out between known values.
    pub width: f64,
    /// Columns that are not resolved so far somewhere.
    pub open: usize,
    /// Evaluations of the motion for it.
    pub evaluations: usize,
}

/// Equal stretches of a range that panels begin with, at least: what is narrower than their nodes lie apart, 0.4 % of the range,
/// and vanishes at all of them, is not seen.
pub(crate) const FIRST_PANELS: usize = 24;

/// Evaluations at most, unless the first panels take more.
pub(crate) const MOST_EVALUATIONS: usize = 500_000;

/// Panels narrower than this part of the range are not halved: they hold a jump.
const NARROWEST: f64 = 1e-10;

/// The same for the edge of what is defined.
const EDGE: f64 = 1e-7;

/// A part of the range in which places need not be reached.
pub(crate) const NEXT_TO: f64 = 1e-3;

/// A column may leave out this part of its size on a narrow panel, as a square root does at its begin.
const STEEP: f64 = 1e-3;

/// A column that changes by more than the last part of its size within panels narrower than the first part of an integrator's step,
/// which together are narrower than the second part of it, is not to be trusted there.
const FINE: f64 = 1.0 / 256.0;
const LOCAL: f64 = 1.0 / 8.0;
const MUCH: f64 = 0.1;

/// Values that differ by so many times the round-off are still the same.
const ROUND_OFF: f64 = 64.0;

/// Places of a range, as parts of it, where round-off is measured first.
const MEASURED: [f64; 3] = [0.1178, 0.4337, 0.7963];

/// So many stretches are worth a trial of how narrow panels must be, which halves them so many times at most.
const MANY: usize = 30;
const DEEPEST: usize = 4;

/// Panels that are at most so many steps of an integrator wide, and at most this part of the first panels of any curve, are first
/// looked at in every second place.
const STEPS: f64 = 1.5;
const PART: f64 = 0.5;

/// Repeated evaluations lie this part of the range apart.
const APART: f64 = 1e-11;

/// A column that could not be resolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Open {
    /// The column.
    pub column: usize,
    /// Where it is worst.
    pub at: f64,
    /// What is left out there, in units of the column.
    pub left: f64,
    /// Largest magnitude of the column.
    pub size: f64,
    /// Whether it is next to a singular position, where a straight line was taken between what is known on either side.
    pub singular: bool,
    /// It grows without bound there: so far from the place on either side a straight line was taken.
    pub pole: Option<f64>,
}

/// A resolved curve.
#[derive(Clone, Debug, Default)]
pub struct Resolved {
    /// The panels, rising; none reaches over a break.
    pub(crate) panels: Vec<Panel>,
    /// The places at which values are known: nodes of panels and ends of pieces, rising.
    pub places: Vec<f64>,
    /// The piece of each.
    pub pieces: Vec<usize>,
    /// Column after column (columns × places).
    values: Vec<f64>,
    /// Round-off of each column, as far as it counts.
    pub(crate) noise: Vec<f64>,
    /// Columns that are not resolved, each once.
    pub open: Vec<Open>,
    /// To what part of its size each column is resolved.
    pub width: f64,
    /// Evaluations of the curve.
    pub evaluations: usize,
}

impl Resolved {
    /// The known values for a search of extremes.
    pub fn samples(&self) -> Samples<'_> {
        let between = Between { panels: &self.panels, width: self.width, noise: &self.noise };
        Samples { places: &self.places, pieces: &self.pieces, values: &self.values, between: Some(between) }
    }

    /// Places where a column has no value, with their pieces, rising.
    pub(crate) fn blanks(&self) -> impl Iterator<Item = (f64, usize)> + '_ {
        let n = self.places.len();
        let blank = move |i: &usize| self.values[*i..].iter().step_by(n).any(|y| !y.is_finite());
        (0..n).filter(blank).map(|i| (self.places[i], self.pieces[i]))
    }

    /// Notes that a column is a straight line at a place, between values of a size at most: within `pole` of it since it grows without
    /// bound, else since it is not known.
    pub(crate) fn note_line(&mut self, column: usize, at: f64, size: f64, pole: Option<f64>) {
        self.open.retain(|open| open.column != column);
        self.open.push(Open { column, at, left: size, size, singular: true, pole });
    }

    /// How well, for a certificate.
    pub(crate) fn quality(&self) -> Resolution {
        Resolution { width: self.width, open: self.open.len(), evaluations: self.evaluations }
    }
}

/// Equal stretches of each piece for a curve of which nothing else is known.
pub(crate) fn stretches(breaks: &[f64]) -> Vec<(f64, f64, usize)> {
    let whole = breaks.last().zip(breaks.first()).map_or(0.0, |(to, from)| to - from);
    let mut all = Vec::new();
    for (piece, ends) in breaks.windows(2).enumerate() {
        let width = ends[1] - ends[0];
        let parts = (FIRST_PANELS as f64 * width / whole).ceil().clamp(0.0, FIRST_PANELS as f64) as usize;
        let at = |k: usize| if k == parts { ends[1] } else { ends[0] + width * k as f64 / parts as f64 };
        all.extend((0..parts).map(|k| (at(k), at(k + 1), piece)));
    }
    all
}

/// A panel that may have to be halved.
struct Waiting {
    panel: Panel,
    /// How often it has been halved.
    depth: usize,
}

/// Resolves a curve that is evaluated on `stretches` (from, to, piece) first, or on parts of them; see [`resolve`].
///
/// # Errors
/// As there.
pub(crate) fn on<C: Curve>(curve: &mut C, stretches: &[(f64, f64, usize)], breaks: &[f64], width: f64) -> Result<Resolved, C::Error> {
    let Some(mut work) = Work::new(curve, breaks, width)? else { return Ok(Resolved::default()) };
    let depth = work.try_some(stretches)?;
    let mut panels = Vec::with_capacity(stretches.len() << depth);
    let mut parts = Vec::with_capacity(1 << depth);
    for &(from, to, piece) in stretches {
        parts.clear();
        parts.push((from, to));
        for _ in 0..depth {
            for i in (0..parts.len()).rev() {
                let (from, to) = parts[i];
                let middle = work.curve.middle(from, to, piece);
                parts.splice(i..=i, [(from, middle), (middle, to)]);
            }
        }
        for &(from, to) in &parts {
            match work.panel(from, to, piece) {
                Ok(panel) => panels.push(panel),
                // next to a dead point, where steps have become short, places can no longer be reached
                Err(_) if to - from < NEXT_TO * work.range => {}
                Err(lost) => return Err(lost),
            }
        }
    }
    work.resolve(panels)
}

/// Resolves a curve that is evaluated on `panels` already, to `width` of each column's size.
///
/// # Errors
/// If the curve cannot be evaluated somewhere.
pub(crate) fn resolve<C: Curve>(curve: &mut C, panels: Vec<Panel>, breaks: &[f64], width: f64) -> Result<Resolved, C::Error> {
    let Some(mut work) = Work::new(curve, breaks, width)? else { return Ok(Resolved::default()) };
    work.evaluations += panels.len() * NODES;
    panels.iter().for_each(|panel| work.sized(panel));
    work.resolve(panels)
}

struct Work<'a, C: Curve> {
    curve: &'a mut C,
    basis: Basis,
    range: f64,
    breaks: &'a [f64],
    width: f64,
    /// Largest magnitude of each column.
    size: Vec<f64>,
    noise: Vec<f64>,
    open: Vec<Option<Open>>,
    evaluations: usize,
}

impl<'a, C: Curve> Work<'a, C> {
    /// With the round-off of columns; none without a range.
    fn new(curve: &'a mut C, breaks: &'a [f64], width: f64) -> Result<Option<Self>, C::Error> {
        let columns = curve.columns();
        let [Some(&from), Some(&to)] = [breaks.first(), breaks.last()] else { return Ok(None) };
        let mut work = Self {
            curve,
            basis: Basis::new(),
            range: to - from,
            breaks,
            width,
            size: vec![0.0; columns],
            noise: vec![0.0; columns],
            open: vec![None; columns],
            evaluations: 0,
        };
        for part in MEASURED {
            let at = from + part * (to - from);
            let piece = breaks.partition_point(|b| *b <= at).clamp(1, breaks.len() - 1) - 1;
            if at - breaks[piece] > 4.0 * APART * work.range && breaks[piece + 1] - at > 4.0 * APART * work.range {
                work.measure(at, piece)?;
            }
        }
        Ok(Some(work))
    }

    /// How often stretches are halved until they are resolved: the middle one of what some of many take.
    fn try_some(&mut self, stretches: &[(f64, f64, usize)]) -> Result<usize, C::Error> {
        if stretches.len() < MANY {
            return Ok(0);
        }
        let mut tried = Vec::with_capacity(MEASURED.len());
        for part in MEASURED {
            let (from, to, piece) = stretches[(part * stretches.len() as f64) as usize];
            // what cannot be evaluated is met again where it matters
            let Ok(panel) = self.panel(from, to, piece) else { return Ok(0) };
            tried.push(panel);
        }
        let mut depths = [0; MEASURED.len()];
        for (mut panel, depth) in tried.into_iter().zip(&mut depths) {
            while *depth < DEEPEST && !self.resolved(&panel) {
                let middle = self.curve.middle(panel.from, panel.to, panel.piece);
                let Ok(half) = self.panel(panel.from, middle, panel.piece) else { return Ok(0) };
                (panel, *depth) = (half, *depth + 1);
            }
        }
        depths.sort_unstable();
        Ok(depths[depths.len() / 2])
    }

    /// Halves panels until they are resolved.
    fn resolve(mut self, panels: Vec<Panel>) -> Result<Resolved, C::Error> {
        let most = MOST_EVALUATIONS.max(4 * NODES * panels.len());
        let mut level: Vec<Waiting> = panels.into_iter().map(|panel| Waiting { panel, depth: 0 }).collect();
        let mut done = Vec::new();
        while !level.is_empty() {
            let mut next = Vec::new();
            for waiting in level {
                match self.halve(waiting, most)? {
                    Ok(halves) => next.extend(halves),
                    Err(panel) => done.push(panel),
                }
            }
            level = next;
        }
        done.sort_by(|a, b| (a.piece, a.from).partial_cmp(&(b.piece, b.from)).unwrap_or(std::cmp::Ordering::Equal));
        self.doubt(&mut done);
        self.finish(done)
    }

    /// A panel, with less work where a step of an integrator is as wide: the motion is smooth on it.
    fn panel(&mut self, from: f64, to: f64, piece: usize) -> Result<Panel, C::Error> {
        let width = to - from;
        let spares = width <= PART * self.range / FIRST_PANELS as f64 && width <= STEPS * self.curve.smooth(0.5 * (from + to), piece);
        let Self { curve, basis, size, noise, width, .. } = self;
        let (panel, spared) = if spares {
            Panel::sparing(*curve, basis, (from, to, piece), |values, c| {
                let size = values.iter().fold(size[c], |m, y| f64::max(m, y.abs()));
                f64::max(*width * size, ROUND_OFF * noise[c])
            })?
        } else {
            (Panel::of(*curve, from, to, piece)?, false)
        };
        self.evaluations += if spared { NODES / 2 + 1 } else { NODES };
        self.sized(&panel);
        Ok(panel)
    }

    /// Takes the values of a panel into the sizes of columns.
    fn sized(&mut self, panel: &Panel) {
        for row in panel.values.chunks_exact(self.size.len().max(1)) {
            for (size, y) in self.size.iter_mut().zip(row).filter(|(_, y)| y.is_finite()) {
                *size = size.max(y.abs());
            }
        }
    }

    /// Takes the round-off at a place into that of the columns.
    fn measure(&mut self, at: f64, piece: usize) -> Result<(), C::Error> {
        let found = noise(self.curve, at, APART * self.range, piece)?;
        self.evaluations += 7;
        for (noise, found) in self.noise.iter_mut().zip(found).filter(|(_, f)| f.is_finite()) {
            *noise = noise.max(found);
        }
        Ok(())
    }

    /// Both halves of a panel that is not resolved, or the panel.
    fn halve(&mut self, waiting: Waiting, most: usize) -> Result<Result<[Waiting; 2], Panel>, C::Error> {
        let Waiting { panel, depth } = waiting;
        if self.resolved(&panel) {
            return Ok(Err(panel));
        }
        // round-off may be larger here than where it was measured
        let exhausted = self.evaluations + 2 * NODES > most;
        if !exhausted && depth > 0 && depth.is_multiple_of(4) && panel.width() > 16.0 * APART * self.range {
            self.measure(panel.from + MEASURED[1] * panel.width(), panel.piece)?;
            if self.resolved(&panel) {
                return Ok(Err(panel));
            }
        }
        let narrow = panel.width() <= NARROWEST * self.range;
        if narrow || exhausted {
            self.leave(&panel, narrow);
            return Ok(Err(panel));
        }
        let middle = self.curve.middle(panel.from, panel.to, panel.piece);
        let halves = match (self.panel(panel.from, middle, panel.piece), self.panel(middle, panel.to, panel.piece)) {
            (Ok(first), Ok(second)) => [first, second],
            // next to a dead point places can no longer be reached
            (Err(_), _) | (_, Err(_)) if panel.width() < NEXT_TO * self.range => {
                self.leave(&panel, false);
                return Ok(Err(panel));
            }
            (Err(lost), _) | (_, Err(lost)) => return Err(lost),
        };
        Ok(Ok(halves.map(|panel| Waiting { panel, depth: depth + 1 })))
    }

    /// What the polynomial on a panel leaves out of a column, if it is more than allowed; infinite at the edge of what is defined.
    fn left(&self, panel: &Panel, column: usize) -> Option<f64> {
        let values = panel.column(column);
        let left = match values.iter().filter(|y| !y.is_finite()).count() {
            0 => self.basis.tail(&values),
            NODES => 0.0,
            _ if panel.width() <= EDGE * self.range => 0.0,
            _ => f64::INFINITY,
        };
        let size = self.size[column];
        if size <= self.curve.floor(column) {
            return None;
        }
        // at the end of a piece a column may begin as a root does: steep, but without an extreme, and of no weight in an integral
        let [from, to] = [self.breaks[panel.piece], self.breaks[panel.piece + 1]];
        let at_end = panel.from == from || panel.to == to;
        if at_end && left <= STEEP * size && left * panel.width() <= self.width * size * self.range {
            return None;
        }
        (left > f64::max(self.width * size, ROUND_OFF * self.noise[column])).then_some(left)
    }

    fn resolved(&self, panel: &Panel) -> bool {
        (0..self.size.len()).all(|c| self.left(panel, c).is_none())
    }

    /// Notes the columns that a panel leaves open. The narrowest ones may hold a jump, or the steep begin of a root.
    fn leave(&mut self, panel: &Panel, narrow: bool) {
        for column in 0..self.size.len() {
            let Some(left) = self.left(panel, column) else { continue };
            let harmless = narrow && (left <= STEEP * self.size[column] || jumps(&panel.column(column)));
            if !harmless && self.open[column].is_none_or(|open| left > open.left) {
                self.open[column] = Some(Open { column, at: 0.5 * (panel.from + panel.to), left, size: 0.0, singular: false, pole: None });
            }
        }
    }

    /// Leaves columns open that change by much within a small part of a step of an integrator, and not beside: the step does not
    /// know of it. So do reactions next to a singular position, which they multiply the errors of the state by.
    fn doubt(&mut self, panels: &mut [Panel]) {
        let narrow = |p: &Panel, curve: &C| p.width() < FINE * curve.smooth(0.5 * (p.from + p.to), p.piece);
        let mut open: Vec<Open> = Vec::new();
        let mut begin = 0;
        while begin < panels.len() {
            let piece = panels[begin].piece;
            let rest = &panels[begin..];
            let end = begin + rest.iter().take_while(|p| p.piece == piece && narrow(p, self.curve)).count().max(1);
            let run = begin..end;
            begin = end;
            let [from, to] = [panels[run.start].from, panels[end - 1].to];
            let at = 0.5 * (from + to);
            if !narrow(&panels[run.start], self.curve) || to - from > LOCAL * self.curve.smooth(at, piece) {
                continue;
            }
            for column in 0..self.size.len() {
                let values: Vec<f64> = panels[run.clone()].iter().flat_map(|p| p.column(column)).collect();
                let [least, most] = [f64::min, f64::max].map(|f| values.iter().copied().fold(values[0], f));
                let round_off = self.size[column] <= self.curve.floor(column);
                if most - least > MUCH * self.size[column] && !jumps(&values) && !round_off {
                    let singular = self.curve.singular(at, piece);
                    open.push(Open { column, at, left: most - least, size: 0.0, singular, pole: None });
                    if singular {
                        straighten(panels, run.clone(), column);
                    }
                }
            }
        }
        for found in open {
            if self.open[found.column].is_none_or(|known| found.left > known.left) {
                self.open[found.column] = Some(found);
            }
        }
    }

    /// Adds the ends of pieces.
    fn finish(self, panels: Vec<Panel>) -> Result<Resolved, C::Error> {
        let (columns, breaks) = (self.size.len(), self.breaks);
        let n = panels.len() * NODES + 2 * (breaks.len() - 1);
        let mut found = Resolved { values: vec![0.0; n * columns], noise: self.noise, width: self.width, ..Resolved::default() };
        let mut out = vec![0.0; columns];
        let add = |found: &mut Resolved, at: f64, piece: usize, row: &[f64]| {
            let i = found.places.len();
            row.iter().enumerate().for_each(|(c, y)| found.values[c * n + i] = *y);
            found.places.push(at);
            found.pieces.push(piece);
        };
        let mut rest = &panels[..];
        for (piece, ends) in breaks.windows(2).enumerate() {
            let (own, others) = rest.split_at(rest.partition_point(|p| p.piece == piece));
            rest = others;
            self.curve.eval(ends[0], piece, &mut out)?;
            add(&mut found, ends[0], piece, &out);
            for panel in own {
                for (j, row) in panel.values.chunks_exact(columns.max(1)).enumerate() {
                    add(&mut found, panel.place(j), piece, row);
                }
            }
            self.curve.eval(ends[1], piece, &mut out)?;
            add(&mut found, ends[1], piece, &out);
        }
        found.evaluations = self.evaluations + 2 * (breaks.len() - 1);
        let size = self.size;
        found.open = self.open.into_iter().flatten().map(|open| Open { size: size[open.column], ..open }).collect();
        found.noise.iter_mut().for_each(|noise| *noise *= ROUND_OFF);
        found.panels = panels;
        Ok(found)
    }
}

/// Puts a straight line in the place of a column on panels of a run, between its neighbours of the same piece.
fn straighten(panels: &mut [Panel], run: std::ops::Range<usize>, column: usize) {
    let piece = panels[run.start].piece;
    let beside = |k: Option<usize>, j: usize| {
        let panel = panels.get(k?).filter(|p| p.piece == piece)?;
        Some((panel.place(j), panel.column(column)[j]))
    };
    let (before, after) = (beside(run.start.checked_sub(1), NODES - 1), beside(Some(run.end), 0));
    let Some(((x0, y0), (x1, y1))) = before.or(after).zip(after.or(before)) else { return };
    for panel in &mut panels[run] {
        let columns = panel.values.len() / NODES;
        for j in 0..NODES {
            let along = if x1 > x0 { (panel.place(j) - x0) / (x1 - x0) } else { 0.0 };
            panel.values[j * columns + column] = y0 + along * (y1 - y0);
        }
    }
}

/// Whether values change in one place only, and not on the way to something without bound.
fn jumps(values: &[f64]) -> bool {
    let steps = || values.windows(2).map(|w| (w[1] - w[0]).abs());
    let largest = steps().fold(0.0, f64::max);
    steps().sum::<f64>() - largest <= 0.05 * largest
}

#[cfg(test)]
#[path = "resolve_tests.rs"]
mod tests;
