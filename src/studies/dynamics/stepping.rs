//! A motion in time that is advanced from outside, and whose parameters may be set on the way.

use super::chart::Charted;
use super::depart::depart;
use super::explain;
use super::march::begin;
use super::phases::Phases;
use super::setup::{Plan, plan};
use super::system::Mechanical;
use super::watch::swept;
use crate::expression::Id;
use crate::geometry::Space;
use crate::model::{Forward, Model, Study};
use crate::results::Failure;
use crate::studies::common::case::{Case, parameters, parameters_with};
use crate::studies::common::observe::Observer;
use grashof_solvers::{Halt, Integration, Node, Progress, Settings, State, System};

/// The mechanism of a motion at values of its parameters, which [`Flow`] moves.
pub(crate) struct Stepping<G: Space<S = f64>> {
    phases: Phases<G>,
    plan: Plan,
    /// Parameters that were set since the start.
    changed: Vec<(usize, f64)>,
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
        Ok(Self { phases, plan, changed: Vec::new() })
    }

    /// Whether something changes the mechanism on the way.
    pub(crate) fn changes(&self, model: &Model) -> bool {
        let m = &self.phases.mechanism;
        !m.stops.is_empty() || !m.contacts.is_empty() || !model.events.is_empty()
    }

    /// The same mechanism with a parameter at another value; those that depend on it follow.
    ///
    /// # Errors
    /// If the parameters allow no mechanism.
    pub(crate) fn set(&self, model: &Model, study: &Study, parameter: usize, value: f64) -> Result<Self, Failure> {
        let mut changed = self.changed.clone();
        changed.retain(|(known, _)| *known != parameter);
        changed.push((parameter, value));
        let mut set = swept(study, &self.phases.parameters);
        set.retain(|(swept, _)| changed.iter().all(|(known, _)| known != swept));
        set.extend(&changed);
        let phases = self.phases.anew(model, &parameters_with(model, &set), self.plan.coordinates)?;
        Ok(Self { phases, plan: self.plan.clone(), changed })
    }

    /// The motion from a state, or from the start.
    ///
    /// # Errors
    /// If it does not begin.
    pub(crate) fn begin<'m>(&'m self, model: &'m Model, study: &'m Study, from: Option<&State>) -> Result<Flow<'m, G>, Failure> {
        let phases = &self.phases;
        let ids: Vec<Id> = study.columns.iter().map(|column| column.value).collect();
        let observer = Observer::new(model, &phases.mechanism, &phases.parameters, &ids);
        let mut system = Mechanical::new(&phases.mechanism, &phases.start, observer, Vec::new());
        let mut node = Node::new(system.dims());
        let mut state = from.cloned().unwrap_or_else(|| begin(phases, system.dims()));
        if from.is_none()
            && let Some(departure) = depart(phases, &mut system, &state, self.plan.until)
        {
            state = departure.to;
        }
        let mut sound = 0.0;
        let mut chart = Charted::new(study, &self.plan, system, phases, &state, &mut sound)?;
        let settings = Settings { balance: false, ..self.plan.settings };
        let begun = chart.run(&self.plan, settings, &state);
        let run = begun.map_err(|halt| explain::no_start(study, &phases.mechanism, &phases.start, &halt))?;
        chart.whole(run.node(), &mut node);
        Ok(Flow { model, phases, plan: &self.plan, settings, chart, run, node })
    }
}

/// A motion in progress.
pub(crate) struct Flow<'m, G: Space<S = f64>> {
    model: &'m Model,
    phases: &'m Phases<G>,
    plan: &'m Plan,
    settings: Settings,
    chart: Charted<'m, G>,
    run: Integration,
    node: Node,
}

impl<G> Flow<'_, G>
where
    G: Space<S = f64>,
{
    /// Integrates to a time, s; `stop` is asked between steps, and ends it where it is.
    ///
    /// # Errors
    /// Why the motion cannot go on; the state is the last good one.
    pub(crate) fn advance(&mut self, t: f64, stop: &dyn Fn() -> bool) -> Result<(), String> {
        while self.node.state.t < t && !stop() {
            let progress = self.run.advance(self.chart.system(), t);
            self.chart.whole(self.run.node(), &mut self.node);
            let progress = progress.map_err(|halt| self.explain(&halt))?;
            let stopped = progress == Progress::Stopped;
            if progress != Progress::End && self.chart.turns(&self.node.state, stopped) {
                self.run = self.chart.run(self.plan, self.settings, &self.node.state).map_err(|halt| self.explain(&halt))?;
                self.chart.whole(self.run.node(), &mut self.node);
            } else if stopped {
                return Err(format!("the motion ends at t = {} s", self.node.state.t));
            } else if progress == Progress::End {
                break;
            }
        }
        Ok(())
    }

    fn explain(&mut self, halt: &Halt) -> String {
        explain::halt(self.model, &self.phases.mechanism, self.chart.mechanical(), self.plan, halt)
    }

    /// The present state.
    pub(crate) fn state(&self) -> &State {
        &self.node.state
    }

    /// The columns of the study in the present state, SI.
    pub(crate) fn columns(&mut self) -> Vec<f64> {
        let system = self.chart.mechanical();
        let mut columns = vec![0.0; system.observer.program().outputs()];
        system.observe(&self.node.state.at(), &self.node.a, &self.node.lambda);
        system.columns(&self.node.state.modes, &mut columns);
        columns
    }
}
