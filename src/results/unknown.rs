//! A name that there is not.

use crate::expression::nearest;
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
    /// Which name was meant, if one is near, and which there are.
    #[must_use]
    pub fn help(&self) -> String {
        let known = self.known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        match nearest(&self.name, self.known.iter().map(String::as_str)) {
            _ if known.is_empty() => "there is none".to_string(),
            Some(near) => format!("did you mean `{near}`? There are {known}"),
            None => format!("there are {known}"),
        }
    }
}

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "there is no {} `{}`: {}", self.what, self.name, self.help())
    }
}

impl std::error::Error for Unknown {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_comes_first() {
        let help = |name: &str| Unknown { what: "study", name: name.into(), known: vec!["swing".into(), "rest".into()] }.help();
        assert_eq!(help("swnig"), "did you mean `swing`? There are `swing`, `rest`");
        assert_eq!(help("x"), "there are `swing`, `rest`");
        assert_eq!(Unknown { what: "study", name: "x".into(), known: Vec::new() }.help(), "there is none");
    }
}
