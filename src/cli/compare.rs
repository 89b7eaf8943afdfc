//! `grashof compare`: a motion in time by several integrators with steps of several sizes: error, time, work, drift.
//!
//! The error of a run is the largest |x − x*| / max(1, |x*|) over the columns x of the study at its end, in SI units: relative for
//! large columns, absolute for small ones. The reference x* is a run of another family at a far tighter tolerance, Radau IIA for
//! explicit integrators and Dormand-Prince for all others; how well these two agree is said, and no error below that means much.

use super::interrupt::{self, interrupted, watch_interrupts};
use super::progress::Progress;
use super::run::{Scalars, load};
use super::schemes::{self, Steps, is_explicit};
use super::{Common, code, fail, files, say};
use compared::{Compared, References, Row};
use grashof::model::{Document, Forward, Integrator, Kind, Model, Study};
use grashof::results::Failure;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::dynamics;
use grashof::studies::run::run;
use std::path::Path;
use std::time::Instant;

mod compared;
mod output;

/// Compared if nothing is named: with a tolerance, and with fixed steps.
const BY_TOLERANCE: [Integrator; 3] = [Integrator::Dop853, Integrator::Radau5, Integrator::Bdf];
const BY_STEP: [Integrator; 4] = [Integrator::Rk4, Integrator::Newmark, Integrator::GeneralizedAlpha, Integrator::Bdf];
/// Tolerances if none are given.
const TOLERANCES: &str = "1e-4..1e-10";
/// Tolerance of the explicit reference; the implicit one is a hundredth of the tightest that is compared.
const TIGHT: f64 = 1e-13;
/// References that differ by more are none.
const UNSURE: f64 = 1e-4;
/// Runs that take less are repeated, s, and how often.
const SHORT: f64 = 0.2;
const REPEATS: usize = 5;
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
    let report = document.check_all(&files::selection(common, Some(&name)).ok_or(code::INPUT)?);
    if report.failed() {
        files::print(&report, common);
        return Err(code::INPUT);
    }
    let mut model = load(&document, common, &name, &mut Scalars::new())?;
    let study = model.study.clone().ok_or(code::INPUT)?;
    let forward = motion(&study)?.clone();
    let values = parameters(&model);
    let (fixed, sizes) = sizes(arguments, schemes::steps(&model, &forward, &values))?;
    let integrators = if integrators.is_empty() { usual(fixed, forward.integrator) } else { integrators };
    usable(&integrators, fixed)?;
    let explain = |failure: &Failure| files::explain(&document, failure, &study.name, common);
    let directory = files::directory(&arguments.model, common).ok_or(code::INPUT)?;
    let ends: &[&str] = if arguments.no_plots { &["csv"] } else { &["csv", "svg", "png"] };
    files::prepare(&directory, &ends.iter().map(|end| format!("compare.{end}")).collect::<Vec<_>>(), common)?;

    let progress = Progress::new(&study.name, integrators.len() * sizes.len() + 2, common.quiet);
    let mut bench = Bench { model: &mut model, study: &study, forward: &forward, values: &values };
    let tightest = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    let references = bench.references(if fixed { 1e-8 } else { tightest }, &progress).map_err(|why| why.told(&study.name, &explain))?;
    let mut rows = Vec::new();
    for &by in &integrators {
        for &size in &sizes {
            let steps = if fixed { Steps::Fixed(size) } else { Steps::Tolerance(size) };
            let row = bench.row(by, steps, &references.columns[usize::from(is_explicit(by))]);
            stop_if_interrupted()?;
            rows.push(row);
            progress.step();
        }
    }
    drop(progress);
    let compared = Compared { study: &study, fixed, references, rows };
    finish(&compared, &directory, arguments, common)
}

/// Writes and prints.
fn finish(compared: &Compared<'_>, directory: &Path, arguments: &Arguments, common: &Common) -> Result<u8, u8> {
    let staging = output::files(compared, !arguments.no_plots);
    stop_if_interrupted()?;
    files::commit(&staging, directory, "compare", common)?;
    say(&if arguments.json { output::json(compared) } else { output::table(compared) });
    if compared.rows.iter().all(|r| !r.reason.is_empty()) {
        fail(&format!("no integrator got through study `{}`", compared.study.name), "the reasons stand in the last column");
        return Ok(code::NUMERICAL);
    }
    Ok(code::DONE)
}

fn stop_if_interrupted() -> Result<(), u8> {
    if !interrupted() {
        return Ok(());
    }
    interrupt::tell_end("interrupted: nothing is written");
    Err(code::INTERRUPTED)
}

/// A usage error with its help.
fn refuse(message: &str, help: &str) -> u8 {
    fail(message, help);
    code::INPUT
}

