//! Sweeps: one study at many parameter values; failed runs are rows with a reason.

use super::common::case::{Case, Streamed, parameters, parameters_with};
use super::common::named::{self, named};
pub use super::grid::grid;
use super::run::run;
use super::solve::{Solved, Task, solve};
use crate::model::{Model, Study, Sweep, Values};
use crate::par;
use crate::results::Failure;
use crate::results::{self, By, Column, Finding, Results, ShownIn, Solution, Statistics, Swept, SweptBy, Table, number};
use crate::studies::common::outcome::Outcome;
pub use crate::studies::common::settings::{Drawn, Settings};
use std::collections::HashSet;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Digits of swept values in titles and legends, and all that a number has.
const IN_TITLES: usize = 6;
const ALL: usize = 17;
/// Numbers of the drawings of all runs together, so that they are all kept.
const DRAWN: usize = 2_000_000;

/// One run of a study.
#[derive(Clone, Debug)]
pub struct Run {
    /// Values of the swept parameters, in the order of `study.sweep`.
    pub at: Vec<f64>,
    /// What `solve` found, in a study that has it.
    pub solved: Option<Solved>,
    /// What came of it.
    pub result: Result<Box<Outcome>, Failure>,
}

/// The study at one point of its sweep (an empty one if it has none), solved if it has a `solve`; `rows` takes the rows of a motion that is
/// not solved, and `done` is told the parameter and the scalar of each run of a `solve`.
pub fn at(
    model: &Model,
    study: &Study,
    point: Vec<f64>,
    settings: Settings<'_>,
    rows: Option<Streamed<'_>>,
    done: &(dyn Fn(f64, f64) + Sync),
) -> Run {
    let set: Vec<(usize, f64)> = study.sweep.iter().map(|s| s.parameter).zip(point.iter().copied()).collect();
    let (solved, result) = match &study.solve {
        Some(asked) => match solve(&Task { model, study, solve: asked, set: &set, settings, done }) {
            Ok((outcome, solved)) => (Some(solved), Ok(Box::new(outcome))),
            Err(failure) => (None, Err(failure)),
        },
        None => {
            let values = parameters_with(model, &set);
            (
                None,
                run(Case { rows, drawn: settings.drawn != Drawn::None, ..Case::new(model, study, &values) }, settings.stop).map(Box::new),
            )
        }
    };
    let mut run = Run { at: point, solved, result };
    if let Ok(outcome) = &mut run.result
        && !study.sweep.is_empty()
    {
        let caption = label(model, study, &run.at, IN_TITLES);
        outcome.scenes.iter_mut().for_each(|(_, scene)| scene.caption.clone_from(&caption));
    }
    run
}

/// Runs of a study's sweep in the order of the grid, the same bits for any number of threads: those that `known` has, and of the others
/// those at the places that are `wanted`. Drawings are left of all of them where these have no more than two million numbers together,
/// else of the first one with results alone; where that has none, or was kept without, it is computed once more. `done` is told each of the latter with its place in the grid, from any thread. Runs that
/// begin after `stop` says so are not computed.
pub fn sweep(
    model: &Model,
    study: &Study,
    settings: Settings<'_>,
    known: Vec<Option<Run>>,
    wanted: &dyn Fn(usize) -> bool,
    done: &(dyn Fn(usize, &Run) + Sync),
) -> Vec<Run> {
    sweep_of(model, study, settings, grid(model, study), known, wanted, done)
}

