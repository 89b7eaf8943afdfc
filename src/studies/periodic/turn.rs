//! A period as a curve over what advances in it.

use crate::geometry::Space;
use crate::numerics::continuous::Curve;
use crate::numerics::resolve::Resolved;
use crate::studies::dynamics::trajectory::{Off, Trajectory};

/// Most Newton steps from progress to time.
const MOST: usize = 12;

/// A place is found to this part of the range.
const FOUND: f64 = 4e-16;

/// A known place of a curve: time, progress, rate of progress.
#[derive(Clone, Copy, Debug)]
struct Known {
    t: f64,
    s: f64,
    rate: f64,
}

/// What advances: its column and that of its rate, its value at the begin, and the direction in which it goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Advance {
    pub(super) value: usize,
    pub(super) rate: usize,
    pub(super) from: f64,
    pub(super) direction: f64,
}

/// The columns of a trajectory over progress s: the time, or what advances.
pub(super) struct Turn<'t, 'e, G: Space<S = f64>> {
    pub(super) trajectory: &'t mut Trajectory<'e, G>,
    advance: Option<Advance>,
    /// Known places of each piece, at both ends and between.
    known: Vec<Vec<Known>>,
    /// Progress at the begin, at every switch, and at the end.
    pub(super) breaks: Vec<f64>,
}

/// Why a period is no curve over what advances.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum NoTurn {
    /// A state cannot be evaluated.
    Off(Off),
    /// It turns back at this time, s.
    Back(f64),
}

impl From<Off> for NoTurn {
    fn from(off: Off) -> Self {
        Self::Off(off)
    }
}

impl<'t, 'e, G: Space<S = f64>> Turn<'t, 'e, G> {
    /// A curve whose progress ends at `length`.
    pub(super) fn new(trajectory: &'t mut Trajectory<'e, G>, advance: Option<Advance>, length: f64) -> Result<Self, NoTurn> {
        let times = trajectory.breaks();
        let mut turn = Self { trajectory, advance, known: Vec::new(), breaks: times.clone() };
        let Some(by) = advance else { return Ok(turn) };
        let mut out = vec![0.0; turn.trajectory.columns()];
        for piece in 0..times.len() - 1 {
            let ends = turn.trajectory.ends_of(piece);
            let middles = ends.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]);
            let mut known = Vec::new();
            for t in middles.chain(ends.last().copied()) {
                turn.trajectory.row(t, piece, &mut out)?;
                known.push(Known { t, s: (out[by.value] - by.from) * by.direction, rate: out[by.rate] * by.direction });
            }
            if let Some(back) = known.iter().find(|k| k.rate.is_nan() || k.rate <= 0.0) {
                return Err(NoTurn::Back(back.t));
            }
            turn.known.push(known);
        }
        let first = |known: &Vec<Known>| known.first().map(|k| k.s);
        turn.breaks = turn.known.iter().filter_map(first).collect();
        turn.breaks[0] = 0.0;
        turn.breaks.push(length);
        Ok(turn)
    }

    /// The time at progress s on a piece.
    pub(super) fn time(&mut self, s: f64, piece: usize) -> Result<f64, Off> {
        let Some(by) = self.advance else { return Ok(s) };
        let known = &self.known[piece];
        let (first, last) = (known[0], known[known.len() - 1]);
        if s <= self.breaks[piece] || s >= self.breaks[piece + 1] {
            return Ok(if s <= self.breaks[piece] { first.t } else { last.t });
        }
        let above = known.partition_point(|k| k.s < s).clamp(1, known.len() - 1);
        let (low, high) = (known[above - 1], known[above]);
        let length = self.breaks[self.breaks.len() - 1];
        let mut t = between(low, high, s);
        let mut out = vec![0.0; self.trajectory.columns()];
        for _ in 0..MOST {
            self.trajectory.row(t, piece, &mut out)?;
            let miss = s - (out[by.value] - by.from) * by.direction;
            let next = (t + miss / (out[by.rate] * by.direction)).clamp(low.t, high.t);
            let moved = (next - t).abs();
            t = next;
            if miss.abs() <= FOUND * length || moved <= f64::EPSILON * high.t.abs() {
                break;
            }
        }
        Ok(t)
    }

    /// As [`Curve::eval`], but where an expression has no value by its own fault that is an error.
    pub(super) fn row(&mut self, s: f64, piece: usize, out: &mut [f64]) -> Result<(), Off> {
        let t = self.time(s, piece)?;
        self.trajectory.row(t, piece, out)
    }

    /// Looks again where resolved columns have no value.
    ///
    /// # Errors
    /// The first place where an expression has none by its own fault.
    pub(super) fn all_defined(&mut self, resolved: &Resolved) -> Result<(), Off> {
        let mut out = vec![0.0; self.trajectory.columns()];
        resolved.blanks().try_for_each(|(s, piece)| self.row(s, piece, &mut out))
    }
}

/// The time at progress s between two known places: the cubic of t over s with dt/ds = 1/rate at both.
fn between(low: Known, high: Known, s: f64) -> f64 {
    let width = high.s - low.s;
    if width <= 0.0 {
        return low.t;
    }
    let x = ((s - low.s) / width).clamp(0.0, 1.0);
    let y = 1.0 - x;
    let hermite = low.t * y * y * (1.0 + 2.0 * x) + high.t * x * x * (1.0 + 2.0 * y) + width * x * y * (y / low.rate - x / high.rate);
    hermite.clamp(low.t, high.t)
}

impl<G: Space<S = f64>> Curve for Turn<'_, '_, G> {
    type Error = Off;

    fn columns(&self) -> usize {
        self.trajectory.columns()
    }

    fn eval(&mut self, s: f64, piece: usize, out: &mut [f64]) -> Result<(), Off> {
        let t = self.time(s, piece)?;
        self.trajectory.eval(t, piece, out)
    }

    fn look(&mut self, s: f64, piece: usize, out: &mut [f64]) -> Result<(), Off> {
        let t = self.time(s, piece)?;
        self.trajectory.look(t, piece, out)
    }

    fn floor(&self, column: usize) -> f64 {
        self.trajectory.floor(column)
    }
}

/// One column of a trajectory over time.
pub(super) struct Single<'t, 'e, G: Space<S = f64>> {
    pub(super) trajectory: &'t mut Trajectory<'e, G>,
    pub(super) column: usize,
}

impl<G: Space<S = f64>> Curve for Single<'_, '_, G> {
    type Error = Off;

    fn columns(&self) -> usize {
        1
    }

    fn eval(&mut self, t: f64, piece: usize, out: &mut [f64]) -> Result<(), Off> {
        self.trajectory.go(t, piece)?;
        out[0] = self.trajectory.outputs(piece)[self.column];
        Ok(())
    }
}
