//! The course of a motion: which mechanism it goes on with behind events that set parameters, blows, and friction that holds or gives way.

use super::chart::Charted;
use super::energy::Begins;
use super::explain;
use super::phases::{Holds, Phases};
use super::setup::Plan;
use super::system::{Mechanical, Met, Watched};
use super::watch::watched;
use crate::expression::Id;
use crate::geometry::Space;
use crate::model::{Crossing, Model};
use crate::results::{Failure, Happened};
use crate::studies::common::case::parameters_with;
use crate::studies::common::observe::Observer;
use grashof_solvers::{Integration, Node, State, Zeno};

/// Part of the time within which an event before a blow and one behind it are of the same instant.
const INSTANT: f64 = 1e-9;

/// Changes at one time, for each stop and contact, behind which there is no end of them.
const CHANGES: usize = 50;

/// How a phase has ended.
pub(super) enum After {
    Done,
    Stopped(String),
    Changed,
}

/// Why there is no mechanism to go on with.
pub(super) enum Lost {
    /// The motion does not begin.
    Failure(Failure),
    /// It ends there.
    Stopped(String),
}

/// What a motion has behind it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Passed {
    /// Parameters that events have set.
    pub(super) changed: Vec<(usize, f64)>,
    /// Stops on which joints rest, and contacts that stick.
    holds: Holds,
    /// Events so far.
    events: Vec<Happened>,
}

/// What has changed so far, and what decides on the next change.
pub(super) struct Course<'a> {
    model: &'a Model,
    plan: &'a Plan,
    /// Columns, then event functions and new values of parameters; and the events that watch them.
    outputs: Vec<Id>,
    watched: Vec<Watched>,
    /// Number of columns: event functions follow them among the outputs.
    columns: usize,
    /// Parameters with values of their own from the begin.
    given: Vec<(usize, f64)>,
    /// All parameters at present.
    parameters: Vec<f64>,
    zeno: Zeno,
    /// Parameters that events have set.
    pub(super) changed: Vec<(usize, f64)>,
    /// Events so far.
    pub(super) events: Vec<Happened>,
    /// Stops on which joints rest, and contacts that stick.
    pub(super) holds: Holds,
    /// Contacts that stopped or gave way at the end of the phase before, and whether all were let go for a blow.
    met: Vec<Met>,
    loosened: bool,
    /// Whether the phase before has ended at such contacts.
    piles: bool,
    /// Time of the last change, s, and how many there were at it.
    at_once: (f64, usize),
    /// Contacts whose friction was not determined at some time.
    pub(super) open: Vec<usize>,
    pub(super) begins: Begins,
    /// When a joint has met a stop last, s.
    blow: f64,
    /// Whether an event has ended the motion.
    pub(super) ended: bool,
}

impl<'a> Course<'a> {
    /// From the start, of `parameters` of which those in `given` have values of their own; with the columns `ids`.
    pub(super) fn new(model: &'a Model, plan: &'a Plan, ids: &[Id], given: Vec<(usize, f64)>, parameters: &[f64]) -> Self {
        let (outputs, watched) = watched(model, ids);
        Self {
            model,
            plan,
            outputs,
            watched,
            columns: ids.len(),
            given,
            parameters: parameters.to_vec(),
            zeno: Zeno::default(),
            changed: Vec::new(),
            events: Vec::new(),
            holds: Holds::default(),
            met: Vec::new(),
            loosened: false,
            piles: false,
            at_once: (f64::NEG_INFINITY, 0),
            open: Vec::new(),
            begins: Begins::Run,
            blow: f64::NEG_INFINITY,
            ended: false,
        }
    }

    /// Goes on where another course has come to, with its events and holds, and the parameters that its events have set.
    pub(super) fn follow(&mut self, before: Passed) {
        (self.changed, self.holds, self.events) = (before.changed, before.holds, before.events);
        self.begins = Begins::Parameters;
        self.take_parameters();
    }

    /// What another course needs to go on from here.
    pub(super) fn passed(&self) -> Passed {
        Passed { changed: self.changed.clone(), holds: self.holds.clone(), events: self.events.clone() }
    }

    /// Goes on without the stop on which a joint has rested.
    pub(super) fn let_go(&mut self, stop: usize) {
        self.holds.resting.retain(|resting| *resting != stop);
        self.begins = Begins::Rests;
    }

    /// Takes the parameters that events have set so far.
    fn take_parameters(&mut self) {
        let values: Vec<_> = self.given.iter().chain(&self.changed).copied().collect();
        self.parameters = parameters_with(self.model, &values);
    }

