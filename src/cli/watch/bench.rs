//! The bench: studies that are out of date are computed, the one in view first, and given up when they are out of date again.

use super::super::interrupt::interrupted;
use super::super::{Common, files, report};
use super::board::Board;
use super::entry::Computed;
use grashof::api::explained;
use grashof::model::{Document, Model, Report, Study};
use grashof::output::{ReportRuns, ReportStudy};
use grashof::par;
use grashof::results::{Column, Failure, Results, Sink};
use grashof::studies::common::case::Streamed;
use grashof::studies::loader::{Loader, NotLoaded};
use grashof::studies::sweep::{Drawn, Run, Settings, at, single, sweep, together};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Numbers that are kept of the rows of a motion, for its figures.
const KEPT: usize = 1_000_000;

/// What a page takes to draw a study, and how often is looked meanwhile whether it is out of date.
const DRAWING: Duration = Duration::from_millis(120);
const LOOK: Duration = Duration::from_millis(5);

/// Rows that go nowhere: the page has those that its figures need.
struct Nowhere;

impl Sink for Nowhere {
    fn begin(&self, _: &Column, _: &[Column]) {}

    fn row(&self, _: f64, _: &[f64]) {}
}

/// Begins to compute, in a thread of its own.
pub(super) fn begin(board: Arc<Board>) -> bool {
    par::background("bench", move || {
        while !interrupted() {
            let (of, document) = board.wait_for_work();
            match &document {
                Ok(document) => all(&board, of, document),
                // the file was sound without the values that were moved: numbers alone do not change that
                Err(report) => nothing(&board, of, report),
            }
        }
    })
}

/// No study can be computed.
fn nothing(board: &Board, of: u64, report: &Report) {
    while let Some(name) = board.next(of) {
        board.put(of, &name, Some(Computed { report: report.clone(), bad: true, ..Computed::default() }));
    }
}

/// Computes studies until there is no more to be done, or all is out of date.
fn all(board: &Board, of: u64, document: &Document) {
    let mut loader = Loader::new(document, board.common.threads());
    let mut first = true;
    while let Some(name) = board.next(of) {
        let stop = || board.is_stale(of) || interrupted();
        let computed = Bench { board, document, stop: &stop }.study(&mut loader, &name);
        board.put(of, &name, (!stop()).then(|| computed.unwrap_or_default()));
        if !std::mem::replace(&mut first, false) {
            continue;
        }
        leave_processors(&stop);
        if let Some(selection) = files::selection(&board.common, None) {
            board.put_findings(of, &document.check_all(&selection));
            // of a model with errors there is nothing to know
            if let Some(head) = report::model_json(document, &board.common) {
                board.put_head(of, head);
            }
        }
    }
}

/// Waits while a page draws the study in view, which it should not have to share the processors for.
fn leave_processors(stop: &dyn Fn() -> bool) {
    let until = Instant::now() + DRAWING;
    while Instant::now() < until && !stop() {
        std::thread::sleep(LOOK);
    }
}

struct Bench<'a> {
    board: &'a Board,
    document: &'a Document,
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl Bench<'_> {
    fn common(&self) -> &Common {
        &self.board.common
    }

    fn settings(&self) -> Settings<'_> {
        Settings { threads: self.common().threads(), drawn: Drawn::All, stop: self.stop }
    }

    /// What came of a study; none if the file has it no more.
    fn study(&self, loader: &mut Loader<'_>, name: &str) -> Option<Computed> {
        let selection = files::selection(self.common(), Some(name))?;
        let mut model = match loader.drawn(&selection, self.stop) {
            Ok(model) => model,
            Err(why) => return Some(wrong(self.not_loaded(name, why))),
        };
        if let Some(parameter) = model.set_and_varied() {
            let message = format!("study `{name}` varies `{parameter}`, which `--set` fixes: it is not computed");
            return Some(wrong(self.told(name, message, "leave the parameter to the study")));
        }
        let moved = {
            let mut state = self.board.lock();
            if let Some(study) = &model.study {
                state.values.note(&model, study);
            }
            state.values.are_moved()
        };
        let study = model.study.as_mut()?;
        // what a file expects of its own values says nothing of others
        if moved || self.common().changes().is_some() {
            study.expect.clear();
        }
        let study = study.clone();
        let about = study.about.split_whitespace().collect::<Vec<_>>().join(" ");
        let computed = if study.sweep.is_empty() { self.single(&model, &study) } else { self.sweep(&model, &study) };
        Some(Computed { about, ..computed })
    }

    fn single(&self, model: &Model, study: &Study) -> Computed {
        let rows = Some(Streamed { sink: &Nowhere, keep: KEPT });
        let run = at(model, study, Vec::new(), self.settings(), rows, &|_, _| {});
        match single(model, study, run) {
            Ok(results) => {
                let json = ReportStudy::of(&results, &study.about).json().to_string();
                Computed { json: Some(json), bad: is_bad(&results), ..Computed::default() }
            }
            Err(failure) => wrong(explained(self.document, &study.name, &failure)),
        }
    }

    fn sweep(&self, model: &Model, study: &Study) -> Computed {
        let runs = sweep(model, study, self.settings(), Vec::new(), &|_| true, &|_, _| {});
        if let Some(failure) = none_began(&runs) {
            return wrong(explained(self.document, &study.name, failure));
        }
        let mut pages = ReportRuns::new(runs.len());
        let mut bad = false;
        let results = together(model, study, runs, &mut |i, run| {
            pages.add(i, run);
            bad |= run.expectations.iter().any(|e| !e.met);
        });
        let json = ReportStudy::of_runs(&results, &study.about, pages).json().to_string();
        Computed { json: Some(json), bad, ..Computed::default() }
    }

    fn not_loaded(&self, name: &str, why: NotLoaded) -> Report {
        match why {
            NotLoaded::Wrong(report) => report,
            NotLoaded::Failed { study, failure } => explained(self.document, &study, &failure),
            NotLoaded::Stopped { study, of, reason } => {
                let message = format!("study `{study}` takes a scalar of `{of}`, which stopped on its way: {reason}");
                self.told(name, message, "see to that study first")
            }
        }
    }

    /// A report of one finding about a study.
    fn told(&self, name: &str, message: String, help: &str) -> Report {
        Report::new(vec![self.document.diagnostic("not-computed", &format!("studies.{name}"), message, "", Some(help.into()))])
    }
}

/// The reason of the first run, if none has begun.
fn none_began(runs: &[Run]) -> Option<&Failure> {
    let began = runs.iter().any(|run| run.result.is_ok());
    runs.first().filter(|_| !began).and_then(|run| run.result.as_ref().err())
}

fn is_bad(results: &Results) -> bool {
    results.stopped.is_some() || results.expectations.iter().any(|e| !e.met)
}

fn wrong(report: Report) -> Computed {
    Computed { report, bad: true, ..Computed::default() }
}
