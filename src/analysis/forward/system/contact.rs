//! Where bodies of a joint touch: sides on which friction by reactions presses, rigid stops, and accelerations with them.

use super::{Mechanical, Root};
use crate::dynamics::{LANES, slack};
use crate::geometry::Space;
use crate::scalar::Dual;
use grashof_solvers::{At, Effect, Stage, State, System};

impl Root {
    /// Whether its crossing acts on the motion as a kink does not: by a blow, or by what an event of the model does or notes.
    pub(super) fn acts(self) -> bool {
        matches!(self, Self::Stop(_) | Self::Clear(_) | Self::Rest { .. } | Self::Event(_))
    }
}

impl<G, D> Mechanical<'_, G, D>
where
    G: Space<S = f64>,
    D: Space<S = Dual<LANES>>,
{
    /// Accelerations and multipliers of a state by an own solution; those of before where there is none.
    pub(super) fn accelerate(&mut self, at: &At<'_>) {
        if self.friction.is_some() {
            let mut terms = std::mem::take(&mut self.terms);
            self.terms(*at, Stage::Dynamics, &mut terms);
            let Self { friction: Some(friction), dynamics, a, lambda, .. } = self else { return };
            a.fill(0.0);
            lambda.fill(0.0);
            // the dynamics stand at the state
            let _ = friction.solve(&terms, &mut |l, f, slope| dynamics.friction(l, f, slope), a, lambda);
            self.terms = terms;
            return;
        }
        self.kinematics(at);
        self.dynamics.forces(at.modes);
        self.dynamics.mass();
        let w = &self.dynamics.work;
        if self.kkt.factor(&w.mass, &w.g).is_ok() {
            self.kkt.solve(&w.force, &w.gamma, &mut self.a, &mut self.lambda);
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
    fn mode_of_stop(&self, stop: usize) -> usize {
        self.dims.modes - self.near.len() + stop
    }

    /// Stops on which joints have come to rest (true) or which they have left, since this was asked last.
    pub(in crate::analysis::forward) fn take_rests(&mut self) -> Vec<(usize, bool)> {
        std::mem::take(&mut self.rests)
    }

    /// A joint reaches a rigid stop: it rebounds, rests or, pulled away, has only touched it; at the state looked at last.
    fn strike(&mut self, index: usize, state: &mut State, row: &mut [f64]) -> Effect {
        let m = self.dynamics.mechanism;
        let stop = m.stops[index];
        let mode = self.mode_of_stop(index);
        row.fill(0.0);
        m.gauges[stop.gauge].project(&self.dynamics.work.readings[stop.gauge], &self.dynamics.work.columns, |k, x| row[k] += x);
        let speed = -stop.sense * self.dynamics.work.readings[stop.gauge].rate;
        if speed < -stop.rest_speed {
            // another blow at the same instant has thrown it back already
            state.modes[mode] = 1;
            return Effect::Record;
        }
        let rebound = Effect::Bounce { restitution: stop.restitution, stops: false };
        if stop.restitution * speed >= stop.rest_speed {
            state.modes[mode] = 0;
            return rebound;
        }
        self.accelerate(&state.at());
        let reading = &self.dynamics.work.readings[stop.gauge];
        let pressed = stop.sense * m.gauges[stop.gauge].acceleration(reading, &self.dynamics.work.columns, &self.a) < 0.0;
        if pressed || speed > stop.rest_speed {
            self.rests.push((index, true));
            return Effect::Bounce { restitution: 0.0, stops: true };
        }
        state.modes[mode] = 1;
        if speed > 0.0 { rebound } else { Effect::Record }
    }

    /// The value of a root of a contact; after the look at the state.
    pub(super) fn touch(&self, root: Root, at: &At<'_>, a: &[f64], lambda: &[f64]) -> f64 {
        let m = self.dynamics.mechanism;
        let gap = |stop: usize| m.stops[stop].gap(self.dynamics.work.readings[m.stops[stop].gauge].x);
        let left = |stop: usize| at.modes[self.mode_of_stop(stop)] == 1;
        match root {
            Root::Side { place, .. } => {
                let pressed = self.dynamics.pressed(lambda).nth(place);
                pressed.map_or(1.0, |(n, _)| n + slack(&self.pattern.metric, a, lambda))
            }
            Root::Stop(stop) => gap(stop) + if left(stop) { self.near[stop] } else { 0.0 },
            Root::Clear(stop) if left(stop) => 2.0 * self.near[stop] - gap(stop),
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
            Root::Stop(stop) => self.strike(stop, state, row),
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
