//! What is wrong with a model file, said the way a compiler says it: place, what was found, what was expected, one remedy.

use super::place::Place;
use std::fmt::Write;

/// Stands in the place of the name of a file for a model that stands in none.
pub(crate) const NO_FILE: &str = "<text>";

/// How grave a diagnostic is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The model cannot be used.
    Error,
    /// The model can be used, but probably says something that was not meant.
    Warning,
}

/// One line of the source and the part of it that is meant.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Excerpt {
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
    /// Number of characters that are marked; at least 1 when shown.
    pub width: usize,
    /// The line's text without its end.
    pub source: String,
}

/// One finding in a model file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// A stable name in kebab-case: `unknown-key`, `wrong-dimension`.
    pub code: &'static str,
    /// How grave it is.
    pub severity: Severity,
    /// What was found.
    pub message: String,
    /// What was expected; empty if the message says it.
    pub expected: String,
    /// One remedy.
    pub help: Option<String>,
    /// Path of keys in the file: `joints.O.revolute[1]`; empty if there is none.
    pub place: Place,
    /// The file's name as given to [`super::Document::read`]; of what is given from outside `command line`, or the name of the argument.
    pub file: String,
    /// The place in the file, if it has one.
    pub at: Option<Excerpt>,
    /// A second place that belongs to it, with a word about it: the first of two equal names.
    pub other: Option<(Excerpt, String)>,
}

impl Diagnostic {
    /// Line counted from 1; 0 if there is no place.
    #[must_use]
    pub fn line(&self) -> usize {
        self.at.as_ref().map_or(0, |at| at.line)
    }

    /// Column in characters counted from 1; 0 if there is no place.
    #[must_use]
    pub fn column(&self) -> usize {
        self.at.as_ref().map_or(0, |at| at.column)
    }

    /// Appends the text of this diagnostic, several lines, with ANSI colours if `color`.
    pub fn render(&self, out: &mut String, color: bool) {
        let paint = Paint(color);
        let (word, tint) = match self.severity {
            Severity::Error => ("error", "1;31"),
            Severity::Warning => ("warning", "1;33"),
        };
        let head = paint.of(tint, &format!("{word}[{}]", self.code));
        let _ = writeln!(out, "{head}{}", paint.of("1", &format!(": {}", self.message)));
        // what stands in no file has no lines that a reader knows
        let place =
            if self.place.is_empty() || self.at.is_some() && self.file != NO_FILE { String::new() } else { format!(": {}", self.place) };
        let lines = [self.at.as_ref(), self.other.as_ref().map(|(at, _)| at)];
        let margin = lines.iter().flatten().map(|at| at.line.to_string().len()).max().unwrap_or(1);
        let (blank, bar) = (" ".repeat(margin), paint.of("1;34", "|"));
        match &self.at {
            Some(at) => {
                let arrow = paint.of("1;34", "-->");
                let _ = writeln!(out, "{blank}{arrow} {}:{}:{}{place}", self.file, at.line, at.column);
                let _ = writeln!(out, "{blank} {bar}");
                // in file order, as a reader meets them
                match &self.other {
                    Some((other, label)) if other.line < at.line => {
                        other.draw(out, margin, ('-', "1;34"), label, paint);
                        at.draw(out, margin, ('^', tint), "", paint);
                    }
                    Some((other, label)) => {
                        at.draw(out, margin, ('^', tint), "", paint);
                        other.draw(out, margin, ('-', "1;34"), label, paint);
                    }
                    None => at.draw(out, margin, ('^', tint), "", paint),
                }
            }
            None => {
                let _ = writeln!(out, "{blank}{} {}{place}", paint.of("1;34", "-->"), self.file);
            }
        }
        if !self.expected.is_empty() || self.help.is_some() {
            let _ = writeln!(out, "{blank} {bar}");
        }
        if !self.expected.is_empty() {
            let _ = writeln!(out, "{blank} {} {}", paint.of("1;34", "="), self.labelled("expected", &self.expected, &blank, paint));
        }
        if let Some(help) = &self.help {
            let _ = writeln!(out, "{blank} {} {}", paint.of("1;34", "="), self.labelled("help", help, &blank, paint));
        }
    }

