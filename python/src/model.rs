//! Model files.

use crate::dynamics::Dynamics;
use crate::errors::{faults, raised};
use crate::functions::{Described, Functions, Trouble};
use crate::interrupt::away;
use crate::results::Results;
use crate::stepper::Stepper;
use crate::sweep::Sweep;
use grashof::Error;
use grashof::results::Scalar;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList};
use pythonize::pythonize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// Names with values, given as in a model file.
type Settings = Vec<(String, String)>;

/// A model file, with variants applied and parameters set.
#[pyclass(frozen, module = "grashof._grashof")]
pub(crate) struct Model {
    model: Arc<grashof::Model>,
    functions: Functions,
}

/// Reads a model file, and what it includes.
#[pyfunction]
pub(crate) fn load(py: Python<'_>, path: PathBuf) -> PyResult<Model> {
    made(py, || grashof::Model::load(path))
}

/// A model that stands in a text and includes no files.
#[pyfunction]
pub(crate) fn parse(py: Python<'_>, text: &str) -> PyResult<Model> {
    made(py, || grashof::Model::parse(text))
}

/// The model that `Model.pack` gave as text.
#[pyfunction]
pub(crate) fn unpack(py: Python<'_>, packed: &str) -> PyResult<Model> {
    made(py, || grashof::Model::unpack(packed))
}

/// YAML for a value that is given as JSON.
#[pyfunction]
pub(crate) fn yaml(json: &str) -> PyResult<String> {
    let wrong = |error: &dyn std::fmt::Display| pyo3::exceptions::PyValueError::new_err(error.to_string());
    let value: serde_json::Value = serde_json::from_str(json).map_err(|error| wrong(&error))?;
    serde_yaml::to_string(&value).map_err(|error| wrong(&error))
}

fn made(py: Python<'_>, make: impl FnOnce() -> Result<grashof::Model, Error> + Send) -> PyResult<Model> {
    match py.detach(make) {
        Ok(model) => Ok(Model { model: Arc::new(model), functions: Functions::default() }),
        Err(error) => Err(raised(py, &error)),
    }
}

impl Model {
    /// The model for one computation, and where that keeps what functions of Python raise.
    fn apart(&self, py: Python<'_>) -> PyResult<(grashof::Model, Trouble)> {
        self.functions.with(&self.model).map_err(|error| raised(py, &error))
    }

    /// Something of the model that takes no time.
    fn told<T: Send>(&self, py: Python<'_>, tell: impl FnOnce(&grashof::Model) -> Result<T, Error> + Send) -> PyResult<T> {
        let (model, trouble) = self.apart(py)?;
        let told = py.detach(|| tell(&model));
        trouble.settle(py, told)
    }

    /// Another model with the same functions.
    fn other(&self, py: Python<'_>, make: impl FnOnce(&grashof::Model) -> Result<grashof::Model, Error> + Send) -> PyResult<Self> {
        let model = self.told(py, make)?;
        Ok(Self { model: Arc::new(model), functions: self.functions.clone() })
    }
}

/// Settings as the library takes them.
fn lent(settings: &Settings) -> Vec<(&str, &str)> {
    settings.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect()
}

/// A study over values of parameters.
fn swept<'m>(model: &'m grashof::Model, study: &str, over: &Settings, samples: Option<(usize, u64)>) -> Result<grashof::Study<'m>, Error> {
    let asked = samples.into_iter().fold(model.study(study)?, |asked, (count, seed)| asked.samples(count, seed));
    Ok(over.iter().fold(asked, |asked, (parameter, values)| asked.over(parameter, values)))
}

#[pymethods]
impl Model {
    /// The same with parameters at other values, given as in the file.
    fn set(&self, py: Python<'_>, values: Settings) -> PyResult<Self> {
        self.other(py, |model| model.set(&lent(&values)))
    }

    /// The same with a variant of the file.
    fn variant(&self, py: Python<'_>, name: &str) -> PyResult<Self> {
        self.other(py, |model| model.variant(name))
    }

    /// The same with functions of Python, in the place of those that it had.
    fn with_functions(&self, py: Python<'_>, functions: Vec<Described>) -> PyResult<Self> {
        let functions = Functions::new(functions);
        let (model, _) = functions.with(&self.model).map_err(|error| raised(py, &error))?;
        Ok(Self { model: Arc::new(model), functions })
    }

