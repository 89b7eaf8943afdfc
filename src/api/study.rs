//! A study of a model file with settings, to run.

use super::error::Error;
use crate::model::{Document, Integrator, Kind, Model, Selection};
use crate::par;
use crate::results::{Compared, Results, Unknown};
use crate::studies::common::case::parameters;
use crate::studies::compare::{NoReference, Watch, compare};
use crate::studies::integrators::Steps;
use crate::studies::loader::Loader;
use crate::studies::sweep::{at, grid, single, sweep, together};
use crate::studies::verify::{Verdict, verify};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A study with settings. What it is set to replaces what the file says; nothing is computed before it is run.
pub struct Study<'a> {
    document: &'a Document,
    selection: Selection<'a>,
    name: String,
    threads: usize,
    progress: Box<dyn Fn(usize, usize) + Sync + 'a>,
    stop: Box<dyn Fn() -> bool + Sync + 'a>,
}

impl<'a> Study<'a> {
    pub(super) fn new(document: &'a Document, name: &str) -> Self {
        Self {
            document,
            selection: Selection::default(),
            name: name.into(),
            threads: par::processors(),
            progress: Box::new(|_, _| {}),
            stop: Box::new(|| false),
        }
    }

    /// Sets a parameter, as the file would: `60 cm`, `l1/2`, or a number in SI.
    #[must_use]
    pub fn set(mut self, parameter: &str, value: &str) -> Self {
        self.selection.sets.push((parameter.into(), value.into()));
        self
    }

    /// Applies a variant of the file, behind those of the study.
    #[must_use]
    pub fn variant(mut self, name: &str) -> Self {
        self.selection.variants.push(name.into());
        self
    }

    /// Runs the study for many values of a parameter: `0.3..0.8:26`, or a list, `30 cm,40 cm`; several: all combinations.
    #[must_use]
    pub fn over(mut self, parameter: &str, values: &str) -> Self {
        self.selection.over.push((parameter.into(), values.into()));
        self
    }

    /// Threads for runs of a sweep or a `solve`; all processors if omitted.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads.max(1);
        self
    }

    /// Is told how many runs are done, and of how many; a `solve` does not know of how many beforehand and says 0.
    #[must_use]
    pub fn on_progress(mut self, told: impl Fn(usize, usize) + Sync + 'a) -> Self {
        self.progress = Box::new(told);
        self
    }

    /// Is asked between steps and runs whether to end; a motion keeps what it has come to.
    #[must_use]
    pub fn stop_if(mut self, stop: impl Fn() -> bool + Sync + 'a) -> Self {
        self.stop = Box::new(stop);
        self
    }

    /// Runs the study, and first those from which it takes scalars.
    ///
    /// A motion that stops on its way has results up to there, with [`Results::stopped`]; so has a sweep of which runs fail, each with
    /// its reason.
    ///
    /// # Errors
    /// If the file or a setting is wrong, or the study does not begin.
    pub fn run(&self) -> Result<Results, Error> {
        let model = self.model()?;
        let Some(study) = &model.study else { return Err(self.unknown()) };
        let done = AtomicUsize::new(0);
        let count = |all: usize| (self.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, all);
        if study.sweep.is_empty() {
            let run = at(&model, study, Vec::new(), self.threads, &*self.stop, &|_, _| count(0));
            return single(&model, study, &run).map_err(|failure| Error::failed(self.document, &self.name, failure));
        }
        let all = grid(&model, study).len();
        let runs = sweep(&model, study, self.threads, Vec::new(), &*self.stop, &|_, _| count(all));
        Ok(together(&model, study, &runs))
    }

    /// Computes a motion in time twice more, at a tenth of its tolerance and by a scheme of another family, and says how many digits
    /// stand; none for other studies.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn verify(&self) -> Result<Option<Verdict>, Error> {
        let model = self.model()?;
        verify(&model, &[parameters(&model)], &*self.stop).map_err(|failure| Error::failed(self.document, &self.name, failure))
    }

    /// Computes a motion in time by several integrators at several tolerances; `now` gives a time in seconds.
    ///
    /// # Errors
    /// If the study is no motion in time, an integrator is not known, or there is no reference.
    pub fn compare(&self, integrators: &[&str], tolerances: &[f64], now: &dyn Fn() -> f64) -> Result<Compared, Error> {
        let mut model = self.model()?;
        let Some(study) = model.study.clone() else { return Err(self.unknown()) };
        let Kind::Dynamics(forward) = study.kind.clone() else {
            let message = format!("study `{}` is no motion in time, so no integrator computes it", self.name);
            return Err(Error::Refused { message, help: "name a study of the kind `dynamics`".into() });
        };
        let known = || crate::model::INTEGRATORS.iter().map(|d| d.name.to_string()).collect();
        let unknown = |name: &str| Unknown { what: "integrator", name: name.into(), known: known() };
        let by = integrators.iter().map(|name| Integrator::named(name).ok_or_else(|| unknown(name))).collect::<Result<Vec<_>, _>>()?;
        let sizes: Vec<Steps> = tolerances.iter().map(|x| Steps::Tolerance(*x)).collect();
        let done = Cell::new(0);
        let all = 2 + by.len() * sizes.len();
        let count = || {
            done.set(done.get() + 1);
            (self.progress)(done.get(), all);
        };
        let watch = Watch { stop: &*self.stop, now, done: &count };
        compare(&mut model, &study, &forward, (&by, &sizes), watch).map_err(|why| match why {
            NoReference::Failure(failure) => Error::failed(self.document, &self.name, failure),
            NoReference::Stopped(why) => Error::Refused { message: format!("there is no reference: {why}"), help: "run the study".into() },
            NoReference::Apart(off) => Error::Refused {
                message: format!("the two references differ by {off:.1e} at the end"),
                help: "compare a shorter motion".into(),
            },
            NoReference::Interrupted => Error::Refused { message: "interrupted".into(), help: "let it run on".into() },
        })
    }

    fn model(&self) -> Result<Model, Error> {
        let selection = Selection { study: Some(&self.name), ..self.selection.clone() };
        Loader::new(self.document, self.threads).model(&selection, &*self.stop).map_err(|why| Error::not_loaded(self.document, why))
    }

    fn unknown(&self) -> Error {
        Unknown { what: "study", name: self.name.clone(), known: self.document.study_names() }.into()
    }
}
