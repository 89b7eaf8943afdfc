//! Rows that go to a CSV file as they are computed, so that a long run takes no memory for them.

use super::csv::push_line;
use super::write_error::WriteError;
use crate::results::{Column, Sink, number};
use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A sink that writes the columns of a run to a CSV file: the bytes of the table's.
///
/// Until [`CsvRows::finish`] the rows lie beside it in a file `.NAME.new`, which is removed if it is not called.
#[derive(Debug)]
pub struct CsvRows {
    path: PathBuf,
    written: Mutex<Written>,
}

#[derive(Debug)]
struct Written {
    file: BufWriter<File>,
    line: String,
    failed: Option<io::Error>,
}

impl CsvRows {
    /// Opens the file beside `path`.
    ///
    /// # Errors
    /// The path and the system's reason.
    pub fn create(path: &Path) -> Result<Self, WriteError> {
        let failed = |cause| WriteError { path: path.to_owned(), cause };
        let file = File::create(beside(path)).map_err(failed)?;
        let written = Written { file: BufWriter::new(file), line: String::new(), failed: None };
        Ok(Self { path: path.to_owned(), written: Mutex::new(written) })
    }

    /// Gives the file its name, in place of one that is there.
    ///
    /// # Errors
    /// The path and the system's reason, of the first row that could not be written as well.
    pub fn finish(self) -> Result<(), WriteError> {
        let mut written = self.written();
        let done = match written.failed.take() {
            Some(cause) => Err(cause),
            None => written.file.flush().and_then(|()| fs::rename(beside(&self.path), &self.path)),
        };
        done.map_err(|cause| WriteError { path: self.path.clone(), cause })
    }

    fn written(&self) -> MutexGuard<'_, Written> {
        self.written.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for CsvRows {
    fn drop(&mut self) {
        // not there any more if it was finished
        let _ = fs::remove_file(beside(&self.path));
    }
}

/// Where the rows lie until the file is finished.
fn beside(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.new"))
}

impl Written {
    /// Writes a line, unless an earlier one could not be.
    fn line<'a>(&mut self, fields: impl Iterator<Item = Cow<'a, str>>) {
        self.line.clear();
        push_line(&mut self.line, fields);
        if self.failed.is_none() {
            self.failed = self.file.write_all(self.line.as_bytes()).err();
        }
    }
}

impl Sink for CsvRows {
    fn begin(&self, _independent: &Column, columns: &[Column]) {
        let mut written = self.written();
        // the rows before do not count
        let emptied = written.file.rewind().and_then(|()| written.file.get_ref().set_len(0));
        written.failed = written.failed.take().or(emptied.err());
        written.line(columns.iter().map(|column| super::csv::quoted(&column.name)));
    }

    fn row(&self, _place: f64, values: &[f64]) {
        self.written().line(values.iter().map(|value| Cow::Owned(number(*value))));
    }
}
