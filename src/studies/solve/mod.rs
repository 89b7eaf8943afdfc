//! `solve`: a parameter p is varied until a scalar s of a study meets its target: f(p) = s(p) − target(p) = 0.
//!
//! How the zero is searched stands in `search`, with p = a + x (b − a) over the bounds a and b. A run that cannot be computed, or
//! that stops on its way, gives no value.

mod explain;
mod search;
mod task;

use super::common::case::{Case, parameters_with};
use super::common::settings::Drawn;
use super::run::run;
use crate::model::Study;
use crate::results::{Failure, Finding};
use crate::studies::common::outcome::Outcome;
use explain::Explain;
use search::{Search, Zero};
use serde::{Deserialize, Serialize};
use std::sync::{Mutex, MutexGuard, PoisonError};
pub use task::Task;
use task::Trial;

/// The result that a run has although it stops on its way.
const TURNS: &str = "turns_fully";

/// A solution, and what certifies it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Solved {
    /// The parameter's value, SI.
    pub value: f64,
    /// The scalar there.
    pub found: f64,
    /// The target there.
    pub target: f64,
    /// The last bracket: values between which the scalar crosses its target.
    pub bracket: [f64; 2],
    /// Runs that were made.
    pub runs: usize,
    /// What a reader should know.
    pub findings: Vec<Finding>,
}

/// The run at the first value, from the first bound on, for which the scalar meets its target; the same bits for any number of
/// threads.
///
/// # Errors
/// [`Failure::Unsolved`] if no value does; the failure of the first run if none can be computed.
pub fn solve(task: &Task<'_>) -> Result<(Outcome, Solved), Failure> {
    let trials = Trials::new(task);
    let f = |x: f64| trials.residual(x);
    let mut search = Search::new(&f, task.settings.threads);
    let zero = search.zero().map_err(|Interrupted| Failure::interrupted())?;
    let (jumps, gaps) = (search.jumps.first().copied(), search.gaps.first().copied());
    let words = Explain { task, log: trials.log(), place: &|x| trials.parameter(x) };
    let Some(zero) = zero else {
        // a model that is wrong for all values is told as it would be without `solve`
        if words.log.iter().all(|run| run.why.is_some()) {
            trials.outcome(0.0, false)?;
        }
        return Err(Failure::Unsolved(words.missed(jumps, gaps)));
    };
    trials.solution(&zero)
}

/// The search was ended from outside.
struct Interrupted;

/// Runs of the study.
struct Trials<'a> {
    task: &'a Task<'a>,
    /// Bounds of the parameter.
    between: [f64; 2],
    log: Mutex<Vec<Trial>>,
    /// The run with the smallest residual so far: |residual|, place, outcome.
    nearest: Mutex<Option<(f64, f64, Outcome)>>,
}

impl<'a> Trials<'a> {
    fn new(task: &'a Task<'a>) -> Self {
        let base = parameters_with(task.model, task.set);
        let between = task.solve.between.map(|id| task.model.pool.value(id, &base));
        Self { task, between, log: Mutex::default(), nearest: Mutex::default() }
    }

    /// The parameter at a place.
    fn parameter(&self, x: f64) -> f64 {
        let [a, b] = self.between;
        if x == 1.0 { b } else { a + x * (b - a) }
    }

    /// Runs by place.
    fn log(&self) -> Vec<Trial> {
        let mut log = lock(&self.log).clone();
        log.sort_by(|a, b| a.x.total_cmp(&b.x));
        log
    }

    /// The run at a place, with its drawing or without.
    fn outcome(&self, x: f64, drawn: bool) -> Result<(Outcome, f64), Failure> {
        let Task { model, study, solve, set, .. } = *self.task;
        let set = [set, &[(solve.parameter, self.parameter(x))]].concat();
        let values = parameters_with(model, &set);
        let target = model.pool.value(solve.target.1, &values);
        let outcome = run(Case { drawn, ..Case::new(model, study, &values) }, self.task.settings.stop)?;
        Ok((outcome, target))
    }

    /// f at a place; NaN where there is no value.
    fn residual(&self, x: f64) -> Result<f64, Interrupted> {
        if (self.task.settings.stop)() {
            return Err(Interrupted);
        }
        let name = &self.task.solve.target.0;
        let result = self.outcome(x, false);
        if (self.task.settings.stop)() {
            return Err(Interrupted);
        }
        let (scalar, target, why) = match &result {
            Ok((outcome, target)) => {
                let scalar = scalar(self.task.study, outcome, name);
                let why = match &outcome.stopped {
                    Some(why) if name != TURNS => Some(why.clone()),
                    _ if !scalar.is_finite() => Some(format!("`{name}` is not a number there")),
                    _ => None,
                };
                (scalar, *target, why)
            }
            Err(failure) => (f64::NAN, f64::NAN, Some(failure.reason())),
        };
        (self.task.done)(self.parameter(x), scalar);
        let residual = if why.is_some() { f64::NAN } else { scalar - target };
        lock(&self.log).push(Trial { x, scalar, target, why });
        if let Ok((outcome, _)) = result {
            let mut nearest = lock(&self.nearest);
            if nearest.as_ref().is_none_or(|(least, ..)| residual.abs() < *least) && !residual.is_nan() {
                *nearest = Some((residual.abs(), x, outcome));
            }
        }
        Ok(residual)
    }

    fn solution(self, zero: &Zero) -> Result<(Outcome, Solved), Failure> {
        let log = self.log();
        let drawn = self.task.settings.drawn != Drawn::None;
        let kept = lock(&self.nearest).take().filter(|(_, x, _)| *x == zero.at && !drawn);
        let outcome = match kept {
            Some((_, _, outcome)) => outcome,
            None => self.outcome(zero.at, drawn)?.0,
        };
        let there = log.iter().find(|run| run.x == zero.at);
        let (found, target) = there.map_or((f64::NAN, f64::NAN), |run| (run.scalar, run.target));
        let runs = log.len();
        let words = Explain { task: self.task, log, place: &|x| self.parameter(x) };
        let solved = Solved {
            value: self.parameter(zero.at),
            found,
            target,
            bracket: zero.bracket.map(|x| self.parameter(x)),
            runs,
            findings: words.findings(zero),
        };
        Ok((outcome, solved))
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A scalar, result of the kind or taken scalar by its name.
fn scalar(study: &Study, outcome: &Outcome, name: &str) -> f64 {
    let own = study.scalars.iter().position(|s| s.name == name).and_then(|i| outcome.scalars.get(i));
    let result = study.results.iter().position(|r| r.name == name).and_then(|i| outcome.results.get(i));
    let taken = study.take.iter().find(|t| t.name == name).map(|t| &t.value);
    own.or(result).or(taken).copied().unwrap_or(f64::NAN)
}
