//! Reading the model file and naming the place of its results.

use super::{Common, code, tell};
use grashof::analysis::outcome::{Failure, Undefined, Unsolved};
use grashof::mechanism::BuildFault;
use grashof::model::{Document, Report, Selection};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// Largest file that is read at all; the reader itself refuses above 1 MiB and says so.
const MOST: u64 = 2 << 20;
/// Largest included file that is read at all; the reader itself refuses above 16 MiB and says so.
pub(super) const MOST_INCLUDED: u64 = 17 << 20;

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

/// A file that a model includes, by its path from the model file.
fn beside(model: &str, included: &str) -> Result<(String, Vec<u8>), String> {
    let path = Path::new(model).parent().unwrap_or(Path::new("")).join(included);
    let name = path.to_string_lossy().into_owned();
    match std::fs::File::open(&path) {
        Ok(_) if path.is_dir() => Err("it is a directory".into()),
        Ok(file) => {
            let mut bytes = Vec::new();
            file.take(MOST_INCLUDED).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
            Ok((name, bytes))
        }
        Err(error) => Err(why(&error)),
    }
}

/// Says why a file cannot be read, on stderr; `what` it was to be, and the remedy if it does not exist.
pub(super) fn unreadable(file: &str, error: &std::io::Error, what: &str, missing: &str) {
    tell(&format!("error: cannot read `{file}`: {}", why(error)));
    let help = match error.kind() {
        std::io::ErrorKind::NotFound => missing.to_string(),
        _ if Path::new(file).is_dir() => "name a file in it".to_string(),
        _ => format!("name {what} that can be read, or `-` for stdin"),
    };
    tell(&format!("  help: {help}"));
}

fn why(error: &std::io::Error) -> String {
    if error.kind() == std::io::ErrorKind::NotFound { "there is no such file".to_string() } else { error.to_string() }
}

/// A model file without faults, with the selection that `--set` and `--variant` make and what there is to say of it, which
/// has been printed.
pub(super) fn sound(model: &str, common: &Common) -> Option<(Document, Selection<'static>, Report)> {
    let document = document(model, common)?;
    let selection = selection(common, None)?;
    let report = document.check_all(&selection);
    print(&report, common);
    (!report.failed()).then_some((document, selection, report))
}

/// Writes a file that must not be there yet; a failure has been told.
pub(super) fn write_new(file: &Path, text: &str) -> bool {
    // never over somebody's work
    let Err(error) = std::fs::File::create_new(file).and_then(|mut f| f.write_all(text.as_bytes())) else { return true };
    let help = match error.kind() {
        std::io::ErrorKind::AlreadyExists => "name another file, or remove this one",
        _ => "name a file in a directory that can be written to",
    };
    tell(&format!("error: cannot write `{}`: {error}\n  help: {help}", file.display()));
    false
}

/// Says in one line that included files hold more than the model uses.
pub(super) fn tell_notes(document: &Document, common: &Common) {
    let count = document.notes().len();
    if count > 0 && !common.quiet {
        let (word, them) = if count == 1 { ("remark", "it") } else { ("remarks", "them") };
        tell(&format!("note: {count} {word} on what the model does not use of its included files; `grashof check` shows {them}"));
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
        let text = report.render(common.colored());
        if !text.is_empty() {
            tell(text.trim_end());
        }
    }
}

/// The selection that `--set` and `--variant` make; none if an assignment has no `=`, which has been printed.
pub(super) fn selection<'a>(common: &Common, study: Option<&'a str>) -> Option<Selection<'a>> {
    let mut sets = Vec::new();
    for text in &common.set {
        match text.split_once('=') {
            Some((name, value)) => sets.push((name.trim().to_string(), value.trim().to_string())),
            None => {
                tell(&format!(
                    "error: `--set {text}` has no `=`\n  help: write `--set NAME=VALUE`, as `--set l3=0.6` or `--set \"l3=60 cm\"`"
                ));
                return None;
            }
        }
    }
    Some(Selection { study, variants: common.variant.clone(), sets, over: Vec::new() })
}

/// Where results go.
pub(super) fn directory(model: &str, common: &Common) -> PathBuf {
    common.output.clone().unwrap_or_else(|| {
        let stem = if model == "-" { "stdin".into() } else { Path::new(model).file_stem().unwrap_or_default().to_os_string() };
        Path::new("results").join(stem)
    })
}

/// Prints why something did not begin, at its place, and gives the exit code; `study` is empty outside of studies.
pub(super) fn explain(document: &Document, failure: &Failure, study: &str, common: &Common) -> u8 {
    let (diagnostics, code) = match failure {
        Failure::Model(faults) => {
            let at = |f: &BuildFault| document.diagnostic(f.code, &f.place, f.message.clone(), f.expected.clone(), f.help.clone());
            (faults.iter().map(at).collect(), code::INPUT)
        }
        Failure::Study { code, message, place, help } => {
            (vec![document.diagnostic(code, place, message.clone(), "", Some(help.clone()))], code::INPUT)
        }
        Failure::Unsolved(Unsolved { message, place, help }) => {
            let message = format!("study `{study}`: {message}");
            (vec![document.diagnostic("unsolved", place, message, "", Some(help.clone()))], code::NUMERICAL)
        }
        Failure::Undefined(Undefined { message, place, help }) => {
            let message = if study.is_empty() { message.clone() } else { format!("study `{study}`: {message}") };
            (vec![document.diagnostic("undefined", place, message, "", Some(help.clone()))], code::NUMERICAL)
        }
        Failure::Numerical { message, help } => {
            let message = format!("study `{study}`: {message}");
            (vec![document.diagnostic("numerical", &format!("studies.{study}"), message, "", Some(help.clone()))], code::NUMERICAL)
        }
    };
    tell(Report::new(diagnostics).render(common.colored()).trim_end());
    code
}
