//! The integrators of the model language: one entry each, from which reader, schema, messages and comparisons take what they need.

/// Schemes for motion in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Chosen by the program, explicit first.
    Auto,
    /// Newmark's family.
    Newmark,
    /// Hilber, Hughes and Taylor.
    Hht,
    /// Chung and Hulbert.
    GeneralizedAlpha,
    /// Backward differences of order 1 to 5.
    Bdf,
    /// Radau IIA of order 5.
    Radau5,
    /// Dormand and Prince of order 8.
    Dop853,
    /// The classical Runge-Kutta scheme.
    Rk4,
    /// Central differences.
    CentralDifference,
    /// IDA of SUNDIALS.
    Ida,
}

/// How a scheme takes constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// By accelerations, with projections of positions and velocities.
    Explicit,
    /// As rows of its own equations.
    Implicit,
    /// Explicit first, implicit where the motion asks for it.
    Either,
}

/// What is known of an integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Description {
    /// The integrator.
    pub integrator: Integrator,
    /// Its name in a model file.
    pub name: &'static str,
    /// How it takes constraints.
    pub family: Family,
    /// Order of its error with fixed steps; of `bdf` where the study names none.
    pub order: usize,
    /// Whether it chooses its steps by a tolerance.
    pub tolerance: bool,
    /// Keys of its own parameters.
    pub keys: &'static [&'static str],
}

/// All integrators; the first is the default.
pub const INTEGRATORS: [Description; 10] = {
    use Family::{Either, Explicit, Implicit};
    const fn entry(integrator: Integrator, name: &'static str, family: Family, order: usize) -> Description {
        Description { integrator, name, family, order, tolerance: true, keys: &[] }
    }
    [
        entry(Integrator::Auto, "auto", Either, 8),
        Description { keys: &["alpha", "beta"], ..entry(Integrator::Newmark, "newmark", Implicit, 2) },
        Description { keys: &["alpha"], ..entry(Integrator::Hht, "hht", Implicit, 2) },
        Description { keys: &["rho"], ..entry(Integrator::GeneralizedAlpha, "generalized-alpha", Implicit, 2) },
        Description { keys: &["order"], ..entry(Integrator::Bdf, "bdf", Implicit, 1) },
        entry(Integrator::Radau5, "radau5", Implicit, 5),
        entry(Integrator::Dop853, "dop853", Explicit, 8),
        entry(Integrator::Rk4, "rk4", Explicit, 4),
        Description { tolerance: false, ..entry(Integrator::CentralDifference, "central-difference", Explicit, 2) },
        entry(Integrator::Ida, "ida", Implicit, 2),
    ]
};

/// Their names.
pub(crate) const NAMES: [&str; INTEGRATORS.len()] = {
    let mut names = [""; INTEGRATORS.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = INTEGRATORS[k].name;
        k += 1;
    }
    names
};

impl Integrator {
    /// What is known of it.
    #[must_use]
    pub fn description(self) -> &'static Description {
        const ALL: &[Description] = &INTEGRATORS;
        // in the order of the entries, which the test holds
        &ALL[self as usize]
    }

    /// Its name in a model file.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.description().name
    }

    /// The integrator of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        INTEGRATORS.iter().find(|d| d.name == name).map(|d| d.integrator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_stand_in_the_order_of_the_integrators() {
        for d in &INTEGRATORS {
            assert_eq!(d.integrator.description(), d);
            assert_eq!(Integrator::named(d.name), Some(d.integrator));
        }
    }
}