/// [`sweep`] over points of one's own, each with a value of every swept parameter.
pub fn sweep_of(
    model: &Model,
    study: &Study,
    settings: Settings<'_>,
    points: Vec<Vec<f64>>,
    known: Vec<Option<Run>>,
    wanted: &dyn Fn(usize) -> bool,
    done: &(dyn Fn(usize, &Run) + Sync),
) -> Vec<Run> {
    let mut points: Vec<Option<Vec<f64>>> = points.into_iter().map(Some).collect();
    let mut runs = known;
    runs.resize_with(points.len(), || None);
    let missing: Vec<(usize, Vec<f64>)> =
        (0..points.len()).filter(|i| runs[*i].is_none() && wanted(*i)).filter_map(|i| Some((i, points[i].take()?))).collect();
    // the first run with results is drawn in any case
    let first = AtomicUsize::new(runs.iter().position(|run| run.as_ref().is_some_and(|run| run.result.is_ok())).unwrap_or(usize::MAX));
    let known = runs.iter().flatten().filter_map(|run| run.result.as_ref().ok());
    let drawn = AtomicUsize::new(known.map(|outcome| numbers(outcome)).sum());
    let of_each = Settings { threads: 1, drawn: if settings.drawn == Drawn::All { Drawn::All } else { Drawn::None }, ..settings };
    let computed = par::map(
        missing.len(),
        settings.threads,
        |k| {
            let (i, point) = &missing[k];
            if (settings.stop)() {
                return Run { at: point.clone(), solved: None, result: Err(Failure::interrupted()) };
            }
            let mut run = at(model, study, point.clone(), of_each, None, &|_, _| {});
            if let Ok(outcome) = &mut run.result {
                let all = drawn.fetch_add(numbers(outcome), Ordering::Relaxed) + numbers(outcome);
                if first.fetch_min(*i, Ordering::Relaxed) < *i && all > DRAWN {
                    outcome.scenes = Vec::new();
                }
            }
            done(*i, &run);
            run
        },
        || {},
    );
    for ((i, _), run) in missing.into_iter().zip(computed) {
        runs[i] = Some(run);
    }
    let mut runs: Vec<Run> = runs.into_iter().flatten().collect();
    if settings.drawn != Drawn::None {
        drawn.fetch_add(draw_first(model, study, &mut runs, settings), Ordering::Relaxed);
    }
    if drawn.load(Ordering::Relaxed) > DRAWN {
        runs.iter_mut().filter_map(|run| run.result.as_mut().ok()).skip(1).for_each(|outcome| outcome.scenes = Vec::new());
    }
    runs
}

/// Draws the first run with results if it has no drawing, by computing it again; gives the numbers of its frames.
fn draw_first(model: &Model, study: &Study, runs: &mut [Run], settings: Settings<'_>) -> usize {
    let Some(first) = runs.iter_mut().find(|run| run.result.is_ok()) else { return 0 };
    if first.result.as_ref().is_ok_and(|outcome| !outcome.scenes.is_empty()) || (settings.stop)() {
        return 0;
    }
    let again = at(model, study, first.at.clone(), settings, None, &|_, _| {});
    match (&mut first.result, again.result) {
        (Ok(outcome), Ok(again)) => {
            outcome.scenes = again.scenes;
            numbers(outcome)
        }
        _ => 0,
    }
}

/// Numbers of the frames of a run.
fn numbers(outcome: &Outcome) -> usize {
    outcome.scenes.iter().map(|(_, scene)| scene.frames.poses.len()).sum()
}

/// What a run, or the search of a `solve`, has come to, with names.
///
/// # Errors
/// Why there is nothing.
pub fn single(model: &Model, study: &Study, run: Run) -> Result<Results, Failure> {
    let solution = solution(model, study, &run);
    Ok(Results { solution, ..named(model, study, *run.result?) })
}

/// What the runs of a sweep have come to: a table with a row for each, and the results of each. `each` gets the latter with their number
/// from 0 as they are made, and may take from them what is of no further use.
pub fn together(model: &Model, study: &Study, runs: Vec<Run>, each: &mut dyn FnMut(usize, &mut Results)) -> Results {
    together_from(0, model, study, runs, each)
}

