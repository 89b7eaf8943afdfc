//! The regime as columns, scalars, extremes and a certificate.

use super::lap::{Lap, Search, Section, tools};
use super::shooting::Orbit;
use super::stability::Neighbours;
use super::states::largest;
use super::turn::{Advance, NoTurn, Single, Turn};
use super::{explain, stability};
use crate::expression::{Dimension, Id};
use crate::geometry::Space;
use crate::model::{PeriodEnd, Periodic};
use crate::numerics::continuous::Curve;
use crate::numerics::extremum::{Extremes, extrema};
use crate::numerics::quadrature::integrals;
use crate::numerics::resolve;
use crate::results::{Certificate, Failure, Finding, List, Resolution};
use crate::studies::common::case::Case;
use crate::studies::common::clock::{Clock, Variable};
use crate::studies::common::functional::Functionals;
use crate::studies::common::indeterminate;
use crate::studies::common::numbers::Sources;
use crate::studies::common::outcome::Outcome;
use crate::studies::common::recorder::{Recorded, Recorder};
use crate::studies::common::scene::{self, Span, Subject};
use crate::studies::common::watched::{Watched, in_variable, unresolved};
use crate::studies::dynamics::phases::Phases;
use crate::studies::dynamics::setup::resolution;
use crate::studies::dynamics::trajectory::Off;
use crate::studies::dynamics::{energy, pose};
use grashof_solvers::{Control, Node};

/// Part of the largest acceleration by which those at the two ends may differ.
const SAME: f64 = 1e-5;

/// In tolerances, how far velocities at the two ends may be apart where nothing accelerates but by round-off.
const STEADY: f64 = 1e3;

/// What is watched in a period.
pub(super) struct Columns {
    pub(super) ids: Vec<Id>,
    /// The quantity whose mean and extremes are found.
    of: usize,
    /// What advances, and its rate.
    over: Option<[usize; 2]>,
    /// The expression that ends the period, if one does.
    pub(super) mark: usize,
}

impl Columns {
    /// Those of a study, then those of the kind.
    pub(super) fn of(watched: &Watched, asked: &Periodic) -> Self {
        let mut ids = watched.ids.clone();
        let mut index = |id: Id| {
            ids.push(id);
            ids.len() - 1
        };
        let of = index(asked.of);
        let over = asked.over.as_ref().map(|over| [index(over.value), index(over.rate)]);
        let mark = match asked.ends {
            PeriodEnd::Through(id) => index(id),
            PeriodEnd::By(_) => over.map_or(of, |[value, _]| value),
        };
        Self { ids, of, over, mark }
    }
}

/// A study that has found its regime.
pub(super) struct Regime<'a> {
    pub(super) search: &'a Search<'a>,
    pub(super) asked: &'a Periodic,
    pub(super) case: Case<'a>,
    pub(super) watched: &'a Watched,
    pub(super) columns: &'a Columns,
}

/// A period seen over the independent variable.
struct Seen<'a> {
    clock: Clock,
    rows: Recorder<'a>,
    /// Times of the rows in the lap, and their pieces.
    times: Vec<(f64, usize)>,
    extremes: Vec<Option<Extremes>>,
    functionals: Vec<f64>,
    findings: Vec<Finding>,
    resolution: Resolution,
}

fn lost(search: &Search<'_>, off: Off) -> Failure {
    if let Some(gap) = &off.gap {
        return Failure::Undefined(gap.explain(&search.model, search.study, &format!("t = {:.6} s", off.at)));
    }
    Failure::numerical(
        format!("the state at t = {} s could not be evaluated", off.at),
        "look at the columns: one of them may not be defined there",
    )
}

