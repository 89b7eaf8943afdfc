//! What a result holds: bytes in memory, or rows that went to a file of their own while they were computed.

use std::io::{self, Read, Seek};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use tempfile::SpooledTempFile;

/// Bytes that stay in memory before they go to a disc.
const IN_MEMORY: usize = 16 << 20;
/// Bytes that are handled at a time.
const PART: usize = 1 << 20;

/// Bytes in memory up to some megabytes, beyond that in a file without a name, which is gone with the program.
#[derive(Clone, Debug)]
pub struct Spooled(Arc<Mutex<SpooledTempFile>>);

impl Spooled {
    /// Bytes that were written; whoever writes stops.
    pub(super) fn new(file: SpooledTempFile) -> Self {
        Self(Arc::new(Mutex::new(file)))
    }

    /// An empty file that would lie on the file system of a directory, which may not be there yet.
    pub(super) fn file(directory: &Path) -> SpooledTempFile {
        let there = directory.ancestors().find(|path| path.is_dir());
        tempfile::spooled_tempfile_in(IN_MEMORY, there.unwrap_or_else(|| Path::new(".")))
    }
}

/// What a result holds.
#[derive(Clone, Debug)]
pub(super) enum Content {
    /// Bytes.
    Bytes(Vec<u8>),
    /// Bytes that may be many.
    Spooled(Spooled),
}

impl Content {
    /// Gives the bytes part by part.
    ///
    /// # Errors
    /// The system's reason, or that of who takes them.
    pub(super) fn parts(&self, each: &mut dyn FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        match self {
            Self::Bytes(bytes) => bytes.chunks(PART).try_for_each(each),
            Self::Spooled(Spooled(file)) => {
                let mut file = file.lock().unwrap_or_else(PoisonError::into_inner);
                file.rewind()?;
                let mut part = vec![0; PART];
                loop {
                    match file.read(&mut part)? {
                        0 => return Ok(()),
                        n => each(&part[..n])?,
                    }
                }
            }
        }
    }
}
