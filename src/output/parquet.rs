//! Tables as Apache Parquet files: columns of 64-bit numbers, null where there is no value.
//!
//! Each column carries its unit and its quantity as metadata of its Arrow field, which Arrow, pandas and Polars read. Rows stand in groups
//! of a fixed size, so that a file depends on its rows alone.

mod encode;
mod gather;
mod read;

pub use gather::gather_parquet;
pub use read::ParquetTable;

use self::encode::{BATCH, defined, field, lost, schema, write, writer};
use super::row_writer::{RowWriter, Target};
use crate::results::{Column, Table};
use arrow_array::{ArrayRef, Float64Array, StringArray};
use arrow_schema::{Schema, SchemaRef};
use parquet::arrow::ArrowWriter;
use std::io;
use std::sync::Arc;

/// Rows as they are computed.
pub(super) struct ParquetRows<T: Target> {
    /// Where they go before they begin, and where they have begun.
    file: Option<T>,
    writer: Option<ArrowWriter<T>>,
    schema: SchemaRef,
    /// Rows that are not encoded yet, by column.
    columns: Vec<Vec<Option<f64>>>,
}

impl<T: Target> ParquetRows<T> {
    pub(super) fn new(file: T) -> Self {
        Self { file: Some(file), writer: None, schema: Arc::new(Schema::empty()), columns: Vec::new() }
    }

    /// Encodes the rows that wait.
    fn encode(&mut self) -> io::Result<()> {
        if self.columns.first().is_none_or(Vec::is_empty) {
            return Ok(());
        }
        let arrays = self.columns.iter_mut().map(|column| Arc::new(Float64Array::from_iter(column.drain(..))) as ArrayRef).collect();
        write(self.writer.as_mut(), &self.schema, arrays)
    }
}

impl<T: Target> RowWriter<T> for ParquetRows<T> {
    fn begin(&mut self, columns: &[Column]) -> io::Result<()> {
        let begun = self.writer.take().map(|writer| writer.into_inner().map_err(io::Error::other)).transpose()?;
        let Some(mut file) = begun.or(self.file.take()) else { return Err(lost()) };
        file.empty()?;
        self.schema = Arc::new(Schema::new(columns.iter().map(field).collect::<Vec<_>>()));
        self.columns = vec![Vec::new(); columns.len()];
        self.writer = Some(writer(file, &self.schema)?);
        Ok(())
    }

    fn row(&mut self, values: &[f64]) -> io::Result<()> {
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(defined(*value));
        }
        if self.columns.first().is_some_and(|column| column.len() == BATCH) { self.encode() } else { Ok(()) }
    }

    fn end(mut self: Box<Self>) -> io::Result<T> {
        self.encode()?;
        self.writer.map_or_else(|| Err(lost()), |writer| writer.into_inner().map_err(io::Error::other))
    }
}

/// The Parquet file of a table, with the `reason` column last if there is one.
///
/// # Errors
/// What the encoder says.
pub fn write_parquet(table: &Table) -> io::Result<Vec<u8>> {
    let schema = schema(&table.columns.iter().collect::<Vec<_>>(), table.reasons.is_some());
    let mut writer = writer(Vec::new(), &schema)?;
    for from in (0..table.rows()).step_by(BATCH) {
        let rows = from..(from + BATCH).min(table.rows());
        let numbers = |column: &Column| {
            // a short column is filled up
            let value = |row: usize| column.values.get(row).copied().and_then(defined);
            Arc::new(rows.clone().map(value).collect::<Float64Array>()) as ArrayRef
        };
        let mut arrays: Vec<ArrayRef> = table.columns.iter().map(numbers).collect();
        if let Some(reasons) = &table.reasons {
            arrays.push(Arc::new(StringArray::from_iter_values(rows.map(|row| reasons.get(row).map_or("", String::as_str)))));
        }
        write(Some(&mut writer), &schema, arrays)?;
    }
    writer.into_inner().map_err(io::Error::other)
}

#[cfg(test)]
mod tests;
