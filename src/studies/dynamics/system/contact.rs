//! Where bodies of a joint touch: sides on which friction by reactions presses, rigid stops, and accelerations with them.

use super::Mechanical;
use super::root::{Root, Watched};
use crate::dynamics::slack;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, Stop, StretchOf};
use grashof_solvers::{At, Effect, Kkt, Stage, State, System};

/// By so many times what counts as near a joint that leaves a stop may stand beyond it at most.
pub(super) const MOST_PASSED: f64 = 30.0;

impl Root {
    /// Whether its crossing acts on the motion as a kink does not: by a blow, or by what an event of the model does or notes.
    pub(super) fn acts(self) -> bool {
        matches!(self, Self::Stop(_) | Self::Clear(_) | Self::Rest { .. } | Self::Slides(_) | Self::Holds { .. } | Self::Event(_))
    }

    /// Whether it is of an expression of the model, which may hold other switches; the zero of an impact is a stop.
    pub(super) fn is_formula(self, events: &[Watched]) -> bool {
        match self {
            Self::Force { .. } | Self::Column { .. } => true,
            Self::Event(event) => events[event].impact.is_none(),
            _ => false,
        }
    }

    /// Whether forces follow other laws behind it.
    pub(super) fn is_forceful(self) -> bool {
        !matches!(self, Self::Column { .. } | Self::Winding { .. } | Self::Event(_))
    }
}

