//! The model file: YAML, its places and diagnostics, the tables of its fields, variants, and the typed entities that the
//! rest of the program is built from.
//!
//! The way of a file: `yaml` (text to value) → [`Document`]; `merge` (variants, by reference) → `shape` (form, along the
//! keys that `decode` declares and `tables` joins) → `decode` (names, expressions, dimensions) → [`Model`]. Faults are collected as paths;
//! `spans` finds their places only if there are any, so that reading a sound file costs one pass more than parsing it.

mod acting;
mod asked;
mod bodies;
mod commas;
mod contacts;
mod coordinates;
mod data;
mod decode;
mod diagnostics;
mod document;
mod entities;
mod fault;
mod faults;
mod fields;
mod figure;
mod files;
mod idle;
mod include;
mod included;
mod inquiry;
mod integrator;
mod keys;
mod literal;
mod merge;
mod misplaced;
mod names;
mod needs;
mod newmark;
mod place;
mod quantities;
mod reading;
mod remedy;
mod rules;
mod schema;
mod scope;
mod selected;
mod shape;
mod spans;
mod stems;
mod study;
mod suggest;
mod tables;
mod undefined;
mod urdf;
mod vocabulary;
mod whole;
mod words;
mod yaml;

pub use crate::expression::ExternalFunction;
pub use asked::Caller;
pub use bodies::*;
pub use contacts::*;
pub(crate) use coordinates::coordinates as coordinates_of;
pub(crate) use decode::REST_SPEED;
pub(crate) use diagnostics::NO_FILE;
pub use diagnostics::{Diagnostic, Excerpt, Report, Severity};
pub use document::{Document, Selection};
pub use entities::*;
pub use figure::*;
pub use files::Files;
pub use integrator::{Description, Family, INTEGRATORS, Integrator};
pub use literal::{Literal, replaced};
pub(crate) use names::unfit;
pub use place::{Place, PointRef};
pub use rules::Check;
pub use schema::schema;
pub use study::*;
pub use urdf::{Import, Imported, axis_angle, import, roll_pitch_yaw};
pub use vocabulary::{Known, Quantity, WORKS};
pub use whole::Model;
pub use words::{in_unit, with_unit};

#[cfg(test)]
mod tests;
