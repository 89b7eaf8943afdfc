//! Events of a run: roots located on the continuous solution, crossings, impacts.

use super::begin::MOMENT;
use super::resolve::{BESIDE, BETWEEN, COARSE, COARSE_GAP, GAP, NODES, Resolver, Verdict, is_far};
use super::zeno::PILE;
use super::{GROWTH, Integration, Progress};
use crate::engine::{Node, Why};
use crate::{Effect, System};

/// A part of a step that is narrower than this part of it is not made narrower still: what is not resolved there is taken as it is seen.
const NARROWEST: f64 = 1e-6;

/// Looks in one step after which no part is made narrower.
const MOST_LOOKS: usize = 4000;

/// Steps for which a root that could not be resolved is only seen: it is noise.
const NOISY: usize = 32;

/// Halvings of a part of a step in the search for a short time on the positive side of a root.
const MOST_HALVINGS: usize = 30;

/// Switches whose operands become equal at one event.
const MOST_AT_REST: usize = 16;

/// What is zero at an event rests there if it is so a moment later; what was crossed at the event, so much later, as part of the same time.
const LATER: f64 = 1e-3;

/// A root is located to this part of the step.
const LOCATED: f64 = 1e-11;

/// What is known of all roots in a part of a step.
enum Part {
    /// All are positive.
    Clear,
    /// θ just behind the first that is not, and its number.
    Across(f64, usize),
    /// One is not resolved.
    Open,
    /// One that is only read could not be resolved, and is given up.
    Without,
}

impl Integration {
    /// The first root that leaves its positive side within the last step: θ just behind it, and its number.
    pub(super) fn crossing(&mut self, system: &mut dyn System) -> Result<Option<(f64, usize)>, Why> {
        let timed = self.timed_crossing(system)?;
        if self.looked.is_empty() {
            return Ok(timed);
        }
        self.interpolate(system)?;
        self.trial.state.modes.copy_from_slice(&self.last.state.modes);
        self.trial.state.live.copy_from_slice(&self.last.state.live);
        system.roots(self.last.state.at(), &self.last.a, &self.last.lambda, &mut self.samples[0]);
        let h = self.node.state.t - self.last.state.t;
        if let Some(root) = self.wrong_from_the_start(system, h)? {
            return Ok(Some((0.0, root)));
        }
        let end = timed.map_or(1.0, |(theta, _)| theta);
        let (mut from, mut width) = (0.0, self.resolved.map_or(1.0, |width| width / h));
        let mut looks = 0;
        while from < end {
            // a rest that is a little longer saves a short one
            let to = if from + 1.3 * width >= end { end } else { from + width };
            width = to - from;
            // every other node is enough where all roots are far from zero
            self.sample(system, [from, to], &COARSE)?;
            looks += COARSE.len();
            if self.all_far() {
                self.widest = self.widest.max(COARSE_GAP * width * h);
                self.samples.swap(0, NODES - 1);
                from = to;
                width *= 2.0;
                continue;
            }
            self.sample(system, [from, to], &BETWEEN)?;
            looks += BETWEEN.len();
            let last = width <= NARROWEST || looks > MOST_LOOKS;
            match self.first_in(system, [from, to], last)? {
                Part::Open => width *= 0.25,
                Part::Without => (width, looks) = (end - from, 0),
                Part::Across(theta, root) => {
                    self.remember(width, h);
                    return Ok(Some((theta, root)));
                }
                Part::Clear => {
                    self.widest = self.widest.max(GAP * width * h);
                    self.samples.swap(0, NODES - 1);
                    from = to;
                    width *= 2.0;
                }
            }
        }
        self.remember(width, h);
        if timed.is_some() {
            self.roots.copy_from_slice(&self.samples[0]);
        }
        Ok(timed)
    }

    /// A root on which forces depend and that is negative at the start and a moment later, whatever it is in the rest of the first step of
    /// the length `h`.
    fn wrong_from_the_start(&mut self, system: &mut dyn System, h: f64) -> Result<Option<usize>, Why> {
        if !std::mem::take(&mut self.begins) || system.pattern().acting.iter().all(|root| self.samples[0][*root] >= 0.0) {
            return Ok(None);
        }
        self.look(system, (MOMENT * self.moment() / h).min(1.0))?;
        let Self { looked, samples, probe, .. } = self;
        Ok(system.pattern().acting.iter().copied().find(|root| looked.contains(root) && samples[0][*root] < 0.0 && probe[*root] < 0.0))
    }

