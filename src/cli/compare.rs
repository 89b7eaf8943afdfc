//! `grashof compare`: a motion in time by several integrators with steps of several sizes: error, time, work, drift.
//!
//! The error of a run is the largest |x − x*| / max(1, |x*|) over the columns x of the study at its end, in SI units: relative for
//! large columns, absolute for small ones. The reference x* is a run of another family at a far tighter tolerance, Radau IIA for
//! explicit integrators and Dormand-Prince for all others; how well these two agree is said, and no error below that means much.

use super::interrupt::{self, interrupted, watch_interrupts};
use super::progress::Progress;
use super::run::load;
use super::{Common, code, files, print_error, print_note, print_out};
use grashof::model::{Document, Forward, Integrator, Kind, Report, Study};
use grashof::output::{Staging, comparison, render_figure};
use grashof::results::{Compared, Failure};
use grashof::studies::common::case::parameters;
use grashof::studies::compare::{NoReference, Watch};
use grashof::studies::integrators::{self, By, Steps};
use grashof::studies::loader::Loader;
use grashof::studies::{self, dynamics};
use std::path::Path;
use std::time::Instant;

/// Compared if nothing is named: with a tolerance, and with fixed steps.
const BY_TOLERANCE: [Integrator; 3] = [Integrator::Dop853, Integrator::Radau5, Integrator::Bdf];
const BY_STEP: [Integrator; 4] = [Integrator::Rk4, Integrator::Newmark, Integrator::GeneralizedAlpha, Integrator::Bdf];
/// Tolerances if none are given.
const TOLERANCES: &str = "1e-4..1e-10";

/// Most sizes in a range.
const MOST: usize = 40;

#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Model file, or `-` for stdin
    model: String,
    /// The study, a motion in time [default: the only one of the file]
    #[arg(long, value_name = "S")]
    study: Option<String>,
    /// Integrators to compare [default: dop853,radau5,bdf, or rk4,newmark,generalized-alpha,bdf with fixed steps, and that of the study]
    #[arg(long, value_name = "A,B,C", value_delimiter = ',')]
    integrators: Vec<String>,
    /// Tolerances: a range in decades, or a list as 1e-4,1e-6 [default: 1e-4..1e-10]
    #[arg(long, value_name = "FROM..TO", conflicts_with = "steps")]
    tolerances: Option<String>,
    /// Fixed steps in seconds, likewise [default for a study with a step: four, two, one and half of it]
    #[arg(long, value_name = "FROM..TO")]
    steps: Option<String>,
    /// Print the results as JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Write no figure
    #[arg(long)]
    no_plots: bool,
}

/// Compares integrators.
pub(super) fn compare(arguments: &Arguments, common: &Common) -> u8 {
    watch_interrupts();
    compared(arguments, common).unwrap_or_else(|code| code)
}

fn compared(arguments: &Arguments, common: &Common) -> Result<u8, u8> {
    let integrators = integrators(&arguments.integrators)?;
    let document = files::document(&arguments.model, common).ok_or(code::INPUT)?;
    let name = match &arguments.study {
        Some(name) => name.clone(),
        None => only_motion(&document, common)?,
    };
    let selection = files::selection(common, Some(&name)).ok_or(code::INPUT)?;
    let stem = stem(&name);
    if common.output.is_none() && document.study_names().contains(&stem) {
        let message = format!("the files of a comparison of study `{name}` have the names of those of the study `{stem}`");
        return Err(refuse(&message, "say where they go with `-o DIR`"));
    }
    let report = document.check_all(&selection);
    if report.failed() {
        files::print(&report, common);
        return Err(code::INPUT);
    }
    let mut model = load(&mut Loader::new(&document, common.threads()), &document, common, &selection, &Report::default())?;
    let study = model.study.clone().ok_or(code::INPUT)?;
    let forward = motion(&study)?.clone();
    let values = parameters(&model);
    let (fixed, sizes) = sizes(arguments, integrators::steps(&model, &forward, &values))?;
    let integrators = if integrators.is_empty() { usual(fixed, forward.integrator) } else { integrators };
    usable(&integrators, fixed)?;
    let explain = |failure: &Failure| files::explain(&document, failure, &study.name, common);
    let directory = files::directory(&arguments.model, common).ok_or(code::INPUT)?;
    let ends: &[&str] = if arguments.no_plots { &["csv"] } else { &["csv", "svg", "png"] };
    files::prepare(&directory, &ends.iter().map(|end| format!("{stem}.{end}")).collect::<Vec<_>>(), common)?;

    let progress = Progress::new(&study.name, integrators.len() * sizes.len() + 2, common.quiet);
    let steps: Vec<Steps> = sizes.iter().map(|&size| if fixed { Steps::Fixed(size) } else { Steps::Tolerance(size) }).collect();
    let begun = Instant::now();
    let watch = Watch { stop: &interrupted, now: &|| begun.elapsed().as_secs_f64(), done: &|| progress.step() };
    let by: Vec<By> = integrators.iter().copied().map(By::Known).collect();
    let compared = studies::compare::compare(&mut model, &study, &forward, (&by, &steps), watch)
        .map_err(|why| no_reference(why, &study.name, &explain))?;
    drop(progress);
    finish(&compared, &directory, arguments, common)
}

