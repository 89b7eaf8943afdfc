//! One study from model to files.

use super::progress::{Progress, interrupted};
use super::{Common, code, figures, files, report, tell};
use grashof::analysis::outcome::{Failure, Outcome};
use grashof::analysis::run::run;
use grashof::analysis::sweep::{self, Run};
use grashof::mechanism::Coordinates;
use grashof::model::{Document, Kind, Model, Report, Study};
use grashof::output::{Picture, Staging, write_csv};
use grashof::par;
use std::path::Path;

/// A study to run, and where its results go.
pub(super) struct Job<'a> {
    pub(super) document: &'a Document,
    pub(super) model: &'a Model,
    pub(super) study: &'a str,
    pub(super) studies: &'a [String],
    pub(super) directory: &'a Path,
    pub(super) plots: bool,
    pub(super) common: &'a Common,
}

/// What came of it.
pub(super) struct Finished {
    pub(super) code: u8,
    /// None if nothing was computed.
    pub(super) output: Option<Output>,
}

/// What is printed of a study.
pub(super) struct Output {
    /// Scalars for stdout.
    pub(super) table: String,
    /// The text of the JSON report, as in its file.
    pub(super) report: String,
    /// Columns with their units.
    pub(super) columns: Vec<(String, String)>,
}

impl Job<'_> {
    /// Runs, writes and reports; faults have been printed.
    pub(super) fn run(&self) -> Finished {
        let nothing = |code| Finished { code, output: None };
        let Some(study) = &self.model.study else { return nothing(code::INPUT) };
        if let Some(failure) = later(study) {
            self.explain(&failure);
            return nothing(code::INPUT);
        }
        if study.sweep.is_empty() { self.single(study) } else { self.sweep(study) }
    }

    /// A study of one run.
    fn single(&self, study: &Study) -> Finished {
        let outcome = match run(self.model, study, &sweep::parameters(self.model), Coordinates::Joint, &interrupted) {
            Ok(outcome) => outcome,
            Err(failure) => {
                let code = self.explain(&failure);
                return Finished { code, output: None };
            }
        };
        let mut code = code::DONE;
        if let Some(reason) = &outcome.stopped {
            let message = format!("study `{}` stopped on its way: {reason}", self.study);
            let help = match study.kind {
                Kind::Dynamics(_) => "what was computed up to there is kept; look at its last rows",
                _ => "start elsewhere, change the lengths, or give a shorter range",
            };
            if interrupted() {
                tell(&message);
            } else {
                self.tell_at("stopped", &study.place, message, help);
            }
            code = if interrupted() { code::INTERRUPTED } else { code::NUMERICAL };
        } else {
            code = code.max(self.expectations(&outcome));
        }
        let table = report::rows(self.model, study, &outcome);
        let mut staging = Staging::new();
        staging.add(format!("{}.csv", self.study), write_csv(&table));
        let report = report::json(self.model, study, &outcome);
        staging.add(format!("{}.json", self.study), report.clone());
        if self.plots {
            self.draw(&mut staging, figures::figures(self.model, study, &[(None, &outcome)]), &outcome);
        }
        let output = Output {
            table: report::summary(self.model, study, &outcome),
            report,
            columns: table.columns.iter().map(|c| (c.name.clone(), c.unit.clone())).collect(),
        };
        self.write(&staging, code, output)
    }

    /// A sweep.
    fn sweep(&self, study: &Study) -> Finished {
        let count = sweep::grid(self.model, study).len();
        let progress = Progress::new(self.study, count, self.common.quiet);
        let runs: Vec<Run> = sweep::sweep(self.model, study, self.common.threads(), interrupted, || progress.step());
        drop(progress);
        if interrupted() {
            return Finished { code: code::INTERRUPTED, output: None };
        }
        // rows that failed for a stated reason are results, unless there is no other
        if runs.iter().all(|r| r.result.is_err()) {
            if let Some(Err(failure)) = runs.first().map(|r| &r.result) {
                self.explain(failure);
            }
            tell(&format!("error: none of the {count} runs of study `{}` began\n  help: the first reason stands above", self.study));
            return Finished { code: code::NUMERICAL, output: None };
        }
        let mut code = code::DONE;
        if runs.iter().all(|r| r.result.as_ref().map_or(true, |o| o.stopped.is_some())) {
            tell(&format!("error: no run of study `{}` got through its range\n  help: the reasons stand in its last column", self.study));
            code = code::NUMERICAL;
        }
        for outcome in runs.iter().filter_map(|r| r.result.as_ref().ok()) {
            code = code.max(self.expectations(outcome));
        }
        let mut staging = Staging::new();
        let table = report::sweep_rows(self.model, study, &runs);
        staging.add(format!("{}.csv", self.study), write_csv(&table));
        let report = report::sweep_json(self.model, study, &runs);
        staging.add(format!("{}.json", self.study), report.clone());
        for (i, run) in runs.iter().enumerate() {
            if let Ok(outcome) = &run.result {
                staging.add(format!("{}-{:03}.csv", self.study, i + 1), write_csv(&report::rows(self.model, study, outcome)));
            }
        }
        let labelled: Vec<(Option<String>, &Outcome)> =
            runs.iter().filter_map(|r| Some((Some(report::label(self.model, study, &r.at)), r.result.as_ref().ok()?))).collect();
        if let (true, Some((_, first))) = (self.plots, labelled.first()) {
            let mut drawn = figures::figures(self.model, study, &labelled);
            drawn.extend(figures::sweep_figures(self.model, study, &runs));
            self.draw(&mut staging, drawn, first);
        }
        let output = Output {
            table: report::sweep_summary(&table),
            report,
            columns: table.columns.iter().map(|c| (c.name.clone(), c.unit.clone())).collect(),
        };
        self.write(&staging, code, output)
    }

    /// Renders figures and the drawing of the mechanism, several at a time.
    fn draw(&self, staging: &mut Staging, figures: Vec<(String, grashof::output::Figure)>, outcome: &Outcome) {
        let drawings: Vec<_> = outcome.scenes.iter().map(|(name, scene)| (name, figures::drawing(self.model, scene))).collect();
        let count = figures.len() + drawings.len();
        let progress = Progress::new(self.study, count, self.common.quiet);
        let pictures = par::map(
            count,
            self.common.threads(),
            |i| match figures.get(i) {
                Some((name, figure)) => (name.clone(), grashof::output::render_figure(figure)),
                None => {
                    let (name, drawing) = &drawings[i - figures.len()];
                    ((*name).clone(), grashof::output::render_drawing(drawing))
                }
            },
            || progress.step(),
        );
        for (name, picture) in pictures {
            match picture {
                Ok(Picture { svg, png }) => {
                    staging.add(format!("{}-{name}.svg", self.study), svg);
                    staging.add(format!("{}-{name}.png", self.study), png);
                }
                Err(error) => tell(&format!("warning: figure `{name}` of study `{}` cannot be drawn: {error}", self.study)),
            }
        }
    }

    fn write(&self, staging: &Staging, code: u8, output: Output) -> Finished {
        // a motion that was interrupted on its way keeps what it has; anything else is whole or absent
        if interrupted() && code != code::INTERRUPTED {
            return Finished { code: code::INTERRUPTED, output: None };
        }
        match staging.commit(self.directory, self.study, self.studies) {
            Ok(paths) => {
                if self.common.verbose {
                    for path in paths {
                        tell(&format!("wrote {}", path.display()));
                    }
                }
                Finished { code, output: Some(output) }
            }
            Err(error) => {
                tell(&format!("error: {error}\n  help: choose another directory with `-o DIR`"));
                Finished { code: code.max(code::INPUT), output: None }
            }
        }
    }

    /// Tells which expectations are not met.
    fn expectations(&self, outcome: &Outcome) -> u8 {
        let changed = !(self.common.set.is_empty() && self.common.variant.is_empty());
        let help = if changed {
            "the file expects this of its own values; `--set` and `--variant` change what is computed"
        } else {
            "find out which of the two is right"
        };
        let mut code = code::DONE;
        for e in outcome.expectations.iter().filter(|e| !e.met) {
            code = code::UNMET;
            let message = format!("`{}` is {}, not {} within {:e}", e.text, e.found, e.wanted, e.tolerance);
            let report = Report::new(vec![self.document.diagnostic(
                "expectation",
                &e.place,
                message,
                "the value that the file expects",
                Some(help.into()),
            )]);
            tell(report.render(self.common.colored()).trim_end());
        }
        code
    }

    /// Prints an error at a place of the file.
    fn tell_at(&self, code: &'static str, place: &str, message: String, help: &str) {
        let report = Report::new(vec![self.document.diagnostic(code, place, message, "", Some(help.into()))]);
        tell(report.render(self.common.colored()).trim_end());
    }

    /// Prints why a run did not begin, and gives its exit code.
    fn explain(&self, failure: &Failure) -> u8 {
        files::explain(self.document, failure, self.study, self.common)
    }
}

/// What the model language has and this version does not compute.
fn later(study: &Study) -> Option<Failure> {
    let beside = |key: &str| format!("studies.{}.{key}", study.name);
    study.solve.as_ref()?;
    let (what, place) = ("`solve`", beside("solve"));
    Some(Failure::Study {
        code: "later",
        message: format!("{what} cannot be computed yet"),
        place,
        help: "name the studies to run with `--study`; `kinematics`, `inverse`, `balance`, `dynamics` and sweeps of them are there".into(),
    })
}
