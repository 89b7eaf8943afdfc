//! A driven motion as a curve: columns at any place of the range, cut into pieces where switches change.

use super::assemble::Assembled;
use super::clock::Clock;
use super::continuous::Curve;
use super::driven::Driven;
use super::observe::Observer;
use super::path::{NoPath, Path, SINGULAR};
use super::root::root;
use super::switching::{Distance, Switching};
use super::undefined::Gap;
use crate::geometry::Space;
use crate::mechanism::Mechanism;

/// A place could not be reached: the message says where.
#[derive(Clone, Debug, PartialEq)]
pub struct Lost {
    /// The independent variable there.
    pub at: f64,
    /// What has no value there, if that is why.
    pub gap: Option<Gap>,
}

/// A motion with its columns.
pub struct Motion<'m, G: Space<S = f64>> {
    /// The solver, left at the place evaluated last.
    pub driven: Driven<'m, G>,
    /// The columns.
    pub observer: Observer<G>,
    /// The independent variable.
    pub clock: Clock,
    /// The path.
    pub path: Path,
    /// Progress at both ends.
    pub ends: [f64; 2],
    /// Progress at the ends and at every switch, rising.
    pub breaks: Vec<f64>,
    /// Modes of the switches on each piece.
    pieces: Vec<Vec<i32>>,
    switching: Switching,
    modes: Vec<i32>,
    distances: Vec<Distance>,
    columns: usize,
}

/// Rows of a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Progress of each row, never falling.
    pub places: Vec<f64>,
    /// Piece of each row.
    pub pieces: Vec<usize>,
    /// Columns of each row.
    pub values: Vec<Vec<f64>>,
}

impl<'m, G: Space<S = f64>> Motion<'m, G> {
    /// Traces the path of a mechanism over the range of a clock.
    ///
    /// # Errors
    /// If the start is a singular position, or the range is endless.
    pub fn trace(
        mechanism: &'m Mechanism<G>,
        start: &Assembled,
        clock: Clock,
        observer: Observer<G>,
        columns: usize,
    ) -> Result<Self, NoPath> {
        let mut driven = Driven::new(mechanism, start);
        let switching = Switching::new(mechanism, &observer);
        let mut modes = start.modes.clone();
        let path = Path::trace(&mut driven, &mut modes, clock.end())?;
        let mut motion = Self {
            driven,
            observer,
            clock,
            path,
            ends: [0.0, clock.length],
            breaks: vec![],
            pieces: vec![],
            switching,
            modes,
            distances: vec![],
            columns,
        };
        motion.find_ends();
        if let Some(t) = motion.path.gap.as_ref().and_then(|_| motion.path.last()) {
            motion.ends[1] = motion.progress_at(t);
        }
        Ok(motion)
    }

    /// Progress at the two ends: a motion that meets a dead point ahead has been followed backwards too.
    fn find_ends(&mut self) {
        let backwards = self.clock.end() < 0.0;
        let [ahead, behind] = if backwards { [0, 1] } else { [1, 0] }.map(|side| self.path.dead[side].as_ref().map(|d| d.0));
        if let Some(t) = ahead {
            let back = behind.map(|t| self.progress_at(t));
            self.ends = [back.unwrap_or(-self.clock.length), self.progress_at(t)];
        }
    }