/// Writes and prints.
fn finish(compared: &Compared, directory: &Path, arguments: &Arguments, common: &Common) -> Result<u8, u8> {
    let staging = written(compared, !arguments.no_plots);
    stop_if_interrupted()?;
    files::commit(&staging, directory, &stem(&compared.study), common)?;
    print_out(&if arguments.json { comparison::json(compared) } else { comparison::table(compared) });
    if compared.rows.iter().all(|r| !r.reason.is_empty()) {
        print_error(&format!("no integrator finished study `{}`", compared.study), "see the last column for the reasons");
        return Ok(code::NUMERICAL);
    }
    Ok(code::DONE)
}

/// What the files of a comparison of a study are called, without their ends.
fn stem(study: &str) -> String {
    format!("{study}-compare")
}

/// `STUDY-compare.csv`, `.svg` and `.png`.
fn written(compared: &Compared, plots: bool) -> Staging {
    let (mut staging, stem) = (Staging::new(), stem(&compared.study));
    staging.add(format!("{stem}.csv"), comparison::csv(compared));
    if plots {
        match render_figure(&comparison::figure(compared)) {
            Ok(picture) => {
                staging.add(format!("{stem}.svg"), picture.svg);
                staging.add(format!("{stem}.png"), picture.png);
            }
            Err(error) => print_note(&format!("warning: the figure cannot be drawn: {error}")),
        }
    }
    staging
}

fn stop_if_interrupted() -> Result<(), u8> {
    if !interrupted() {
        return Ok(());
    }
    interrupt::print_end("interrupted: nothing is written");
    Err(code::INTERRUPTED)
}

/// A usage error with its help.
fn refuse(message: &str, help: &str) -> u8 {
    print_error(message, help);
    code::INPUT
}

/// The integrators of their words.
fn integrators(words: &[String]) -> Result<Vec<Integrator>, u8> {
    let mut found = Vec::new();
    for text in words {
        let Some(integrator) = Integrator::named(text.trim()) else {
            return Err(refuse(
                &format!("there is no integrator `{}`", text.trim()),
                &format!("the integrators are {}", integrators::names()),
            ));
        };
        if !found.contains(&integrator) {
            found.push(integrator);
        }
    }
    Ok(found)
}

/// What is compared if nothing is named.
fn usual(fixed: bool, own: Integrator) -> Vec<Integrator> {
    let mut all = if fixed { BY_STEP.to_vec() } else { BY_TOLERANCE.to_vec() };
    if !all.contains(&own) && (fixed || own.description().tolerance) {
        all.insert(0, own);
    }
    all
}

/// Refuses what this program does not have, and what does not take a tolerance.
fn usable(integrators: &[Integrator], fixed: bool) -> Result<(), u8> {
    if let Some(&missing) = integrators.iter().find(|i| !dynamics::is_available(**i)) {
        return Err(refuse(
            &format!("the integrator `{}` (SUNDIALS) is not part of this program", missing.name()),
            "build it with `cargo build --release --features sundials` (needs cmake, make and clang), or leave it out",
        ));
    }
    if let Some(stepped) = integrators.iter().find(|i| !fixed && !i.description().tolerance) {
        return Err(refuse(
            &format!("`{}` takes fixed steps, no tolerance", stepped.name()),
            "give `--steps`, as `--steps 1e-2..1e-4`, or leave it out",
        ));
    }
    Ok(())
}

/// The study that is compared where none is named: the only motion in time of one run in the file.
fn only_motion(document: &Document, common: &Common) -> Result<String, u8> {
    let names = document.study_names();
    let is_motion = |name: &&String| {
        let model = files::selection(common, Some(name)).and_then(|selection| document.model(&selection).ok());
        let study = model.and_then(|model| model.study);
        study.is_some_and(|s| matches!(s.kind, Kind::Dynamics(_)) && s.sweep.is_empty() && s.solve.is_none())
    };
    let motions: Vec<&String> = names.iter().filter(is_motion).collect();
    match motions[..] {
        [only] => Ok(only.clone()),
        [] => {
            // faults of the file come before what it lacks
            let report = document.check_all(&files::selection(common, None).ok_or(code::INPUT)?);
            if report.failed() {
                files::print(&report, common);
                return Err(code::INPUT);
            }
            let help = "add one, as `studies: { swing: { dynamics: { until: 10 s } } }`";
            Err(refuse("the model has no motion in time of one run, so there is nothing to compare", help))
        }
        _ => {
            let list = motions.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            Err(refuse(&format!("the model has {} motions in time", motions.len()), &format!("name one with `--study`: {list}")))
        }
    }
}

