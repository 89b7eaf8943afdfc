//! What touches at rest: contacts, and joints on their rigid stops, which are decided together.

use super::Mechanical;
use super::contact::MOST_PASSED;
use crate::dynamics::slack;
use crate::geometry::Space;
use crate::mechanism::StretchOf;
use grashof_solvers::{State, System};

/// A rate of what touches that counts as rest, in rad/s or sizes of the mechanism a second.
pub(super) const REST: f64 = 1e-9;

/// Part of the accelerations at hand that counts as none.
pub(super) const NO_ACCELERATION: f64 = 1e-8;

/// A contact, or a joint and its rigid stop, by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Touching {
    Contact(usize),
    Stop(usize),
}

impl<G> Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    /// Along what it moves, and the sense in which a positive force of it acts.
    fn way_of(&self, touching: Touching) -> (StretchOf, f64) {
        let m = self.dynamics.mechanism;
        match touching {
            Touching::Contact(contact) => (m.contacts[contact].along, 1.0),
            Touching::Stop(stop) => {
                let stop = &m.stops[stop];
                (stop.along.unwrap_or(StretchOf::Gauge(stop.gauge)), stop.sense)
            }
        }
    }

    /// The direction of its force, ∂ẋ/∂v (nv).
    pub(super) fn pushes(&self, touching: Touching) -> Vec<f64> {
        let (along, sense) = self.way_of(touching);
        self.gradient(along).into_iter().map(|x| sense * x).collect()
    }

    /// Its acceleration at accelerations `a` (nv).
    pub(super) fn parts(&self, touching: Touching, a: &[f64]) -> f64 {
        let (along, sense) = self.way_of(touching);
        sense * self.dynamics.extent_acceleration(along, a)
    }

    /// Whether it only pushes.
    pub(super) fn only_pushes(&self, touching: Touching) -> bool {
        match touching {
            Touching::Contact(contact) => self.dynamics.mechanism.contacts[contact].is_one_way(),
            Touching::Stop(_) => true,
        }
    }

    /// Rigid stops on which joints rest in a state, or which they touch without speed; `resting` are those of which rows hold them.
    pub(crate) fn touched(&mut self, state: &State, resting: &[usize]) -> Vec<usize> {
        self.kinematics(&state.at());
        (0..self.near.len()).filter(|stop| resting.contains(stop) || self.is_touched(*stop)).collect()
    }

    /// Whether a joint touches a rigid stop without speed; after the look at the state.
    pub(super) fn is_touched(&self, stop: usize) -> bool {
        let of = &self.dynamics.mechanism.stops[stop];
        let Some(along) = of.along.filter(|_| of.event.is_none()) else { return false };
        let gap = self.gap(stop) / self.near[stop];
        (-MOST_PASSED..=2.0).contains(&gap) && self.dynamics.extent_rate(along).abs() <= 2.0 * REST * of.size(self.size)
    }

    /// Marks, of stops that are touched, those that are not among the `resting` ones as left just now; after [`Self::touched`].
    pub(crate) fn leave(&self, touched: &[usize], resting: &[usize], state: &mut State) {
        for &stop in touched {
            state.modes[self.mode_of_stop(stop)] = if resting.contains(&stop) { 0 } else { self.passed(stop) };
        }
    }

    /// Whether all stops on which joints rest push, and no joint moves into one that it touches, in a state of the mechanism that holds
    /// what rests and sticks.
    pub(crate) fn stops_hold(&mut self, state: &State, touched: &[usize]) -> bool {
        self.accelerate(&state.at());
        let (a, lambda) = (self.a.clone(), self.lambda.clone());
        let slack = slack(&self.pattern().metric, &a, &lambda);
        let pushes = self.rests_by_rows().all(|(row, sense)| -sense * lambda[row] >= -slack);
        let largest = a.iter().zip(&self.pattern().size_v).fold(0.0, |m: f64, (a, size)| m.max((a / size).abs()));
        let into = |stop: &usize| {
            let size = self.dynamics.mechanism.stops[*stop].size(self.size);
            self.parts(Touching::Stop(*stop), &a) < -NO_ACCELERATION * largest * size
        };
        pushes && !touched.iter().any(into)
    }
}