impl<'a> Regime<'a> {
    /// Its outcome; `periods` were run before the search.
    pub(super) fn outcome<G: Space<S = f64>>(&self, phases: &Phases<G>, orbit: Orbit<'_, G>, periods: usize) -> Result<Outcome, Failure> {
        let Self { search, asked, case, watched, columns } = *self;
        let Orbit { mut lap, multipliers, neutral, closure, steps } = orbit;
        check_closed(search, &mut lap, closure[1])?;
        let (model, study, period, times) = (&search.model, search.study, lap.period(), lap.trajectory.breaks());
        let mut mean = [0.0];
        let (stretches, width) = (lap.trajectory.stretches(), resolution(Control::Tolerance(search.tolerance)));
        let mut single = Single { trajectory: &mut lap.trajectory, column: columns.of };
        let resolved = resolve::on(&mut single, &stretches, &times, width).map_err(|off| lost(search, off))?;
        integrals(&mut single, &resolved.panels, &resolved.noise, &mut mean).map_err(|off| lost(search, off))?;
        let Seen { clock, rows, times: of_rows, extremes, functionals, findings, resolution } = self.see(&mut lap)?;
        lap.findings.extend(findings);
        lap.findings.extend(indeterminate::open(Case { model, study, ..case }, watched, &phases.mechanism, &phases.start));
        let floquet = multipliers.first().map_or(0.0, |m| m.norm());
        let (max, min) = extremes[columns.of].map_or((f64::NAN, f64::NAN), |e| (e.max.value, e.min.value));
        let results = vec![period, mean[0] / period, max, min, floquet];
        let tables = &phases.mechanism.tables;
        let numbers =
            Sources { case: Case { model, study, ..case }, tables, functionals: &functionals, results: &results, works: &[] }.numbers(true);
        let trajectory = &mut lap.trajectory;
        let ends = [times[0], times[times.len() - 1]];
        let span = Span { ends, times: Some(ends), turns: true, ..Span::default() };
        let over = asked.over.is_some().then_some(columns.over).flatten();
        let mut out = vec![0.0; trajectory.columns()];
        let subject = Subject { case, mechanism: &phases.mechanism };
        let mut at = |t: f64| {
            let Some([value, _]) = over else { return Some((t, pose(trajectory, &times, t)?)) };
            let piece = times.partition_point(|b| *b <= t).clamp(1, times.len() - 1) - 1;
            trajectory.row(t, piece, &mut out).ok()?;
            Some((out[value], trajectory.system(piece).dynamics.poses()))
        };
        let scenes = scene::wanted(case, || subject.over(span, &mut at));
        let one = |name: &str, x: f64| List { name: name.into(), values: vec![x], ..List::default() };
        let mut lists = stability::lists(&multipliers);
        lists.extend([one("closure", closure[0]), one("newton_steps", steps as f64), one("periods_run", periods as f64)]);
        lap.findings.extend(numbers.findings);
        let neighbours = match neutral {
            0 => Neighbours::Apart,
            _ if lap.keeps_energy() => Neighbours::Energies,
            _ => Neighbours::Balanced { advances: matches!(search.section, Section::Advance(..)) },
        };
        lap.findings.push(stability::finding(&multipliers, neighbours, &study.place));
        let some = of_rows.iter().copied().step_by((of_rows.len() / energy::SAMPLES).max(1));
        let certificate =
            Certificate { resolved: Some(resolution), ..energy::residuals(&mut lap.trajectory, (of_rows.len(), some), lap.certificate) };
        lap.findings.extend(energy::open(&certificate, phases.mechanism.size(), &study.place));
        let Recorded { places, switches, rows, selected_from } = rows.recorded();
        Ok(Outcome {
            parameters: case.named(),
            independent: if asked.over.is_some() { search.over.clone() } else { "time".into() },
            places,
            switches,
            rows,
            selected_from,
            stopped: numbers.undefined.as_ref().map(|u| u.message.clone()),
            undefined: numbers.undefined,
            scalars: numbers.scalars,
            expectations: numbers.expectations,
            results,
            lists,
            extremes: watched.columns.iter().map(|&c| extremes[c].map(|e| in_variable(e, clock))).collect(),
            findings: lap.findings,
            certificate,
            events: lap.events,
            scenes,
            ..Outcome::default()
        })
    }

