//! Results of a study: tables as NumPy arrays, all else as dictionaries.

use crate::drawn;
use crate::errors::{raised, refused};
use grashof::output;
use grashof::results::{self, Column, Run, Scene};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use pythonize::pythonize;

/// Results of one study.
#[pyclass(frozen, module = "grashof._grashof")]
pub(crate) struct Results {
    /// All but the numbers of columns, the drawings and the runs.
    facts: results::Results,
    /// Columns × rows, so that each column lies in one piece.
    table: Py<PyArray2<f64>>,
    independent: Py<PyArray2<f64>>,
    curves: Py<PyArray2<f64>>,
    scenes: Vec<(String, Scene)>,
    runs: Vec<Run>,
}

impl Results {
    /// Moves the numbers of columns into arrays.
    pub(crate) fn new(py: Python<'_>, mut facts: results::Results) -> PyResult<Self> {
        let rows = facts.table.rows();
        Ok(Self {
            table: taken(py, &mut facts.table.columns, rows)?,
            independent: taken(py, std::slice::from_mut(&mut facts.independent), rows)?,
            curves: taken(py, &mut facts.curves, rows)?,
            scenes: std::mem::take(&mut facts.scenes),
            runs: std::mem::take(&mut facts.runs),
            facts,
        })
    }

    /// The results with the numbers of their columns, without drawings and runs.
    pub(crate) fn rows(&self, py: Python<'_>) -> PyResult<results::Results> {
        let mut results = self.facts.clone();
        given(&self.table.bind(py).try_readonly()?, &mut results.table.columns)?;
        given(&self.independent.bind(py).try_readonly()?, std::slice::from_mut(&mut results.independent))?;
        given(&self.curves.bind(py).try_readonly()?, &mut results.curves)?;
        Ok(results)
    }

    /// The results as they were.
    pub(crate) fn whole(&self, py: Python<'_>) -> PyResult<results::Results> {
        Ok(results::Results { scenes: self.scenes.clone(), runs: self.runs.clone(), ..self.rows(py)? })
    }
}

/// The numbers of columns as an array that cannot be written to.
fn taken(py: Python<'_>, columns: &mut [Column], rows: usize) -> PyResult<Py<PyArray2<f64>>> {
    let mut values = Vec::with_capacity(columns.len() * rows);
    for column in columns.iter_mut() {
        let end = values.len() + rows;
        values.append(&mut std::mem::take(&mut column.values));
        values.resize(end, f64::NAN);
    }
    let array = PyArray1::from_vec(py, values).reshape([columns.len(), rows])?;
    array.try_readwrite()?.make_nonwriteable();
    Ok(array.unbind())
}

/// Gives columns their numbers again.
fn given(array: &PyReadonlyArray2<'_, f64>, columns: &mut [Column]) -> PyResult<()> {
    let values = array.as_slice()?;
    let rows = values.len() / columns.len().max(1);
    for (column, values) in columns.iter_mut().zip(values.chunks(rows.max(1))) {
        column.values = values.to_vec();
    }
    Ok(())
}

#[pymethods]
impl Results {
    /// The numbers of the columns, SI: columns × rows.
    #[getter]
    fn table(&self, py: Python<'_>) -> Py<PyArray2<f64>> {
        self.table.clone_ref(py)
    }

    /// The independent variable of each row: 1 × rows.
    #[getter]
    fn independent(&self, py: Python<'_>) -> Py<PyArray2<f64>> {
        self.independent.clone_ref(py)
    }

    /// The numbers of curves that only figures show: curves × rows.
    #[getter]
    fn curves(&self, py: Python<'_>) -> Py<PyArray2<f64>> {
        self.curves.clone_ref(py)
    }

    /// All else but drawings and runs, as plain Python objects; columns without their values.
    fn facts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(pythonize(py, &self.facts)?)
    }

    /// Number of runs of a sweep.
    #[getter]
    fn run_count(&self) -> usize {
        self.runs.len()
    }

    /// Label and results of a run of a sweep; none if it did not begin.
    fn run(&self, py: Python<'_>, index: usize) -> PyResult<(String, Option<Self>)> {
        let run = self.runs.get(index).ok_or_else(|| pyo3::exceptions::PyIndexError::new_err("there is no such run"))?;
        let results = run.results.as_ref().map(|results| Self::new(py, results::Results::clone(results))).transpose()?;
        Ok((run.label.clone(), results))
    }

    /// What was found, in words.
    fn summary(&self, py: Python<'_>) -> PyResult<String> {
        let results = results::Results { runs: self.runs.clone(), ..self.rows(py)? };
        Ok(py.detach(|| output::summary(&results)))
    }

    /// The text of the CSV file.
    fn csv(&self, py: Python<'_>) -> PyResult<String> {
        let table = self.rows(py)?.table;
        Ok(py.detach(|| output::write_csv(&table)))
    }

    /// The text of the JSON file.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        let results = results::Results { runs: self.runs.clone(), ..self.rows(py)? };
        Ok(py.detach(|| output::write_json(&results)))
    }

    /// The bytes of the Parquet file.
    fn parquet<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let table = self.rows(py)?.table;
        let bytes = py.detach(|| output::write_parquet(&table)).map_err(|why| refused(py, &why.to_string(), "write it as CSV"))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Figures: those of the study that have these names, or one of these columns over the independent variable or another column; without
    /// names all of the study.
    #[pyo3(signature = (names, over=None))]
    fn figures<'py>(&self, py: Python<'py>, names: Vec<String>, over: Option<String>) -> PyResult<Bound<'py, PyAny>> {
        let results = results::Results { runs: self.runs.clone(), ..self.rows(py)? };
        drawn::figures(py, results, &names, over)
    }

    /// The SVG text of each figure of the study, by name.
    fn figures_svg(&self, py: Python<'_>) -> PyResult<Vec<(String, String)>> {
        let results = results::Results { runs: self.runs.clone(), ..self.rows(py)? };
        py.detach(|| drawn::figures_svg(&results)).map_err(|why| refused(py, &why, "draw it by `plot`"))
    }

    /// The motion, or a mode by its number from 0, as the text of an SVG that moves.
    #[pyo3(signature = (mode=0, width=800, rate=30.0, speed=1.0, duration=None))]
    fn animation(&self, py: Python<'_>, mode: usize, width: usize, rate: f64, speed: f64, duration: Option<f64>) -> PyResult<String> {
        let results = results::Results { scenes: self.scenes.clone(), ..self.rows(py)? };
        let made = py
            .detach(|| drawn::animation(&results, mode, width, rate, duration.map_or(output::Pace::Speed(speed), output::Pace::Duration)));
        made.map_err(|error| raised(py, &error))
    }
}
