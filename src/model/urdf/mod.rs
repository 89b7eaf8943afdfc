//! URDF: robots as XML, read by `urdf-rs` and translated to the sections of a model.
//!
//! The way of a file: `guard` (size, depth, XML) → `grammar` (elements, attributes, numbers) → `robot` (what `urdf-rs` reads,
//! and whether it can exist) → `translate` (sections of a model, with the place of each entry). The same sections lie below
//! those of a model that includes the file, and are written as text by [`import`].

mod constant;
mod finite;
mod grammar;
mod guard;
mod inertia;
mod names;
mod notes;
mod robot;
mod rotation;
mod translate;
mod write;

pub(crate) use guard::is_robot;
pub(crate) use notes::Notes;
pub use rotation::{axis_angle, roll_pitch_yaw};
pub use write::{Import, Imported, import};

use super::fault::Fault;
use serde_yaml::{Mapping, Value};
use std::collections::HashMap;
use std::ops::Range;

/// How the root of a robot stands in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Base {
    /// On the ground.
    #[default]
    Fixed,
    /// Free.
    Free,
}

/// How a robot becomes part of a model.
#[derive(Clone, Copy, Debug, Default)]
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

/// Reads a URDF and translates it.
///
/// # Errors
/// Everything that is wrong with the file, as far as it can be read.
pub(crate) fn read(text: &str, options: &Options<'_>) -> Result<Translated, Vec<Fault>> {
    let tree = guard::tree(text).map_err(|fault| vec![*fault])?;
    let root = tree.root_element();
    let mut notes = Notes::default();
    let faults = grammar::check(root, &mut notes);
    if !faults.is_empty() {
        return Err(faults);
    }
    let robot = robot::read(root, &mut notes)?;
    let translate::Translation { sections, base, places, remarks } = translate::translate(&robot, options, &mut notes)?;
    Ok(Translated { name: robot.name, sections, base, places, remarks, notes })
}
