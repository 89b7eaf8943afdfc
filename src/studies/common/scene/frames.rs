//! Frames of a motion: as many as make up for what interpolation between them leaves out.
//!
//! A uniform grid is doubled; the poses in the middle of its cells, which the next grid needs anyway, tell how far interpolation is off.
//! Some irrational places beside them keep a motion that repeats itself in the grid from being taken for one that rests.

use super::places::reaches;
use crate::geometry::{Pose, Quaternion, Space};
use crate::mechanism::Mechanism;
use crate::results::scene::{Frames, interpolate};

/// Cells of the first grid of a motion: six positions of a turn fall on frames.
pub(super) const CELLS: usize = 6;
/// Error that is small enough, as part of the size.
const ENOUGH: f64 = 1e-6;
/// Error that is not seen, as part of the size: a motion with blows, whose error falls with the cells only, is taken no further.
const UNSEEN: f64 = 1e-3;
/// Of one that is still seen, cells are halved where it is off by more than this part of the size: beside a dead point bodies move with
/// the root of the way to it, and a uniform grid comes to nothing.
const FAIR: f64 = 1e-4;
/// A body that goes round more than once in the plane turns by less than this from frame to frame, rad, if so many cells do: straight
/// lines through few frames have its angle, but few positions of a turn.
const TURNED: f64 = std::f64::consts::TAU / 24.0;
/// Places within a cell at which the bound is told in the end, and how often a cell is halved at most.
const WITHIN: [f64; 3] = [0.125, 0.5, 0.875];
const HALVED: usize = 40;
/// Reach of a body at least, as part of the size.
const LEAST: f64 = 0.01;
/// The middle of a cell is not quite the worst place in it.
const BESIDE_MIDDLE: f64 = 1.5;
/// Irrational places that are looked at.
const PROBES: usize = 7;
/// Numbers of all frames at most.
const NUMBERS: usize = 600_000;
/// Multiples of the cells of the first grid that are tried for one in which a place is a frame.
const TRIES: usize = 10;
/// Positions that a still picture shows.
pub(super) const SHOWN: usize = 6;

/// A part of a motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// Progress at its ends.
    pub(crate) ends: [f64; 2],
    /// Time at its ends, s, if it is a motion in time.
    pub(crate) times: Option<[f64; 2]>,
    /// Whether it may come back to where it began.
    pub(crate) turns: bool,
    /// Cells of the first grid.
    pub(crate) first: usize,
    /// Cells at most.
    pub(crate) most: usize,
    /// A place of the independent variable that is to be a frame.
    pub(crate) at: Option<f64>,
}

impl Default for Span {
    fn default() -> Self {
        Self { ends: [0.0; 2], times: None, turns: false, first: CELLS, most: 4095, at: None }
    }
}

/// The independent variable and the poses of all bodies at a progress; none where it cannot be reached.
pub(super) type At<'a, G> = dyn FnMut(f64) -> Option<(f64, Vec<Pose<G>>)> + 'a;

/// A place of the motion: the independent variable, and the poses as they stand in [`Frames`].
type Frame = (f64, Vec<f64>);

/// Frames of given poses, counted from 0.
pub(super) fn of_poses<G: Space<S = f64>>(poses: &[Vec<Pose<G>>]) -> Frames {
    Frames {
        at: (0..poses.len()).map(|i| i as f64).collect(),
        poses: poses.iter().flat_map(|poses| flat(poses)).collect(),
        shown: (0..poses.len()).collect(),
        ..Frames::default()
    }
}