/// The integrators of their words.
fn integrators(words: &[String]) -> Result<Vec<Integrator>, u8> {
    let mut found = Vec::new();
    for text in words {
        let Some(integrator) = Integrator::named(text.trim()) else {
            return Err(refuse(&format!("there is no integrator `{}`", text.trim()), &format!("the integrators are {}", schemes::names())));
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

/// The numbers of `1e-3..1e-10`, decade by decade, or of a list.
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
    let count = (decades.abs() + 1e-9).floor() as usize + 1;
    if count > MOST {
        return Err(wrong(format!("{count} sizes are more than {MOST}")));
    }
    // read again, so that 1e-3 a thousandth of 1 is the same number as 1e-3
    let round = |x: f64| format!("{x:.12e}").parse().unwrap_or(x);
    Ok((0..count).map(|k| round(from * 10f64.powf(decades.signum() * k as f64))).collect())
}

/// Why there is no reference.
enum NoReference {
    Failure(Failure),
    Stopped(String),
    Apart(f64),
    Interrupted,
}

impl NoReference {
    /// Prints it; the exit code.
    fn told(self, study: &str, explain: &dyn Fn(&Failure) -> u8) -> u8 {
        match self {
            Self::Failure(failure) => explain(&failure),
            Self::Stopped(why) => {
                fail(&format!("there is no reference for study `{study}`: {why}"), "run the study itself first, and see why it stops");
                code::NUMERICAL
            }
            Self::Apart(off) => {
                fail(
                    &format!("the references of study `{study}`, by `dop853` and by `radau5`, differ by {off:.1e} at the end"),
                    "compare a shorter motion: where small differences grow without bound, no error can be told; `grashof run --verify` tells where they begin, and whether events differ",
                );
                code::NUMERICAL
            }
            Self::Interrupted => {
                interrupt::tell_end("interrupted: nothing is written");
                code::INTERRUPTED
            }
        }
    }
}

/// A study under many integrators.
struct Bench<'a> {
    model: &'a mut Model,
    study: &'a Study,
    forward: &'a Forward,
    values: &'a [f64],
}

impl Bench<'_> {
    /// The references by dop853 and by radau5.
    fn references(&mut self, tightest: f64, progress: &Progress) -> Result<References, NoReference> {
        let explicit = self.end(Integrator::Dop853, TIGHT);
        progress.step();
        // how tight an implicit scheme can be depends on the motion: its Newton iterations end at rounding
        let mut implicit = (0.0, Err(NoReference::Interrupted));
        for looser in [1e-2, 1e-1, 1.0] {
            let tolerance = (looser * tightest).clamp(TIGHT, 1e-10);
            if tolerance > implicit.0 {
                implicit = (tolerance, self.end(Integrator::Radau5, tolerance));
            }
            if implicit.1.is_ok() || interrupted() {
                break;
            }
        }
        progress.step();
        if interrupted() {
            return Err(NoReference::Interrupted);
        }
        let of = [(Integrator::Dop853, TIGHT), (Integrator::Radau5, implicit.0)];
        match (explicit, implicit.1) {
            (Ok(a), Ok(b)) => {
                let off = error(&a, &b).max(error(&b, &a));
                if off.is_nan() || off > UNSURE {
                    return Err(NoReference::Apart(off));
                }
                Ok(References { columns: [a, b], of, agree: Some(off) })
            }
            // one alone must do, and it is said
            (Ok(x), Err(_)) => Ok(References { columns: [x.clone(), x], of: [of[0]; 2], agree: None }),
            (Err(_), Ok(x)) => Ok(References { columns: [x.clone(), x], of: [of[1]; 2], agree: None }),
            (Err(why), Err(_)) => Err(why),
        }
    }

    /// Columns at the end of a run.
    fn end(&mut self, by: Integrator, tolerance: f64) -> Result<Vec<f64>, NoReference> {
        let study = schemes::changed(self.model, self.study, self.forward, by, Steps::Tolerance(tolerance), None);
        let ended = self.recorded(&study).map_err(NoReference::Failure)?;
        if ended.reason.is_empty() { Ok(ended.columns) } else { Err(NoReference::Stopped(format!("`{}`: {}", by.name(), ended.reason))) }
    }

    /// A run with everything but its time.
    fn recorded(&self, study: &Study) -> Result<Ended, Failure> {
        let begin = Instant::now();
        let outcome = run(Case { model: self.model, study, parameters: self.values }, &interrupted)?;
        let time = begin.elapsed().as_secs_f64();
        let march = outcome.certificate.march.unwrap_or_default();
        let k = march.counts;
        Ok(Ended {
            columns: outcome.rows.last().map_or_else(Vec::new, |row| row[..study.columns.len()].to_vec()),
            time,
            counts: [k.steps, k.rejected, k.evaluations, k.factorisations].map(|n| n as f64),
            energy: march.energy_drift,
            residuals: [outcome.certificate.constraint, march.velocity],
            reason: outcome.stopped.unwrap_or_default(),
        })
    }

    /// Why a run without a record stops.
    fn stopped(&self, study: &Study) -> Option<String> {
        let Kind::Dynamics(forward) = &study.kind else { return None };
        dynamics::bare(Case { model: self.model, study, parameters: self.values }, forward, &mut |_| {}).ok()?.stopped
    }

    /// The steps alone: time and counters of a run without a record.
    fn bare(&self, study: &Study) -> Option<(f64, [f64; 4])> {
        let Kind::Dynamics(forward) = &study.kind else { return None };
        let (mut begin, mut time) = (Instant::now(), f64::NAN);
        let mut timer = |on: bool| if on { begin = Instant::now() } else { time = begin.elapsed().as_secs_f64() };
        let k = dynamics::bare(Case { model: self.model, study, parameters: self.values }, forward, &mut timer).ok()?.counts;
        Some((time, [k.steps, k.rejected, k.evaluations, k.factorisations].map(|n| n as f64)))
    }

    /// One integrator with steps of one size.
    fn row(&mut self, by: Integrator, steps: Steps, reference: &[f64]) -> Row {
        let study = schemes::changed(self.model, self.study, self.forward, by, steps, None);
        let nan = f64::NAN;
        let mut row = Row {
            integrator: by.name(),
            size: steps.size(),
            time: nan,
            counts: [nan; 4],
            error: nan,
            energy: nan,
            residuals: [nan; 2],
            reason: String::new(),
        };
        let ended = match self.recorded(&study) {
            Ok(ended) => ended,
            Err(failure) => {
                // a run that fails in its first step has no record, but a reason of its own
                row.reason = self.stopped(&study).unwrap_or_else(|| failure.reason());
                return row;
            }
        };
        (row.time, row.counts, row.energy, row.residuals) = (ended.time, ended.counts, ended.energy, ended.residuals);
        row.reason = ended.reason;
        if !row.reason.is_empty() {
            return row;
        }
        row.error = error(&ended.columns, reference);
        // where events set parameters the mechanism is built anew on the way, and the whole run is what is timed
        if self.model.events.iter().all(|e| e.set.is_empty()) {
            let (mut spent, mut best) = (0.0, f64::INFINITY);
            for _ in 0..REPEATS {
                let Some((time, counts)) = self.bare(&study) else { break };
                (best, spent, row.counts) = (time.min(best), spent + time, counts);
                if spent > SHORT || interrupted() {
                    break;
                }
            }
            row.time = if best.is_finite() { best } else { row.time };
        }
        row
    }
}

