//! What could not be written.

use std::fmt;
use std::io::{self, ErrorKind};
use std::path::PathBuf;

/// A file or directory that could not be written, and why.
#[derive(Debug)]
pub struct WriteError {
    /// What could not be written.
    pub path: PathBuf,
    /// The system's reason; [`ErrorKind::AlreadyExists`] for a file that no run is recorded to have written.
    pub cause: io::Error,
}
impl WriteError {
    /// What can be done about it.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self.cause.kind() {
            ErrorKind::AlreadyExists => "move it away, choose another directory with `-o DIR`, or replace it with `--force`",
            _ => "choose another directory with `-o DIR`",
        }
    }
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot write {}: {}", self.path.display(), self.cause)
    }
}

impl std::error::Error for WriteError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.cause)
    }
}
