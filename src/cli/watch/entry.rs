//! What the board has of a study, and findings as pages have them.

use grashof::model::{Diagnostic, Report, Severity};
use grashof::output::ReportModel;
use serde_json::{Value, json};
use std::sync::Arc;

/// A study.
pub(super) struct Entry {
    pub(super) name: String,
    /// What the page has of it, and its number; 0 if there is nothing.
    pub(super) result: (u64, Arc<String>),
    /// Of what it was computed last.
    pub(super) of: u64,
    pub(super) busy: bool,
    pub(super) bad: bool,
    pub(super) about: String,
    pub(super) findings: Vec<Value>,
}

/// What came of a study.
#[derive(Default)]
pub(super) struct Computed {
    /// What the page has of it; none if it came to nothing.
    pub(super) json: Option<String>,
    /// What it is for.
    pub(super) about: String,
    /// Whether it stopped on its way or does not meet what is expected.
    pub(super) bad: bool,
    /// Why it came to nothing.
    pub(super) report: Report,
}

impl Entry {
    /// What a page has of it, where number `wanted` is the newest.
    pub(super) fn json(&self, wanted: u64) -> Value {
        json!({
            "name": self.name, "about": self.about, "version": self.result.0, "stale": self.of != wanted, "busy": self.busy,
            "bad": self.bad, "findings": self.findings,
        })
    }
}

/// The entry of a study, with what was known of it.
pub(super) fn entry(name: String, known: &mut Vec<Entry>) -> Entry {
    match known.iter().position(|entry| entry.name == name) {
        Some(i) => known.swap_remove(i),
        None => Entry { name, result: (0, Arc::default()), of: 0, busy: false, bad: false, about: String::new(), findings: Vec::new() },
    }
}

/// What a page has of a model that was never sound.
pub(super) fn unknown(path: &str) -> Value {
    let model = ReportModel { name: path, path, source: "", about: "", overview: &[] };
    model.json()
}

/// Findings as a page has them.
pub(super) fn shown(report: &Report) -> Vec<Value> {
    let one = |found: &Diagnostic| {
        let mut text = String::new();
        found.render(&mut text, false);
        let error = found.severity == Severity::Error;
        json!({ "error": error, "text": text.trim_end(), "file": found.file, "line": found.line(), "column": found.column() })
    };
    report.diagnostics.iter().map(one).collect()
}
