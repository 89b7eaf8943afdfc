//! The extension module `grashof._grashof`: the face of the library for the Python package, which stands in `grashof/*.py`.
//!
//! Nothing is computed here. What runs long does so in a thread of its own without the lock of the interpreter ([`interrupt`]); tables
//! are moved into NumPy arrays once ([`results`]); all else of results goes over as dictionaries.

mod drawn;
mod dynamics;
mod errors;
mod functions;
mod interrupt;
mod model;
mod results;
mod stepper;
mod sweep;

use pyo3::prelude::*;

/// The face of the library.
#[pymodule]
mod _grashof {
    use super::*;
    #[pymodule_export]
    use crate::dynamics::Dynamics;
    #[pymodule_export]
    use crate::errors::there_are;
    #[pymodule_export]
    use crate::model::{Model, load, parse, unpack, yaml};
    #[pymodule_export]
    use crate::results::Results;
    #[pymodule_export]
    use crate::stepper::Stepper;
    #[pymodule_export]
    use crate::sweep::{Sweep, Table};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("version", env!("CARGO_PKG_VERSION"))
    }
}
