//! The schemes, and how one is chosen.

use crate::System;
use crate::method::Method;
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

/// Whether this build has the scheme: `Ida` needs the feature `sundials`.
pub fn available(method: Method) -> bool {
    method != Method::Ida || cfg!(feature = "sundials")
}

/// A scheme with room for a system; one that is not [`available`] refuses each start.
pub fn new(method: Method, settings: Settings, system: &dyn System) -> Box<dyn Scheme> {
    let _ = settings;
    match method {
        Method::Auto => Box::new(auto::Auto::new(settings, system)),
        Method::Dop853 => Box::new(dop853::Dop853::new(settings, system)),
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
        Method::Rk4 => Box::new(rk4::Rk4::new(system, !settings.locate)),
    }
}

#[cfg(test)]
mod tests {
    use super::available;
    use crate::Method;

    #[test]
    fn only_ida_can_be_absent() {
        assert_eq!(available(Method::Ida), cfg!(feature = "sundials"));
        assert!([Method::Auto, Method::Radau5, Method::Bdf { order: None }, Method::Rk4].into_iter().all(available));
    }
}
