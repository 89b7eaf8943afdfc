//! The beginning of a study, up to its first evaluations: what `check` asks instead of running it.
//!
//! A sweep keeps a run that does not begin as a row, and a `solve` looks on where one does not; so a study is hindered if none of the
//! runs that are tried begins.

use super::common::case::{Case, parameters, parameters_with};
use super::common::clock::Variable;
use super::common::motion::Lost;
use super::common::observe::Observer;
use super::common::watched::Watched;
use super::driven::{clock, prepared, see, trace};
use super::run::run;
use super::sweep::grid;
use crate::geometry::{Planar, Space, Spatial};
use crate::mechanism::Coordinates;
use crate::model::{Dimensions, Kind, Model, Range, Study};
use crate::results::Failure;
use crate::studies::common::outcome::Outcome;
use std::cell::Cell;

/// Part of a range that is looked at.
const BEGIN: f64 = 1e-3;

/// Most runs of a sweep that are tried, evenly over it.
const TRIED: usize = 16;

/// Parts of the range of a `solve` that are tried, in this order.
const PARTS: [f64; 9] = [0.0, 1.0, 0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875];

/// Why a study does not begin, and the values of what it varies in the run that says so.
#[derive(Clone, Debug)]
pub struct Hindrance {
    /// Parameters and their values, SI.
    pub at: Vec<(String, f64)>,
    /// The reason.
    pub failure: Failure,
}

/// Begins the runs of a study until one of them begins.
///
/// # Errors
/// Why the first one would not begin, if none would.
pub fn rehearse(model: &Model, study: &Study) -> Result<(), Hindrance> {
    let points = grid(model, study);
    let tried = TRIED.min(points.len());
    let mut first = None;
    for k in 0..tried {
        let point = &points[k * (points.len() - 1) / (tried - 1).max(1)];
        let swept: Vec<(usize, f64)> = study.sweep.iter().map(|s| s.parameter).zip(point.iter().copied()).collect();
        for set in solved(model, study, &swept) {
            let Err(failure) = begin(Case::new(model, study, &parameters_with(model, &set))) else { return Ok(()) };
            let at = || set.iter().map(|&(parameter, x)| (model.parameters[parameter].name.clone(), x)).collect();
            first.get_or_insert_with(|| Hindrance { at: at(), failure });
        }
    }
    first.map_or(Ok(()), Err)
}

/// The values of a run with those that a `solve` tries.
fn solved(model: &Model, study: &Study, set: &[(usize, f64)]) -> Vec<Vec<(usize, f64)>> {
    let Some(solve) = &study.solve else { return vec![set.to_vec()] };
    let values = if set.is_empty() { parameters(model) } else { parameters_with(model, set) };
    let [low, high] = solve.between.map(|id| model.pool.value(id, &values));
    PARTS.iter().map(|part| [set, &[(solve.parameter, low + (high - low) * part)]].concat()).collect()
}

/// Begins a study at given parameter values and leaves it behind its first step.
fn begin(case: Case<'_>) -> Result<(), Failure> {
    match &case.study.kind {
        Kind::Kinematics(range) | Kind::Inverse(range) | Kind::Balance { range, .. } => match case.model.space {
            Dimensions::Planar => driven::<Planar<f64>>(case, range),
            Dimensions::Spatial => driven::<Spatial<f64>>(case, range),
        },
        kind => {
            // who asks whether to stop has begun; a motion in time makes its first step
            let steps = usize::from(matches!(kind, Kind::Dynamics(_)));
            let asked = Cell::new(0);
            let stop = || {
                asked.set(asked.get() + 1);
                asked.get() > steps
            };
            match run(case, &stop) {
                Ok(Outcome { undefined: Some(undefined), .. }) => Err(Failure::Undefined(undefined)),
                Err(failure) if asked.get() <= steps || matches!(failure, Failure::Undefined(_)) => Err(failure),
                _ => Ok(()),
            }
        }
    }
}

fn driven<G: Space<S = f64>>(case: Case<'_>, range: &Range) -> Result<(), Failure> {
    let Case { model, study, parameters, .. } = case;
    let (mechanism, start) = prepared::<G>(case, Coordinates::Joint)?;
    let clock = clock(case, &mechanism, &start, range)?.part(BEGIN);
    let watched = Watched::of(study);
    let observer = Observer::new(model, &mechanism, parameters, &watched.ids);
    let mut motion = trace(case, &mechanism, &start, clock, observer, watched.ids.len())?;
    let seen = see(&mut motion, case, &watched, 1, Variable { name: "the start", unit: (1.0, "") });
    match motion.path.gap.take().or_else(|| seen.err().and_then(|Lost { gap, .. }| gap)) {
        Some(gap) => Err(Failure::Undefined(gap.explain(model, study, "the start"))),
        None => Ok(()),
    }
}
