//! The table of a motion, written to its files while it is computed.

use super::content::Spooled;
use super::csv_rows::CsvLines;
use super::formats::Formats;
#[cfg(feature = "parquet")]
use super::parquet::ParquetRows;
use super::row_writer::{RowWriter, Writers};
use super::write_error::WriteError;
use crate::results::{Column, Sink};
use std::path::{Path, PathBuf};
use tempfile::SpooledTempFile;

/// A sink that writes rows in all formats that are asked for, to files without a name until all results are there: see
/// [`Staging::add_spooled`](super::Staging::add_spooled).
pub struct RowFiles {
    directory: PathBuf,
    ends: Vec<&'static str>,
    rows: Writers<SpooledTempFile>,
}

impl RowFiles {
    /// Files for a directory, which may not be there yet.
    #[must_use]
    pub fn new(directory: &Path, formats: Formats) -> Self {
        let mut ends = Vec::new();
        let mut writers: Vec<Box<dyn RowWriter<SpooledTempFile>>> = Vec::new();
        if formats.csv {
            ends.push(".csv");
            writers.push(Box::new(CsvLines::new(Spooled::file(directory))));
        }
        #[cfg(feature = "parquet")]
        if formats.parquet {
            ends.push(".parquet");
            writers.push(Box::new(ParquetRows::new(Spooled::file(directory))));
        }
        Self { directory: directory.to_owned(), ends, rows: Writers::new(writers) }
    }

    /// The ends of the files' names, and what they hold; none if there were no rows.
    ///
    /// # Errors
    /// The directory and the system's reason why a row could not be written.
    pub fn finish(self) -> Result<Option<Vec<(String, Spooled)>>, WriteError> {
        let Self { directory, ends, rows } = self;
        let written = rows.end().map_err(|cause| WriteError { path: directory, cause })?;
        Ok(written.map(|files| ends.iter().map(|end| (*end).to_owned()).zip(files.into_iter().map(Spooled::new)).collect()))
    }
}

impl Sink for RowFiles {
    fn begin(&self, independent: &Column, columns: &[Column]) {
        self.rows.begin(independent, columns);
    }

    fn row(&self, place: f64, values: &[f64]) {
        self.rows.row(place, values);
    }
}
