//! A motion that is advanced from outside.

use super::error::Error;
use grashof_solvers::{Counts, Halt, Integration, Progress, Scheme, Settings, State, System};

/// A motion in time, advanced to one time after the other.
pub struct Simulation<'m> {
    system: Box<dyn System + 'm>,
    run: Integration,
}

impl<'m> Simulation<'m> {
    pub(super) fn new(
        mut system: Box<dyn System + 'm>,
        settings: Settings,
        scheme: Option<Box<dyn Scheme>>,
        start: State,
    ) -> Result<Self, Error> {
        let run = match scheme {
            Some(scheme) => Integration::with_scheme(&mut *system, scheme, settings, &start),
            None => Integration::new(&mut *system, settings, &start),
        };
        Ok(Self { run: run.map_err(|halt| stopped(&halt))?, system })
    }

    /// Integrates to a time, s, and gives the state there.
    ///
    /// # Errors
    /// Why the motion cannot go on; the state is the last good one.
    pub fn advance(&mut self, t: f64) -> Result<&State, Error> {
        if t > self.state().t {
            while self.run.advance(&mut *self.system, t).map_err(|halt| stopped(&halt))? != Progress::End {}
        }
        Ok(self.state())
    }

    /// The present state: t, q, v and the states z of the model.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.run.node().state
    }

    /// What was spent.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.run.engine.counts
    }
}

fn stopped(halt: &Halt) -> Error {
    Error::Refused { message: format!("the motion stops {halt}"), help: "end it before, or try another scheme".into() }
}
