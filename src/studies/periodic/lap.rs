//! One period of the motion: from a state to where the period ends.

use super::saltation::{Side, instant};
use crate::expression::Id;
use crate::geometry::Space;
use crate::mechanism::Coordinates;
use crate::model::{Crossing, Event, Family, Model, Study};
use crate::results::{Certificate, Failure, Finding, Happened};
use crate::studies::common::case::Case;
use crate::studies::common::observe::Observer;
use crate::studies::dynamics::march;
use crate::studies::dynamics::march::Recorded;
use crate::studies::dynamics::phases::Phases;
use crate::studies::dynamics::setup::Plan;
use crate::studies::dynamics::system::Mechanical;
use crate::studies::dynamics::trajectory::{PhaseSystem, Trajectory};
use grashof_solvers::{Control, Method, Node, Settings, State, System};
use std::cell::Cell;

/// Name of the event that ends a period: none that a model can give.
const ENDS: &str = "(end of the period)";

/// Time that no period is expected to last, s.
const FOREVER: f64 = 1e6;

/// Most steps in one period.
const MOST_STEPS: usize = 50_000;

/// Where a period ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Section {
    /// After so long a time, s.
    Time(f64),
    /// Where the expression has advanced by so much.
    Advance(Id, f64),
    /// Where the expression rises through 0.
    Return(Id),
}

/// What a period is, and how the motion in it is integrated.
pub(super) struct Search<'a> {
    /// The model of the study; it has one event more while a period runs.
    pub(super) model: Model,
    pub(super) study: &'a Study,
    /// What advances, in words.
    pub(super) over: String,
    pub(super) section: Section,
    /// Value of the expression of the section where a period begins.
    pub(super) begin: f64,
    /// Columns.
    pub(super) ids: Vec<Id>,
    /// Which of them is the expression of the section.
    pub(super) mark: usize,
    pub(super) coordinates: Coordinates,
    pub(super) tolerance: f64,
    pub(super) stop: &'a dyn Fn() -> bool,
}

/// A period that has been run.
pub(super) struct Lap<'e, G: Space<S = f64>> {
    pub(super) trajectory: Trajectory<'e, G>,
    pub(super) certificate: Certificate,
    pub(super) events: Vec<Happened>,
    pub(super) findings: Vec<Finding>,
    pub(super) start: Node,
    /// Behind the corner of a law at which it ends, if it ends at one, as the start is.
    pub(super) end: Node,
    /// The switches of that corner, and the node before it.
    pub(super) corner: Option<(Vec<usize>, Box<Node>)>,
}

impl<G: Space<S = f64>> Lap<'_, G> {
    /// Its time, s.
    pub(super) fn period(&self) -> f64 {
        self.end.state.t - self.start.state.t
    }

    /// Whether no force, stop or event has taken or given energy in it.
    pub(super) fn keeps_energy(&self) -> bool {
        self.certificate.march.as_ref().is_some_and(|march| march.works().iter().all(|(_, work)| *work == 0.0))
    }
}

/// Why a period did not come to its end.
pub(super) enum Broken {
    /// The run did not begin.
    Failure(Failure),
    /// It stopped, in words.
    Stopped(String),
    /// The end of the period was never reached: how far `over` has come, and the time if steps have run out.
    Never { gone: f64, t: Option<f64> },
}

