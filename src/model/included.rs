//! A file that a model includes.

use super::diagnostics::Diagnostic;
use super::fault::{Fault, Spot};
use super::spans::Spans;
use super::urdf::Translated;
use serde_yaml::{Mapping, Value};
use std::ops::Range;

/// A file that a model includes.
#[derive(Clone, Debug)]
pub(crate) struct Included {
    /// Its name for messages.
    pub(super) file: String,
    pub(super) text: String,
    pub(super) robot: Translated,
    /// Where the model asks for it: `include[0]`.
    pub(super) place: String,
}

/// The included file and the path in it that a place leads to.
pub(crate) fn find<'i, 'p>(included: &'i [Included], place: &'p str) -> Option<(&'i Included, &'p str)> {
    let (index, path) = place.strip_prefix("urdf[")?.split_once("].")?;
    Some((included.get(index.parse::<usize>().ok()?)?, path))
}

impl Included {
    /// Its entries, by section.
    pub(crate) fn sections(&self) -> &Mapping {
        &self.robot.sections
    }

    /// Bytes of the nearest entry that contains a path.
    fn at(&self, path: &str) -> Option<Range<usize>> {
        let mut path = path;
        loop {
            if let Some(range) = self.robot.places.get(path) {
                return Some(range.clone());
            }
            path = &path[..path.rfind(['.', '['])?];
        }
    }

    /// The place in the model whose value stands at a path, if the model gives it: `at` or `rpy`.
    pub(crate) fn asked(&self, path: &str) -> Option<String> {
        let base = self.robot.base.as_deref()?;
        [(format!("ground.{base}"), "at"), (format!("joints.{base}.rpy"), "rpy")].into_iter().find_map(|(head, key)| {
            let rest = path.strip_prefix(head.as_str()).filter(|rest| rest.is_empty() || rest.starts_with('['))?;
            Some(format!("{}.{key}{rest}", self.place))
        })
    }

    /// A finding at a path of this file.
    pub(crate) fn diagnostic(&self, fault: &Fault, path: &str) -> Diagnostic {
        let spot = self.at(path).map_or(Spot::Nowhere, Spot::Bytes);
        let spot = if matches!(fault.spot, Spot::Outside(..)) { fault.spot.clone() } else { spot };
        Fault { spot, other: None, ..fault.clone() }.diagnostic(&self.file, &self.text, &Spans::new(""))
    }

    /// What of the file is not used, or not as it stands: `robot.urdf:12: ...`.
    pub(crate) fn notes(&self, model: &Value) -> Vec<String> {
        let heavy = |body: &str| {
            let own = model.get("bodies").and_then(|bodies| bodies.get(body)).and_then(Value::as_mapping);
            own.is_some_and(|own| own.keys().filter_map(Value::as_str).any(|key| !["points", "drawn", "com", "fictitious"].contains(&key)))
        };
        self.robot.notes.sentences(&self.text, &heavy).into_iter().map(|(line, note)| format!("{}:{line}: {note}", self.file)).collect()
    }
}
