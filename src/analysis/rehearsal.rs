//! The beginning of a study, up to its first evaluation: what `check` asks instead of running it.

use super::outcome::Failure;
use super::run::{clock, prepared, run};
use crate::geometry::{Planar, Space, Spatial};
use crate::mechanism::Coordinates;
use crate::model::{Dimensions, Kind, Model, Range, Study};
use std::cell::Cell;

/// Begins the study of a model at given parameter values and leaves it at its first step.
///
/// # Errors
/// Why the study would not begin.
pub fn rehearse(model: &Model, study: &Study, parameters: &[f64]) -> Result<(), Failure> {
    match &study.kind {
        Kind::Kinematics(range) | Kind::Inverse(range) | Kind::Balance { range, .. } => match model.space {
            Dimensions::Planar => driven::<Planar<f64>>(model, study, range, parameters),
            Dimensions::Spatial => driven::<Spatial<f64>>(model, study, range, parameters),
        },
        _ => {
            // who asks whether to stop has begun
            let begun = Cell::new(false);
            let stop = || {
                begun.set(true);
                true
            };
            let result = run(model, study, parameters, Coordinates::Joint, &stop);
            if begun.get() { Ok(()) } else { result.map(|_| ()) }
        }
    }
}

fn driven<G: Space<S = f64>>(model: &Model, study: &Study, range: &Range, parameters: &[f64]) -> Result<(), Failure> {
    let (mechanism, start) = prepared::<G>(model, study, parameters, Coordinates::Joint)?;
    clock(model, &mechanism, &start, range, parameters, study).map(|_| ())
}
