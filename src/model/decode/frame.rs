//! The names of a study while it is decoded.

use super::kinds::Features;
use crate::expression::{Dimension, Symbol};
use crate::model::scope::Local;

/// Names of a study while it is decoded.
pub(super) struct Frame<'s> {
    pub(super) local: Local<'s>,
    /// The key of its kind.
    pub(super) word: &'static str,
    pub(super) features: Features,
    /// Swept parameters.
    pub(super) swept: Vec<usize>,
    /// Names of scalars in order, for figures.
    pub(super) scalars: Vec<(String, Dimension)>,
    /// Results of the kind.
    pub(super) results: Vec<(String, Symbol)>,
}