    /// The same with one more study, given as YAML; and its name.
    fn with_study(&self, name: &str, yaml: &str) -> (Self, String) {
        let (model, name) = self.model.with_study(name, yaml);
        (Self { model: Arc::new(model), functions: self.functions.clone() }, name)
    }

    /// The text of the file.
    #[getter]
    fn text(&self) -> &str {
        self.model.text()
    }

    /// All of the model as text, with the files that it names.
    fn pack(&self) -> String {
        self.model.pack()
    }

    /// Names of the studies.
    #[getter]
    fn studies(&self) -> Vec<String> {
        self.model.studies()
    }

    /// Names of the variants.
    #[getter]
    fn variants(&self) -> Vec<String> {
        self.model.variants()
    }

    /// Name, value in SI and unit of each parameter.
    fn parameters(&self, py: Python<'_>) -> PyResult<Vec<(String, f64, String)>> {
        let all = self.told(py, grashof::Model::parameters)?;
        Ok(all.into_iter().map(|Scalar { name, value, unit, .. }| (name, value, unit)).collect())
    }

    /// All that is wrong with the file.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let report = self.told(py, |model| Ok(model.check()))?;
        faults(py, Some(&report))
    }

    /// Runs a study with settings, for all combinations of swept values.
    #[pyo3(signature = (study, over, threads=None, samples=None))]
    fn run(
        &self,
        py: Python<'_>,
        study: String,
        over: Settings,
        threads: Option<usize>,
        samples: Option<(usize, u64)>,
    ) -> PyResult<Results> {
        let (model, trouble) = self.apart(py)?;
        let thread = trouble.clone();
        let run = away(py, move |flag| {
            thread.known(|| {
                let asked = swept(&model, &study, &over, samples)?;
                let asked = threads.into_iter().fold(asked, grashof::Study::threads);
                asked.stop_if(|| flag.load(Ordering::Relaxed)).run()
            })
        })?;
        Results::new(py, trouble.settle(py, run)?)
    }

    /// A sweep of a study, to be computed part by part.
    #[pyo3(signature = (study, over, samples=None, threads=1))]
    fn prepare(&self, py: Python<'_>, study: String, over: Settings, samples: Option<(usize, u64)>, threads: usize) -> PyResult<Sweep> {
        let (model, trouble) = self.apart(py)?;
        let prepared = away(py, move |flag| {
            swept(&model, &study, &over, samples)?.threads(threads).stop_if(|| flag.load(Ordering::Relaxed)).prepare()
        })?;
        let prepared = trouble.settle(py, prepared)?;
        Ok(Sweep::new(prepared, trouble))
    }

    /// Computes a motion by several integrators, at several tolerances or with several steps, s.
    fn compare<'py>(
        &self,
        py: Python<'py>,
        study: String,
        integrators: Vec<String>,
        sizes: Vec<f64>,
        fixed: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (model, trouble) = self.apart(py)?;
        let compared = away(py, move |flag| {
            let begin = Instant::now();
            let clock = || begin.elapsed().as_secs_f64();
            let study = model.study(&study)?.stop_if(|| flag.load(Ordering::Relaxed));
            let integrators: Vec<&str> = integrators.iter().map(String::as_str).collect();
            if fixed { study.compare_steps(&integrators, &sizes, &clock) } else { study.compare(&integrators, &sizes, &clock) }
        })?;
        Ok(pythonize(py, &trouble.settle(py, compared)?)?)
    }

    /// The mechanism, to be evaluated by hand.
    fn dynamics(&self, py: Python<'_>) -> PyResult<Dynamics> {
        let (model, trouble) = self.apart(py)?;
        let mechanism = py.detach(|| model.mechanism());
        let mechanism = trouble.settle(py, mechanism)?;
        Ok(Dynamics::new(mechanism, trouble))
    }

    /// The motion of a study, to be advanced from outside.
    fn stepper(&self, py: Python<'_>, study: String) -> PyResult<Stepper> {
        let (model, trouble) = self.apart(py)?;
        Stepper::new(py, model, trouble, study)
    }

    /// The page of a report on results of its studies.
    fn report<'py>(&self, py: Python<'py>, results: Vec<PyRef<'py, Results>>) -> PyResult<Bound<'py, PyBytes>> {
        let results = results.iter().map(|results| results.whole(py)).collect::<PyResult<Vec<_>>>()?;
        let page = py.detach(|| self.model.report(&results.iter().collect::<Vec<_>>()));
        Ok(PyBytes::new(py, &page))
    }
}
