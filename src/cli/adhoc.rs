//! One study that the model file does not have: `grashof modes`, `grashof statics`.

use super::interrupt::{self, interrupted, watch_interrupts};
use super::shard::Part;
use super::study::Job;
use super::terminal::{take_errors, with_errors};
use super::{Common, code, files, print_out, run};
use grashof::model::Report;
use grashof::output::Formats;
use grashof::studies::loader::Loader;

#[derive(clap::Args)]
#[group(skip)]
pub(super) struct Arguments {
    /// Model file, or `-` for stdin
    model: String,
    /// Print the results as JSON instead of tables
    #[arg(long)]
    json: bool,
    /// Write no figures
    #[arg(long)]
    no_plots: bool,
}

/// Runs a study, given for a number of bodies as the YAML that it would have in the file (`statics: { from: start }`), under a name near
/// `name` that no study of the file has.
pub(super) fn study(arguments: &Arguments, name: &str, yaml: impl Fn(usize) -> String, common: &Common) -> u8 {
    watch_interrupts();
    let Some(mut document) = files::document(&arguments.model, common) else { return code::INPUT };
    let name = document.add_study(name, &yaml(document.body_count()));
    let Some(selection) = files::selection(common, Some(&name)) else { return code::INPUT };
    let model = match run::load(&mut Loader::new(&document, common.threads()), &document, common, &selection, &Report::default()) {
        Ok(model) => model,
        Err(code) => return code,
    };
    let Some(directory) = files::directory(&arguments.model, common) else { return code::INPUT };
    let plots = !arguments.no_plots;
    let (formats, part) = (Formats::default(), &Part::Whole);
    let job = Job { document: &document, model: &model, study: &name, directory: &directory, plots, report: false, formats, part, common };
    let finished = job.run();
    if interrupted() {
        interrupt::print_end(&format!("interrupted: study `{name}`"));
        return code::INTERRUPTED;
    }
    if let Some(output) = &finished.output {
        if arguments.json {
            print_out(&with_errors(&output.report, take_errors()));
        } else {
            print_out(&name);
            print_out(&output.table);
        }
    }
    finished.code
}