    /// Keeps the width to which roots were resolved in a step of the length `h`, as the first to be tried in the next one.
    fn remember(&mut self, width: f64, h: f64) {
        self.resolved = (width < 1.0).then_some(width * h);
        self.noisy.iter_mut().for_each(|left| *left = left.saturating_sub(1));
    }

    /// Whether all roots are farther from zero than they change, at every other node of a part and beside them.
    fn all_far(&self) -> bool {
        self.looked.iter().all(|&root| {
            let values = COARSE.iter().map(|&j| self.samples[j][root]);
            let begin = self.samples[0][root];
            let (low, high) = values.fold((begin, begin), |(low, high), x| (low.min(x), high.max(x)));
            is_far(low, high)
        })
    }

    /// Roots at nodes of a part of the step, the last of which stands for the place beside them; those of the begin are known.
    fn sample(&mut self, system: &mut dyn System, [from, to]: [f64; 2], nodes: &[usize]) -> Result<(), Why> {
        for &j in nodes {
            let s = if j < NODES { Resolver::node(j) } else { BESIDE };
            let theta = if j == NODES - 1 { to } else { from + 0.5 * (1.0 + s) * (to - from) };
            self.look(system, theta)?;
            self.samples[j].copy_from_slice(&self.probe);
        }
        Ok(())
    }

    /// The first root that leaves its positive side in a part of the step; `last`: the part is not made narrower.
    fn first_in(&mut self, system: &mut dyn System, [from, to]: [f64; 2], last: bool) -> Result<Part, Why> {
        let mut first: Option<(f64, usize)> = None;
        for k in 0..self.looked.len() {
            let root = self.looked[k];
            let g: [f64; NODES] = std::array::from_fn(|j| self.samples[j][root]);
            let rough = self.noisy[root] > 0 || self.rough.contains(&root);
            let verdict = if rough { Verdict::Open } else { self.resolver.judge(&g, self.samples[NODES][root]) };
            let place = |s: f64| if s == 1.0 { to } else { from + 0.5 * (1.0 + s) * (to - from) };
            let found = match verdict {
                Verdict::Clear => continue,
                Verdict::Across { before, .. } if first.is_some_and(|(x, _)| x <= place(before)) => continue,
                Verdict::Across { before, after } if before == after => Some(from),
                Verdict::Across { before, after } => {
                    self.look(system, place(before))?;
                    let f_before = self.probe[root];
                    self.look(system, place(after))?;
                    let f_after = self.probe[root];
                    let changes = f_before > 0.0 && f_after < 0.0;
                    if changes { Some(self.locate(system, root, [place(before), place(after)], [f_before, f_after])?) } else { None }
                }
                Verdict::Open => None,
            };
            match found {
                Some(theta) if first.is_none_or(|(x, _)| theta < x) => first = Some((theta, root)),
                Some(_) => {}
                None if !(rough || last) => return Ok(Part::Open),
                None if self.observes(root) && !self.falls(root) => {
                    self.give_up(root, self.last.state.t);
                    return Ok(Part::Without);
                }
                None => {
                    if !rough && !self.falls(root) {
                        self.engine.counts.unresolved += 1;
                        self.unresolved.get_or_insert((root, self.last.state.t));
                        self.noisy[root] = NOISY;
                    }
                    if let Some(theta) = self.seen(system, root, &g, [from, to])?
                        && first.is_none_or(|(x, _)| theta < x)
                    {
                        first = Some((theta, root));
                    }
                }
            }
        }
        if first.is_some() {
            self.roots.copy_from_slice(&self.samples[0]);
        }
        Ok(first.map_or(Part::Clear, |(theta, root)| Part::Across(theta, root)))
    }

    /// Whether a root falls from zero in a part of the step, as that of a joint which begins on its stop: then it is seen whole.
    fn falls(&self, root: usize) -> bool {
        self.samples[1..].iter().all(|sample| sample[root] < 0.0)
    }

