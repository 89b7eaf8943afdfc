//! How a run is to be computed.

use crate::engine::Control;
use crate::method::Method;
use crate::scheme::Level;

/// How a run is to be computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The scheme.
    pub method: Method,
    /// Which constraint rows an implicit scheme imposes.
    pub level: Level,
    /// Tolerance or steps.
    pub control: Control,
    /// Whether switches are located; else the modes are taken anew from each state, and a step may march across.
    pub locate: bool,
    /// Whether the work of [`System::power`](crate::System::power) is integrated.
    pub balance: bool,
    /// Longest step with error control, s: a force that no step evaluates is not seen.
    pub longest: f64,
    /// Most steps of a run.
    pub most_steps: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            level: Level::Stabilized,
            control: Control::Tolerance(1e-8),
            locate: true,
            balance: false,
            longest: f64::INFINITY,
            most_steps: 50_000_000,
        }
    }
}
