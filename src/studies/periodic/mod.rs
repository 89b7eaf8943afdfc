//! Periodic regimes: the study kind `periodic`.
//!
//! A run from the start settles until two periods are alike, Newton's method closes the period (`shooting`), with the exact
//! derivative of its map (`monodromy`, `saltation`), and the last period is the regime: columns over what advances in it (`turn`).

mod collocation;
mod explain;
mod instant;
mod lap;
mod monodromy;
mod report;
mod rough;
mod saltation;
mod settle;
mod shooting;
mod stability;
mod states;
mod timed;
mod turn;

use super::common::case::{Case, parameters_with};
use super::common::watched::Watched;
use super::dynamics::phases::Phases;
use crate::geometry::Space;
use crate::mechanism::Coordinates;
use crate::model::{Chart, PeriodEnd, Periodic};
use crate::results::Failure;
use crate::studies::common::outcome::Outcome;
use grashof_solvers::State;
use lap::{Search, Section};
use report::{Columns, Regime};
use settle::Until;
use shooting::Orbit;
use timed::timed;

/// Tolerance of the integration, unless the study gives one; and of the run before the search.
const TOLERANCE: f64 = 1e-12;
const ROUGH: f64 = 1e-6;

/// Part of the largest acceleration by which those of two periods may differ.
const ALIKE: f64 = 1e-6;

/// Runs a periodic study.
///
/// # Errors
/// If there is no regime to be found.
pub(crate) fn run<G>(case: Case<'_>, asked: &Periodic, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
{
    let Case { model, study, .. } = case;
    let watched = Watched::of(study);
    let columns = Columns::of(&watched, asked);
    let mut search = search(case, asked, &columns, stop)?;
    let ways = ways(case, asked);
    let phases = Phases::<G>::new(model, &ways[0], search.coordinates)?;
    let until = asked.settle.map_or(Until::Alike, |id| Until::Time(case.value(id)));
    let start = search.start(&phases);
    let (tolerance, rough) = (search.tolerance, ROUGH.max(search.tolerance));
    let settle = |search: &mut Search<'_>, tolerance: f64| {
        settle::settle(search, &phases, &start, until, tolerance).map_err(|why| explain::broken(search, why))
    };
    search.section = section(case.at(&ways[0]), asked);
    let mut settled = settle(&mut search, rough)?;
    let mut exact = rough == tolerance;
    if settled.keeps_energy && settled.restless.is_none() && !exact {
        // no later period makes good what the run loses
        settled = settle(&mut search, tolerance)?;
        exact = true;
    }
    if let Some(why) = settled.restless.and_then(|restless| explain::unsettled(&search, restless, settled.keeps_energy)) {
        return Err(why);
    }
    let mut states: Vec<State> = vec![settled.state.clone()];
    for (step, values) in ways.iter().enumerate() {
        let phases = Phases::<G>::new(model, values, search.coordinates)?;
        search.section = section(case.at(values), asked);
        search.begin = if matches!(search.section, Section::Return(_)) { 0.0 } else { search.value(&phases, &search.start(&phases)) };
        let mut found = near(&mut search, &phases, &predicted(&states));
        if step == 0 && !exact && found.as_ref().is_ok_and(|orbit| orbit.neutral > 0) {
            // which of a family it is the start decides
            search.section = section(case.at(values), asked);
            settled = settle(&mut search, tolerance)?;
            found = near(&mut search, &phases, &settled.state);
        }
        let last = step + 1 == ways.len();
        match (found, asked.from) {
            (Ok(orbit), _) if last => {
                return Regime { search: &search, asked, case, watched: &watched, columns: &columns }.outcome(
                    &phases,
                    orbit,
                    settled.periods,
                );
            }
            (Ok(orbit), _) if step == 0 => states = vec![orbit.lap.start.state],
            (Ok(orbit), _) => states.push(orbit.lap.start.state),
            (Err(why), _) if step == 0 && settled.restless.is_some() => {
                return Err(explain::still_settling(&settled, why));
            }
            (Err(why), Some(from)) if !last => {
                return Err(explain::on_the_way(why, &model.parameters[from.parameter].name, values[from.parameter]));
            }
            (Err(why), _) => return Err(why),
        }
    }
    Err(Failure::numerical("a continuation has no steps", "give `from` at least one step"))
}

/// The regime near a state.
fn near<'e, G: Space<S = f64>>(search: &mut Search<'_>, phases: &'e Phases<G>, guess: &State) -> Result<Orbit<'e, G>, Failure> {
    by_time(search, phases, guess)?;
    shooting::shoot(search, phases, guess).map_err(|why| explain::lost(search, phases, why))
}

/// The parameters of each step of a continuation; those of the study are the last ones, and the only ones without.
fn ways(case: Case<'_>, asked: &Periodic) -> Vec<Vec<f64>> {
    let parameters = case.parameters;
    let Some(from) = asked.from else { return vec![parameters.to_vec()] };
    let (begin, end) = (case.value(from.at), parameters[from.parameter]);
    let at = |step: usize| begin + (end - begin) * step as f64 / from.steps as f64;
    let before = (0..from.steps).map(|step| with(case, from.parameter, at(step)));
    before.chain([parameters.to_vec()]).collect()
}