/// Frames over a span of a motion.
pub(super) fn over<G: Space<S = f64>>(mechanism: &Mechanism<G>, span: Span, at: &mut At<'_, G>) -> Frames {
    let [low, high] = span.ends;
    // what has no place beside its origin turns all the same
    let reaches = reaches(mechanism).into_iter().map(|reach| reach.max(LEAST * mechanism.size())).collect();
    let sampler = Sampler { reaches, stride: if G::VECTOR == 2 { 3 } else { 7 }, size: mechanism.size() };
    // the ends as they are given, not as they are rounded
    let progress = |part: f64| if part == 1.0 { high } else { low + (high - low) * part };
    let grid = span
        .at
        .and_then(|x| part_of(x, &mut |part| Some(at(progress(part))?.0)))
        .map_or_else(|| Grid { cells: span.first, knot: None }, |part| Grid::with(part, span.first));
    let (first, mut look) = (grid.cells, |part: f64| {
        let (x, poses) = at(progress(grid.part(part)))?;
        Some((x, flat(&poses)))
    });
    let width = (mechanism.bodies.len() - 1) * sampler.stride;
    let most = span.most.min(NUMBERS / width.max(1)).max(first);
    let mut grid: Vec<Option<Frame>> = (0..=first).map(|i| look(i as f64 / first as f64)).collect();
    let mut before = f64::INFINITY;
    let error = loop {
        let cells = grid.len() - 1;
        let middles: Vec<Option<Frame>> = (0..cells).map(|i| look((i as f64 + 0.5) / cells as f64)).collect();
        let curve = sampler.curve(&grid);
        let mut error = middles.iter().flatten().map(|frame| sampler.error(&curve, frame)).fold(0.0, f64::max);
        if error <= ENOUGH * sampler.size / BESIDE_MIDDLE {
            let probes = (1..=PROBES).filter_map(|k| look((k as f64 * 0.618_033_988_749_895).fract()));
            error = probes.map(|frame| sampler.error(&curve, &frame)).fold(error, f64::max);
        }
        let blows = error < UNSEEN * sampler.size && error > 0.25 * before && cells >= 200;
        let error = BESIDE_MIDDLE * error;
        let coarse = sampler.turned(&curve).is_some_and(|turned| turned > TURNED && turned * cells as f64 <= TURNED * most as f64);
        if error <= ENOUGH * sampler.size && !coarse || 2 * cells > most || blows {
            break error;
        }
        before = error / BESIDE_MIDDLE;
        grid = interleaved(grid, middles);
    };
    let cells = grid.len() - 1;
    let parts: Vec<f64> = (0..=cells).map(|i| i as f64 / cells as f64).collect();
    if error <= UNSEEN * sampler.size {
        return sampler.frames(span, &parts, &grid, error);
    }
    let (parts, grid, error) = sampler.halved(parts, grid, cells + most / 4, &mut look);
    sampler.frames(span, &parts, &grid, error)
}

/// The part of a span at which the independent variable has a value between those of its ends, by regula falsi.
fn part_of(x: f64, at: &mut dyn FnMut(f64) -> Option<f64>) -> Option<f64> {
    let mut ends = [(0.0, at(0.0)? - x), (1.0, at(1.0)? - x)];
    let range = (ends[1].1 - ends[0].1).abs();
    for _ in 0..50 {
        let [(a, fa), (b, fb)] = ends;
        if fa * fb >= 0.0 {
            return None;
        }
        let part = a - fa * (b - a) / (fb - fa);
        let off = at(part)? - x;
        if off.abs() <= 1e-12 * range {
            return Some(part);
        }
        ends[usize::from(off * fa < 0.0)] = (part, off);
    }
    None
}

/// A first grid of cells of one size, or of one size before a knot and of another one behind it.
#[derive(Clone, Copy)]
struct Grid {
    cells: usize,
    /// Cells before the knot, and the part of the span where it is.
    knot: Option<(usize, f64)>,
}

impl Grid {
    /// The grid of few cells, multiples of `first`, in which a part of the span is an edge of a cell.
    fn with(part: f64, first: usize) -> Self {
        let on_edge = |cells: &usize| (part * *cells as f64 - (part * *cells as f64).round()).abs() < 1e-9;
        match (1..=TRIES).map(|k| k * first).find(on_edge) {
            Some(cells) => Self { cells, knot: None },
            None => {
                let cells = 2 * first;
                Self { cells, knot: Some((((part * cells as f64).round() as usize).clamp(1, cells - 1), part)) }
            }
        }
    }

