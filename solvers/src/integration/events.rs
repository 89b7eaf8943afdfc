//! Events of a run: roots located on the continuous solution, crossings, impacts, and the work between.

use super::{Integration, Progress};
use crate::engine::{Node, Why};
use crate::{Effect, System};

/// Places inside of a step at which roots are looked at, with its end.
const LOOKS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];

/// Halvings of a part of a step in the search for a short time on the positive side of a root.
const MOST_HALVINGS: usize = 30;

/// A root is located to this part of the step.
const LOCATED: f64 = 1e-11;

/// Where a function that is positive at −1, 0 and 1 may be negative between: the lowest point of the parabola through the three
/// values, if that is far below them.
fn dip([a, b, c]: [f64; 3]) -> Option<f64> {
    let bend = a - 2.0 * b + c;
    let x = 0.5 * (a - c) / bend;
    let lowest = b - 0.125 * (a - c) * (a - c) / bend;
    (bend > 0.0 && x.abs() < 1.0 && lowest < 0.3 * a.min(b).min(c)).then_some(x)
}

impl Integration {
    /// The first root that leaves its positive side within the last step: θ just behind it, and its number.
    pub(super) fn crossing(&mut self, system: &mut dyn System) -> Result<Option<(f64, usize)>, Why> {
        if self.looked.is_empty() {
            return Ok(None);
        }
        self.interpolate(system)?;
        self.trial.state.modes.copy_from_slice(&self.last.state.modes);
        self.trial.state.live.copy_from_slice(&self.last.state.live);
        system.roots(self.last.state.at(), &self.last.a, &self.last.lambda, &mut self.roots);
        let mut from = 0.0;
        for look in LOOKS {
            self.look(system, look)?;
            self.samples.copy_from_slice(&self.probe);
            let mut first: Option<(f64, usize)> = None;
            for k in 0..self.looked.len() {
                let root = self.looked[k];
                let (g0, g1) = (self.roots[root], self.samples[root]);
                if g1 < 0.0 {
                    let place = if g0 > 0.0 {
                        self.locate(system, root, [from, look], [g0, g1])?
                    } else {
                        self.again(system, root, [from, look], g1)?
                    };
                    if first.is_none_or(|(x, _)| place < x) {
                        first = Some((place, root));
                    }
                } else if from > 0.0
                    && let Some(dip) = dip([self.older[root], g0, g1])
                {
                    // positive at three looks, but perhaps not between them
                    let x = from + dip * (look - from);
                    self.look(system, x)?;
                    if self.probe[root] < 0.0 {
                        let (a, fa) = if dip < 0.0 { (2.0 * from - look, self.older[root]) } else { (from, g0) };
                        let value = self.probe[root];
                        let place = if fa > 0.0 { self.locate(system, root, [a, x], [fa, value])? } else { a };
                        if first.is_none_or(|(x, _)| place < x) {
                            first = Some((place, root));
                        }
                    }
                }
            }
            if first.is_some() {
                return Ok(first);
            }
            std::mem::swap(&mut self.older, &mut self.roots);
            self.roots.copy_from_slice(&self.samples);
            from = look;
        }
        Ok(None)
    }

    /// The place where a root that is not positive at the begin and negative at the end of a part of the step changes its sign: behind
    /// a short time on its positive side (a ball that has bounced), or at once.
    fn again(&mut self, system: &mut dyn System, root: usize, [from, to]: [f64; 2], at_end: f64) -> Result<f64, Why> {
        let (mut beyond, mut value) = (to, at_end);
        for _ in 0..MOST_HALVINGS {
            let x = from + 0.5 * (beyond - from);
            self.look(system, x)?;
            let g = self.probe[root];
            if g > 0.0 {
                return self.locate(system, root, [x, beyond], [g, value]);
            }
            (beyond, value) = (x, g.min(-f64::MIN_POSITIVE));
        }
        Ok(from)
    }

    /// Roots at the place θ of the last step, into `probe`.
    fn look(&mut self, system: &mut dyn System, theta: f64) -> Result<(), Why> {
        let (t, h) = (self.last.state.t, self.node.state.t - self.last.state.t);
        self.dense.evaluate(t + theta * h, &mut self.trial.state);
        if system.pattern().roots_by_reactions {
            self.engine.accelerate(system, &mut self.trial)?;
        }
        system.roots(self.trial.state.at(), &self.trial.a, &self.trial.lambda, &mut self.probe);
        Ok(())
    }

    /// The place where a root changes its sign, on the far side: the Illinois variant of false position (Dowell & Jarratt 1971),
    /// halved where it is slow.
    fn locate(&mut self, system: &mut dyn System, root: usize, between: [f64; 2], values: [f64; 2]) -> Result<f64, Why> {
        let ([mut a, mut b], [mut fa, mut fb]) = (between, values);
        let mut side = 0;
        for iteration in 0..100 {
            if b - a <= LOCATED {
                break;
            }
            let secant = b - fb * (b - a) / (fb - fa);
            // a step of a tenth of what is asked beyond the secant brackets a root that lies close to one end
            let x = if iteration % 4 == 3 { 0.5 * (a + b) } else { secant.clamp(a + 0.1 * LOCATED, b - 0.1 * LOCATED) };
            self.look(system, x)?;
            let f = self.probe[root];
            if f < 0.0 {
                (b, fb) = (x, f);
                if side == -1 {
                    fa *= 0.5;
                }
                side = -1;
            } else {
                (a, fa) = (x, f);
                if side == 1 {
                    fb *= 0.5;
                }
                side = 1;
            }
        }
        Ok(b)
    }

