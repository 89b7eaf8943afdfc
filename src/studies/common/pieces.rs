//! The pieces of a driven motion: the places where a switch leaves its mode, resolved on the motion and never on rows.
//!
//! Every switch has a distance from the end of its mode: a function of progress that is smooth on a piece. Stretches of the range are
//! halved until the polynomial through fifteen values and the end shows each distance to be clear of zero, or leaves out less than
//! [`WIDTH`] of it; then its lowest place is looked at itself. So a mode that ends is found however short the next one is, unless
//! the distance comes below zero by less than that part of its size on the stretch. The earliest end cuts the piece, and what lies
//! behind it is looked at in the new modes.

use super::motion::{Lost, Motion};
use super::switching::Distance;
use crate::geometry::Space;
use crate::numerics::continuous::Curve;
use crate::numerics::panel::{Basis, NODES, Panel, noise};
use crate::numerics::resolve::{FIRST_PANELS, Resolved, resolve};
use crate::numerics::root::root;

/// Part of their size to which columns and the distances of switches are resolved.
pub(crate) const WIDTH: f64 = 1e-9;

/// Switches nearer to each other than this part of the range are one.
const TOGETHER: f64 = 1e-12;

/// The modes at the start are those of the state this part of the range behind it, for a start on a switch.
const BEHIND: f64 = 1e-8;

/// Stretches narrower than this part of the range are not halved.
const NARROWEST: f64 = 1e-10;

/// A distance is zero if it is within so many times its round-off.
const ROUND_OFF: f64 = 100.0;

/// Where on a stretch its round-off is taken, and how often and how much nearer to its begin where the modes there do not hold so far.
const HEARD: f64 = 0.4337;
const NEARER: usize = 12;
const NEARER_BY: f64 = 0.25;

/// Part of what a distance varies by on a stretch up to which the polynomial may leave it out where the distance is far from zero: what is
/// left out of a narrow peak whose slopes alone are seen is far more. And part of its size below which it does not vary.
const UNDERSTOOD: f64 = 0.01;
const FLAT: f64 = 1e-12;

/// Nodes of the path to a first stretch.
const NODES_TO_A_STRETCH: usize = 4;

/// Most looks for switches, some 25 for each that is found: in all, and for each node of the path.
const MOST_LOOKS: [usize; 2] = [300_000, 300];

/// A lowest place beyond this part of the half-width of a stretch is the end where the distance is known to be zero.
const NEAR_END: f64 = 0.999;

/// Changes at one place before modes are taken from the state behind it, and before they are left as they are.
const FLIPS: [usize; 2] = [8, 32];

/// A stretch still to be looked at.
struct Stretch {
    from: f64,
    to: f64,
    /// The modes behind a switch that stands at its begin.
    enter: Option<Vec<i32>>,
    /// Switches that are known to leave their mode at its end.
    closed: Vec<usize>,
}

/// What a look at a stretch has shown.
enum Look {
    /// No mode ends; the columns.
    Clear(Panel),
    /// A place to cut it at.
    Cut(f64),
    /// The earliest end of a mode: the last place before, the place, the switches, the modes behind.
    Ends { before: f64, at: f64, switches: Vec<usize>, next: Vec<i32> },
}

/// Distances at the nodes and the end of a stretch.
struct Seen {
    panel: Panel,
    /// (NODES + 1) × distances.
    roots: Vec<Vec<Distance>>,
}

impl Seen {
    fn place(&self, j: usize) -> f64 {
        if j == NODES { self.panel.to } else { self.panel.place(j) }
    }

    fn values(&self, k: usize) -> [f64; NODES] {
        std::array::from_fn(|j| self.roots[j][k].root)
    }

    fn size(&self, k: usize) -> f64 {
        self.roots.iter().fold(0.0, |m, d| f64::max(m, d[k].root.abs()))
    }
}

/// The search from one end of the range to the other.
struct Front<'a, 'm, G: Space<S = f64>> {
    motion: &'a mut Motion<'m, G>,
    basis: Basis,
    /// What of a distance counts as zero.
    floor: Vec<f64>,
    /// Switches that changed where the present piece begins.
    fresh: Vec<usize>,
    /// Changes at that place.
    flips: usize,
    /// Switches that are left in their mode on the next stretch.
    left: Vec<usize>,
    looks: usize,
}

