//! Studies with another integrator.

use crate::model::{Control, Family, Forward, INTEGRATORS, Integrator, Kind, Model, Study};
use grashof_solvers::{Scheme, System};
use std::fmt;
use std::sync::Arc;

/// All names, for a message.
pub fn names() -> String {
    INTEGRATORS.map(|d| format!("`{}`", d.name)).join(", ")
}

/// Whether it takes accelerations and projects; `auto` begins so.
pub fn is_explicit(integrator: Integrator) -> bool {
    integrator.description().family != Family::Implicit
}

/// An accurate scheme of another family: Radau IIA for explicit ones, Dormand and Prince for all others.
pub fn other(integrator: Integrator) -> Integrator {
    if is_explicit(integrator) { Integrator::Radau5 } else { Integrator::Dop853 }
}

/// Makes a scheme for a system.
type Make = dyn Fn(&dyn System) -> Box<dyn Scheme> + Send + Sync;

/// An integrator from outside of the library.
#[derive(Clone)]
pub struct OwnIntegrator {
    /// Its name.
    pub name: String,
    make: Arc<Make>,
}

impl OwnIntegrator {
    /// An integrator by its name and what makes its scheme for a system.
    pub fn new(name: &str, make: impl Fn(&dyn System) -> Box<dyn Scheme> + Send + Sync + 'static) -> Self {
        Self { name: name.into(), make: Arc::new(make) }
    }

    /// Its scheme for a system.
    pub fn scheme(&self, system: &dyn System) -> Box<dyn Scheme> {
        (self.make)(system)
    }
}

impl fmt::Debug for OwnIntegrator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OwnIntegrator").field("name", &self.name).finish_non_exhaustive()
    }
}

/// What computes a motion.
#[derive(Clone, Debug)]
pub enum By {
    /// An integrator of the library.
    Known(Integrator),
    /// One from outside, and one of the library that takes constraints as it does.
    Own(OwnIntegrator, Integrator),
}

impl By {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Known(integrator) => integrator.name(),
            Self::Own(own, _) => &own.name,
        }
    }

    /// The integrator of the library, or the one that takes constraints as it does.
    pub fn like(&self) -> Integrator {
        match self {
            Self::Known(integrator) | Self::Own(_, integrator) => *integrator,
        }
    }

    /// The one from outside.
    pub fn own(&self) -> Option<&OwnIntegrator> {
        if let Self::Own(own, _) = self { Some(own) } else { None }
    }
}

/// How steps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// By a relative tolerance.
    Tolerance(f64),
    /// Fixed, s.
    Fixed(f64),
}

impl Steps {
    /// The number, whichever it is.
    pub fn size(self) -> f64 {
        match self {
            Self::Tolerance(x) | Self::Fixed(x) => x,
        }
    }
}

/// A study by another integrator or with other steps, with rows every so many seconds; its numbers are added to the model's pool.
///
/// Parameters and constraint rows that belong to the study's own integrator are kept for that one alone, `order` and marching
/// across switches where steps are fixed.
pub fn changed(model: &mut Model, study: &Study, forward: &Forward, by: Integrator, steps: Steps, every: Option<f64>) -> Study {
    let own = by == forward.integrator;
    let kept = |id| if own { id } else { None };
    let fixed = matches!(steps, Steps::Fixed(_));
    let control = match steps {
        Steps::Tolerance(x) => Control::Tolerance(Some(model.pool.constant(x))),
        Steps::Fixed(h) => Control::Step(model.pool.constant(h)),
    };
    let kind = Kind::Dynamics(Forward {
        until: forward.until,
        every: every.map(|x| model.pool.constant(x)).or(forward.every),
        control,
        integrator: by,
        alpha: kept(forward.alpha),
        beta: kept(forward.beta),
        rho: kept(forward.rho),
        order: if own && fixed { forward.order } else { None },
        level: if own || !is_explicit(by) { forward.level } else { None },
        chart: forward.chart,
        locate: forward.locate || !fixed,
    });
    // what is compared are columns alone
    let (scalars, functionals, plots, expect) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    Study { kind, scalars, functionals, plots, expect, ..study.clone() }
}

/// The steps of a study as it stands.
pub fn steps(model: &Model, forward: &Forward, parameters: &[f64]) -> Steps {
    match forward.control {
        Control::Tolerance(id) => Steps::Tolerance(id.map_or(1e-8, |id| model.pool.value(id, parameters))),
        Control::Step(id) => Steps::Fixed(model.pool.value(id, parameters)),
    }
}
