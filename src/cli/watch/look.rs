//! What is in the model file and in the files that it includes.

use super::super::files;
use grashof::api::beside;
use grashof::model::{Document, Report};
use std::cell::RefCell;
use std::io::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest file that is read at all; the reader itself refuses above 8 MiB and says so.
pub(super) const MOST: u64 = 16 << 20;

/// What a look found.
#[derive(Clone, Debug)]
pub(super) struct Look {
    /// Bytes of the model file.
    pub(super) bytes: Arc<Vec<u8>>,
    /// The model, or what is wrong with its text.
    pub(super) read: Result<Arc<Document>, Report>,
    /// Files that it includes, with what was in them.
    included: Vec<(PathBuf, Option<Vec<u8>>)>,
}

impl Look {
    /// Whether a file that it includes is another one now.
    pub(super) fn included_changed(&self) -> bool {
        self.included.iter().any(|(path, bytes)| {
            let length = std::fs::metadata(path).map(|of| of.len()).ok();
            let known = bytes.as_ref().map(|bytes| bytes.len() as u64);
            length != known || bytes.is_some() && std::fs::read(path).ok() != *bytes
        })
    }
}

/// Reads the model file and what it includes.
pub(super) fn read(model: &str) -> Result<Look, Error> {
    files::bytes(model, MOST).map(|bytes| of(model, bytes))
}

/// The model of some bytes, in the place of those of its file.
pub(super) fn of(model: &str, bytes: Vec<u8>) -> Look {
    let included = RefCell::new(Vec::new());
    let read = Document::with_files(&bytes, model, &|path| {
        let found = beside(model, path);
        let place = Path::new(model).parent().unwrap_or(Path::new("")).join(path);
        included.borrow_mut().push((place, found.as_ref().ok().map(|(_, bytes)| bytes.clone())));
        found
    });
    Look { bytes: Arc::new(bytes), read: read.map(Arc::new), included: included.into_inner() }
}
