//! The equations of motion, evaluated in many states at once.
//!
//! Arrays come with one row a state and go back so; the shapes in front are those of `grashof/dynamics.py`.

use crate::errors::raised;
use grashof::api::{Evaluator, Mechanism};
use grashof::{Error, solvers};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use std::sync::Arc;

type States<'py> = PyReadonlyArray2<'py, f64>;
type Rows<'py> = Bound<'py, PyArray2<f64>>;

/// A mechanism whose equations of motion can be evaluated.
#[pyclass(frozen, module = "grashof._grashof")]
pub(crate) struct Dynamics {
    mechanism: Arc<Mechanism>,
}

impl Dynamics {
    pub(crate) fn new(mechanism: Mechanism) -> Self {
        Self { mechanism: Arc::new(mechanism) }
    }

    /// Evaluates something of each state, `width` numbers, by one evaluator without the lock of the interpreter.
    fn each<'py>(
        &self,
        py: Python<'py>,
        (count, width): (usize, usize),
        evaluate: impl Fn(&mut Evaluator<'_>, usize, &mut Vec<f64>) -> Result<(), Error> + Sync,
    ) -> PyResult<Rows<'py>> {
        let all = py.detach(|| {
            let mut evaluator = self.mechanism.evaluator();
            let mut out = Vec::with_capacity(count * width);
            (0..count).try_for_each(|i| evaluate(&mut evaluator, i, &mut out)).map(|()| out)
        });
        Ok(PyArray1::from_vec(py, all.map_err(|error| raised(py, &error))?).reshape([count, width])?)
    }
}

/// The numbers of the state of a number; `rows` holds states of this width one behind the other.
fn row(rows: &[f64], width: usize, index: usize) -> &[f64] {
    &rows[index * width..][..width]
}

#[pymethods]
impl Dynamics {
    /// Names of the coordinates behind the velocities.
    #[getter]
    fn coordinates(&self) -> Vec<String> {
        self.mechanism.coordinates()
    }

    /// Numbers of coordinates, velocities and constraint rows.
    #[getter]
    fn sizes(&self) -> (usize, usize, usize) {
        self.mechanism.sizes()
    }

    /// Coordinates and velocities of the start.
    fn start<'py>(&self, py: Python<'py>) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>) {
        let (q, v) = self.mechanism.start();
        (PyArray1::from_vec(py, q), PyArray1::from_vec(py, v))
    }

    /// One of the terms that depend on positions: `mass`, `constraints`, `jacobian`.
    fn position<'py>(&self, py: Python<'py>, term: &str, t: PyReadonlyArray1<'py, f64>, q: States<'py>) -> PyResult<Rows<'py>> {
        let (nq, nv, m) = self.mechanism.sizes();
        let (t, q) = (t.as_slice()?, q.as_slice()?);
        let (width, take): (usize, fn(&solvers::Terms, &mut Vec<f64>)) = match term {
            "mass" => (nv * nv, |terms, out| out.extend(terms.mass.to_dense())),
            "constraints" => (m, |terms, out| out.extend(&terms.phi)),
            _ => (m * nv, |terms, out| out.extend(terms.g.to_dense())),
        };
        self.each(py, (t.len(), width), |evaluator, i, out| {
            take(evaluator.position(t[i], row(q, nq, i))?, out);
            Ok(())
        })
    }

    /// The applied forces f along the velocities.
    fn force<'py>(&self, py: Python<'py>, t: PyReadonlyArray1<'py, f64>, q: States<'py>, v: States<'py>) -> PyResult<Rows<'py>> {
        let (nq, nv, _) = self.mechanism.sizes();
        let (t, q, v) = (t.as_slice()?, q.as_slice()?, v.as_slice()?);
        self.each(py, (t.len(), nv), |evaluator, i, out| {
            out.extend(&evaluator.terms(t[i], row(q, nq, i), row(v, nv, i))?.force);
            Ok(())
        })
    }

    /// Accelerations, and behind them the multipliers.
    fn accelerations<'py>(&self, py: Python<'py>, t: PyReadonlyArray1<'py, f64>, q: States<'py>, v: States<'py>) -> PyResult<Rows<'py>> {
        let (nq, nv, m) = self.mechanism.sizes();
        let (t, q, v) = (t.as_slice()?, q.as_slice()?, v.as_slice()?);
        self.each(py, (t.len(), nv + m), |evaluator, i, out| {
            let (a, lambda) = evaluator.accelerations(t[i], row(q, nq, i), row(v, nv, i))?;
            out.extend(a);
            out.extend(lambda);
            Ok(())
        })
    }

    /// The forces that, added to the applied ones, give accelerations.
    fn inverse<'py>(
        &self,
        py: Python<'py>,
        t: PyReadonlyArray1<'py, f64>,
        state: (States<'py>, States<'py>),
        wanted: (States<'py>, States<'py>),
    ) -> PyResult<Rows<'py>> {
        let (nq, nv, m) = self.mechanism.sizes();
        let (t, q, v) = (t.as_slice()?, state.0.as_slice()?, state.1.as_slice()?);
        let (a, multipliers) = (wanted.0.as_slice()?, wanted.1.as_slice()?);
        self.each(py, (t.len(), nv), |evaluator, i, out| {
            out.extend(evaluator.inverse(t[i], row(q, nq, i), row(v, nv, i), row(a, nv, i), row(multipliers, m, i))?);
            Ok(())
        })
    }

    /// Where a body is: its place, then its axes as the columns of a matrix that is written row by row.
    fn pose<'py>(&self, py: Python<'py>, body: &str, q: States<'py>) -> PyResult<Rows<'py>> {
        let count = q.as_array().nrows();
        let q = q.as_slice()?;
        let placed = py.detach(|| {
            let mut out = Vec::with_capacity(12 * count);
            self.mechanism.placements(body, q, |at| {
                out.extend(at.position.iter());
                out.extend(at.rotation.transpose().iter());
            })?;
            Ok::<_, Error>(out)
        });
        Ok(PyArray1::from_vec(py, placed.map_err(|error| raised(py, &error))?).reshape([count, 12])?)
    }
}
