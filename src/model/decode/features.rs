//! What a kind of study offers, and the names of a study while it is decoded.

use crate::expression::{Dimension, Symbol};
use crate::model::merge::Node;
use crate::model::scope::Local;
use serde_yaml::Value;

/// What a kind of study offers.
pub(super) struct Features {
    pub(super) word: &'static str,
    /// Dimension of the independent variable.
    pub(super) independent: Option<Dimension>,
    /// The independent variable as a path, if it is not the time.
    pub(super) first: Option<String>,
    /// Whether reactions are found.
    pub(super) reactions: bool,
    /// Whether first-order states are followed.
    pub(super) states: bool,
    /// Results with their dimensions.
    pub(super) results: Vec<(String, Dimension)>,
}

/// Names of a study while it is decoded.
pub(super) struct Frame<'s> {
    pub(super) local: Local<'s>,
    pub(super) features: Features,
    /// Swept parameters.
    pub(super) swept: Vec<usize>,
    /// Names of scalars in order, for figures.
    pub(super) scalars: Vec<(String, Dimension)>,
    /// Results of the kind.
    pub(super) results: Vec<(String, Symbol)>,
}

/// A whole number that the tables have checked.
pub(super) fn count(node: Node<'_>, key: &str) -> Option<usize> {
    match node.get(key)? {
        Node::Plain(Value::Number(n)) => usize::try_from(n.as_u64()?).ok(),
        _ => None,
    }
}
