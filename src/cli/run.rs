//! `grashof run`: studies one after the other; the highest code wins.

use super::end::json_list;
use super::interrupt::{self, interrupted, watch_interrupts};
use super::shard::{Part, Shard};
use super::study::{Finished, Job};
use super::terminal::{failure_json, take_errors, with_errors};
use super::{Common, code, files, print_error, print_note, print_out, report};
use grashof::model::{Document, Model, Report, Selection};
use grashof::output::{Formats, ReportStudy};
use grashof::studies::loader::{Loader, NotLoaded};
use grashof::studies::verify::verify;
use serde_json::json;
use std::collections::HashSet;
use std::path::Path;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Model file, or `-` for stdin
    model: String,
    /// Run this study alone (repeatable)
    #[arg(long, value_name = "S")]
    study: Vec<String>,
    /// Compute one part of a sweep alone, the K-th of N, and keep it for `grashof gather`
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Write no report
    #[arg(long)]
    no_report: bool,
    #[command(flatten)]
    wanted: Wanted,
}

/// What is wanted of studies beside their files.
#[derive(clap::Args)]
pub(super) struct Wanted {
    /// Print the results as JSON instead of tables
    #[arg(long)]
    pub(super) json: bool,
    /// Print the columns of each study with their units, too
    #[arg(long)]
    units: bool,
    /// Write no figures
    #[arg(long)]
    no_plots: bool,
    /// Formats of tables, with commas between them: csv, parquet
    #[arg(long, value_name = "FORMATS", default_value = "csv", value_parser = formats)]
    format: Formats,
    /// Judge expectations even if `--set`, `--variant` or `--over` change what is computed
    #[arg(long)]
    pub(super) expect: bool,
    /// Compute each motion in time twice more, at a tenth of its tolerance and by a scheme of another family, and report how many
    /// digits are certain
    #[arg(long)]
    verify: bool,
}

/// Formats by their names.
fn formats(text: &str) -> Result<Formats, String> {
    let mut formats = Formats { csv: false, parquet: false };
    for name in text.split(',') {
        match name.trim() {
            "csv" => formats.csv = true,
            "parquet" => formats.parquet = true,
            other => return Err(format!("`{other}` is no format of tables: write csv, parquet, or csv,parquet")),
        }
    }
    if !formats.are_built() {
        return Err("this program was built without Parquet: build it with `cargo build --release --features parquet`".into());
    }
    Ok(formats)
}

/// Runs the studies of a model.
pub(super) fn run(arguments: &Arguments, common: &Common) -> u8 {
    watch_interrupts();
    let mut reports = Vec::new();
    let code = studies(arguments, common, &mut reports);
    if arguments.wanted.json && !reports.is_empty() {
        print_out(&json_list(&reports));
    }
    code
}

