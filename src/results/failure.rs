//! Why a run has no result.

use crate::mechanism::BuildFault;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Why a run has no result.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Failure {
    /// The model has no mechanism at these parameters.
    Model(Vec<BuildFault>),
    /// The study asks for what the mechanism cannot give: freedom left over, too many drivers; with the path in the file.
    Study { code: &'static str, message: String, place: String, help: String },
    /// Something has no value where it is needed from the start on.
    Undefined(Undefined),
    /// It did not begin or end for a numerical reason.
    Numerical { message: String, help: String },
    /// No value of the parameter that is varied meets the target.
    Unsolved(Unsolved),
}

/// Why a `solve` has no solution, with the path in the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unsolved {
    /// What was found.
    pub message: String,
    /// Path in the file.
    pub place: String,
    /// One remedy.
    pub help: String,
}

/// What has no value in a study, with the path in the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Undefined {
    /// What, where and why.
    pub message: String,
    /// Path in the file.
    pub place: String,
    /// One remedy.
    pub help: String,
}

impl Failure {
    /// A numerical reason, with one remedy.
    pub(crate) fn numerical(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Numerical { message: message.into(), help: help.into() }
    }

    /// It was ended from outside.
    pub(crate) fn interrupted() -> Self {
        Self::numerical("interrupted", "")
    }

    /// In one sentence, as the `reason` of a sweep's row.
    #[must_use]
    pub fn reason(&self) -> String {
        match self {
            Self::Model(faults) => {
                let told = |f: &BuildFault| match f.place.as_str() {
                    "" => f.message.clone(),
                    place => format!("`{place}`: {}", f.message),
                };
                faults.iter().map(told).collect::<Vec<_>>().join("; ")
            }
            Self::Undefined(Undefined { message, .. })
            | Self::Study { message, .. }
            | Self::Numerical { message, .. }
            | Self::Unsolved(Unsolved { message, .. }) => message.clone(),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reason())
    }
}

impl std::error::Error for Failure {}
