//! Friction and contact at joints: closed forms, agreement of coordinates, schemes and spaces, energies, faults.

mod blows;
mod bristles;
mod closed_forms;
mod clutches;
mod equivalence;
mod jumps;
mod on_stops;
mod one_sided;
mod redundant;
mod sharing;
mod sticking;
mod stops;

use crate::common;
use grashof::mechanism::Coordinates;
use grashof::results::{Certificate, Failure, March};
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run;

/// Settings of every scheme in all coordinates, each with the tolerance of its results.
fn forms() -> impl Iterator<Item = (String, f64)> {
    let of = |settings: &'static str, tolerance| {
        ["joint", "cartesian", "minimal"].map(|coordinates| (format!("{settings}, coordinates: {coordinates}"), tolerance))
    };
    closed_forms::SCHEMES.into_iter().flat_map(move |(settings, tolerance)| of(settings, tolerance))
}

/// A study of a text, or why it failed.
fn tried(text: &str, name: &str) -> Result<Outcome, Failure> {
    let model = common::model(text, Some(name));
    let study = model.study.clone().expect("the study");
    run(Case::new(&model, &study, &parameters(&model)), &|| false)
}

/// A study of a text, run to its end.
fn done(text: &str, name: &str) -> Outcome {
    common::study(text, name, Coordinates::Joint)
}

/// The last value of each column.
fn last(outcome: &Outcome) -> &[f64] {
    outcome.rows.last().expect("a row")
}

/// The certificate of a motion in time.
fn march(outcome: &Outcome) -> &March {
    let Certificate { march: Some(march), .. } = &outcome.certificate else { panic!("no motion in time") };
    march
}

/// Energy that the balance lacks, in parts of what it is about.
fn drift(outcome: &Outcome) -> f64 {
    march(outcome).energy_drift / march(outcome).energy_scale
}

/// Found and right agree.
#[track_caller]
fn close(what: &str, found: f64, right: f64, tolerance: f64) {
    assert!((found - right).abs() <= tolerance, "{what}: {found} instead of {right}, off by {:e}", found - right);
}
