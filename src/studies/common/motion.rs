//! A driven motion as a curve: columns at any place of the range, cut into pieces where switches change.

use super::case::Case;
use super::clock::Clock;
use super::grain::{Grain, PLACES};
use super::observe::Observer;
use super::passage::Passage;
use super::switching::{Distance, Switching};
use crate::expression::Id;
use crate::geometry::{Pose, Space};
use crate::kinematics::assemble::Assembled;
use crate::kinematics::driven::Driven;
use crate::kinematics::path::{NoPath, Path, SINGULAR};
use crate::kinematics::standing::Standing;
use crate::kinematics::undefined::Gap;
use crate::mechanism::Mechanism;
use crate::numerics::continuous::Curve;
use crate::numerics::resolve::Resolved;

/// Part of a velocity by which its values on two sides of a switch may differ by round-off.
const JUMP: f64 = 1e-7;

/// Part of the mean speed below which a mechanism counts as standing: there what velocities differ by is round-off of the whole motion.
const STANDING: f64 = 1e-2;

/// How far from a change point, in rad or sizes, positions are taken that tell those in it.
const SMOOTH: f64 = 0.08;

/// Parts of the range next to a dead point within which positions may be a series, and within which rates may be open.
const FOLDED: f64 = 1e-6;
/// See [`FOLDED`].
const WEAK: f64 = 1e-4;

/// A place could not be reached: the message says where.
#[derive(Clone, Debug, PartialEq)]
pub struct Lost {
    /// The independent variable there.
    pub at: f64,
    /// What has no value there, if that is why.
    pub gap: Option<Gap>,
}

