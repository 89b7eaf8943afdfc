//! Trials of steps: how long they are, and which are accepted.

use super::foresight::shortest;
use super::{Integration, PARTS, active};
use crate::System;
use crate::engine::{Control, LONGEST_RETRY, Why};

/// A step may be so many times as long as the state at its end lets one be that begins there.
const LATER: f64 = 1.2;

impl Integration {
    /// Tries steps until one succeeds: `trial` is complete then. True if it ends at `until`.
    pub(super) fn attempt(&mut self, system: &mut dyn System, until: f64, left: f64) -> Result<bool, Why> {
        let (mut failures, mut reason) = (0, Why::StepSize);
        let followed = system.longest(self.node.state.at());
        loop {
            let t = self.node.state.t;
            let mut h = match self.settings.control {
                Control::Steps(steps) => steps[self.turn % 2],
                Control::Tolerance(_) => self.h.min(self.settings.longest).min(followed),
            };
            let itself = active(&mut self.scheme, &mut self.bridge, self.bridging.is_some()).chooses_steps();
            // a last step that is a little longer saves a very short one
            let mut ends = itself || h * (1.0 + 1e-9) >= left;
            if ends {
                h = left;
            } else if !self.engine.is_fixed() && 2.0 * h > left {
                h = 0.5 * left;
            }
            // a switch of time alone is known beforehand: the step ends there, also where it is a little longer for that
            let far = t + if ends { h } else { h * (1.0 + 1e-9) };
            let ahead = if itself || self.engine.is_fixed() { None } else { self.foresee(system, t, far)?.filter(|ahead| *ahead < far) };
            if let Some(ahead) = ahead {
                (h, ends) = (ahead - t, false);
            }
            if h.is_nan() || h <= shortest(t, until) {
                return Err(self.too_short(t, reason));
            }
            let scheme = active(&mut self.scheme, &mut self.bridge, self.bridging.is_some());
            let tried = scheme.attempt(system, &mut self.engine, &self.node, h, &mut self.trial);
            if itself {
                // what was offered is the way to the end, not the step
                h = tried.map_or_else(|rejected| rejected.retry, |()| self.trial.state.t - t);
            }
            let (why, retry) = match tried {
                Ok(()) => match self.complete(system, h) {
                    Ok(true) if let Some(retry) = self.is_lost(system, h, followed) => (Why::Lost, retry),
                    Ok(true) => {
                        let scheme = active(&mut self.scheme, &mut self.bridge, self.bridging.is_some());
                        let next = scheme.accept(&mut self.engine, &self.node, &self.trial);
                        // what was cut short says nothing about the step that the error allows
                        let cut = ahead.is_some() || ends && !itself && !self.engine.is_fixed();
                        self.h = if cut { next.max(self.h) } else { next };
                        self.limit_growth(self.resolved.map_or(f64::INFINITY, |width| PARTS * width));
                        if let Some(ahead) = ahead {
                            self.trial.state.t = ahead;
                        }
                        self.turn += 1;
                        return Ok(ends && !(itself && self.trial.state.t < until - 4.0 * f64::EPSILON * until.abs()));
                    }
                    Ok(false) => continue,
                    Err(why) => (why, 0.25 * h),
                },
                Err(rejected) => (rejected.why, rejected.retry),
            };
            self.engine.counts.rejected += 1;
            failures += 1;
            if matches!(why, Why::NotFinite(_) | Why::Friction) {
                self.spoiled = Some((why, t));
            }
            if self.engine.is_fixed() || itself && why == Why::Lost {
                return Err(why);
            }
            if !matches!(why, Why::Error(_) | Why::Lost) && self.begins_bridge(system, h, self.sigma < 0.2 * self.largest_sigma)? {
                continue;
            }
            self.h = retry.min(LONGEST_RETRY * h);
            reason = if matches!(why, Why::Error(_)) { Why::StepSize } else { why };
            if failures > 60 || t + self.h <= t {
                return Err(self.too_short(t, reason));
            }
        }
    }

    /// Why steps have become too short at `t`: numbers that were not finite just ahead say more than the error.
    fn too_short(&self, t: f64, why: Why) -> Why {
        match self.spoiled {
            Some((spoiled, at)) if (t - at).abs() <= 1e-6 * (t - self.start).abs() => spoiled,
            _ => why,
        }
    }

    /// Accelerations and multipliers of the trial; false if it lies in a singular position, so that a bridge has begun instead.
    fn complete(&mut self, system: &mut dyn System, h: f64) -> Result<bool, Why> {
        let explicit = self.bridging.is_some();
        let scheme = active(&mut self.scheme, &mut self.bridge, explicit);
        if !scheme.completes() {
            self.engine.accelerate(system, &mut self.trial)?;
        }
        if self.bridge.is_none() {
            return Ok(true);
        }
        let sigma = self.weakest.follow(&mut self.engine, 1);
        if !explicit && sigma < self.bridge_at() && self.begins_bridge(system, h, true)? {
            return Ok(false);
        }
        self.sigma = sigma;
        self.largest_sigma = self.largest_sigma.max(sigma);
        Ok(true)
    }

    /// The step to try instead of the trial of length `h` (s) in which values that are followed from their last ones have been lost.
    fn is_lost(&mut self, system: &mut dyn System, h: f64, followed: f64) -> Option<f64> {
        let at_end = system.longest(self.trial.state.at());
        (h > LATER * followed.min(at_end)).then_some(at_end.min(0.5 * h))
    }
}
