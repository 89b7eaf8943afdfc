//! Files that a model includes, read beside the model file.

use std::fs::{self, File};
use std::io::{Error, Read};
use std::path::Path;

/// Largest included file that is read at all; the reader itself refuses above 16 MiB and says so.
pub const MOST_INCLUDED: u64 = 17 << 20;

/// A file that a model includes, by its path from the model file: its name and what is in it.
///
/// # Errors
/// Why it cannot be read, in words.
pub fn beside(model: &str, included: &str) -> Result<(String, Vec<u8>), String> {
    let path = Path::new(model).parent().unwrap_or(Path::new("")).join(included);
    let name = path.to_string_lossy().into_owned();
    let read = || {
        match fs::metadata(&path)? {
            known if known.is_dir() => return Err(Error::other("it is a directory")),
            // a pipe may have no writer, and a device no end
            known if !known.is_file() => return Err(Error::other("it is no plain file")),
            _ => {}
        }
        let mut bytes = Vec::new();
        File::open(&path)?.take(MOST_INCLUDED).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    read().map(|bytes| (name, bytes)).map_err(|error| why(&error))
}

/// Why a file cannot be read.
#[must_use]
pub fn why(error: &Error) -> String {
    if error.kind() == std::io::ErrorKind::NotFound { "there is no such file".to_string() } else { error.to_string() }
}