/// Where a period ends, at given parameters.
fn section(case: Case<'_>, asked: &Periodic) -> Section {
    match (&asked.over, asked.ends) {
        (Some(over), PeriodEnd::By(by)) => Section::Advance(over.value, case.value(by)),
        (None, PeriodEnd::By(by)) => Section::Time(case.value(by)),
        (_, PeriodEnd::Through(id)) => Section::Return(id),
    }
}

/// Parameters with one of them at another value; those that the study varies keep theirs.
fn with(case: Case<'_>, parameter: usize, x: f64) -> Vec<f64> {
    let Case { model, study, parameters, .. } = case;
    let varied = study.sweep.iter().map(|s| s.parameter).chain(study.solve.iter().map(|s| s.parameter));
    let kept = varied.filter(|p| *p != parameter).map(|p| (p, parameters[p]));
    parameters_with(model, &kept.chain([(parameter, x)]).collect::<Vec<_>>())
}

/// The state that the last two steps of a continuation point to; the last one where it is alone.
fn predicted(states: &[State]) -> State {
    let mut next = states.last().cloned().unwrap_or_default();
    if let [.., before, _] = states {
        let ahead = |x: &mut [f64], from: &[f64]| x.iter_mut().zip(from).for_each(|(x, from)| *x += *x - from);
        ahead(&mut next.q, &before.q);
        ahead(&mut next.v, &before.v);
        ahead(&mut next.z, &before.z);
    }
    next
}

/// What the study asks for, in numbers.
fn search<'a>(case: Case<'a>, asked: &Periodic, columns: &Columns, stop: &'a dyn Fn() -> bool) -> Result<Search<'a>, Failure> {
    let Case { model, study, .. } = case;
    if let Some(event) = model.events.iter().find(|e| !e.set.is_empty()) {
        return Err(Failure::Study {
            code: "events-that-set",
            message: format!("the event `{}` sets a parameter, which is no part of the state that a periodic regime repeats", event.name),
            place: event.place.clone(),
            help: "make what changes a state or a function of the state, or use `dynamics`".into(),
        });
    }
    Ok(Search {
        model: model.clone(),
        study,
        over: asked.over.as_ref().map_or("t".into(), |over| over.name.clone()),
        section: section(case, asked),
        begin: 0.0,
        mark: columns.mark,
        ids: columns.ids.clone(),
        coordinates: if asked.chart == Chart::Cartesian { Coordinates::Cartesian } else { Coordinates::Joint },
        tolerance: asked.tolerance.map_or(TOLERANCE, |id| case.value(id)),
        stop,
    })
}

/// A mechanism on which time acts repeats itself after a time: where what advances is driven by time, after the time in which it
/// does.
fn by_time<G>(search: &mut Search<'_>, phases: &Phases<G>, state: &State) -> Result<(), Failure>
where
    G: Space<S = f64>,
{
    if !timed(&search.model, &phases.mechanism) {
        return Ok(());
    }
    if !matches!(search.section, Section::Time(_)) {
        let mut lap = search.lap(phases, state, search.tolerance).map_err(|why| explain::broken(search, why))?;
        let map = lap.map(search, phases).map_err(|why| explain::rough(search, why))?;
        let free = map.surface.is_some_and(|surface| surface.normal.amax() > 1e-9 * surface.pace.abs());
        if free {
            return Err(explain::not_driven(search));
        }
        search.section = Section::Time(lap.period());
    }
    let mut lap = search.lap(phases, state, search.tolerance).map_err(|why| explain::broken(search, why))?;
    match repeats(&mut lap) {
        Some((t, periods)) => Err(explain::not_repeated(search, t, periods)),
        None => Ok(()),
    }
}

/// The first of some times at which the accelerations of a state are others one period later, or so many periods: of something that
/// changes late, or slowly; farther away by more, since the period is known to some digits.
fn repeats<G: Space<S = f64>>(lap: &mut lap::Lap<'_, G>) -> Option<(f64, u32)> {
    const LOOKS: usize = 7;
    const LATER: [(u32, f64); 4] = [(1, ALIKE), (10, 1e-3), (100, 1e-3), (1000, 1e-3)];
    if lap.trajectory.phases.len() > 1 {
        // a joint that rests on a stop is told where the map is asked for
        return None;
    }
    let (breaks, period) = (lap.trajectory.breaks(), lap.period());
    for i in 0..LOOKS {
        let t = period * (i as f64 + 0.37) / LOOKS as f64;
        let piece = breaks.partition_point(|b| *b <= t).clamp(1, breaks.len() - 1) - 1;
        lap.trajectory.go(t, piece).ok()?;
        let here = lap.trajectory.node.clone();
        let size = here.a.iter().chain(&here.zdot).fold(0.0, |m, x| f64::max(m, x.abs()));
        let both = |node: &grashof_solvers::Node| node.a.iter().chain(&node.zdot).copied().collect::<Vec<_>>();
        for (periods, alike) in LATER {
            let mut later = here.clone();
            later.state.t += f64::from(periods) * period;
            let phase = lap::tools(&mut lap.trajectory);
            phase.engine.follow_modes(&mut phase.system, &mut later.state);
            phase.engine.accelerate(&mut phase.system, &mut later).ok()?;
            if both(&here).iter().zip(both(&later)).any(|(a, b)| (a - b).abs() > alike * size) {
                return Some((t, periods));
            }
        }
    }
    None
}
