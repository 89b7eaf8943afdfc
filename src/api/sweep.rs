//! The runs of a sweep, to be computed part by part.

use super::error::Error;
use crate::model::{self, Model};
use crate::results::{Column, Results, Statistics, Table};
use crate::studies::grid::{at_chances, drawn, grid};
use crate::studies::sweep::{Drawn, Settings, columns, statistics, sweep_of, together_from};
use std::ops::Range;

/// A sweep whose model has been read and whose points are known: [`Study::prepare`](super::Study::prepare). Its runs may be computed in
/// any parts, by many threads, processes and machines.
pub struct PreparedSweep {
    model: Model,
    study: model::Study,
    points: Vec<Vec<f64>>,
}

impl PreparedSweep {
    pub(super) fn new(model: Model, study: model::Study) -> Self {
        let points = grid(&model, &study);
        Self { model, study, points }
    }

    /// Number of its runs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.points.len()
    }

    /// Names of the parameters that it varies.
    #[must_use]
    pub fn parameters(&self) -> Vec<&str> {
        self.study.sweep.iter().map(|sweep| self.model.parameters[sweep.parameter].name.as_str()).collect()
    }

    /// A text of all that decides its results; of the file neither comments nor what another study is.
    #[must_use]
    pub fn content(&self) -> String {
        let mut text = String::new();
        // a text takes all
        let _ = self.model.write_content(&mut text);
        text
    }

    /// The columns of its table, without values. The table of the runs leaves out results of the kind that no run has, as the frequency of
    /// a mode that is not there.
    #[must_use]
    pub fn columns(&self) -> Vec<Column> {
        columns(&self.model, &self.study)
    }

    /// Computes some of its runs, by their places from 0 on: their rows are those of the whole sweep, bit for bit. Nothing is drawn. `stop`
    /// is asked between steps and runs whether to end.
    ///
    /// # Errors
    /// If there are no such runs.
    pub fn only(&self, runs: Range<usize>, threads: usize, stop: &(dyn Fn() -> bool + Sync)) -> Result<Results, Error> {
        let first = runs.start;
        let Some(points) = self.points.get(runs.clone()) else {
            let message = format!("the sweep has no runs {} to {}", runs.start, runs.end);
            return Err(Error::Refused { message, help: format!("it has {}: the first is 0, and the end is not computed", self.count()) });
        };
        let settings = Settings { threads, drawn: Drawn::None, stop };
        let runs = sweep_of(&self.model, &self.study, settings, points.to_vec(), Vec::new(), &|_| true, &|_, _| {});
        Ok(together_from(first, &self.model, &self.study, runs, &mut |_, _| {}))
    }

    /// The values of the parameters with a distribution, in their order, below which each of them is with a chance.
    ///
    /// # Errors
    /// If there is not one chance strictly between 0 and 1 for each of them, or a parameter has no distribution.
    pub fn at_chances(&self, chances: &[f64]) -> Result<Vec<f64>, Error> {
        let refused = |message: &str, help: &str| Error::Refused { message: message.into(), help: help.into() };
        if drawn(&self.study).len() != self.study.sweep.len() {
            return Err(refused("a parameter has no distribution", "give each one `normal(MEAN, DEVIATION)` or `uniform(FROM, TO)`"));
        }
        if chances.len() != self.study.sweep.len() || chances.iter().any(|u| !(*u > 0.0 && *u < 1.0)) {
            return Err(refused("these are no chances", "give one number between 0 and 1 for each parameter"));
        }
        Ok(at_chances(&self.model, &self.study, chances))
    }

    /// How the numbers of its table are distributed over the runs, if values are drawn.
    #[must_use]
    pub fn statistics(&self, table: &Table) -> Vec<Statistics> {
        if self.study.samples.is_some() { statistics(&self.study.sweep, table) } else { Vec::new() }
    }
}
