//! Errors of the library as the exceptions of `grashof/errors.py`.

use grashof::Error;
use grashof::model::{Diagnostic, Report, Severity};
use grashof::results::Unknown;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// The exception of an error.
pub(crate) fn raised(py: Python<'_>, error: &Error) -> PyErr {
    let class = match error {
        _ if error.is_unknown_name() => "UnknownName",
        Error::Read { .. } | Error::Wrong(_) => "ModelError",
        Error::Failed { .. } => "StudyError",
        Error::Unknown(_) | Error::Refused { .. } => "Refused",
    };
    let message = match error {
        // its help follows
        Error::Unknown(unknown) => format!("there is no {} `{}`", unknown.what, unknown.name),
        Error::Refused { message, .. } => message.clone(),
        _ => error.to_string(),
    };
    // the text of reports holds their help
    let told = error.report().is_some();
    exception(py, class, (&message, &error.code(), error.place(), &error.help(), told), error.report()).unwrap_or_else(|failed| failed)
}

/// The exception for what a call asks that cannot be given.
pub(crate) fn refused(py: Python<'_>, message: &str, help: &str) -> PyErr {
    exception(py, "Refused", (message, "refused", "", help, false), None).unwrap_or_else(|failed| failed)
}

/// The exception for a run that was ended by a signal, from what the handler of the signal has raised.
pub(crate) fn interrupted(py: Python<'_>, raised: PyErr) -> PyErr {
    if !raised.is_instance_of::<pyo3::exceptions::PyKeyboardInterrupt>(py) {
        return raised;
    }
    let told = ("the run was interrupted", "interrupted", "", "let it run on", true);
    exception(py, "Interrupted", told, None).unwrap_or_else(|failed| failed)
}

/// An exception by its class, with message, code, place, help, and whether the message says the help itself.
fn exception(
    py: Python<'_>,
    class: &str,
    (message, code, place, help, told): (&str, &str, &str, &str, bool),
    report: Option<&Report>,
) -> PyResult<PyErr> {
    let message = if told || help.is_empty() { message.to_string() } else { format!("{message}; {help}") };
    let named = PyDict::new(py);
    named.set_item("code", code)?;
    named.set_item("place", place)?;
    named.set_item("help", help)?;
    named.set_item("faults", faults(py, report)?)?;
    let class = py.import("grashof.errors")?.getattr(class)?;
    Ok(PyErr::from_value(class.call((message,), Some(&named))?))
}

/// What is said of a name that there is not among those that there are.
#[pyfunction]
pub(crate) fn there_are(name: &str, known: Vec<String>) -> String {
    Unknown { what: "name", name: name.into(), known }.help()
}

/// The findings of a report as objects of the class `Fault`.
pub(crate) fn faults<'py>(py: Python<'py>, report: Option<&Report>) -> PyResult<Bound<'py, PyList>> {
    let class = py.import("grashof.errors")?.getattr("Fault")?;
    let fault = |d: &Diagnostic| {
        let severity = match d.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let help = d.help.as_deref().unwrap_or_default();
        let mut text = String::new();
        d.render(&mut text, false);
        class.call1((d.code, severity, &d.message, &d.expected, help, &d.place, &d.file, d.line(), d.column(), text))
    };
    let all: Vec<_> = report.iter().flat_map(|report| &report.diagnostics).map(fault).collect::<PyResult<_>>()?;
    PyList::new(py, all)
}
