//! What is printed on stdout and on stderr.
//!
//! Names and texts come from the user's files and may hold anything; what would steer a terminal is shown as `\u001b`, which inside
//! of a JSON string means the same character. Errors that are printed are also kept, for `--json`.

use grashof::model::{Diagnostic, Excerpt, Report, Severity};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::io::{ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Whether stdout could not be written.
static FAILED: AtomicBool = AtomicBool::new(false);
/// Whether anything was said on stdout.
static SAID: AtomicBool = AtomicBool::new(false);
/// Errors that were printed and not yet taken.
static ERRORS: Mutex<Vec<Value>> = Mutex::new(Vec::new());
/// Why studies did not begin, as far as it was told: code, place, message.
static TOLD: Mutex<BTreeSet<(String, String, String)>> = Mutex::new(BTreeSet::new());

/// A line on stdout. A closed pipe is no error: somebody has read enough.
pub(crate) fn print_out(text: &str) {
    SAID.store(true, Ordering::Relaxed);
    let mut out = std::io::stdout().lock();
    told_if_failed(writeln!(out, "{}", escaped(text)).and_then(|()| out.flush()));
}

/// Tells once that stdout could not be written.
pub(crate) fn told_if_failed(written: std::io::Result<()>) {
    if let Err(error) = written
        && error.kind() != ErrorKind::BrokenPipe
        && !FAILED.swap(true, Ordering::Relaxed)
    {
        print_note(&format!("error: cannot write to standard output: {error}\n  help: direct it to a file or pipe that can be written"));
    }
}

/// Whether something of stdout is lost.
pub(crate) fn output_failed() -> bool {
    FAILED.load(Ordering::Relaxed)
}

/// Whether anything was said on stdout.
pub(crate) fn has_said() -> bool {
    SAID.load(Ordering::Relaxed)
}

/// A line on stderr.
pub(crate) fn print_note(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{}", escaped(text));
}

/// Tells an error with its remedy.
pub(crate) fn print_error(message: &str, help: &str) {
    print_note(&format!("error: {message}\n  help: {help}"));
    keep(json!({ "message": message, "help": help }));
}

/// Tells that something was interrupted.
pub(crate) fn print_interrupted(message: &str) {
    print_note(message);
    keep(json!({ "message": message }));
}

/// Tells what was found at places of a file, as a compiler does.
pub(crate) fn print_report(report: &Report, colored: bool) {
    keep_all(report);
    let visible = Report { diagnostics: report.diagnostics.iter().map(visible).collect() };
    let text = visible.render(colored);
    if !text.is_empty() {
        let _ = writeln!(std::io::stderr().lock(), "{}", text.trim_end());
    }
}

/// Tells why a study did not begin: in one line where an earlier one did not for the same reason.
pub(crate) fn print_failure(study: &str, report: &Report, colored: bool) {
    let key = |found: &Diagnostic| (found.code.to_owned(), found.place.clone(), found.message.clone());
    let mut told = TOLD.lock().unwrap_or_else(PoisonError::into_inner);
    let new = report.diagnostics.iter().filter(|found| told.insert(key(found))).count();
    drop(told);
    let [first, ..] = &report.diagnostics[..] else { return };
    if new > 0 || study.is_empty() {
        return print_report(report, colored);
    }
    keep_all(report);
    let place = first.at.as_ref().map_or_else(String::new, |at| format!(" at {}:{}:{}", first.file, at.line, at.column));
    print_note(&format!("error[{}]: study `{study}` does not begin for the same reason{place}", first.code));
}

/// Keeps the errors of a report.
fn keep_all(report: &Report) {
    for found in report.diagnostics.iter().filter(|found| found.severity == Severity::Error) {
        let place = found.at.as_ref().map(|at| (at.line, at.column));
        keep(json!({
            "code": found.code, "message": found.message, "expected": found.expected, "help": found.help, "path": found.place,
            "file": found.file, "line": place.map(|p| p.0), "column": place.map(|p| p.1),
        }));
    }
}

/// A finding with nothing in its texts that steers a terminal.
fn visible(found: &Diagnostic) -> Diagnostic {
    let text = |text: &String| escaped(text).into_owned();
    let excerpt = |at: &Excerpt| Excerpt { source: at.source.chars().map(|c| if steers(c) { ' ' } else { c }).collect(), ..at.clone() };
    Diagnostic {
        message: text(&found.message),
        expected: text(&found.expected),
        help: found.help.as_ref().map(text),
        file: text(&found.file),
        at: found.at.as_ref().map(excerpt),
        other: found.other.as_ref().map(|(at, label)| (excerpt(at), text(label))),
        ..found.clone()
    }
}

fn keep(error: Value) {
    ERRORS.lock().unwrap_or_else(PoisonError::into_inner).push(error);
}

/// The errors that were printed since the last call.
pub(crate) fn take_errors() -> Vec<Value> {
    std::mem::take(&mut *ERRORS.lock().unwrap_or_else(PoisonError::into_inner))
}

/// The JSON of a command or study that came to nothing.
pub(crate) fn failure_json(study: Option<&str>, errors: Vec<Value>) -> String {
    let mut object = serde_json::Map::new();
    object.extend(study.map(|study| ("study".to_string(), study.into())));
    object.insert("status".into(), "failed".into());
    object.insert("errors".into(), errors.into());
    serde_json::to_string_pretty(&object).unwrap_or_default()
}

/// The JSON text of a report with the errors that belong to it, its numbers untouched.
pub(crate) fn with_errors(report: &str, errors: Vec<Value>) -> String {
    let report = report.trim_end();
    match report.strip_suffix('}') {
        Some(open) if !errors.is_empty() => {
            let errors = serde_json::to_string_pretty(&errors).unwrap_or_default().replace('\n', "\n  ");
            format!("{},\n  \"errors\": {errors}\n}}", open.trim_end())
        }
        _ => report.to_string(),
    }
}

/// Whether a character steers a terminal or the direction of text instead of being shown.
fn steers(c: char) -> bool {
    (c.is_control() && c != '\n' && c != '\t') || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A text with everything visible.
pub(crate) fn escaped(text: &str) -> Cow<'_, str> {
    if !text.contains(steers) {
        return text.into();
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if steers(c) { out.push_str(&format!("\\u{:04x}", u32::from(c))) } else { out.push(c) }
    }
    out.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_shown() {
        assert_eq!(escaped("a\x1b[2J\u{9b}b\r\u{202e}\nü\t"), "a\\u001b[2J\\u009bb\\u000d\\u202e\nü\t");
        // inside of a JSON string the same character
        let text = serde_json::to_string("x\u{7f}\u{9b}\u{202e}y").unwrap();
        assert_eq!(serde_json::from_str::<String>(&escaped(&text)).unwrap(), "x\u{7f}\u{9b}\u{202e}y");
    }

    #[test]
    fn errors_join_a_report_whose_numbers_stay() {
        let report = "{\n  \"study\": \"a\",\n  \"x\": 0.1000000000000000055\n}\n";
        assert_eq!(with_errors(report, vec![]), report.trim_end());
        let joined = with_errors(report, vec![json!({ "message": "m" })]);
        assert!(joined.contains("0.1000000000000000055"));
        let read: Value = serde_json::from_str(&joined).unwrap();
        assert_eq!(read["errors"][0]["message"], "m");
    }
}