    /// Where a root is seen to leave its positive side, by the signs at the nodes of a part alone.
    fn seen(&mut self, system: &mut dyn System, root: usize, g: &[f64; NODES], [from, to]: [f64; 2]) -> Result<Option<f64>, Why> {
        let place = |j: usize| if j == NODES - 1 { to } else { from + 0.5 * (1.0 + Resolver::node(j)) * (to - from) };
        let Some(j) = (1..NODES).find(|j| g[*j] < 0.0) else { return Ok(None) };
        let between = [place(j - 1), place(j)];
        if g[j - 1] > 0.0 { self.locate(system, root, between, [g[j - 1], g[j]]) } else { self.again(system, root, between, g[j]) }
            .map(Some)
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
    pub(super) fn look(&mut self, system: &mut dyn System, theta: f64) -> Result<(), Why> {
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
        let h = self.node.state.t - self.last.state.t;
        let repeated = self.repeated.take();
        self.ahead.copy_from(&self.node);
        if theta < 1.0 {
            self.interpolate(system)?;
            self.land(system, theta, root)?;
        }
        self.balance(system, true)?;
        self.before.copy_from(&self.node);
        self.look_back(system)?;
        self.crossed.clear();
        self.blows.clear();
        self.engine.counts.events += 1;
        let mut stop = false;
        let (mut restart, mut bounces) = (false, false);
        let mut at_rest = 0;
        let mut next = Some(self.innermost(system, root));
        loop {
            let Some(root) = next else {
                // what is zero now and stays so may let others jump
                let rested = if at_rest < MOST_AT_REST { self.come_to_rest(system) } else { Ok(None) };
                match rested {
                    Ok(Some(changed)) => restart |= changed,
                    Ok(None) => break,
                    Err(why) => return self.ends_before(why),
                }
                at_rest += 1;
                next = self.also_crossed(system).or_else(|| self.also_timed(system));
                continue;
            };
            let effect = self.cross(system, root);
            bounces |= matches!(effect, Effect::Bounce { .. });
            match effect {
                Effect::Record => {}
                Effect::Stop => stop = true,
                Effect::Restart => restart = true,
                Effect::Impulse { restitution, stops: ends } | Effect::Bounce { restitution, stops: ends } => {
                    stop |= ends;
                    self.add_blow(system, root, restitution);
                }
            }
            if !self.blows.is_empty() {
                // what else is hit at this instant is so with the velocities before
                next = self.also_crossed(system).or_else(|| self.also_hit(system, LOCATED * h));
                if next.is_some() {
                    continue;
                }
                restart = true;
                if let Some(held) = self.blow(system, &mut stop)? {
                    // the motion up to the blow stands; there is none behind it
                    self.halted = Some(Why::Blocked(held));
                    return Ok(Progress::Event);
                }
                self.blows.clear();
            }
            if let Err(why) = self.engine.settle(system, &mut self.node) {
                return self.ends_before(why);
            }
            next = self.also_crossed(system).or_else(|| self.also_timed(system));
        }
        let only_read = !restart && !stop && self.crossed.iter().all(|root| self.observes(*root));
        if only_read {
            self.count_observed();
        } else if let Some(&root) = self.crossed.first()
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
        // what bound the step was the event, not the error
        if let Some((h, resolved)) = repeated {
            self.h = h;
            self.resolved = [self.resolved, resolved].into_iter().flatten().reduce(f64::min);
        }
        let longest = self.longest_gap();
        self.limit_growth(GROWTH * longest);
        if let Err(why) = self.scheme.restart(system, &mut self.engine, &self.node, self.h) {
            return self.ends_before(why);
        }
        (self.turn, self.origin) = (0, self.node.state.t);
        Ok(Progress::Event)
    }

    /// Roots just before an event at the node, with those that are positive half way to it: of a short flight from one stop to the next the
    /// ends may be on the wrong side by round-off.
    fn look_back(&mut self, system: &mut dyn System) -> Result<(), Why> {
        self.probe.fill(0.0);
        if self.dense_ready {
            self.trial.state.modes.copy_from_slice(&self.last.state.modes);
            self.trial.state.live.copy_from_slice(&self.last.state.live);
            self.look(system, 0.5)?;
        }
        system.roots(self.node.state.at(), &self.node.a, &self.node.lambda, &mut self.instant);
        self.instant.iter_mut().zip(&self.probe).for_each(|(at, between)| *at = at.max(*between));
        Ok(())
    }

    /// What was crossed leads to where nothing can be evaluated: the motion up to there stands, and the next advance fails.
    fn ends_before(&mut self, why: Why) -> Result<Progress, Why> {
        self.ahead.copy_from(&self.node);
        self.node.copy_from(&self.before);
        self.halted = Some(why);
        Ok(Progress::Event)
    }

    /// A root that belongs to the same instant: negative in the state reached, and positive before what has happened or before that part of the
    /// step, and not crossed yet, or negative by a jump of what it is made of.
    pub(super) fn also_crossed(&mut self, system: &mut dyn System) -> Option<usize> {
        let Node { state, a, lambda, .. } = &self.node;
        system.roots(state.at(), a, lambda, &mut self.probe);
        let was_positive = |root: usize| self.roots[root] > 0.0 || self.instant[root] > 0.0;
        let own = |root: usize| was_positive(root) && !self.crossed.contains(&root);
        let near = |root: &usize| self.probe[*root] < 0.0 && (own(*root) || self.jumped.contains(root));
        self.looked.iter().copied().find(near)
    }

    /// A stop that is hit at the same instant as that of the last blow, so that round-off does not decide on an order: before that could
    /// move on by the way to which it is known, or within the time to which roots are located, `least` (s).
    fn also_hit(&mut self, system: &mut dyn System, least: f64) -> Option<usize> {
        let blow = self.blows.last()?;
        let (_, way) = *system.pattern().striking.iter().find(|(root, _)| *root == blow.root)?;
        if system.pattern().striking.len() < 2 {
            return None;
        }
        let speed: f64 = blow.row.iter().zip(&self.node.state.v).map(|(r, v)| r * v).sum();
        let within = (way / speed.abs()).min(MOMENT * self.moment()).max(least);
        self.trial.copy_from(&self.node);
        self.drift(system, within);
        system.roots(self.trial.state.at(), &self.trial.a, &self.trial.lambda, &mut self.samples[0]);
        // one that was left at the begin of the step may be behind its zero by round-off since then: what counts is that it closes
        let hit = |root: &usize| self.samples[0][*root] < self.probe[*root].min(0.0) && !self.crossed.contains(root);
        system.pattern().striking.iter().map(|(root, _)| *root).filter(|root| self.looked.contains(root)).find(hit)
    }

    /// Gives a switch whose root has become zero at the event and stays so the mode of equal operands, as where a clamp or a segment of a
    /// table rests on what it is compared with; whether a force has changed, none if there is no such switch.
    fn come_to_rest(&mut self, system: &mut dyn System) -> Result<Option<bool>, Why> {
        // those of the node were looked at last
        if self.probe.iter().all(|g| *g != 0.0) {
            return Ok(None);
        }
        // what was crossed just now may leave zero slowly, unless a law of time has ended at the same instant
        let law_ended = self.crossed.iter().any(|root| self.foresight.roots.contains(root));
        self.look_later(system, MOMENT, 0)?;
        if law_ended {
            self.look_later(system, LATER, 1)?;
        }
        self.near_side.copy_from_slice(&self.probe);
        let Self { looked, foresight, crossed, probe, samples, node, .. } = self;
        let rests = |root: usize| !crossed.contains(&root) || law_ended && samples[1][root] == 0.0;
        let stays = |root: &&usize| probe[**root] == 0.0 && samples[0][**root] == 0.0 && rests(**root);
        let mut at_rest = looked.iter().chain(&foresight.roots).filter(stays);
        let Some((root, effect)) = at_rest.find_map(|root| Some((*root, system.equal(*root, &mut node.state)?))) else { return Ok(None) };
        self.note_jumped(system, root);
        let changed = effect == Effect::Restart;
        if changed {
            self.engine.settle(system, &mut self.node)?;
        }
        Ok(Some(changed))
    }

    /// Roots a `part` of the moment behind the node along its velocities and accelerations, into a sample.
    fn look_later(&mut self, system: &mut dyn System, part: f64, sample: usize) -> Result<(), Why> {
        self.trial.copy_from(&self.node);
        self.drift(system, part * self.moment());
        if system.pattern().roots_by_reactions {
            self.engine.accelerate(system, &mut self.trial)?;
        }
        system.roots(self.trial.state.at(), &self.trial.a, &self.trial.lambda, &mut self.samples[sample]);
        Ok(())
    }

    /// The longest of the times between the last events that changed the motion, of which one is now, s.
    fn longest_gap(&mut self) -> f64 {
        let t = self.node.state.t;
        self.gaps.rotate_right(1);
        (self.gaps[0], self.changed) = (t - self.changed, t);
        self.gaps.iter().fold(0.0, |m, gap| f64::max(m, *gap))
    }

    /// Keeps a step that is chosen by its error to `most` (s).
    pub(super) fn limit_growth(&mut self, most: f64) {
        // events that pile up are told as such, not as steps that are too short
        let least = PILE * (self.node.state.t - self.start).max(1e-3 * (self.goal - self.start));
        if !self.engine.is_fixed() && most.max(least) > 0.0 {
            self.h = self.h.min(most.max(least));
        }
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
}
