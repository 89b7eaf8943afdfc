//! Rows of numbers as a file of a format, written one by one.

use crate::results::{Column, Sink};
use std::fs::File;
use std::io::{self, Seek, Write};
use std::sync::{Mutex, PoisonError};
use tempfile::SpooledTempFile;

/// Where the rows of a table go.
pub(super) trait Target: Write + Seek + Send {
    /// Makes it empty.
    fn empty(&mut self) -> io::Result<()>;
}

impl Target for File {
    fn empty(&mut self) -> io::Result<()> {
        self.rewind()?;
        self.set_len(0)
    }
}

impl Target for SpooledTempFile {
    fn empty(&mut self) -> io::Result<()> {
        self.rewind()?;
        self.set_len(0)
    }
}

impl Target for io::Cursor<Vec<u8>> {
    fn empty(&mut self) -> io::Result<()> {
        self.get_mut().clear();
        self.rewind()
    }
}

/// Writes the rows of a table in a format.
pub(super) trait RowWriter<T: Target>: Send {
    /// Begins, or begins again: the rows before do not count.
    fn begin(&mut self, columns: &[Column]) -> io::Result<()>;

    /// A row.
    fn row(&mut self, values: &[f64]) -> io::Result<()>;

    /// Ends, and gives what was written to.
    fn end(self: Box<Self>) -> io::Result<T>;
}

/// A sink that writes rows in several formats at the same time.
pub(super) struct Writers<T: Target>(Mutex<State<T>>);

struct State<T: Target> {
    writers: Vec<Box<dyn RowWriter<T>>>,
    /// Whether rows have begun, and why they could not be written.
    begun: bool,
    failed: Option<io::Error>,
}

impl<T: Target> Writers<T> {
    pub(super) fn new(writers: Vec<Box<dyn RowWriter<T>>>) -> Self {
        Self(Mutex::new(State { writers, begun: false, failed: None }))
    }

    /// What was written to, in order; none if there were no rows.
    pub(super) fn end(self) -> io::Result<Option<Vec<T>>> {
        let State { writers, begun, failed } = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        match failed {
            Some(cause) => Err(cause),
            None if !begun => Ok(None),
            None => writers.into_iter().map(RowWriter::end).collect::<io::Result<Vec<T>>>().map(Some),
        }
    }

    /// Does something with each writer, unless an earlier row could not be written.
    fn each(&self, act: impl FnMut(&mut Box<dyn RowWriter<T>>) -> io::Result<()>) {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        state.begun = true;
        if state.failed.is_none() {
            state.failed = state.writers.iter_mut().try_for_each(act).err();
        }
    }
}

impl<T: Target> Sink for Writers<T> {
    fn begin(&self, _independent: &Column, columns: &[Column]) {
        self.each(|writer| writer.begin(columns));
    }

    fn row(&self, _place: f64, values: &[f64]) {
        self.each(|writer| writer.row(values));
    }
}