    /// `label: text`, further lines indented below the first.
    fn labelled(&self, label: &str, text: &str, blank: &str, paint: Paint) -> String {
        let indent = format!("\n{blank}   {}", " ".repeat(label.len() + 2));
        format!("{} {}", paint.of("1", &format!("{label}:")), text.trim_end().replace('\n', &indent))
    }
}

impl Excerpt {
    /// The source line and, below it, the mark.
    fn draw(&self, out: &mut String, margin: usize, (mark, tint): (char, &str), label: &str, paint: Paint) {
        /// A line of data may be very long; only its part around the mark is shown.
        const SHOWN: usize = 160;
        let start = self.column.saturating_sub(1);
        let skip = if start > SHOWN / 2 && self.source.chars().count() > SHOWN { start - SHOWN / 2 } else { 0 };
        let shown: String = self.source.chars().skip(skip).take(SHOWN).map(|c| if c.is_control() { ' ' } else { c }).collect();
        let bar = paint.of("1;34", "|");
        let number = paint.of("1;34", &format!("{:>margin$}", self.line));
        let _ = writeln!(out, "{number} {bar} {}", shown.trim_end());
        let width = self.width.clamp(1, (SHOWN + 1).saturating_sub(start - skip).max(1));
        let mut marks: String = std::iter::repeat_n(mark, width).collect();
        if !label.is_empty() {
            marks = format!("{marks} {label}");
        }
        let _ = writeln!(out, "{} {bar} {}{}", " ".repeat(margin), " ".repeat(start - skip), paint.of(tint, &marks));
    }
}

/// Whether text is coloured.
#[derive(Clone, Copy)]
struct Paint(bool);

impl Paint {
    fn of(self, code: &str, text: &str) -> String {
        if self.0 { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_owned() }
    }
}

/// All findings of one reading, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// The findings.
    pub diagnostics: Vec<Diagnostic>,
}

impl Report {
    /// A report of these findings, sorted by place and without repetitions.
    #[must_use]
    pub fn new(mut diagnostics: Vec<Diagnostic>) -> Self {
        diagnostics.sort_by(|a, b| {
            (a.at.is_none(), &a.file, a.line(), a.column(), a.severity, a.code, &a.message).cmp(&(
                b.at.is_none(),
                &b.file,
                b.line(),
                b.column(),
                b.severity,
                b.code,
                &b.message,
            ))
        });
        diagnostics.dedup();
        Self { diagnostics }
    }

    /// The same without lines of the source: of a file that turns out to be something else than was asked for, nothing is shown.
    #[must_use]
    pub(super) fn without_excerpts(mut self) -> Self {
        for found in &mut self.diagnostics {
            (found.at, found.other) = (None, None);
        }
        self
    }

    /// The same without what another report says of the same places.
    #[must_use]
    pub fn beyond(mut self, other: &Self) -> Self {
        let of = |d: &Diagnostic| (d.code, d.file.clone(), d.line(), d.column());
        self.diagnostics.retain(|found| !other.diagnostics.iter().any(|known| of(known) == of(found)));
        self
    }

    /// Number of errors.
    #[must_use]
    pub fn errors(&self) -> usize {
        self.diagnostics.iter().filter(|d| d.severity == Severity::Error).count()
    }

    /// True if there is an error among the findings.
    #[must_use]
    pub fn failed(&self) -> bool {
        self.errors() > 0
    }

    /// Everything as text, in the manner of a compiler; with ANSI colours if `color`.
    #[must_use]
    pub fn render(&self, color: bool) -> String {
        let mut out = String::new();
        for (i, diagnostic) in self.diagnostics.iter().enumerate() {
            if i > 0 {
                out.push('\n');
            }
            diagnostic.render(&mut out, color);
        }
        out
    }
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Report {}
