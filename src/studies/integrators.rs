//! Studies with another integrator.

use crate::model::{Control, Family, Forward, INTEGRATORS, Integrator, Kind, Model, Study};

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
