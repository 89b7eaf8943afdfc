//! A mechanism in the making, and what all parts of the build do to it.

use super::super::force::Output;
use super::super::gauge::{Along, Gauge, Measured};
use super::super::joint::Shape;
use super::super::{Function, Mechanism, Row};
use super::fault::BuildFault;
use crate::expression::{Id, LookupTable, Pool};
use crate::geometry::Space;
use crate::model::{Model, Quantity};
use std::sync::Arc;

/// Work in progress.
pub(super) struct Builder<'m, G: Space> {
    pub(super) model: &'m Model,
    pub(super) parameters: &'m [f64],
    pub(super) planar: bool,
    /// False if joints that are to be cut stand on the tree like others.
    pub(super) honour_cuts: bool,
    pub(super) mechanism: Mechanism<G>,
    pub(super) shapes: Vec<Shape>,
    /// Which bodies are point masses without a rotation.
    pub(super) particles: Vec<bool>,
    /// Gauge of each slot of each joint, once something needs it.
    pub(super) slots: Vec<Vec<Option<usize>>>,
    /// Measured quantities of cut joints' slots.
    pub(super) slot_measures: Vec<Vec<Measured<G>>>,
    /// Sign of the quaternion of each body, once something needs it.
    pub(super) signs: Vec<Option<usize>>,
    pub(super) pool: Pool,
    pub(super) inputs: Vec<Quantity>,
    pub(super) tables: Arc<[LookupTable]>,
    /// Outputs of the programs by stage.
    pub(super) position: Vec<Output>,
    pub(super) velocity: Vec<Output>,
    pub(super) time: Vec<Output>,
    pub(super) force: Vec<Output>,
    pub(super) states: Vec<Output>,
    pub(super) faults: Vec<BuildFault>,
}

impl<G: Space> Builder<'_, G> {
    pub(super) fn fault(&mut self, code: &'static str, place: &str, message: String, expected: &str, help: Option<String>) {
        self.faults.push(BuildFault { code, place: place.to_string(), message, expected: expected.to_string(), help });
    }

    /// A number from parameters; a fault and 0 if it is not finite.
    pub(super) fn number(&mut self, id: Id, place: &str) -> f64 {
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

    pub(super) fn optional(&mut self, id: Option<Id>, place: &str) -> f64 {
        id.map_or(0.0, |id| self.number(id, place))
    }

    /// Two or three numbers as a triple.
    pub(super) fn triple(&mut self, ids: &[Id], place: &str) -> [f64; 3] {
        let mut x = [0.0; 3];
        for (x, id) in x.iter_mut().zip(ids) {
            *x = self.number(*id, place);
        }
        x
    }

    /// Adds a gauge between two bodies.
    pub(super) fn gauge(&mut self, a: usize, b: usize, measured: Measured<G>, shift: f64) -> usize {
        let columns = match measured {
            Measured::Coordinate { along, .. } => vec![(along.v, 1.0)],
            _ => self.columns_between(a, b),
        };
        let points = |measured| if let Measured::Slide { pa, pb, .. } = measured { Some((pa, pb)) } else { None };
        let m = &mut self.mechanism;
        // those that no row or force needs are read apart
        let before = m.gauges.last().filter(|_| m.gauges.len() != m.active_gauges);
        let same_points =
            before.is_some_and(|g| (g.a, g.b) == (a, b) && points(measured).is_some() && points(g.measured) == points(measured));
        m.gauges.push(Gauge { a, b, measured, shift, columns, same_points });
        m.gauges.len() - 1
    }

    /// Velocity columns that move b (1) or a (−1) against the other, each rising. What is on both roads to the ground moves both bodies
    /// alike.
    fn columns_between(&self, a: usize, b: usize) -> Vec<(usize, f64)> {
        let m = &self.mechanism;
        let [mut of_a, mut of_b] = [a, b].map(|body| m.bodies[body].column);
        let (mut moves_a, mut moves_b) = (Vec::new(), Vec::new());
        // columns fall on the way to the ground, so that the larger one is on one of the roads only
        while of_a != of_b {
            let (road, found, sign) = if of_a > of_b { (&mut of_a, &mut moves_a, -1.0) } else { (&mut of_b, &mut moves_b, 1.0) };
            let Some(k) = *road else { break };
            found.push((k, sign));
            *road = m.above[k];
        }
        moves_b.into_iter().rev().chain(moves_a.into_iter().rev()).collect()
    }

    /// The gauge of a joint's coordinate.
    pub(super) fn slot(&mut self, joint: usize, slot: usize) -> Option<usize> {
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
    pub(super) fn remaining_gauges(&mut self) {
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
    pub(super) fn input(&mut self, quantity: Quantity) -> Id {
        let index = self.inputs.iter().position(|q| *q == quantity).unwrap_or_else(|| {
            self.inputs.push(quantity);
            self.inputs.len() - 1
        });
        self.pool.input(index as u32)
    }

    pub(super) fn row(&mut self, row: Row<G>) {
        self.mechanism.rows.push(row);
    }

    pub(super) fn function(&mut self, function: Function) -> usize {
        self.mechanism.functions.push(function);
        self.mechanism.functions.len() - 1
    }
}

/// A coordinate gauge's axis.
pub(super) fn along(q: usize, v: usize, turns: bool, reversed: bool) -> Along {
    Along { q, v, turns, sign: if reversed { -1.0 } else { 1.0 } }
}
