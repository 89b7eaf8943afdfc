//! A model file in memory, and the models that can be made of it.

use super::asked::{Asked, Caller};
use super::data::DataFiles;
use super::diagnostics::{Diagnostic, Report};
use super::fault::Fault;
use super::files::Files;
use super::idle;
use super::include;
use super::included::{Included, find};
use super::merge::Node;
use super::reading::{BYTE_ORDER, report, shown, text_of};
use super::spans::Spans;
use super::study::Samples;
use super::suggest;
use super::yaml;
use crate::expression::ExternalFunction;
use serde_yaml::{Mapping, Value};
use std::sync::Arc;

/// What is asked of a model file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection<'a> {
    /// The study that the model is merged for.
    pub study: Option<&'a str>,
    /// Variants from outside, applied after those of the study.
    pub variants: Vec<String>,
    /// Parameters from outside, as name and value; over everything.
    pub sets: Vec<(String, String)>,
    /// Sweeps from outside, in place of the study's own: parameter, and `FROM..TO:COUNT` (with `:log` for equal ratios), a list, or a
    /// distribution, `normal(MEAN, DEVIATION)` or `uniform(FROM, TO)`.
    pub over: Vec<(String, String)>,
    /// How many points are drawn from the distributions in `over`.
    pub samples: Option<Samples>,
    /// Functions from outside that expressions may call.
    pub externals: Arc<[ExternalFunction]>,
    /// Who asks.
    pub caller: Caller,
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
    /// Measured data that its figures name.
    pub(super) data: DataFiles,
    /// Names of studies that do not stand in the text.
    added: Vec<String>,
}

impl Document {
    /// Reads a model file that includes no others; `file` is its name for messages. Nothing but its YAML is judged yet.
    ///
    /// # Errors
    /// What is not YAML, or is YAML that the format refuses (aliases, tags, two documents, more than 8 MiB, ...).
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
        let text = text.strip_prefix(BYTE_ORDER).unwrap_or(text);
        let root = yaml::read(text).map_err(|faults| report(file, text, &faults, &[]))?;
        let included = include::read(&root, file, text, files)?;
        let data = DataFiles::read(&root, files);
        Ok(Self { root: Value::Mapping(root), file: file.to_owned(), text: text.to_owned(), included, data, added: Vec::new() })
    }

    /// What of included files the model does not use, or not as it stands, one sentence each with its file and line.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.included.iter().flat_map(|included| included.notes(&self.root)).collect()
    }

    /// Parameters that no expression of the file names, in file order.
    #[must_use]
    pub fn unused_parameters(&self) -> Vec<String> {
        self.root.as_mapping().map(idle::without_effect).unwrap_or_default()
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

    /// Number of moving bodies that the file names.
    #[must_use]
    pub fn body_count(&self) -> usize {
        self.named("bodies").len()
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
        self.added.push(free.clone());
        free
    }

    pub(super) fn study_node(&self, name: &str) -> Option<Node<'_>> {
        let node = Node::Plain(self.root.get("studies")?).get(name)?;
        node.is_map().then_some(node)
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
        let place = if find(&self.included, place).is_some() { place.to_owned() } else { self.real_place(&spans, place) };
        let mut found = shown(&Fault::new(code, place, message, expected).maybe_help(help), &self.file, &self.text, &spans, &self.included);
        self.leave_out_lines(&mut found);
        found
    }

    /// Leaves out the lines of what is found in a study that does not stand in the text.
    fn leave_out_lines(&self, found: &mut Diagnostic) {
        let study = found.place.strip_prefix("studies.").and_then(|rest| rest.split(['.', '[']).next());
        if study.is_some_and(|study| self.added.iter().any(|added| added == study)) {
            (found.at, found.other) = (None, None);
        }
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
        let mut report = report(&self.file, &self.text, faults, &self.included);
        report.diagnostics.iter_mut().for_each(|found| self.leave_out_lines(found));
        report
    }

    pub(super) fn unknown_study(&self, name: &str, caller: Caller) -> Fault {
        let known = self.study_names();
        let help = suggest::help(name, known.iter().map(String::as_str));
        Fault::new("unknown-study", String::new(), format!("unknown study `{name}`"), "a study of this file")
            .maybe_help(help)
            .at(caller.given(Asked::Study, name).end(name.len()))
    }
}