/// [`together`] for runs that follow each other in a sweep from one of them on, `first`, counted from 0: findings name them so.
pub fn together_from(first: usize, model: &Model, study: &Study, runs: Vec<Run>, each: &mut dyn FnMut(usize, &mut Results)) -> Results {
    let labels = labels(model, study, &runs);
    let labelled = |(i, run): (usize, Run)| {
        let solution = solution(model, study, &run);
        let label = labels[i].clone();
        let mut results = run.result.ok().map(|outcome| Box::new(named(model, study, *outcome)));
        results.iter_mut().for_each(|results| each(i, results));
        results::Run { label, results, solution }
    };
    let table = table(model, study, &runs);
    let mut findings = Vec::new();
    for (i, (run, reason)) in runs.iter().zip(table.reasons.iter().flatten()).enumerate() {
        let of = |message: &str| format!("run {} ({}): {message}", first + i + 1, labels[i]);
        if !reason.is_empty() {
            findings.push(Finding { code: "run-stopped".into(), message: of(reason), path: study.place.clone() });
        }
        findings.extend(run.solved.iter().flat_map(|s| &s.findings).map(|f| Finding { message: of(&f.message), ..f.clone() }));
    }
    findings.extend(findings_of(first, &runs, &labels));
    findings.extend(constant(study, &table));
    findings.extend(study.sweep.iter().filter_map(|sweep| by_the_file(model, study, sweep)));
    Results {
        model: model.name.clone(),
        study: study.name.clone(),
        kind: study.kind.name().into(),
        variants: model.variants.clone(),
        place: study.place.clone(),
        parameters: named::parameters(model, parameters(model).into_iter()),
        statistics: if study.samples.is_some() { statistics(&study.sweep, &table) } else { Vec::new() },
        table,
        findings,
        plots: named::plots(model, study),
        swept: swept(study),
        runs: runs.into_iter().enumerate().map(labelled).collect(),
        ..Results::default()
    }
}

/// Findings that say what each run has come to: they are results of its own, and question none.
const OF_EACH: [&str; 3] = ["equilibrium", "further-equilibrium", "stable-regime"];

/// What a reader should know of the runs, each thing once: what the first run with it says, and how many have it.
fn findings_of(first: usize, runs: &[Run], labels: &[String]) -> Vec<Finding> {
    let mut known: Vec<(usize, usize, &Finding)> = Vec::new();
    for (i, outcome) in runs.iter().enumerate().filter_map(|(i, run)| Some((i, run.result.as_ref().ok()?))) {
        let mut codes: Vec<&str> = Vec::new();
        for finding in &outcome.findings {
            if codes.contains(&&*finding.code) || OF_EACH.contains(&&*finding.code) {
                continue;
            }
            codes.push(&finding.code);
            match known.iter_mut().find(|(.., other)| other.code == finding.code) {
                Some((_, count, _)) => *count += 1,
                None => known.push((i, 1, finding)),
            }
        }
    }
    let told = |(i, count, finding): (usize, usize, &Finding)| {
        let message = said_by([count, runs.len()], first + i, &labels[i], &finding.message);
        Finding { message, ..finding.clone() }
    };
    known.into_iter().map(told).collect()
}

/// Runs from which on scalars that are all the same are no chance.
const SOME: usize = 3;

/// That nothing that the study asks for depends on what is swept.
fn constant(study: &Study, table: &Table) -> Option<Finding> {
    let scalars = &table.columns[table.columns.len() - study.scalars.len()..];
    let same = |column: &Column| column.values.iter().all(|x| x.is_finite() && Some(x) == column.values.first());
    let swept = study.sweep.iter().zip(&table.columns).map(|(_, column)| format!("`{}`", column.name)).collect::<Vec<_>>();
    let all = !scalars.is_empty() && scalars.iter().all(same) && table.rows() >= SOME;
    all.then(|| Finding {
        code: "sweep-constant".into(),
        message: format!("all scalars are the same in all {} runs: does anything depend on {}?", table.rows(), swept.join(" or ")),
        path: study.place.clone(),
    })
}

