//! A model as a whole.

use super::bodies::{Attraction, Body};
use super::contacts::Clutch;
use super::diagnostics::Report;
use super::entities::{
    Coupling, Dimensions, DisplayUnit, Driver, Event, FirstOrder, Joint, Load, Measure, Motor, Parameter, Spring, Start, Table,
};
use super::rules::Check;
use super::study::Study;
use super::vocabulary::Quantity;
use crate::expression::{Id, Pool};
use std::fmt;

/// A model with its variants merged: everything that a mechanism and one study are built from.
#[derive(Clone, Debug)]
pub struct Model {
    /// The file's `name`.
    pub name: String,
    /// The file's `about`.
    pub about: String,
    /// `space`.
    pub space: Dimensions,
    /// Units in which results are shown, one for a dimension.
    pub units: Vec<DisplayUnit>,
    /// Every expression of the model.
    pub pool: Pool,
    /// What each input leaf of the pool stands for: `Node::Input(i)` is `inputs[i]`.
    pub inputs: Vec<Quantity>,
    /// Parameters in file order; `Node::Parameter(i)` is `parameters[i]`.
    pub parameters: Vec<Parameter>,
    /// Tables in file order; a table node's index points here.
    pub tables: Vec<Table>,
    /// 2 or 3 components, m/s²; 0 where gravity is a field.
    pub gravity: Vec<Id>,
    /// Gravity of each body where it is a field.
    pub attractions: Vec<Attraction>,
    /// Bodies in file order; the first is the ground.
    pub bodies: Vec<Body>,
    /// Joints in file order.
    pub joints: Vec<Joint>,
    /// Couplings in file order.
    pub couplings: Vec<Coupling>,
    /// Drivers in file order.
    pub drivers: Vec<Driver>,
    /// Loads in file order.
    pub loads: Vec<Load>,
    /// Springs in file order.
    pub springs: Vec<Spring>,
    /// Motors in file order.
    pub motors: Vec<Motor>,
    /// Clutches in file order.
    pub clutches: Vec<Clutch>,
    /// First-order states in file order; [`Quantity::State`] counts them.
    pub states: Vec<FirstOrder>,
    /// Measures in file order.
    pub measures: Vec<Measure>,
    /// Events in file order.
    pub events: Vec<Event>,
    /// Entries of `start` in file order.
    pub start: Vec<Start>,
    /// The study that the model was merged for, if any.
    pub study: Option<Study>,
    /// The variants that were applied, in order.
    pub variants: Vec<String>,
    /// Names of the parameters that were set from outside (`--set`), in the order given.
    pub set: Vec<String>,
    /// What must hold of its numbers, and of those of its study.
    pub checks: Vec<Check>,
    /// What it probably does not mean as it says it, and no error.
    pub warnings: Report,
}

impl Model {
    /// Gives back the room that lists which are long in large models were grown by and do not need.
    pub(super) fn release_spare_room(&mut self) {
        self.bodies.shrink_to_fit();
        self.joints.shrink_to_fit();
        self.springs.shrink_to_fit();
        self.loads.shrink_to_fit();
        self.start.shrink_to_fit();
        self.inputs.shrink_to_fit();
        self.checks.shrink_to_fit();
    }

    /// The event that changes one of some parameters, if there is one.
    pub(super) fn event_that_sets(&self, parameters: &[usize]) -> Option<&Event> {
        self.events.iter().find(|event| event.set.iter().any(|(parameter, _)| parameters.contains(parameter)))
    }

    /// A parameter that is set from outside although the study varies it.
    #[must_use]
    pub fn set_and_varied(&self) -> Option<&str> {
        let study = self.study.as_ref()?;
        let varied = study.sweep.iter().map(|s| s.parameter).chain(study.solve.iter().map(|s| s.parameter));
        varied.map(|p| self.parameters[p].name.as_str()).find(|name| self.set.iter().any(|set| set == name))
    }

    /// Writes all that decides its results: of the text of the file neither comments nor what another study is.
    ///
    /// # Errors
    /// Those of what is written to.
    pub fn write_content(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        // the index of the pool has no order: its nodes hold all
        let rest = Self { pool: Pool::new(), ..self.clone() };
        write!(to, "{:?} {:?} {rest:?}", self.pool.nodes(), self.pool.switches())
    }

    /// Puts numbers for the scalars that the study takes from others, in the order of its `take`.
    pub fn give(&mut self, taken: &[f64]) {
        for (input, quantity) in self.inputs.iter().enumerate() {
            if let Quantity::Taken(k) = quantity
                && let Some(value) = taken.get(*k)
            {
                self.pool.give(input as u32, *value);
            }
        }
        if let Some(study) = &mut self.study {
            study.take.iter_mut().zip(taken).for_each(|(take, value)| take.value = *value);
        }
    }
}