/// The distances of the switches of a motion as a curve.
struct Distances<'a, 'm, G: Space<S = f64>>(&'a mut Motion<'m, G>, usize);

impl<G: Space<S = f64>> Curve for Distances<'_, '_, G> {
    type Error = Lost;

    fn columns(&self) -> usize {
        self.1
    }

    fn eval(&mut self, s: f64, piece: usize, out: &mut [f64]) -> Result<(), Lost> {
        let found = self.0.distances(s, piece)?;
        out.iter_mut().zip(found).for_each(|(out, d)| *out = d.root);
        Ok(())
    }
}

impl<G: Space<S = f64>> Motion<'_, G> {
    /// Finds the pieces, and resolves the columns on them to `WIDTH` of their size.
    ///
    /// # Errors
    /// If a place cannot be reached.
    pub fn resolve(&mut self) -> Result<Resolved, Lost> {
        let [low, high] = self.ends;
        self.find_passages();
        self.solve(low + BEHIND * (high - low), None)?;
        let switches = self.driven.dynamics.mechanism.switches;
        self.breaks = vec![low];
        self.pieces = vec![self.modes[..switches].to_vec()];
        let count = self.distances(low + BEHIND * (high - low), 0)?.len();
        let parts = FIRST_PANELS.max(self.path.nodes.len() / NODES_TO_A_STRETCH);
        let at = |k: usize| if k == parts { high } else { low + (high - low) * k as f64 / parts as f64 };
        let mut looks = 0;
        let panels = if count == 0 {
            (0..parts).map(|k| Panel::of(self, at(k), at(k + 1), 0)).collect::<Result<_, _>>()?
        } else {
            let stretch = |k: usize| Stretch { from: at(k), to: at(k + 1), enter: None, closed: Vec::new() };
            let mut front = Front {
                motion: self,
                basis: Basis::new(),
                floor: vec![0.0; count],
                fresh: Vec::new(),
                flips: 0,
                left: Vec::new(),
                looks: 0,
            };
            let found = front.sweep((0..parts).rev().map(stretch).collect())?;
            looks = front.looks - NODES * found.len();
            found
        };
        self.breaks.push(high);
        let breaks = self.breaks.clone();
        let mut found = resolve(self, panels, &breaks, WIDTH)?;
        found.evaluations += looks;
        self.note_lines(&mut found);
        Ok(found)
    }
}

impl<G: Space<S = f64>> Front<'_, '_, G> {
    fn range(&self) -> f64 {
        self.motion.ends[1] - self.motion.ends[0]
    }

    /// Number of the present piece.
    fn piece(&self) -> usize {
        self.motion.pieces.len() - 1
    }

    fn distances(&mut self, s: f64) -> Result<Vec<Distance>, Lost> {
        self.looks += 1;
        self.motion.distances(s, self.piece())
    }

    /// Looks at all stretches, the last of the list first.
    fn sweep(&mut self, mut waiting: Vec<Stretch>) -> Result<Vec<Panel>, Lost> {
        let [low, high] = self.motion.ends;
        self.hear(low, high);
        let mut panels: Vec<Panel> = Vec::new();
        while let Some(mut stretch) = waiting.pop() {
            if let Some(next) = stretch.enter.take() {
                self.enter(stretch.from, next, &mut panels)?;
            }
            let Stretch { from, to, closed, .. } = stretch;
            // up to a switch so near there is nothing to be seen; and effort has an end
            let short = !closed.is_empty() && to - from <= NARROWEST * self.range();
            let exhausted = self.looks > MOST_LOOKS[0].max(MOST_LOOKS[1] * self.motion.path.nodes.len());
            if short || exhausted {
                if exhausted {
                    let switch = self.fresh.first().copied().unwrap_or(self.distances(to)?[0].switch);
                    self.motion.leave(switch, from);
                }
                let piece = self.piece();
                panels.push(Panel::of(&mut *self.motion, from, to, piece)?);
                continue;
            }
            match self.look(from, to, &closed)? {
                Look::Clear(panel) => {
                    panels.push(panel);
                    self.left.clear();
                }
                Look::Cut(at) => {
                    waiting.push(Stretch { from: at, to, enter: None, closed });
                    waiting.push(Stretch { from, to: at, enter: None, closed: Vec::new() });
                }
                Look::Ends { before, at, mut switches, mut next } => {
                    let near = TOGETHER * self.range();
                    let at = if at - from <= near { from } else { at };
                    let together = to - at <= near;
                    let entered = waiting.last_mut().and_then(|behind| behind.enter.take());
                    // what stood at the end is looked at again in the new modes, but for what changes at the same place
                    if together {
                        entered.iter().for_each(|modes| closed.iter().for_each(|&switch| next[switch] = modes[switch]));
                        switches.extend(closed);
                    }
                    match waiting.last_mut() {
                        Some(behind) if together => (behind.from, behind.enter) = (at, Some(next)),
                        // a switch at the end of the range changes nothing any more
                        None if high - at <= near => {}
                        _ => waiting.push(Stretch { from: at, to, enter: Some(next), closed: Vec::new() }),
                    }
                    let end = if high - at <= near { before } else { at };
                    if end > from {
                        waiting.push(Stretch { from, to: end, enter: None, closed: switches });
                    }
                }
            }
        }
        Ok(panels)
    }

