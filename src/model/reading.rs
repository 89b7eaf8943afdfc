//! Texts and what is found in them, at its place.

use super::diagnostics::{Diagnostic, Report};
use super::fault::{Fault, Spot};
use super::included::{Included, find};
use super::spans::Spans;
use std::collections::HashSet;

/// Most findings of one report.
const MOST_SHOWN: usize = 200;

/// The sign of the byte order that some editors put in front of a text.
pub(super) const BYTE_ORDER: char = '\u{feff}';

/// Bytes as text, without the sign of a byte order in front; `most` of them are shown if they are none.
pub(crate) fn text_of<'b>(bytes: &'b [u8], file: &str, most: usize) -> Result<&'b str, Report> {
    let text = std::str::from_utf8(bytes).map(|text| text.strip_prefix(BYTE_ORDER).unwrap_or(text));
    text.map_err(|error| {
        let good = error.valid_up_to();
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min(most)]);
        let fault = Fault::new("not-utf8", String::new(), format!("byte {} is not UTF-8", good + 1), "a text file in UTF-8")
            .at(Spot::Bytes(good..good + 1))
            .help("save the file as UTF-8");
        report(file, &text, &[fault], &[])
    })
}

/// A finding at its place, which may lie in an included file.
pub(super) fn shown(fault: &Fault, file: &str, text: &str, spans: &Spans, included: &[Included]) -> Diagnostic {
    match find(included, &fault.place) {
        None => fault.diagnostic(file, text, spans),
        Some((inner, path)) => match inner.asked(path) {
            Some(place) => Fault { place, ..fault.clone() }.diagnostic(file, text, spans),
            None => inner.diagnostic(fault, path),
        },
    }
}

/// Findings in a text, each once.
pub(crate) fn report(file: &str, text: &str, faults: &[Fault], included: &[Included]) -> Report {
    if faults.is_empty() {
        return Report::default();
    }
    let spans = Spans::new(text);
    let mut seen = HashSet::new();
    let distinct: Vec<&Fault> = faults.iter().filter(|fault| seen.insert(*fault)).collect();
    let mut found: Vec<Diagnostic> = distinct.iter().take(MOST_SHOWN).map(|fault| shown(fault, file, text, &spans, included)).collect();
    if let Some(rest) = distinct.len().checked_sub(MOST_SHOWN).filter(|rest| *rest > 0) {
        // an error among the hidden ones stays an error
        let warning = distinct.iter().skip(MOST_SHOWN).all(|fault| fault.warning);
        let told = if rest == 1 { "one more finding is not shown".to_owned() } else { format!("{rest} more findings are not shown") };
        let mut more = Fault::new("more", String::new(), told, "");
        (more.warning, more.spot) = (warning, Spot::Nowhere);
        found.push(more.diagnostic(file, text, &spans));
    }
    Report::new(found)
}
