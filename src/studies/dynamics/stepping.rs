//! A motion in time that is advanced from outside, and whose parameters may be set on the way.

use super::chart::Charted;
use super::course::{After, Course, Lost, Passed};
use super::depart::depart;
use super::energy::Begins;
use super::explain;
use super::march::begin;
use super::phases::Phases;
use super::setup::{Plan, plan};
use super::watch::swept;
use crate::expression::Id;
use crate::geometry::Space;
use crate::model::{Forward, Model, Study};
use crate::results::{Failure, Happened};
use crate::studies::common::case::{Case, parameters, parameters_with};
use grashof_solvers::{Halt, Integration, Node, Progress, Settings, State, System};

/// The mechanism of a motion at values of its parameters, which [`Flow`] moves.
pub(crate) struct Stepping<G: Space<S = f64>> {
    phases: Phases<G>,
    plan: Plan,
    /// Parameters that were set since the start, with the number of the call, and how many such calls there were.
    changed: Vec<(usize, f64, usize)>,
    calls: usize,
    /// Their values and those of a sweep.
    given: Vec<(usize, f64)>,
}

/// How far a motion has come: what it goes on from with other parameters.
#[derive(Clone, Debug)]
pub(crate) struct Reached {
    state: State,
    passed: Passed,
    /// Calls before which parameters had been set.
    calls: usize,
}

impl<G> Stepping<G>
where
    G: Space<S = f64>,
{
    /// The mechanism at the start.
    ///
    /// # Errors
    /// If the model has none, or it cannot be assembled.
    pub(crate) fn new(model: &Model, study: &Study, forward: &Forward) -> Result<Self, Failure> {
        let values = parameters(model);
        let plan = plan(Case::new(model, study, &values), forward)?;
        let phases = Phases::new(model, &values, plan.coordinates)?;
        let given = swept(study, &values);
        Ok(Self { phases, plan, changed: Vec::new(), calls: 0, given })
    }

    /// The same mechanism with a parameter at another value; those that depend on it follow.
    ///
    /// # Errors
    /// If the parameters allow no mechanism.
    pub(crate) fn set(&self, model: &Model, study: &Study, parameter: usize, value: f64) -> Result<Self, Failure> {
        let mut changed = self.changed.clone();
        changed.retain(|(known, ..)| *known != parameter);
        changed.push((parameter, value, self.calls));
        let mut given = swept(study, &self.phases.parameters);
        given.retain(|(swept, _)| changed.iter().all(|(known, ..)| known != swept));
        given.extend(changed.iter().map(|(parameter, value, _)| (*parameter, *value)));
        let phases = self.phases.anew(model, &parameters_with(model, &given), self.plan.coordinates)?;
        Ok(Self { phases, plan: self.plan.clone(), changed, calls: self.calls + 1, given })
    }

    /// The motion from the start, or from where another one has come to.
    ///
    /// # Errors
    /// If it does not begin.
    pub(crate) fn begin<'m>(&'m self, model: &'m Model, study: &'m Study, from: Option<&Reached>) -> Result<Flow<'m, G>, Failure> {
        let (phases, plan) = (&self.phases, &self.plan);
        let ids: Vec<Id> = study.columns.iter().map(|column| column.value).collect();
        let columns = ids.len();
        let mut course = Course::new(model, plan, &ids, self.given.clone(), &phases.parameters);
        let mut state = match from {
            Some(Reached { state, passed, calls }) => {
                let mut passed = passed.clone();
                // what has been set from outside since counts
                let since = |parameter: usize| self.changed.iter().any(|(known, _, call)| *known == parameter && call >= calls);
                passed.changed.retain(|(parameter, _)| !since(*parameter));
                course.follow(passed);
                state.clone()
            }
            None => begin(phases, course.machine(phases).dims()),
        };
        let settings = Settings { balance: false, ..plan.settings };
        let motion = Motion { model, study, phases, plan, settings, columns, calls: self.calls };
        match motion.leg(&mut course, &mut state) {
            Ok((leg, node)) => Ok(Flow { motion, course, leg, node }),
            Err(Lost::Failure(failure)) => Err(failure),
            Err(Lost::Stopped(why)) => Err(Failure::numerical(why, "go on from another state, or with other parameters")),
        }
    }
}

/// What stays the same all the way.
struct Motion<'m, G: Space<S = f64>> {
    model: &'m Model,
    study: &'m Study,
    phases: &'m Phases<G>,
    plan: &'m Plan,
    settings: Settings,
    /// Number of columns.
    columns: usize,
    /// Calls that had set parameters.
    calls: usize,
}

/// From one change of the mechanism to the next.
struct Leg<'m, G: Space<S = f64>> {
    phase: &'m Phases<G>,
    chart: Charted<'m, G>,
    run: Integration,
    /// Whether an event has ended the motion.
    ended: bool,
}

