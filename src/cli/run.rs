//! `grashof run`: studies one after the other; the highest code wins.

use super::progress::{interrupted, watch_interrupts};
use super::study::{Finished, Job};
use super::{Common, code, files, say, tell};
use grashof::model::{Document, Model};
use std::collections::HashSet;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Model file, or `-` for stdin
    model: String,
    /// Run this study alone (repeatable)
    #[arg(long, value_name = "S")]
    study: Vec<String>,
    /// Print the results as JSON instead of tables
    #[arg(long)]
    json: bool,
    /// Print the columns of each study with their units, too
    #[arg(long)]
    units: bool,
    /// Write no figures
    #[arg(long)]
    no_plots: bool,
}

/// Runs the studies of a model.
pub(super) fn run(arguments: &Arguments, common: &Common) -> u8 {
    watch_interrupts();
    let Some(document) = files::document(&arguments.model, common) else { return code::INPUT };
    let Some(selection) = files::selection(common, None) else { return code::INPUT };
    let report = document.check_all(&selection);
    files::print(&report, common);
    if report.failed() {
        return code::INPUT;
    }
    let known = document.study_names();
    if known.is_empty() {
        tell(
            "error: the model has no studies, so there is nothing to run\n  help: add one, as `studies: { turn: { kinematics: { over: 1 turn } } }`, or use `grashof check`",
        );
        return code::INPUT;
    }
    let mut studies = if arguments.study.is_empty() { known.clone() } else { arguments.study.clone() };
    let mut seen = HashSet::new();
    studies.retain(|study| seen.insert(study.clone()));
    let directory = files::directory(&arguments.model, common);
    let mut worst = code::DONE;
    let mut reports = Vec::new();
    for study in &studies {
        let model = match load(&document, common, study) {
            Ok(model) => model,
            Err(code) => {
                worst = worst.max(code);
                continue;
            }
        };
        let named = !arguments.study.is_empty();
        match conflict(&model) {
            Some(parameter) if named => {
                tell(&format!(
                    "error: `--set {parameter}` sets the parameter that study `{study}` varies\n  help: leave the parameter to the study, or run another one"
                ));
                worst = worst.max(code::INPUT);
                continue;
            }
            Some(parameter) => {
                if !common.quiet {
                    tell(&format!("note: study `{study}` is skipped: it varies `{parameter}`, which `--set` fixes"));
                }
                continue;
            }
            None => {}
        }
        let job =
            Job { document: &document, model: &model, study, studies: &known, directory: &directory, plots: !arguments.no_plots, common };
        let finished = job.run();
        if interrupted() {
            let what = if finished.code == code::INTERRUPTED { "is not written" } else { "was the last one" };
            tell(&format!("interrupted: study `{study}` {what}"));
            return code::INTERRUPTED;
        }
        worst = worst.max(finished.code);
        show(&finished, study, arguments, &mut reports);
    }
    if arguments.json {
        say(&json_list(&reports));
    }
    worst
}

/// JSON texts as one list, their numbers untouched: reading them back could change a last digit.
fn json_list(texts: &[String]) -> String {
    let items: Vec<String> = texts.iter().map(|text| format!("\n  {}", text.trim_end().replace('\n', "\n  "))).collect();
    format!("[{}{}]", items.join(","), if items.is_empty() { "" } else { "\n" })
}

/// Prints what a study gave.
fn show(finished: &Finished, study: &str, arguments: &Arguments, reports: &mut Vec<String>) {
    let Some(output) = &finished.output else { return };
    if arguments.json {
        reports.push(output.report.clone());
        return;
    }
    say(study);
    say(&output.table);
    if arguments.units {
        for (name, unit) in &output.columns {
            say(&format!("  {name} [{}]", if unit.is_empty() { "1" } else { unit }));
        }
        say("");
    }
}

fn load(document: &Document, common: &Common, study: &str) -> Result<Model, u8> {
    let selection = files::selection(common, Some(study)).ok_or(code::INPUT)?;
    document.model(&selection).map_err(|report| {
        files::print(&report, common);
        code::INPUT
    })
}

/// A parameter that is set from outside although the study varies it.
fn conflict(model: &Model) -> Option<String> {
    let study = model.study.as_ref()?;
    let varied = study.sweep.iter().map(|s| s.parameter).chain(study.solve.iter().map(|s| s.parameter));
    varied.map(|p| model.parameters[p].name.clone()).find(|name| model.set.contains(name))
}
