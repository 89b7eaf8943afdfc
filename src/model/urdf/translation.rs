//! The sections of a model that a robot becomes.

use serde_yaml::Mapping;
use std::collections::HashMap;
use std::ops::Range;

/// Sections of a model and where their entries come from.
pub(super) struct Translation {
    /// `ground`, `bodies`, `joints`, `couplings`, `start`.
    pub(super) sections: Mapping,
    /// Joint of the root and the ground.
    pub(super) base: Option<String>,
    /// Bytes of the file by path: `bodies.link1.mass`.
    pub(super) places: HashMap<String, Range<usize>>,
    /// What the file says of an entry beyond what the model uses, by path.
    pub(super) remarks: HashMap<String, String>,
}
