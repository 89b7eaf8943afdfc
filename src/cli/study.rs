//! One study from model to files.

mod sweep;

use super::interrupt::{self, interrupted};
use super::progress::{Counted, Progress};
use super::shard::Part;
use super::terminal::{print_interrupted, print_report};
use super::{Common, code, files, print_error, print_note};
use grashof::model::{Document, Kind, Model, Report, Shown, ShownWhat, Study};
use grashof::output::{
    Figure, Formats, Picture, ReportStudy, RowFiles, Staging, WriteError, drawing, figures, summary, tables, ten_digits, write_json,
};
use grashof::par;
use grashof::results::{Failure, Results};
use grashof::studies::common::case::{Streamed, parameters};
use grashof::studies::sweep::{Drawn, Settings, at, single};
use std::path::Path;

/// Numbers that are kept in memory of the rows of a motion, for its figures.
const KEPT: usize = 4_000_000;

/// A study to run, and where its results go.
pub(super) struct Job<'a> {
    pub(super) document: &'a Document,
    pub(super) model: &'a Model,
    /// What the names of its files begin with: its name, but for a sweep from the command line.
    pub(super) study: &'a str,
    pub(super) directory: &'a Path,
    pub(super) plots: bool,
    /// Whether the report takes it.
    pub(super) report: bool,
    pub(super) formats: Formats,
    pub(super) part: &'a Part,
    pub(super) common: &'a Common,
}

/// What came of it.
pub(super) struct Finished {
    pub(super) code: u8,
    /// None if nothing was computed.
    pub(super) output: Option<Output>,
    /// Parameters of each run that has a result, in file order.
    pub(super) computed: Vec<Vec<f64>>,
    /// Whether the runs of a sweep are of no further use: they are written, or none of them is a result.
    ended: bool,
}

impl Finished {
    /// Nothing was computed.
    fn nothing(code: u8) -> Self {
        Self { code, output: None, computed: Vec::new(), ended: false }
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
    /// What the report has of it, if it is wanted.
    pub(super) page: Option<ReportStudy>,
}

impl Job<'_> {
    /// Runs, writes and reports; faults have been printed.
    pub(super) fn run(&self) -> Finished {
        let Some(study) = &self.model.study else { return Finished::nothing(code::INPUT) };
        // a motion in time keeps what it has come to
        let keeps = matches!(study.kind, Kind::Dynamics(_)) && study.sweep.is_empty() && study.solve.is_none();
        interrupt::begins(format!("interrupted: study `{}` is not written", study.name), keeps);
        if let Err(code) = files::prepare(self.directory, &self.names(study), self.common) {
            return Finished::nothing(code);
        }
        match self.part {
            Part::Whole if study.sweep.is_empty() => self.single(study),
            _ if study.sweep.is_empty() => {
                print_error(
                    &format!("study `{}` is no sweep, which could be cut", study.name),
                    "name a study with `sweep:`, or use `grashof sweep`",
                );
                Finished::nothing(code::INPUT)
            }
            Part::Whole => self.sweep(study),
            Part::Shard(shard) => self.shard(study, *shard),
            Part::Gathered(directories) => self.gathered(study, directories),
        }
    }

