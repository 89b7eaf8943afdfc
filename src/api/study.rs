//! A study of a model file with settings, to run.

use super::error::Error;
use super::mechanism::Mechanism;
use super::sweep::PreparedSweep;
use crate::model::{self, Document, INTEGRATORS, Integrator, Kind, Model, Selection};
use crate::par;
use crate::results::{Compared, Results, Sink, Unknown};
use crate::studies::common::case::{Case, Streamed, parameters};
use crate::studies::common::named::named;
use crate::studies::compare::{NoReference, Watch, compare};
use crate::studies::integrators::{By, OwnIntegrator, Steps};
use crate::studies::loader::Loader;
use crate::studies::run::run;
use crate::studies::sweep::{Drawn, Settings, at, grid, single, sweep, together};
use crate::studies::verify::{Verdict, verify};
use grashof_solvers::{Scheme, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A study with settings. What it is set to replaces what the file says; nothing is computed before it is run. With parameters set, variants
/// or values of its own, what the file expects of its values is not judged.
pub struct Study<'a> {
    document: &'a Document,
    selection: Selection<'a>,
    name: String,
    integrators: Vec<OwnIntegrator>,
    sink: Option<&'a dyn Sink>,
    threads: usize,
    drawn: bool,
    progress: Box<dyn Fn(usize, usize) + Sync + 'a>,
    stop: Box<dyn Fn() -> bool + Sync + 'a>,
}

