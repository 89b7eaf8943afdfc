//! Files of a study, written as one set.
//!
//! Everything is made first, in memory or, rows of a long motion, in files without names. Then each file is written under a temporary name in the target directory, and when all of
//! them lie there, each is renamed over the one before, so that under its name stands at every instant the old file or the new
//! one. The record of the directory ([`super::manifest`]) names the set before its first byte is written: a run that is killed on
//! the way leaves an old set and temporary files, or all that is needed to finish the new set, and the next run in the directory
//! clears the one or does the other. A lock on the directory lets only one run write there at a time; the system drops it when a
//! run dies. Where a file system has no locks, runs at the same time need directories of their own.

use super::content::{Content, Spooled};
use super::manifest::{Entry, Manifest, Mark, Writing, is_plain, put, set_of};
use super::write_error::WriteError;
use crate::par;
use std::collections::{BTreeMap, HashSet};
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Files that are written at a time.
const WRITERS: usize = 8;

/// The files of one study, not yet on the disc.
#[derive(Clone, Debug, Default)]
pub struct Staging {
    files: Vec<(String, Content)>,
    /// Names of the files.
    names: HashSet<String>,
}

/// What has been written.
#[derive(Clone, Debug, Default)]
pub struct Written {
    /// All files, in order.
    pub paths: Vec<PathBuf>,
    /// What was mended of earlier runs, in sentences.
    pub notes: Vec<String>,
}

impl Staging {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file; one of the same name is replaced.
    pub fn add(&mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        self.put(name.into(), Content::Bytes(bytes.into()));
    }

    /// Adds a file whose bytes may be many; one of the same name is replaced.
    pub fn add_spooled(&mut self, name: impl Into<String>, bytes: Spooled) {
        self.put(name.into(), Content::Spooled(bytes));
    }

    fn put(&mut self, name: String, content: Content) {
        if !self.names.insert(name.clone()) {
            self.files.retain(|(known, _)| *known != name);
        }
        self.files.push((name, content));
    }

    /// Writes all files into `directory` (made if missing) and removes what an earlier run of `study` is recorded to have left and
    /// this one did not make. With `force` a file that no run is recorded to have written is replaced, too.
    ///
    /// # Errors
    /// The path and the system's reason. The directory is then as it was before; only if a rename fails halfway, which the checks
    /// before it leave to a failing disc, the record names what is missing, and the next run brings it.
    pub fn commit(&self, directory: &Path, study: &str, force: bool) -> Result<Written, WriteError> {
        self.commit_unless(directory, study, force, &|| false)
    }

    /// As [`Staging::commit`]; `stop` is asked until all files lie there under temporary names.
    ///
    /// # Errors
    /// As there; [`ErrorKind::Interrupted`] if it was to stop.
    pub fn commit_unless(
        &self,
        directory: &Path,
        study: &str,
        force: bool,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<Written, WriteError> {
        if let Some((name, _)) = self.files.iter().find(|(name, _)| !is_plain(name)) {
            return Err(failed(&directory.join(name), io::Error::new(ErrorKind::InvalidInput, "not a plain file name")));
        }
        let missing = directory.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists());
        let made: Vec<PathBuf> = missing.map(Path::to_owned).collect();
        let written = self.write(directory, study, force, stop);
        if written.is_err() {
            // the innermost first; one that is not empty stays
            made.iter().for_each(|path| _ = fs::remove_dir(path));
        }
        written
    }

    fn write(&self, directory: &Path, study: &str, force: bool, stop: &(dyn Fn() -> bool + Sync)) -> Result<Written, WriteError> {
        if let Some(file) = directory.ancestors().find(|path| path.is_file()) {
            return Err(failed(file, io::Error::new(ErrorKind::NotADirectory, "a file is in the way of the directory")));
        }
        fs::create_dir_all(directory).map_err(|cause| failed(directory, cause))?;
        let lock = lock(directory);
        let (mut manifest, notes) = recovered(directory)?;
        let mark = |(name, content): &(String, Content)| match Mark::of(content) {
            Ok(mark) => Ok((name.clone(), mark)),
            Err(cause) => Err(failed(&directory.join(name), cause)),
        };
        let marks: BTreeMap<String, Mark> = self.files.iter().map(mark).collect::<Result<_, _>>()?;
        for (name, _) in &self.files {
            may_replace(directory, name, marks.get(name), &manifest, force)?;
        }
        let before = manifest.clone();
        let set = set_of(&marks);
        let writing = Writing { study: study.into(), set, suffix: free_suffix(directory, marks.keys()), files: marks };
        manifest.writing = Some(writing.clone());
        manifest.store(directory)?;
        let written = |i: usize| put(&writing.temporary(directory, &self.files[i].0), &self.files[i].1, stop);
        // who writes waits for the disc
        let written = par::map(self.files.len(), WRITERS, written, || {});
        for ((name, _), written) in self.files.iter().zip(written) {
            if let Err(cause) = written {
                writing.clear(directory);
                // the first error is the one the user needs
                before.put_back(directory);
                return Err(failed(&directory.join(name), cause));
            }
        }
        manifest.finish(directory, &writing)?;
        if let Some(lock) = lock {
            let _ = lock.sync_all();
        }
        Ok(Written { paths: self.files.iter().map(|(name, _)| directory.join(name)).collect(), notes })
    }
}

/// Looks before a study is computed whether its files could be written, as far as their names are known, and mends what a run that
/// was killed has left in the directory: what was mended, in sentences.
///
/// # Errors
/// The first file that no run is recorded to have written and that `force` does not permit to replace.
pub fn prepare(directory: &Path, names: &[String], force: bool) -> Result<Vec<String>, WriteError> {
    if !directory.is_dir() {
        return Ok(Vec::new());
    }
    let _lock = lock(directory);
    let (manifest, notes) = recovered(directory)?;
    for name in names {
        may_replace(directory, name, None, &manifest, force)?;
    }
    Ok(notes)
}