/// A motion with its columns; the gaps of rigid stops follow them.
pub struct Motion<'m, G: Space<S = f64>> {
    /// The solver, left at the place evaluated last.
    pub driven: Driven<'m, G>,
    /// The columns.
    pub observer: Observer<G>,
    /// The independent variable.
    pub clock: Clock,
    /// The path.
    pub path: Path,
    /// How it begins, if that is at rest in a change point.
    pub(super) standing: Option<Standing>,
    /// Change points on the way.
    pub(super) passages: Vec<Passage>,
    /// Progress at both ends.
    pub ends: [f64; 2],
    /// Progress at the ends and at every switch, rising.
    pub breaks: Vec<f64>,
    /// Switches that could not be followed, with the independent variable.
    pub lost_switches: Vec<(usize, f64)>,
    /// Modes of the switches on each piece.
    pub(crate) pieces: Vec<Vec<i32>>,
    switching: Switching,
    pub(crate) modes: Vec<i32>,
    distances: Vec<Distance>,
    columns: usize,
    /// Size of the mechanism, m.
    size: f64,
    /// Below what each column is zero but for round-off.
    floors: Vec<f64>,
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
        let standing = Standing::of(start);
        let path = Path::trace(&mut driven, &mut modes, clock.end(), standing.as_ref())?;
        let mut motion = Self {
            driven,
            observer,
            clock,
            path,
            standing,
            passages: vec![],
            ends: [0.0, clock.length],
            breaks: vec![],
            lost_switches: vec![],
            pieces: vec![],
            switching,
            modes,
            distances: vec![],
            columns,
            size: start.size,
            floors: vec![],
        };
        motion.find_ends();
        let cut = motion.path.gap.is_some() || motion.path.jump.is_some();
        if let Some(t) = motion.path.last().filter(|_| cut) {
            motion.ends[1] = motion.progress_at(t);
        }
        Ok(motion)
    }

    /// Progress at the two ends: a motion that meets a dead point ahead has been followed backwards too.
    fn find_ends(&mut self) {
        let backwards = self.clock.end() < 0.0;
        let [ahead, behind] = if backwards { [0, 1] } else { [1, 0] }.map(|side| self.path.dead[side].as_ref().map(|d| d.0));
        if let Some(t) = ahead {
            let back = behind.or(self.path.back).map(|t| self.progress_at(t));
            self.ends = [back.unwrap_or(-self.clock.length), self.progress_at(t)];
        }
    }

    /// Progress at a time.
    pub(super) fn progress_at(&mut self, t: f64) -> f64 {
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

    /// Poses of all bodies at progress `s`; none where it cannot be reached.
    pub(crate) fn poses(&mut self, s: f64) -> Option<Vec<Pose<G>>> {
        self.reach(s, Some(self.piece_at(s))).ok()?;
        Some(self.driven.dynamics.poses())
    }

    /// The piece at progress `s`, the one behind where a switch stands just there.
    pub(crate) fn piece_at(&self, s: f64) -> usize {
        self.breaks.partition_point(|b| *b <= s).clamp(1, self.breaks.len() - 1) - 1
    }

    /// Places the mechanism at progress `s` with the modes of a piece, or with modes from the state itself; whether rates are open.
    pub(super) fn reach(&mut self, s: f64, piece: Option<usize>) -> Result<bool, Lost> {
        let mut lost = Lost { at: self.clock.value(s), gap: None };
        let t = self.time(s);
        let m = self.driven.dynamics.mechanism;
        if let Some(piece) = piece {
            self.modes[..m.switches].copy_from_slice(&self.pieces[piece]);
        }
        match self.dead_at(s) {
            Some(q) => {
                self.singular(t, &q);
                Ok(false)
            }
            None => {
                let mut q = std::mem::take(&mut self.driven.q);
                let near = self.path.guess(&self.driven, t, &mut q);
                let standing = self.standing.as_ref().and_then(|s| s.coordinates(&mut self.driven, &mut self.modes, t));
                self.driven.q = standing.clone().unwrap_or(q);
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
                    let found = reached.is_ok().then(|| self.driven.q.clone()).filter(|_| self.beside_dead(s, WEAK).is_some());
                    let place = found.or(standing).or_else(|| self.smooth(t)).or_else(|| self.folded(s));
                    let Some(q) = place else { return Err(lost) };
                    self.singular(t, &q);
                    return Ok(false);
                }
                Ok(true)
            }
        }
    }

    /// Evaluates the mechanism at progress `s`: with the modes of a piece, or with modes from the state itself.
    pub(crate) fn solve(&mut self, s: f64, piece: Option<usize>) -> Result<(), Lost> {
        if self.reach(s, piece)? {
            self.driven.rates(&self.modes);
        }
        let m = self.driven.dynamics.mechanism;
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

    /// Places (in the independent variable) at which velocities jump, as where the law of a driver has a kink.
    pub(crate) fn jumps(&mut self) -> Vec<f64> {
        let mut places = Vec::new();
        let nodes = &self.path.nodes;
        let speed = nodes.iter().flat_map(|node| &node.v).fold(0.0, |sum, v| sum + v.abs()) / nodes.len().max(1) as f64;
        for piece in 1..self.pieces.len() {
            let s = self.breaks[piece];
            let sides = [piece - 1, piece].map(|piece| {
                let solved = self.solve(s, Some(piece)).is_ok();
                if solved { self.driven.v.clone() } else { Vec::new() }
            });
            let largest = sides.iter().flatten().fold(STANDING * speed, |m: f64, v| m.max(v.abs()));
            let [before, after] = &sides;
            let differs = |(a, b): (&f64, &f64)| (a - b).abs() > JUMP * (a.abs() + b.abs()) && (a - b).abs() > JUMP * largest;
            if before.iter().zip(after).any(differs) {
                places.push(self.clock.value(s));
            }
        }
        places
    }

    /// Lets the motion end at progress `s`.
    pub(crate) fn end_at(&mut self, s: f64) {
        let side = usize::from(s > 0.0);
        self.ends[side] = s;
        self.path.dead[if self.clock.end() < 0.0 { 1 - side } else { side }] = None;
        self.path.jump = self.path.jump.take().filter(|_| side == 0);
    }

    /// Lets the motion end where all is defined last before a place (in the independent variable) where something is not; what is
    /// undefined just behind it, or nothing if that is so from the start on.
    pub(crate) fn end_before(&mut self, at: f64) -> Option<Lost> {
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
        if good == 0.0 {
            return None;
        }
        self.end_at(good);
        Some(lost)
    }

    /// Whether all is defined at progress `s`.
    fn defined(&mut self, s: f64) -> Result<(), Lost> {
        let mut out = vec![0.0; self.columns()];
        self.solve(s, None)?;
        self.read(s, &mut out)
    }

    /// As [`Curve::eval`], but where a law or an expression has no value by its own fault that is an error, and in a singular position
    /// itself rates have none.
    pub(crate) fn row(&mut self, s: f64, piece: usize, out: &mut [f64]) -> Result<(), Lost> {
        self.direct(s, piece, out)?;
        if self.driven.v.iter().all(|v| v.is_finite()) {
            self.smooth_columns(s, piece, out, &mut []);
        }
        Ok(())
    }

    /// Columns by the constraints alone.
    fn direct(&mut self, s: f64, piece: usize, out: &mut [f64]) -> Result<(), Lost> {
        self.solve(s, Some(piece))?;
        let found = self.read(s, out);
        if found.is_ok() {
            return found;
        }
        // a located switch lies on its far side, where the formula of this side may just not be defined any more
        let inside = 1..self.breaks.len().saturating_sub(1);
        let located = [(piece, 1.0), (piece + 1, -1.0)].into_iter().find(|(k, _)| inside.contains(k) && self.breaks[*k] == s);
        let inwards = located.map_or(0.0, |(_, inwards)| inwards);
        for shift in [1e-15, 1e-13, 1e-11].into_iter().filter(|_| inwards != 0.0) {
            let beside = s + inwards * shift * self.clock.length;
            self.solve(beside, Some(piece))?;
            if self.read(beside, out).is_ok() {
                return Ok(());
            }
        }
        found
    }

    /// Takes below what each of the watched expressions is zero, from the size of the motion.
    pub(crate) fn take_floors(&mut self, case: Case<'_>, ids: &[Id]) {
        let (mut grain, [low, high]) = (Grain::of(self.size), self.ends);
        for s in PLACES.map(|part| low + part * (high - low)) {
            // what cannot be reached is met again
            if self.solve(s, None).is_ok() {
                let Driven { dynamics, v, .. } = &mut self.driven;
                grain.take(dynamics, v, &self.modes);
            }
        }
        self.floors = grain.floors(case.model, case.study, ids, self.clock.end());
    }

    /// Looks again where resolved columns have no value.
    ///
    /// # Errors
    /// The first place where a law or an expression has none by its own fault.
    pub(crate) fn all_defined(&mut self, resolved: &Resolved) -> Result<(), Lost> {
        let mut out = vec![0.0; self.columns()];
        resolved.blanks().try_for_each(|(s, piece)| self.row(s, piece, &mut out))
    }

    /// Coordinates of the dead point at an end of the path.
    fn dead_at(&self, s: f64) -> Option<Vec<f64>> {
        let side = self.ends.iter().position(|e| *e == s)?;
        self.path.dead[if self.clock.end() < 0.0 { 1 - side } else { side }].as_ref().map(|d| d.1.clone())
    }

    /// Progress and coordinates of a dead point that is nearer to progress `s` than a part of the range.
    fn beside_dead(&self, s: f64, part: f64) -> Option<(f64, Vec<f64>)> {
        let end = self.ends.into_iter().find(|end| (end - s).abs() <= part * self.clock.length)?;
        Some((end, self.dead_at(end)?))
    }

    /// Coordinates so near to a dead point that Newton's method has no direction any more. The path turns back there, so that they are a
    /// series in √d of the distance d from it: its terms in √d and d through the dead point and two regular places.
    fn folded(&mut self, s: f64) -> Option<Vec<f64>> {
        let (end, dead) = self.beside_dead(s, FOLDED)?;
        let (inwards, h) = ((s - end).signum(), FOLDED * self.clock.length);
        let mut beside = |d: f64| {
            let t = self.time(end + inwards * d);
            self.regular(t)?;
            Some(self.driven.q.clone())
        };
        let (one, four) = (beside(h)?, beside(4.0 * h)?);
        // r = √(d/h) is 1 and 2 at the two places
        let r = ((end - s).abs() / h).sqrt();
        let series = |((q, one), four): ((&f64, &f64), &f64)| {
            let (a, b) = (one - q, four - q);
            q + r * (0.5 * (4.0 * a - b) + r * 0.5 * (b - 2.0 * a))
        };
        Some(dead.iter().zip(&one).zip(&four).map(series).collect())
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

    /// Places the mechanism at a time where that is regular.
    fn regular(&mut self, t: f64) -> Option<()> {
        let mut q = std::mem::take(&mut self.driven.q);
        let near = self.path.guess(&self.driven, t, &mut q);
        self.driven.q = q;
        self.driven.wind(&mut self.modes, &self.path.nodes[near].turns);
        self.driven.position(t, &self.modes).ok().map(drop)
    }

    /// Coordinates at a change point, where Newton has no direction: the polynomial through eight regular neighbours.
    fn smooth(&mut self, t: f64) -> Option<Vec<f64>> {
        let m = self.driven.dynamics.mechanism;
        let near = self.path.nodes.partition_point(|n| n.t < t).min(self.path.nodes.len() - 1);
        let reach = f64::min(4e-3 * self.clock.end().abs(), SMOOTH / self.driven.measure(&self.path.nodes[near].v));
        let mut sum = vec![0.0; m.nq];
        for k in [-4_i32, -3, -2, -1, 1, 2, 3, 4] {
            let at = t + 0.25 * reach * f64::from(k);
            self.regular(at)?;
            // Lagrange's weight at the middle: Π_{i≠k} i/(i − k)
            let weight: f64 =
                [-4_i32, -3, -2, -1, 1, 2, 3, 4].iter().filter(|i| **i != k).map(|&i| f64::from(i) / f64::from(i - k)).product();
            sum.iter_mut().zip(&self.driven.q).for_each(|(s, q)| *s += weight * q);
        }
        Some(sum)
    }

    /// Notes a switch that could not be followed; the first of them is enough to say so.
    pub(crate) fn leave(&mut self, switch: usize, at: f64) {
        if self.lost_switches.iter().all(|(known, _)| *known != switch) {
            self.lost_switches.push((switch, self.clock.value(at)));
        }
    }

    /// Columns of the state evaluated last, at progress `s`, then the gaps of rigid stops and the rates of one-way clutches.
    ///
    /// # Errors
    /// A law or an expression that has no value by its own fault; then no column has one.
    pub(crate) fn read(&mut self, s: f64, out: &mut [f64]) -> Result<(), Lost> {
        let (columns, gaps) = out.split_at_mut(self.columns);
        self.observer.columns(&self.modes, columns);
        let d = &self.driven.dynamics;
        let (gaps, rates) = gaps.split_at_mut(d.mechanism.stops.len());
        for (gap, stop) in gaps.iter_mut().zip(&d.mechanism.stops) {
            *gap = stop.gap(d.work.readings[stop.gauge].x);
        }
        for (rate, clutch) in rates.iter_mut().zip(d.mechanism.one_way()) {
            *rate = d.extent_rate(clutch.along);
        }
        let law = self.driven.dynamics.undefined(&self.modes).map(Gap::Law);
        let Some(gap) = law.or_else(|| self.observer.undefined(&self.modes, columns)) else { return Ok(()) };
        out.fill(f64::NAN);
        Err(Lost { at: self.clock.value(s), gap: Some(gap) })
    }

    /// How far each switch is from the end of its mode on a piece.
    pub(crate) fn distances(&mut self, s: f64, piece: usize) -> Result<Vec<Distance>, Lost> {
        self.solve(s, Some(piece))?;
        let mut found = self.own_distances();
        if self.smooth_columns(s, piece, &mut [], &mut found) {
            self.solve(s, Some(piece))?;
        }
        Ok(found)
    }

    /// The same for the state evaluated last, by the constraints alone.
    pub(super) fn own_distances(&mut self) -> Vec<Distance> {
        let mut out = std::mem::take(&mut self.distances);
        self.switching.distances(&self.driven.dynamics, &mut self.observer, &self.modes, &mut out);
        // the side on which a joint with friction by reactions presses is a switch of its own
        for (root, switch) in self.driven.pressed() {
            out.push(Distance { switch, root, neighbour: if self.modes[switch] < 0 { 1 } else { -1 } });
        }
        let found = out.clone();
        self.distances = out;
        found
    }
}

impl<G: Space<S = f64>> Curve for Motion<'_, G> {
    type Error = Lost;

    fn columns(&self) -> usize {
        let m = self.driven.dynamics.mechanism;
        self.columns + m.stops.len() + m.one_way().count()
    }

    fn floor(&self, column: usize) -> f64 {
        self.floors.get(column).copied().unwrap_or(0.0)
    }

    fn eval(&mut self, s: f64, piece: usize, out: &mut [f64]) -> Result<(), Lost> {
        match self.direct(s, piece, out) {
            Err(Lost { gap: Some(_), .. }) => out.fill(f64::NAN),
            found => {
                found?;
                self.smooth_columns(s, piece, out, &mut []);
            }
        }
        Ok(())
    }
}
