//! Change points that a driven motion passes through, and columns beside them.
//!
//! The rows G of the constraints are nearly dependent there: with σ, their smallest singular value, which is about the distance, an
//! error ε of the rows is one of ε/σ in positions, of ε/σ² in velocities, of ε/σ³ in accelerations and of ε/σ⁴ in reactions. Yet on
//! the branch that the motion follows all of them are smooth, but for reactions that grow without bound. So what is nearer to a change
//! point than [`MOVES`] is the polynomial through ten places around. Two places between tell whether it is the motion; a column that
//! only they tell to differ has a pole, which values beside it show and a straight line replaces where these are not known any more.

use super::motion::Motion;
use super::passage::{Around, PLACES, Passage, weights};
use super::switching::Distance;
use crate::geometry::Space;
use crate::kinematics::path::PathPoint;
use crate::numerics::continuous::Curve;
use crate::numerics::panel::noise;
use crate::numerics::resolve::Resolved;

/// Distances between the places of a polynomial, in rad or sizes of the mechanism: the first that serves is taken.
const MOVES: [f64; 4] = [0.04, 0.02, 0.01, 0.005];

/// Places of the polynomial to a range, at least.
const PLACES_TO_A_RANGE: f64 = 12.0;

/// A line through two values that points to less than this part of the nearer one points to zero: values are bent between nodes.
const BENT: f64 = 0.5;

/// Looks at which a change point is located between two nodes of a path.
const LOCATED: usize = 30;

/// Looks behind which a least regularity that is still this part of that beside it is none of a change point.
const LOOKS: usize = 8;
/// See [`LOOKS`]; in the end a position of less than the second part is singular.
const REGULAR: f64 = 0.1;
/// See [`REGULAR`].
const SINGULAR: f64 = 1e-3;

/// A polynomial that misses the motion between its places by more than this part of its size is not the motion.
const MISSED: f64 = 1e-6;

/// Values that differ by so many times their round-off are the same.
const ROUND_OFF: f64 = 1000.0;

/// Places at which round-off is measured lie this part of the range apart.
const APART: f64 = 1e-11;

/// Part of the distance between places up to which values beside a pole are known.
const POLE: f64 = 1.0 / 32.0;

