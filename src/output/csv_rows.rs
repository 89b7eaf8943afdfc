//! Rows that go to a CSV file as they are computed, so that a long run takes no memory for them.

use super::csv::{push_line, quoted};
use super::row_writer::{RowWriter, Target, Writers};
use super::write_error::WriteError;
use crate::results::{Column, Sink, number};
use std::borrow::Cow;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A sink that writes the columns of a run to a CSV file: the bytes of the table's.
///
/// Until [`CsvRows::finish`] the rows lie beside it in a file `.NAME.new`, which is removed if it is not called.
pub struct CsvRows {
    path: PathBuf,
    lines: Option<Writers<File>>,
}

impl CsvRows {
    /// Opens the file beside `path`.
    ///
    /// # Errors
    /// The path and the system's reason.
    pub fn create(path: &Path) -> Result<Self, WriteError> {
        let file = File::create(beside(path)).map_err(|cause| WriteError { path: path.to_owned(), cause })?;
        Ok(Self { path: path.to_owned(), lines: Some(Writers::new(vec![Box::new(CsvLines::new(file))])) })
    }

    /// Gives the file its name, in place of one that is there.
    ///
    /// # Errors
    /// The path and the system's reason, of the first row that could not be written as well.
    pub fn finish(mut self) -> Result<(), WriteError> {
        let written = self.lines.take().map_or(Ok(None), Writers::end);
        let done = written.and_then(|_| fs::rename(beside(&self.path), &self.path));
        done.map_err(|cause| WriteError { path: self.path.clone(), cause })
    }
}

impl fmt::Debug for CsvRows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CsvRows").field("path", &self.path).finish_non_exhaustive()
    }
}

impl Drop for CsvRows {
    fn drop(&mut self) {
        // not there any more if it was finished
        let _ = fs::remove_file(beside(&self.path));
    }
}

impl Sink for CsvRows {
    fn begin(&self, independent: &Column, columns: &[Column]) {
        self.lines.iter().for_each(|lines| lines.begin(independent, columns));
    }

    fn row(&self, place: f64, values: &[f64]) {
        self.lines.iter().for_each(|lines| lines.row(place, values));
    }
}

/// Where the rows lie until the file is finished.
fn beside(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.new"))
}

/// The lines of a CSV file.
pub(super) struct CsvLines<T: Target> {
    file: BufWriter<T>,
    line: String,
}

impl<T: Target> CsvLines<T> {
    pub(super) fn new(file: T) -> Self {
        Self { file: BufWriter::new(file), line: String::new() }
    }

    fn line<'a>(&mut self, fields: impl Iterator<Item = Cow<'a, str>>) -> io::Result<()> {
        self.line.clear();
        push_line(&mut self.line, fields);
        self.file.write_all(self.line.as_bytes())
    }
}

impl<T: Target> RowWriter<T> for CsvLines<T> {
    fn begin(&mut self, columns: &[Column]) -> io::Result<()> {
        self.file.flush()?;
        self.file.get_mut().empty()?;
        self.line(columns.iter().map(|column| quoted(&column.name)))
    }

    fn row(&mut self, values: &[f64]) -> io::Result<()> {
        if values.is_empty() {
            return Ok(());
        }
        self.line(values.iter().map(|value| Cow::Owned(number(*value))))
    }

    fn end(self: Box<Self>) -> io::Result<T> {
        self.file.into_inner().map_err(io::IntoInnerError::into_error)
    }
}
