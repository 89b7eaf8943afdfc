//! The table of a sweep from those of its parts, a few rows at a time.

use super::encode::{BATCH, schema, write, writer};
use super::read::{ParquetTable, REASON, numbers, reasons};
use crate::results::Column;
use arrow_array::{ArrayRef, Float64Array, StringArray};
use arrow_schema::SchemaRef;
use parquet::arrow::ArrowWriter;
use std::io;
use std::path::Path;
use std::sync::Arc;

/// Writes the table of a sweep whose parts stand in files of [`write_parquet`](super::write_parquet), in the order of the rows: the bytes
/// are those of the whole table, wherever it was cut. `columns` are all that the sweep can have; those that some parts leave out, since
/// none of their runs has a value, are left out where no part has one.
///
/// # Errors
/// If a part cannot be read, or the file cannot be written.
pub fn gather_parquet<W: io::Write + Send>(columns: &[Column], parts: &[impl AsRef<Path>], file: W) -> io::Result<()> {
    let of = |path: &Path, why: io::Error| io::Error::other(format!("{}: {why}", path.display()));
    let open = |path: &Path| ParquetTable::open(path).map_err(|why| of(path, why));
    let columns = kept(columns, &mut parts.iter().map(|path| open(path.as_ref())))?;
    let mut rows = Rows::new(&columns, file)?;
    for path in parts {
        let path = path.as_ref();
        rows.add(&open(path)?).map_err(|why| of(path, why))?;
    }
    rows.end()
}

/// The columns that the whole table has.
fn kept<'c>(columns: &'c [Column], parts: &mut dyn Iterator<Item = io::Result<ParquetTable>>) -> io::Result<Vec<&'c Column>> {
    let mut lacking = vec![false; columns.len()];
    let mut filled = vec![false; columns.len()];
    for part in parts {
        let part = part?;
        for (k, column) in columns.iter().enumerate() {
            let known = part.is_filled(&column.name);
            lacking[k] |= known.is_none();
            filled[k] |= known == Some(true);
        }
    }
    let kept = columns.iter().enumerate().filter(|(k, _)| !lacking[*k] || filled[*k]);
    Ok(kept.map(|(_, column)| column).collect())
}

/// Rows that are encoded in batches of one size, whatever pieces they come in.
struct Rows<'c, W: io::Write + Send> {
    names: Vec<&'c str>,
    schema: SchemaRef,
    writer: ArrowWriter<W>,
    /// Rows that are not encoded yet, by column.
    columns: Vec<Vec<Option<f64>>>,
    reasons: Vec<String>,
}

impl<'c, W: io::Write + Send> Rows<'c, W> {
    fn new(columns: &[&'c Column], file: W) -> io::Result<Self> {
        let schema = schema(columns, true);
        let writer = writer(file, &schema)?;
        let names = columns.iter().map(|column| column.name.as_str()).collect();
        Ok(Self { names, schema, writer, columns: vec![Vec::new(); columns.len()], reasons: Vec::new() })
    }

    /// Adds the rows of a part.
    fn add(&mut self, part: &ParquetTable) -> io::Result<()> {
        let names: Vec<&str> = self.names.iter().copied().chain([REASON]).collect();
        for batch in part.batches(&names, BATCH)? {
            let batch = batch.map_err(io::Error::other)?;
            for (name, values) in self.names.iter().zip(&mut self.columns) {
                match part.is_filled(name) {
                    Some(_) => numbers(&batch, name, &mut |x| values.push(x))?,
                    None => values.resize(values.len() + batch.num_rows(), None),
                }
            }
            reasons(&batch, &mut |reason| self.reasons.push(reason.to_owned()))?;
            while self.reasons.len() >= BATCH {
                self.encode()?;
            }
        }
        Ok(())
    }

    /// Encodes the first rows that wait.
    fn encode(&mut self) -> io::Result<()> {
        let count = self.reasons.len().min(BATCH);
        let numbers = |column: &mut Vec<Option<f64>>| Arc::new(column.drain(..count).collect::<Float64Array>()) as ArrayRef;
        let mut arrays: Vec<ArrayRef> = self.columns.iter_mut().map(numbers).collect();
        arrays.push(Arc::new(StringArray::from_iter_values(self.reasons.drain(..count))));
        write(Some(&mut self.writer), &self.schema, arrays)
    }

    fn end(mut self) -> io::Result<()> {
        if !self.reasons.is_empty() {
            self.encode()?;
        }
        self.writer.close().map(drop).map_err(io::Error::other)
    }
}
