//! A model file.

use super::error::Error;
use super::files::beside;
use super::mechanism::Mechanism;
use super::page::told;
use super::sources::Sources;
use super::stepper::Stepping;
use super::study::Study;
use crate::model::{self, Caller, Document, ExternalFunction, Selection};
use crate::output::{Report, ReportRuns, ReportStudy};
use crate::results::{Results, Scalar, Unknown};
use crate::studies::common::case::parameters;
use crate::studies::common::named;
use std::path::Path;
use std::sync::Arc;

/// A model file, with variants applied and parameters set: a mechanism, and studies of it.
#[derive(Clone, Debug)]
pub struct Model {
    sources: Arc<Sources>,
    document: Arc<Document>,
    selection: Selection<'static>,
}

impl Model {
    /// Reads a model file, and what it includes.
    ///
    /// # Errors
    /// If the file cannot be read, or is no model. What is wrong with the mechanism or a study is told by [`Self::check`], and when
    /// these are asked for.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let name = path.to_string_lossy();
        let bytes = std::fs::read(path).map_err(|cause| Error::Read { path: path.into(), cause })?;
        Ok(Self::of(Sources::read(&bytes, &name, &|included| beside(&name, included))?))
    }

    /// A model that stands in a text and includes no files.
    ///
    /// # Errors
    /// If it is no model.
    pub fn parse(text: &str) -> Result<Self, Error> {
        Ok(Self::of(Sources::read(text.as_bytes(), model::NO_FILE, &|_| Err("no files are read here".to_owned()))?))
    }

    fn of((sources, document): (Sources, Document)) -> Self {
        Self {
            sources: Arc::new(sources),
            document: Arc::new(document),
            selection: Selection { caller: Caller::Code, ..Selection::default() },
        }
    }

    /// All of the model as text, with the files that it names, to be read by [`Self::unpack`] in another process or on another machine.
    #[must_use]
    pub fn pack(&self) -> String {
        serde_json::json!({ "sources": *self.sources, "variants": self.selection.variants, "sets": self.selection.sets }).to_string()
    }

    /// The model that [`Self::pack`] gave as text.
    ///
    /// # Errors
    /// If it gave none.
    pub fn unpack(packed: &str) -> Result<Self, Error> {
        #[derive(serde::Deserialize)]
        struct Packed {
            sources: Sources,
            variants: Vec<String>,
            sets: Vec<(String, String)>,
        }
        let read = serde_json::from_str(packed).map_err(|why| Error::Refused {
            message: format!("this is no packed model: {why}"),
            help: "pack it with the same version of the program".into(),
        });
        let Packed { sources, variants, sets } = read?;
        let Self { sources, document, selection } = Self::of((sources.clone(), sources.document()?));
        Ok(Self { sources, document, selection: Selection { variants, sets, ..selection } })
    }

    /// The same with parameters at other values, given as in the file: `[("l3", "60 cm")]`, or as numbers in SI. They stand over what
    /// variants and studies say.
    ///
    /// # Errors
    /// If there is no such parameter, a value is none for it, or the model is wrong.
    pub fn set(&self, values: &[(&str, &str)]) -> Result<Self, Error> {
        let mut selection = self.selection.clone();
        for (name, value) in values {
            selection.sets.retain(|(known, _)| known != name);
            selection.sets.push(((*name).into(), (*value).into()));
        }
        self.selected(selection)
    }

    /// The same with a variant of the file, behind those of its studies.
    ///
    /// # Errors
    /// If there is no such variant, or the model is wrong with it.
    pub fn variant(&self, name: &str) -> Result<Self, Error> {
        let mut selection = self.selection.clone();
        selection.variants.push(name.into());
        self.selected(selection)
    }

    /// The same with functions from outside, in the place of those that it had: expressions may call them by their names. They stay
    /// behind where the model is packed.
    ///
    /// # Errors
    /// If a name is none or is not free, or a unit or switch cannot be read. What is wrong with a call is told as what is wrong with the
    /// model, which is not looked at here.
    pub fn with_functions(&self, functions: Vec<ExternalFunction>) -> Result<Self, Error> {
        if let Some((message, help)) = model::unfit(&functions) {
            return Err(Error::Refused { message, help });
        }
        Ok(Self { selection: Selection { externals: functions.into(), ..self.selection.clone() }, ..self.clone() })
    }

    fn selected(&self, selection: Selection<'static>) -> Result<Self, Error> {
        self.document.model(&selection).map_err(Error::Wrong)?;
        Ok(Self { selection, ..self.clone() })
    }

    /// The same with one more study, given as the YAML that it would have in the file (`statics: { from: start }`); and its name, which
    /// is the first of `name`, `name-2`, ... that no study has. What is wrong with it is told when it is run.
    #[must_use]
    pub fn with_study(&self, name: &str, yaml: &str) -> (Self, String) {
        let mut document = Document::clone(&self.document);
        let name = document.add_study(name, yaml);
        let mut sources = Sources::clone(&self.sources);
        sources.add(&name, yaml);
        (Self { sources: Arc::new(sources), document: Arc::new(document), selection: self.selection.clone() }, name)
    }

    /// The text of the file.
    #[must_use]
    pub fn text(&self) -> &str {
        self.document.text()
    }

    /// Names of the studies, in file order.
    #[must_use]
    pub fn studies(&self) -> Vec<String> {
        self.document.study_names()
    }

    /// Names of the variants, in file order.
    #[must_use]
    pub fn variants(&self) -> Vec<String> {
        self.document.variant_names()
    }

    /// The parameters with their values, SI, in file order.
    ///
    /// # Errors
    /// If the file is wrong.
    pub fn parameters(&self) -> Result<Vec<Scalar>, Error> {
        let model = self.document.model(&self.selection).map_err(Error::Wrong)?;
        Ok(named::parameters(&model, parameters(&model).into_iter()))
    }

    /// All faults of the model, of each of its variants and studies.
    #[must_use]
    pub fn check(&self) -> model::Report {
        self.document.check_all(&self.selection)
    }

    /// A study of the file.
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn study(&self, name: &str) -> Result<Study<'_>, Error> {
        let known = self.studies();
        if known.iter().any(|study| study == name) {
            return Ok(Study::new(&self.document, name, self.selection.clone()));
        }
        Err(Unknown { what: "study", name: name.into(), known }.into())
    }

    /// The mechanism at the values that the model gives, assembled at its start.
    ///
    /// # Errors
    /// If the file is wrong, or the mechanism cannot be assembled.
    pub fn mechanism(&self) -> Result<Mechanism, Error> {
        self.mechanism_with(&[])
    }

    /// [`Self::mechanism`] with parameters at other values, given as in the file: `[("l3", "60 cm")]`.
    ///
    /// # Errors
    /// As there.
    pub fn mechanism_with(&self, set: &[(&str, &str)]) -> Result<Mechanism, Error> {
        let mut selection = self.selection.clone();
        selection.sets.extend(set.iter().map(|(name, value)| ((*name).to_string(), (*value).to_string())));
        let model = self.document.model(&selection).map_err(Error::Wrong)?;
        Mechanism::new(model).map_err(|failure| Error::failed(&self.document, "", failure))
    }

    /// The motion of a study of the kind `dynamics`, to be advanced from outside by the integrator of the study.
    ///
    /// # Errors
    /// If the study is no motion in time or wrong, or does not begin.
    pub fn stepping(&self, study: &str) -> Result<Stepping, Error> {
        let known = self.studies();
        if !known.iter().any(|name| name == study) {
            return Err(Unknown { what: "study", name: study.into(), known }.into());
        }
        Stepping::new(&self.document, &Selection { study: Some(study), ..self.selection.clone() })
    }

    /// The page of a report on results of its studies, as the bytes of an HTML file that needs nothing else.
    #[must_use]
    pub fn report(&self, results: &[&Results]) -> Vec<u8> {
        let path = Path::new(self.document.file()).file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let mut report = told(&self.document, Some(&self.selection), path, Report::new);
        for results in results {
            let selection = Selection { study: Some(&results.study), ..self.selection.clone() };
            let study = self.document.model(&selection).ok().and_then(|model| model.study);
            report.add(&shown(results, study.as_ref().map_or("", |study| &study.about)));
        }
        report.html()
    }
}

/// What a page has of results; `about` says what they are for.
fn shown(results: &Results, about: &str) -> ReportStudy {
    if results.table.reasons.is_none() {
        return ReportStudy::of(results, about);
    }
    let mut runs = ReportRuns::new(results.runs.len());
    for (number, run) in results.runs.iter().enumerate() {
        run.results.iter().for_each(|results| runs.add(number, results));
    }
    ReportStudy::of_runs(results, about, runs)
}
