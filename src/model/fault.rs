//! A finding before its place is looked up: reading is fast because positions are sought only for what is wrong.

use super::diagnostics::{Diagnostic, Excerpt, Severity};
use super::remedy::remedy;
use super::spans::{Spans, Step};
use std::ops::Range;

/// What part of a place is meant.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Spot {
    /// The value.
    Value,
    /// The key.
    Key,
    /// Bytes of the value's text.
    Within(String, Range<usize>),
    /// Bytes of the key's text.
    WithinKey(String, Range<usize>),
    /// Bytes of the file.
    Bytes(Range<usize>),
    /// The file as a whole.
    Nowhere,
    /// Bytes of a text given from outside, by an option or in a call.
    Outside(Given, Range<usize>),
}

/// A text that was given from outside, as messages show it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Given {
    /// What stands in the place of the name of a file.
    pub(crate) source: &'static str,
    /// The text.
    pub(crate) text: String,
}

impl Given {
    /// Bytes of it.
    pub(crate) fn spot(&self, part: Range<usize>) -> Spot {
        Spot::Outside(self.clone(), part)
    }

    /// All of it.
    pub(crate) fn whole(&self) -> Spot {
        self.spot(0..self.text.len())
    }

    /// Its last bytes.
    pub(crate) fn end(&self, length: usize) -> Spot {
        self.spot(self.text.len() - length..self.text.len())
    }
}

/// A finding with the path of its place.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Fault {
    pub(crate) code: &'static str,
    pub(crate) warning: bool,
    /// Path in the file.
    pub(crate) place: String,
    pub(crate) spot: Spot,
    pub(crate) message: String,
    pub(crate) expected: String,
    pub(crate) help: Option<String>,
    /// The remedy where nothing closer to the case is found.
    pub(crate) otherwise: Option<String>,
    /// Bytes of the file that belong to it, and a word about them.
    pub(crate) other: Option<(Range<usize>, String)>,
}

impl Fault {
    /// An error at the value of a place.
    pub(crate) fn new(code: &'static str, place: String, message: impl Into<String>, expected: impl Into<String>) -> Self {
        Self {
            code,
            warning: false,
            place,
            spot: Spot::Value,
            message: message.into(),
            expected: expected.into(),
            help: None,
            otherwise: None,
            other: None,
        }
    }

    /// The same with a remedy.
    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same with a remedy, if there is one.
    pub(crate) fn maybe_help(mut self, help: Option<String>) -> Self {
        self.help = help;
        self
    }

    /// The same at another part of the place.
    pub(crate) fn at(mut self, spot: Spot) -> Self {
        self.spot = spot;
        self
    }

    /// The same, not grave.
    pub(crate) fn warn(mut self) -> Self {
        self.warning = true;
        self
    }

    /// The place that it spoils: of an item of a list the whole list, since a comma may have cut another item.
    pub(crate) fn cause(&self) -> String {
        match self.place.rsplit_once('[') {
            Some((list, item)) if item.ends_with(']') => list.to_owned(),
            _ => self.place.clone(),
        }
    }

    /// Looks the place up.
    pub(crate) fn diagnostic(&self, file: &str, text: &str, spans: &Spans) -> Diagnostic {
        let (file, at) = match &self.spot {
            Spot::Outside(given, range) => (given.source, Some(excerpt(&given.text, range.clone()))),
            Spot::Nowhere => (file, None),
            Spot::Bytes(range) => (file, Some(excerpt(text, range.clone()))),
            Spot::Value => (file, spans.value(&self.place).map(|range| excerpt(text, range))),
            Spot::Key => (file, spans.key(&self.place).map(|range| excerpt(text, range))),
            Spot::Within(value, part) => {
                (file, spans.within(text, &self.place, value, part.clone(), false).map(|range| excerpt(text, range)))
            }
            Spot::WithinKey(value, part) => {
                (file, spans.within(text, &self.place, value, part.clone(), true).map(|range| excerpt(text, range)))
            }
        };
        Diagnostic {
            code: self.code,
            severity: if self.warning { Severity::Warning } else { Severity::Error },
            message: self.message.clone(),
            expected: self.expected.clone(),
            help: self.help.clone().or_else(|| self.otherwise.clone()).or_else(|| remedy(self.code).map(str::to_owned)),
            place: self.place.clone(),
            file: file.to_owned(),
            at,
            other: self.other.as_ref().map(|(range, label)| (excerpt(text, range.clone()), label.clone())),
        }
    }
}

/// The line of a byte range and its part in it; a range over several lines is cut at the end of the first.
pub(crate) fn excerpt(text: &str, range: Range<usize>) -> Excerpt {
    let floor = |at: usize| (0..=at.min(text.len())).rev().find(|i| text.is_char_boundary(*i)).unwrap_or(0);
    let (start, end) = (floor(range.start), floor(range.end.max(range.start)));
    let before = &text[..start];
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |i| start + i);
    let source = text[line_start..line_end].trim_end_matches('\r');
    let end = end.min(line_start + source.len()).max(start.min(line_start + source.len()));
    let start = start.min(end);
    Excerpt {
        line: before.matches('\n').count() + 1,
        column: text[line_start..start].chars().count() + 1,
        width: text[start..end].chars().count().max(1),
        source: source.to_owned(),
    }
}

/// Where a reader is: a path that costs nothing until it is asked for.
#[derive(Clone, Copy)]
pub(crate) struct At<'p, 'k> {
    parent: Option<&'p At<'p, 'k>>,
    step: Option<Step<'k>>,
}

impl<'p, 'k> At<'p, 'k> {
    /// The file itself.
    pub(crate) const ROOT: At<'static, 'static> = At { parent: None, step: None };

    /// A key below, by its name or as it was declared.
    pub(crate) fn key(&'p self, key: impl Into<&'k str>) -> At<'p, 'k> {
        At { parent: Some(self), step: Some(Step::Key(key.into())) }
    }

    /// An item below.
    pub(crate) fn index(&'p self, index: usize) -> At<'p, 'k> {
        At { parent: Some(self), step: Some(Step::Index(index)) }
    }

    /// All steps from the root.
    pub(crate) fn steps(&self) -> Vec<Step<'k>> {
        let mut steps = Vec::new();
        let mut at = Some(self);
        while let Some(here) = at {
            steps.extend(here.step);
            at = here.parent;
        }
        steps.reverse();
        steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let text = "a: ü\nbö: [1]\n";
        let at = excerpt(text, text.find('1').map(|i| i..i + 1).unwrap());
        assert_eq!((at.line, at.column, at.width, at.source.as_str()), (2, 6, 1, "bö: [1]"));
        assert_eq!(excerpt("", 5..9).column, 1);
    }

    #[test]
    fn paths_are_built_from_the_root() {
        let a = At::ROOT.key("joints");
        let b = a.key("O");
        assert_eq!(super::super::merge::path(&b.index(1).steps()), "joints.O[1]");
    }
}
