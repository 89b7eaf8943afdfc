//! A name that there is not.

use std::fmt;

/// There is nothing of a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unknown {
    /// What was asked for: `column`.
    pub what: &'static str,
    /// The name.
    pub name: String,
    /// Names that there are.
    pub known: Vec<String>,
}

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = self.known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let known = if known.is_empty() { "there is none".to_string() } else { format!("there are {known}") };
        write!(f, "there is no {} `{}`: {known}", self.what, self.name)
    }
}

impl std::error::Error for Unknown {}
