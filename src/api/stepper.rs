//! A motion in time that is advanced from outside by the integrator of its study.

use super::error::Error;
use crate::geometry::{Planar, Space, Spatial};
use crate::model::{Dimensions, Document, Forward, Kind, Model, Selection, Study};
use crate::par;
use crate::results::{Failure, Happened, Unknown};
use crate::studies::dynamics::stepping;
use crate::studies::loader::Loader;
use grashof_solvers::State;
use std::sync::Arc;

/// The mechanism of a motion at values of its parameters, which a [`Stepper`] moves.
pub struct Stepping {
    asked: Arc<Asked>,
    of: Of,
}

/// What was asked for.
struct Asked {
    document: Document,
    model: Model,
    study: Study,
}

impl Asked {
    fn failed(&self, failure: Failure) -> Error {
        Error::failed(&self.document, &self.study.name, failure)
    }
}

/// In the plane or in space.
enum Of {
    Planar(Box<stepping::Stepping<Planar<f64>>>),
    Spatial(Box<stepping::Stepping<Spatial<f64>>>),
}

impl Stepping {
    pub(super) fn new(document: &Document, selection: &Selection<'_>) -> Result<Self, Error> {
        let mut loader = Loader::new(document, par::processors());
        let model = loader.model(selection, &|| false).map_err(|why| Error::not_loaded(document, why))?;
        let name = selection.study.unwrap_or_default();
        let study = model.study.clone().ok_or_else(|| Unknown { what: "study", name: name.into(), known: document.study_names() })?;
        let Kind::Dynamics(forward) = study.kind.clone() else {
            return Err(Error::Refused {
                message: format!("study `{name}` is no motion in time, so nothing is there to step"),
                help: "name a study of the kind `dynamics`".into(),
            });
        };
        let of = Of::new(&model, &study, &forward).map_err(|failure| Error::failed(document, name, failure))?;
        Ok(Self { asked: Arc::new(Asked { document: document.clone(), model, study }), of })
    }

    /// The same mechanism with a parameter at another value, SI; those that depend on it follow. A motion goes on with it by
    /// [`Self::begin_at`] from where it has come to, as behind an event that sets the parameter.
    ///
    /// # Errors
    /// If there is no such parameter, or no mechanism with this value.
    pub fn set(&self, parameter: &str, value: f64) -> Result<Self, Error> {
        let Asked { model, study, .. } = &*self.asked;
        let known = || model.parameters.iter().map(|p| p.name.clone()).collect();
        let index = model.parameters.iter().position(|p| p.name == parameter);
        let index = index.ok_or_else(|| Unknown { what: "parameter", name: parameter.into(), known: known() })?;
        let of = match &self.of {
            Of::Planar(of) => of.set(model, study, index, value).map(|of| Of::Planar(Box::new(of))),
            Of::Spatial(of) => of.set(model, study, index, value).map(|of| Of::Spatial(Box::new(of))),
        };
        Ok(Self { of: of.map_err(|failure| self.asked.failed(failure))?, asked: Arc::clone(&self.asked) })
    }

    /// The motion from the start.
    ///
    /// # Errors
    /// If it does not begin.
    pub fn begin(&self) -> Result<Stepper<'_>, Error> {
        self.from(None)
    }

    /// The motion from where another [`Stepper`] has come to; what rests on a stop there or sticks does so still, as far as the forces
    /// let it.
    ///
    /// # Errors
    /// If it does not begin there.
    pub fn begin_at(&self, reached: &Reached) -> Result<Stepper<'_>, Error> {
        self.from(Some(&reached.of))
    }

    fn from(&self, from: Option<&stepping::Reached>) -> Result<Stepper<'_>, Error> {
        let Asked { model, study, .. } = &*self.asked;
        let flow: Result<Box<dyn Flow + '_>, Failure> = match &self.of {
            Of::Planar(of) => of.begin(model, study, from).map(|flow| Box::new(flow) as Box<dyn Flow>),
            Of::Spatial(of) => of.begin(model, study, from).map(|flow| Box::new(flow) as Box<dyn Flow>),
        };
        Ok(Stepper { flow: flow.map_err(|failure| self.asked.failed(failure))? })
    }

    /// Names of the columns of the study.
    #[must_use]
    pub fn columns(&self) -> Vec<String> {
        self.asked.study.columns.iter().map(|column| column.name.clone()).collect()
    }
}

impl Of {
    fn new(model: &Model, study: &Study, forward: &Forward) -> Result<Self, Failure> {
        Ok(match model.space {
            Dimensions::Planar => Self::Planar(Box::new(stepping::Stepping::new(model, study, forward)?)),
            Dimensions::Spatial => Self::Spatial(Box::new(stepping::Stepping::new(model, study, forward)?)),
        })
    }
}

/// How far a motion has come: its state, its events, what rests on stops or sticks, and the parameters that events have set.
#[derive(Clone, Debug)]
pub struct Reached {
    of: stepping::Reached,
}

/// A motion in time, advanced to one time after the other.
pub struct Stepper<'m> {
    flow: Box<dyn Flow + 'm>,
}

impl Stepper<'_> {
    /// Integrates to a time, s, or to an event that ends the motion; `stop` is asked between steps, and ends it where it is.
    ///
    /// # Errors
    /// Why the motion cannot go on; the state is the last good one.
    pub fn advance(&mut self, t: f64, stop: &dyn Fn() -> bool) -> Result<(), Error> {
        let halted = |message| Error::Refused { message, help: "end it before, or try another integrator".into() };
        self.flow.advance(t, stop).map_err(halted)
    }

    /// The present state: t, q, v and the states z of the model.
    #[must_use]
    pub fn state(&self) -> &State {
        self.flow.state()
    }

    /// How far it has come, for [`Stepping::begin_at`].
    #[must_use]
    pub fn reached(&self) -> Reached {
        Reached { of: self.flow.reached() }
    }

    /// The events of the model so far, in order, with their times.
    #[must_use]
    pub fn events(&self) -> &[Happened] {
        self.flow.events()
    }

    /// Whether an event has ended the motion: it goes no further.
    #[must_use]
    pub fn ended(&self) -> bool {
        self.flow.ended()
    }

    /// The columns of the study in the present state, SI.
    #[must_use]
    pub fn columns(&mut self) -> Vec<f64> {
        self.flow.columns()
    }
}

/// A motion in progress, in the plane or in space.
trait Flow {
    fn advance(&mut self, t: f64, stop: &dyn Fn() -> bool) -> Result<(), String>;
    fn state(&self) -> &State;
    fn reached(&self) -> stepping::Reached;
    fn events(&self) -> &[Happened];
    fn ended(&self) -> bool;
    fn columns(&mut self) -> Vec<f64>;
}

impl<G> Flow for stepping::Flow<'_, G>
where
    G: Space<S = f64>,
{
    fn advance(&mut self, t: f64, stop: &dyn Fn() -> bool) -> Result<(), String> {
        self.advance(t, stop)
    }

    fn state(&self) -> &State {
        self.state()
    }

    fn reached(&self) -> stepping::Reached {
        self.reached()
    }

    fn events(&self) -> &[Happened] {
        self.events()
    }

    fn ended(&self) -> bool {
        self.ended()
    }

    fn columns(&mut self) -> Vec<f64> {
        self.columns()
    }
}