impl Search<'_> {
    /// The expression whose value ends a period.
    pub(super) fn marked(&self) -> Option<Id> {
        match self.section {
            Section::Time(_) => None,
            Section::Advance(id, _) | Section::Return(id) => Some(id),
        }
    }

    /// Runs from a state to the end of the period, at a tolerance.
    pub(super) fn lap<'e, G: Space<S = f64>>(&mut self, phases: &'e Phases<G>, from: &State, tolerance: f64) -> Result<Lap<'e, G>, Broken> {
        let begin = self.value(phases, from);
        let (until, ends) = match self.section {
            Section::Time(period) => (from.t + period, None),
            Section::Advance(id, by) => {
                let target = self.model.pool.constant(begin + by);
                let crossing = if by > 0.0 { Crossing::Rising } else { Crossing::Falling };
                (from.t + FOREVER, Some((self.model.pool.sub(id, target), crossing)))
            }
            Section::Return(id) => (from.t + FOREVER, Some((id, Crossing::Rising))),
        };
        if let Some((when, crossing)) = ends {
            let place = self.study.place.clone();
            let event = Event { name: ENDS.into(), when, crossing, stop: true, set: Vec::new(), restitution: None, place };
            self.model.events.push(event);
        }
        let run = self.march(phases, from, until, tolerance);
        if ends.is_some() {
            self.model.events.pop();
        }
        let (recorded, exhausted) = run.map_err(Broken::Failure)?;
        self.finish(recorded, exhausted, until, begin)
    }

    /// The run itself, and whether it took too many steps.
    fn march<'e, G: Space<S = f64>>(
        &self,
        phases: &'e Phases<G>,
        from: &State,
        until: f64,
        tolerance: f64,
    ) -> Result<(Recorded<'e, G>, bool), Failure> {
        let steps = Cell::new(0);
        let stop = || {
            steps.set(steps.get() + 1);
            steps.get() > MOST_STEPS || (self.stop)()
        };
        let control = Control::Tolerance(tolerance);
        let plan = Plan {
            until,
            every: None,
            settings: Settings { method: Method::Auto, control, balance: true, ..Settings::default() },
            coordinates: self.coordinates,
            minimal: false,
            family: Family::Either,
            integrator: None,
        };
        let m = &phases.mechanism;
        let modes = self.alone(phases, &[]).dims().modes + self.model.events.len();
        let state = with_modes(from, m.switches + m.windings, modes);
        let case = Case::new(&self.model, self.study, &phases.parameters);
        let recorded = march::march(case, &plan, &self.ids, phases, Some(&state), (&stop, None))?;
        Ok((recorded, steps.get() > MOST_STEPS))
    }

    /// The lap that a run has left, if it has come to its end.
    fn finish<'e, G: Space<S = f64>>(
        &self,
        recorded: Recorded<'e, G>,
        exhausted: bool,
        until: f64,
        begin: f64,
    ) -> Result<Lap<'e, G>, Broken> {
        let Recorded { mut trajectory, stopped, undefined, mut events, certificate, findings } = recorded;
        if let Some(undefined) = undefined {
            return Err(Broken::Failure(Failure::Undefined(undefined)));
        }
        if let (Some(why), false) = (&stopped, exhausted) {
            return Err(Broken::Stopped(why.clone()));
        }
        let breaks = trajectory.breaks();
        let (Some(&first), Some(&last)) = (breaks.first(), breaks.last()) else { return Err(Broken::Never { gone: 0.0, t: None }) };
        let lost = |_| Broken::Stopped(format!("the state at t = {last} s could not be evaluated"));
        trajectory.go(first, 0).map_err(lost)?;
        let start = trajectory.node.clone();
        let pieces = breaks.len() - 1;
        trajectory.go(last, pieces - 1).map_err(lost)?;
        let end = trajectory.node.clone();
        let ended = match self.section {
            // an event just before it may leave no step
            Section::Time(_) => last >= until - 4.0 * f64::EPSILON * until.abs(),
            _ => events.pop_if(|e| e.name == ENDS).is_some(),
        };
        if ended && !exhausted {
            let within = instant(end.state.t - start.state.t, self.tolerance);
            let beyond = Side::<G>::from(tools(&mut trajectory)).beyond(&end, within);
            let (end, corner) = match beyond {
                Some((met, behind)) => (behind, Some((met, Box::new(end)))),
                None => (end, None),
            };
            return Ok(Lap { trajectory, certificate, events, findings, start, end, corner });
        }
        match events.last() {
            Some(event) if !exhausted && last < until => {
                Err(Broken::Stopped(format!("the event `{}` ends the motion at t = {last:.6} s", event.name)))
            }
            _ => {
                let gone = if self.marked().is_some() { trajectory.outputs(pieces - 1)[self.mark] - begin } else { 0.0 };
                Err(Broken::Never { gone, t: exhausted.then_some(last) })
            }
        }
    }

    /// The state at the assembled start.
    pub(super) fn start<G: Space<S = f64>>(&self, phases: &Phases<G>) -> State {
        march::begin(phases, self.alone(phases, &[]).dims())
    }

    /// The expression of the section in a state; 0 where only time counts.
    pub(super) fn value<G: Space<S = f64>>(&self, phases: &Phases<G>, state: &State) -> f64 {
        let Some(id) = self.marked() else { return 0.0 };
        let m = &phases.mechanism;
        let mut system = self.alone(phases, &[id]);
        let mut at = with_modes(state, m.switches + m.windings, system.dims().modes);
        let from = at.clone();
        system.modes(from.at(), &mut at.modes);
        system.observe(&at.at(), &vec![0.0; m.nv], &vec![0.0; m.rows.len()]);
        let mut out = [0.0];
        system.columns(&at.modes, &mut out);
        out[0]
    }

    /// Takes the modes of the switches of a state, as those of a table that counts turns, from its values a short time later.
    pub(super) fn take_modes<G: Space<S = f64>>(&self, phases: &Phases<G>, state: &mut State, short: f64) {
        let m = &phases.mechanism;
        let mut system = self.alone(phases, &[]);
        let mut at = with_modes(state, m.switches + m.windings, system.dims().modes);
        m.retract(&mut at.q, &at.v.iter().map(|v| short * v).collect::<Vec<_>>());
        at.t += short;
        let from = at.clone();
        system.modes(from.at(), &mut at.modes);
        state.modes[..m.switches].copy_from_slice(&at.modes[..m.switches]);
    }

    /// The mechanism with columns and without events.
    fn alone<'e, G: Space<S = f64>>(&self, phases: &'e Phases<G>, ids: &[Id]) -> Mechanical<'e, G> {
        let observer = Observer::new(&self.model, &phases.mechanism, &phases.parameters, ids);
        Mechanical::new(&phases.mechanism, &phases.start, observer, Vec::new())
    }
}

/// A state whose first modes are kept, and whose others are to be taken from its values.
fn with_modes(state: &State, kept: usize, all: usize) -> State {
    let mut state = state.clone();
    state.modes.truncate(kept);
    state.modes.resize(all, 0);
    state
}

/// The first phase of a trajectory: a system with its engine, to evaluate other states with.
pub(super) fn tools<'t, 'e, G: Space<S = f64>>(trajectory: &'t mut Trajectory<'e, G>) -> &'t mut PhaseSystem<'e, G> {
    &mut trajectory.phases[0]
}
