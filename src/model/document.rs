//! A model file in memory, and the models that can be made of it.

use super::diagnostics::{Diagnostic, Report};
use super::entities::Model;
use super::fault::{Fault, Spot};
use super::include::{self, Files, Included};
use super::inquiry::Inquiry;
use super::merge::Node;
use super::spans::Spans;
use super::suggest;
use super::yaml;
use serde_yaml::{Mapping, Value};
use std::collections::HashSet;

/// What is asked of a model file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection<'a> {
    /// The study that the model is merged for.
    pub study: Option<&'a str>,
    /// Variants from outside, applied after those of the study.
    pub variants: Vec<String>,
    /// Parameters from outside, as name and value; over everything.
    pub sets: Vec<(String, String)>,
    /// Sweeps from outside, in place of the study's own: parameter, and `FROM..TO:COUNT` (with `:log` for equal ratios) or a list.
    pub over: Vec<(String, String)>,
}

/// A model file.
#[derive(Clone, Debug)]
pub struct Document {
    file: String,
    text: String,
    /// A map.
    pub(super) root: Value,
    /// The files that it includes, in its order.
    pub(super) included: Vec<Included>,
}

impl Document {
    /// Reads a model file that includes no others; `file` is its name for messages. Nothing but its YAML is judged yet.
    ///
    /// # Errors
    /// What is not YAML, or is YAML that the format refuses (aliases, tags, two documents, more than 1 MiB, ...).
    pub fn read(text: &str, file: &str) -> Result<Self, Report> {
        Self::new(text, file, &|_| Err("no files are read here".to_owned()))
    }

    /// As [`Self::read`], from bytes that may be no text.
    ///
    /// # Errors
    /// As [`Self::read`], and at the first byte that is not UTF-8.
    pub fn from_bytes(bytes: &[u8], file: &str) -> Result<Self, Report> {
        Self::read(text_of(bytes, file, yaml::MOST_BYTES)?, file)
    }

    /// As [`Self::from_bytes`], with the files that the model includes: a model reads nothing itself.
    ///
    /// # Errors
    /// As [`Self::from_bytes`]; a wrong section `include`; everything that is wrong with an included file.
    pub fn with_files(bytes: &[u8], file: &str, files: &Files<'_>) -> Result<Self, Report> {
        Self::new(text_of(bytes, file, yaml::MOST_BYTES)?, file, files)
    }

    fn new(text: &str, file: &str, files: &Files<'_>) -> Result<Self, Report> {
        let root = yaml::read(text).map_err(|faults| report(file, text, &faults, &[]))?;
        let included = include::read(&root, file, text, files)?;
        Ok(Self { root: Value::Mapping(root), file: file.to_owned(), text: text.to_owned(), included })
    }