    /// The part of the span at a part of the cells.
    fn part(&self, part: f64) -> f64 {
        let Some((before, at)) = self.knot else { return part };
        let knot = before as f64 / self.cells as f64;
        if part <= knot { part / knot * at } else { 1.0 - (1.0 - part) / (1.0 - knot) * (1.0 - at) }
    }
}

/// A grid of twice as many cells.
fn interleaved(grid: Vec<Option<Frame>>, middles: Vec<Option<Frame>>) -> Vec<Option<Frame>> {
    let mut finer = Vec::with_capacity(2 * grid.len());
    let mut middles = middles.into_iter();
    for frame in grid {
        finer.push(frame);
        finer.extend(middles.next());
    }
    finer
}

/// Poses of the moving bodies as numbers.
fn flat<G: Space<S = f64>>(poses: &[Pose<G>]) -> Vec<f64> {
    let mut numbers = Vec::with_capacity(7 * poses.len());
    for pose in poses.iter().skip(1) {
        numbers.extend((0..G::VECTOR).map(|i| G::component(pose.p, i)));
        if G::VECTOR == 2 {
            numbers.push(G::angle(pose.r));
        } else {
            numbers.extend(Quaternion::of_rotation::<G>(pose.r).0);
        }
    }
    numbers
}

/// What the errors of frames are measured by.
struct Sampler {
    /// Of each body, m; that of the ground is not used.
    reaches: Vec<f64>,
    /// Numbers of a pose.
    stride: usize,
    /// Size of the mechanism, m.
    size: f64,
}

/// Frames with signs of quaternions that do not jump, at rising places.
struct Continuous {
    at: Vec<f64>,
    poses: Vec<f64>,
    /// −1 if the independent variable falls.
    sign: f64,
}

impl Sampler {
    /// What is there of a grid, as a curve.
    fn curve(&self, grid: &[Option<Frame>]) -> Continuous {
        let ends = [grid.iter().flatten().next(), grid.iter().flatten().next_back()].map(|frame| frame.map_or(0.0, |f| f.0));
        let sign = if ends[1] < ends[0] { -1.0 } else { 1.0 };
        let mut curve = Continuous { at: Vec::new(), poses: Vec::new(), sign };
        for (x, row) in grid.iter().flatten() {
            if curve.at.last().is_some_and(|last| sign * x <= *last) {
                continue;
            }
            let from = curve.poses.len().saturating_sub(row.len());
            let mut row = row.clone();
            if !curve.at.is_empty() {
                self.same_signs(&mut row, &curve.poses[from..]);
            }
            curve.at.push(sign * x);
            curve.poses.extend(row);
        }
        curve
    }

    /// By how much a body turns from one frame to the next at most, rad, of those in the plane that go round more than once.
    fn turned(&self, curve: &Continuous) -> Option<f64> {
        let width = self.stride * (self.reaches.len() - 1);
        let count = curve.at.len();
        if self.stride != 3 || count < 2 {
            return None;
        }
        let angle = |frame: usize, column: usize| curve.poses[frame * width + column];
        let rounds = (2..width).step_by(3).filter(|k| (angle(count - 1, *k) - angle(0, *k)).abs() > std::f64::consts::TAU * (1.0 + 1e-6));
        rounds.flat_map(|k| (1..count).map(move |i| (angle(i, k) - angle(i - 1, k)).abs())).reduce(f64::max)
    }

