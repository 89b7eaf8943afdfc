//! The schemes, and how one is chosen.

use crate::System;
use crate::scheme::Scheme;
use crate::settings::Settings;

#[cfg(not(feature = "sundials"))]
mod absent;
mod auto;
mod bdf;
mod central_difference;
mod dop853;
mod explicit;
#[cfg(feature = "sundials")]
mod ida;
mod newmark;
mod radau5;
mod rk4;

/// The schemes by name, with their parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Explicit or implicit, as the motion asks.
    Auto,
    /// Newmark 1959: `displacement` is the textbook's β, `velocity` its γ.
    Newmark {
        /// Weight of the new acceleration in the displacement.
        displacement: f64,
        /// Weight of the new acceleration in the velocity.
        velocity: f64,
    },
    /// Hilber, Hughes & Taylor 1977, α in [−1/3, 0].
    Hht {
        /// α.
        alpha: f64,
    },
    /// Chung & Hulbert 1993 in the form of Arnold & Brüls 2007.
    GeneralizedAlpha {
        /// Spectral radius at infinity, 0 to 1.
        rho: f64,
    },
    /// Backward differences, variable order, or the given one with given steps.
    Bdf {
        /// 1 to 5; none: chosen by the error.
        order: Option<usize>,
    },
    /// Radau IIA with three stages (Hairer & Wanner, Solving ODEs II, section IV.8).
    Radau5,
    /// Dormand & Prince's method of order 8 (Hairer, Nørsett & Wanner, Solving ODEs I, section II.5).
    Dop853,
    /// The classical Runge-Kutta method.
    Rk4,
    /// Central differences, implicit in the forces that depend on velocity.
    CentralDifference,
    /// IDA of SUNDIALS, where this build has it: see [`available`].
    Ida,
}

impl Method {
    /// Whether Newton's method solves its steps.
    pub fn is_implicit(self) -> bool {
        !matches!(self, Self::Dop853 | Self::Rk4 | Self::CentralDifference | Self::Auto)
    }
}

/// Whether this build has the scheme: `Ida` needs the feature `sundials`.
pub fn available(method: Method) -> bool {
    method != Method::Ida || cfg!(feature = "sundials")
}

/// A scheme with room for a system; one that is not [`available`] refuses each start.
pub fn new(method: Method, settings: Settings, system: &dyn System) -> Box<dyn Scheme> {
    let _ = settings;
    match method {
        Method::Auto => Box::new(auto::Auto::new(settings, system)),
        Method::Dop853 => Box::new(dop853::Dop853::new(system, !settings.locate)),
        Method::Bdf { order } => Box::new(bdf::Bdf::new(order, settings, system)),
        Method::Radau5 => Box::new(radau5::Radau5::new(settings, system)),
        Method::Newmark { displacement, velocity } => {
            Box::new(newmark::Newmark::new(newmark::Parameters::newmark(displacement, velocity), settings, system))
        }
        Method::Hht { alpha } => Box::new(newmark::Newmark::new(newmark::Parameters::hht(alpha), settings, system)),
        Method::GeneralizedAlpha { rho } => Box::new(newmark::Newmark::new(newmark::Parameters::generalized_alpha(rho), settings, system)),
        Method::CentralDifference => Box::new(central_difference::CentralDifference::new(settings, system)),
        #[cfg(feature = "sundials")]
        Method::Ida => Box::new(ida::Ida::new(system, !settings.locate)),
        #[cfg(not(feature = "sundials"))]
        Method::Ida => Box::new(absent::Absent),
        _ => Box::new(rk4::Rk4::new(system)),
    }
}