    /// Ends the last step at a root, crosses it, and starts the scheme afresh; if the motion goes on as if nothing had happened,
    /// the rest of the step is kept for the next advance.
    pub(super) fn event(&mut self, system: &mut dyn System, theta: f64, root: usize, ends: bool) -> Result<Progress, Why> {
        let (t, h) = (self.last.state.t, self.node.state.t - self.last.state.t);
        self.ahead.copy_from(&self.node);
        self.dense.evaluate(t + theta * h, &mut self.node.state);
        self.node.state.modes.copy_from_slice(&self.last.state.modes);
        self.engine.settle(system, &mut self.node)?;
        self.balance(system)?;
        self.before.copy_from(&self.node);
        self.crossed.clear();
        self.engine.counts.events += 1;
        let mut stop = false;
        let (mut restart, mut bounces) = (false, false);
        let mut next = Some(root);
        while let Some(root) = next {
            self.crossed.push(root);
            let effect = system.cross(root, &mut self.node.state, &mut self.row);
            bounces |= matches!(effect, Effect::Bounce { .. });
            match effect {
                Effect::Record => {}
                Effect::Stop => stop = true,
                Effect::Restart => restart = true,
                Effect::Impulse { restitution, stops } | Effect::Bounce { restitution, stops } => {
                    if !self.engine.impulse(system, &mut self.node.state, &self.row, restitution)? {
                        // the motion up to the blow stands; there is none behind it
                        self.halted = Some(Why::Blocked(root));
                        return Ok(Progress::Event);
                    }
                    restart = true;
                    stop |= stops;
                }
            }
            if let Err(why) = self.engine.settle(system, &mut self.node) {
                return self.ends_before(why);
            }
            next = self.also_crossed(system);
        }
        if let Some(&root) = self.crossed.first()
            && !bounces
            && self.zeno.pile_up(self.node.state.t, self.start)
        {
            return Err(Why::Zeno(root));
        }
        if stop {
            return Ok(Progress::Stopped);
        }
        if !restart && self.node.state.t < self.ahead.state.t {
            self.pending = Some(ends);
            return Ok(Progress::Event);
        }
        self.bridging = None;
        if let Err(why) = self.scheme.restart(system, &mut self.engine, &self.node, self.h) {
            return self.ends_before(why);
        }
        (self.turn, self.origin) = (0, self.node.state.t);
        Ok(Progress::Event)
    }

    /// What was crossed leads to where nothing can be evaluated: the motion up to there stands, and the next advance fails.
    fn ends_before(&mut self, why: Why) -> Result<Progress, Why> {
        self.ahead.copy_from(&self.node);
        self.node.copy_from(&self.before);
        self.halted = Some(why);
        Ok(Progress::Event)
    }

    /// A root that belongs to the same instant: negative in the state reached, and not crossed yet.
    fn also_crossed(&mut self, system: &mut dyn System) -> Option<usize> {
        let Node { state, a, lambda, .. } = &self.node;
        system.roots(state.at(), a, lambda, &mut self.probe);
        let near = |root: &usize| self.probe[*root] < 0.0 && self.roots[*root] > 0.0 && !self.crossed.contains(root);
        self.looked.iter().copied().find(near)
    }

    /// Modes of the node from its values, where switches are not located.
    pub(super) fn march_across(&mut self, system: &mut dyn System) -> Result<(), Why> {
        if self.engine.follow_modes(system, &mut self.node.state) {
            self.engine.accelerate(system, &mut self.node)?;
        }
        // implicit schemes have followed the modes themselves
        self.engine.counts.stepped_over += usize::from(self.node.state.modes != self.last.state.modes);
        Ok(())
    }

    /// Adds ∫ power dt over the last step by Lobatto's rule with five nodes, exact to degree seven (Abramowitz & Stegun 25.4.32).
    pub(super) fn balance(&mut self, system: &mut dyn System) -> Result<(), Why> {
        if !self.settings.balance || self.engine.dims.work == 0 {
            return Ok(());
        }
        self.interpolate(system)?;
        let (t, h) = (self.last.state.t, self.node.state.t - self.last.state.t);
        self.work.copy_from_slice(&self.last.state.work);
        let inner = 0.5 - 0.5 * (3.0_f64 / 7.0).sqrt();
        let (end, side, middle) = (1.0 / 20.0, 49.0 / 180.0, 16.0 / 45.0);
        for (theta, weight) in [(0.0, end), (inner, side), (0.5, middle), (1.0 - inner, side), (1.0, end)] {
            if theta == 0.0 {
                system.power(self.last.state.at(), &self.last.a, &self.last.lambda, &mut self.power);
            } else if theta == 1.0 {
                system.power(self.node.state.at(), &self.node.a, &self.node.lambda, &mut self.power);
            } else {
                self.trial.state.modes.copy_from_slice(&self.last.state.modes);
                self.trial.state.live.copy_from_slice(&self.last.state.live);
                self.dense.evaluate(t + theta * h, &mut self.trial.state);
                self.engine.accelerate(system, &mut self.trial)?;
                system.power(self.trial.state.at(), &self.trial.a, &self.trial.lambda, &mut self.power);
            }
            self.work.iter_mut().zip(&self.power).for_each(|(w, p)| *w += weight * h * p);
        }
        self.node.state.work.copy_from_slice(&self.work);
        Ok(())
    }
}