    /// Begins a piece.
    fn enter(&mut self, at: f64, mut next: Vec<i32>, panels: &mut Vec<Panel>) -> Result<(), Lost> {
        let range = self.range();
        let begin = self.motion.breaks[self.motion.breaks.len() - 1];
        let piece = self.piece();
        let changed = |from: &[i32], to: &[i32]| (0..to.len()).filter(|&k| from[k] != to[k]).collect::<Vec<_>>();
        if at - begin > TOGETHER * range {
            self.fresh = changed(&self.motion.pieces[piece], &next);
            self.flips = 0;
            self.motion.breaks.push(at);
            self.motion.pieces.push(next);
            // of several switches at one place the first alone may lead to where there is no position
            let beside = (at + BEHIND * range).min(self.motion.ends[1]);
            if self.motion.distances(at, piece + 1).is_err() && self.motion.solve(beside, None).is_ok() {
                let switches = self.motion.pieces[piece].len();
                self.motion.pieces[piece + 1] = self.motion.modes[..switches].to_vec();
                self.fresh = changed(&self.motion.pieces[piece], &self.motion.pieces[piece + 1]);
            }
            return Ok(());
        }
        // at the same place as the last one: the piece between them is empty
        self.flips += 1;
        let switches = changed(&self.motion.pieces[piece], &next);
        if self.flips == FLIPS[0] {
            self.motion.solve(at + BEHIND * range, None)?;
            next = self.motion.modes[..next.len()].to_vec();
        }
        if self.flips > FLIPS[1] {
            switches.iter().for_each(|s| self.motion.leave(*s, at));
            self.left = switches;
            return Ok(());
        }
        self.fresh.extend(switches);
        self.motion.pieces[piece] = next;
        panels.retain(|p| p.piece < piece);
        Ok(())
    }

    /// Takes the round-off of distances between two places into what counts as zero: where the present modes hold, or where the motion
    /// is not lost beyond their end, ever nearer to the begin.
    fn hear(&mut self, from: f64, to: f64) {
        let (piece, count) = (self.piece(), self.floor.len());
        let mut width = to - from;
        for last in (0..NEARER).rev() {
            let at = from + HEARD * width;
            width *= NEARER_BY;
            let holds = self.distances(at).is_ok_and(|all| last == 0 || all.iter().all(|d| d.root >= 0.0 || d.root.is_nan()));
            let step = 1e-11 * self.range();
            let Some(Ok(found)) = holds.then(|| noise(&mut Distances(self.motion, count), at, step, piece)) else { continue };
            self.looks += 7;
            self.floor.iter_mut().zip(found).filter(|(_, f)| f.is_finite()).for_each(|(floor, f)| *floor = floor.max(ROUND_OFF * f));
            return;
        }
    }

    /// Looks for the earliest end of a mode on a stretch.
    fn look(&mut self, from: f64, to: f64, closed: &[usize]) -> Result<Look, Lost> {
        let wide = to - from > NARROWEST * self.range();
        match self.look_at(from, to, closed) {
            // beyond the end of its modes a motion may be lost
            Err(_) if wide => Ok(Look::Cut(0.5 * (from + to))),
            found => found,
        }
    }

