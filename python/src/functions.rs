//! Functions of Python that expressions of a model call.
//!
//! They are called from the threads that compute, each call with the lock of the interpreter. What one of them raises is kept until the
//! computation has ended, which it does soon, since the call gives no number.

use crate::errors::raised;
use grashof::Error;
use grashof::api::ExternalFunction;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyTuple};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Name, arguments with the sides of switches behind them, what computes it, its slopes by arguments, unit, and conditions of switches.
pub(crate) type Described = (String, Vec<String>, Py<PyAny>, Vec<(String, Py<PyAny>)>, Option<String>, Option<Vec<(String, String)>>);

/// A function as it was described.
struct Function {
    name: String,
    arguments: Vec<String>,
    law: Arc<Py<PyAny>>,
    slopes: Vec<(String, Arc<Py<PyAny>>)>,
    unit: Option<String>,
    switches: Option<Vec<(String, String)>>,
}

/// The functions of a model.
#[derive(Clone, Default)]
pub(crate) struct Functions(Arc<Vec<Function>>);

/// The exception that one of the functions has raised first.
#[derive(Clone, Default)]
pub(crate) struct Trouble(Arc<Kept>);

#[derive(Default)]
struct Kept {
    /// Whether there are functions.
    functions: bool,
    any: AtomicBool,
    error: Mutex<Option<PyErr>>,
}

impl Trouble {
    fn keep(&self, error: PyErr) {
        self.0.error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        self.0.any.store(true, Ordering::Release);
    }

    /// What a computation has come to, if none of the functions has raised anything.
    ///
    /// # Errors
    /// What one has raised; the exception of an error of the library.
    pub(crate) fn settle<T>(&self, py: Python<'_>, computed: Result<T, Error>) -> PyResult<T> {
        let kept = self.0.error.lock().unwrap_or_else(PoisonError::into_inner).take();
        self.0.any.store(false, Ordering::Release);
        match kept {
            Some(error) => Err(error),
            None => computed.map_err(|error| raised(py, &error)),
        }
    }

    /// Computes something in a thread that stays known to the interpreter if there are functions, so that it need not be made known for
    /// each call, which takes longer than the call.
    pub(crate) fn known<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        if !self.0.functions {
            return work();
        }
        match Python::try_attach(|py| py.detach(|| ())) {
            Some(()) => Python::attach(|py| py.detach(work)),
            None => work(),
        }
    }

    /// The value of a law; not a number if it raises something, or has before.
    fn value(&self, law: &Py<PyAny>, name: &str, x: &[f64], plain: usize) -> f64 {
        if self.0.any.load(Ordering::Acquire) {
            return f64::NAN;
        }
        // an interpreter that is on its way out calls nothing any more
        let value = Python::try_attach(|py| {
            called(py, law, name, x, plain).unwrap_or_else(|error| {
                self.keep(error);
                f64::NAN
            })
        });
        value.unwrap_or(f64::NAN)
    }
}

/// Calls a law: `plain` numbers, and behind them truths.
fn called(py: Python<'_>, law: &Py<PyAny>, name: &str, x: &[f64], plain: usize) -> PyResult<f64> {
    let argument = |(i, x): (usize, &f64)| match i < plain {
        true => PyFloat::new(py, *x).into_any(),
        false => PyBool::new(py, *x != 0.0).to_owned().into_any(),
    };
    let arguments = PyTuple::new(py, x.iter().enumerate().map(argument))?;
    let value = law.bind(py).call1(arguments)?;
    value.extract().map_err(|_| match value.repr() {
        Ok(shown) => PyTypeError::new_err(format!("function `{name}` gave {shown}, and not a number")),
        Err(error) => error,
    })
}

impl Functions {
    /// The functions that were described.
    pub(crate) fn new(described: Vec<Described>) -> Self {
        let shared = |(argument, slope): (String, Py<PyAny>)| (argument, Arc::new(slope));
        let function = |(name, arguments, law, slopes, unit, switches): Described| Function {
            name,
            arguments,
            law: Arc::new(law),
            slopes: slopes.into_iter().map(shared).collect(),
            unit,
            switches,
        };
        Self(Arc::new(described.into_iter().map(function).collect()))
    }

    /// A model with these functions, and where one computation with it keeps what they raise.
    ///
    /// # Errors
    /// If the functions do not fit.
    pub(crate) fn with(&self, model: &grashof::Model) -> Result<(grashof::Model, Trouble), Error> {
        if self.0.is_empty() {
            return Ok((model.clone(), Trouble::default()));
        }
        let trouble = Trouble(Arc::new(Kept { functions: true, ..Kept::default() }));
        let functions = self.0.iter().map(|function| function.external(&trouble)).collect();
        Ok((model.with_functions(functions)?, trouble))
    }
}

impl Function {
    fn external(&self, trouble: &Trouble) -> ExternalFunction {
        let sides = self.switches.as_ref().map_or(0, Vec::len);
        let plain = self.arguments.len().saturating_sub(sides);
        let law = |law: &Arc<Py<PyAny>>| {
            let (law, name, trouble) = (Arc::clone(law), self.name.clone(), trouble.clone());
            move |x: &[f64]| trouble.value(&law, &name, x, plain)
        };
        let arguments: Vec<&str> = self.arguments[..plain].iter().map(String::as_str).collect();
        let mut function = ExternalFunction::new(&self.name, &arguments, law(&self.law));
        for (argument, slope) in &self.slopes {
            function = function.slope(argument, law(slope));
        }
        if let Some(unit) = &self.unit {
            function = function.unit(unit);
        }
        if let Some(switches) = &self.switches {
            let switches: Vec<(&str, &str)> = switches.iter().map(|(name, condition)| (name.as_str(), condition.as_str())).collect();
            function = function.switches(&switches);
        }
        function
    }
}