impl<'m, G> Motion<'m, G>
where
    G: Space<S = f64>,
{
    /// Begins to go on from a state; the leg, and where it begins.
    fn leg(&self, course: &mut Course<'m>, state: &mut State) -> Result<(Leg<'m, G>, Node), Lost> {
        loop {
            let first = course.begins == Begins::Run;
            let phase = course.next(self.phases, state)?;
            let mut system = course.machine(phase);
            // nobody may see a stop that pulls, not even for the instant in which a parameter is set
            if let Some(stop) = system.let_go_pulled(state) {
                course.let_go(stop);
                continue;
            }
            let mut node = Node::new(system.dims());
            if first && let Some(departure) = depart(phase, &mut system, state, self.plan.until) {
                *state = departure.to;
            }
            let mut chart = Charted::new(self.study, self.plan, system, phase, state, &mut 0.0).map_err(Lost::Failure)?;
            let run = match chart.run(self.plan, self.settings, state) {
                Ok(run) => run,
                Err(halt) if first => {
                    return Err(Lost::Failure(explain::no_start(self.study, &phase.mechanism, &phase.start, &halt)));
                }
                Err(halt) => return Err(Lost::Stopped(self.explain(phase, &mut chart, &halt))),
            };
            chart.whole(run.node(), &mut node);
            // what crosses in the same instant as the event before
            let at_once = if first { Vec::new() } else { chart.mechanical().flipped(&state.modes, &node.state.modes) };
            let at_once = course.hits(at_once, node.state.t);
            course.note(&at_once, node.state.t);
            let mut leg = Leg { phase, chart, run, ended: false };
            if course.ends_or_sets(&at_once) {
                state.copy_from(&node.state);
                match course.stopped_by(&mut leg.chart, &node, &at_once) {
                    After::Done => leg.ended = true,
                    After::Stopped(why) => return Err(Lost::Stopped(why)),
                    After::Changed => continue,
                }
            }
            return Ok((leg, node));
        }
    }

    fn explain(&self, phase: &Phases<G>, chart: &mut Charted<'m, G>, halt: &Halt) -> String {
        explain::halt(self.model, &phase.mechanism, chart.mechanical(), self.plan, halt)
    }
}

/// A motion in progress.
pub(crate) struct Flow<'m, G: Space<S = f64>> {
    motion: Motion<'m, G>,
    course: Course<'m>,
    leg: Leg<'m, G>,
    node: Node,
}

impl<G> Flow<'_, G>
where
    G: Space<S = f64>,
{
    /// Integrates to a time, s, or to an event that ends the motion; `stop` is asked between steps, and ends it where it is.
    ///
    /// # Errors
    /// Why the motion cannot go on; the state is the last good one.
    pub(crate) fn advance(&mut self, t: f64, stop: &dyn Fn() -> bool) -> Result<(), String> {
        if self.leg.ended && self.node.state.t < t {
            let last = self.course.events.last().map_or_else(String::new, |event| format!(" by the event `{}`", event.name));
            return Err(format!("the motion has ended{last} at t = {} s", self.node.state.t));
        }
        while !self.leg.ended && self.node.state.t < t && !stop() {
            let Self { motion, course, leg, node } = self;
            let Leg { phase, chart, run, ended } = leg;
            let progress = match run.advance(chart.system(), t) {
                Ok(progress) => progress,
                Err(halt) => {
                    chart.whole(run.node(), node);
                    return Err(motion.explain(phase, chart, &halt));
                }
            };
            let (happened, stopped) = (matches!(progress, Progress::Event | Progress::Stopped), progress == Progress::Stopped);
            if happened {
                chart.whole(run.before(), node);
                let (before, counted) = (node.clone(), course.happened(chart, run));
                chart.whole(run.node(), node);
                // the last roots are those of the coordinates themselves
                let own = run.crossed().iter().all(|root| *root >= chart.mechanical().roots.len());
                if stopped && !(own && chart.turns(&node.state, true)) {
                    match course.stopped_by(chart, &before, &counted) {
                        After::Done => *ended = true,
                        After::Stopped(why) => return Err(why),
                        After::Changed => self.go_on()?,
                    }
                    continue;
                }
            } else {
                chart.whole(run.node(), node);
            }
            if stopped || progress != Progress::End && chart.turns(&node.state, false) {
                *run = chart.run(motion.plan, motion.settings, &node.state).map_err(|halt| motion.explain(phase, chart, &halt))?;
                chart.whole(run.node(), node);
            } else if progress == Progress::End {
                break;
            }
        }
        Ok(())
    }

    /// Goes on with another mechanism.
    fn go_on(&mut self) -> Result<(), String> {
        let mut state = self.node.state.clone();
        match self.motion.leg(&mut self.course, &mut state) {
            Ok((leg, node)) => {
                (self.leg, self.node) = (leg, node);
                Ok(())
            }
            Err(Lost::Failure(failure)) => Err(failure.reason()),
            Err(Lost::Stopped(why)) => Err(why),
        }
    }

    /// The present state.
    pub(crate) fn state(&self) -> &State {
        &self.node.state
    }

    /// How far it has come.
    pub(crate) fn reached(&self) -> Reached {
        Reached { state: self.node.state.clone(), passed: self.course.passed(), calls: self.motion.calls }
    }

    /// The events so far.
    pub(crate) fn events(&self) -> &[Happened] {
        &self.course.events
    }

    /// Whether an event has ended the motion.
    pub(crate) fn ended(&self) -> bool {
        self.leg.ended
    }

    /// The columns of the study in the present state, SI.
    pub(crate) fn columns(&mut self) -> Vec<f64> {
        let system = self.leg.chart.mechanical();
        let mut columns = vec![0.0; system.observer.program().outputs()];
        system.observe(&self.node.state.at(), &self.node.a, &self.node.lambda);
        system.columns(&self.node.state.modes, &mut columns);
        columns.truncate(self.motion.columns);
        columns
    }
}