    /// What of included files the model does not use, or not as it stands, one sentence each with its file and line.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.included.iter().flat_map(|included| included.notes(&self.root)).collect()
    }

    /// The file's name as given.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The file's text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Names of the studies, in file order.
    #[must_use]
    pub fn study_names(&self) -> Vec<String> {
        self.named("studies").into_iter().map(|(name, _)| name.to_owned()).collect()
    }

    /// Names of the variants, in file order.
    #[must_use]
    pub fn variant_names(&self) -> Vec<String> {
        self.named("variants").into_iter().map(|(name, _)| name.to_owned()).collect()
    }

    /// Entries of a section of the file.
    pub(super) fn named(&self, section: &str) -> Vec<(&str, Node<'_>)> {
        self.root.get(section).map(|value| Node::Plain(value).entries()).unwrap_or_default()
    }

    /// Adds a study in memory, as if it stood in the file: `yaml` is its map, and its name is the first of `name`, `name-2`, ...
    /// that no study has. Gives the name. What is wrong with the study is found when its model is asked for.
    pub fn add_study(&mut self, name: &str, yaml: &str) -> String {
        let known = self.study_names();
        let numbered = (2..).map(|i| format!("{name}-{i}"));
        let free = std::iter::once(name.to_owned()).chain(numbered).find(|name| !known.contains(name)).unwrap_or_default();
        let study = serde_yaml::from_str(yaml).unwrap_or(Value::Null);
        if let Value::Mapping(root) = &mut self.root {
            let studies = root.entry("studies".into()).or_insert_with(|| Value::Mapping(Mapping::new()));
            if let Value::Mapping(studies) = studies {
                studies.insert(free.as_str().into(), study);
            }
        }
        free
    }

    pub(super) fn study_node(&self, name: &str) -> Option<Node<'_>> {
        let node = Node::Plain(self.root.get("studies")?).get(name)?;
        node.is_map().then_some(node)
    }

    /// The model for a selection: variants merged, everything decoded and checked, the study too if one is named.
    ///
    /// # Errors
    /// Everything that is wrong with it. Warnings alone are no error; [`Self::check_all`] shows them.
    pub fn model(&self, selection: &Selection<'_>) -> Result<Model, Report> {
        let mut inquiry = Inquiry::new(self, selection);
        let mut faults = inquiry.form();
        if faults.is_empty() {
            match selection.study {
                Some(name) if self.study_node(name).is_none() => faults.push(self.unknown_study(name)),
                Some(name) => return inquiry.model_for(Some(name)),
                None => return inquiry.model_for(None),
            }
        }
        Err(self.report(&faults))
    }

    /// Everything that is wrong with the file: its form, the model as it stands, and the model of every study with the study.
    /// Each finding once.
    #[must_use]
    pub fn check_all(&self, selection: &Selection<'_>) -> Report {
        let mut inquiry = Inquiry::new(self, selection);
        let mut faults = inquiry.form();
        let meaning = inquiry.meaning();
        // what follows from a fault of form is not said again; a misspelt key says nothing against its value
        let headless = faults.iter().any(|fault| fault.code == "unknown-key" && !fault.place.contains('.'));
        let form: HashSet<String> = faults.iter().filter(|fault| fault.code != "unknown-key").map(Fault::cause).collect();
        let consequence = |fault: &Fault| {
            // the names of a section whose own name is misspelt are unknown
            headless && fault.code.starts_with("unknown-")
                || fault.spot != Spot::Key && (form.contains(&fault.cause()) || form.contains(&fault.place))
        };
        faults.extend(meaning.into_iter().filter(|fault| !consequence(fault)));
        self.report(&faults)
    }

    /// A finding of a later phase (building, assembly) at a path of this file, as entities carry it in `place`.
    #[must_use]
    pub fn diagnostic(
        &self,
        code: &'static str,
        place: &str,
        message: impl Into<String>,
        expected: impl Into<String>,
        help: Option<String>,
    ) -> Diagnostic {
        let spans = Spans::new(&self.text);
        let place = if include::find(&self.included, place).is_some() { place.to_owned() } else { self.real_place(&spans, place) };
        shown(&Fault::new(code, place, message, expected).maybe_help(help), &self.file, &self.text, &spans, &self.included)
    }

    /// The place itself, or the same place in a variant (an entity of the file may have got the key from there).
    fn real_place(&self, spans: &Spans, place: &str) -> String {
        if spans.has(place) {
            return place.to_owned();
        }
        let merged = match place.strip_prefix("variants.") {
            Some(rest) => self
                .variant_names()
                .iter()
                .find_map(|name| rest.strip_prefix(name.as_str())?.strip_prefix('.').map(str::to_owned))
                .unwrap_or_else(|| place.to_owned()),
            None => place.to_owned(),
        };
        let found = std::iter::once(merged.clone())
            .chain(self.variant_names().iter().map(|name| format!("variants.{name}.{merged}")))
            .find(|candidate| spans.has(candidate));
        found.unwrap_or_else(|| place.to_owned())
    }

    pub(super) fn report(&self, faults: &[Fault]) -> Report {
        report(&self.file, &self.text, faults, &self.included)
    }

    pub(super) fn unknown_study(&self, name: &str) -> Fault {
        let known = self.study_names();
        let help = suggest::help(name, known.iter().map(String::as_str));
        let shown = format!("--study {name}");
        let start = shown.len() - name.len();
        Fault::new("unknown-study", String::new(), format!("unknown study `{name}`"), "a study of this file")
            .maybe_help(help)
            .at(Spot::Outside(shown.clone(), start..shown.len()))
    }
}

/// Most findings of one report.
const MOST_SHOWN: usize = 200;

/// Bytes as text; `most` of them are shown if they are none.
pub(super) fn text_of<'b>(bytes: &'b [u8], file: &str, most: usize) -> Result<&'b str, Report> {
    std::str::from_utf8(bytes).map_err(|error| {
        let good = error.valid_up_to();
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min(most)]);
        let fault = Fault::new("not-utf8", String::new(), format!("byte {} is not UTF-8", good + 1), "a text file in UTF-8")
            .at(Spot::Bytes(good..good + 1))
            .help("save the file as UTF-8");
        report(file, &text, &[fault], &[])
    })
}

/// A finding at its place, which may lie in an included file.
fn shown(fault: &Fault, file: &str, text: &str, spans: &Spans, included: &[Included]) -> Diagnostic {
    match include::find(included, &fault.place) {
        None => fault.diagnostic(file, text, spans),
        Some((inner, path)) => match inner.asked(path) {
            Some(place) => Fault { place, ..fault.clone() }.diagnostic(file, text, spans),
            None => inner.diagnostic(fault, path),
        },
    }
}

/// Findings in a text, each once.
pub(super) fn report(file: &str, text: &str, faults: &[Fault], included: &[Included]) -> Report {
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
        let mut more = Fault::new("more", String::new(), format!("{rest} more findings are not shown"), "");
        (more.warning, more.spot) = (warning, Spot::Nowhere);
        found.push(more.diagnostic(file, text, &spans));
    }
    Report::new(found)
}
