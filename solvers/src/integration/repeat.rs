//! Steps made again because of an event in them.
//!
//! Between two events a force may act in a zone that is much narrower than a step (the fall of friction with speed, a stiff stop that is
//! just touched). A step that reaches far beyond evaluates the force at none or few places of the zone, and its error estimate does not
//! know of it either. Made again to just behind the event it does.
//!
//! The polynomial over a step that is long beside the time in which a stiff force changes swings, by less than the error that is allowed,
//! but out of a piece of the force that is narrower than that (friction by a load below a small stick speed). The event is none, the end of
//! the step knows nothing of it, and all the same the transient would begin anew there, in step after step. So a root that is positive
//! again at the end is believed only in a step that ends where it is farthest beyond zero.

use super::foresight::shortest;
use super::{Integration, Progress};
use crate::System;
use crate::engine::Why;

/// An event is early in this part of a step.
const EARLY: f64 = 0.1;

/// Nearer to the begin it is located to no part of its own.
const NEAREST: f64 = 1e-9;

/// The step made again is so many times as long as the way to the event.
const BEHIND: f64 = 1.05;

/// Shortest ways to an event that are stepped to, in the shortest steps that can be made.
const WORTH: f64 = 64.0;

/// Places at which the way of a root beyond zero is looked at, between its own and the end of the step.
const LOOKS: u32 = 8;

/// Longest part of a step to which it is made again where its end knows nothing of the event.
const LONGEST: f64 = 0.5;

impl Integration {
    /// The part of the last step to which it is to be made again because of a root at its place θ: to just behind one that lies early, and
    /// for one that is positive again at the end, to where it is farthest beyond zero.
    pub(super) fn part_to_repeat(&mut self, system: &mut dyn System, theta: f64, root: usize) -> Result<Option<f64>, Why> {
        let (t, h) = (self.last.state.t, self.node.state.t - self.last.state.t);
        let chosen = !self.engine.is_fixed() && self.bridging.is_none() && !self.scheme.chooses_steps();
        // the rest of a step behind something recorded has been a whole step before
        let whole = self.dense.h <= h * (1.0 + 1e-9);
        let least = WORTH * shortest(t, self.goal) / h;
        if !(chosen && whole && system.pattern().forceful.contains(&root)) {
            return Ok(None);
        }
        if theta < EARLY && theta > NEAREST && theta > least {
            return Ok(Some(BEHIND * theta));
        }
        // what is rough or noise is taken as it is seen
        if theta == 0.0 || self.noisy[root] > 0 || self.rough.contains(&root) {
            return Ok(None);
        }
        let part = self.farthest_beyond(system, theta, root)?.min(LONGEST);
        Ok((part > least).then_some(part))
    }

    /// Where in the last step a root that has left its positive side at the place θ is farthest beyond zero; 0 if it is not positive again
    /// at the end.
    fn farthest_beyond(&mut self, system: &mut dyn System, theta: f64, root: usize) -> Result<f64, Why> {
        self.look(system, 1.0)?;
        if self.probe[root] <= 0.0 {
            return Ok(0.0);
        }
        let (mut place, mut lowest) = (theta, f64::INFINITY);
        for k in 0..LOOKS {
            let x = theta + f64::from(k) / f64::from(LOOKS) * (1.0 - theta);
            self.look(system, x)?;
            if self.probe[root] < lowest {
                (place, lowest) = (x, self.probe[root]);
            }
        }
        Ok(place)
    }

    /// Makes the last step again, to a part of it.
    pub(super) fn repeat(&mut self, system: &mut dyn System, part: f64) -> Result<Progress, Why> {
        let h = self.node.state.t - self.last.state.t;
        self.repeated.get_or_insert((self.h, self.resolved));
        self.node.copy_from(&self.last);
        self.engine.counts.steps -= 1;
        self.engine.counts.rejected += 1;
        self.h = part * h;
        self.scheme.restart(system, &mut self.engine, &self.node, self.h)?;
        self.step(system, self.goal)
    }
}
