//! Sweeps: one study at many parameter values; failed runs are rows with a reason.

use super::common::case::{Case, parameters, parameters_with};
use super::run::run;
use super::solve::{Solved, Task, solve};
use crate::model::{Model, Study, Values};
use crate::par;
use crate::results::{Failure, Outcome};

/// One run of a study.
#[derive(Clone, Debug)]
pub struct Run {
    /// Values of the swept parameters, in the order of `study.sweep`.
    pub at: Vec<f64>,
    /// What `solve` found, in a study that has it.
    pub solved: Option<Solved>,
    /// What came of it.
    pub result: Result<Outcome, Failure>,
}

/// The points of a study's sweep: the grid over its parameters, the last one fastest; one empty point if it sweeps nothing.
#[must_use]
pub fn grid(model: &Model, study: &Study) -> Vec<Vec<f64>> {
    let base = parameters(model);
    let mut points = vec![vec![]];
    for sweep in &study.sweep {
        let values: Vec<f64> = match &sweep.values {
            Values::List(ids) => model.pool.values(ids, &base),
            &Values::Span { from, to, count, log } => {
                let (a, b) = (model.pool.value(from, &base), model.pool.value(to, &base));
                (0..count)
                    .map(|i| {
                        let s = if count > 1 { i as f64 / (count - 1) as f64 } else { 0.0 };
                        match i {
                            0 => a,
                            _ if i + 1 == count => b,
                            _ if log => a * (b / a).powf(s),
                            _ => a + (b - a) * s,
                        }
                    })
                    .collect()
            }
        };
        points = points.iter().flat_map(|p| values.iter().map(move |v| [p.clone(), vec![*v]].concat())).collect();
    }
    points
}

/// The study at one point of its sweep (an empty one if it has none), solved if it has a `solve`; `done` is told the parameter and
/// the scalar of each run of a `solve`.
pub fn at(
    model: &Model,
    study: &Study,
    point: Vec<f64>,
    threads: usize,
    stop: &(dyn Fn() -> bool + Sync),
    done: &(dyn Fn(f64, f64) + Sync),
) -> Run {
    let set: Vec<(usize, f64)> = study.sweep.iter().map(|s| s.parameter).zip(point.iter().copied()).collect();
    let (solved, result) = match &study.solve {
        Some(asked) => match solve(&Task { model, study, solve: asked, set: &set, threads, stop, done }) {
            Ok((outcome, solved)) => (Some(solved), Ok(outcome)),
            Err(failure) => (None, Err(failure)),
        },
        None => (None, run(Case { model, study, parameters: &parameters_with(model, &set) }, stop)),
    };
    Run { at: point, solved, result }
}

/// All runs of a study's sweep in the order of the grid, the same bits for any number of threads. Those that `known` has are not
/// computed again; `done` is told each of the others with its place in the grid, from any thread. Runs that begin after `stop`
/// says so are not computed.
pub fn sweep(
    model: &Model,
    study: &Study,
    threads: usize,
    known: Vec<Option<Run>>,
    stop: &(dyn Fn() -> bool + Sync),
    done: &(dyn Fn(usize, &Run) + Sync),
) -> Vec<Run> {
    let mut points: Vec<Option<Vec<f64>>> = grid(model, study).into_iter().map(Some).collect();
    let mut runs = known;
    runs.resize_with(points.len(), || None);
    let missing: Vec<(usize, Vec<f64>)> =
        (0..points.len()).filter(|i| runs[*i].is_none()).filter_map(|i| Some((i, points[i].take()?))).collect();
    let computed = par::map(
        missing.len(),
        threads,
        |k| {
            let (i, point) = &missing[k];
            if stop() {
                return Run { at: point.clone(), solved: None, result: Err(Failure::interrupted()) };
            }
            let run = at(model, study, point.clone(), 1, stop, &|_, _| {});
            done(*i, &run);
            run
        },
        || {},
    );
    for ((i, _), run) in missing.into_iter().zip(computed) {
        runs[i] = Some(run);
    }
    runs.into_iter().flatten().collect()
}
