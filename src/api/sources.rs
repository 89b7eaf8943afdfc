//! What a model was read from, so that it can be read again elsewhere.

use super::error::Error;
use crate::model::Document;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

/// A file that a model names, by the path it has there: its name for messages and its text, or why it could not be read.
type Named = (String, Result<(String, String), String>);

/// The texts of a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Sources {
    /// Name of the file, for messages.
    file: String,
    text: String,
    /// The files that it names, in the order in which they were asked for.
    files: Vec<Named>,
    /// Studies that were added, by their names with their YAML.
    added: Vec<(String, String)>,
}

impl Sources {
    /// Reads a model, and keeps what was read.
    ///
    /// # Errors
    /// If it is no model.
    pub(super) fn read(bytes: &[u8], file: &str, files: &crate::model::Files<'_>) -> Result<(Self, Document), Error> {
        let kept: RefCell<Vec<Named>> = RefCell::default();
        let read = |path: &str| {
            let found = files(path);
            let text = found.clone().and_then(|(name, bytes)| match String::from_utf8(bytes) {
                Ok(text) => Ok((name, text)),
                Err(_) => Err("it is no text (UTF-8)".to_owned()),
            });
            kept.borrow_mut().push((path.to_owned(), text));
            found
        };
        let document = Document::with_files(bytes, file, &read).map_err(Error::Wrong)?;
        let text = document.text().to_owned();
        Ok((Self { file: file.to_owned(), text, files: kept.into_inner(), added: Vec::new() }, document))
    }

    /// Reads the model again from its texts.
    ///
    /// # Errors
    /// If it is none.
    pub(super) fn document(&self) -> Result<Document, Error> {
        let found = |path: &str| {
            let known = self.files.iter().find(|(known, _)| known == path);
            let (_, found) = known.ok_or_else(|| "no files are read here".to_owned())?;
            found.clone().map(|(name, text)| (name, text.into_bytes()))
        };
        let mut document = Document::with_files(self.text.as_bytes(), &self.file, &found).map_err(Error::Wrong)?;
        for (name, yaml) in &self.added {
            document.add_study(name, yaml);
        }
        Ok(document)
    }

    /// Adds a study.
    pub(super) fn add(&mut self, name: &str, yaml: &str) {
        self.added.push((name.to_owned(), yaml.to_owned()));
    }
}
