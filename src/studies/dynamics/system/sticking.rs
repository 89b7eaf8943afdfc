//! What sticks and what slides: roots of contacts, and the decision which of those at rest are held.
//!
//! At an instant the contacts that slide have known forces; those at rest have forces f between bounds such that each is held
//! (ẍ = 0) or slides away against its largest force. With the accelerations ẍ = A f + b along the contacts, A and b by the equations
//! of motion without the rows that hold contacts, that is a linear complementarity problem with boxes. Where the bounds depend on
//! reactions, they are taken from the solution before, until they stay.

use super::Mechanical;
use super::root::{Met, Root};
use super::touching::{NO_ACCELERATION, REST, Touching};
use crate::dynamics::slack;
use crate::geometry::Space;
use crate::mechanism::{Contact, ContactLaw, EffortLaw, StretchOf};
use crate::numerics::complementarity::{Bounded, Place, basic, shared, solve};
use grashof_solvers::{At, Effect, Kkt, State};
use nalgebra::{DMatrix, DVector};

/// A contact that has just stopped is no faster than so many times that: its event is located to the rounding of a time.
const STOPPED: f64 = 1e3;

/// A one-way clutch that is met faster than so many times that takes a blow.
const BLOW: f64 = 10.0;

/// Part of what moves freely by which a contact is moved that drivers and other joints hold to its motion.
const DETERMINED: f64 = 1e-10;

/// Inertial forces in parts of the largest force that count as none.
const STILL: f64 = 1e-9;

/// Solutions in which normal forces are taken from the one before, and the part of the forces that they may still change.
const MOST_ROUNDS: usize = 500;
const SETTLED: f64 = 1e-10;

/// Rounds after which only a part of each change is taken: normal forces may go round in a circle.
const PATIENCE: usize = 40;
const PART: f64 = 0.3;

/// What sticks from now on.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Decided {
    /// Contacts that rows hold.
    pub(crate) held: Vec<usize>,
    /// The sense in which each contact slides; 0 if it sticks.
    pub(crate) senses: Vec<i32>,
    /// Contacts at rest whose friction nothing determines: other rows or drivers hold them as well.
    pub(crate) open: Vec<usize>,
    /// Stops on which joints rest, of those that were to be decided.
    pub(crate) resting: Vec<usize>,
}

/// Accelerations (nv) and multipliers (rows) by a force, or what velocities jump by and impulses.
pub(super) struct Response {
    pub(super) a: Vec<f64>,
    pub(super) lambda: Vec<f64>,
}

