//! What is wrong with the text of an expression.

use std::ops::Range;
/// An error of form in an expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// Bytes of the text; empty at its end.
    pub at: Range<usize>,
    /// What stands there.
    pub found: String,
    /// What was expected instead.
    pub expected: String,
    /// One remedy.
    pub help: Option<String>,
}
