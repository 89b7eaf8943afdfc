//! The report: one page with all studies of a run, which asks for nothing outside of itself.
//!
//! The page is the bundle of `viewer/`, and data behind it: one object of JSON, compressed (gzip) and written as base64. It has
//!
//! ```text
//! { "version", "model": { "name", "path", "source", "about" }, "overview": [{ "label", "value" }], "studies": [...] }
//! ```
//!
//! where each study is [`Results`](crate::results::Results) as serde writes it, with `about`, with `rows`, which says what was left out
//! of its table, and with the frames of its scenes as differences ([`poses`]). One without results is `{ "study", "about", "faults" }`.
//! The same run gives the same bytes.

mod axes;
mod base64;
mod bundle;
mod live;
mod poses;
mod rows;
mod study;
mod tables;

pub use live::{LIVE_POLICY, live_page};
pub use study::{ReportRuns, ReportStudy};

pub(super) use base64::base64;
use bundle::{SPACE, STYLE, escaped};
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Value, json};
use std::io::Write;
use study::in_one_line;

const PAGE: &str = include_str!("../../../viewer/dist/page.js");
/// What the page may load and run: itself, by the checksums of its parts.
const POLICY: &str = include_str!("../../../viewer/dist/policy.txt");

/// What a report says of the model.
#[derive(Clone, Debug, Default)]
pub struct ReportModel<'a> {
    /// Its name.
    pub name: &'a str,
    /// The name of its file.
    pub path: &'a str,
    /// The text of the file.
    pub source: &'a str,
    /// What it is about; may be empty.
    pub about: &'a str,
    /// What is worth knowing at a glance: labels and values.
    pub overview: &'a [(String, String)],
}

impl ReportModel<'_> {
    /// The object that a page has of it, without studies.
    #[must_use]
    pub fn json(&self) -> Value {
        let overview: Vec<_> = self.overview.iter().map(|(label, value)| json!({ "label": label, "value": value })).collect();
        let about = (!self.about.trim().is_empty()).then_some(self.about);
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "model": { "name": self.name, "path": self.path, "source": self.source, "about": about },
            "made": null,
            "overview": overview,
        })
    }
}

/// Why a study has no results.
#[derive(Clone, Debug, Default)]
pub struct ReportFault {
    /// In words.
    pub message: String,
    /// Path in the file; may be empty.
    pub place: String,
    /// One remedy; may be empty.
    pub help: String,
}

/// A report to which studies are added as they are finished; it keeps them compressed.
#[derive(Debug)]
pub struct Report {
    title: String,
    data: GzEncoder<Vec<u8>>,
    /// Studies that it lists, and those of them that have results.
    listed: usize,
    studies: usize,
    spatial: bool,
}

impl Report {
    /// A report without studies.
    #[must_use]
    pub fn new(model: &ReportModel<'_>) -> Self {
        let head = model.json().to_string();
        let mut report =
            Self { title: model.name.into(), data: GzEncoder::new(Vec::new(), Compression::best()), listed: 0, studies: 0, spatial: false };
        report.put(head.strip_suffix('}').unwrap_or(&head));
        report.put(",\"studies\":[");
        report
    }

    /// Adds a study.
    pub fn add(&mut self, study: &ReportStudy) {
        self.list(&study.text);
        self.studies += 1;
        self.spatial |= study.spatial;
    }

    /// Lists a study.
    fn list(&mut self, text: &str) {
        if self.listed > 0 {
            self.put(",");
        }
        self.put(text);
        self.listed += 1;
    }

    /// Adds a study that has no results, with what it is for and why there are none: messages, places in the file, remedies.
    pub fn add_failed(&mut self, study: &str, about: &str, faults: &[ReportFault]) {
        let faults: Vec<_> = faults.iter().map(|f| json!({ "message": f.message, "place": f.place, "help": f.help })).collect();
        self.list(&json!({ "study": study, "about": in_one_line(about), "faults": faults }).to_string());
    }

    /// Whether no study has results.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.studies == 0
    }

    /// The page.
    #[must_use]
    pub fn html(mut self) -> Vec<u8> {
        self.put("]}");
        let data = base64(&self.data.finish().unwrap_or_default());
        let title = escaped(&self.title);
        let space = if self.spatial { format!("<script>{SPACE}</script>\n") } else { String::new() };
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n\
             <link rel=\"icon\" href=\"data:,\">\n<style>{STYLE}</style>\n</head>\n<body>\n\
             <noscript>This report needs JavaScript; it asks for nothing outside of this file.</noscript>\n\
             <div id=\"page\"></div>\n<script type=\"text/plain\" id=\"data\">{data}</script>\n{space}<script>{PAGE}</script>\n\
             </body>\n</html>\n",
            POLICY.trim()
        )
        .into_bytes()
    }

    /// Adds text of the data; memory takes it all.
    fn put(&mut self, text: &str) {
        let _ = self.data.write_all(text.as_bytes());
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
