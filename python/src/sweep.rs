//! Sweeps that are computed part by part, and the tables that their parts leave.

use crate::errors::{raised, refused};
use crate::functions::Trouble;
use crate::interrupt::away;
use crate::results::Results;
use grashof::api::PreparedSweep;
use grashof::output::{ParquetTable, gather_parquet};
use grashof::results::Column;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pythonize::pythonize;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Name, SI unit and quantity of a column.
type About = (String, String, String);

fn about(columns: &[Column]) -> Vec<About> {
    columns.iter().map(|column| (column.name.clone(), column.unit.clone(), column.quantity.clone())).collect()
}

/// A sweep whose model has been read and whose points are known.
#[pyclass(frozen, module = "grashof._grashof")]
pub(crate) struct Sweep {
    sweep: Arc<PreparedSweep>,
    trouble: Trouble,
}

impl Sweep {
    pub(crate) fn new(sweep: PreparedSweep, trouble: Trouble) -> Self {
        Self { sweep: Arc::new(sweep), trouble }
    }
}

#[pymethods]
impl Sweep {
    /// Number of runs.
    #[getter]
    fn count(&self) -> usize {
        self.sweep.count()
    }

    /// Names of the parameters that run through values.
    #[getter]
    fn parameters(&self) -> Vec<String> {
        self.sweep.parameters().into_iter().map(str::to_owned).collect()
    }

    /// A text of all that decides the results.
    fn content(&self, py: Python<'_>) -> String {
        py.detach(|| self.sweep.content())
    }

    /// Computes the runs from one on to another, which is not computed.
    #[pyo3(signature = (first, end, threads=1))]
    fn only(&self, py: Python<'_>, first: usize, end: usize, threads: usize) -> PyResult<Results> {
        let (sweep, thread) = (Arc::clone(&self.sweep), self.trouble.clone());
        let run = away(py, move |flag| thread.known(|| sweep.only(first..end, threads.max(1), &|| flag.load(Ordering::Relaxed))))?;
        Results::new(py, self.trouble.settle(py, run)?)
    }

    /// Values of the parameters by their chances, a row a point.
    fn at_chances<'py>(&self, py: Python<'py>, chances: PyReadonlyArray2<'py, f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let [rows, columns] = [chances.as_array().nrows(), chances.as_array().ncols()];
        let mut values = Vec::with_capacity(rows * columns);
        for row in chances.as_array().rows() {
            values.extend(self.sweep.at_chances(&row.to_vec()).map_err(|error| raised(py, &error))?);
        }
        PyArray1::from_vec(py, values).reshape([rows, columns])
    }

    /// Writes the table of all runs from those of its parts, files in the order of the runs.
    fn gather(&self, py: Python<'_>, parts: Vec<PathBuf>, into: PathBuf) -> PyResult<()> {
        let sweep = Arc::clone(&self.sweep);
        let gathered = away(py, move |_| {
            let mut file = BufWriter::new(File::create(into)?);
            gather_parquet(&sweep.columns(), &parts, &mut file)?;
            file.flush()?;
            file.get_ref().sync_all()
        })?;
        gathered.map_err(|why: io::Error| refused(py, &why.to_string(), "look after the directory of the results"))
    }

    /// How the numbers of a table of all runs are distributed, if values are drawn.
    fn statistics<'py>(&self, py: Python<'py>, table: &Bound<'py, Table>) -> PyResult<Bound<'py, PyAny>> {
        let table = table.get();
        let read = py.detach(|| table.whole()).map_err(|why| unreadable(py, &why))?;
        Ok(pythonize(py, &self.sweep.statistics(&read))?)
    }
}

/// A table in a Parquet file.
#[pyclass(frozen, module = "grashof._grashof")]
pub(crate) struct Table {
    table: ParquetTable,
}

impl Table {
    fn whole(&self) -> io::Result<grashof::results::Table> {
        let with_values = |column: &Column| Ok(Column { values: self.table.column(&column.name)?, ..column.clone() });
        let columns = self.table.columns().iter().map(with_values).collect::<io::Result<Vec<_>>>()?;
        Ok(grashof::results::Table { columns, ..Default::default() })
    }
}

fn unreadable(py: Python<'_>, why: &io::Error) -> PyErr {
    refused(py, &format!("the table cannot be read: {why}"), "name a file that this package has written")
}

#[pymethods]
impl Table {
    /// Looks at what is in a file.
    #[new]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let table = ParquetTable::open(&path).map_err(|why| unreadable(py, &why))?;
        Ok(Self { table })
    }

    /// Number of rows.
    #[getter]
    fn rows(&self) -> usize {
        self.table.rows()
    }

    /// Name, SI unit and quantity of each column of numbers.
    #[getter]
    fn columns(&self) -> Vec<About> {
        about(self.table.columns())
    }

    /// The values of a column; NaN where there is none.
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = py.detach(|| self.table.column(name)).map_err(|why| unreadable(py, &why))?;
        Ok(PyArray1::from_vec(py, values))
    }

    /// Why each run of a sweep has no whole result.
    fn reasons(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        py.detach(|| self.table.reasons()).map_err(|why| unreadable(py, &why))
    }
}
