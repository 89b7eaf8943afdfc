//! How a robot becomes part of a model, and what it is then.

use super::notes::Notes;
use crate::model::fields::{LENGTH, ROLL_PITCH_YAW, Shape, Size};
use crate::model::keys::{Words, keys, words};
use serde_yaml::{Mapping, Value};
use std::collections::HashMap;
use std::ops::Range;

keys! {
    /// An included robot.
    pub(crate) INCLUDE = IncludeKeys "an included robot" [] {
        urdf: need Shape::Text, "URDF file, by its path from this file.";
        prefix: may Shape::Text, "In front of every name of the robot; nothing if omitted.";
        at: may Shape::List(&LENGTH, Size::Exactly(3)), "Place of the root in the world; the origin if omitted.";
        rpy: may ROLL_PITCH_YAW, "Orientation of the root: turned about the world's x, then y, then z.";
        base: may Shape::Word(Base::WORDS), "Whether the root is fixed to the ground.";
        stops: may Shape::Flag, "Make end stops of the position limits.";
    }
}

words! {
    /// How the root of a robot stands in the world.
    pub(crate) enum Base {
        /// On the ground.
        Fixed = "fixed",
        /// Free.
        Free = "free",
    }
}

/// How a robot becomes part of a model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options<'o> {
    /// In front of every name.
    pub(crate) prefix: &'o str,
    /// Place of the root in the world, m; the origin if omitted. As the model says it, expressions included.
    pub(crate) at: Option<&'o Value>,
    /// Roll, pitch and yaw of the root, rad.
    pub(crate) rpy: Option<&'o Value>,
    /// Whether the root is fixed.
    pub(crate) base: Base,
    /// Whether position limits become end stops.
    pub(crate) stops: bool,
}

/// A robot as part of a model.
#[derive(Clone, Debug)]
pub(crate) struct Translated {
    /// The robot's own name.
    pub(crate) name: String,
    /// `ground`, `bodies`, `joints`, `couplings`, `start`.
    pub(crate) sections: Mapping,
    /// Joint by which the root stands on the ground, and its point there; none where the root is free.
    pub(crate) base: Option<String>,
    /// Bytes of the file by the path of an entry or of one of its values.
    pub(crate) places: HashMap<String, Range<usize>>,
    /// What the file says of an entry beyond what the model uses, by its path.
    pub(crate) remarks: HashMap<String, String>,
    /// What is not used, or not as it stands.
    pub(crate) notes: Notes,
}