impl<'a> Study<'a> {
    pub(super) fn new(document: &'a Document, name: &str, selection: Selection<'a>) -> Self {
        Self {
            document,
            selection,
            name: name.into(),
            integrators: Vec::new(),
            sink: None,
            threads: par::processors(),
            drawn: true,
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

    /// Runs the study for many values of a parameter: `0.3..0.8:26`, or a list, `30 cm,40 cm`; several: all combinations. With
    /// [`Self::samples`] also a distribution, `normal(55 cm, 1 mm)` or `uniform(54 cm, 56 cm)`. Several parameters
    /// with commas between them run through a list of points: `l1,l3` through `10 cm,50 cm; 12 cm,55 cm`.
    #[must_use]
    pub fn over(mut self, parameter: &str, values: &str) -> Self {
        self.selection.over.push((parameter.into(), values.into()));
        self
    }

    /// How many points are drawn from the distributions of [`Self::over`], all parameters at once; the seed decides which.
    #[must_use]
    pub fn samples(mut self, count: usize, seed: u64) -> Self {
        self.selection.samples = Some(model::Samples { count: count.max(1), seed });
        self
    }

    /// Threads for runs of a sweep or a `solve`; all processors if omitted.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads.max(1);
        self
    }

    /// Leaves out drawings ([`Results::scenes`]), whose frames take time.
    #[must_use]
    pub fn undrawn(mut self) -> Self {
        self.drawn = false;
        self
    }

    /// Calls a function with the number of runs done, and of all runs: 0 for a `solve`, which does not know it beforehand.
    #[must_use]
    pub fn on_progress(mut self, show: impl Fn(usize, usize) + Sync + 'a) -> Self {
        self.progress = Box::new(show);
        self
    }

    /// Is asked between steps and runs whether to end; a motion keeps what it has come to.
    #[must_use]
    pub fn stop_if(mut self, stop: impl Fn() -> bool + Sync + 'a) -> Self {
        self.stop = Box::new(stop);
        self
    }

    /// Gives the rows of [`Self::run`] to a sink as they are computed; the table of its results is then empty. For studies of one run.
    #[must_use]
    pub fn rows_to(mut self, sink: &'a dyn Sink) -> Self {
        self.sink = Some(sink);
        self
    }

    /// Brings an integrator of one's own for [`Self::compare`]: its name, and what makes its scheme for a system.
    #[must_use]
    pub fn integrator(mut self, name: &str, scheme: impl Fn(&dyn System) -> Box<dyn Scheme> + Send + Sync + 'static) -> Self {
        self.integrators.push(OwnIntegrator::new(name, scheme));
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
        if let Some(sink) = self.sink {
            return self.streamed(&model, study, sink);
        }
        let settings = Settings { threads: self.threads, drawn: if self.drawn { Drawn::All } else { Drawn::None }, stop: &*self.stop };
        let done = AtomicUsize::new(0);
        let count = |all: usize| (self.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, all);
        if study.sweep.is_empty() {
            let run = at(&model, study, Vec::new(), settings, None, &|_, _| count(0));
            return single(&model, study, run).map_err(|failure| Error::failed(self.document, &self.name, failure));
        }
        let all = grid(&model, study).len();
        let runs = sweep(&model, study, settings, Vec::new(), &|_| true, &|_, _| count(all));
        Ok(together(&model, study, runs, &mut |_, _| {}))
    }

    /// The sweep of the study, to be computed part by part; studies from which it takes scalars are run.
    ///
    /// # Errors
    /// If the file or a setting is wrong, the study is no sweep, or one from which it takes has no whole result.
    pub fn prepare(&self) -> Result<PreparedSweep, Error> {
        let selection = self.selection();
        let loaded = Loader::new(self.document, self.threads).model(&selection, &*self.stop);
        let model = self.as_asked(loaded.map_err(|why| Error::not_loaded(self.document, why))?)?;
        let Some(study) = model.study.clone() else { return Err(self.unknown()) };
        if study.sweep.is_empty() {
            let message = format!("study `{}` is no sweep", self.name);
            return Err(Error::Refused { message, help: "say which values parameters run through".into() });
        }
        Ok(PreparedSweep::new(model, study))
    }

    /// A study of one run whose rows go to a sink.
    fn streamed(&self, model: &Model, study: &model::Study, sink: &dyn Sink) -> Result<Results, Error> {
        if !study.sweep.is_empty() || study.solve.is_some() {
            let message = format!("study `{}` has many runs, and rows go out from one", self.name);
            return Err(Error::Refused { message, help: "take the table of each of its runs from the results".into() });
        }
        let values = parameters(model);
        let case = Case { rows: Some(Streamed { sink, keep: 0 }), drawn: self.drawn, ..Case::new(model, study, &values) };
        let outcome = run(case, &*self.stop).map_err(|failure| Error::failed(self.document, &self.name, failure))?;
        Ok(named(model, study, outcome))
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

    /// Computes a motion in time by several integrators at several tolerances; `now` gives a time in seconds. Integrators are those of
    /// the model language and those that [`Self::integrator`] brought.
    ///
    /// # Errors
    /// If the study is no motion in time, an integrator is not known, or there is no reference.
    pub fn compare(&self, integrators: &[&str], tolerances: &[f64], now: &dyn Fn() -> f64) -> Result<Compared, Error> {
        self.compared(integrators, &tolerances.iter().map(|x| Steps::Tolerance(*x)).collect::<Vec<_>>(), now)
    }

    /// [`Self::compare`] with fixed steps of several sizes, s.
    ///
    /// # Errors
    /// As there.
    pub fn compare_steps(&self, integrators: &[&str], steps: &[f64], now: &dyn Fn() -> f64) -> Result<Compared, Error> {
        self.compared(integrators, &steps.iter().map(|h| Steps::Fixed(*h)).collect::<Vec<_>>(), now)
    }

    fn compared(&self, integrators: &[&str], sizes: &[Steps], now: &dyn Fn() -> f64) -> Result<Compared, Error> {
        let mut model = self.model()?;
        let Some(study) = model.study.clone() else { return Err(self.unknown()) };
        let Kind::Dynamics(forward) = study.kind.clone() else {
            let message = format!("study `{}` is no motion in time, so no integrator computes it", self.name);
            return Err(Error::Refused { message, help: "name a study of the kind `dynamics`".into() });
        };
        let by = integrators.iter().map(|name| self.by(name, &model)).collect::<Result<Vec<_>, _>>()?;
        let done = Cell::new(0);
        let all = 2 + by.len() * sizes.len();
        let count = || {
            done.set(done.get() + 1);
            (self.progress)(done.get(), all);
        };
        let watch = Watch { stop: &*self.stop, now, done: &count };
        compare(&mut model, &study, &forward, (&by, sizes), watch).map_err(|why| match why {
            NoReference::Failure(failure) => Error::failed(self.document, &self.name, failure),
            NoReference::Stopped(why) => Error::Refused { message: format!("there is no reference: {why}"), help: "run the study".into() },
            NoReference::Apart(off) => Error::Refused {
                message: format!("the two references differ by {off:.1e} at the end"),
                help: "compare a shorter motion".into(),
            },
            NoReference::Interrupted => Error::Refused { message: "interrupted".into(), help: "let it run on".into() },
        })
    }

    /// The integrator of a name.
    fn by(&self, name: &str, model: &Model) -> Result<By, Error> {
        if let Some(own) = self.integrators.iter().find(|own| own.name == name) {
            let mechanism = Mechanism::new(model.clone()).map_err(|failure| Error::failed(self.document, &self.name, failure))?;
            let implicit = own.scheme(&*mechanism.system()).is_implicit();
            return Ok(By::Own(own.clone(), if implicit { Integrator::Radau5 } else { Integrator::Dop853 }));
        }
        let known = || INTEGRATORS.iter().map(|d| d.name.to_string()).chain(self.integrators.iter().map(|own| own.name.clone())).collect();
        let unknown = || Unknown { what: "integrator", name: name.into(), known: known() };
        Ok(By::Known(Integrator::named(name).ok_or_else(unknown)?))
    }

    fn model(&self) -> Result<Model, Error> {
        let loaded = Loader::new(self.document, self.threads).drawn(&self.selection(), &*self.stop);
        self.as_asked(loaded.map_err(|why| Error::not_loaded(self.document, why))?)
    }

    /// A model without what the file expects of its own values, if these are changed, as the program does it.
    ///
    /// # Errors
    /// If a parameter is set that the study varies.
    fn as_asked(&self, mut model: Model) -> Result<Model, Error> {
        if let Some(parameter) = model.set_and_varied() {
            let message = format!("`{parameter}` is set, and study `{}` varies it", self.name);
            return Err(Error::Refused { message, help: "leave the parameter to the study, or run another one".into() });
        }
        let Selection { sets, variants, over, .. } = &self.selection;
        if let Some(study) = &mut model.study
            && !(sets.is_empty() && variants.is_empty() && over.is_empty())
        {
            study.expect.clear();
        }
        Ok(model)
    }

    fn selection(&self) -> Selection<'_> {
        Selection { study: Some(&self.name), ..self.selection.clone() }
    }

    fn unknown(&self) -> Error {
        Unknown { what: "study", name: self.name.clone(), known: self.document.study_names() }.into()
    }
}
