//! What is worth knowing, what was expected, and what happened.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Something worth knowing that is not an error.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    /// Kebab-case kind.
    pub code: Cow<'static, str>,
    /// In words.
    pub message: String,
    /// Path in the file.
    pub path: String,
}

impl Finding {
    /// Whether it says that the numbers of a motion are wrong by more than they should be.
    #[must_use]
    pub fn is_warning(&self) -> bool {
        matches!(&*self.code, "energy" | "open-constraints")
    }
}

/// One checked expectation.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Checked {
    /// As written.
    pub text: String,
    /// What was found.
    pub found: f64,
    /// What was wanted.
    pub wanted: f64,
    /// Allowed difference.
    pub tolerance: f64,
    /// Whether it is met.
    pub met: bool,
    /// What is wrong where it is not met, in the units that the model asks for; else empty.
    pub message: String,
    /// Path in the file.
    pub place: String,
}

/// An event of the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Happened {
    /// Its name.
    pub name: String,
    /// When, s.
    pub at: f64,
}
