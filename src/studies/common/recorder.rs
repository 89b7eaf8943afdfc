//! The rows of a run: kept, or passed on as they are computed.

use super::case::Case;
use super::clock::Clock;
use super::named::column;
use super::watched::Watched;
use crate::expression::Dimension;
use crate::results::{Column, Finding, Rows};

/// Takes the rows of a run in order.
pub(crate) struct Recorder<'a> {
    case: Case<'a>,
    clock: Clock,
    /// What findings call the independent variable.
    symbol: &'a str,
    /// Which of the watched expressions are shown: the columns, then the curves of figures.
    shown: Vec<usize>,
    /// Progress of each row, never falling.
    pub(crate) progress: Vec<f64>,
    /// Piece of each row.
    pub(crate) pieces: Vec<usize>,
    /// What is shown in each row; nothing where a sink takes the rows.
    rows: Rows,
    /// Of each column the number of rows in which it is not defined, and where it was so first.
    blank: Vec<(usize, f64)>,
}

/// The rows that were kept.
pub(crate) struct Recorded {
    /// The independent variable of each.
    pub(crate) places: Vec<f64>,
    /// Rows before each switch.
    pub(crate) switches: Vec<usize>,
    pub(crate) rows: Rows,
}

impl<'a> Recorder<'a> {
    /// Before the rows over the independent variable `name`, which findings call by its `symbol`.
    pub(crate) fn new(case: Case<'a>, watched: &Watched, clock: Clock, [name, symbol]: [&'a str; 2]) -> Self {
        let shown: Vec<usize> = watched.columns.iter().chain(&watched.shown).copied().collect();
        let study = case.study;
        if let Some(sink) = case.sink {
            let columns: Vec<Column> = study.columns.iter().map(|c| column(case.model, &c.name, c.dimension, Vec::new())).collect();
            sink.begin(&column(case.model, name, study.independent.unwrap_or(Dimension::NONE), Vec::new()), &columns);
        }
        let (rows, blank) = (Rows::new(shown.len()), vec![(0, 0.0); study.columns.len()]);
        Self { case, clock, symbol, shown, progress: Vec::new(), pieces: Vec::new(), rows, blank }
    }

    /// A row at some progress in a piece, with the values of all that is watched.
    pub(crate) fn row(&mut self, progress: f64, piece: usize, watched: &[f64]) {
        let place = self.clock.value(progress);
        let shown = self.shown.iter().map(|&c| watched[c]);
        for (blank, _) in self.blank.iter_mut().zip(shown.clone()).filter(|(_, value)| !value.is_finite()) {
            *blank = (blank.0 + 1, if blank.0 == 0 { place } else { blank.1 });
        }
        self.progress.push(progress);
        self.pieces.push(piece);
        match self.case.sink {
            Some(sink) => sink.row(place, &shown.take(self.blank.len()).collect::<Vec<_>>()),
            None => self.rows.push(shown),
        }
    }

    /// Columns with blank cells that the study does not name as such.
    pub(crate) fn findings(&self) -> Vec<Finding> {
        let study = self.case.study;
        let columns = study.columns.iter().zip(&self.blank);
        let blank = columns.filter(|(c, (count, _))| *count > 0 && !study.undefined.contains(&c.value));
        let finding = |(column, (count, first)): (&crate::model::Column, &(usize, f64))| Finding {
            code: "blank-cells".into(),
            message: format!(
                "`{}` is not defined in {count} of {} rows, first at {} = {}: its cells are blank there",
                column.name,
                self.progress.len(),
                self.symbol,
                (first * 1e6).round() / 1e6 + 0.0
            ),
            path: format!("{}.columns", study.place),
        };
        blank.map(finding).collect()
    }

    /// What was kept.
    pub(crate) fn recorded(self) -> Recorded {
        if self.case.sink.is_some() {
            return Recorded { places: Vec::new(), switches: Vec::new(), rows: self.rows };
        }
        let switches = (1..self.pieces.len()).filter(|&i| self.pieces[i - 1] != self.pieces[i]).map(|i| i - 1).collect();
        Recorded { places: self.progress.iter().map(|s| self.clock.value(*s)).collect(), switches, rows: self.rows }
    }
}
