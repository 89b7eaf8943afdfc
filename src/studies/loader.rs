//! The model of a study, with the scalars that it takes from other studies.

use super::common::named::named;
use super::sweep::{Drawn, Settings, at, single, sweep, together};
use crate::model::{Beside, Document, Model, Plot, Report, Selection, ShownWhat, Study};
use crate::results::{Failure, Family, Results};
use std::collections::HashMap;

/// Loads models of studies of one document; studies from which others take are run once.
pub struct Loader<'d> {
    document: &'d Document,
    threads: usize,
    /// Numbers of the studies that were run for others.
    taken: HashMap<String, Vec<(String, f64)>>,
    /// Results of the studies that stand beside others in figures.
    beside: HashMap<String, Results>,
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
        Self { document, threads, taken: HashMap::new(), beside: HashMap::new() }
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

    /// The model of a selection as [`Self::model`] gives it, whose figures have the curves of the other studies that they name.
    ///
    /// # Errors
    /// As [`Self::model`], and if one of these studies does not begin, or lacks a curve.
    pub fn drawn(&mut self, selection: &Selection<'_>, stop: &(dyn Fn() -> bool + Sync)) -> Result<Model, NotLoaded> {
        let mut model = self.model(selection, stop)?;
        let Some(study) = &mut model.study else { return Ok(model) };
        let place = study.place.clone();
        for plot in &mut study.plots {
            for other in &plot.with {
                self.run_beside(selection, other, stop)?;
                let lacks = |why: String| {
                    let at = format!("{place}.plot.{}.with", plot.name);
                    let help = Some("name the curve in a figure or in the columns of that study, too".into());
                    NotLoaded::Wrong(Report::new(vec![self.document.diagnostic(
                        "no-column",
                        &at,
                        why,
                        "a study with the same curves",
                        help,
                    )]))
                };
                plot.beside.extend(curves(plot, &self.beside[other]).map_err(lacks)?);
            }
        }
        Ok(model)
    }

    /// Runs a study that stands beside another one, unless it was run for that.
    fn run_beside(&mut self, selection: &Selection<'_>, name: &str, stop: &(dyn Fn() -> bool + Sync)) -> Result<(), NotLoaded> {
        if self.beside.contains_key(name) {
            return Ok(());
        }
        let model = self.model(&Selection { study: Some(name), over: Vec::new(), ..selection.clone() }, stop)?;
        let Some(study) = &model.study else { return Ok(()) };
        let settings = Settings { threads: self.threads, drawn: Drawn::None, stop };
        let results = if study.sweep.is_empty() {
            let failed = |failure: Failure| NotLoaded::Failed { study: name.into(), failure };
            single(&model, study, at(&model, study, Vec::new(), settings, None, &|_, _| {})).map_err(failed)?
        } else {
            let runs = sweep(&model, study, settings, Vec::new(), &|_| true, &|_, _| {});
            together(&model, study, runs, &mut |_, _| {})
        };
        self.beside.insert(name.into(), results);
        Ok(())
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

/// The curves of a figure as another study has them.
///
/// # Errors
/// Which one it has not, in words.
fn curves(plot: &Plot, other: &Results) -> Result<Vec<Beside>, String> {
    let column = |results: &Results, name: &str| -> Option<Vec<f64>> {
        results
            .column(name)
            .ok()
            .map(<[f64]>::to_vec)
            .or_else(|| (results.independent.name == name).then(|| results.independent.values.clone()))
    };
    let of_runs = plot.all().any(|shown| !matches!(shown.what, ShownWhat::Column(_)));
    let runs: Vec<(String, &Results)> = match &other.table.reasons {
        Some(_) if !of_runs => other.runs.iter().filter_map(|run| Some((format!(", {}", run.label), run.results.as_deref()?))).collect(),
        _ => vec![(String::new(), other)],
    };
    let mut all = Vec::new();
    for (label, results) in runs {
        let x = match &plot.over {
            Some(over) => column(results, &over.name).ok_or_else(|| format!("study `{}` has no `{}`", other.study, over.name))?,
            None if of_runs => results.table.columns.first().map(|c| c.values.clone()).unwrap_or_default(),
            None => results.independent.values.clone(),
        };
        let (families, measured) = if of_runs { other.families(plot.over.as_ref().map(|over| over.name.as_str())) } else { one(x.len()) };
        for shown in plot.show.iter().chain(plot.right.iter().flat_map(|(show, _)| show)) {
            let y = column(results, &shown.name).ok_or_else(|| format!("study `{}` has no `{}`", other.study, shown.name))?;
            for family in &families {
                let points = family.rows.iter().filter_map(|row| Some((*x.get(*row)?, *y.get(*row)?))).collect();
                let of_family = if family.label.is_empty() { String::new() } else { format!(", {}", family.label) };
                let label = format!("{}, {}{label}{of_family}", shown.name, other.study);
                all.push(Beside { label, of: shown.name.clone(), points, measured });
            }
        }
    }
    Ok(all)
}

/// All rows of a table as one curve.
fn one(rows: usize) -> (Vec<Family>, bool) {
    (vec![Family { label: String::new(), rows: (0..rows).collect() }], false)
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
