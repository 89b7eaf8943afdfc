//! Finished runs of a sweep, kept beside its results until these are written: after an interrupt, a crash or a kill the same
//! command goes on from there.
//!
//! `<study>.partial` holds 16 bytes, [`MAGIC`] and the fingerprint of all that decides the results, and behind them one record a
//! run: its length, its checksum, and the run with its place in the sweep, by the postcard format, in which numbers keep their
//! bits. A record is appended by one write. So the file can end in a torn record at any time, which is cut off when it is read; a
//! file with another fingerprint is not used. Runs that never began are not kept: they cost nothing to try again. A file of this
//! name that does not begin so, or that is a link, is somebody's own and is left alone; one that another run has locked is its.
//!
//! A shard keeps its runs for good, in a file of its own, which ends in a record of no bytes when all its runs have been tried:
//! those that it does not hold then never began.

use grashof::model::Model;
use grashof::results::{Failure, Unsolved};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::solve::Solved;
use grashof::studies::sweep::Run;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Begins the file.
const MAGIC: &[u8; 8] = b"grashof1";
/// Length and checksum before each run.
const HEAD: usize = 16;

/// The file of finished runs.
pub(super) struct Kept {
    path: PathBuf,
    fingerprint: u64,
    /// Open from the first run on that is kept; none if it cannot be written.
    file: Mutex<Place>,
    count: AtomicUsize,
    note: Option<String>,
}

enum Place {
    /// Not written yet.
    New,
    /// Open; what is in it is of another sweep and goes when the first run is kept.
    Stale(File),
    /// Open at its end.
    Open(File),
    /// It cannot be written; the sweep goes on without it.
    Closed,
}

/// A run as it is written.
#[derive(Serialize, Deserialize)]
struct Record<R, S> {
    index: usize,
    at: Vec<f64>,
    solved: S,
    result: R,
}

type Written<'r> = Record<Result<&'r Outcome, &'r Unsolved>, &'r Option<Solved>>;
type Read = Record<Result<Outcome, Unsolved>, Option<Solved>>;

impl Kept {
    /// What earlier tries of the same sweep of `count` runs have left, and the file for further runs.
    ///
    /// With `force` a plain file of this name that holds no runs is replaced.
    pub(super) fn open(directory: &Path, stem: &str, model: &Model, count: usize, force: bool) -> (Self, Vec<Option<Run>>) {
        let path = directory.join(format!("{stem}.partial"));
        let fingerprint = fingerprint(model);
        let mut known: Vec<Option<Run>> = Vec::new();
        known.resize_with(count, || None);
        let (file, why) = match there(&path) {
            Ok(None) => (Place::New, None),
            Ok(Some((file, bytes))) => match read(&bytes, fingerprint, &mut known) {
                Some(good) if file.set_len(good as u64).is_ok() => (Place::Open(file), None),
                Some(_) => (Place::Closed, Some("cannot be written: finished runs are not kept")),
                None if force || is_ours(&bytes) => {
                    (Place::Stale(file), Some("is of another model, study or version, or broken: it is not used"))
                }
                None => (Place::Closed, Some("holds no finished runs: it is left alone, and finished runs are not kept")),
            },
            Err(why) => (Place::Closed, Some(why)),
        };
        let note = why.map(|why| format!("note: {} {why}", path.display()));
        let there = AtomicUsize::new(known.iter().flatten().count());
        (Self { path, fingerprint, file: Mutex::new(file), count: there, note }, known)
    }

    /// Why a file that is there is not used.
    pub(super) fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// How many runs of all are kept, in a sentence; none if there are none.
    pub(super) fn in_words(&self, all: usize) -> Option<String> {
        let kept = self.count.load(Ordering::Relaxed);
        (kept > 0).then(|| format!("kept: {kept} of {all} runs, from which the same command goes on"))
    }

    /// Keeps a finished run.
    pub(super) fn add(&self, index: usize, run: &Run) {
        let result = match &run.result {
            Ok(outcome) => Ok(&**outcome),
            Err(Failure::Unsolved(why)) => Err(why),
            Err(_) => return,
        };
        let Ok(bytes) = postcard::to_stdvec(&Written { index, at: run.at.clone(), solved: &run.solved, result }) else { return };
        let mut record = (bytes.len() as u64).to_le_bytes().to_vec();
        record.extend(checksum(self.fingerprint, &bytes).to_le_bytes());
        record.extend(bytes);
        let mut place = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        *place = match std::mem::replace(&mut *place, Place::Closed) {
            Place::New => self.created().and_then(|file| self.begun(file)).map_or(Place::Closed, Place::Open),
            Place::Stale(file) => self.begun(file).map_or(Place::Closed, Place::Open),
            other => other,
        };
        if let Place::Open(file) = &mut *place {
            match file.write_all(&record) {
                Ok(()) => _ = self.count.fetch_add(1, Ordering::Relaxed),
                Err(_) => *place = Place::Closed,
            }
        }
    }

    /// A new file; none if something has come to lie there since.
    fn created(&self) -> Option<File> {
        fs::create_dir_all(self.path.parent()?).ok()?;
        let file = File::options().append(true).create_new(true).open(&self.path).ok()?;
        locked(&file).then_some(file)
    }

    /// The file with its head and nothing else.
    fn begun(&self, mut file: File) -> Option<File> {
        file.set_len(0).ok()?;
        file.write_all(&[*MAGIC, self.fingerprint.to_le_bytes()].concat()).ok()?;
        Some(file)
    }

