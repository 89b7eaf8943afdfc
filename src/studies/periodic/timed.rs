//! Whether a motion knows what time it is.

use crate::expression::Id;
use crate::geometry::Space;
use crate::mechanism::{Leaf, Mechanism};
use crate::model::{Model, Quantity};

/// Whether time itself acts on the motion: by drivers, forces, rates of states, or events.
pub(super) fn timed<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>) -> bool {
    let in_time = |ids: &[Id]| model.pool.inputs_of(ids).iter().any(|&i| model.inputs[i as usize] == Quantity::Time);
    let events: Vec<Id> = model.events.iter().flat_map(|e| [e.when].into_iter().chain(e.restitution.map(|r| r.e))).collect();
    let leaves = mechanism.programs().into_iter().flat_map(|p| &p.fills).any(|(_, leaf)| matches!(leaf, Leaf::Time));
    // a driver without a program moves at a constant speed
    !mechanism.drives.is_empty() || leaves || in_time(&events)
}