impl<G> Mechanical<'_, G>
where
    G: Space<S = f64>,
{
    /// A rate of a contact that counts as rest, rad/s or m/s.
    fn rest(&self, contact: &Contact) -> f64 {
        REST * contact.unit(self.size)
    }

    /// The value of a root of a contact that sticks or slides; after the look at the state.
    pub(super) fn grip(&self, root: Root, at: &At<'_>, a: &[f64], lambda: &[f64]) -> f64 {
        let m = self.dynamics.mechanism;
        match root {
            Root::Slides(contact) => {
                let contact = &m.contacts[contact];
                let (rate, rest) = (self.dynamics.extent_rate(contact.along), self.rest(contact));
                match (contact.law, at.modes[contact.mode]) {
                    (ContactLaw::OneWay { .. }, _) => rate + rest,
                    (_, 0) => rest - 0.25 * rate * rate / rest,
                    (_, sense) => f64::from(sense) * rate + rest,
                }
            }
            Root::Holds { contact, row, sense } => {
                let by = f64::from(sense) * lambda[row];
                let slack = slack(&self.pattern.metric, a, lambda);
                match m.contacts[contact].law {
                    ContactLaw::OneWay { .. } if sense > 0 => slack - by,
                    ContactLaw::OneWay { .. } => 1.0,
                    ContactLaw::Friction { holds, pressing, .. } => {
                        let normal = pressing.map_or(1.0, |pressing| self.dynamics.normal(pressing, lambda));
                        self.dynamics.work.force_outputs[holds] * normal + slack - by
                    }
                }
            }
            _ => 1.0,
        }
    }

    /// A contact comes to rest or gives way; at the state looked at last.
    pub(super) fn meet(&mut self, contact: usize, sense: i32, state: &mut State, row: &mut [f64]) -> Effect {
        self.met.push(Met { contact, sense });
        let contact = &self.dynamics.mechanism.contacts[contact];
        if sense == 0 && contact.is_one_way() && self.dynamics.extent_rate(contact.along) < -BLOW * self.rest(contact) {
            row.fill(0.0);
            self.dynamics.extent_gradient(contact.along, |k, x| row[k] += x);
            let waits = self.lets_go() || self.lifts(state, row);
            return if waits { Effect::Stop } else { Effect::Bounce { restitution: 0.0, stops: true } };
        }
        Effect::Stop
    }

    /// Meets contacts that slide, and at the state looked at last have come to rest, to rounding: where a force switches with their rate, as
    /// `sign` of it does, both change at one instant. Whether there are any.
    pub(super) fn turns_back(&mut self, state: &State) -> bool {
        let m = self.dynamics.mechanism;
        let slides = |contact: &Contact| !contact.is_one_way() && state.modes[contact.mode] != 0;
        let rests = |contact: &Contact| self.dynamics.extent_rate(contact.along).abs() <= self.rest(contact);
        let before = self.met.len();
        let turning = (0..m.contacts.len()).filter(|&c| slides(&m.contacts[c]) && rests(&m.contacts[c]));
        let turning: Vec<Met> = turning.map(|contact| Met { contact, sense: 0 }).collect();
        self.met.extend(turning);
        self.met.len() > before
    }

    /// Whether rows hold contacts, so that a blow must wait until they are let go: no friction of finite size withstands a blow.
    pub(super) fn lets_go(&mut self) -> bool {
        self.loosened = self.dynamics.mechanism.held().next().is_some();
        self.loosened
    }

    /// Whether a contact or a stop that a blow has let go has to be decided anew; after the look at the state.
    pub(super) fn undecided(&self, modes: &[i32]) -> bool {
        let closed = |c: &Contact| self.dynamics.extent_rate(c.along).abs() <= 2.0 * self.rest(c);
        let at_rest = |c: &Contact| if c.is_one_way() { closed(c) } else { modes[c.mode] == 0 };
        let stands = |stop: usize| self.left(stop, modes) && self.is_touched(stop);
        self.dynamics.mechanism.contacts.iter().any(at_rest) || (0..self.near.len()).any(stands)
    }

    /// Contacts that stopped or gave way since this was asked last, and whether a blow waits.
    pub(crate) fn take_met(&mut self) -> (Vec<Met>, bool) {
        (std::mem::take(&mut self.met), std::mem::take(&mut self.loosened))
    }

    /// Where each contact stands, rad or m.
    pub(crate) fn extents(&mut self, state: &State) -> Vec<f64> {
        self.kinematics(&state.at());
        self.dynamics.mechanism.contacts.iter().map(|c| self.dynamics.extent(c.along)).collect()
    }

    /// Which contacts are held and how the others slide, from a state on, and which of the stops that joints touch at rest push; `held` are
    /// contacts, and of the `touched` stops `rested` those, that rows have held until now, `met` contacts that have stopped or given way.
    /// No row of this mechanism holds a contact, or one of these stops.
    ///
    /// None where no accelerations obey the laws of friction.
    pub(crate) fn decide(&mut self, state: &State, held: &[usize], met: &[Met], [touched, rested]: [&[usize]; 2]) -> Option<Decided> {
        let m = self.dynamics.mechanism;
        let mut modes = state.modes.clone();
        self.kinematics(&state.at());
        let rates: Vec<f64> = m.contacts.iter().map(|c| self.dynamics.extent_rate(c.along)).collect();
        let sense_of = |c: usize| met.iter().find(|x| x.contact == c).map(|x| x.sense);
        let at_rest = |c: usize| {
            let slow = |times: f64| rates[c].abs() <= times * self.rest(&m.contacts[c]);
            slow(2.0) || held.contains(&c) || sense_of(c).is_some() && slow(STOPPED)
        };
        let resting: Vec<usize> = (0..m.contacts.len()).filter(|c| at_rest(*c)).collect();
        let before: Vec<i32> = m.contacts.iter().map(|c| modes[c.mode]).collect();
        let slides = |c: usize| !m.contacts[c].is_one_way() && !resting.contains(&c);
        let senses: Vec<i32> = (0..m.contacts.len()).map(|c| if slides(c) { rates[c].signum() as i32 } else { 0 }).collect();
        m.slide(&senses, &mut modes);
        let begins = |touching: Touching| match touching {
            Touching::Stop(stop) if rested.contains(&stop) => Place::Between,
            Touching::Stop(_) => Place::Low,
            Touching::Contact(c) => match sense_of(c) {
                Some(1) => Place::Low,
                Some(-1) => Place::High,
                None if !held.contains(&c) && before[c] > 0 => Place::Low,
                None if !held.contains(&c) && before[c] < 0 => Place::High,
                // one that does not carry need not begin to, where others hold the same
                None if !held.contains(&c) && m.contacts[c].is_one_way() => Place::Low,
                _ => Place::Between,
            },
        };
        let stops = touched.iter().map(|stop| Touching::Stop(*stop));
        let all: Vec<Touching> = resting.iter().map(|c| Touching::Contact(*c)).chain(stops).collect();
        let found = self.balance_of(&At { modes: &modes, ..state.at() }, true, &all, held, begins)?;
        let open = found.shared.iter().filter_map(|i| resting.get(*i)).copied().collect();
        let rests = touched.iter().zip(&found.places[resting.len()..]).filter(|(_, place)| **place == Place::Between);
        let mut out = Decided { senses, open, resting: rests.map(|(stop, _)| *stop).collect(), ..Decided::default() };
        for (i, &c) in resting.iter().enumerate() {
            match (m.contacts[c].is_one_way(), found.determined[i], found.places[i]) {
                // one that has just given way carries no more than it can, to round-off: it is not held once more
                (false, None, Place::Between) if found.spent[i] != 0 && sense_of(c) == Some(found.spent[i]) => {
                    out.senses[c] = found.spent[i];
                }
                (_, None, Place::Between) => out.held.push(c),
                // what drivers keep at one rate may carry anything in its sense
                (true, Some(0), _) => out.open.push(c),
                (true, ..) | (_, None, Place::Idle) => {}
                (_, Some(sense), _) => {
                    out.senses[c] = sense;
                    if sense == 0 {
                        out.open.push(c);
                    }
                }
                (_, None, Place::Low) => out.senses[c] = 1,
                (_, None, Place::High) => out.senses[c] = -1,
            }
        }
        Some(out)
    }

    /// Contacts that friction holds where the whole mechanism stands still in a state without velocity, and the senses of those that give
    /// all they can beside them; none where it would move.
    pub(crate) fn gripped(&mut self, state: &State) -> Option<Decided> {
        let m = self.dynamics.mechanism;
        let all: Vec<usize> = (0..m.contacts.len()).collect();
        let mut modes = state.modes.clone();
        m.slide(&vec![0; m.contacts.len()], &mut modes);
        let touching = |contacts: &[usize]| contacts.iter().map(|c| Touching::Contact(*c)).collect::<Vec<_>>();
        let found = self.balance_of(&At { modes: &modes, ..state.at() }, false, &touching(&all), &[], |_| Place::Between)?;
        if !found.rests {
            return None;
        }
        let sense = |c: &usize| match (found.determined[*c], found.places[*c], m.contacts[*c].is_one_way()) {
            (None, Place::Low, false) => 1,
            (None, Place::High, false) => -1,
            _ => 0,
        };
        let senses: Vec<i32> = all.iter().map(sense).collect();
        let held: Vec<usize> = all.into_iter().filter(|c| found.determined[*c].is_none() && found.places[*c] == Place::Between).collect();
        let open = found.shared;
        if senses.iter().any(|sense| *sense != 0) {
            // what they give is the force of one that slides
            m.slide(&senses, &mut modes);
            let found = self.balance_of(&At { modes: &modes, ..state.at() }, false, &touching(&held), &[], |_| Place::Between)?;
            if !found.rests {
                return None;
            }
        }
        Some(Decided { held, senses, open, ..Decided::default() })
    }

    /// Solves for the forces of what touches at rest. Drivers are `driven` on, or stand still; where forces depend on each other stops
    /// hold rather than contacts, and of these those in `first` rather than others.
    fn balance_of(
        &mut self,
        at: &At<'_>,
        driven: bool,
        resting: &[Touching],
        first: &[usize],
        begins: impl Fn(Touching) -> Place,
    ) -> Option<Balanced> {
        let m = self.dynamics.mechanism;
        self.kinematics(at);
        self.dynamics.forces(at.modes);
        self.dynamics.mass();
        let w = &self.dynamics.work;
        let kkt = self.kkt.get_or_insert_with(|| Kkt::of_pattern(&self.pattern));
        kkt.factor(w.mass.values(), w.g.values()).ok()?;
        let mut free = Response { a: vec![0.0; m.nv], lambda: vec![0.0; m.rows.len()] };
        let none = vec![0.0; m.rows.len()];
        let gamma = if driven { &w.gamma } else { &none };
        kkt.solve(&w.force, gamma, &mut free.a, &mut free.lambda);
        let gradients: Vec<Vec<f64>> = resting.iter().map(|touching| self.pushes(*touching)).collect();
        let responses: Vec<Response> = gradients.iter().map(|g| self.response(g)).collect();
        // efforts by reactions of what slides
        let friction_by_reactions: Vec<(f64, usize, Response)> = m
            .efforts
            .iter()
            .filter_map(|effort| match effort.law {
                EffortLaw::Friction { output, pressing: Some(pressing) } => {
                    let size = self.dynamics.work.force_outputs[output];
                    let gradient = self.gradient(effort.along);
                    (size != 0.0).then(|| (size, pressing, self.response(&gradient)))
                }
                _ => None,
            })
            .collect();
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let n = resting.len();
        let a = DMatrix::from_fn(n, n, |i, j| dot(&gradients[i], &responses[j].a));
        let alone: Vec<f64> = resting.iter().map(|touching| self.parts(*touching, &free.a)).collect();
        let freely: Vec<f64> = gradients.iter().map(|gradient| self.freely(gradient)).collect();
        let fixed: Vec<bool> = (0..n).map(|i| a[(i, i)] <= DETERMINED * freely[i]).collect();

        let mut lambda = free.lambda.clone();
        let mut forces = DVector::zeros(n);
        let begin: Vec<Place> = resting.iter().map(|touching| begins(*touching)).collect();
        let mut places = begin.clone();
        let mut last: Vec<f64> = Vec::new();
        for round in 0..MOST_ROUNDS {
            let friction_forces: Vec<f64> =
                friction_by_reactions.iter().map(|(size, pressing, _)| size * self.dynamics.pressing_force(*pressing, &lambda)).collect();
            let caps: Vec<f64> = resting.iter().map(|touching| self.most(*touching, &lambda)).collect();
            let b = DVector::from_fn(n, |i, _| {
                alone[i]
                    + friction_by_reactions.iter().zip(&friction_forces).map(|((_, _, r), f)| f * dot(&gradients[i], &r.a)).sum::<f64>()
            });
            let slack = slack(&self.pattern.metric, &free.a, &lambda);
            let bounded_by = |j: &usize| caps[*j].is_finite();
            let size = |i: usize| b[i].abs() + (0..n).filter(bounded_by).map(|j| a[(i, j)].abs() * caps[j]).sum::<f64>();
            let movable: Vec<usize> = (0..n).filter(|i| !fixed[*i]).collect();
            let bounded: Vec<Bounded> = movable
                .iter()
                .map(|&i| Bounded {
                    low: if self.only_pushes(resting[i]) { 0.0 } else { -caps[i] },
                    high: caps[i],
                    // where a contact that gives way stands must not depend on normal forces that are not yet right; later on one of
                    // several solutions is kept
                    place: if round < PATIENCE { begin[i] } else { places[i] },
                    force: slack,
                    // what is let go accelerates by round-off of forces at first
                    acceleration: f64::max(NO_ACCELERATION * size(i), a[(i, i)] * slack),
                })
                .collect();
            let block = DMatrix::from_fn(movable.len(), movable.len(), |i, j| a[(movable[i], movable[j])]);
            let side = DVector::from_fn(movable.len(), |i, _| b[movable[i]]);
            let (mut f, mut found) = solve(&block, &side, &bounded)?;
            let mut order: Vec<usize> = (0..movable.len()).collect();
            order.sort_by_key(|i| match resting[movable[*i]] {
                Touching::Stop(_) => 0,
                Touching::Contact(contact) if first.contains(&contact) => 1,
                Touching::Contact(_) => 2,
            });
            basic(&block, &side, &bounded, &mut f, &mut found, &order);
            forces.fill(0.0);
            for (k, &i) in movable.iter().enumerate() {
                (forces[i], places[i]) = (f[k], found[k]);
            }
            let part = if round < PATIENCE { 1.0 } else { PART };
            let before = std::mem::replace(&mut lambda, free.lambda.clone());
            let all = friction_by_reactions
                .iter()
                .map(|(_, _, r)| r)
                .zip(friction_forces.iter().copied())
                .chain(responses.iter().zip(forces.iter().copied()));
            for (response, f) in all {
                lambda.iter_mut().zip(&response.lambda).for_each(|(l, r)| *l += f * r);
            }
            lambda.iter_mut().zip(&before).for_each(|(l, before)| *l = before + part * (*l - before));
            let now: Vec<f64> = friction_forces.iter().copied().chain(caps.iter().copied().filter(|c| c.is_finite())).collect();
            let largest = now.iter().fold(slack, |m, x| m.max(x.abs()));
            let stays = last.len() == now.len() && now.iter().zip(&last).all(|(x, y)| (x - y).abs() <= SETTLED * largest);
            if stays || friction_by_reactions.is_empty() && resting.iter().all(|touching| !self.by_reactions(*touching)) {
                // by round-off of forces all moves, also where none of those that touch has a bound
                let still = |i: usize| b[i].abs() <= NO_ACCELERATION * (size(i) + freely[i] * largest) + freely[i] * slack;
                let determined = (0..n).map(|i| fixed[i].then(|| if still(i) { 0 } else { b[i].signum() as i32 })).collect();
                let mut accelerations = free.a;
                let all = friction_by_reactions
                    .iter()
                    .map(|(_, _, r)| r)
                    .zip(friction_forces)
                    .chain(responses.iter().zip(forces.iter().copied()));
                for (response, f) in all {
                    accelerations.iter_mut().zip(&response.a).for_each(|(x, r)| *x += f * r);
                }
                let inertial = accelerations.iter().zip(&self.pattern.metric).fold(0.0, |m, (x, d)| f64::max(m, (x * d).abs()));
                let found: Vec<Place> = movable.iter().map(|i| places[*i]).collect();
                let shared = shared(&block, &found).into_iter().map(|k| movable[k]).collect();
                let spent = |i: usize| i32::from(forces[i] <= -caps[i]) - i32::from(forces[i] >= caps[i]);
                let spent = (0..n).map(spent).collect();
                // what a one-way clutch holds has no bound, so that it is not among these
                let largest = forces.iter().fold(largest, |m, x| m.max(x.abs()));
                return Some(Balanced { places, shared, spent, determined, rests: inertial <= STILL * largest });
            }
            last = now;
        }
        None
    }

    /// Whether the largest force of what touches depends on reactions.
    fn by_reactions(&self, touching: Touching) -> bool {
        let Touching::Contact(contact) = touching else { return false };
        self.dynamics.mechanism.contacts[contact].friction().is_some_and(|(_, pressing)| pressing.is_some())
    }

    /// The largest force or torque of what touches.
    fn most(&self, touching: Touching, lambda: &[f64]) -> f64 {
        let Touching::Contact(contact) = touching else { return f64::INFINITY };
        let Some((holds, pressing)) = self.dynamics.mechanism.contacts[contact].friction() else { return f64::INFINITY };
        let normal = pressing.map_or(1.0, |pressing| self.dynamics.pressing_force(pressing, lambda));
        (self.dynamics.work.force_outputs[holds] * normal).max(0.0)
    }

    /// Rigid stops that joints touch in a state without velocity in which rows hold them to their place.
    pub(crate) fn held_on_stops(&mut self, state: &State) -> Vec<usize> {
        if !self.factored(&state.at()) {
            return Vec::new();
        }
        let stops = &self.dynamics.mechanism.stops;
        let is_touched = |stop: &usize| stops[*stop].event.is_none() && self.gap(*stop).abs() <= 2.0 * self.near[*stop];
        let touched: Vec<usize> = (0..stops.len()).filter(is_touched).collect();
        let mut is_held = |stop: &usize| {
            let gradient = self.gradient(StretchOf::Gauge(self.dynamics.mechanism.stops[*stop].gauge));
            let given = self.response(&gradient).a.iter().zip(&gradient).map(|(a, g)| a * g).sum::<f64>();
            given <= DETERMINED * self.freely(&gradient)
        };
        touched.into_iter().filter(|stop| is_held(stop)).collect()
    }

    /// What a unit force along a gradient would give without rows, by the metric D, which coordinates without mass have, too.
    fn freely(&self, gradient: &[f64]) -> f64 {
        gradient.iter().zip(&self.pattern.metric).map(|(g, d)| g * g / d).sum()
    }

    /// ∂ẋ/∂v (nv) at the state evaluated last.
    pub(super) fn gradient(&self, along: StretchOf) -> Vec<f64> {
        let mut gradient = vec![0.0; self.dynamics.mechanism.nv];
        self.dynamics.extent_gradient(along, |k, x| gradient[k] += x);
        gradient
    }

    /// Evaluates a state and factors M and G there; false if M is singular on the motions that are left.
    pub(super) fn factored(&mut self, at: &At<'_>) -> bool {
        self.kinematics(at);
        self.dynamics.inertias();
        self.dynamics.mass();
        let w = &self.dynamics.work;
        let kkt = self.kkt.get_or_insert_with(|| Kkt::of_pattern(&self.pattern));
        kkt.factor(w.mass.values(), w.g.values()).is_ok()
    }

    /// What a force (nv) does, or an impulse: it is M a + Gᵀλ with G a = 0; by the factors at hand.
    pub(super) fn response(&mut self, force: &[f64]) -> Response {
        let m = self.dynamics.mechanism;
        let mut response = Response { a: vec![0.0; m.nv], lambda: vec![0.0; m.rows.len()] };
        if let Some(kkt) = &mut self.kkt {
            kkt.solve(force, &vec![0.0; m.rows.len()], &mut response.a, &mut response.lambda);
        }
        response
    }
}

/// Forces of what touches at rest as found.
struct Balanced {
    places: Vec<Place>,
    /// Those at a bound whose motion others hold as well.
    shared: Vec<usize>,
    /// The sense in which a contact begins to slide whose force has reached what it can carry, else 0.
    spent: Vec<i32>,
    /// The sense in which a contact begins to move whatever its force, 0 if it does not.
    determined: Vec<Option<i32>>,
    /// Whether nothing accelerates.
    rests: bool,
}
