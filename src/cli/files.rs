//! Reading the model file and naming the place of its results.

use super::interrupt::{interrupted, uncut};
use super::terminal::{print_error, print_failure, print_report};
use super::{Common, code, print_note, print_out};
use grashof::api::{beside, explained, why};
use grashof::model::{Document, Report, Selection};
use grashof::output::{Staging, WriteError};
use grashof::results::Failure;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// Largest file that is read at all; the reader itself refuses above 8 MiB and says so.
const MOST: u64 = 16 << 20;

/// Reads a model file, or stdin for `-`; what is wrong has been printed.
pub(super) fn document(model: &str, common: &Common) -> Option<Document> {
    let bytes = match bytes(model, MOST) {
        Ok(bytes) => bytes,
        Err(error) => {
            unreadable(model, &error, "a model file", "check the path, or write a new model with `grashof new four-bar`");
            return None;
        }
    };
    let name = if model == "-" { "<stdin>" } else { model };
    match Document::with_files(&bytes, name, &|included| beside(model, included)) {
        Ok(document) => Some(document),
        Err(report) => {
            print(&report, common);
            None
        }
    }
}

/// Says why a file cannot be read, on stderr; `what` it was to be, and the remedy if it does not exist.
pub(super) fn unreadable(file: &str, error: &std::io::Error, what: &str, missing: &str) {
    let help = match error.kind() {
        std::io::ErrorKind::NotFound => missing.to_string(),
        _ if Path::new(file).is_dir() => "name a file in it".to_string(),
        _ => format!("name {what} that can be read, or `-` for stdin"),
    };
    print_error(&format!("cannot read `{file}`: {}", why(error)), &help);
}

/// A model file without faults, with the selection that `--set` and `--variant` make and what there is to say of it, which
/// has been printed.
pub(super) fn sound(model: &str, common: &Common) -> Option<(Document, Selection<'static>, Report)> {
    sound_for(model, common, &[])
}

/// The same where studies are named: changes are for these alone, and may not suit others.
pub(super) fn sound_for(model: &str, common: &Common, studies: &[String]) -> Option<(Document, Selection<'static>, Report)> {
    let document = document(model, common)?;
    let selection = selection(common, None)?;
    let report = document.check_studies(&selection, if common.changes().is_some() { studies } else { &[] });
    print(&report, common);
    (!report.failed()).then_some((document, selection, report))
}

/// Writes a file that must not be there yet, unless `--force` says so, whole or not at all; a failure was reported.
pub(super) fn write_new(file: &Path, bytes: &[u8], common: &Common) -> bool {
    let new = unfinished(file);
    let whole = || {
        let mut out = std::fs::File::create_new(&new)?;
        out.write_all(bytes)?;
        name(&new, file, common)
    };
    // never over somebody's work
    let written = if file.exists() && !common.force { Err(ErrorKind::AlreadyExists.into()) } else { uncut(whole) };
    let Err(error) = written else { return true };
    let _ = std::fs::remove_file(&new);
    unwritten(file, &error);
    false
}

/// Prints a text, or writes it to the file of `--output`, `-` being stdout; a failure was reported.
pub(super) fn print_or_write(text: &str, common: &Common) -> u8 {
    match common.output.as_deref().filter(|file| file.as_os_str() != "-") {
        None => print_out(text),
        Some(file) if !write_new(file, format!("{text}\n").as_bytes(), common) => return code::INPUT,
        Some(_) => {}
    }
    code::DONE
}

/// Gives a whole file its name, which must be free unless `--force` says otherwise.
fn name(whole: &Path, file: &Path, common: &Common) -> std::io::Result<()> {
    if common.force {
        return std::fs::rename(whole, file);
    }
    match std::fs::hard_link(whole, file) {
        Ok(()) => std::fs::remove_file(whole),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(error),
        // a file system without links
        Err(_) => std::fs::rename(whole, file),
    }
}

/// A name in the directory of a file for what is not whole yet.
pub(super) fn unfinished(file: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(file.file_name().unwrap_or_default());
    name.push(format!(".new-{}", std::process::id()));
    file.with_file_name(name)
}

