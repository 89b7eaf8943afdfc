//! Files of a study, whole or not at all.
//!
//! Everything is made in memory first. Then each file is written under a temporary name in the target directory, and only when
//! all of them lie there are they renamed, which within one directory is atomic for each. A failure undoes what was done.

use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The files of one study, not yet on the disc.
#[derive(Clone, Debug, Default)]
pub struct Staging {
    files: Vec<(String, Vec<u8>)>,
}

/// A file or directory that could not be written, and why.
#[derive(Debug)]
pub struct WriteError {
    /// What could not be written.
    pub path: PathBuf,
    /// The system's reason.
    pub cause: io::Error,
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

impl Staging {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file; one of the same name is replaced.
    pub fn add(&mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        let name = name.into();
        self.files.retain(|(known, _)| *known != name);
        self.files.push((name, bytes.into()));
    }

    /// The names so far, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|(name, _)| name.as_str())
    }

    /// Writes all files into `directory` (made if missing) and removes what an earlier run of `study` left and this one did not
    /// make; `studies` are the names of all studies of the model, whose files are never touched.
    ///
    /// # Errors
    /// The path and the system's reason. The directory is then as it was before.
    pub fn commit(&self, directory: &Path, study: &str, studies: &[String]) -> Result<Vec<PathBuf>, WriteError> {
        if let Some(name) = self.names().find(|name| !is_plain(name)) {
            let cause = io::Error::new(io::ErrorKind::InvalidInput, "not a plain file name");
            return Err(WriteError { path: directory.join(name), cause });
        }
        let mut undo = Undo::default();
        match self.write(directory, &mut undo) {
            Ok(paths) => {
                undo.backups.iter().for_each(|(backup, _)| discard(backup));
                remove_stale(directory, study, studies, |name| self.names().any(|made| made == name));
                Ok(paths)
            }
            Err(error) => {
                undo.roll_back();
                Err(error)
            }
        }
    }

    fn write(&self, directory: &Path, undo: &mut Undo) -> Result<Vec<PathBuf>, WriteError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |cause| WriteError { path, cause }
        };
        let missing = directory.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists());
        undo.directories = missing.map(Path::to_owned).collect();
        if let Some(file) = directory.ancestors().find(|path| path.is_file()) {
            return Err(failed(file)(io::Error::new(io::ErrorKind::NotADirectory, "a file is in the way of the directory")));
        }
        fs::create_dir_all(directory).map_err(failed(directory))?;

        // The process number keeps two runs in one directory apart.
        let temporary = |name: &str, purpose: &str| directory.join(format!(".{name}.{purpose}-{}", std::process::id()));
        for (name, bytes) in &self.files {
            let path = directory.join(name);
            if path.is_dir() {
                return Err(failed(&path)(io::Error::new(io::ErrorKind::IsADirectory, "a directory of this name is in the way")));
            }
            let new = temporary(name, "new");
            undo.temporaries.push(new.clone());
            fs::write(&new, bytes).map_err(failed(&path))?;
        }
        let mut paths = Vec::with_capacity(self.files.len());
        for (name, _) in &self.files {
            let path = directory.join(name);
            if path.exists() {
                let old = temporary(name, "old");
                fs::rename(&path, &old).map_err(failed(&path))?;
                undo.backups.push((old, path.clone()));
            }
            fs::rename(temporary(name, "new"), &path).map_err(failed(&path))?;
            undo.written.push(path.clone());
            paths.push(path);
        }
        Ok(paths)
    }
}

/// What has been done so far, to be undone if the rest fails.
#[derive(Default)]
struct Undo {
    /// Directories that did not exist, the innermost first.
    directories: Vec<PathBuf>,
    temporaries: Vec<PathBuf>,
    written: Vec<PathBuf>,
    /// (where the earlier file lies now, where it belongs)
    backups: Vec<(PathBuf, PathBuf)>,
}

impl Undo {
    fn roll_back(&self) {
        // The first error is the one the user needs; a second one while undoing could not be helped anyway.
        self.written.iter().chain(&self.temporaries).for_each(|path| discard(path));
        for (backup, path) in &self.backups {
            let _ = fs::rename(backup, path);
        }
        for directory in &self.directories {
            let _ = fs::remove_dir(directory);
        }
    }
}

fn discard(path: &Path) {
    let _ = fs::remove_file(path);
}

/// A name with no way out of its directory: study and plot names come from the user's file.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && !name.contains(['/', '\\', '\0']) && name != "." && name != ".."
}

/// Removes files of `study` from an earlier run that were not `made` now. Failing to is no failure of the run: the new files are
/// all there.
fn remove_stale(directory: &Path, study: &str, studies: &[String], made: impl Fn(&str) -> bool) {
    for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some(name) = name.to_str() else { continue };
        if is_of(name, study, studies) && !made(name) && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            discard(&entry.path());
        }
    }
}

