//! What was compared.

use grashof::model::{Integrator, Study};

/// What an integrator came to with steps of one size.
#[derive(Clone, Debug, Default)]
pub(super) struct Row {
    pub(super) integrator: &'static str,
    pub(super) size: f64,
    /// From the first step to the last, s: the best of a few.
    pub(super) time: f64,
    /// Steps, rejected ones, evaluations, factorisations.
    pub(super) counts: [f64; 4],
    pub(super) error: f64,
    /// Largest |E − E(0) − work|, J.
    pub(super) energy: f64,
    /// Largest residuals of positions and velocities.
    pub(super) residuals: [f64; 2],
    /// Why it failed; empty if it did not.
    pub(super) reason: String,
}

/// The references, and how well they agree.
#[derive(Clone, Debug)]
pub(super) struct References {
    /// For implicit schemes, and for explicit ones: columns at the end.
    pub(super) columns: [Vec<f64>; 2],
    /// Their integrators and tolerances.
    pub(super) of: [(Integrator, f64); 2],
    /// Their difference, as an error; none if there is one reference alone.
    pub(super) agree: Option<f64>,
}

/// All that was compared.
pub(super) struct Compared<'a> {
    pub(super) study: &'a Study,
    /// Whether the sizes are those of fixed steps.
    pub(super) fixed: bool,
    pub(super) references: References,
    pub(super) rows: Vec<Row>,
}
