//! A motion in time by several integrators with steps of several sizes: error, time, work, drift.
//!
//! The error of a run is the largest |x − x*| / max(1, |x*|) over the columns x of the study at its end, in SI units: relative for
//! large columns, absolute for small ones. The reference x* is a run of another family at a far tighter tolerance, Radau IIA for
//! explicit integrators and Dormand-Prince for all others; how well these two agree is said, and no error below that means much.

use super::common::case::Case;
use super::compared::with_motion;
use super::dynamics;
use super::integrators::{self, By, OwnIntegrator, Steps, is_explicit};
use super::run::run;
use crate::model::{Forward, Integrator, Kind, Model, Study};
use crate::results::{Compared, ComparedRun, Failure, References};

/// Tolerance of the explicit reference; the implicit one is a hundredth of the tightest that is compared.
const TIGHT: f64 = 1e-13;
/// References that differ by more are none.
const UNSURE: f64 = 1e-4;
/// Runs that take less are repeated, s, and how often.
const SHORT: f64 = 0.2;
const REPEATS: usize = 5;

/// What a comparison asks and tells on its way.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Whether to end.
    pub stop: &'a dyn Fn() -> bool,
    /// The time, s.
    pub now: &'a dyn Fn() -> f64,
    /// Is called behind each reference and each row.
    pub done: &'a dyn Fn(),
}

/// Compares integrators with steps of several sizes; what is not computed any more since it shall end has no row.
///
/// # Errors
/// If there is no reference.
pub fn compare(
    model: &mut Model,
    study: &Study,
    forward: &Forward,
    asked: (&[By], &[Steps]),
    watch: Watch<'_>,
) -> Result<Compared, NoReference> {
    let values = super::common::case::parameters(model);
    let study = &with_motion(model, study);
    let (integrators, sizes) = asked;
    let fixed = matches!(sizes.first(), Some(Steps::Fixed(_)));
    let tightest = sizes.iter().map(|steps| steps.size()).fold(f64::INFINITY, f64::min);
    let mut bench = Bench { model, study, forward, values: &values, watch };
    let references = bench.references(if fixed { 1e-8 } else { tightest })?;
    let mut rows = Vec::new();
    for by in integrators {
        for &steps in sizes {
            let row = bench.row(by, steps, &references.columns[usize::from(is_explicit(by.like()))]);
            if (watch.stop)() {
                return Err(NoReference::Interrupted);
            }
            rows.push(row);
            (watch.done)();
        }
    }
    Ok(Compared { study: study.name.clone(), columns: study.columns.iter().map(|c| c.name.clone()).collect(), fixed, references, rows })
}

/// Why there is no reference.
#[derive(Debug)]
pub enum NoReference {
    /// No run began.
    Failure(Failure),
    /// Runs stopped on their way.
    Stopped(String),
    /// The two references differ by this error.
    Apart(f64),
    /// It was ended.
    Interrupted,
}

/// A study under many integrators.
struct Bench<'a> {
    model: &'a mut Model,
    study: &'a Study,
    forward: &'a Forward,
    values: &'a [f64],
    watch: Watch<'a>,
}

