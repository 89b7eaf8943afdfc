//! A model file.

use super::error::Error;
use super::files::beside;
use super::mechanism::Mechanism;
use super::study::Study;
use crate::model::{Document, Report, Selection};
use crate::results::Unknown;
use std::path::Path;

/// A model file: a mechanism, and studies of it.
#[derive(Clone, Debug)]
pub struct Model {
    document: Document,
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
        let document = Document::with_files(&bytes, &name, &|included| beside(&name, included)).map_err(Error::Wrong)?;
        Ok(Self { document })
    }

    /// A model that stands in a text and includes no files.
    ///
    /// # Errors
    /// If it is no model.
    pub fn parse(text: &str) -> Result<Self, Error> {
        Ok(Self { document: Document::read(text, "<text>").map_err(Error::Wrong)? })
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

    /// All faults of the model, of each of its variants and studies.
    #[must_use]
    pub fn check(&self) -> Report {
        self.document.check_all(&Selection::default())
    }

    /// A study of the file.
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn study(&self, name: &str) -> Result<Study<'_>, Error> {
        let known = self.studies();
        if known.iter().any(|study| study == name) {
            return Ok(Study::new(&self.document, name));
        }
        Err(Unknown { what: "study", name: name.into(), known }.into())
    }

    /// The mechanism at the values that the file gives, assembled at its start.
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
        let sets = set.iter().map(|(name, value)| ((*name).to_string(), (*value).to_string())).collect();
        let model = self.document.model(&Selection { sets, ..Selection::default() }).map_err(Error::Wrong)?;
        Mechanism::new(model).map_err(|failure| Error::failed(&self.document, "", failure))
    }
}