/// What a recorded run came to.
struct Ended {
    columns: Vec<f64>,
    time: f64,
    counts: [f64; 4],
    energy: f64,
    residuals: [f64; 2],
    reason: String,
}

/// Largest |x − x*| / max(1, |x*|); columns that are defined in neither are left out.
fn error(columns: &[f64], reference: &[f64]) -> f64 {
    let off = |(x, r): (&f64, &f64)| match (x.is_nan(), r.is_nan()) {
        (true, true) => 0.0,
        (false, false) => (x - r).abs() / r.abs().max(1.0),
        _ => f64::INFINITY,
    };
    columns.iter().zip(reference).map(off).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_go_by_decades_and_lists_as_they_stand() {
        let read = |text: &str| listed(text, "--tolerances", 0.1).unwrap();
        assert_eq!(read("1e-3..1e-6"), [1e-3, 1e-4, 1e-5, 1e-6]);
        assert_eq!(read("1e-6..1e-4"), [1e-6, 1e-5, 1e-4]);
        assert_eq!(read("2e-3..1e-5"), [2e-3, 2e-4, 2e-5]);
        assert_eq!(read("1e-4, 3e-7"), [1e-4, 3e-7]);
        assert_eq!(read("1e-4"), [1e-4]);
        for wrong in ["", "1e-3..", "0", "1", "-1e-3", "1e-3..x", "1e-300..1e-3", "nan"] {
            assert!(listed(wrong, "--tolerances", 0.1).is_err(), "{wrong}");
        }
    }

    #[test]
    fn errors_are_relative_for_large_columns_and_absolute_for_small_ones() {
        assert_eq!(error(&[1000.0, 0.5, f64::NAN], &[1001.0, 0.25, f64::NAN]), 0.25);
        assert_eq!(error(&[f64::NAN], &[1.0]), f64::INFINITY);
    }
}
