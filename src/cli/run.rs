//! `grashof run`: studies one after the other; the highest code wins.

use super::progress::{interrupted, watch_interrupts};
use super::study::{Finished, Job};
use super::{Common, code, files, say, tell, verify};
use grashof::analysis::run::run as run_study;
use grashof::analysis::sweep::parameters;
use grashof::mechanism::Coordinates;
use grashof::model::{Document, Model};
use std::collections::{HashMap, HashSet};

/// Scalars of the studies that were run for others.
pub(super) type Scalars = HashMap<String, Vec<(String, f64)>>;

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
    /// Compute each motion in time twice more, at a tenth of its tolerance and by a scheme of another family, and tell how many
    /// digits stand
    #[arg(long)]
    verify: bool,
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
    let mut scalars = Scalars::new();
    for study in &studies {
        let model = match load(&document, common, study, &mut scalars) {
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
            let what = match (&finished.output, finished.code) {
                (None, _) => "is not written",
                (Some(_), code::INTERRUPTED) => "is written up to there",
                _ => "was the last one",
            };
            tell(&format!("interrupted: study `{study}` {what}"));
            return code::INTERRUPTED;
        }
        worst = worst.max(finished.code);
        show(&finished, study, arguments, &mut reports);
        if arguments.verify && finished.output.is_some() {
            worst = worst.max(verified(&document, &model, study, arguments, common));
            if interrupted() {
                tell(&format!("interrupted: study `{study}` is written, and not verified"));
                return code::INTERRUPTED;
            }
        }
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

/// Prints how many digits of a motion in time stand; on stderr where stdout has JSON.
fn verified(document: &Document, model: &Model, study: &str, arguments: &Arguments, common: &Common) -> u8 {
    match verify::verify(model) {
        Ok(Some(verdict)) => {
            let line = if arguments.json { tell } else { say };
            line(&format!("{}{}", if arguments.json { format!("{study}: ") } else { "  ".into() }, verdict.line));
            if !arguments.json {
                say("");
            }
            if verdict.agrees { code::DONE } else { code::UNMET }
        }
        Ok(None) => code::DONE,
        Err(failure) => files::explain(document, &failure, study, common),
    }
}

/// The model of a study, with the scalars that it takes from others.
pub(super) fn load(document: &Document, common: &Common, study: &str, scalars: &mut Scalars) -> Result<Model, u8> {
    let selection = files::selection(common, Some(study)).ok_or(code::INPUT)?;
    let mut model = document.model(&selection).map_err(|report| {
        files::print(&report, common);
        code::INPUT
    })?;
    let takes = model.study.as_ref().map(|s| s.take.clone()).unwrap_or_default();
    let mut taken = Vec::new();
    for take in &takes {
        let of = match scalars.get(&take.study) {
            Some(of) => of,
            None => {
                let other = load(document, common, &take.study, scalars)?;
                let found = scalars_of(document, &other, study, common)?;
                scalars.entry(take.study.clone()).or_insert(found)
            }
        };
        taken.push(of.iter().find(|(name, _)| *name == take.scalar).map_or(f64::NAN, |(_, value)| *value));
    }
    if !taken.is_empty() {
        model.give(&taken);
    }
    Ok(model)
}

/// Runs a study for its scalars, which `for_study` takes; faults have been printed.
fn scalars_of(document: &Document, model: &Model, for_study: &str, common: &Common) -> Result<Vec<(String, f64)>, u8> {
    let Some(study) = &model.study else { return Err(code::INPUT) };
    let refuse = |what: &str, help: &str, code: u8| {
        tell(&format!("error: study `{for_study}` takes a scalar of `{}`, {what}\n  help: {help}", study.name));
        code
    };
    if !study.sweep.is_empty() {
        return Err(refuse("which is a sweep and has a list of values", "take it from a study of one run", code::INPUT));
    }
    let outcome = run_study(model, study, &parameters(model), Coordinates::Joint, &interrupted)
        .map_err(|failure| files::explain(document, &failure, &study.name, common))?;
    if let Some(reason) = &outcome.stopped {
        return Err(refuse(&format!("which stopped on its way: {reason}"), "see to that study first", code::NUMERICAL));
    }
    let results = study.results.iter().map(|r| r.name.clone()).zip(outcome.results.iter().copied());
    let own = study.scalars.iter().map(|s| s.name.clone()).zip(outcome.scalars.iter().copied());
    let taken = study.take.iter().map(|t| (t.name.clone(), t.value));
    Ok(results.chain(own).chain(taken).collect())
}

/// A parameter that is set from outside although the study varies it.
fn conflict(model: &Model) -> Option<String> {
    let study = model.study.as_ref()?;
    let varied = study.sweep.iter().map(|s| s.parameter).chain(study.solve.iter().map(|s| s.parameter));
    varied.map(|p| model.parameters[p].name.clone()).find(|name| model.set.contains(name))
}