    /// Progress at a time.
    fn progress_at(&mut self, t: f64) -> f64 {
        if !self.clock.is_driver() {
            return t * self.clock.direction;
        }
        // bisection on the monotone time of progress; exact for constant speeds
        let (mut low, mut high) = (-self.clock.length, self.clock.length);
        let (t_low, t_high) = (self.time(low), self.time(high));
        let exact = low + (high - low) * (t - t_low) / (t_high - t_low);
        if (self.time(exact) - t).abs() <= 4.0 * f64::EPSILON * t.abs() {
            return exact;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if (self.time(middle) < t) == (t_low < t_high) { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Time at progress `s`.
    pub fn time(&mut self, s: f64) -> f64 {
        self.clock.time(&mut self.driven.dynamics, &mut self.modes, s)
    }

    /// Evaluates the mechanism at progress `s`: with the modes of a piece, or with modes from the state itself.
    pub(super) fn solve(&mut self, s: f64, piece: Option<usize>) -> Result<(), Lost> {
        let mut lost = Lost { at: self.clock.value(s), gap: None };
        let t = self.time(s);
        let m = self.driven.dynamics.mechanism;
        if let Some(piece) = piece {
            self.modes[..m.switches].copy_from_slice(&self.pieces[piece]);
        }
        match self.dead_at(s) {
            Some(q) => self.singular(t, &q),
            None => {
                let mut q = std::mem::take(&mut self.driven.q);
                let near = self.path.guess(&self.driven, t, &mut q);
                self.driven.q = q;
                self.driven.wind(&mut self.modes, &self.path.nodes[near].turns);
                let reached = match piece {
                    Some(_) => self.driven.position(t, &self.modes),
                    None => self.driven.follow(t, &mut self.modes),
                };
                if reached.is_err() || self.driven.condition() < SINGULAR {
                    lost.gap = self.driven.dynamics.undefined(&self.modes).map(Gap::Law);
                    if lost.gap.is_some() {
                        return Err(lost);
                    }
                    let Some(q) = self.smooth(t) else { return Err(lost) };
                    self.singular(t, &q);
                } else {
                    self.driven.rates(&self.modes);
                }
            }
        }
        if piece.is_none() {
            let d = &mut self.driven.dynamics;
            for program in [&m.position_program, &m.velocity_program, &m.force_program, &m.state_program] {
                d.switch(program, &mut self.modes);
            }
        }
        self.driven.forces(&self.modes);
        if piece.is_none() {
            self.driven.press(&mut self.modes);
        }
        let Driven { dynamics, q, v, a, reactions, .. } = &mut self.driven;
        self.observer.read(dynamics, [q, v, a], reactions, &self.modes);
        if piece.is_none() {
            self.observer.set_modes(&mut self.modes);
        }
        Ok(())
    }

    /// Lets the motion end where all is defined last before a place (in the independent variable) where something is not; what is
    /// undefined just behind it, or nothing if that is so from the start on.
    pub(super) fn end_before(&mut self, at: f64) -> Option<Lost> {
        let s = self.clock.progress(at);
        let (mut good, mut bad) = (0.0, s);
        self.defined(good).ok()?;
        let mut lost = Lost { at, gap: None };
        for _ in 0..60 {
            let middle = 0.5 * (good + bad);
            match self.defined(middle) {
                Ok(()) => good = middle,
                Err(why) => (bad, lost) = (middle, why),
            }
        }
        self.ends[usize::from(s > 0.0)] = good;
        (good != 0.0).then_some(lost)
    }

    /// Whether all is defined at progress `s`.
    fn defined(&mut self, s: f64) -> Result<(), Lost> {
        let mut out = vec![0.0; self.columns];
        self.solve(s, None)?;
        self.columns_at(s, &mut out)
    }

    /// Columns at progress `s`, where everything was evaluated last.
    fn columns_at(&mut self, s: f64, out: &mut [f64]) -> Result<(), Lost> {
        self.observer.columns(&self.modes, out);
        let law = self.driven.dynamics.undefined(&self.modes).map(Gap::Law);
        match law.or_else(|| self.observer.undefined(&self.modes, out)) {
            None => Ok(()),
            Some(gap) => Err(Lost { at: self.clock.value(s), gap: Some(gap) }),
        }
    }

    /// Coordinates of the dead point at an end of the path.
    fn dead_at(&self, s: f64) -> Option<Vec<f64>> {
        let side = self.ends.iter().position(|e| *e == s)?;
        self.path.dead[if self.clock.end() < 0.0 { 1 - side } else { side }].as_ref().map(|d| d.1.clone())
    }

    /// A singular position: coordinates are known, rates are not defined.
    fn singular(&mut self, t: f64, q: &[f64]) {
        self.driven.q.copy_from_slice(q);
        self.driven.dynamics.time(t, &self.modes);
        self.driven.dynamics.position(q, &self.modes);
        self.driven.v.fill(f64::NAN);
        self.driven.a.fill(f64::NAN);
        self.driven.dynamics.velocity(&self.driven.v, &self.modes);
    }

    /// Coordinates at a change point, where Newton has no direction: the polynomial through eight regular neighbours.
    fn smooth(&mut self, t: f64) -> Option<Vec<f64>> {
        let reach = 4e-3 * self.clock.end().abs();
        let m = self.driven.dynamics.mechanism;
        let mut sum = vec![0.0; m.nq];
        for k in [-4_i32, -3, -2, -1, 1, 2, 3, 4] {
            let at = t + 0.25 * reach * f64::from(k);
            let mut q = std::mem::take(&mut self.driven.q);
            let near = self.path.guess(&self.driven, at, &mut q);
            self.driven.q = q;
            self.driven.wind(&mut self.modes, &self.path.nodes[near].turns);
            self.driven.position(at, &self.modes).ok()?;
            // Lagrange's weight at the middle: Π_{i≠k} i/(i − k)
            let weight: f64 =
                [-4_i32, -3, -2, -1, 1, 2, 3, 4].iter().filter(|i| **i != k).map(|&i| f64::from(i) / f64::from(i - k)).product();
            sum.iter_mut().zip(&self.driven.q).for_each(|(s, q)| *s += weight * q);
        }
        Some(sum)
    }

    /// Rows on the grid of `samples` equal intervals, with both sides of every switch; finds the pieces.
    ///
    /// # Errors
    /// If a place of the grid cannot be reached.
    pub fn sample(&mut self, samples: usize) -> Result<Rows, Lost> {
        let spacing = self.clock.length / samples as f64;
        let [low, high] = self.ends;
        let mut grid: Vec<f64> = Vec::with_capacity(samples + 3);
        grid.push(low);
        let first = (low / spacing).ceil() as i64;
        for k in first.. {
            let s = if k == samples as i64 { self.clock.length } else { k as f64 * spacing };
            if s >= high {
                break;
            }
            if s > low {
                grid.push(s);
            }
        }
        grid.push(high);

        let switches = self.driven.dynamics.mechanism.switches;
        let mut rows = Rows::default();
        // a start on a switch takes its modes from the direction of motion
        self.solve(low + 1e-6 * spacing, None)?;
        self.breaks = vec![low];
        self.pieces = vec![self.modes[..switches].to_vec()];
        self.push(low, &mut rows)?;
        for pair in grid.windows(2) {
            let (mut a, b) = (pair[0], pair[1]);
            let at_end = b == high;
            // the last place looks back, not ahead
            self.solve(if at_end { b - 1e-6 * spacing } else { b }, None)?;
            let there = self.modes[..switches].to_vec();
            for _ in 0..64 {
                let piece = self.pieces.len() - 1;
                if self.pieces[piece] == there {
                    break;
                }
                let Some((s, next)) = self.crossing(a, b, piece, &there)? else { break };
                let s = if (b - s).abs() < 1e-9 * spacing && !at_end { b } else { s };
                a = s;
                if s <= self.breaks[self.breaks.len() - 1] {
                    // at the same place as the last one: the piece between them is empty
                    self.pieces[piece] = next;
                    if rows.pieces.last() == Some(&piece) {
                        rows.places.pop();
                        rows.pieces.pop();
                        rows.values.pop();
                        self.push(s, &mut rows)?;
                    }
                    continue;
                }
                self.push(s, &mut rows)?;
                self.breaks.push(s);
                self.pieces.push(next);
                if s != b {
                    self.push(s, &mut rows)?;
                }
            }
            if rows.places.last() != Some(&b) || rows.pieces.last() != Some(&(self.pieces.len() - 1)) {
                self.push(b, &mut rows)?;
            }
        }
        self.breaks.push(high);
        Ok(rows)
    }

    /// Adds a row of the present piece.
    fn push(&mut self, s: f64, rows: &mut Rows) -> Result<(), Lost> {
        let piece = self.pieces.len() - 1;
        let mut out = vec![0.0; self.columns];
        self.eval(s, piece, &mut out)?;
        rows.places.push(s);
        rows.pieces.push(piece);
        rows.values.push(out);
        Ok(())
    }

    /// The earliest place in [a, b] where the modes of a piece end, and the modes behind it; b shows the modes `there`.
    fn crossing(&mut self, a: f64, b: f64, piece: usize, there: &[i32]) -> Result<Option<(f64, Vec<i32>)>, Lost> {
        let at_a = self.distances(a, piece)?;
        let at_b = self.distances(b, piece)?;
        let mut earliest: Option<(f64, usize)> = None;
        for (from, to) in at_a.iter().zip(&at_b) {
            let changes = there[from.switch] != self.pieces[piece][from.switch];
            if !(to.root < 0.0 || (to.root <= 0.0 && changes)) {
                continue;
            }
            let place = if from.root <= 0.0 {
                a
            } else {
                let switch = from.switch;
                let miss = |s: f64| -> Result<f64, Lost> {
                    let all = self.distances(s, piece)?;
                    Ok(all.iter().find(|d| d.switch == switch).map_or(f64::NAN, |d| d.root))
                };
                match root(miss, a, b, from.root, to.root, 0.0)? {
                    Some(found) => found.place(),
                    None => b,
                }
            };
            if earliest.is_none_or(|(s, _)| place < s) {
                earliest = Some((place, from.switch));
            }
        }
        let Some((s, switch)) = earliest else { return self.bisect(a, b, piece) };
        let neighbour = self.distances(s, piece)?.iter().find(|d| d.switch == switch).map(|d| d.neighbour);
        let mut next = self.pieces[piece].clone();
        // a table may be left by several segments at once: what is seen there decides
        next[switch] = if there[switch] != next[switch] { there[switch] } else { neighbour.unwrap_or(there[switch]) };
        Ok(Some((s, next)))
    }

    /// Where modes from the state itself first differ from those of a piece: for switches whose distance does not show it.
    fn bisect(&mut self, a: f64, b: f64, piece: usize) -> Result<Option<(f64, Vec<i32>)>, Lost> {
        let switches = self.driven.dynamics.mechanism.switches;
        let (mut low, mut high) = (a, b);
        let mut next = None;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            self.solve(middle, None)?;
            if self.modes[..switches] == self.pieces[piece][..] {
                low = middle;
            } else {
                high = middle;
                next = Some(self.modes[..switches].to_vec());
            }
        }
        Ok(next.map(|modes| (high, modes)))
    }

    fn distances(&mut self, s: f64, piece: usize) -> Result<Vec<Distance>, Lost> {
        self.solve(s, Some(piece))?;
        let mut out = std::mem::take(&mut self.distances);
        self.switching.distances(&self.driven.dynamics, &mut self.observer, &self.modes, &mut out);
        // the side on which a joint with friction by reactions presses is a switch of its own
        for (root, switch) in self.driven.pressed() {
            out.push(Distance { switch, root, neighbour: if self.modes[switch] < 0 { 1 } else { -1 } });
        }
        let found = out.clone();
        self.distances = out;
        Ok(found)
    }
}

impl<G: Space<S = f64>> Curve for Motion<'_, G> {
    type Error = Lost;

    fn columns(&self) -> usize {
        self.columns
    }

    fn eval(&mut self, s: f64, piece: usize, out: &mut [f64]) -> Result<(), Lost> {
        self.solve(s, Some(piece))?;
        let found = self.columns_at(s, out);
        if found.is_ok() {
            return found;
        }
        // a located switch lies on its far side, where the formula of this side may just not be defined any more
        for shift in [1e-15, -1e-15, 1e-13, -1e-13, 1e-11, -1e-11] {
            let beside = s + shift * self.clock.length;
            self.solve(beside, Some(piece))?;
            if self.columns_at(beside, out).is_ok() {
                return Ok(());
            }
        }
        found
    }
}
