//! An integration alone, for measurements: nothing is recorded but its end.

use super::chart::Charted;
use super::depart::depart;
use super::energy::Balance;
use super::energy::Begins;
use super::explain;
use super::march::begin;
use super::phases::Phases;
use super::setup::Plan;
use super::system::Mechanical;
use super::watch::watched;
use crate::expression::Id;
use crate::geometry::Space;
use crate::model::Family;
use crate::results::Failure;
use crate::studies::common::case::Case;
use crate::studies::common::observe::Observer;
use grashof_solvers::{Control, Counts, Engine, Node, Progress, Settings, Stage, System};

/// What an integration alone has come to: nothing is recorded but its end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Unrecorded {
    /// Time reached, s.
    pub t: f64,
    /// Columns of the study there.
    pub columns: Vec<f64>,
    /// Largest |E − E(0) − work|, J, of the end alone.
    pub energy_drift: f64,
    /// Largest residuals of positions and velocities at the end, in units of size.
    pub residuals: [f64; 2],
    /// What was spent.
    pub counts: Counts,
    /// Why it has stopped on its way.
    pub stopped: Option<String>,
}

/// Integrates a plan to its end, for measurements: `timer` is called with true when the steps begin and with false when they end.
///
/// # Errors
/// If the run did not begin.
pub(super) fn unrecorded<G: Space<S = f64>>(
    case: Case<'_>,
    plan: &Plan,
    ids: &[Id],
    phases: &Phases<G>,
    timer: &mut dyn FnMut(bool),
) -> Result<Unrecorded, Failure> {
    let Case { model, study, .. } = case;
    let (all, watched) = watched(model, ids);
    let observer = Observer::new(model, &phases.mechanism, &phases.parameters, &all);
    let mut system = Mechanical::new(&phases.mechanism, &phases.start, observer, watched);
    let dims = system.dims();
    let mut state = begin(phases, dims);
    if let Some(departure) = depart(phases, &mut system, &state, plan.until) {
        state = departure.to;
    }
    let mut chart = Charted::new(study, plan, system, phases, &state, &mut 0.0)?;
    let mut node = Node::new(dims);
    let mut balance = Balance::default();
    let settings = Settings { balance: false, ..plan.settings };
    if plan.family == Family::Implicit {
        // the steps would make it else
        chart.mechanical().linearizer();
    }
    timer(true);
    let mut run = chart.run(plan, settings, &state).map_err(|halt| explain::no_start(study, &phases.mechanism, &phases.start, &halt))?;
    chart.whole(run.node(), &mut node);
    balance.begin(chart.mechanical(), &node, Begins::Run);
    let stopped = loop {
        match run.advance(chart.system(), plan.until) {
            Ok(Progress::End) => break None,
            Ok(Progress::Step | Progress::Event) if !chart.is_bridge() => {}
            Ok(progress) => {
                chart.whole(run.node(), &mut node);
                if chart.turns(&node.state, progress == Progress::Stopped) {
                    balance.turn(&run, chart.is_bridge().then_some(node.state.t));
                    match chart.run(plan, settings, &node.state) {
                        Ok(next) => run = next,
                        Err(halt) => break Some(explain::halt(model, &phases.mechanism, chart.mechanical(), plan, &halt)),
                    }
                } else if progress == Progress::Stopped {
                    break None;
                }
            }
            Err(halt) => break Some(explain::halt(model, &phases.mechanism, chart.mechanical(), plan, &halt)),
        }
    };
    timer(false);
    chart.whole(run.node(), &mut node);
    balance.end(chart.mechanical(), &node, &run, Counts::default());
    drop(run);
    let mut columns = vec![0.0; all.len()];
    let mut engine = Engine::new(chart.mechanical(), Control::Tolerance(1e-8));
    engine.evaluate(chart.mechanical(), node.state.at(), Stage::Velocity);
    let residuals = [engine.position_residual(), engine.velocity_residual(&node.state.v)];
    chart.mechanical().observe(&node.state.at(), &node.a, &node.lambda);
    chart.mechanical().columns(&node.state.modes, &mut columns);
    columns.truncate(ids.len());
    let (energy_drift, counts) = balance.finish(plan, &study.place).0.march.map_or_else(Default::default, |m| (m.energy_drift, m.counts));
    Ok(Unrecorded { t: node.state.t, columns, energy_drift, residuals, counts, stopped })
}
