//! Model → mechanism: expressions become numbers and programs, names become indices, the joint graph becomes a tree.
//!
//! The one place that sees both the model file's entities and the mechanism. It works in the order of the mechanism:
//! bodies, joints and tree, then what constrains (cut joints, couplings, drivers), then what pulls.

mod bodies;
mod elements;
mod friction;
mod graph;
mod particle;
mod programs;
mod starts;

use super::force::Output;
use super::gauge::{Along, Gauge, Measured};
use super::joint::Shape;
use super::{Function, Mechanism, Row};
use crate::expression::{Id, Pool, Table};
use crate::geometry::Space;
use crate::model::{Model, Quantity};
use std::sync::Arc;

/// A choice of spanning tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coordinates {
    /// Minimum depth; joints off the tree are cut.
    #[default]
    Joint,
    /// Every body free in the ground frame, every joint cut.
    Cartesian,
}

/// Why a model has no mechanism, at a place of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BuildFault {
    /// Kebab-case kind of the fault.
    pub code: &'static str,
    /// Path in the model file.
    pub place: String,
    /// What was found.
    pub message: String,
    /// What was expected.
    pub expected: String,
    /// One remedy.
    pub help: Option<String>,
}

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

/// Work in progress.
struct Builder<'m, G: Space> {
    model: &'m Model,
    parameters: &'m [f64],
    planar: bool,
    /// False if joints that are to be cut stand on the tree like others.
    honour_cuts: bool,
    mechanism: Mechanism<G>,
    shapes: Vec<Shape>,
    /// Which bodies are point masses without a rotation.
    particles: Vec<bool>,
    /// Gauge of each slot of each joint, once something needs it.
    slots: Vec<Vec<Option<usize>>>,
    /// Measured quantities of cut joints' slots.
    slot_measures: Vec<Vec<Measured<G>>>,
    /// Sign of the quaternion of each body, once something needs it.
    signs: Vec<Option<usize>>,
    pool: Pool,
    inputs: Vec<Quantity>,
    tables: Arc<[Table]>,
    /// Outputs of the programs by stage.
    position: Vec<Output>,
    velocity: Vec<Output>,
    time: Vec<Output>,
    force: Vec<Output>,
    states: Vec<Output>,
    faults: Vec<BuildFault>,
}

impl<G: Space> Builder<'_, G> {
    fn fault(&mut self, code: &'static str, place: &str, message: String, expected: &str, help: Option<String>) {
        self.faults.push(BuildFault { code, place: place.to_string(), message, expected: expected.to_string(), help });
    }

    /// A number from parameters; a fault and 0 if it is not finite.
    fn number(&mut self, id: Id, place: &str) -> f64 {
        let x = self.model.pool.value(id, self.parameters);
        if x.is_finite() {
            return x;
        }
        self.fault(
            "not-a-number",
            place,
            format!("this evaluates to {x}"),
            "a finite number",
            Some("look at the parameters it uses".into()),
        );
        0.0
    }

    fn optional(&mut self, id: Option<Id>, place: &str) -> f64 {
        id.map_or(0.0, |id| self.number(id, place))
    }

    /// Two or three numbers as a triple.
    fn triple(&mut self, ids: &[Id], place: &str) -> [f64; 3] {
        let mut x = [0.0; 3];
        for (x, id) in x.iter_mut().zip(ids) {
            *x = self.number(*id, place);
        }
        x
    }

    /// Adds a gauge between two bodies.
    fn gauge(&mut self, a: usize, b: usize, measured: Measured<G>, shift: f64) -> usize {
        let (pa, pb) = (&self.mechanism.bodies[a].path, &self.mechanism.bodies[b].path);
        // common ancestors move both bodies alike: they do not change what is measured between them
        let common = pa.iter().zip(pb).take_while(|(x, y)| x == y).count();
        let columns = match measured {
            Measured::Coordinate { along, .. } => vec![(along.v, 1.0)],
            _ => pb[common..].iter().map(|k| (*k, 1.0)).chain(pa[common..].iter().map(|k| (*k, -1.0))).collect(),
        };
        self.mechanism.gauges.push(Gauge { a, b, measured, shift, columns });
        self.mechanism.gauges.len() - 1
    }

    /// The gauge of a joint's coordinate.
    fn slot(&mut self, joint: usize, slot: usize) -> Option<usize> {
        if let Some(Some(gauge)) = self.slots[joint].get(slot) {
            return Some(*gauge);
        }
        let measured = *self.slot_measures[joint].get(slot)?;
        let (mut a, mut b) = (self.mechanism.joints[joint].a.0, self.mechanism.joints[joint].b.0);
        if self.mechanism.joints[joint].tree.is_none() && self.shapes[joint].seen_from_second(slot) {
            (a, b) = (b, a);
        }
        let shift = if slot == 0 { self.shapes[joint].zero } else { 0.0 };
        let gauge = self.gauge(a, b, measured, shift);
        self.slots[joint][slot] = Some(gauge);
        Some(gauge)
    }

    /// The gauges that nothing needed, for start values and outputs.
    fn remaining_gauges(&mut self) {
        for input in 0..self.model.inputs.len() {
            if let quantity @ Quantity::Quaternion { .. } = self.model.inputs[input] {
                self.gauge_of(quantity);
            }
        }
        for joint in 0..self.shapes.len() {
            let slots: Vec<usize> = (0..self.slot_measures[joint].len()).filter_map(|s| self.slot(joint, s)).collect();
            self.mechanism.joints[joint].slots = slots;
        }
    }

    /// The input of the extended pool that stands for a quantity.
    fn input(&mut self, quantity: Quantity) -> Id {
        let index = self.inputs.iter().position(|q| *q == quantity).unwrap_or_else(|| {
            self.inputs.push(quantity);
            self.inputs.len() - 1
        });
        self.pool.input(index as u32)
    }

    fn row(&mut self, row: Row<G>) {
        self.mechanism.rows.push(row);
    }

    fn function(&mut self, function: Function) -> usize {
        self.mechanism.functions.push(function);
        self.mechanism.functions.len() - 1
    }
}

/// A coordinate gauge's axis.
fn along(q: usize, v: usize, turns: bool, reversed: bool) -> Along {
    Along { q, v, turns, sign: if reversed { -1.0 } else { 1.0 } }
}
