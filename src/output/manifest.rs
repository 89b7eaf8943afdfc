//! The record of what runs have written into a directory: `.grashof.json`.
//!
//! It holds, for each result, the study that it is of, its size, a checksum, and a number for the whole set that was written with
//! it. A file is a result of an earlier run only if its size and checksum are those of the record; anything else is somebody's own
//! work. While a set is being written the record also holds the new sizes and checksums, so that a run that was killed leaves
//! behind what is needed to finish its work. A record that is damaged, or is no plain file, is none.

use super::content::Content;
use super::write_error::WriteError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

/// Name of the record in its directory.
pub(super) const NAME: &str = ".grashof.json";
/// Version of its format.
const VERSION: u32 = 1;
/// Largest record that is read, bytes.
const MOST: u64 = 64 << 20;

/// By what the content of a file is known.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Mark {
    /// Bytes.
    pub(super) size: u64,
    /// Checksum, 16 hexadecimal digits.
    sum: String,
}

/// A result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Entry {
    pub(super) study: String,
    /// The same for all files of one set: files of a study with different ones are of different runs.
    pub(super) set: String,
    #[serde(flatten)]
    pub(super) mark: Mark,
}

/// A set that is being written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Writing {
    pub(super) study: String,
    pub(super) set: String,
    /// End of the names of temporary files: `.NAME` + suffix.
    pub(super) suffix: String,
    pub(super) files: BTreeMap<String, Mark>,
}

/// The record.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Manifest {
    grashof: u32,
    pub(super) files: BTreeMap<String, Entry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) writing: Option<Writing>,
}

/// 64-bit FNV-1a (Fowler, Noll, Vo), which every version of the program computes alike.
struct Sum(u64);

impl Sum {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3));
    }

    fn text(&self) -> String {
        format!("{:016x}", self.0)
    }
}

impl Mark {
    /// That of a content.
    ///
    /// # Errors
    /// The system's reason why it cannot be read.
    pub(super) fn of(content: &Content) -> io::Result<Self> {
        let (mut sum, mut size) = (Sum::new(), 0);
        content.parts(&mut |part| {
            sum.add(part);
            size += part.len() as u64;
            Ok(())
        })?;
        Ok(Self { size, sum: sum.text() })
    }

    /// Whether there is a plain file at this path, no link, whose content has this mark.
    pub(super) fn fits(&self, path: &Path) -> bool {
        let same = || -> io::Result<bool> {
            let known = fs::symlink_metadata(path)?;
            if !known.is_file() || known.len() != self.size {
                return Ok(false);
            }
            let (mut file, mut sum, mut part) = (File::open(path)?, Sum::new(), [0; 1 << 16]);
            loop {
                match file.read(&mut part)? {
                    0 => return Ok(sum.text() == self.sum),
                    n => sum.add(&part[..n]),
                }
            }
        };
        same().unwrap_or(false)
    }
}

/// A number for a set of files, from their names and marks.
pub(super) fn set_of(files: &BTreeMap<String, Mark>) -> String {
    let mut sum = Sum::new();
    for (name, mark) in files {
        sum.add(format!("{name}\0{}\0{}\0", mark.size, mark.sum).as_bytes());
    }
    sum.text()
}

/// A name with no way out of its directory, and none that is hidden: no result has one.
pub(super) fn is_plain(name: &str) -> bool {
    !name.is_empty() && !name.contains(['/', '\\', '\0']) && !name.starts_with('.')
}

/// An end of temporary names with no way out of the directory.
fn is_suffix(text: &str) -> bool {
    text.starts_with(".new-") && text.bytes().all(|c| c.is_ascii_alphanumeric() || b".-".contains(&c))
}

impl Manifest {
    /// The record of a directory; empty if there is none that can be used.
    pub(super) fn read(directory: &Path) -> Self {
        let empty = Self { grashof: VERSION, ..Self::default() };
        let path = directory.join(NAME);
        if !fs::symlink_metadata(&path).is_ok_and(|known| known.is_file() && known.len() <= MOST) {
            return empty;
        }
        let Ok(bytes) = fs::read(&path) else { return empty };
        let Ok(mut read) = serde_json::from_slice::<Self>(&bytes) else { return empty };
        if read.grashof != VERSION {
            return empty;
        }
        // a name that leads out of the directory is nothing that was written here
        read.files.retain(|name, _| is_plain(name));
        read.writing = read.writing.filter(|writing| is_suffix(&writing.suffix) && writing.files.keys().all(|name| is_plain(name)));
        read
    }

    /// Puts the record into its directory in the place of the one before, which is at no instant torn.
    pub(super) fn store(&self, directory: &Path) -> Result<(), WriteError> {
        let path = directory.join(NAME);
        let new = directory.join(format!("{NAME}.new"));
        let write = || -> io::Result<()> {
            let text = serde_json::to_string_pretty(self).map_err(io::Error::other)?;
            // one that a killed run has left
            let _ = fs::remove_file(&new);
            put(&new, &Content::Bytes(text.into_bytes()), &|| false)?;
            fs::rename(&new, &path)
        };
        write().map_err(|cause| {
            let _ = fs::remove_file(&new);
            WriteError { path: path.clone(), cause }
        })
    }

    /// Makes the record what it was before a set that could not be written; there may be no room for it, which changes nothing.
    pub(super) fn put_back(&self, directory: &Path) {
        if self.files.is_empty() {
            let _ = fs::remove_file(directory.join(NAME));
        } else {
            let _ = self.store(directory);
        }
    }

    /// Whether the file of this name is one that a run is recorded to have written.
    pub(super) fn knows(&self, directory: &Path, name: &str) -> bool {
        self.files.get(name).is_some_and(|entry| entry.mark.fits(&directory.join(name)))
    }
}

/// Writes a file that must not be there yet, through to the disc; links are not followed. `stop` is asked on the way.
///
/// # Errors
/// The system's reason; [`io::ErrorKind::Interrupted`] if it was to stop.
pub(super) fn put(path: &Path, content: &Content, stop: &dyn Fn() -> bool) -> io::Result<()> {
    let mut file = File::create_new(path)?;
    content.parts(&mut |part| {
        if stop() {
            return Err(io::ErrorKind::Interrupted.into());
        }
        file.write_all(part)
    })?;
    file.sync_all()
}