    fn look_at(&mut self, from: f64, to: f64, closed: &[usize]) -> Result<Look, Lost> {
        let end = self.distances(to)?;
        let out = |d: &Distance, floor: f64, left: &[usize]| d.root < -floor && !left.contains(&d.switch);
        let ended: Vec<usize> =
            (0..end.len()).filter(|&k| out(&end[k], self.floor[k], &self.left) && !closed.contains(&end[k].switch)).collect();
        if !ended.is_empty() {
            let begin = self.distances(from)?;
            if ended.iter().all(|&k| begin[k].root > self.floor[k].max(WIDTH * end[k].root.abs())) {
                return self.ends([from, to], &ended, &begin, &end);
            }
        }
        let seen = self.see(from, to, end)?;
        for k in 0..self.floor.len() {
            let signs = seen.roots.windows(2).filter(|w| (w[0][k].root < 0.0) != (w[1][k].root < 0.0)).count();
            if signs > 3 && seen.size(k) > self.floor[k] {
                self.hear(from, to);
            }
        }
        for j in 0..=NODES {
            let known = |k: usize| j == NODES && closed.contains(&seen.roots[j][k].switch);
            let ended: Vec<usize> =
                (0..self.floor.len()).filter(|&k| out(&seen.roots[j][k], self.floor[k], &self.left) && !known(k)).collect();
            if ended.is_empty() {
                continue;
            }
            if j > 0 {
                return self.ends([seen.place(j - 1), seen.place(j)], &ended, &seen.roots[j - 1], &seen.roots[j]);
            }
            let begin = self.distances(from)?;
            let begins = from - self.motion.breaks[self.motion.breaks.len() - 1] <= TOGETHER * self.range();
            let near_zero = |k: usize| begin[k].root > -self.floor[k].max(WIDTH * seen.size(k));
            // what has just changed is zero there, and may come below zero again soon
            let fresh = begins && ended.iter().any(|&k| self.fresh.contains(&begin[k].switch) && near_zero(k));
            if fresh && to - from > NARROWEST * self.range() {
                return Ok(Look::Cut(seen.place(0)));
            }
            return self.ends([from, seen.place(0)], &ended, &begin, &seen.roots[0]);
        }
        if let Some(dwell) = self.dwell(from, &seen, closed)? {
            return Ok(dwell);
        }
        self.decide(seen, closed)
    }

    /// Distances and columns at the nodes of a stretch.
    fn see(&mut self, from: f64, to: f64, end: Vec<Distance>) -> Result<Seen, Lost> {
        let (piece, columns) = (self.piece(), self.motion.columns());
        let mut panel = Panel { from, to, piece, values: vec![0.0; NODES * columns] };
        let mut roots = Vec::with_capacity(NODES + 1);
        for j in 0..NODES {
            roots.push(self.distances(panel.place(j))?);
            let (place, values) = (panel.place(j), &mut panel.values[j * columns..(j + 1) * columns]);
            // beyond the end of its modes there may be no values
            if self.motion.read(place, values).is_ok() {
                self.motion.smooth_columns(place, piece, values, &mut []);
            }
        }
        roots.push(end);
        Ok(Seen { panel, roots })
    }

