//! The expressions that a study watches: columns, what functionals are taken of, what only figures show.

use super::clock::{Clock, Variable};
use crate::expression::{Id, Switch};
use crate::model::{Functional, FunctionalKind, Model, Plot, Quantity, Shown, ShownWhat, Study};
use crate::numerics::extremum::Extremes;
use crate::numerics::resolve::{Open, Resolution, Resolved};
use crate::results::Finding;

/// Part of the range to which the place of what is not resolved is told.
const NEAR: f64 = 1e-6;

/// The distinct expressions to watch: columns, what functionals are taken of, what only figures show.
pub(crate) struct Watched {
    pub(crate) ids: Vec<Id>,
    /// Index in `ids` of each functional's argument.
    pub(crate) functionals: Vec<usize>,
    /// Index in `ids` of each column.
    pub(crate) columns: Vec<usize>,
    /// Index in `ids` of curves that figures show beyond the columns.
    pub(crate) shown: Vec<usize>,
}

impl Watched {
    /// What a column is that is watched for scalars or expectations, or for a figure, in words.
    fn asked(&self, model: &Model, study: &Study, column: usize) -> String {
        let functional = |&k: &usize| self.functionals[k] == column;
        let takes = |id: Id| {
            let inputs = model.pool.inputs_of(&[id]);
            inputs.iter().any(|&i| matches!(model.inputs[i as usize], Quantity::Functional(k) if functional(&k)))
        };
        let scalars = study.scalars.iter().filter(|s| takes(s.value)).map(|s| format!("`{}`", s.name));
        let names: Vec<String> = scalars.chain(study.expect.iter().filter(|e| takes(e.value)).map(|e| format!("`{}`", e.text))).collect();
        if !names.is_empty() {
            return format!("what {} is taken of", names.join(", "));
        }
        let shown = of_pictures(study).find(|shown| shown.what == ShownWhat::Column(self.ids[column]));
        shown.map_or_else(|| "what a figure shows".into(), |shown| format!("`{}`", shown.name))
    }

    /// What is not resolved and counts, with the name of each column that shows it: equal expressions are watched once.
    fn open<'a>(&'a self, study: &'a Study, resolved: &'a Resolved) -> impl Iterator<Item = (&'a Open, Option<&'a str>)> {
        // a value at a place does not depend on what is between
        let single = |f: &Functional| matches!(f.kind, FunctionalKind::Value | FunctionalKind::Last);
        let taken = move |column: usize| {
            self.shown.contains(&column) || self.functionals.iter().zip(&study.functionals).any(|(&c, f)| c == column && !single(f))
        };
        resolved.open.iter().flat_map(move |open| {
            let columns = study.columns.iter().zip(&self.columns).filter(|(_, c)| **c == open.column);
            let mut names: Vec<_> = columns.map(|(column, _)| (open, Some(column.name.as_str()))).collect();
            if names.is_empty() && taken(open.column) {
                names.push((open, None));
            }
            names
        })
    }

    /// How well a motion is resolved: as many columns are not as are told.
    pub(crate) fn quality(&self, study: &Study, resolved: &Resolved) -> Resolution {
        Resolution { open: self.open(study, resolved).count(), ..resolved.quality() }
    }

    pub(crate) fn of(study: &Study) -> Self {
        let mut ids: Vec<Id> = Vec::new();
        let mut index = |id: Id| {
            ids.iter().position(|x| *x == id).unwrap_or_else(|| {
                ids.push(id);
                ids.len() - 1
            })
        };
        let columns = study.columns.iter().map(|c| index(c.value)).collect();
        let functionals = study.functionals.iter().map(|f| index(f.of)).collect();
        let shown = extra_curves(study).into_iter().map(&mut index).collect();
        Self { ids, functionals, columns, shown }
    }
}

/// What figures and drawings show.
pub(crate) fn of_pictures(study: &Study) -> impl Iterator<Item = &Shown> + Clone {
    study.plots.iter().flat_map(Plot::all).chain(study.forces.iter().flat_map(|f| &f.components))
}

