//! What a dynamic study asks for, as numbers and as settings of the integrators.

use crate::kinematics::bounded::cheapest;
use crate::mechanism::Coordinates;
use crate::model::{self, Chart, Family, Forward, Integrator};
use crate::results::Failure;
use crate::studies::common::case::Case;
use crate::studies::common::pieces::WIDTH;
use crate::studies::integrators::OwnIntegrator;
use grashof_solvers::{Control, Level, Method, Settings, schemes};

/// A study in numbers.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) until: f64,
    pub(crate) every: Option<f64>,
    pub(crate) settings: Settings,
    pub(crate) coordinates: Coordinates,
    pub(crate) minimal: bool,
    /// How the integrator takes constraints.
    pub(crate) family: Family,
    /// An integrator from outside, instead of the method of the settings.
    pub(crate) integrator: Option<OwnIntegrator>,
}

impl Plan {
    /// The fixed step, s.
    pub(super) fn fixed_step(&self) -> Option<f64> {
        match self.settings.control {
            Control::Steps([h, _]) => Some(h),
            Control::Tolerance(_) => None,
        }
    }
}

/// Columns are resolved to so many times the tolerance, at worst to [`COARSEST`], to which those of a fixed step are.
const RESOLVED: f64 = 10.0;
const COARSEST: f64 = 1e-5;

/// Part of their size to which columns are worth being resolved: what the integration leaves uncertain needs no following.
pub(crate) fn resolution(control: Control) -> f64 {
    match control {
        Control::Tolerance(tolerance) => (RESOLVED * tolerance).clamp(WIDTH, COARSEST),
        Control::Steps(_) => COARSEST,
    }
}

/// Steps to a motion at least: where nothing acts an error allows any step, and what acts behind it must be met. With the stages of a
/// step places are then about as near to each other as the first looks at a driven motion.
const LONGEST: f64 = 20.0;

/// Tolerance of a study that gives none.
const TOLERANCE: f64 = 1e-8;

/// The scheme by the name of an integrator; parameters of the Newmark family at their usual values.
#[must_use]
pub fn method(integrator: Integrator) -> Method {
    match integrator {
        Integrator::Auto => Method::Auto,
        Integrator::Newmark => Method::Newmark { displacement: 0.25, velocity: 0.5 },
        Integrator::Hht => Method::Hht { alpha: -0.05 },
        Integrator::GeneralizedAlpha => Method::GeneralizedAlpha { rho: 0.8 },
        Integrator::Bdf => Method::Bdf { order: None },
        Integrator::Radau5 => Method::Radau5,
        Integrator::Dop853 => Method::Dop853,
        Integrator::Rk4 => Method::Rk4,
        Integrator::CentralDifference => Method::CentralDifference,
        Integrator::Ida => Method::Ida,
    }
}

/// Whether this program was built with a scheme.
#[must_use]
pub fn is_available(integrator: Integrator) -> bool {
    schemes::available(method(integrator))
}

/// The numbers of a study, which the build of its mechanism judges.
///
/// # Errors
/// If the scheme is not in this program.
pub(super) fn plan(case: Case<'_>, forward: &Forward) -> Result<Plan, Failure> {
    let study = case.study;
    let value = |id| case.value(id);
    let (until, every) = (value(forward.until), forward.every.map(value));
    let control = match forward.control {
        model::Control::Step(id) => {
            let h = value(id);
            Control::Steps([h, h])
        }
        model::Control::Tolerance(id) => Control::Tolerance(id.map_or(TOLERANCE, value).max(1e-14)),
    };
    if !is_available(forward.integrator) {
        return Err(Failure::Study {
            code: "no-ida",
            message: "the integrator `ida` (SUNDIALS) is not part of this program".into(),
            place: study.place_of("integrator"),
            help: "build it with `cargo build --release --features sundials` (needs cmake, make and clang), or use `bdf`".into(),
        });
    }
    let mut method = method(forward.integrator);
    let [alpha, beta, rho] = [forward.alpha, forward.beta, forward.rho].map(|id| id.map(value));
    match &mut method {
        Method::Newmark { displacement, velocity } => {
            (*displacement, *velocity) = (alpha.unwrap_or(*displacement), beta.unwrap_or(*velocity));
        }
        Method::Hht { alpha: x } => *x = alpha.unwrap_or(*x),
        Method::GeneralizedAlpha { rho: x } => *x = rho.unwrap_or(*x),
        Method::Bdf { order } => *order = forward.order,
        _ => {}
    }
    let level = match forward.level {
        None | Some(model::Level::Stabilized) => Level::Stabilized,
        Some(model::Level::Position) => Level::Position,
        Some(model::Level::Velocity) => Level::Velocity,
        Some(model::Level::Acceleration) => Level::Acceleration,
    };
    Ok(Plan {
        until,
        every,
        settings: Settings {
            method,
            level,
            control,
            locate: forward.locate,
            balance: true,
            longest: until / LONGEST,
            ..Settings::default()
        },
        coordinates: match forward.chart {
            Chart::Auto => cheapest(case.model, case.parameters),
            Chart::Joint | Chart::Minimal => Coordinates::Joint,
            Chart::Cartesian => Coordinates::Cartesian,
        },
        minimal: forward.chart == Chart::Minimal,
        family: forward.integrator.description().family,
        integrator: case.integrator.cloned(),
    })
}
