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
mod options;
mod read;
mod robot;
mod rotation;
mod translate;
mod translation;
mod write;

pub(crate) use guard::is_robot;
pub(crate) use options::{Base, INCLUDE, IncludeKeys, Options, Translated};
pub(crate) use read::read;
pub use rotation::{axis_angle, roll_pitch_yaw};
pub use write::{Import, Imported, import};