/// That values which are made of another parameter of the sweep are made of its value in the file.
fn by_the_file(model: &Model, study: &Study, sweep: &Sweep) -> Option<Finding> {
    let (mut open, mut reached) = (sweep.values.ids(), Vec::new());
    while let Some(id) = open.pop() {
        for parameter in model.pool.parameters_of(&[id]).into_iter().map(|parameter| parameter as usize) {
            if !reached.contains(&parameter) {
                reached.push(parameter);
                open.push(model.parameters[parameter].value);
            }
        }
    }
    let varied = study.sweep.iter().map(|other| other.parameter).find(|other| *other != sweep.parameter && reached.contains(other))?;
    let [name, varied] = [sweep.parameter, varied].map(|parameter| &model.parameters[parameter].name);
    Some(Finding {
        code: "sweep-of-file".into(),
        message: format!(
            "values of `{name}` are made of `{varied}` as the file has it, in every run, although the sweep varies `{varied}`; for another one in each run give pairs by `points`"
        ),
        path: if sweep.place.is_empty() { study.place.clone() } else { sweep.place.clone() },
    })
}

/// What the first of so many runs of all says: its number, counted from 0, and its label.
#[must_use]
pub fn said_by([count, all]: [usize; 2], number: usize, label: &str, message: &str) -> String {
    let others = if count == 1 { String::new() } else { format!("in {count} of {all} runs, the first of them ") };
    format!("{others}run {} ({label}): {message}", number + 1)
}

/// How the parameters of a sweep get their values.
fn swept(study: &Study) -> Vec<Swept> {
    let beside = |sweep: Option<&Sweep>| sweep.is_some_and(|sweep| matches!(sweep.values, Values::Beside(_)));
    let by = |(k, sweep): (usize, &Sweep)| {
        let by = match sweep.values {
            Values::Normal { .. } | Values::Uniform { .. } => SweptBy::Drawn,
            _ if beside(Some(sweep)) || beside(study.sweep.get(k + 1)) => SweptBy::Points,
            _ => SweptBy::Grid,
        };
        let written_in = sweep.unit.clone().map(|(unit, size)| ShownIn { unit, size });
        Swept { by, written_in }
    };
    study.sweep.iter().enumerate().map(by).collect()
}

/// How the numbers of a table are distributed over its rows, behind the parameters that the sweep gives.
#[must_use]
pub fn statistics(sweep: &[Sweep], table: &Table) -> Vec<Statistics> {
    let (swept, found) = table.columns.split_at(sweep.len());
    let drawn: Vec<&Column> = if sweep.iter().all(|s| s.values.are_drawn()) { swept.iter().collect() } else { Vec::new() };
    found.iter().filter_map(|column| Some(Statistics::of(column)?.with_parts(column, &drawn))).collect()
}

/// What certifies the solution of a run that solves.
fn solution(model: &Model, study: &Study, run: &Run) -> Option<Solution> {
    let (solved, solve) = (run.solved.as_ref()?, study.solve.as_ref()?);
    let parameter = &model.parameters[solve.parameter];
    Some(Solution {
        parameter: named::parameter(model, parameter, solved.value),
        of: solve.target.0.clone(),
        found: solved.found,
        target: solved.target,
        bracket: solved.bracket,
        runs: solved.runs,
        findings: solved.findings.clone(),
    })
}

/// The swept values of a run with some digits, in the units that the model asks for, else in those in which they are written:
/// `l3 = 60 cm`.
fn label(model: &Model, study: &Study, at: &[f64], digits: usize) -> String {
    let value = |(sweep, x): (&Sweep, &f64)| {
        let parameter = &model.parameters[sweep.parameter];
        let mut value = named::scalar(model, &parameter.name, parameter.dimension, *x, By::File);
        let written_in = sweep.unit.clone().map(|(unit, size)| ShownIn { unit, size });
        value.shown_in = value.shown_in.or(written_in);
        let (x, unit) = value.shown();
        format!("{} = {} {unit}", value.name, number(significant(x, digits))).trim_end().to_string()
    };
    study.sweep.iter().zip(at).map(value).collect::<Vec<_>>().join(", ")
}