/// Runs the studies one after the other; for JSON, their reports or why there is none.
fn studies(arguments: &Arguments, common: &Common, reports: &mut Vec<String>) -> u8 {
    let Some((document, _, told)) = files::sound_for(&arguments.model, common, &arguments.study) else { return code::INPUT };
    files::print_notes(&document, common);
    let known = document.study_names();
    if known.is_empty() {
        print_error(
            "the model has no studies, so there is nothing to run",
            "add one, as `studies: { turn: { kinematics: { over: 1 turn, samples: 72 } } }`, or use `grashof check`",
        );
        return code::INPUT;
    }
    let mut studies = if arguments.study.is_empty() { known.clone() } else { arguments.study.clone() };
    let mut seen = HashSet::new();
    studies.retain(|study| seen.insert(study.clone()));
    let Some(directory) = files::directory(&arguments.model, common) else { return code::INPUT };
    let part = arguments.shard.map_or(Part::Whole, Part::Shard);
    let paged = !arguments.no_report && arguments.shard.is_none();
    let request = Request { document: &document, common, wanted: &arguments.wanted, directory: &directory, part: &part, report: paged };
    if paged && let Err(code) = files::prepare(&directory, &[report::FILE.into()], common) {
        return code;
    }
    let mut page = paged.then(|| report::begun(&document, common));
    let mut worst = code::DONE;
    let mut loader = Loader::new(&document, common.threads());
    let (mut noted, mut uncut) = (false, 0);
    for study in &studies {
        let mut reported = |told: Option<Told>, about: &str| {
            let errors = take_errors();
            let (json, shown) = told.map_or((None, None), |told| (told.json, told.page));
            match (&mut page, &shown) {
                (Some(page), Some(study)) => page.add(study),
                (Some(page), None) => report::add_failed(page, study, about, &errors),
                (None, _) => {}
            }
            match json {
                Some(report) => reports.push(with_errors(&report, errors)),
                None if errors.is_empty() => {}
                None => reports.push(failure_json(Some(study), errors)),
            }
        };
        interrupt::begins(format!("interrupted: study `{study}` is not begun"), false);
        let selected = files::selection(common, Some(study)).ok_or(code::INPUT);
        let mut model = match selected.and_then(|selection| load(&mut loader, &document, common, &selection, &told)) {
            Ok(model) => model,
            Err(code) => {
                let code = if interrupted() { print_interrupt(study, "is not begun") } else { code };
                reported(None, "");
                worst = worst.max(code);
                if interrupted() {
                    return code;
                }
                continue;
            }
        };
        match model.set_and_varied() {
            Some(parameter) if !arguments.study.is_empty() => {
                worst = worst.max(refused(parameter, study));
                reported(None, about(&model));
                continue;
            }
            Some(parameter) => {
                let reason = format!("study `{study}` is skipped: it varies `{parameter}`, which `--set` fixes");
                if !common.quiet {
                    print_note(&format!("note: {reason}"));
                }
                if let Some(page) = &mut page {
                    report::add_failed(page, study, about(&model), &[json!({ "message": reason })]);
                }
                continue;
            }
            None => {}
        }
        // a part of a file is that of its sweeps
        if arguments.shard.is_some() && arguments.study.is_empty() && model.study.as_ref().is_some_and(|s| s.sweep.is_empty()) {
            uncut += 1;
            continue;
        }
        request.drop_expectations(&mut model, common.changes(), &mut noted);
        let told = request.study(&model, study, study);
        worst = worst.max(told.code);
        reported(Some(told), about(&model));
        if interrupted() {
            return code::INTERRUPTED;
        }
    }
    if uncut == studies.len() {
        print_error(
            "`--shard` cuts sweeps, and no study of the model is one",
            "leave it out, give a study `sweep:`, or use `grashof sweep --study S --over NAME=VALUES --shard K/N`",
        );
        return code::INPUT;
    }
    if arguments.shard.is_none() {
        worst = worst.max(report::written(page, &directory, common));
    }
    worst
}

/// What the study of a model is for.
fn about(model: &Model) -> &str {
    model.study.as_ref().map_or("", |study| &study.about)
}

/// Says what became of a study when Ctrl-C was pressed.
fn print_interrupt(study: &str, what: &str) -> u8 {
    interrupt::print_end(&format!("interrupted: study `{study}` {what}"));
    code::INTERRUPTED
}

/// Refuses a study that varies a parameter which is set from outside.
pub(super) fn refused(parameter: &str, study: &str) -> u8 {
    print_error(
        &format!("`--set {parameter}` sets the parameter that study `{study}` varies"),
        "leave the parameter to the study, or run another one",
    );
    code::INPUT
}

/// Where studies are run and what is wanted of them.
pub(super) struct Request<'a> {
    pub(super) document: &'a Document,
    pub(super) common: &'a Common,
    pub(super) wanted: &'a Wanted,
    pub(super) directory: &'a Path,
    pub(super) part: &'a Part,
    /// Whether a report takes the studies.
    pub(super) report: bool,
}

/// What became of a study.
pub(super) struct Told {
    pub(super) code: u8,
    /// Its results, if they are wanted as JSON.
    pub(super) json: Option<String>,
    /// What the report has of it, if there is one.
    pub(super) page: Option<ReportStudy>,
}