    /// Takes of the two quaternions of each rotation the one nearer to that of a neighbour.
    fn same_signs(&self, row: &mut [f64], neighbour: &[f64]) {
        if self.stride == 7 {
            for (pose, other) in row.chunks_exact_mut(7).zip(neighbour.chunks_exact(7)) {
                if pose[3..].iter().zip(&other[3..]).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
                    pose[3..].iter_mut().for_each(|x| *x = -*x);
                }
            }
        }
    }

    /// How far any place of any body is from where interpolation has it, at most, m.
    fn error(&self, curve: &Continuous, (x, exact): &Frame) -> f64 {
        let mut found = vec![0.0; exact.len()];
        interpolate(&curve.at, &curve.poses, self.stride, curve.sign * x, &mut found);
        let mut exact = exact.clone();
        self.same_signs(&mut exact, &found);
        let poses = found.chunks_exact(self.stride).zip(exact.chunks_exact(self.stride));
        let off = |(reach, (a, b)): (&f64, (&[f64], &[f64]))| {
            let (k, turn) = if self.stride == 3 { (2, 1.0) } else { (3, 2.0) };
            let gap =
                |range: std::ops::Range<usize>| a[range.clone()].iter().zip(&b[range]).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            gap(0..k) + reach * turn * gap(k..self.stride)
        };
        self.reaches[1..].iter().zip(poses).map(off).fold(0.0, f64::max)
    }

    /// A grid whose cells are halved where interpolation is off, to `most` cells; with the parts of the span where its frames are, and how
    /// far it is off then.
    fn halved(
        &self,
        mut parts: Vec<f64>,
        mut grid: Vec<Option<Frame>>,
        most: usize,
        look: &mut dyn FnMut(f64) -> Option<Frame>,
    ) -> (Vec<f64>, Vec<Option<Frame>>, f64) {
        let mut at = |parts: &[f64], cell: usize, within: f64| look(parts[cell] + within * (parts[cell + 1] - parts[cell]));
        let mut middles: Vec<Option<Frame>> = (0..parts.len() - 1).map(|cell| at(&parts, cell, 0.5)).collect();
        for _ in 0..HALVED {
            let curve = self.curve(&grid);
            let off = |middle: &Option<Frame>| middle.as_ref().is_some_and(|frame| self.error(&curve, frame) > FAIR * self.size);
            let bad: Vec<bool> = middles.iter().map(off).collect();
            if !bad.contains(&true) || grid.len() >= most {
                break;
            }
            // from the last cell on, so that those before keep their places
            for cell in (0..bad.len()).rev().filter(|cell| bad[*cell]) {
                parts.insert(cell + 1, 0.5 * (parts[cell] + parts[cell + 1]));
                grid.insert(cell + 1, middles[cell].take());
                let halves = [at(&parts, cell, 0.5), at(&parts, cell + 1, 0.5)];
                middles.splice(cell..=cell, halves);
            }
        }
        let curve = self.curve(&grid);
        let places = (0..parts.len() - 1).flat_map(|cell| WITHIN.map(|within| (cell, within)));
        let off = places.filter_map(|(cell, within)| Some(self.error(&curve, &at(&parts, cell, within)?)));
        let error = BESIDE_MIDDLE * off.fold(0.0, f64::max);
        (parts, grid, error)
    }

    /// The frames of a grid, at some parts of the span.
    fn frames(&self, span: Span, parts: &[f64], grid: &[Option<Frame>], error: f64) -> Frames {
        let Continuous { mut at, mut poses, sign } = self.curve(grid);
        let width = if at.is_empty() { 0 } else { poses.len() / at.len() };
        let closed = span.turns && at.len() > 2 && self.returns(&poses[..width], &poses[poses.len() - width..]);
        let last = at.len().saturating_sub(1);
        let steps = if closed { SHOWN } else { SHOWN - 1 };
        let known: Vec<f64> = parts.iter().zip(grid).filter(|(_, frame)| frame.is_some()).map(|(part, _)| *part).collect();
        // of a uniform grid by their numbers, so that a turn has them at round places; of one with halved cells by the way
        let even = parts.len() < 3 || parts.windows(2).all(|ends| (ends[1] - ends[0] - parts[1]).abs() < 1e-12);
        let next = |part: f64| known.partition_point(|at| *at < part - 1e-12);
        let place = |i: usize| if even { (2 * i * last + steps) / (2 * steps) } else { next(i as f64 / steps as f64).min(last) };
        let mut shown: Vec<usize> = (0..SHOWN).map(place).collect();
        shown.dedup();
        shown.retain(|i| *i < at.len());
        if sign < 0.0 {
            at.reverse();
            at.iter_mut().for_each(|x| *x = 0.0 - *x);
            poses = poses.chunks_exact(width.max(1)).rev().flatten().copied().collect();
            shown.iter_mut().for_each(|i| *i = last - *i);
        }
        Frames { at, poses, shown, error, closed, rest: None }
    }

    /// Whether two frames are one, whole turns aside.
    fn returns(&self, first: &[f64], last: &[f64]) -> bool {
        let near = 1e-7 * self.size;
        let pairs = first.chunks_exact(self.stride).zip(last.chunks_exact(self.stride));
        pairs.zip(&self.reaches[1..]).all(|((a, b), reach)| {
            let turned = if self.stride == 3 {
                (0.5 * (b[2] - a[2])).sin().abs() * 2.0
            } else {
                let dot: f64 = a[3..].iter().zip(&b[3..]).map(|(a, b)| a * b).sum();
                2.0 * (1.0 - dot * dot).max(0.0).sqrt()
            };
            let (k, turned) = if self.stride == 3 { (2, turned) } else { (3, if turned < 1e-7 { 0.0 } else { turned }) };
            a[..k].iter().zip(&b[..k]).all(|(a, b)| (a - b).abs() <= near) && turned * reach.max(self.size * 1e-3) <= near
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_halved_beside_a_dead_point_until_the_bound_is_small() {
        // a bar that turns with the root of the way to the end
        let sampler = Sampler { reaches: vec![0.0, 0.3], stride: 3, size: 1.0 };
        let turn = |part: f64| (1.0 - part).sqrt();
        let mut look = |part: f64| Some((part, vec![0.0, 0.0, turn(part)]));
        let parts: Vec<f64> = (0..=64).map(|i| f64::from(i) / 64.0).collect();
        let grid: Vec<Option<Frame>> = parts.iter().map(|part| look(*part)).collect();
        let (parts, grid, error) = sampler.halved(parts, grid, 500, &mut look);
        assert!(error < 3e-4 && parts.len() < 150, "{error} with {}", parts.len());
        let frames = sampler.frames(Span { ends: [0.0, 1.0], ..Span::default() }, &parts, &grid, error);
        let off = |x: f64| 0.3 * (frames.at(x, 2)[2] - turn(x)).abs();
        let worst = (0..100_000).map(|i| off(f64::from(i) / 1e5)).fold(0.0, f64::max);
        assert!(worst <= error, "{worst} is more than the bound {error}");
        let shown: Vec<f64> = frames.shown.iter().map(|i| frames.at[*i]).collect();
        assert!(shown.len() == SHOWN && shown.iter().enumerate().all(|(i, x)| (x - 0.2 * i as f64).abs() < 0.02), "{shown:?}");
    }

    #[test]
    fn a_place_that_is_asked_for_is_an_edge_of_a_cell() {
        // by cells of one size where few of them do, else by a knot
        for (x, knot) in [(0.25, false), (0.4, false), (0.123_456, true), (0.999, true)] {
            let found = part_of(x, &mut |part| Some(part.powi(3))).expect("a part");
            assert!((found - f64::cbrt(x)).abs() < 1e-9, "{found}");
            let grid = Grid::with(x, CELLS);
            assert_eq!(grid.knot.is_some(), knot, "{x}");
            let nearest = (0..=grid.cells).map(|i| (grid.part(i as f64 / grid.cells as f64) - x).abs()).fold(1.0, f64::min);
            assert!(nearest < 1e-12 && (grid.part(1.0), grid.part(0.0)) == (1.0, 0.0), "{x}: {nearest}");
        }
        assert_eq!(part_of(2.0, &mut Some), None);
    }
}
