//! Tables as Apache Parquet files: columns of 64-bit numbers, null where there is no value.
//!
//! Each column carries its unit and its quantity as metadata of its Arrow field, which Arrow, pandas and Polars read. Rows stand in groups
//! of a fixed size, so that a file depends on its rows alone.

mod gather;
mod read;

pub use gather::gather_parquet;
pub use read::ParquetTable;

use super::row_writer::{RowWriter, Target};
use crate::results::{Column, Table};
use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_writer::ArrowWriterOptions;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;
use std::collections::HashMap;
use std::io;
use std::sync::Arc;

/// Rows of a group.
const GROUP: usize = 1 << 17;
/// Rows that are encoded at a time, a part of a group.
const BATCH: usize = 1 << 13;

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

/// The columns of a table, and of a sweep the reasons behind them.
fn schema(columns: &[&Column], reasons: bool) -> SchemaRef {
    let reason = reasons.then(|| Field::new(read::REASON, DataType::Utf8, false));
    Arc::new(Schema::new(columns.iter().copied().map(field).chain(reason).collect::<Vec<_>>()))
}

fn writer<W: io::Write + Send>(file: W, schema: &SchemaRef) -> io::Result<ArrowWriter<W>> {
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).set_max_row_group_row_count(Some(GROUP)).build();
    let options = ArrowWriterOptions::new().with_properties(properties);
    ArrowWriter::try_new_with_options(file, schema.clone(), options).map_err(io::Error::other)
}

fn write<W: io::Write + Send>(writer: Option<&mut ArrowWriter<W>>, schema: &SchemaRef, arrays: Vec<ArrayRef>) -> io::Result<()> {
    let batch = RecordBatch::try_new(schema.clone(), arrays).map_err(io::Error::other)?;
    writer.map_or_else(|| Err(lost()), |writer| writer.write(&batch).map_err(io::Error::other))
}

/// A column with its unit, SI.
fn field(column: &Column) -> Field {
    let about = [("unit", &column.unit), ("quantity", &column.quantity)];
    let about = about.into_iter().filter(|(_, word)| !word.is_empty()).map(|(key, word)| (key.to_owned(), word.clone()));
    Field::new(&column.name, DataType::Float64, true).with_metadata(about.collect::<HashMap<_, _>>())
}

/// A number, where there is one: the cells that CSV leaves blank are null.
fn defined(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

/// Rows before their columns.
fn lost() -> io::Error {
    io::Error::other("no columns have begun")
}

#[cfg(test)]
mod tests;
