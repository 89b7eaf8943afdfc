//! Tables as Apache Parquet files: columns of 64-bit numbers, null where there is no value.
//!
//! Each column carries its unit and its quantity as metadata of its Arrow field, which Arrow, pandas and Polars read. Rows stand in groups
//! of a fixed size, so that a file depends on its rows alone.

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
    let reason = table.reasons.iter().map(|_| Field::new("reason", DataType::Utf8, false));
    let schema = Arc::new(Schema::new(table.columns.iter().map(field).chain(reason).collect::<Vec<_>>()));
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
mod tests {
    use super::*;
    use arrow_array::Array;
    use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
    use std::fs::File;
    use std::io::{Cursor, Write};

    fn reader(bytes: &[u8]) -> ParquetRecordBatchReaderBuilder<File> {
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(bytes).unwrap();
        ParquetRecordBatchReaderBuilder::try_new(file).unwrap()
    }

    /// Names, units, numbers (NaN for null) and row groups of a file.
    fn read(bytes: &[u8]) -> (Vec<String>, Vec<Option<String>>, Vec<Vec<f64>>, usize) {
        let builder = reader(bytes);
        let fields: Vec<_> = builder.schema().fields().iter().cloned().collect();
        let groups = builder.metadata().num_row_groups();
        let mut columns = vec![Vec::new(); fields.len()];
        for batch in builder.build().unwrap() {
            for (out, array) in columns.iter_mut().zip(batch.unwrap().columns()) {
                if let Some(numbers) = array.as_any().downcast_ref::<Float64Array>() {
                    out.extend(numbers.iter().map(|x| x.unwrap_or(f64::NAN)));
                }
            }
        }
        let units = fields.iter().map(|field| field.metadata().get("unit").cloned()).collect();
        (fields.iter().map(|field| field.name().clone()).collect(), units, columns, groups)
    }

    fn column(name: &str, unit: &str, values: Vec<f64>) -> Column {
        Column { name: name.into(), unit: unit.into(), values, ..Column::default() }
    }

    #[test]
    fn a_table_reads_back_bit_for_bit_and_rows_give_the_same_bytes() {
        let n = GROUP + BATCH + 3;
        let t: Vec<f64> = (0..n).map(|i| i as f64 / 3.0).collect();
        let x: Vec<f64> = (0..n).map(|i| if i % 1000 == 7 { f64::NAN } else { (i as f64).sin() }).collect();
        let table = Table { columns: vec![column("time", "s", t.clone()), column("a, b", "", x.clone())], ..Table::default() };
        let bytes = write_parquet(&table).unwrap();
        let (names, units, columns, groups) = read(&bytes);
        assert_eq!((names, units, groups), (vec!["time".into(), "a, b".into()], vec![Some("s".into()), None], 2));
        let same = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan())
        };
        assert!(same(&columns[0], &t) && same(&columns[1], &x));

        let mut rows = Box::new(ParquetRows::new(Cursor::new(Vec::new())));
        // rows that begin anew do not count
        for _ in 0..2 {
            rows.begin(&table.columns).unwrap();
            (0..n).for_each(|i| rows.row(&[t[i], x[i]]).unwrap());
        }
        assert!(rows.end().unwrap().into_inner() == bytes, "other bytes");
    }

    #[test]
    fn a_sweep_has_its_reasons_last() {
        let table = Table {
            columns: vec![column("l3", "m", vec![0.1, 0.2])],
            reasons: Some(vec![String::new(), "no turn".into()]),
            ..Table::default()
        };
        let builder = reader(&write_parquet(&table).unwrap());
        let batch = builder.build().unwrap().next().unwrap().unwrap();
        let reasons = batch.column_by_name("reason").unwrap().as_any().downcast_ref::<StringArray>().unwrap().clone();
        assert_eq!((reasons.value(0), reasons.value(1), reasons.null_count()), ("", "no turn", 0));
    }
}
