//! Where a run cannot go on.

use crate::why::Why;
use std::fmt;

/// A run that cannot go on, with the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halt {
    /// Why.
    pub why: Why,
    /// Time of the last good state, s.
    pub t: f64,
    /// The last step that was tried, s.
    pub h: f64,
}

impl fmt::Display for Halt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at t = {} s: {}", self.t, self.why)
    }
}

impl std::error::Error for Halt {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.why)
    }
}