/// Looks whether a file can be written: that it is not there yet, unless `--force` says so, and that its directory is; what is wrong was
/// reported.
pub(super) fn may_write(file: &Path, common: &Common) -> Result<(), u8> {
    let directory = file.parent().filter(|directory| !directory.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let error = if file.exists() && !common.force {
        std::io::Error::from(ErrorKind::AlreadyExists)
    } else if !directory.is_dir() {
        std::io::Error::from(ErrorKind::NotFound)
    } else {
        return Ok(());
    };
    unwritten(file, &error);
    Err(code::INPUT)
}

/// Gives a whole file its name, as [`write_new`] does; a failure was reported.
pub(super) fn place(whole: &Path, file: &Path, common: &Common) -> Result<(), u8> {
    name(whole, file, common).map_err(|error| {
        unwritten(file, &error);
        code::INPUT
    })
}

fn unwritten(file: &Path, error: &std::io::Error) {
    let help = match error.kind() {
        ErrorKind::AlreadyExists => "name another file, remove this one, or replace it with `--force`",
        _ => "name a file in a directory that can be written to",
    };
    print_error(&format!("cannot write `{}`: {}", file.display(), why(error)), help);
}

/// Looks whether results of these names can be written, and mends what a killed run has left; what is wrong was reported.
pub(super) fn prepare(directory: &Path, names: &[String], common: &Common) -> Result<(), u8> {
    let notes = grashof::output::prepare(directory, names, common.force).map_err(|error| unwritable(&error))?;
    print_mended(&notes, common);
    Ok(())
}

/// Writes the files of a study, unless it is interrupted; what is wrong was reported.
pub(super) fn commit(staging: &Staging, directory: &Path, stem: &str, common: &Common) -> Result<(), u8> {
    // what was interrupted before keeps what it has come to
    let keeps = interrupted();
    let written = uncut(|| staging.commit_unless(directory, stem, common.force, &|| !keeps && interrupted()));
    let written =
        written.map_err(|error| if error.cause.kind() == ErrorKind::Interrupted { code::INTERRUPTED } else { unwritable(&error) })?;
    print_mended(&written.notes, common);
    if common.verbose {
        written.paths.iter().for_each(|path| print_note(&format!("wrote {}", path.display())));
    }
    Ok(())
}

/// Reports what could not be written.
pub(super) fn unwritable(error: &WriteError) -> u8 {
    print_error(&error.to_string(), error.help());
    code::INPUT
}

fn print_mended(notes: &[String], common: &Common) {
    if !common.quiet {
        notes.iter().for_each(|note| print_note(&format!("note: {note}")));
    }
}

/// Says in one line that included files hold more than the model uses.
pub(super) fn print_notes(document: &Document, common: &Common) {
    let count = document.notes().len();
    if count > 0 && !common.quiet {
        let (word, them) = if count == 1 { ("remark", "it") } else { ("remarks", "them") };
        print_note(&format!("note: {count} {word} on what the model does not use of its included files; `grashof check` shows {them}"));
    }
}

/// The bytes of a file, or of stdin for `-`, up to `most`.
pub(super) fn bytes(model: &str, most: u64) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if model == "-" {
        std::io::stdin().lock().take(most).read_to_end(&mut bytes)?;
    } else {
        if Path::new(model).is_dir() {
            return Err(std::io::Error::new(std::io::ErrorKind::IsADirectory, "it is a directory"));
        }
        std::fs::File::open(model)?.take(most).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// Prints diagnostics on stderr; warnings are left out when quiet.
pub(super) fn print(report: &Report, common: &Common) {
    if report.failed() || !common.quiet {
        print_report(report, common.colored());
    }
}

/// The selection that `--set` and `--variant` make; none if an assignment has no `=`, which has been printed.
pub(super) fn selection<'a>(common: &Common, study: Option<&'a str>) -> Option<Selection<'a>> {
    let mut sets = Vec::new();
    for text in &common.set {
        match text.split_once('=') {
            Some((name, value)) => sets.push((name.trim().to_string(), value.trim().to_string())),
            None => {
                print_error(&format!("`--set {text}` has no `=`"), "write `--set NAME=VALUE`, as `--set l3=0.6` or `--set \"l3=60 cm\"`");
                return None;
            }
        }
    }
    Some(Selection { study, variants: common.variant.clone(), sets, ..Selection::default() })
}

/// Where results go; none if the name of the model makes no directory, which was reported.
pub(super) fn directory(model: &str, common: &Common) -> Option<PathBuf> {
    if let Some(directory) = &common.output {
        return Some(directory.clone());
    }
    let stem = if model == "-" { "stdin".into() } else { Path::new(model).file_stem().unwrap_or_default().to_os_string() };
    // `...yaml` is `..` without its extension, which leads out of `results`
    if ["", ".", ".."].iter().any(|name| stem == *name) {
        print_error(
            &format!("the name of `{model}` without its extension names no directory for results"),
            "say where they go with `-o DIR`",
        );
        return None;
    }
    Some(Path::new("results").join(stem))
}

/// Prints why something did not begin, at its place, and gives the exit code; `study` is empty outside of studies.
pub(super) fn explain(document: &Document, failure: &Failure, study: &str, common: &Common) -> u8 {
    explain_beside(document, failure, study, study, common)
}

/// [`explain`] for a failure of a study `of` that keeps another one from beginning, of which it takes a scalar.
pub(super) fn explain_beside(document: &Document, failure: &Failure, study: &str, of: &str, common: &Common) -> u8 {
    print_failure(study, &explained(document, of, failure), common.colored());
    match failure {
        Failure::Model(_) | Failure::Study { .. } => code::INPUT,
        Failure::Unsolved(_) | Failure::Undefined(_) | Failure::Numerical { .. } => code::NUMERICAL,
    }
}
