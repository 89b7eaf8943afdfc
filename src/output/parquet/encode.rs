//! How rows become bytes, whoever has them.

use super::read::REASON;
use crate::results::Column;
use arrow_array::{ArrayRef, RecordBatch};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_writer::ArrowWriterOptions;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;
use std::collections::HashMap;
use std::io;
use std::sync::Arc;

/// Rows of a group.
pub(super) const GROUP: usize = 1 << 17;
/// Rows that are encoded at a time, a part of a group.
pub(super) const BATCH: usize = 1 << 13;

/// The columns of a table, and of a sweep the reasons behind them.
pub(super) fn schema(columns: &[&Column], reasons: bool) -> SchemaRef {
    let reason = reasons.then(|| Field::new(REASON, DataType::Utf8, false));
    Arc::new(Schema::new(columns.iter().copied().map(field).chain(reason).collect::<Vec<_>>()))
}

pub(super) fn writer<W: io::Write + Send>(file: W, schema: &SchemaRef) -> io::Result<ArrowWriter<W>> {
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).set_max_row_group_row_count(Some(GROUP)).build();
    let options = ArrowWriterOptions::new().with_properties(properties);
    ArrowWriter::try_new_with_options(file, schema.clone(), options).map_err(io::Error::other)
}

pub(super) fn write<W: io::Write + Send>(writer: Option<&mut ArrowWriter<W>>, schema: &SchemaRef, arrays: Vec<ArrayRef>) -> io::Result<()> {
    let batch = RecordBatch::try_new(schema.clone(), arrays).map_err(io::Error::other)?;
    writer.map_or_else(|| Err(lost()), |writer| writer.write(&batch).map_err(io::Error::other))
}

/// A column with its unit, SI.
pub(super) fn field(column: &Column) -> Field {
    let about = [("unit", &column.unit), ("quantity", &column.quantity)];
    let about = about.into_iter().filter(|(_, word)| !word.is_empty()).map(|(key, word)| (key.to_owned(), word.clone()));
    Field::new(&column.name, DataType::Float64, true).with_metadata(about.collect::<HashMap<_, _>>())
}

/// A number, where there is one: the cells that CSV leaves blank are null.
pub(super) fn defined(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

/// Rows before their columns.
pub(super) fn lost() -> io::Error {
    io::Error::other("no columns have begun")
}
