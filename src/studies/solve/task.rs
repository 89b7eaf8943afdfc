//! What is asked of a `solve`, and the runs that were made for it.

use crate::model::{Model, Solve, Study};
use crate::studies::common::settings::Settings;

/// What is asked of a study, and who is told.
pub struct Task<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its study.
    pub study: &'a Study,
    /// What is varied, and until when.
    pub solve: &'a Solve,
    /// Other parameters with their values, as of a sweep.
    pub set: &'a [(usize, f64)],
    /// How runs are made; of all of them the solution alone is drawn.
    pub settings: Settings<'a>,
    /// Is told the parameter and the scalar of each run, from any thread.
    pub done: &'a (dyn Fn(f64, f64) + Sync),
}

/// A run that was made.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    /// Place in [0, 1].
    pub(super) x: f64,
    pub(super) scalar: f64,
    pub(super) target: f64,
    /// Why there is no value.
    pub(super) why: Option<String>,
}