fn failed(path: &Path, cause: io::Error) -> WriteError {
    WriteError { path: path.to_owned(), cause }
}

/// The directory, locked against other runs until this is dropped; none where there are no locks.
fn lock(directory: &Path) -> Option<File> {
    let file = File::open(directory).ok()?;
    file.lock().ok()?;
    Some(file)
}

/// Refuses to replace what no run has written: `new` is what would stand there.
fn may_replace(directory: &Path, name: &str, new: Option<&Mark>, manifest: &Manifest, force: bool) -> Result<(), WriteError> {
    let path = directory.join(name);
    let refused = |kind, why| Err(failed(&path, io::Error::new(kind, why)));
    match fs::symlink_metadata(&path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(failed(&path, error)),
        Ok(there) if there.is_dir() => refused(ErrorKind::IsADirectory, "a directory of this name is in the way"),
        Ok(_) if force || manifest.knows(directory, name) || new.is_some_and(|new| new.fits(&path)) => Ok(()),
        Ok(_) if manifest.files.contains_key(name) => {
            refused(ErrorKind::AlreadyExists, "the file there is not as an earlier run has written it")
        }
        Ok(_) => refused(ErrorKind::AlreadyExists, "there is a file that no earlier run is recorded to have written"),
    }
}

/// An end of temporary names that nothing in the directory has.
fn free_suffix<'a>(directory: &Path, names: impl Iterator<Item = &'a String> + Clone) -> String {
    let taken = |suffix: &String| names.clone().any(|name| fs::symlink_metadata(directory.join(format!(".{name}{suffix}"))).is_ok());
    let mut suffixes = (0..).map(|n| format!(".new-{}.{n}", std::process::id()));
    suffixes.find(|suffix| !taken(suffix)).unwrap_or_default()
}

/// The record of a directory, after what a killed run has left there is finished or cleared; the lock must be held.
fn recovered(directory: &Path) -> Result<(Manifest, Vec<String>), WriteError> {
    let mut manifest = Manifest::read(directory);
    let Some(writing) = manifest.writing.clone() else { return Ok((manifest, Vec::new())) };
    let study = &writing.study;
    let stands = |name: &String, mark: &Mark| mark.fits(&directory.join(name));
    let ready = |name: &String, mark: &Mark| {
        mark.fits(&writing.temporary(directory, name)) && may_replace(directory, name, Some(mark), &manifest, false).is_ok()
    };
    if writing.files.iter().all(|(name, mark)| stands(name, mark) || ready(name, mark)) {
        // a torn one beside a file that has not changed from the set before
        let torn =
            writing.files.iter().map(|(name, mark)| (writing.temporary(directory, name), mark)).filter(|(path, mark)| !mark.fits(path));
        torn.for_each(|(path, _)| discard(&path));
        manifest.finish(directory, &writing)?;
        return Ok((
            manifest,
            vec![format!("a run of `{study}` was killed while it wrote into {}: its files are complete now", directory.display())],
        ));
    }
    // before the first rename, or with temporary files that somebody has taken away
    for (name, mark) in writing.files.iter().filter(|(name, mark)| stands(name, mark)) {
        manifest.files.insert(name.clone(), Entry { study: study.clone(), set: writing.set.clone(), mark: mark.clone() });
    }
    writing.clear(directory);
    manifest.writing = None;
    manifest.store(directory)?;
    let state = if manifest.is_mixed(study) { "its files are of two runs: run it again" } else { "its files are those of the run before" };
    Ok((manifest, vec![format!("a run of `{study}` was killed while it wrote into {}: {state}", directory.display())]))
}

impl Writing {
    /// Where a file lies until it is renamed.
    fn temporary(&self, directory: &Path, name: &str) -> PathBuf {
        directory.join(format!(".{name}{}", self.suffix))
    }

    /// Removes the temporary files.
    fn clear(&self, directory: &Path) {
        self.files.keys().for_each(|name| discard(&self.temporary(directory, name)));
    }
}

impl Manifest {
    /// Renames the temporary files that are still there, removes what the set before had and this one has not, and records it.
    fn finish(&mut self, directory: &Path, writing: &Writing) -> Result<(), WriteError> {
        for name in writing.files.keys() {
            let (from, to) = (writing.temporary(directory, name), directory.join(name));
            match fs::rename(&from, &to) {
                // renamed by the run that was killed
                Err(error) if error.kind() == ErrorKind::NotFound && writing.files[name].fits(&to) => {}
                Err(error) => return Err(failed(&to, error)),
                Ok(()) => {}
            }
        }
        let stale = self.files.iter().filter(|(name, entry)| entry.study == writing.study && !writing.files.contains_key(*name));
        for name in stale.map(|(name, _)| name.clone()).collect::<Vec<_>>() {
            // what somebody has put there since is not ours
            if self.knows(directory, &name) {
                discard(&directory.join(&name));
            }
            self.files.remove(&name);
        }
        for (name, mark) in &writing.files {
            let entry = Entry { study: writing.study.clone(), set: writing.set.clone(), mark: mark.clone() };
            self.files.insert(name.clone(), entry);
        }
        self.writing = None;
        self.store(directory)
    }

    /// Whether files of a study are of different runs.
    fn is_mixed(&self, study: &str) -> bool {
        let mut sets = self.files.values().filter(|entry| entry.study == study).map(|entry| &entry.set);
        sets.next().is_some_and(|first| sets.any(|set| set != first))
    }
}

fn discard(path: &Path) {
    let _ = fs::remove_file(path);
}

#[cfg(test)]
#[path = "staging_tests.rs"]
mod tests;
