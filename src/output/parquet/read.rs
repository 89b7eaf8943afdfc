//! Tables in Parquet files, read column by column.

use crate::results::Column;
use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, RecordBatch};
use arrow_schema::{DataType, Field};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::{ParquetRecordBatchReader, ParquetRecordBatchReaderBuilder};
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// A table in a Parquet file that this room has written.
#[derive(Debug)]
pub struct ParquetTable {
    path: PathBuf,
    columns: Vec<Column>,
    /// Columns in which a row has a value.
    filled: Vec<bool>,
    rows: usize,
}

impl ParquetTable {
    /// Looks at what is in a file.
    ///
    /// # Errors
    /// If it cannot be read, or is no such file.
    pub fn open(path: &Path) -> io::Result<Self> {
        let builder = open(path)?;
        let metadata = builder.metadata();
        let rows = usize::try_from(metadata.file_metadata().num_rows()).map_err(io::Error::other)?;
        let fields: Vec<_> = builder.schema().fields().iter().enumerate().filter(|(_, field)| is_number(field)).collect();
        let filled = |index: usize| {
            let groups = metadata.row_groups().iter().map(|group| (group.num_rows(), group.column(index).statistics()));
            groups.into_iter().any(|(rows, known)| known.and_then(|known| known.null_count_opt()) != u64::try_from(rows).ok())
        };
        let filled = fields.iter().map(|(index, _)| filled(*index)).collect();
        Ok(Self { path: path.to_owned(), columns: fields.iter().map(|(_, field)| column(field)).collect(), filled, rows })
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The columns of numbers, without values.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Whether a column has a value in a row; none if there is no such column.
    pub(super) fn is_filled(&self, name: &str) -> Option<bool> {
        self.columns.iter().position(|column| column.name == name).map(|index| self.filled[index])
    }

    /// The values of a column; NaN where there is none.
    ///
    /// # Errors
    /// If the file cannot be read, or has no such column.
    pub fn column(&self, name: &str) -> io::Result<Vec<f64>> {
        let mut values = Vec::with_capacity(self.rows);
        for batch in self.batches(&[name], usize::MAX)? {
            numbers(&batch.map_err(io::Error::other)?, name, &mut |x| values.push(x.unwrap_or(f64::NAN)))?;
        }
        Ok(values)
    }

    /// Why each run of a sweep has no whole result; empty where it has.
    ///
    /// # Errors
    /// If the file cannot be read, or is of no sweep.
    pub fn reasons(&self) -> io::Result<Vec<String>> {
        let mut all = Vec::with_capacity(self.rows);
        for batch in self.batches(&[REASON], usize::MAX)? {
            reasons(&batch.map_err(io::Error::other)?, &mut |reason| all.push(reason.to_owned()))?;
        }
        Ok(all)
    }

    /// The rows of some columns, not more than so many at a time.
    pub(super) fn batches(&self, names: &[&str], rows: usize) -> io::Result<ParquetRecordBatchReader> {
        let builder = open(&self.path)?;
        let fields = builder.schema().fields().iter().enumerate();
        let wanted: Vec<usize> = fields.filter(|(_, field)| names.contains(&field.name().as_str())).map(|(index, _)| index).collect();
        let mask = ProjectionMask::roots(builder.parquet_schema(), wanted);
        builder.with_projection(mask).with_batch_size(rows.min(MOST)).build().map_err(io::Error::other)
    }
}

/// The column of a sweep behind its numbers.
pub(super) const REASON: &str = "reason";
/// Rows that are read at a time, at most.
const MOST: usize = 1 << 16;

fn open(path: &Path) -> io::Result<ParquetRecordBatchReaderBuilder<File>> {
    ParquetRecordBatchReaderBuilder::try_new(File::open(path)?).map_err(io::Error::other)
}

fn is_number(field: &Field) -> bool {
    *field.data_type() == DataType::Float64
}

/// A column without values, as the field of a file tells it.
fn column(field: &Field) -> Column {
    let about = |key: &str| field.metadata().get(key).cloned().unwrap_or_default();
    Column { name: field.name().clone(), unit: about("unit"), quantity: about("quantity"), ..Column::default() }
}

/// Gives each number of a column of some rows.
pub(super) fn numbers(batch: &RecordBatch, name: &str, take: &mut dyn FnMut(Option<f64>)) -> io::Result<()> {
    let array = batch.column_by_name(name).and_then(|array| array.as_primitive_opt::<Float64Type>());
    array.ok_or_else(|| lacks(name))?.iter().for_each(take);
    Ok(())
}

/// Gives each reason of some rows.
pub(super) fn reasons(batch: &RecordBatch, take: &mut dyn FnMut(&str)) -> io::Result<()> {
    let array = batch.column_by_name(REASON).and_then(|array| array.as_string_opt::<i32>()).ok_or_else(|| lacks(REASON))?;
    (0..array.len()).for_each(|row| take(array.value(row)));
    Ok(())
}

fn lacks(name: &str) -> io::Error {
    io::Error::other(format!("the file has no column `{name}`"))
}
