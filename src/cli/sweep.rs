//! `grashof sweep`: a study of the file over values of parameters that are named on the command line.

use super::interrupt::{interrupted, watch_interrupts};
use super::run::{Request, Wanted, conflict, load, refused};
use super::terminal::{take_errors, with_errors};
use super::{Common, code, files, print_error, print_out};
use grashof::model::{Plot, Selection, Shown, ShownWhat, Study};
use grashof::studies::loader::Loader;

/// The figure of scalars over the swept parameter, where the study has none of its own.
const FIGURE: &str = "scalars";

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Model file, or `-` for stdin
    model: String,
    /// The study; may be left out if the model has only one
    #[arg(long, value_name = "S")]
    study: Option<String>,
    /// Values of a parameter: a range with the number of values, as `l3=0.3..0.8:26` (with `:log` at the end for equal ratios), or a
    /// list, as `l3=30cm,40cm,50cm` (repeatable: all combinations, the last parameter fastest)
    #[arg(long, value_name = "NAME=VALUES", required = true)]
    over: Vec<String>,
    #[command(flatten)]
    wanted: Wanted,
}

/// Sweeps a study.
pub(super) fn sweep(arguments: &Arguments, common: &Common) -> u8 {
    watch_interrupts();
    let Some((document, selection, _)) = files::sound(&arguments.model, common) else { return code::INPUT };
    files::print_notes(&document, common);
    let known = document.study_names();
    let (Some(study), Some(over)) = (chosen(arguments, &known), over(&arguments.over)) else { return code::INPUT };
    let stem = format!("{study}-over-{}", over.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join("+"));
    let selection = Selection { study: Some(study), over, ..selection };
    let mut model = match load(&mut Loader::new(&document, common.threads()), &document, common, &selection) {
        Ok(model) => model,
        Err(_) if interrupted() => return code::INTERRUPTED,
        Err(code) => return code,
    };
    if let Some(parameter) = conflict(&model) {
        return refused(&parameter, study);
    }
    if let Some(study) = &mut model.study {
        let figure = figure(study);
        study.plots.extend(figure);
    }
    let Some(directory) = files::directory(&arguments.model, common) else { return code::INPUT };
    let request = Request { document: &document, common, wanted: &arguments.wanted, directory: &directory };
    request.drop_expectations(&mut model, Some("--over"), &mut false);
    let (code, report) = request.study(&model, study, &stem);
    if let Some(report) = report {
        print_out(&with_errors(&report, take_errors()));
    }
    code
}

/// The study that is named, or the only one.
fn chosen<'a>(arguments: &'a Arguments, known: &'a [String]) -> Option<&'a str> {
    match (&arguments.study, known) {
        (Some(study), _) => Some(study),
        (None, [only]) => Some(only),
        (None, []) => {
            print_error(
                "the model has no studies, so there is nothing to sweep",
                "add one, as `studies: { turn: { kinematics: { over: 1 turn, samples: 360 } } }`",
            );
            None
        }
        (None, several) => {
            print_error(
                &format!("the model has {} studies", several.len()),
                &format!("name one of them with `--study`: {}", several.join(", ")),
            );
            None
        }
    }
}

/// Parameters and the texts of their values; what has no `=` has been refused.
fn over(texts: &[String]) -> Option<Vec<(String, String)>> {
    let split = |text: &String| match text.split_once('=') {
        Some((name, values)) => Some((name.trim().to_string(), values.trim().to_string())),
        None => {
            print_error(
                &format!("`--over {text}` has no `=`"),
                "write `--over NAME=FROM..TO:COUNT` or a list, as `--over l3=0.3..0.8:26` or `--over \"l3=30 cm,40 cm\"`",
            );
            None
        }
    };
    texts.iter().map(split).collect()
}

/// A figure of all scalars over the one parameter, if the study draws no numbers of whole runs itself.
fn figure(study: &Study) -> Option<Plot> {
    let whole = |plot: &Plot| plot.name == FIGURE || plot.show.iter().any(|s| !matches!(s.what, ShownWhat::Column(_)));
    if study.sweep.len() != 1 || study.scalars.is_empty() || study.plots.iter().any(whole) {
        return None;
    }
    let scalars = study.scalars.iter().enumerate();
    let show = scalars.map(|(i, s)| Shown { name: s.name.clone(), what: ShownWhat::Scalar(i), dimension: s.dimension }).collect();
    Some(Plot { name: FIGURE.into(), show, over: None, unit: None })
}
