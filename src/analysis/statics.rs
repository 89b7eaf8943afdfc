//! Not there yet.

use super::outcome::{Failure, Outcome};
use crate::dynamics::LANES;
use crate::geometry::Space;
use crate::model::{Model, Study};
use crate::scalar::Dual;

pub(super) fn run<G>(
    model: &Model,
    study: &Study,
    parameters: &[f64],
    stop: &dyn Fn() -> bool,
) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
    G::Lift<Dual<LANES>>: Space<S = Dual<LANES>>,
{
    let _ = (model, parameters, stop);
    Err(Failure::Study { code: "later", message: "cannot be computed yet".into(), place: study.place.clone(), help: "run others".into() })
}
