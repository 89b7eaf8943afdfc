//! The model of a study, with the scalars that it takes from other studies.

use super::common::named::named;
use super::sweep::{Drawn, Settings, at};
use crate::model::{Document, Model, Report, Selection, Study};
use crate::results::{Failure, Results};
use std::collections::HashMap;

/// Loads models of studies of one document; studies from which others take are run once.
pub struct Loader<'d> {
    document: &'d Document,
    threads: usize,
    /// Numbers of the studies that were run for others.
    taken: HashMap<String, Vec<(String, f64)>>,
}

/// Why a study has no model.
#[derive(Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum NotLoaded {
    /// The file, or what is asked of it, is wrong.
    Wrong(Report),
    /// A study from which it takes has no result.
    Failed { study: String, failure: Failure },
    /// `study` takes from a study that stopped on its way.
    Stopped { study: String, of: String, reason: String },
}

impl<'d> Loader<'d> {
    /// For a document; studies from which others take are run by so many threads.
    #[must_use]
    pub fn new(document: &'d Document, threads: usize) -> Self {
        Self { document, threads, taken: HashMap::new() }
    }

    /// The model of a selection; a study in it gets what it takes. `stop` is asked while other studies run.
    ///
    /// # Errors
    /// If the file is wrong, or a study from which it takes has no whole result.
    pub fn model(&mut self, selection: &Selection<'_>, stop: &(dyn Fn() -> bool + Sync)) -> Result<Model, NotLoaded> {
        let study = selection.study.unwrap_or_default();
        let mut model = self.document.model(selection).map_err(NotLoaded::Wrong)?;
        let takes = model.study.as_ref().map(|s| s.take.clone()).unwrap_or_default();
        let mut taken = Vec::new();
        for take in &takes {
            if !self.taken.contains_key(&take.study) {
                let numbers = self.numbers(&Selection { study: Some(&take.study), over: Vec::new(), ..selection.clone() }, study, stop)?;
                self.taken.insert(take.study.clone(), numbers);
            }
            taken.push(number(&self.taken[&take.study], &take.scalar));
        }
        if !taken.is_empty() {
            model.give(&taken);
        }
        Ok(model)
    }

    /// Runs a study for its scalars, from which study `of` takes.
    fn numbers(&mut self, selection: &Selection<'_>, of: &str, stop: &(dyn Fn() -> bool + Sync)) -> Result<Vec<(String, f64)>, NotLoaded> {
        let model = self.model(selection, stop)?;
        let Some(study) = &model.study else { return Ok(Vec::new()) };
        let failed = |failure: Failure| NotLoaded::Failed { study: study.name.clone(), failure };
        let settings = Settings { threads: self.threads, drawn: Drawn::None, stop };
        let outcome = at(&model, study, Vec::new(), settings, None, &|_, _| {}).result.map_err(failed)?;
        if let Some(reason) = &outcome.stopped {
            return Err(NotLoaded::Stopped { study: of.into(), of: study.name.clone(), reason: reason.clone() });
        }
        Ok(numbers(&named(&model, study, *outcome)))
    }
}

/// Gives a model what its study takes, as far as the studies that it takes from are quickly computed; none if they are not.
///
/// # Errors
/// Why there is nothing to take, in words.
pub fn quickly(document: &Document, selection: &Selection<'_>) -> Result<Option<Model>, String> {
    let Ok(mut model) = document.model(selection) else { return Ok(None) };
    let takes = model.study.as_ref().map(|study| study.take.clone()).unwrap_or_default();
    let mut taken = Vec::new();
    for take in &takes {
        let Some(other) = quickly(document, &Selection { study: Some(&take.study), ..selection.clone() })? else { return Ok(None) };
        let Some(asked) = &other.study else { return Ok(None) };
        if !is_quick(asked) {
            return Ok(None);
        }
        let hindered = |why: &str| format!("study `{}` takes a scalar of `{}`: {why}", selection.study.unwrap_or_default(), take.study);
        let settings = Settings { threads: 1, drawn: Drawn::None, stop: &|| false };
        let outcome = at(&other, asked, Vec::new(), settings, None, &|_, _| {}).result.map_err(|failure| hindered(&failure.reason()))?;
        if let Some(why) = &outcome.stopped {
            return Err(hindered(why));
        }
        taken.push(number(&numbers(&named(&other, asked, *outcome)), &take.scalar));
    }
    if !taken.is_empty() {
        model.give(&taken);
    }
    Ok(Some(model))
}

/// Whether a study is one run without a motion in time.
fn is_quick(study: &Study) -> bool {
    use crate::model::Kind::{Dynamics, Periodic};
    study.sweep.is_empty() && study.solve.is_none() && !matches!(study.kind, Dynamics(_) | Periodic(_))
}

/// What other studies can take from one.
fn numbers(results: &Results) -> Vec<(String, f64)> {
    results.scalars.iter().map(|s| (s.name.clone(), s.value)).collect()
}

fn number(of: &[(String, f64)], name: &str) -> f64 {
    of.iter().find(|(known, _)| known == name).map_or(f64::NAN, |(_, value)| *value)
}
