//! Sweeps: one study at many parameter values; failed runs are rows with a reason.

use super::outcome::{Failure, Outcome};
use super::run::run;
use crate::mechanism::Coordinates;
use crate::model::{Model, Study, Values};
use crate::par;

/// One run of a sweep.
pub struct Run {
    /// Values of the swept parameters, in the order of `study.sweep`.
    pub at: Vec<f64>,
    /// What came of it.
    pub result: Result<Outcome, Failure>,
}

/// Parameters of a model as numbers, in file order.
#[must_use]
pub fn parameters(model: &Model) -> Vec<f64> {
    model.pool.resolve_parameters(&model.parameters.iter().map(|p| p.value).collect::<Vec<_>>())
}

/// Parameters with some of them set to numbers; those that depend on them follow.
#[must_use]
pub fn parameters_with(model: &Model, set: &[(usize, f64)]) -> Vec<f64> {
    let mut pool = model.pool.clone();
    let mut values: Vec<_> = model.parameters.iter().map(|p| p.value).collect();
    for &(i, x) in set {
        values[i] = pool.constant(x);
    }
    pool.resolve_parameters(&values)
}

/// The points of a study's sweep: the grid over its parameters, the last one fastest.
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

/// All runs of a study's sweep in the order of the grid, the same bits for any number of threads; runs that begin after `stop`
/// says so are not computed.
pub fn sweep(model: &Model, study: &Study, threads: usize, stop: impl Fn() -> bool + Sync, done: impl Fn() + Sync) -> Vec<Run> {
    let points = grid(model, study);
    par::map(
        points.len(),
        threads,
        |i| {
            if stop() {
                return Run { at: points[i].clone(), result: Err(Failure::Numerical("interrupted".into())) };
            }
            let set: Vec<(usize, f64)> = study.sweep.iter().map(|s| s.parameter).zip(points[i].iter().copied()).collect();
            let result = run(model, study, &parameters_with(model, &set), Coordinates::Joint, &stop);
            Run { at: points[i].clone(), result }
        },
        done,
    )
}
