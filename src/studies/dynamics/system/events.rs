//! Events of the model: on which side of zero their functions are, which crossings count, what they do.

use super::Mechanical;
use super::root::{Root, Watched};
use crate::geometry::Space;
use crate::model::Crossing;
use crate::studies::common::observe::Observer;
use grashof_solvers::{Effect, State};

impl<G> Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    /// Roots of switches that nothing but columns and scalars read: neither forces nor events.
    pub(super) fn observing(observer: &Observer<G>, roots: &[Root], events: &[Watched]) -> Vec<usize> {
        let program = observer.program();
        let outputs: Vec<usize> = events.iter().flat_map(|event| [Some(event.output), event.impact]).flatten().collect();
        let acting = program.switches_of(&outputs);
        let only_read = |root: &Root| matches!(root, Root::Column { k } if !acting.contains(&program.switches()[*k]));
        roots.iter().enumerate().filter(|(_, root)| only_read(root)).map(|(i, _)| i).collect()
    }

    /// The number of the switch of a column, as modes count it.
    pub(in crate::studies::dynamics) fn switch_of(&self, root: usize) -> Option<usize> {
        let Some(&Root::Column { k }) = self.roots.get(root) else { return None };
        self.observer.program().switches().get(k).map(|switch| *switch as usize)
    }

    /// The direction that counts for an event that has left `side`.
    fn counts(&self, event: usize, side: i32) -> bool {
        match self.events[event].crossing {
            Crossing::Both => true,
            Crossing::Rising => side < 0,
            Crossing::Falling => side > 0,
        }
    }

    /// The model's event behind a root that was crossed, if it counts in the direction in which it went; `state` is behind it.
    pub(crate) fn event_of(&self, root: usize, state: &State) -> Option<usize> {
        let Root::Event(event) = self.roots[root] else { return None };
        if self.events[event].impact.is_some() {
            return self.struck.contains(&event).then_some(event);
        }
        let m = self.dynamics.mechanism;
        let before = -state.modes[m.switches + m.windings + event];
        self.counts(event, before).then_some(event)
    }

    /// Forgets which events with impacts were met.
    pub(crate) fn forget_struck(&mut self) {
        self.struck.clear();
    }

    /// Whether the crossing of a root can give a blow.
    pub(crate) fn strikes(&self, root: usize) -> bool {
        self.pattern.striking.iter().any(|(striking, _)| *striking == root)
    }

    /// Events whose side differs between two lists of modes, and which count in that direction: they have happened between them.
    pub(crate) fn flipped(&self, before: &[i32], after: &[i32]) -> Vec<usize> {
        let first = self.dynamics.mechanism.switches + self.dynamics.mechanism.windings;
        (0..self.events.len()).filter(|e| before[first + e] != after[first + e] && self.counts(*e, before[first + e])).collect()
    }

    /// Sets the side of every event from the columns computed last. One with impacts that stands at its zero begins on the side that
    /// counts, and leaves that by a blow alone; the other side it keeps within rounding of its zero.
    pub(super) fn sides_of_events(&self, modes: &mut [i32]) {
        let m = self.dynamics.mechanism;
        for (event, watched) in self.events.iter().enumerate() {
            let side = &mut modes[m.switches + m.windings + event];
            if watched.impact.is_some() && *side != 0 && self.counts(event, *side) {
                continue;
            }
            let x = self.outputs[watched.output];
            let near = m.stops.iter().position(|s| s.event == Some(event)).map_or(0.0, |stop| self.near[stop]);
            match watched.crossing {
                Crossing::Falling if x.abs() <= near && *side == 0 => *side = 1,
                Crossing::Rising if x.abs() <= near && *side == 0 => *side = -1,
                _ if x.abs() <= near && *side != 0 => {}
                _ if x != 0.0 => *side = if x < 0.0 { -1 } else { 1 },
                _ => {}
            }
        }
    }

    /// Crosses the zero of an event; at the state looked at last.
    pub(super) fn cross_event(&mut self, event: usize, state: &mut State, row: &mut [f64]) -> Effect {
        let m = self.dynamics.mechanism;
        self.observer.columns(&state.modes, &mut self.outputs);
        let watched = self.events[event];
        let side = &mut state.modes[m.switches + m.windings + event];
        let before = *side;
        if let (Some(restitution), true) = (watched.impact, self.counts(event, before)) {
            // thrown back, it stays on its side
            return self.impact(event, self.outputs[restitution], state, row);
        }
        *side = -before;
        if watched.stops && self.counts(event, before) { Effect::Stop } else { Effect::Record }
    }
}