    /// How its runs are made.
    fn settings(&self) -> Settings<'static> {
        // those of a shard are drawn once it is gathered; figures show the first run alone
        let drawn = match self.part {
            Part::Shard(_) => Drawn::None,
            _ if self.report => Drawn::All,
            _ if self.plots => Drawn::First,
            _ => Drawn::None,
        };
        Settings { threads: self.common.threads(), drawn, stop: &interrupted }
    }

    /// Names of files that are known before anything is computed.
    fn names(&self, study: &Study) -> Vec<String> {
        let column = |shown: &Shown| matches!(shown.what, ShownWhat::Column(_));
        let plots = study.plots.iter().filter(|plot| self.plots && plot.all().all(column));
        let plots = plots.flat_map(|plot| ["svg", "png"].map(|end| format!("{}-{}.{end}", self.study, plot.name)));
        let ends = self.formats.ends().into_iter().chain(["json"]);
        ends.map(|end| format!("{}.{end}", self.study)).chain(plots).collect()
    }

    /// A study of one run, or of those that a `solve` takes to find one.
    fn single(&self, study: &Study) -> Finished {
        let solves = study.solve.is_some();
        let quiet = self.common.quiet;
        let progress = if solves { Progress::open(self.study, quiet) } else { Progress::of_run(self.study, quiet) };
        let show = |x: f64, scalar: f64| progress.show(&self.trial(study, x, scalar));
        let rows = RowFiles::new(self.directory, self.formats);
        let until = match &study.kind {
            Kind::Dynamics(motion) if !solves => Some(self.model.pool.value(motion.until, &parameters(self.model))),
            _ => None,
        };
        let counted = Counted { rows: &rows, progress: &progress, until };
        let streamed = Some(Streamed { sink: &counted, keep: KEPT });
        let run = at(self.model, study, Vec::new(), self.settings(), streamed, &show);
        drop(progress);
        let results = match single(self.model, study, run) {
            Ok(results) => results,
            Err(_) if interrupted() => return Finished::nothing(code::INTERRUPTED),
            Err(failure) => return Finished::nothing(self.explain(&failure)),
        };
        if !self.common.quiet {
            let of_start = results.findings.iter().filter(|f| f.code == "change-point");
            let of_solution = results.solution.iter().flat_map(|s| &s.findings);
            of_solution.chain(of_start).for_each(|f| print_note(&format!("note: study `{}`: {}", study.name, f.message)));
        }
        let mut code = code::DONE;
        if let Some(reason) = &results.stopped {
            let message = format!("study `{}` stopped on its way: {reason}", study.name);
            let help = match study.kind {
                Kind::Dynamics(_) => "what was computed up to there is kept; look at its last rows",
                _ => "start elsewhere, change the lengths, or give a shorter range",
            };
            if interrupted() {
                print_interrupted(&message);
            } else if let Some(undefined) = &results.undefined {
                self.print_at("undefined", &undefined.place, message, "", &undefined.help);
            } else {
                self.print_at("stopped", &study.place, message, "", help);
            }
            code = if interrupted() { code::INTERRUPTED } else { code::NUMERICAL };
        } else {
            code = code.max(self.expectations(&results));
        }
        let mut staging = Staging::new();
        if let Err(unwritten) = self.table(&mut staging, rows, &results) {
            return Finished::nothing(code.max(unwritten));
        }
        grashof::output::files(self.study, &results).into_iter().for_each(|(name, bytes)| staging.add(name, bytes));
        // who interrupts a motion wants its rows, and no waiting for figures
        if self.plots && !interrupted() {
            self.draw(&mut staging, figures(&results), &results);
        }
        let page = self.report.then(|| ReportStudy::of(&results, &study.about));
        let output = Output { table: summary(&results), report: write_json(&results), columns: units(&results), page };
        Finished { computed: vec![values(&results)], ..self.write(&staging, code, output) }
    }

    /// The files of the table: of rows that went out as they were computed, or made of the results; what is wrong was reported.
    fn table(&self, staging: &mut Staging, rows: RowFiles, results: &Results) -> Result<(), u8> {
        match rows.finish().map_err(|error| files::unwritable(&error))? {
            Some(files) => files.into_iter().for_each(|(end, bytes)| staging.add_spooled(format!("{}{end}", self.study), bytes)),
            None => self.add(staging, tables(self.study, &results.table, self.formats))?,
        }
        Ok(())
    }

    /// Adds files that an encoder has made; what is wrong was reported.
    fn add(&self, staging: &mut Staging, made: Result<Vec<(String, Vec<u8>)>, WriteError>) -> Result<(), u8> {
        let files = made.map_err(|error| files::unwritable(&error))?;
        files.into_iter().for_each(|(name, bytes)| staging.add(name, bytes));
        Ok(())
    }

    /// A run of a `solve`, beside its progress.
    fn trial(&self, study: &Study, x: f64, scalar: f64) -> String {
        let Some(solve) = &study.solve else { return String::new() };
        let parameter = &self.model.parameters[solve.parameter];
        let value = ten_digits;
        format!("{} = {} {}, {} = {}", parameter.name, value(x), parameter.dimension.si(), solve.target.0, value(scalar))
    }

    /// Renders figures and the drawing of the mechanism, several at a time.
    fn draw(&self, staging: &mut Staging, figures: Vec<(String, Figure)>, results: &Results) {
        let drawn = results.scenes.iter().map(|(name, scene)| (name, drawing(&results.model, self.study, name, scene)));
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
                Err(error) => print_note(&format!("warning: figure `{name}` of study `{}` cannot be drawn: {error}", self.study)),
            }
        }
    }

    fn write(&self, staging: &Staging, code: u8, output: Output) -> Finished {
        // a motion that was interrupted on its way keeps what it has; anything else is whole or absent
        if interrupted() && code != code::INTERRUPTED {
            return Finished::nothing(code::INTERRUPTED);
        }
        match files::commit(staging, self.directory, self.study, self.common) {
            Ok(()) => {
                let what = if code == code::INTERRUPTED { "is written up to there" } else { "was the last one" };
                interrupt::begins(format!("interrupted: study `{}` {what}", self.study), code == code::INTERRUPTED);
                Finished { code, output: Some(output), computed: Vec::new(), ended: false }
            }
            Err(unwritten) => Finished::nothing(code.max(unwritten)),
        }
    }

    /// Tells which expectations are not met.
    fn expectations(&self, results: &Results) -> u8 {
        let missed = results.expectations.iter().filter(|e| !e.met);
        missed.fold(code::DONE, |_, e| self.unmet(&e.place, e.message.clone()))
    }

    /// Tells that an expectation at a place of the file is not met.
    fn unmet(&self, place: &str, message: String) -> u8 {
        let help = match self.common.changes() {
            Some(_) => "the file expects this of its own values; `--set` and `--variant` change what is computed",
            None => "find out which of the two is right",
        };
        self.print_at("expectation", place, message, "the value that the file expects", help);
        code::UNMET
    }

    /// Prints an error at a place of the file, with what was expected there if that is more than the message says.
    fn print_at(&self, code: &'static str, place: &str, message: String, expected: &str, help: &str) {
        let report = Report::new(vec![self.document.diagnostic(code, place, message, expected, Some(help.into()))]);
        print_report(&report, self.common.colored());
    }

    /// Prints why a run did not begin, and gives its exit code.
    fn explain(&self, failure: &Failure) -> u8 {
        let name = self.model.study.as_ref().map_or(self.study, |study| &study.name);
        files::explain(self.document, failure, name, self.common)
    }
}

/// Values of the parameters of a run.
fn values(results: &Results) -> Vec<f64> {
    results.parameters.iter().map(|p| p.value).collect()
}

/// Columns with their units.
fn units(results: &Results) -> Vec<(String, String)> {
    results.table.columns.iter().map(|c| (c.name.clone(), c.unit.clone())).collect()
}