impl<G: Space<S = f64>> Motion<'_, G> {
    /// Finds the change points that the path passes through.
    pub(crate) fn find_passages(&mut self) {
        self.passages.clear();
        let nodes = std::mem::take(&mut self.path.nodes);
        // a line through the values at two nodes, at the place of a third
        let ahead = |a: &PathPoint, b: &PathPoint, at: f64| {
            let beside = (a.regularity - b.regularity).exp();
            1.0 + (1.0 - beside) * (at - b.t) / (b.t - a.t)
        };
        // singular values are flat farther off: any that fall towards each other may have zero between them
        let redundant = self.driven.dynamics.mechanism.rows.len() > self.driven.v.len();
        let most = if redundant { 1.0 } else { BENT };
        let mut between = Vec::new();
        for (i, two) in nodes.windows(2).enumerate() {
            // from both sides what vanishes in singular positions points to zero in between
            let before = i.checked_sub(1).map(|k| ahead(&nodes[k], &two[0], two[1].t));
            let after = nodes.get(i + 2).map(|next| ahead(next, &two[1], two[0].t));
            let mut known = before.into_iter().chain(after).peekable();
            if known.peek().is_some() && known.all(|r| r < most) {
                between.push(i);
            }
        }
        self.path.nodes = nodes;
        for i in between {
            let Some((t, singular)) = self.least_regular(i) else { continue };
            let node = &self.path.nodes[i];
            let dt = self.driven.measure(&node.v).recip();
            let (at, next) = (self.progress_at(t), self.path.nodes[i + 1].t);
            // where drivers stand still there is no measure of the way
            let dt = if dt.is_finite() { dt } else { next - self.path.nodes[i].t };
            let pace = (self.progress_at(t + 1e-3 * dt) - at).abs() / 1e-3;
            // one at a node is seen on both sides of it
            let seen = self.passages.iter().any(|p| (p.at - at).abs() < MOVES[3] * pace);
            if seen {
                continue;
            }
            if self.standing.is_none() || at.abs() > PLACES as f64 * MOVES[0] * pace {
                self.passages.push(Passage { at, pace, singular, known: Vec::new() });
            }
        }
    }

    /// The time between a node and the next at which constraints are least regular, if they are singular there or nearly so, and which.
    fn least_regular(&mut self, i: usize) -> Option<(f64, bool)> {
        let [a, b] = [&self.path.nodes[i], &self.path.nodes[i + 1]].map(|node| (node.t, node.regularity));
        let beside = f64::max(a.1, b.1);
        let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
        let mut ends = [a.0, b.0];
        let mut inner = [ends[1] - ratio * (ends[1] - ends[0]), ends[0] + ratio * (ends[1] - ends[0])];
        let mut known = inner.map(|t| self.regularity_at(t));
        for look in 0..LOCATED {
            let low = usize::from(known[1] < known[0]);
            if look == LOOKS && known[low] > REGULAR.ln() + beside {
                return None;
            }
            if known[low] == f64::NEG_INFINITY {
                return Some((inner[low], true));
            }
            ends[1 - low] = inner[1 - low];
            (inner[1 - low], known[1 - low]) = (inner[low], known[low]);
            let width = ends[1] - ends[0];
            inner[low] = if low == 0 { ends[1] - ratio * width } else { ends[0] + ratio * width };
            known[low] = self.regularity_at(inner[low]);
        }
        let low = usize::from(known[1] < known[0]);
        Some((inner[low], known[low] < SINGULAR.ln() + beside))
    }

    /// How regular constraints are at a time on the path; not at all where it cannot be reached.
    fn regularity_at(&mut self, t: f64) -> f64 {
        let mut q = std::mem::take(&mut self.driven.q);
        let near = self.path.guess(&self.driven, t, &mut q);
        self.driven.q = q;
        self.driven.wind(&mut self.modes, &self.path.nodes[near].turns);
        if self.driven.follow(t, &mut self.modes).is_ok() { self.driven.regularity() } else { f64::NEG_INFINITY }
    }

    /// Puts what polynomials tell beside a change point in the place of columns and of distances of switches, as far as given;
    /// whether the motion had to be evaluated elsewhere for that.
    pub(crate) fn smooth_columns(&mut self, s: f64, piece: usize, columns: &mut [f64], distances: &mut [Distance]) -> bool {
        let beside = self.passages.iter().position(|p| (s - p.at).abs() < MOVES[0] * p.pace);
        let Some(passage) = beside else { return false };
        let moved = self.know(passage, piece);
        let Passage { at, known, .. } = &self.passages[passage];
        let Some((_, Some(around))) = known.iter().find(|(modes, _)| *modes == self.pieces[piece]) else { return moved };
        let x = (s - at) / around.spacing;
        if x.abs() >= 1.0 {
            return moved;
        }
        around.put(x, 0, columns);
        let mut roots: Vec<f64> = distances.iter().map(|d| d.root).collect();
        around.put(x, around.values.len() / PLACES - self.driven.v.len() - roots.len(), &mut roots);
        distances.iter_mut().zip(roots).for_each(|(d, root)| d.root = root);
        moved
    }

    /// Notes the columns that are straight lines at change points.
    pub(super) fn note_lines(&self, resolved: &mut Resolved) {
        let columns = Curve::columns(self);
        let mut noted: Vec<usize> = Vec::new();
        for passage in &self.passages {
            for around in passage.known.iter().filter_map(|(_, around)| around.as_ref()) {
                for &(column, [before, after]) in around.lines.iter().filter(|(c, _)| *c < columns) {
                    if !noted.contains(&column) {
                        noted.push(column);
                        let size = f64::max(before.abs(), after.abs());
                        resolved.note_line(column, passage.at, size, around.grow.then_some(around.reach * around.spacing));
                    }
                }
            }
        }
    }

    /// Sees to it that it is known what is around a change point in the modes of a piece; whether it was not.
    fn know(&mut self, passage: usize, piece: usize) -> bool {
        if self.passages[passage].known.iter().any(|(modes, _)| *modes == self.pieces[piece]) {
            return false;
        }
        let passages = std::mem::take(&mut self.passages);
        let Passage { at, pace, singular, .. } = passages[passage];
        let mut around = MOVES.iter().find_map(|m| self.around(at, m * pace, piece, false));
        if around.is_none() && singular {
            around = self.around(at, MOVES[0] * pace, piece, true);
        }
        self.passages = passages;
        self.passages[passage].known.push((self.pieces[piece].clone(), around));
        true
    }

    /// What is known around a change point with places in a given distance, if the motion is smooth there, or `whatever` it is.
    fn around(&mut self, at: f64, spacing: f64, piece: usize, whatever: bool) -> Option<Around> {
        let [first, last] = [self.path.nodes.first()?.t, self.path.nodes.last()?.t].map(|t| self.progress_at(t));
        let [low, high] = [f64::min(first, last).min(self.ends[0]), f64::max(first, last).max(self.ends[1])];
        let spacing = spacing.min((high - low) / PLACES_TO_A_RANGE);
        // as many places on either side as the path allows
        let room = |way: f64| (way / spacing + 1e-9).floor().clamp(0.0, PLACES as f64) as usize;
        let [before, after] = [room(at - low), room(high - at)];
        let before = before.min((PLACES / 2).max(PLACES.saturating_sub(after)));
        let offset = |k: usize| if k < before { k as f64 - before as f64 } else { (k - before + 1) as f64 };
        let mut around =
            Around { spacing, offsets: std::array::from_fn(offset), values: Vec::new(), lines: Vec::new(), reach: POLE, grow: true };
        for k in 0..PLACES {
            around.values.extend(self.all(at + spacing * around.offsets[k], piece)?);
        }
        let count = around.values.len() / PLACES;
        let size = |c: usize| around.of(c).fold(0.0, |m: f64, y| m.max(y.abs()));
        let rates = count - self.driven.v.len()..count;
        let fastest = rates.clone().map(size).fold(0.0, f64::max);
        let beside = at + 0.5 * spacing * if after > 0 { 1.0 } else { -1.0 };
        let floor = self.round_off(beside, piece).or_else(|| whatever.then(|| vec![0.0; count]))?;
        let (mut poles, mut unknown) = (Vec::new(), Vec::new());
        for x in [-0.5, 0.5] {
            let s = at + x * spacing;
            if s < low || s > high {
                continue;
            }
            let Some(there) = self.all(s, piece) else {
                unknown.extend(0..count);
                continue;
            };
            let weights = weights(&around.offsets, x);
            for (c, y) in there.iter().enumerate() {
                let size = if rates.contains(&c) { fastest } else { size(c) };
                let missed = (y - around.polynomial(&weights, c)).abs();
                if missed <= MISSED * size || missed <= ROUND_OFF * floor[c] {
                    continue;
                }
                if !rates.contains(&c) && around.has_pole(c, x, *y) {
                    poles.push(c);
                } else if rates.contains(&c) || !around.is_rough(c) {
                    unknown.push(c);
                }
            }
        }
        if !unknown.is_empty() {
            if !whatever {
                return None;
            }
            (around.reach, around.grow) = (1.0, false);
        }
        let mut lines = [poles, unknown].concat();
        lines.sort_unstable();
        lines.dedup();
        if !lines.is_empty() {
            let sides = [-around.reach, around.reach].map(|x| Some(at + x * spacing).filter(|s| *s >= low && *s <= high));
            let [before, after] = sides.map(|s| self.all(s?, piece));
            let (before, after) = (before.as_ref().or(after.as_ref())?, after.as_ref().or(before.as_ref())?);
            around.lines = lines.into_iter().map(|c| (c, [before[c], after[c]])).collect();
        }
        Some(around)
    }

    /// Columns, distances of switches and velocities by constraints alone.
    fn all(&mut self, s: f64, piece: usize) -> Option<Vec<f64>> {
        self.solve(s, Some(piece)).ok()?;
        let rates = self.driven.v.clone();
        let mut out = vec![0.0; Curve::columns(self)];
        self.read(s, &mut out).ok()?;
        out.extend(self.own_distances().iter().map(|d| d.root));
        out.extend(rates);
        Some(out)
    }

    /// Round-off of the same.
    fn round_off(&mut self, s: f64, piece: usize) -> Option<Vec<f64>> {
        let count = self.all(s, piece)?.len();
        let step = APART * self.clock.length;
        noise(&mut All(self, count), s, step, piece).ok()
    }
}

/// All values of a motion as a curve.
struct All<'a, 'm, G: Space<S = f64>>(&'a mut Motion<'m, G>, usize);

impl<G: Space<S = f64>> Curve for All<'_, '_, G> {
    type Error = ();

    fn columns(&self) -> usize {
        self.1
    }

    fn eval(&mut self, s: f64, piece: usize, out: &mut [f64]) -> Result<(), ()> {
        out.copy_from_slice(&self.0.all(s, piece).ok_or(())?);
        Ok(())
    }
}