    /// Says behind the runs of a shard that all of them were tried; false if they could not be kept.
    pub(super) fn end(&self) -> bool {
        let mut place = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        *place = match std::mem::replace(&mut *place, Place::Closed) {
            // none of them began
            Place::New => self.created().and_then(|file| self.begun(file)).map_or(Place::Closed, Place::Open),
            Place::Stale(file) => self.begun(file).map_or(Place::Closed, Place::Open),
            other => other,
        };
        if let Place::Open(file) = &mut *place { file.write_all(&end(self.fingerprint)).is_ok() } else { false }
    }

    /// Where the runs are kept.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Removes the file: its runs stand in the results. The directory goes too if nothing else is in it.
    pub(super) fn remove(self) {
        let place = self.file.into_inner().unwrap_or_else(PoisonError::into_inner);
        let ours = matches!(place, Place::Open(_) | Place::Stale(_));
        if ours
            && fs::remove_file(&self.path).is_ok()
            && let Some(directory) = self.path.parent()
        {
            let _ = fs::remove_dir(directory);
        }
    }
}

/// Puts the runs that a shard has kept into `known`; whether all its runs were tried.
///
/// # Errors
/// Why the file is not used.
pub(super) fn gather(path: &Path, model: &Model, known: &mut [Option<Run>]) -> Result<bool, &'static str> {
    let fingerprint = fingerprint(model);
    let bytes = fs::read(path).map_err(|_| "cannot be read")?;
    let good = read(&bytes, fingerprint, known).ok_or("is of another model, study or version, or broken")?;
    Ok(bytes[good..] == end(fingerprint))
}

/// The record behind all runs of a shard.
fn end(fingerprint: u64) -> Vec<u8> {
    [0_u64.to_le_bytes(), checksum(fingerprint, &[]).to_le_bytes()].concat()
}

/// Puts the runs of a file into `known`, and gives the number of its bytes that are sound; none if it is not of this sweep.
fn read(bytes: &[u8], fingerprint: u64, known: &mut [Option<Run>]) -> Option<usize> {
    let head = [*MAGIC, fingerprint.to_le_bytes()].concat();
    let mut rest = bytes.strip_prefix(&head[..])?;
    while let Some((record, after)) = next(rest, fingerprint) {
        let Some(slot) = known.get_mut(record.index) else { break };
        *slot = Some(Run { at: record.at, solved: record.solved, result: record.result.map(Box::new).map_err(Failure::Unsolved) });
        rest = after;
    }
    Some(bytes.len() - rest.len())
}

/// The first record of some bytes and what follows it; none if it is torn or damaged.
fn next(bytes: &[u8], fingerprint: u64) -> Option<(Read, &[u8])> {
    let number = |at: usize| Some(u64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?));
    let length = usize::try_from(number(0)?).ok()?;
    let payload = bytes.get(HEAD..HEAD.checked_add(length)?)?;
    if checksum(fingerprint, payload) != number(8)? {
        return None;
    }
    Some((postcard::from_bytes(payload).ok()?, &bytes[HEAD + length..]))
}

/// The file that is there, open at its end and locked, with its bytes; none if there is none.
///
/// # Errors
/// Why it is not used.
fn there(path: &Path) -> Result<Option<(File, Vec<u8>)>, &'static str> {
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        // a link may lead out of the directory, and a pipe has no end
        Ok(known) if !known.is_file() => return Err("is no plain file: it is left alone, and finished runs are not kept"),
        _ => {}
    }
    let mut file = File::options().read(true).append(true).open(path).map_err(|_| "cannot be opened: finished runs are not kept")?;
    if !locked(&file) {
        return Err("is in use by another run: finished runs are not kept");
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(|_| "cannot be read: finished runs are not kept")?;
    Ok(Some((file, bytes)))
}

/// Whether no other run has the file, as far as the file system knows.
fn locked(file: &File) -> bool {
    !matches!(file.try_lock(), Err(TryLockError::WouldBlock))
}

/// Whether some bytes begin as a file of finished runs does, however short they are.
fn is_ours(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC[..bytes.len().min(MAGIC.len())])
}

fn checksum(fingerprint: u64, bytes: &[u8]) -> u64 {
    shortened(Sha256::new().chain_update(fingerprint.to_le_bytes()).chain_update(bytes))
}

/// The first 64 bits of a hash.
fn shortened(hash: Sha256) -> u64 {
    let hash = hash.finalize();
    hash[..8].iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte))
}

/// A number for all that decides the results: the program, and the model with its study as they were read, with variants,
/// settings and scalars of other studies in them.
fn fingerprint(model: &Model) -> u64 {
    struct Text(Sha256);
    impl std::fmt::Write for Text {
        fn write_str(&mut self, text: &str) -> std::fmt::Result {
            self.0.update(text.as_bytes());
            Ok(())
        }
    }
    let mut text = Text(Sha256::new());
    // by its bytes, so that copies on several machines are one
    let program = std::env::current_exe().and_then(fs::read).ok().map(|bytes| shortened(Sha256::new().chain_update(bytes)));
    let _ = write!(text, "{} {program:?} ", env!("CARGO_PKG_VERSION"));
    let _ = model.write_content(&mut text);
    shortened(text.0)
}
