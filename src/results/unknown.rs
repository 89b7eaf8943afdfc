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

impl Unknown {
    /// Which names there are.
    #[must_use]
    pub fn help(&self) -> String {
        let known = self.known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        if known.is_empty() { "there is none".to_string() } else { format!("there are {known}") }
    }
}

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "there is no {} `{}`: {}", self.what, self.name, self.help())
    }
}

impl std::error::Error for Unknown {}