/// Expressions that only figures and drawings show, in the order in which [`Outcome::rows`](crate::studies::common::outcome::Outcome::rows) carries them behind the columns.
#[must_use]
pub fn extra_curves(study: &Study) -> Vec<Id> {
    let mut extra = Vec::new();
    for shown in of_pictures(study) {
        if let ShownWhat::Column(id) = shown.what
            && study.columns.iter().all(|c| c.value != id)
            && !extra.contains(&id)
        {
            extra.push(id);
        }
    }
    extra
}

/// Extremes by the independent variable instead of progress.
pub(crate) fn in_variable(mut e: Extremes, clock: Clock) -> Extremes {
    e.min.at = clock.value(e.min.at);
    e.max.at = clock.value(e.max.at);
    e
}

/// Why something is not resolved.
#[derive(PartialEq)]
enum Why {
    /// It grows without bound at a change point, within what is told of it.
    Pole(String),
    /// It cannot be computed next to a singular position.
    Singular,
    /// It varies too fast.
    Fast,
}

/// Names of which the same is to be said, with what it is and the first of what belongs to each.
pub(crate) fn together<K: PartialEq, T>(all: impl Iterator<Item = (String, K, T)>) -> Vec<(Vec<String>, K, T)> {
    let mut found: Vec<(Vec<String>, K, T)> = Vec::new();
    for (name, said, with) in all {
        match found.iter_mut().find(|(_, known, _)| *known == said) {
            Some((names, ..)) => names.push(name),
            None => found.push((vec![name], said, with)),
        }
    }
    found
}

/// Columns and switches that are not resolved within the effort that they are worth.
pub(crate) fn unresolved(
    model: &Model,
    study: &Study,
    watched: &Watched,
    resolved: &Resolved,
    switches: &[(usize, f64)],
    variable: Variable<'_>,
    clock: Clock,
) -> Vec<Finding> {
    let finding = |message: String| Finding { code: "unresolved".into(), message, path: study.place.clone() };
    let open = watched.open(study, resolved).map(|(open, column)| {
        let what = match column {
            Some(name) => format!("`{name}`"),
            None => watched.asked(model, study, open.column),
        };
        // a place is told as well as it is known
        let told = NEAR * clock.length;
        let at = variable.at((clock.value(open.at) / told).round() * told);
        let why = match (open.pole, open.singular) {
            (Some(reach), _) => Why::Pole(variable.told(reach)),
            (None, true) => Why::Singular,
            (None, false) => Why::Fast,
        };
        (what, (column.is_some(), at, why), ())
    });
    let columns = together(open).into_iter().map(|(names, (columns, at, why), ())| {
        let one = names.len() == 1;
        let what = match (columns, one) {
            (true, true) => format!("column {}", names[0]),
            (true, false) => format!("columns {}", names.join(", ")),
            (false, _) => names.join(", "),
        };
        finding(match why {
            Why::Pole(reach) => format!(
                "{what} {} without bound at the change point {at}: within {reach} of it a straight line was taken for extremes, means and integrals, which have no meaning there",
                if one { "grows" } else { "grow" }
            ),
            Why::Singular => format!(
                "{what} cannot be computed next to the singular position at {at}, which multiplies the errors of the state: a straight line was taken there for extremes, means and integrals"
            ),
            Why::Fast => format!(
                "{what} {} too fast or without bound near {at}: there {} extremes, means and integrals may be wrong",
                if one { "varies" } else { "vary" },
                if one { "its" } else { "their" }
            ),
        })
    });
    let switches = switches.iter().map(|&(switch, at)| {
        let what = model.pool.switches().get(switch).map_or_else(|| "the side of a guide".into(), Switch::told);
        finding(format!("{what} changes too often near {} to be followed: some of its changes may be missing", variable.at(at)))
    });
    columns.chain(switches).collect()
}