    /// Rows, extremes and functionals of a period.
    fn see<G: Space<S = f64>>(&self, lap: &mut Lap<'_, G>) -> Result<Seen<'a>, Failure> {
        let Self { search, asked, case, watched, columns } = *self;
        let (clock, advance) = clock(asked, case, columns, lap, search).map_err(|off| lost(search, off))?;
        let mut turn = Turn::new(&mut lap.trajectory, advance, clock.length).map_err(|why| match why {
            NoTurn::Off(off) => lost(search, off),
            NoTurn::Back(t) => explain::turns_back(search, t),
        })?;
        let name = if asked.over.is_some() { &search.over } else { "time" };
        let variable = Variable::of(name, search.study.independent.unwrap_or(Dimension::NONE));
        let mut recorder = Recorder::new(case, watched, clock, name, variable);
        let times = rows(&mut turn, asked.samples, &mut recorder).map_err(|off| lost(search, off))?;
        let breaks = turn.breaks.clone();
        let width = resolution(Control::Tolerance(search.tolerance));
        let resolved = resolve::on(&mut turn, &resolve::stretches(&breaks), &breaks, width).map_err(|off| lost(search, off))?;
        turn.all_defined(&resolved).map_err(|off| lost(search, off))?;
        let extremes = extrema(&mut turn, resolved.samples(), &breaks);
        let ends = [0.0, clock.length];
        let mut findings = unresolved(&search.model, search.study, watched, &resolved, &[], variable, clock);
        let mut all = Functionals { clock, ends, curve: &mut turn, resolved: &resolved, extremes: &extremes, breaks: &breaks };
        let functionals = all.all(case, &watched.functionals, &mut findings).map_err(|off| lost(search, off))?;
        Ok(Seen { clock, rows: recorder, times, extremes, functionals, findings, resolution: watched.quality(search.study, &resolved) })
    }
}

/// Refuses a motion that is back in its independent coordinates alone: other coordinates, or the accelerations, differ by more than
/// a part `SAME`. The begin lies behind a switch on which the period ends, so that its modes count at the end, too.
fn check_closed<G: Space<S = f64>>(search: &Search<'_>, lap: &mut Lap<'_, G>, apart: f64) -> Result<(), Failure> {
    let rates = |node: &Node| node.a.iter().chain(&node.zdot).copied().collect::<Vec<_>>();
    let start = rates(&lap.start);
    let size = fastest(lap, &rates, STEADY * search.tolerance / SAME);
    let sizes = vec![size; start.len()];
    let phase = tools(&mut lap.trajectory);
    let mut followed = lap.end.clone();
    phase.engine.follow_modes(&mut phase.system, &mut followed.state);
    let mut differs = f64::INFINITY;
    for modes in [&lap.end.state.modes, &lap.start.state.modes, &followed.state.modes] {
        let mut end = lap.end.clone();
        end.state.modes.clone_from(modes);
        if phase.engine.accelerate(&mut phase.system, &mut end).is_ok() {
            let difference: Vec<f64> = rates(&end).iter().zip(&start).map(|(a, b)| a - b).collect();
            differs = differs.min(largest(&difference, &sizes));
        }
    }
    let worst = apart.max(differs);
    if worst <= SAME { Ok(()) } else { Err(explain::not_closed(search, worst)) }
}

/// The largest acceleration in a lap, and at least one that changes velocities by a `part` of them in a period: where a period begins there
/// may be none, and a steady motion has none but round-off.
fn fastest<G: Space<S = f64>>(lap: &mut Lap<'_, G>, rates: &impl Fn(&Node) -> Vec<f64>, part: f64) -> f64 {
    const LOOKS: usize = 24;
    let (breaks, begin, period) = (lap.trajectory.breaks(), lap.start.state.t, lap.period());
    let steady = lap.start.state.v.iter().chain(&lap.start.state.z).fold(f64::MIN_POSITIVE, |m: f64, x| m.max(part * x.abs() / period));
    let mut size = rates(&lap.start).iter().fold(steady, |m, x| m.max(x.abs()));
    for i in 1..LOOKS {
        let t = begin + period * i as f64 / LOOKS as f64;
        let piece = breaks.partition_point(|b| *b <= t).clamp(1, breaks.len() - 1) - 1;
        if lap.trajectory.go(t, piece).is_ok() {
            size = rates(&lap.trajectory.node).iter().fold(size, |m, x| m.max(x.abs()));
        }
    }
    size
}

/// The independent variable, and what advances in the lap.
fn clock<G: Space<S = f64>>(
    asked: &Periodic,
    case: Case<'_>,
    columns: &Columns,
    lap: &mut Lap<'_, G>,
    _search: &Search<'_>,
) -> Result<(Clock, Option<Advance>), Off> {
    let (Some([value, rate]), PeriodEnd::By(by)) = (columns.over, asked.ends) else {
        return Ok((Clock::of_time(lap.period()), None));
    };
    let by = case.value(by);
    let mut out = vec![0.0; lap.trajectory.columns()];
    lap.trajectory.row(lap.start.state.t, 0, &mut out)?;
    let mut clock = Clock::of_time(by.abs());
    (clock.from, clock.direction) = (out[value], by.signum());
    Ok((clock, Some(Advance { value, rate, from: clock.from, direction: clock.direction })))
}

/// Rows on a grid of progress with both sides of every switch; gives their times and pieces.
fn rows<G: Space<S = f64>>(turn: &mut Turn<'_, '_, G>, samples: usize, recorder: &mut Recorder<'_>) -> Result<Vec<(f64, usize)>, Off> {
    let breaks = turn.breaks.clone();
    let length = breaks[breaks.len() - 1];
    let near = 1e-9 * length / samples as f64;
    let (mut times, mut out) = (Vec::new(), vec![0.0; turn.columns()]);
    for (piece, ends) in breaks.windows(2).enumerate() {
        let grid = (0..=samples).map(|k| length * k as f64 / samples as f64).filter(|s| *s > ends[0] + near && *s < ends[1] - near);
        for s in std::iter::once(ends[0]).chain(grid).chain([ends[1]]) {
            turn.row(s, piece, &mut out)?;
            times.push((turn.time(s, piece)?, piece));
            recorder.row(s, piece, &out);
        }
    }
    Ok(times)
}
