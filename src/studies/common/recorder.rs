//! The rows of a run: kept, or passed on as they are computed.

use super::case::{Case, Streamed};
use super::clock::{Clock, Variable};
use super::named::{column, column_of};
use super::selection::Selection;
use super::watched::{Watched, together};
use crate::expression::Dimension;
use crate::results::{Column, Finding, Rows};

/// Takes the rows of a run in order.
pub(crate) struct Recorder<'a> {
    case: Case<'a>,
    clock: Clock,
    /// What findings call the independent variable.
    variable: Variable<'a>,
    /// Which of the watched expressions are shown: the columns, then the curves of figures.
    shown: Vec<usize>,
    /// What is shown in each row, of rows that are passed on as far as it is to be kept.
    kept: Selection,
    /// Of each column the rows in which it is not defined.
    blank: Vec<Blank>,
}

/// Rows in which a column is not defined.
#[derive(Clone, Copy, Default)]
struct Blank {
    count: usize,
    /// Where it was so first.
    first: f64,
    /// A number that the same rows give, and others do not.
    rows: u64,
}

/// The rows that were kept.
pub(crate) struct Recorded {
    /// The independent variable of each.
    pub(crate) places: Vec<f64>,
    /// Rows before each switch.
    pub(crate) switches: Vec<usize>,
    pub(crate) rows: Rows,
    /// How many rows they were selected from; none if these are all, or if none was to be kept.
    pub(crate) selected_from: Option<usize>,
}

impl<'a> Recorder<'a> {
    /// Before the rows over an independent variable, whose column has a `name`.
    pub(crate) fn new(case: Case<'a>, watched: &Watched, clock: Clock, name: &str, variable: Variable<'a>) -> Self {
        let study = case.study;
        if let Some(Streamed { sink, .. }) = case.rows {
            let columns: Vec<Column> =
                study.columns.iter().map(|c| column_of(case.model, study, (&c.name, c.dimension, c.value), Vec::new())).collect();
            sink.begin(&column(case.model, name, study.independent.unwrap_or(Dimension::NONE), Vec::new()), &columns);
        }
        let shown: Vec<usize> = match case.rows {
            Some(Streamed { keep: 0, .. }) => watched.columns.clone(),
            _ => watched.columns.iter().chain(&watched.shown).copied().collect(),
        };
        let kept = match case.rows {
            None => Selection::new(shown.len(), usize::MAX),
            // places alone
            Some(Streamed { keep: 0, .. }) => Selection::new(0, PLACES),
            Some(Streamed { keep, .. }) => Selection::new(shown.len(), keep),
        };
        Self { case, clock, variable, shown, kept, blank: vec![Blank::default(); study.columns.len()] }
    }

    /// A row at some progress in a piece, with the values of all that is watched.
    pub(crate) fn row(&mut self, progress: f64, piece: usize, watched: &[f64]) {
        let place = self.clock.value(progress);
        let shown = self.shown.iter().map(|&c| watched[c]);
        let number = self.kept.count() as u64 + 1;
        for (blank, _) in self.blank.iter_mut().zip(shown.clone()).filter(|(_, value)| !value.is_finite()) {
            let first = if blank.count == 0 { place } else { blank.first };
            // 2⁶⁴ over the golden ratio spreads numbers over all bits
            let rows = blank.rows.rotate_left(5) ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            *blank = Blank { count: blank.count + 1, first, rows };
        }
        if let Some(Streamed { sink, .. }) = self.case.rows {
            sink.row(place, &shown.clone().take(self.blank.len()).collect::<Vec<_>>());
        }
        let keeps = !matches!(self.case.rows, Some(Streamed { keep: 0, .. }));
        self.kept.push(progress, piece, shown.take(if keeps { usize::MAX } else { 0 }));
    }

    /// Number of rows.
    pub(crate) fn count(&self) -> usize {
        self.kept.count()
    }

    /// Progress and piece of about `count` of the kept rows, evenly chosen.
    pub(crate) fn some_places(&self, count: usize) -> impl Iterator<Item = (f64, usize)> + '_ {
        let places = self.kept.places();
        let every = (places.len() / count).max(1);
        places.step_by(every)
    }

    /// Columns with blank cells that the study does not name as such, those with the same blank rows together.
    pub(crate) fn findings(&self) -> Vec<Finding> {
        let study = self.case.study;
        let columns = study.columns.iter().zip(&self.blank);
        let blank = columns.filter(|(c, blank)| blank.count > 0 && !study.undefined.contains(&c.value));
        let all = together(blank.map(|(column, blank)| (format!("`{}`", column.name), (blank.count, blank.rows), blank.first)));
        let finding = |(names, (count, _), first): (Vec<String>, (usize, u64), f64)| Finding {
            code: "blank-cells".into(),
            message: format!(
                "{} {} not defined in {count} of {} rows, first at {}: {} cells are blank there",
                names.join(", "),
                if names.len() == 1 { "is" } else { "are" },
                self.count(),
                self.variable.at(first),
                if names.len() == 1 { "its" } else { "their" }
            ),
            path: format!("{}.columns", study.place),
        };
        all.into_iter().map(finding).collect()
    }

    /// What was kept.
    pub(crate) fn recorded(self) -> Recorded {
        if matches!(self.case.rows, Some(Streamed { keep: 0, .. })) {
            return Recorded { places: Vec::new(), switches: Vec::new(), rows: Rows::new(self.shown.len()), selected_from: None };
        }
        let (pieces, places): (Vec<usize>, Vec<f64>) = self.kept.places().map(|(s, piece)| (piece, self.clock.value(s))).unzip();
        // of a switch that is left out of a selection no side is next to the other
        let whole = !self.kept.is_partial();
        let is_switch = |i: usize| pieces[i - 1] != pieces[i] && (whole || places[i - 1] == places[i]);
        let switches = (1..pieces.len()).filter(|&i| is_switch(i)).map(|i| i - 1).collect();
        let selected_from = self.kept.is_partial().then(|| self.kept.count());
        Recorded { places, switches, rows: self.kept.into_rows(), selected_from }
    }
}

/// Most places that are kept where values are not.
const PLACES: usize = 1 << 16;