impl Request<'_> {
    /// Drops what a file expects of its own values if `option` changes these and nobody asks to judge it; `noted` becomes true with
    /// the one line that says so.
    pub(super) fn drop_expectations(&self, model: &mut Model, option: Option<&str>, noted: &mut bool) {
        let (Some(option), false, Some(study)) = (option, self.wanted.expect, &mut model.study) else { return };
        let dropped = !study.expect.is_empty();
        study.expect.clear();
        if dropped && !self.common.quiet && !std::mem::replace(noted, true) {
            let change = if option.contains(' ') { "change" } else { "changes" };
            print_note(&format!(
                "note: what the file expects of its own values is not judged, since `{option}` {change} what is computed; `--expect` judges it"
            ));
        }
    }

    /// Runs a study into files whose names begin with `stem`, prints what is wanted of it, and says what became of it. An
    /// interrupt was reported.
    pub(super) fn study(&self, model: &Model, study: &str, stem: &str) -> Told {
        let Self { document, common, directory, part, report, .. } = *self;
        let (plots, formats) = (!self.wanted.no_plots, self.wanted.format);
        let job = Job { document, model, study: stem, directory, plots, report, formats, part, common };
        let finished = job.run();
        if interrupted() {
            let what = match (&finished.output, finished.code) {
                (None, _) => "is not written",
                (Some(_), code::INTERRUPTED) => "is written up to there",
                _ => "was the last one",
            };
            let json = finished.output.map(|output| output.report).filter(|_| self.wanted.json);
            return Told { code: print_interrupt(study, what), json, page: None };
        }
        let mut code = finished.code;
        self.show(&finished, stem, about(model));
        if self.wanted.verify && finished.output.is_some() {
            interrupt::begins(format!("interrupted: study `{study}` is written, and not verified"), false);
            code = code.max(self.verified(model, study, &finished.computed));
            if interrupted() {
                code = print_interrupt(study, "is written, and not verified");
            }
        }
        let (json, page) = finished.output.map_or((None, None), |output| (Some(output.report), output.page));
        Told { code, json: json.filter(|_| self.wanted.json), page }
    }

    /// Prints what a study is for, and its tables.
    fn show(&self, finished: &Finished, name: &str, about: &str) {
        let Some(output) = finished.output.as_ref().filter(|_| !self.wanted.json) else { return };
        print_out(name);
        let about: Vec<&str> = about.split_whitespace().collect();
        if !about.is_empty() {
            print_out(&format!("  {}", about.join(" ")));
        }
        print_out(&output.table);
        if self.wanted.units {
            for (name, unit) in &output.columns {
                print_out(&format!("  {name} [{}]", if unit.is_empty() { "1" } else { unit }));
            }
            print_out("");
        }
    }

    /// Prints how many digits of a motion in time stand; on stderr where stdout has JSON.
    fn verified(&self, model: &Model, study: &str, computed: &[Vec<f64>]) -> u8 {
        let json = self.wanted.json;
        match verify(model, computed, &interrupted) {
            Ok(Some(verdict)) => {
                let line = if json { print_note } else { print_out };
                line(&format!("{}{}", if json { format!("{study}: ") } else { "  ".into() }, verdict.line));
                if !json {
                    print_out("");
                }
                if verdict.agrees { code::DONE } else { code::UNMET }
            }
            Ok(None) => code::DONE,
            Err(failure) => files::explain(self.document, &failure, study, self.common),
        }
    }
}

/// The model of a study, with the scalars that it takes from others; what is wrong or doubtful has been printed, but for what was `told`.
pub(super) fn load(
    loader: &mut Loader<'_>,
    document: &Document,
    common: &Common,
    selection: &Selection<'_>,
    told: &Report,
) -> Result<Model, u8> {
    let loaded = loader.drawn(selection, &interrupted);
    if let Ok(model) = &loaded {
        files::print(&model.warnings.clone().beyond(told), common);
    }
    loaded.map_err(|why| match why {
        NotLoaded::Wrong(report) => {
            files::print(&report, common);
            code::INPUT
        }
        NotLoaded::Failed { .. } if interrupted() => code::INTERRUPTED,
        NotLoaded::Failed { study: of, failure } => files::explain_beside(document, &failure, selection.study.unwrap_or(&of), &of, common),
        NotLoaded::Stopped { study, of, reason } => {
            let message = format!("study `{study}` takes a scalar of `{of}`, which stopped on its way: {reason}");
            print_error(&message, "see to that study first");
            code::NUMERICAL
        }
    })
}