/// Whether the file `name` is one that `study` makes, and none that another of `studies` could have made.
///
/// Names may nest: `one-turn-unloaded.csv` belongs to the study `one-turn-unloaded`, not to `one-turn`. So a file is left alone
/// as soon as any longer study name fits its beginning.
fn is_of(name: &str, study: &str, studies: &[String]) -> bool {
    let rest_after = |study: &str| name.strip_prefix(study).filter(|rest| rest.starts_with(['.', '-']));
    let Some(rest) = rest_after(study) else { return false };
    if studies.iter().any(|other| other.len() > study.len() && rest_after(other).is_some()) {
        return false;
    }
    let Some(part) = rest.strip_prefix('-') else { return matches!(rest, ".csv" | ".json" | ".mat") };
    // of a sweep from the command line, which has a name of its own
    if part.starts_with("over-") {
        return false;
    }
    let run = |number: &str| number.len() >= 3 && number.bytes().all(|byte| byte.is_ascii_digit());
    let plot = |name: &str| !name.is_empty();
    let matrix = |name: &str| matches!(name, "A" | "B" | "C" | "D" | "mass" | "damping" | "stiffness");
    let of_run = |name: &str| name.split_once('-').is_some_and(|(number, name)| run(number) && matrix(name));
    part.strip_suffix(".csv").is_some_and(|name| run(name) || matrix(name) || of_run(name))
        || part.strip_suffix(".mat").is_some_and(run)
        || [".svg", ".png"].iter().any(|end| part.strip_suffix(end).is_some_and(plot))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fresh directory below the system's temporary one, removed at the end.
    struct Scratch(PathBuf);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("grashof-{name}-{}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        fn names(&self) -> Vec<String> {
            let mut names: Vec<_> = fs::read_dir(&self.0).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
            names.sort();
            names
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    fn staged(names: &[&str]) -> Staging {
        let mut staging = Staging::new();
        names.iter().for_each(|name| staging.add(*name, "new"));
        staging
    }

    #[test]
    fn a_failed_write_leaves_everything_as_it_was() {
        let scratch = Scratch::new("atomic");
        fs::write(scratch.0.join("a.csv"), "old").unwrap();
        fs::create_dir(scratch.0.join("a.json")).unwrap();
        let error = staged(&["a.csv", "a-x.svg", "a.json"]).commit(&scratch.0, "a", &["a".into()]).unwrap_err();
        assert_eq!(error.path, scratch.0.join("a.json"));
        assert!(error.to_string().contains("in the way"));
        assert_eq!(scratch.names(), ["a.csv", "a.json"]);
        assert_eq!(fs::read_to_string(scratch.0.join("a.csv")).unwrap(), "old");
    }

    #[test]
    fn a_roll_back_restores_files_and_removes_new_directories() {
        let scratch = Scratch::new("rollback");
        let (inner, old, path) = (scratch.0.join("out"), scratch.0.join(".old"), scratch.0.join("a.csv"));
        fs::create_dir(&inner).unwrap();
        fs::write(&old, "old").unwrap();
        fs::write(&path, "new").unwrap();
        let undo = Undo { directories: vec![inner], temporaries: vec![], written: vec![path.clone()], backups: vec![(old, path.clone())] };
        undo.roll_back();
        assert_eq!(scratch.names(), ["a.csv"]);
        assert_eq!(fs::read_to_string(path).unwrap(), "old");
    }

    #[test]
    fn a_path_through_a_file_is_an_error_and_makes_nothing() {
        let scratch = Scratch::new("through");
        fs::write(scratch.0.join("file"), "").unwrap();
        assert!(staged(&["a.csv"]).commit(&scratch.0.join("file/below"), "a", &[]).is_err());
        assert!(staged(&["../a.csv"]).commit(&scratch.0.join("out"), "a", &[]).is_err());
        assert_eq!(scratch.names(), ["file"]);
    }

    #[test]
    fn stale_files_of_this_study_go_and_no_others() {
        let scratch = Scratch::new("stale");
        let out = scratch.0.join("out/deep");
        let kept = [
            "one-turn-unloaded.csv",
            "one-turn-unloaded-001.csv",
            "one-turn-unloaded-angles.svg",
            "one-turn-notes.txt",
            "one-turn.yaml",
            "one-turn-over-l3.csv",
            "one-turn-over-l3-007.csv",
            "one-turn-over-l3-swing.svg",
        ];
        let stale =
            ["one-turn.csv", "one-turn-007.csv", "one-turn-007-A.csv", "one-turn-007.mat", "one-turn-oldplot.svg", "one-turn-oldplot.png"];
        fs::create_dir_all(&out).unwrap();
        kept.iter().chain(&stale).for_each(|name| fs::write(out.join(name), "old").unwrap());
        let studies = ["one-turn".to_owned(), "one-turn-unloaded".to_owned()];
        staged(&["one-turn.json", "one-turn-angles.svg"]).commit(&out, "one-turn", &studies).unwrap();
        let mut names: Vec<_> = fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        let mut expected = [kept.as_slice(), &["one-turn.json", "one-turn-angles.svg"]].concat();
        expected.sort();
        assert_eq!(names, expected);
    }

    #[test]
    fn a_second_run_replaces_the_first() {
        let scratch = Scratch::new("again");
        fs::write(scratch.0.join("a.csv"), "old").unwrap();
        let paths = staged(&["a.csv"]).commit(&scratch.0, "a", &["a".into()]).unwrap();
        assert_eq!(fs::read_to_string(&paths[0]).unwrap(), "new");
        assert_eq!(scratch.names(), ["a.csv"]);
    }
}
