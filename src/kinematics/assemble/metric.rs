//! Units of velocity columns, and the metric in which the search for a start is shortest.

use crate::geometry::Space;
use crate::mechanism::{Mechanism, Step};

/// Kind of unit of each velocity column: 0 turns, 1 slides.
pub(crate) fn units<G: Space>(mechanism: &Mechanism<G>) -> Vec<u8> {
    let mut unit = vec![0; mechanism.nv];
    for step in &mechanism.steps {
        if let Step::Axis { turns: false, v, .. } = step {
            unit[*v] = 1;
        }
    }
    unit
}

/// Diagonal of the metric of the search (nv): 1 rad counts as much as the size of the mechanism, by bodies and joints.
pub(super) fn joint_metric<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Vec<f64> {
    mechanism.units(mechanism.start_size()).iter().map(|unit| 1.0 / (unit * unit)).collect()
}

/// |x|.
pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