impl<G> Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    /// Roots that can give a blow, each with the way to which its stop is known.
    pub(super) fn striking(mechanism: &Mechanism<G>, roots: &[Root], near: &[f64]) -> Vec<(usize, f64)> {
        let stop = |root: &Root| match *root {
            Root::Stop(stop) => Some(stop),
            // a blow where its function is zero
            Root::Event(event) => mechanism.stops.iter().position(|s| s.event == Some(event)),
            _ => None,
        };
        roots.iter().enumerate().filter_map(|(i, root)| Some((i, near[stop(root)?]))).collect()
    }

    /// Roots of one-way clutches that no row holds closed.
    pub(super) fn closing(mechanism: &Mechanism<G>, roots: &[Root]) -> Vec<usize> {
        let one_way = |root: &Root| matches!(*root, Root::Slides(contact) if mechanism.contacts[contact].is_one_way());
        (0..roots.len()).filter(|i| one_way(&roots[*i])).collect()
    }

    /// Accelerations and multipliers of a state by an own solution; those of before where there is none.
    pub(super) fn accelerate(&mut self, at: &At<'_>) {
        if let Some((mut friction, mut terms)) = self.friction.take() {
            self.terms(*at, Stage::Dynamics, &mut terms);
            let Self { dynamics, a, lambda, .. } = self;
            a.fill(0.0);
            lambda.fill(0.0);
            // the dynamics stand at the state
            let _ = friction.solve(&terms, &mut |l, f, slope| dynamics.friction(l, f, slope), a, lambda);
            self.friction = Some((friction, terms));
            return;
        }
        self.kinematics(at);
        self.dynamics.forces(at.modes);
        self.dynamics.mass();
        let w = &self.dynamics.work;
        let kkt = self.kkt.get_or_insert_with(|| Kkt::of_pattern(&self.pattern));
        if kkt.factor(w.mass.values(), w.g.values()).is_ok() {
            kkt.solve(&w.force, &w.gamma, &mut self.a, &mut self.lambda);
        }
    }

    /// Sets the modes of the sides on which joints press, beginning with those at hand: each change may move the others.
    pub(super) fn press(&mut self, at: &At<'_>, modes: &mut [i32]) {
        for _ in 0..4 * self.dynamics.mechanism.sides().count() {
            self.accelerate(&At { modes, ..*at });
            let slack = -slack(&self.pattern.metric, &self.a, &self.lambda);
            let Some((_, mode)) = self.dynamics.pressed(&self.lambda).find(|(n, _)| *n < slack) else { break };
            modes[mode] = if modes[mode] < 0 { 1 } else { -1 };
        }
    }

    /// Place of the mode of a stop.
    pub(super) fn mode_of_stop(&self, stop: usize) -> usize {
        self.dims.modes - self.near.len() + stop
    }

    /// Stops on which joints have come to rest (true) or which they have left, since this was asked last.
    pub(crate) fn take_rests(&mut self) -> Vec<(usize, bool)> {
        std::mem::take(&mut self.rests)
    }

    /// Lets go, in a state, the joint whose stop would have to pull most; none if all that joints rest on push.
    pub(crate) fn let_go_pulled(&mut self, state: &mut State) -> Option<usize> {
        self.accelerate(&state.at());
        let least = -slack(&self.pattern.metric, &self.a, &self.lambda);
        let force = |root: &Root| match *root {
            Root::Rest { row, stop } => Some((-self.dynamics.mechanism.stops[stop].sense * self.lambda[row], stop)),
            _ => None,
        };
        let pulls = self.roots.iter().filter_map(force).filter(|(force, _)| *force < least);
        let (_, stop) = pulls.min_by(|one, other| one.0.total_cmp(&other.0))?;
        state.modes[self.mode_of_stop(stop)] = 1;
        Some(stop)
    }

    /// The rows that hold joints on stops, with the senses in which these push.
    pub(super) fn rests_by_rows(&self) -> impl Iterator<Item = (usize, f64)> {
        let stops = &self.dynamics.mechanism.stops;
        self.roots.iter().filter_map(|root| match *root {
            Root::Rest { row, stop } => Some((row, stops[stop].sense)),
            _ => None,
        })
    }

    /// Whether a blow has to wait until what cannot withstand it is let go: contacts that stick, and joints that rest where a stop would
    /// have to pull; `row` takes the unit force of the blow.
    fn waits(&mut self, index: usize, state: &mut State, row: &mut [f64]) -> bool {
        let Stop { gauge, sense, rest_speed, .. } = self.dynamics.mechanism.stops[index];
        row.fill(0.0);
        self.dynamics.extent_gradient(StretchOf::Gauge(gauge), |k, x| row[k] += x);
        if self.lets_go() {
            return true;
        }
        // what is too slow for a rebound is too slow to lift a joint off its stop
        if self.dynamics.work.readings[gauge].rate.abs() <= rest_speed {
            return false;
        }
        let impulse: Vec<f64> = row.iter().map(|x| sense * x).collect();
        self.lifts(state, &impulse)
    }

    /// Lets go what rests where a stop would have to pull at an impulse (nv) in a state; whether anything does.
    pub(super) fn lifts(&mut self, state: &mut State, impulse: &[f64]) -> bool {
        let pulled = self.pulled(&state.at(), impulse);
        for &stop in &pulled {
            state.modes[self.mode_of_stop(stop)] = 1;
            self.rests.push((stop, false));
        }
        self.loosened |= !pulled.is_empty();
        !pulled.is_empty()
    }

    /// A joint reaches a rigid stop: it rebounds, rests or, pulled away, has only touched it; at the state looked at last.
    fn strike(&mut self, index: usize, restitution: f64, state: &mut State) -> Effect {
        let stop = self.dynamics.mechanism.stops[index];
        let mode = self.mode_of_stop(index);
        let undecided = self.undecided(&state.modes);
        let Some(along) = stop.along else { return self.strike_without_rest(index, restitution, undecided) };
        let speed = -stop.sense * self.dynamics.extent_rate(along);
        if speed < -stop.rest_speed {
            // another blow at the same instant has thrown it back already
            state.modes[mode] = 1;
            return if undecided { Effect::Stop } else { Effect::Record };
        }
        let rebound = Effect::Bounce { restitution, stops: undecided };
        if restitution * speed >= stop.rest_speed {
            state.modes[mode] = 0;
            return rebound;
        }
        self.accelerate(&state.at());
        let pressed = stop.sense * self.dynamics.extent_acceleration(along, &self.a) < 0.0;
        // a rebound so weak counts as rest, also of what is pulled away
        let weak = Effect::Bounce { restitution: 0.0, stops: true };
        if pressed || speed > stop.rest_speed {
            self.rests.push((index, true));
            return weak;
        }
        state.modes[mode] = self.passed(index);
        match undecided {
            _ if speed > 0.0 => weak,
            true => Effect::Stop,
            false => Effect::Record,
        }
    }

    /// A blow at the zero of a function that holds more than positions: nothing can rest there, and where it would the run ends.
    fn strike_without_rest(&mut self, index: usize, restitution: f64, undecided: bool) -> Effect {
        let stop = self.dynamics.mechanism.stops[index];
        let rebound = restitution * self.dynamics.work.readings[stop.gauge].rate.abs();
        if rebound >= stop.rest_speed {
            return Effect::Impulse { restitution, stops: undecided };
        }
        self.restless = stop.event;
        Effect::Stop
    }

    /// An event with impacts is met from the side that counts: a blow, as at a rigid stop.
    pub(super) fn impact(&mut self, event: usize, restitution: f64, state: &mut State, row: &mut [f64]) -> Effect {
        let m = self.dynamics.mechanism;
        let side = f64::from(state.modes[m.switches + m.windings + event]);
        let Some(stop) = m.stops.iter().position(|s| s.event == Some(event) && s.sense == side) else { return Effect::Record };
        if self.waits(stop, state, row) {
            return Effect::Stop;
        }
        self.struck.push(event);
        let also = self.events[event].stops;
        match self.strike(stop, restitution, state) {
            Effect::Bounce { restitution, stops } => Effect::Bounce { restitution, stops: stops || also },
            Effect::Impulse { restitution, stops } => Effect::Impulse { restitution, stops: stops || also },
            Effect::Record if also => Effect::Stop,
            effect => effect,
        }
    }

    /// The event whose impacts would have to come to rest where nothing can hold, if the last crossing met one.
    pub(crate) fn restless(&self) -> Option<usize> {
        self.restless
    }

    /// Way that is left to a stop at the state looked at last, rad or m, or in the unit of its event's function.
    pub(super) fn gap(&self, stop: usize) -> f64 {
        let s = self.dynamics.mechanism.stops[stop];
        s.along.map_or(1.0, |along| s.gap(self.dynamics.extent(along)))
    }

    /// Ways that are left to all stops in a state, 0 of those that are touched; none of events that are met from the other side.
    pub(crate) fn gaps(&mut self, state: &State) -> Vec<Option<f64>> {
        self.look(&state.at(), None);
        self.observer.columns(&state.modes, &mut self.outputs);
        let m = self.dynamics.mechanism;
        let counts = |stop: &Stop| stop.event.is_none_or(|event| f64::from(state.modes[m.switches + m.windings + event]) == stop.sense);
        let way = |k: usize, stop: &Stop| {
            let gap = stop.event.map_or_else(|| self.gap(k), |event| stop.sense * self.outputs[self.events[event].output]);
            // one that was left just now may be passed by as much
            if gap.abs() <= 2.0 * self.near[k] { 0.0 } else { gap }
        };
        m.stops.iter().enumerate().map(|(k, stop)| counts(stop).then(|| way(k, stop))).collect()
    }

    /// Whether a joint has left a stop just now, and may still pass it by rounding.
    pub(super) fn left(&self, stop: usize, modes: &[i32]) -> bool {
        modes[self.mode_of_stop(stop)] > 0
    }

    /// The mode of a stop that a joint leaves from where it stands: so many times what counts as near it may still be beyond; after the
    /// look at the state.
    pub(super) fn passed(&self, stop: usize) -> i32 {
        1 + (-self.gap(stop) / self.near[stop]).ceil().clamp(0.0, MOST_PASSED) as i32
    }

    /// How far beyond a stop its joint may still be, rad or m.
    fn slack_of(&self, stop: usize, modes: &[i32]) -> f64 {
        f64::from(modes[self.mode_of_stop(stop)]) * self.near[stop]
    }

    /// The value of the root of an event with impacts whose function is `x`: its way to the side that counts.
    pub(super) fn way(&self, event: usize, x: f64, modes: &[i32]) -> f64 {
        let m = self.dynamics.mechanism;
        let side = f64::from(modes[m.switches + m.windings + event]);
        let stop = m.stops.iter().position(|s| s.event == Some(event) && s.sense == side);
        let held = |stop: usize| self.roots.iter().any(|root| matches!(root, Root::Rest { stop: s, .. } if *s == stop));
        match stop {
            Some(stop) if held(stop) => 1.0,
            Some(stop) => side * x + self.slack_of(stop, modes),
            None => side * x,
        }
    }

    /// Whether the whole mechanism stands still on rigid stops, where nothing but round-off leads an event over its zero.
    pub(super) fn rests(&mut self, v: &[f64]) -> bool {
        let Self { roots, decided, dynamics, .. } = self;
        roots.iter().any(|root| matches!(root, Root::Rest { .. })) && decided.velocities(&dynamics.work, v).iter().all(|v| *v == 0.0)
    }

    /// The value of a root of a contact; after the look at the state.
    pub(super) fn touch(&self, root: Root, at: &At<'_>, a: &[f64], lambda: &[f64]) -> f64 {
        let m = self.dynamics.mechanism;
        let left = |stop: usize| self.left(stop, at.modes);
        match root {
            Root::Side { place, .. } => {
                let pressed = self.dynamics.pressed(lambda).nth(place);
                pressed.map_or(1.0, |(n, _)| n + slack(&self.pattern.metric, a, lambda))
            }
            Root::Stop(stop) => self.gap(stop) + self.slack_of(stop, at.modes),
            Root::Clear(stop) if left(stop) => 2.0 * self.near[stop] - self.gap(stop),
            Root::Rest { row, stop } => -m.stops[stop].sense * lambda[row],
            _ => 1.0,
        }
    }

    /// Crosses a root of a contact; at the state looked at last.
    pub(super) fn part(&mut self, root: Root, state: &mut State, row: &mut [f64]) -> Effect {
        match root {
            Root::Side { mode, .. } => {
                state.modes[mode] = if state.modes[mode] < 0 { 1 } else { -1 };
                Effect::Restart
            }
            Root::Stop(stop) if self.waits(stop, state, row) => Effect::Stop,
            Root::Stop(stop) => self.strike(stop, self.dynamics.mechanism.stops[stop].restitution, state),
            Root::Clear(stop) => {
                state.modes[self.mode_of_stop(stop)] = 0;
                Effect::Record
            }
            Root::Rest { stop, .. } => {
                state.modes[self.mode_of_stop(stop)] = 1;
                self.rests.push((stop, false));
                Effect::Stop
            }
            _ => Effect::Record,
        }
    }
}
