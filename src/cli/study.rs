//! One study from model to files.

mod sweep;

use super::progress::{Progress, interrupted};
use super::{Common, code, figures, files, linear, report, tell};
use grashof::analysis::outcome::{Failure, Outcome};
use grashof::analysis::sweep::{Run, at};
use grashof::model::{Document, Kind, Model, Report, Study};
use grashof::output::{Picture, Staging, write_csv};
use grashof::par;
use std::path::Path;

/// A study to run, and where its results go.
pub(super) struct Job<'a> {
    pub(super) document: &'a Document,
    pub(super) model: &'a Model,
    /// What the names of its files begin with: its name, but for a sweep from the command line.
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
    /// Parameters of each run that has a result, in file order.
    pub(super) computed: Vec<Vec<f64>>,
}

impl Finished {
    /// Nothing was computed.
    fn nothing(code: u8) -> Self {
        Self { code, output: None, computed: Vec::new() }
    }
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
        let Some(study) = &self.model.study else { return Finished::nothing(code::INPUT) };
        if study.sweep.is_empty() { self.single(study) } else { self.sweep(study) }
    }

    /// A study of one run, or of those that a `solve` takes to find one.
    fn single(&self, study: &Study) -> Finished {
        let progress = Progress::open(self.study, self.common.quiet || study.solve.is_none());
        let told = |x: f64, scalar: f64| progress.tell(&self.trial(study, x, scalar));
        let Run { result, solved, .. } = at(self.model, study, Vec::new(), self.common.threads(), &interrupted, &told);
        drop(progress);
        let outcome = match result {
            Ok(outcome) => outcome,
            Err(_) if interrupted() => return Finished::nothing(code::INTERRUPTED),
            Err(failure) => return Finished::nothing(self.explain(&failure)),
        };
        if !self.common.quiet {
            solved.iter().flat_map(|s| &s.findings).for_each(|f| tell(&format!("note: study `{}`: {}", study.name, f.message)));
        }
        let mut code = code::DONE;
        if let Some(reason) = &outcome.stopped {
            let message = format!("study `{}` stopped on its way: {reason}", study.name);
            let help = match study.kind {
                Kind::Dynamics(_) => "what was computed up to there is kept; look at its last rows",
                _ => "start elsewhere, change the lengths, or give a shorter range",
            };
            if interrupted() {
                tell(&message);
            } else if let Some(undefined) = &outcome.undefined {
                self.tell_at("undefined", &undefined.place, message, &undefined.help);
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
        let report = report::json(self.model, study, &outcome, solved.as_ref());
        staging.add(format!("{}.json", self.study), report.clone());
        for (name, bytes) in linear::files(study, &outcome) {
            staging.add(name, bytes);
        }
        if self.plots {
            self.draw(&mut staging, figures::figures(self.model, study, &[(None, &outcome)]), &outcome);
        }
        let output = Output {
            table: report::solution(self.model, study, solved.as_ref()) + &report::summary(self.model, study, &outcome),
            report,
            columns: table.columns.iter().map(|c| (c.name.clone(), c.unit.clone())).collect(),
        };
        Finished { computed: vec![values(&outcome)], ..self.write(&staging, code, output) }
    }

    /// A run of a `solve`, beside its progress.
    fn trial(&self, study: &Study, x: f64, scalar: f64) -> String {
        let Some(solve) = &study.solve else { return String::new() };
        let parameter = &self.model.parameters[solve.parameter];
        let value = report::significant;
        format!("{} = {} {}, {} = {}", parameter.name, value(x), parameter.dimension.si(), solve.target.0, value(scalar))
    }

    /// Renders figures and the drawing of the mechanism, several at a time.
    fn draw(&self, staging: &mut Staging, figures: Vec<(String, grashof::output::Figure)>, outcome: &Outcome) {
        let drawn = outcome.scenes.iter().map(|(name, scene)| (name, figures::drawing(self.model, self.study, name, scene)));
        let drawings: Vec<_> = drawn.collect();
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
            return Finished::nothing(code::INTERRUPTED);
        }
        match staging.commit(self.directory, self.study, self.studies) {
            Ok(paths) => {
                if self.common.verbose {
                    for path in paths {
                        tell(&format!("wrote {}", path.display()));
                    }
                }
                Finished { code, output: Some(output), computed: Vec::new() }
            }
            Err(error) => {
                tell(&format!("error: {error}\n  help: choose another directory with `-o DIR`"));
                Finished::nothing(code.max(code::INPUT))
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
        let name = self.model.study.as_ref().map_or(self.study, |study| &study.name);
        files::explain(self.document, failure, name, self.common)
    }
}

/// Values of the parameters of a run.
fn values(outcome: &Outcome) -> Vec<f64> {
    outcome.parameters.iter().map(|(_, x)| *x).collect()
}
