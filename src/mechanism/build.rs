//! Model → mechanism: expressions become numbers and programs, names become indices, the joint graph becomes a tree.
//!
//! The one place that sees both the model file's entities and the mechanism. It works in the order of the mechanism:
//! bodies, joints and tree, then what constrains (cut joints, couplings, drivers), then what pulls.

mod bodies;
mod builder;
mod coordinates;
mod elements;
mod fault;
mod friction;
mod graph;
mod impacts;
mod particle;
mod programs;
mod starts;

use super::Mechanism;
use crate::geometry::Space;
use crate::model::Model;
use builder::Builder;
pub use coordinates::Coordinates;
pub use fault::BuildFault;

/// Builds the mechanism of a model at given parameter values (in the order of `model.parameters`).
///
/// All parameter values go through here, from the file, a sweep, a `solve`, a `take` or an event: the rules of the model file are
/// applied to them as they are when it is read.
///
/// # Errors
/// All faults found: values out of their range, quantities that cannot stand where they stand.
pub fn build<G: Space>(model: &Model, parameters: &[f64], coordinates: Coordinates) -> Result<Mechanism<G>, Vec<BuildFault>> {
    let faults = model.faults(parameters);
    if faults.is_empty() {
        return build_beside(model, parameters, coordinates);
    }
    let faults = faults.into_iter();
    Err(faults.map(|f| BuildFault { code: f.code, place: f.place, message: f.message, expected: f.expected, help: f.help }).collect())
}

/// As [`build`], a little beside parameters that the rules allow: a difference quotient may step over the end of a range.
///
/// # Errors
/// Where there is no such mechanism.
pub fn build_beside<G: Space>(model: &Model, parameters: &[f64], coordinates: Coordinates) -> Result<Mechanism<G>, Vec<BuildFault>> {
    let mut builder = Builder::<G>::new(model, parameters);
    builder.tables();
    builder.bodies();
    if !builder.faults.is_empty() {
        return Err(builder.faults);
    }
    builder.graph(coordinates);
    if !builder.faults.is_empty() {
        return Err(builder.faults);
    }
    builder.constraints();
    builder.forces();
    builder.states();
    builder.impacts();
    builder.gauges_of_programs();
    builder.mechanism.active_gauges = builder.mechanism.gauges.len();
    builder.remaining_gauges();
    builder.starts();
    builder.finish()
}

/// The joints, constraints and start values of a model without its forces, on the tree of all joints: one that neither coordinates nor
/// `cut` change, so that what a start leaves open is completed alike in all of them.
///
/// # Errors
/// As [`build`].
pub fn build_uncut<G: Space>(model: &Model, parameters: &[f64]) -> Result<Mechanism<G>, Vec<BuildFault>> {
    let mut builder = Builder::<G>::new(model, parameters);
    builder.honour_cuts = false;
    builder.tables();
    builder.bodies();
    builder.graph(Coordinates::Joint);
    if !builder.faults.is_empty() {
        return Err(builder.faults);
    }
    builder.constraints();
    builder.gauges_of_programs();
    builder.mechanism.active_gauges = builder.mechanism.gauges.len();
    builder.remaining_gauges();
    builder.starts();
    builder.finish()
}

/// Whether [`build`] in these coordinates has the tree of [`build_uncut`].
#[must_use]
pub fn is_uncut(model: &Model, coordinates: Coordinates) -> bool {
    coordinates == Coordinates::Joint && !model.joints.iter().any(graph::is_cut)
}