impl Bench<'_> {
    /// The references by dop853 and by radau5.
    fn references(&mut self, tightest: f64) -> Result<References, NoReference> {
        let explicit = self.end(Integrator::Dop853, TIGHT);
        (self.watch.done)();
        // how tight an implicit scheme can be depends on the motion: its Newton iterations end at rounding
        let mut implicit = (0.0, Err(NoReference::Interrupted));
        for looser in [1e-2, 1e-1, 1.0] {
            let tolerance = as_read(looser * tightest).clamp(TIGHT, 1e-10);
            if tolerance > implicit.0 {
                implicit = (tolerance, self.end(Integrator::Radau5, tolerance));
            }
            if implicit.1.is_ok() || (self.watch.stop)() {
                break;
            }
        }
        (self.watch.done)();
        if (self.watch.stop)() {
            return Err(NoReference::Interrupted);
        }
        let of = [(Integrator::Dop853, TIGHT), (Integrator::Radau5, implicit.0)].map(|(by, tolerance)| (by.name().to_string(), tolerance));
        match (explicit, implicit.1) {
            (Ok(a), Ok(b)) => {
                let off = error(&a, &b).max(error(&b, &a));
                if off.is_nan() || off > UNSURE {
                    return Err(NoReference::Apart(off));
                }
                Ok(References { columns: [a, b], of, agree: Some(off) })
            }
            // one alone must do, and it is said
            (Ok(x), Err(_)) => Ok(References { columns: [x.clone(), x], of: [of[0].clone(), of[0].clone()], agree: None }),
            (Err(_), Ok(x)) => Ok(References { columns: [x.clone(), x], of: [of[1].clone(), of[1].clone()], agree: None }),
            (Err(why), Err(_)) => Err(why),
        }
    }

    /// Columns at the end of a run.
    fn end(&mut self, by: Integrator, tolerance: f64) -> Result<Vec<f64>, NoReference> {
        let study = integrators::changed(self.model, self.study, self.forward, by, Steps::Tolerance(tolerance), None);
        let ended = self.recorded(&study, None).map_err(NoReference::Failure)?;
        if ended.reason.is_empty() { Ok(ended.columns) } else { Err(NoReference::Stopped(format!("`{}`: {}", by.name(), ended.reason))) }
    }

    /// A study under the bench, by an integrator of its own or one from outside.
    fn case<'c>(&'c self, study: &'c Study, integrator: Option<&'c OwnIntegrator>) -> Case<'c> {
        Case { integrator, ..Case::new(self.model, study, self.values).undrawn() }
    }

    /// A run with everything but its time.
    fn recorded(&self, study: &Study, own: Option<&OwnIntegrator>) -> Result<Ended, Failure> {
        let begin = (self.watch.now)();
        let outcome = run(self.case(study, own), self.watch.stop)?;
        let time = (self.watch.now)() - begin;
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
    fn stopped(&self, study: &Study, own: Option<&OwnIntegrator>) -> Option<String> {
        let Kind::Dynamics(forward) = &study.kind else { return None };
        dynamics::unrecorded(self.case(study, own), forward, &mut |_| {}).ok()?.stopped
    }

    /// The steps alone: time and counters of a run without a record.
    fn unrecorded(&self, study: &Study, own: Option<&OwnIntegrator>) -> Option<(f64, [f64; 4])> {
        let Kind::Dynamics(forward) = &study.kind else { return None };
        let (mut begin, mut time) = (0.0, f64::NAN);
        let now = self.watch.now;
        let mut timer = |on: bool| if on { begin = now() } else { time = now() - begin };
        let k = dynamics::unrecorded(self.case(study, own), forward, &mut timer).ok()?.counts;
        Some((time, [k.steps, k.rejected, k.evaluations, k.factorisations].map(|n| n as f64)))
    }

    /// One integrator with steps of one size.
    fn row(&mut self, by: &By, steps: Steps, reference: &[f64]) -> ComparedRun {
        let study = integrators::changed(self.model, self.study, self.forward, by.like(), steps, None);
        let own = by.own();
        let nan = f64::NAN;
        let mut row = ComparedRun {
            integrator: by.name().into(),
            size: steps.size(),
            time: nan,
            counts: [nan; 4],
            error: nan,
            energy: nan,
            residuals: [nan; 2],
            reason: String::new(),
        };
        let ended = match self.recorded(&study, own) {
            Ok(ended) => ended,
            Err(failure) => {
                // a run that fails in its first step has no record, but a reason of its own
                row.reason = self.stopped(&study, own).unwrap_or_else(|| failure.reason());
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
                let Some((time, counts)) = self.unrecorded(&study, own) else { break };
                (best, spent, row.counts) = (time.min(best), spent + time, counts);
                if spent > SHORT || (self.watch.stop)() {
                    break;
                }
            }
            row.time = if best.is_finite() { best } else { row.time };
        }
        row
    }
}

/// The number that is read where this one is written with twelve digits: a tenth of 1e-10 is 1e-11.
fn as_read(x: f64) -> f64 {
    format!("{x:.12e}").parse().unwrap_or(x)
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
    fn a_part_of_a_tolerance_is_the_number_that_is_read() {
        assert_eq!([as_read(0.1 * 1e-10), as_read(0.01 * 1e-4), as_read(0.0)], [1e-11, 1e-6, 0.0]);
    }

    #[test]
    fn errors_are_relative_for_large_columns_and_absolute_for_small_ones() {
        assert_eq!(error(&[1000.0, 0.5, f64::NAN], &[1001.0, 0.25, f64::NAN]), 0.25);
        assert_eq!(error(&[f64::NAN], &[1.0]), f64::INFINITY);
    }
}
