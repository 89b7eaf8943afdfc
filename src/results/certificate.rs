//! How far results are to be trusted.

use crate::model::WORKS;
use crate::numerics::resolve::Resolution;
use grashof_solvers::Counts;
use serde::{Deserialize, Serialize};

/// What certifies a motion in time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct March {
    /// Schemes that stepped: `dop853`, `dop853, radau5`.
    pub schemes: String,
    /// Tolerance; none with a fixed step.
    pub tolerance: Option<f64>,
    /// Largest |E − E(0) − work| at the ends of steps, J.
    pub energy_drift: f64,
    /// Largest of kinetic energy, change of potential energy and works, J.
    pub energy_scale: f64,
    /// Work of drivers, J.
    pub drivers: f64,
    /// Work of loads and motors, J.
    pub loads: f64,
    /// Work of dampers, J.
    pub dampers: f64,
    /// Work of end stops beside what they store, J: damping of those that give way, blows at rigid ones.
    pub stops: f64,
    /// Energy that events have given or taken at once, J.
    pub impacts: f64,
    /// Widest gap between looks at the conditions that depend on the motion, s; 0 where there are none.
    pub widest_gap: f64,
    /// Largest residual of the velocity constraints over the rows, in units of size per second.
    pub velocity: f64,
    /// What was spent.
    #[serde(with = "CountsFields")]
    pub counts: Counts,
}

impl March {
    /// The works by name, J.
    #[must_use]
    pub fn works(&self) -> [(&'static str, f64); WORKS.len()] {
        let works = [self.drivers, self.loads, self.dampers, self.stops, self.impacts];
        std::array::from_fn(|i| (WORKS[i], works[i]))
    }
}

/// How well the rows satisfy the equations.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Certificate {
    /// Positions solved.
    pub evaluations: usize,
    /// Located switches.
    pub switches: usize,
    /// Largest |Φ| over the rows, m or rad.
    pub constraint: f64,
    /// Largest |driver power + power of applied forces − dT/dt| over the rows, relative to the largest of its terms.
    pub power_balance: f64,
    /// Functions from outside whose switches are not declared, so that none is located.
    #[serde(default)]
    pub undeclared: usize,
    /// How far columns are resolved between their rows.
    pub resolved: Option<Resolution>,
    /// More of a motion in time.
    pub march: Option<March>,
}

/// Fields of [`Counts`], which the solvers keep free of formats.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Counts")]
struct CountsFields {
    steps: usize,
    rejected: usize,
    evaluations: usize,
    tangents: usize,
    factorisations: usize,
    iterations: usize,
    events: usize,
    bridges: usize,
    stepped_over: usize,
    unresolved: usize,
}
