//! Why a mechanism cannot be assembled.

use crate::results::Failure;

/// Why a mechanism cannot be assembled, in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AssemblyFault {
    /// Kebab-case kind: `not-assembled`, `start-cannot-hold`, `over-constrained`, `dead-point`.
    pub code: &'static str,
    /// What stays open.
    pub message: String,
    /// Path in the model file of what it concerns most.
    pub place: String,
    /// One remedy.
    pub help: String,
}

impl From<AssemblyFault> for Failure {
    fn from(fault: AssemblyFault) -> Self {
        Self::Study { code: fault.code, message: fault.message, place: fault.place, help: fault.help }
    }
}