    /// A stretch on which no distance is seen below zero: whether none comes below between the places, either.
    fn decide(&mut self, seen: Seen, closed: &[usize]) -> Result<Look, Lost> {
        let Panel { from, to, .. } = seen.panel;
        let mut cut = false;
        for k in 0..self.floor.len() {
            let switch = seen.roots[0][k].switch;
            let values = seen.values(k);
            let size = seen.size(k);
            let least = values.iter().fold(f64::INFINITY, |m, y| m.min(*y));
            let settled = !size.is_finite() || size <= self.floor[k] || self.left.contains(&switch);
            let varies = values.iter().fold(f64::NEG_INFINITY, |m, y| m.max(*y)) - least;
            let understood = varies <= self.floor[k].max(FLAT * size) || self.basis.tail(&values) <= UNDERSTOOD * varies;
            if settled || understood && least > 2.0 * varies {
                continue;
            }
            // between its values it may come lower than all of them
            let (s, low) = self.basis.dip(&values);
            if understood && least.min(low) > 4.0 * self.basis.rough(&values) {
                continue;
            }
            if self.basis.tail(&values) > self.floor[k].max(WIDTH * size) {
                cut |= to - from > NARROWEST * self.range();
                continue;
            }
            let known = s < -NEAR_END && self.fresh.contains(&switch) || s > NEAR_END && closed.contains(&switch);
            if known || low > 10.0 * WIDTH * size {
                continue;
            }
            let at = 0.5 * (from + to) + 0.5 * (to - from) * s;
            let there = self.distances(at)?;
            if there[k].root < -self.floor[k] {
                let before = (0..NODES).rev().find(|&j| seen.place(j) < at);
                let (place, begin) = match before {
                    Some(j) => (seen.place(j), seen.roots[j].clone()),
                    None => (from, self.distances(from)?),
                };
                return self.ends([place, at], &[k], &begin, &there);
            }
        }
        Ok(if cut { Look::Cut(0.5 * (from + to)) } else { Look::Clear(seen.panel) })
    }

    /// A distance that is exactly zero on a stretch, as in the dwell of a cam: then its mode is the one that the state asks for.
    fn dwell(&mut self, from: f64, seen: &Seen, closed: &[usize]) -> Result<Option<Look>, Lost> {
        for k in 0..self.floor.len() {
            let switch = seen.roots[0][k].switch;
            let zero = |j: usize| seen.roots[j][k].root == 0.0;
            let Some(j) = (0..NODES).find(|&j| zero(j) && zero(j + 1)) else { continue };
            if closed.contains(&switch) || self.left.contains(&switch) {
                continue;
            }
            self.motion.solve(seen.place(j), None)?;
            self.looks += 1;
            let mode = self.motion.modes[switch];
            let piece = self.piece();
            if mode == self.motion.pieces[piece][switch] {
                continue;
            }
            let begin = if j == 0 { from } else { seen.place(j - 1) };
            let (before, at) = self.edge(begin, seen.place(j), k, |root| root <= 0.0)?;
            let mut next = self.motion.pieces[piece].clone();
            next[switch] = mode;
            return Ok(Some(Look::Ends { before, at, switches: vec![switch], next }));
        }
        Ok(None)
    }

    /// The earliest place between two where one of the distances `ended` that are negative at the second comes below zero, and the
    /// modes behind it.
    fn ends(&mut self, [a, b]: [f64; 2], ended: &[usize], at_a: &[Distance], at_b: &[Distance]) -> Result<Look, Lost> {
        let near = TOGETHER * self.range();
        let mut found: Vec<(f64, f64, usize, f64)> = Vec::new();
        for &k in ended {
            let (before, after, at) = if at_a[k].root > 0.0 {
                let miss = |s: f64| Ok(self.distances(s)?[k].root);
                match root(miss, a, b, at_a[k].root, at_b[k].root, 0.0)? {
                    Some(found) => (found.before, found.after, found.place()),
                    None => (a, b, b),
                }
            } else {
                let floor = self.floor[k];
                let (before, after) = self.edge(a, b, k, |root| root < -floor)?;
                (before, after, after)
            };
            found.push((at, before, k, after));
        }
        let earliest = found.iter().copied().min_by(|x, y| x.0.total_cmp(&y.0)).unwrap_or((b, a, ended[0], b));
        let piece = self.piece();
        let mut next = self.motion.pieces[piece].clone();
        let mut switches = Vec::new();
        for &(at, _, k, after) in &found {
            if at - earliest.0 <= near {
                let there = self.distances(after)?[k];
                next[there.switch] = there.neighbour;
                switches.push(there.switch);
            }
        }
        Ok(Look::Ends { before: earliest.1, at: earliest.0, switches, next })
    }

    /// The neighbouring places between a and b before and behind which a distance satisfies a condition, as it does at b.
    fn edge(&mut self, a: f64, b: f64, k: usize, holds: impl Fn(f64) -> bool) -> Result<(f64, f64), Lost> {
        if holds(self.distances(a)?[k].root) {
            return Ok((a, a));
        }
        let (mut low, mut high) = (a, b);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if holds(self.distances(middle)?[k].root) { high = middle } else { low = middle }
        }
        Ok((low, high))
    }
}