/// The swept values of all runs, with no more digits than tell them apart.
fn labels(model: &Model, study: &Study, runs: &[Run]) -> Vec<String> {
    let with = |digits: usize| runs.iter().map(|run| label(model, study, &run.at, digits)).collect::<Vec<String>>();
    let short = with(IN_TITLES);
    let distinct = short.iter().collect::<HashSet<_>>().len() == short.len();
    if distinct { short } else { with(ALL) }
}

/// A number with some significant digits.
fn significant(x: f64, digits: usize) -> f64 {
    if digits >= ALL { x } else { format!("{x:.*e}", digits - 1).parse().unwrap_or(x) }
}

/// The columns of the table of a sweep that leaves none out, without values.
#[must_use]
pub fn columns(model: &Model, study: &Study) -> Vec<Column> {
    table(model, study, &[]).columns
}

/// One row a run: swept parameters, the one that was solved for, results of the kind, scalars, and why a run is not whole.
fn table(model: &Model, study: &Study, runs: &[Run]) -> Table {
    let outcomes: Vec<Option<&Outcome>> = runs.iter().map(|run| run.result.as_deref().ok()).collect();
    let of = |values: &dyn Fn(&Outcome) -> Option<f64>, none: f64| -> Vec<f64> {
        let value = |run: &Run| match &run.result {
            Ok(outcome) => values(outcome).unwrap_or(f64::NAN),
            // no value of a parameter is none of a mechanism
            Err(Failure::Unsolved(_)) => f64::NAN,
            Err(_) => none,
        };
        runs.iter().map(value).collect()
    };
    let parameter = |index: usize, values: Vec<f64>| {
        let p = &model.parameters[index];
        named::column(model, &p.name, p.dimension, values)
    };
    let swept = study.sweep.iter().enumerate();
    let mut columns: Vec<Column> = swept.map(|(k, s)| parameter(s.parameter, runs.iter().map(|r| r.at[k]).collect())).collect();
    let solved = || runs.iter().map(|run| run.solved.as_ref().map_or(f64::NAN, |solved| solved.value)).collect();
    columns.extend(study.solve.iter().map(|solve| parameter(solve.parameter, solved())));
    // results that no run has although its kind gives lists, as the frequency of a mode that is not there, are left out
    let lists = outcomes.iter().flatten().any(|o| !o.lists.is_empty());
    let has = |i: usize| outcomes.iter().flatten().any(|o| o.results.get(i).is_some_and(|x| !x.is_nan()));
    // nor is a turn told where nothing turns
    let any = outcomes.is_empty() || outcomes.iter().any(Option::is_none);
    let turns = |i: usize| study.results[i].name != "turns_fully" || model.is_turned() && (has(i) || any);
    for (i, result) in study.results.iter().enumerate().filter(|(i, _)| (!lists || has(*i)) && turns(*i)) {
        // a range that could not be begun is not a full turn
        let none = if result.name == "turns_fully" { 0.0 } else { f64::NAN };
        columns.push(named::column(model, &result.name, result.dimension, of(&|o| o.results.get(i).copied(), none)));
    }
    for (i, scalar) in study.scalars.iter().enumerate() {
        let values = of(&|o| o.scalars.get(i).copied(), f64::NAN);
        columns.push(named::column_of(model, study, (&scalar.name, scalar.dimension, scalar.value), values));
    }
    let reason = |run: &Run| match &run.result {
        Ok(outcome) => outcome.stopped.clone().unwrap_or_default(),
        Err(failure) => failure.reason(),
    };
    Table { columns, reasons: Some(runs.iter().map(reason).collect()), ..Table::default() }
}