    /// The system of a mechanism of this motion.
    pub(super) fn machine<'m, G: Space<S = f64>>(&self, phase: &'m Phases<G>) -> Mechanical<'m, G> {
        let observer = Observer::new(self.model, &phase.mechanism, &phase.parameters, &self.outputs);
        Mechanical::new(&phase.mechanism, &phase.start, observer, self.watched.clone())
    }

    /// The mechanism to go on with from a state.
    ///
    /// # Errors
    /// If there is none.
    pub(super) fn next<'m, G: Space<S = f64>>(&mut self, phases: &'m Phases<G>, state: &mut State) -> Result<&'m Phases<G>, Lost> {
        let began = self.begins == Begins::Run;
        let goes_on = self.begins == Begins::Rests && self.at_once.0 == state.t;
        let before = if goes_on { self.at_once.1 } else { 0 };
        self.at_once = (state.t, before + 1);
        let m = &phases.mechanism;
        if before > CHANGES * (1 + m.stops.len() + m.contacts.len()) {
            return Err(Lost::Stopped(explain::changes(state.t)));
        }
        if let Some(why) = self.moved_stops(phases, state) {
            return Err(Lost::Stopped(why));
        }
        let phase = match self.choose(phases, state) {
            Ok(Some(phase)) => phase,
            Ok(None) if began => {
                return Err(Lost::Failure(Failure::numerical(explain::jams(phases, state.t), explain::LESS_FRICTION)));
            }
            Ok(None) => return Err(Lost::Stopped(format!("{}; {}", explain::jams(phases, state.t), explain::LESS_FRICTION))),
            Err(Failure::Model(faults)) => {
                return Err(Lost::Stopped(explain::set(self.model, &self.events, &self.changed, state.t, &faults)));
            }
            Err(failure) => return Err(Lost::Stopped(failure.reason())),
        };
        if (self.piles || self.begins == Begins::Parameters) && self.zeno.pile_up(state.t, 0.0) {
            let hunts = explain::hunts(&self.events, state.t);
            return Err(Lost::Stopped(if self.met.is_empty() { hunts } else { explain::chatters(phases, &self.met, state.t) }));
        }
        Ok(phase)
    }

    /// Lets go the joints whose stops an event has moved away from them; why the run cannot go on, where it has moved one beyond the joint.
    fn moved_stops<G: Space<S = f64>>(&mut self, phases: &Phases<G>, state: &State) -> Option<String> {
        if self.begins != Begins::Parameters || phases.mechanism.stops.is_empty() {
            return None;
        }
        // what the parameters do not allow is told where the phase is chosen
        let base = phases.with(self.model, &self.parameters, self.plan.coordinates, &Holds::default()).ok()?;
        let gaps = self.machine(base).gaps(state);
        let passed = gaps.iter().position(|gap| gap.is_some_and(|gap| gap < 0.0));
        if let Some(stop) = passed {
            return Some(explain::passed(self.model, &base.mechanism.stops[stop], &self.events, state.t));
        }
        self.holds.resting.retain(|stop| gaps[*stop].is_none_or(|gap| gap == 0.0));
        None
    }

    /// The mechanism to go on with, once it is decided which contacts stick from the state on, and on which of the stops that they touch
    /// joints rest; none where no accelerations obey the laws of friction.
    fn choose<'m, G: Space<S = f64>>(&mut self, phases: &'m Phases<G>, state: &mut State) -> Result<Option<&'m Phases<G>>, Failure> {
        if self.loosened {
            self.holds.held.clear();
            return self.phase(phases, &self.holds).map(Some);
        }
        let open = self.phase(phases, &Holds::default())?;
        let contacts = open.mechanism.contacts.len();
        if self.begins == Begins::Run {
            open.mechanism.slide(&vec![0; contacts], &mut state.modes);
        }
        let mut together = None;
        let mut touched = Vec::new();
        if !open.mechanism.stops.is_empty() {
            let mut system = self.machine(open);
            touched = system.touched(state, &self.holds.resting);
            let stops = [&touched[..], &self.holds.resting];
            together = if touched.is_empty() { None } else { system.decide(state, &self.holds.held, &self.met, stops) };
            if let Some(decided) = &together {
                self.holds.resting.clone_from(&decided.resting);
                system.leave(&touched, &decided.resting, state);
            }
        }
        let free = Holds { held: Vec::new(), ..self.holds.clone() };
        let base = self.phase(phases, &free)?;
        if contacts == 0 {
            return Ok(Some(base));
        }
        // beside stops that hold, what friction does is decided anew: where both could hold the same, stops do
        let mut system = self.machine(base);
        let beside = system.decide(state, &self.holds.held, &self.met, [&[], &[]]);
        let holds = |course: &mut Self, held: Vec<usize>, senses: &[i32], state: &mut State| {
            base.mechanism.slide(senses, &mut state.modes);
            course.holds.held = held;
            course.phase(phases, &course.holds)
        };
        let (before, held) = (state.modes.clone(), self.holds.held.clone());
        let mut open_friction = beside.as_ref().map(|decided| decided.open.clone()).unwrap_or_default();
        let mut phase = match beside {
            Some(decided) => Some(holds(self, decided.held, &decided.senses, state)?),
            None => None,
        };
        if let Some(decided) = together
            && phase.is_none_or(|phase| !self.machine(phase).stops_hold(state, &touched))
        {
            (state.modes, self.holds.held) = (before, held);
            open_friction.clone_from(&decided.open);
            phase = Some(holds(self, decided.held, &decided.senses, state)?);
        }
        let Some(phase) = phase else { return Ok(None) };
        // where the evaluator has them: what is held near its start stands there exactly
        state.live = self.machine(phase).extents(state);
        self.open.extend(open_friction);
        Ok(Some(phase))
    }

    /// The mechanism at the present parameters with given holds.
    fn phase<'m, G: Space<S = f64>>(&self, phases: &'m Phases<G>, holds: &Holds) -> Result<&'m Phases<G>, Failure> {
        phases.with(self.model, &self.parameters, self.plan.coordinates, holds)
    }

    /// Notes the events of the model that the last step has ended at; their numbers.
    pub(super) fn happened<G: Space<S = f64>>(&mut self, chart: &mut Charted<'_, G>, run: &Integration) -> Vec<usize> {
        let state = &run.node().state;
        let system = chart.mechanical();
        let crossed = run.crossed().iter().filter(|r| **r < system.roots.len());
        let counted: Vec<usize> = crossed.clone().filter_map(|root| system.event_of(*root, state)).collect();
        let t = state.t;
        if crossed.into_iter().any(|root| system.strikes(*root)) {
            self.blow = t;
        }
        system.forget_struck();
        let counted = self.hits(counted, t);
        self.note(&counted, t);
        counted
    }

    /// Events without those that a stop has thrown back through zero: a function that is zero at a stop only touches zero there, and rounding
    /// leads it beyond and back. One hit is one event, however its directions count.
    pub(super) fn hits(&self, counted: Vec<usize>, t: f64) -> Vec<usize> {
        let near = INSTANT * t;
        let touched = |event: &usize| {
            let event = &self.model.events[*event];
            let last = self.events.iter().rev().take_while(|e| t - e.at <= near).find(|e| e.name == event.name);
            event.crossing == Crossing::Both && last.is_some_and(|last| self.blow >= last.at - near)
        };
        counted.into_iter().filter(|event| !touched(event)).collect()
    }

    /// Notes events by their numbers.
    pub(super) fn note(&mut self, counted: &[usize], at: f64) {
        self.events.extend(counted.iter().map(|&e| Happened { name: self.model.events[e].name.clone(), at }));
    }

    /// Whether one of these events ends the run or sets parameters.
    pub(super) fn ends_or_sets(&self, counted: &[usize]) -> bool {
        counted.iter().any(|&e| self.model.events[e].stop || !self.model.events[e].set.is_empty())
    }

    /// A run that was stopped by events: ended by one of them, or to go on with other parameters.
    pub(super) fn stopped_by<G: Space<S = f64>>(&mut self, chart: &mut Charted<'_, G>, before: &Node, counted: &[usize]) -> After {
        if let Some((row, height)) = chart.mechanical().step() {
            return After::Stopped(explain::step(chart.mechanical().dynamics.mechanism, row, height, before.state.t));
        }
        if let Some(event) = chart.mechanical().restless() {
            return After::Stopped(explain::restless(self.model, event, before.state.t));
        }
        if counted.iter().any(|&e| self.model.events[e].stop) {
            self.ended = true;
            return After::Done;
        }
        let system = chart.mechanical();
        let rests = system.take_rests();
        (self.met, self.loosened) = system.take_met();
        self.begins = Begins::Rests;
        for (stop, rests) in rests {
            self.holds.resting.retain(|s| *s != stop);
            if rests {
                self.holds.resting.push(stop);
            }
        }
        system.observe(&before.state.at(), &before.a, &before.lambda);
        let mut outputs = vec![0.0; system.observer.program().outputs()];
        system.columns(&before.state.modes, &mut outputs);
        let functions = self.model.events.iter().map(|e| 1 + usize::from(e.restitution.is_some())).sum::<usize>();
        let mut place = self.columns + functions;
        let mut one_has_set = false;
        for (i, event) in self.model.events.iter().enumerate() {
            if counted.contains(&i) && !event.set.is_empty() {
                if one_has_set {
                    // what another one of the same instant has set counts for this one
                    self.take_parameters();
                    system.observer = Observer::new(self.model, system.dynamics.mechanism, &self.parameters, &self.outputs);
                    system.observe(&before.state.at(), &before.a, &before.lambda);
                    system.columns(&before.state.modes, &mut outputs);
                }
                for (k, &(parameter, _)) in event.set.iter().enumerate() {
                    self.changed.retain(|(p, _)| *p != parameter);
                    self.changed.push((parameter, outputs[place + k]));
                }
                self.begins = Begins::Parameters;
                one_has_set = true;
            }
            place += event.set.len();
        }
        self.piles = !self.met.is_empty();
        if self.begins == Begins::Parameters {
            self.take_parameters();
        }
        After::Changed
    }
}
