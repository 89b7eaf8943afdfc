//! `grashof sweep`: a study of the file over values of parameters that are named on the command line.

use super::interrupt::{interrupted, watch_interrupts};
use super::run::{Request, Wanted, load, refused};
use super::shard::{Part, Shard};
use super::terminal::{take_errors, with_errors};
use super::{Common, code, files, print_error, print_out};
use grashof::model::{Plot, Samples, Selection, Shown, ShownWhat, Study};
use grashof::studies::loader::Loader;

/// The figure of scalars over the swept parameter, where the study has none of its own.
const FIGURE: &str = "scalars";

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Model file, or `-` for stdin
    pub(super) model: String,
    /// The study; may be left out if the model has only one
    #[arg(long, value_name = "S")]
    pub(super) study: Option<String>,
    /// Values of a parameter: a range with the number of values, as `l3=0.3..0.8:26` (with `:log` at the end for equal ratios), or a
    /// list, as `l3=30cm,40cm,50cm` (repeatable: all combinations, the last parameter fastest); or a distribution, as
    /// `"l3=normal(55 cm, 1 mm)"` or `"l3=uniform(54 cm, 56 cm)"`; or of several parameters a list of points, as
    /// `"l1,l3=10 cm,50 cm; 12 cm,55 cm"`
    #[arg(long, value_name = "NAME=VALUES", required = true)]
    pub(super) over: Vec<String>,
    #[command(flatten)]
    pub(super) drawn: Drawn,
    /// Compute one part of the sweep alone, the K-th of N, and keep it for `grashof gather`
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Compute on a Ray cluster, by the Python package `grashof`: the address of the cluster, or `local` for one of this machine alone. The
    /// table is written as a Parquet file
    #[arg(long, value_name = "ADDRESS", conflicts_with_all = ["shard", "json", "units", "format", "expect", "verify"])]
    pub(super) ray: Option<String>,
    #[command(flatten)]
    wanted: Wanted,
}

/// How many points are drawn from distributions.
#[derive(clap::Args)]
pub(super) struct Drawn {
    /// How many points are drawn from the distributions, all parameters at once
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    samples: Option<u32>,
    /// Decides which points are drawn
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u32,
}

impl Drawn {
    fn samples(&self) -> Option<Samples> {
        self.samples.map(|count| Samples { count: count as usize, seed: self.seed.into() })
    }

    /// Number of points, if it is given.
    pub(super) fn count(&self) -> Option<u32> {
        self.samples
    }

    /// What decides which points are drawn.
    pub(super) fn seed(&self) -> u32 {
        self.seed
    }
}

/// A sweep as it is asked for.
pub(super) struct Asked<'a> {
    pub(super) model: &'a str,
    pub(super) study: Option<&'a str>,
    /// Values of parameters; none if the study has a sweep of its own.
    pub(super) over: &'a [String],
    pub(super) drawn: &'a Drawn,
    pub(super) wanted: &'a Wanted,
    pub(super) part: Part,
}

/// Sweeps a study.
pub(super) fn sweep(arguments: &Arguments, common: &Common) -> u8 {
    let part = arguments.shard.map_or(Part::Whole, Part::Shard);
    let (model, study) = (arguments.model.as_str(), arguments.study.as_deref());
    computed(&Asked { model, study, over: &arguments.over, drawn: &arguments.drawn, wanted: &arguments.wanted, part }, common)
}

/// Computes a sweep, or a part of it, or gathers its parts.
pub(super) fn computed(asked: &Asked, common: &Common) -> u8 {
    watch_interrupts();
    let named: Vec<String> = asked.study.map(str::to_owned).into_iter().collect();
    let Some((document, selection, told)) = files::sound_for(asked.model, common, &named) else { return code::INPUT };
    files::print_notes(&document, common);
    let known = document.study_names();
    let (Some(study), Some(over)) = (chosen(asked.study, &known), over(asked.over)) else { return code::INPUT };
    let names: Vec<&str> = over.iter().flat_map(|(names, _)| names.split(',').map(str::trim)).collect();
    let (stem, swept) =
        if names.is_empty() { (study.to_owned(), None) } else { (format!("{study}-over-{}", names.join("+")), Some("--over")) };
    if swept.is_some() && known.contains(&stem) {
        print_error(
            &format!("the results of this sweep would be named `{stem}`, as a study of the file is"),
            "give that study another name",
        );
        return code::INPUT;
    }
    let selection = Selection { study: Some(study), over, samples: asked.drawn.samples(), ..selection };
    let mut model = match load(&mut Loader::new(&document, common.threads()), &document, common, &selection, &told) {
        Ok(model) => model,
        Err(_) if interrupted() => return code::INTERRUPTED,
        Err(code) => return code,
    };
    if let Some(parameter) = model.set_and_varied() {
        return refused(parameter, study);
    }
    if let (Some(study), true) = (&mut model.study, swept.is_some()) {
        let figure = figure(study);
        study.plots.extend(figure);
    }
    let Some(directory) = files::directory(asked.model, common) else { return code::INPUT };
    let request = Request { document: &document, common, wanted: asked.wanted, directory: &directory, part: &asked.part, report: false };
    request.drop_expectations(&mut model, swept.or(common.changes()), &mut false);
    let told = request.study(&model, study, &stem);
    if let Some(report) = told.json {
        print_out(&with_errors(&report, take_errors()));
    }
    told.code
}

/// The study that is named, or the only one.
fn chosen<'a>(named: Option<&'a str>, known: &'a [String]) -> Option<&'a str> {
    match (named, known) {
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
    Some(Plot { name: FIGURE.into(), show, ..Plot::default() })
}
