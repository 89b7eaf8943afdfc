//! The mechanisms of a run: one for all parameters, stops on which joints rest and contacts that stick, from one change to the next.

use super::massless::spins;
use crate::dynamics::Differentiable;
use crate::geometry::Space;
use crate::kinematics::assemble::Assembled;
use crate::kinematics::undefined::assembled;
use crate::mechanism::{Coordinates, Mechanism, build};
use crate::model::Model;
use crate::results::Failure;
use crate::studies::common::stops;
use std::cell::OnceCell;

/// Parameters that no earlier mechanism of a run had may be set so many times.
pub(super) const MOST_PHASES: usize = 5000;

/// What holds a mechanism beside its own rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Holds {
    /// Stops on which joints rest.
    pub(super) resting: Vec<usize>,
    /// Contacts that stick.
    pub(super) held: Vec<usize>,
}

/// A mechanism at given parameters and holds; and those that the run came to need after it.
pub(crate) struct Phases<G: Space<S = f64>> {
    pub(crate) mechanism: Differentiable<G>,
    pub(crate) parameters: Vec<f64>,
    pub(crate) start: Assembled,
    holds: Holds,
    next: OnceCell<Box<Phases<G>>>,
}

impl<G: Space<S = f64>> Phases<G> {
    /// The mechanism at the start.
    ///
    /// # Errors
    /// If the model has none, it cannot be assembled, or a thin body can turn about its own axis.
    pub(crate) fn new(model: &Model, parameters: &[f64], coordinates: Coordinates) -> Result<Self, Failure> {
        let (mechanism, start) = assembled::<G>(model, parameters, coordinates)?;
        stops::begins(model, &mechanism, &start)?;
        if let Some(failure) = spins(&mechanism, &start) {
            return Err(failure);
        }
        let mechanism = Differentiable::new(mechanism);
        Ok(Self { mechanism, parameters: parameters.to_vec(), start, holds: Holds::default(), next: OnceCell::new() })
    }

    /// The first phase.
    pub(super) fn first(&self) -> &Self {
        self
    }

    /// The mechanism with other parameters or holds, made when it is needed first; rows keep where the start has anchored them.
    ///
    /// # Errors
    /// If the parameters allow no mechanism, or were set anew too many times.
    pub(super) fn with(&self, model: &Model, parameters: &[f64], coordinates: Coordinates, holds: &Holds) -> Result<&Self, Failure> {
        let (mut phase, mut same, mut count) = (self, None, 0);
        loop {
            if phase.parameters == parameters {
                if phase.holds == *holds {
                    return Ok(phase);
                }
                if phase.holds == Holds::default() {
                    same = Some(phase);
                }
            }
            let Some(next) = phase.next.get() else { break };
            (phase, count) = (next, count + 1);
        }
        if count > MOST_PHASES {
            let message = format!("parameters, stops on which joints rest or contacts that stick have changed to {MOST_PHASES} others");
            return Err(Failure::numerical(message, "end the run before, or let parameters take fewer values"));
        }
        let mut mechanism = match same {
            Some(same) => Mechanism::clone(&same.mechanism),
            None => build::<G>(model, parameters, coordinates).map_err(Failure::Model)?,
        };
        self.anchor(&mut mechanism);
        holds.resting.iter().for_each(|stop| mechanism.rest(*stop));
        holds.held.iter().for_each(|contact| mechanism.hold(*contact));
        let mechanism = Differentiable::new(mechanism);
        let (parameters, start) = (parameters.to_vec(), self.start.clone());
        let next = Self { mechanism, parameters, start, holds: holds.clone(), next: OnceCell::new() };
        Ok(phase.next.get_or_init(|| Box::new(next)))
    }

    /// The mechanism with other parameters on its own; rows keep where the start has anchored them.
    ///
    /// # Errors
    /// If the parameters allow no mechanism.
    pub(super) fn anew(&self, model: &Model, parameters: &[f64], coordinates: Coordinates) -> Result<Self, Failure> {
        let mut mechanism = build::<G>(model, parameters, coordinates).map_err(Failure::Model)?;
        self.anchor(&mut mechanism);
        let mechanism = Differentiable::new(mechanism);
        let (parameters, start) = (parameters.to_vec(), self.start.clone());
        Ok(Self { mechanism, parameters, start, holds: Holds::default(), next: OnceCell::new() })
    }

    fn anchor(&self, mechanism: &mut Mechanism<G>) {
        for (row, before) in mechanism.rows.iter_mut().zip(&self.mechanism.rows) {
            if row.anchored {
                (row.offset, row.anchored) = (before.offset, before.anchored);
            }
        }
    }
}
