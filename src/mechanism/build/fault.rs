//! Why a model has no mechanism.

/// Why a model has no mechanism, at a place of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BuildFault {
    /// Kebab-case kind of the fault.
    pub code: &'static str,
    /// Path in the model file.
    pub place: String,
    /// What was found.
    pub message: String,
    /// What was expected.
    pub expected: String,
    /// One remedy.
    pub help: Option<String>,
}
