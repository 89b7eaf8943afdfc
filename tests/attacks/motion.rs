//! Motions of made models, and how far two of them are apart.

use crate::common::model;
use grashof::studies::common::case::{Case, parameters};
use grashof::studies::common::outcome::Outcome;
use grashof::studies::run::run;

/// The study `move` of a model, or why it does not run to its end.
pub(crate) fn moved(text: &str) -> Result<Outcome, String> {
    let model = model(text, Some("move"));
    let study = model.study.clone().expect("the study");
    let outcome = run(Case::new(&model, &study, &parameters(&model)), &|| false).map_err(|f| f.reason().to_owned())?;
    match outcome.stopped {
        Some(reason) => Err(reason),
        None => Ok(outcome),
    }
}

/// Rows at the instants k `every`; a located switch has further ones.
fn asked(outcome: &Outcome, every: f64) -> Vec<&[f64]> {
    let end = outcome.rows.last().map_or(0.0, |row| row[0]);
    let near = |k: u32| outcome.rows.iter().find(|r| (r[0] - every * f64::from(k)).abs() < 1e-12).expect("a row at each instant");
    (0..).take_while(|k| every * f64::from(*k) < end + 1e-9).map(near).collect()
}

/// The largest difference of two motions with rows `every` so long and the same columns, by the size of each column and at least 1.
pub(crate) fn apart(a: &Outcome, b: &Outcome, every: f64) -> f64 {
    let (a, b) = (asked(a, every), asked(b, every));
    let size = |c: usize| a.iter().fold(1.0_f64, |m, r| m.max(r[c].abs()));
    let off = |c: usize| a.iter().zip(&b).map(move |(x, y)| (x[c] - y[c]).abs()).fold(0.0, f64::max);
    (0..a[0].len()).map(|c| off(c) / size(c)).fold(0.0, f64::max)
}