/// The motion in time of a study of one run.
fn motion(study: &Study) -> Result<&Forward, u8> {
    let Kind::Dynamics(forward) = &study.kind else {
        return Err(refuse(
            &format!("study `{}` is no motion in time, so no integrator computes it", study.name),
            "name a study of the kind `dynamics` with `--study`",
        ));
    };
    if !study.sweep.is_empty() || study.solve.is_some() {
        return Err(refuse(
            &format!("study `{}` has many runs", study.name),
            "name a study of one run; other values of parameters are given by `--set NAME=VALUE`",
        ));
    }
    Ok(forward)
}

/// Whether steps are fixed, and the sizes to compare.
fn sizes(arguments: &Arguments, own: Steps) -> Result<(bool, Vec<f64>), u8> {
    let text = match (&arguments.tolerances, &arguments.steps, own) {
        (Some(text), ..) => return Ok((false, listed(text, "--tolerances", 0.1)?)),
        (None, Some(text), _) => return Ok((true, listed(text, "--steps", f64::INFINITY)?)),
        (None, None, Steps::Fixed(h)) => return Ok((true, vec![4.0 * h, 2.0 * h, h, 0.5 * h])),
        (None, None, Steps::Tolerance(_)) => TOLERANCES,
    };
    Ok((false, listed(text, "--tolerances", 0.1)?))
}

/// The numbers of `1e-3..1e-10`, decade by decade up to the end, or of a list.
fn listed(text: &str, flag: &str, most: f64) -> Result<Vec<f64>, u8> {
    let bound = if most.is_finite() { format!(" and at most {most}") } else { String::new() };
    let wrong = |what: String| {
        let help = format!("write a range in decades, as `{flag} 1e-3..1e-6`, or a list, as `{flag} 1e-4,1e-6`; numbers above 0{bound}");
        refuse(&format!("`{flag} {text}`: {what}"), &help)
    };
    let number = |part: &str| match part.trim().parse::<f64>() {
        Ok(x) if x > 0.0 && x <= most && x.is_finite() => Ok(x),
        _ => Err(wrong(format!("`{}` cannot be used", part.trim()))),
    };
    let Some((from, to)) = text.split_once("..") else {
        return text.split(',').map(number).collect();
    };
    let (from, to) = (number(from)?, number(to)?);
    let decades = (to / from).log10();
    let whole = (decades.abs() + 1e-9).floor() as usize;
    // the end that is asked for is compared, also where it lies within a decade
    let ends_between = decades.abs() > whole as f64 + 1e-9;
    let count = whole + 1 + usize::from(ends_between);
    if count > MOST {
        return Err(wrong(format!("{count} sizes are more than {MOST}")));
    }
    // read again, so that 1e-3 a thousandth of 1 is the same number as 1e-3
    let round = |x: f64| format!("{x:.12e}").parse().unwrap_or(x);
    let of_decade = (0..=whole).map(|k| round(from * 10f64.powf(decades.signum() * k as f64)));
    Ok(of_decade.chain(ends_between.then_some(to)).collect())
}

/// Prints why there is no reference; the exit code.
fn no_reference(why: NoReference, study: &str, explain: &dyn Fn(&Failure) -> u8) -> u8 {
    match why {
        NoReference::Failure(failure) => explain(&failure),
        NoReference::Stopped(why) => {
            print_error(&format!("there is no reference for study `{study}`: {why}"), "run the study itself first, and see why it stops");
            code::NUMERICAL
        }
        NoReference::Apart(off) => {
            print_error(
                &format!("the references of study `{study}`, by `dop853` and by `radau5`, differ by {off:.1e} at the end"),
                "compare a shorter motion: where small differences grow without bound, no error can be given; `grashof run --verify` shows where they begin, and whether events differ",
            );
            code::NUMERICAL
        }
        NoReference::Interrupted => {
            interrupt::print_end("interrupted: nothing is written");
            code::INTERRUPTED
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_go_by_decades_and_lists_as_they_stand() {
        let read = |text: &str| listed(text, "--tolerances", 0.1).unwrap();
        assert_eq!(read("1e-3..1e-6"), [1e-3, 1e-4, 1e-5, 1e-6]);
        assert_eq!(read("1e-6..1e-4"), [1e-6, 1e-5, 1e-4]);
        assert_eq!(read("2e-3..1e-5"), [2e-3, 2e-4, 2e-5, 1e-5]);
        assert_eq!(read("1e-4, 3e-7"), [1e-4, 3e-7]);
        assert_eq!(read("1e-4"), [1e-4]);
        for wrong in ["", "1e-3..", "0", "1", "-1e-3", "1e-3..x", "1e-300..1e-3", "nan"] {
            assert!(listed(wrong, "--tolerances", 0.1).is_err(), "{wrong}");
        }
    }
}
