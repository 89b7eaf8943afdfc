//! The rows of a motion in time, taken while it runs.

use super::trajectory::{Off, Trajectory};
use crate::geometry::Space;
use crate::numerics::continuous::Curve;
use crate::studies::common::recorder::Recorder;

/// Part of the output step by which a row of the grid must be inside of its piece.
const NEAR: f64 = 1e-9;

/// Takes rows from a motion as far as it has come: on the grid of the study, or at every step, with both sides of every switch.
pub(crate) struct Rows<'a> {
    recorder: Recorder<'a>,
    /// The output step, s; none: a row for every step.
    every: Option<f64>,
    /// The present piece of the motion, and the next place in it; none before its first row.
    piece: usize,
    next: Option<i64>,
    /// Where a row had no value.
    off: Option<Off>,
    out: Vec<f64>,
}

impl<'a> Rows<'a> {
    /// Before the first row.
    pub(crate) fn new(recorder: Recorder<'a>, every: Option<f64>) -> Self {
        Self { recorder, every, piece: 0, next: None, off: None, out: Vec::new() }
    }

    /// Takes the rows up to the last step, the end of which may still become a part of a longer one.
    pub(crate) fn follow<G>(&mut self, trajectory: &mut Trajectory<'_, G>)
    where
        G: Space<S = f64>,
    {
        self.take(trajectory, false);
    }

    /// Takes the rows up to the end of the motion, which may have been shortened since: then all of them anew.
    ///
    /// # Errors
    /// The first row without a value.
    pub(crate) fn finish<G>(mut self, trajectory: &mut Trajectory<'_, G>) -> Result<Recorder<'a>, Off>
    where
        G: Space<S = f64>,
    {
        self.take(trajectory, true);
        match self.off {
            Some(off) => Err(off),
            None => Ok(self.recorder),
        }
    }

    /// Takes the rows of finished pieces, and of the last one as far as it has come or, where the motion has ended, to its end.
    fn take<G>(&mut self, trajectory: &mut Trajectory<'_, G>, ended: bool)
    where
        G: Space<S = f64>,
    {
        while self.off.is_none() && self.piece < trajectory.pieces() {
            let closed = ended || self.piece + 1 < trajectory.pieces();
            let [from, to] = trajectory.ends(self.piece);
            // a piece in which no time has passed may still be taken back
            if !closed && to <= from {
                return;
            }
            self.off = self.piece(trajectory, [from, to], closed).err();
            if !closed {
                return;
            }
            (self.piece, self.next) = (self.piece + 1, None);
        }
    }

    /// Takes the rows of the present piece.
    fn piece<G>(&mut self, trajectory: &mut Trajectory<'_, G>, [from, to]: [f64; 2], closed: bool) -> Result<(), Off>
    where
        G: Space<S = f64>,
    {
        let mut next = match self.next {
            Some(next) => next,
            None => {
                self.row(trajectory, from)?;
                self.every.map_or(0, |every| (from / every).floor() as i64)
            }
        };
        match self.every {
            Some(every) => {
                while next as f64 * every <= from + NEAR * every {
                    next += 1;
                }
                while (next as f64 * every) < to - NEAR * every {
                    self.row(trajectory, next as f64 * every)?;
                    next += 1;
                }
                if closed {
                    self.row(trajectory, to)?;
                }
            }
            None => {
                let steps = trajectory.steps_of(self.piece) as i64 - i64::from(!closed);
                while next < steps {
                    if let Some(end) = trajectory.end_of_step(self.piece, next as usize) {
                        self.row(trajectory, end)?;
                    }
                    next += 1;
                }
            }
        }
        self.next = Some(next);
        Ok(())
    }

    fn row<G>(&mut self, trajectory: &mut Trajectory<'_, G>, t: f64) -> Result<(), Off>
    where
        G: Space<S = f64>,
    {
        self.out.resize(trajectory.columns(), 0.0);
        trajectory.row(t, self.piece, &mut self.out)?;
        self.recorder.row(t, self.piece, &self.out);
        Ok(())
    }
}
