//! Grashof: mechanisms from a text file to motion, forces and pictures.

pub mod analysis;
pub mod dynamics;
pub mod expression;
pub mod geometry;
pub mod mechanism;
pub mod model;
pub mod output;
pub mod par;
pub mod scalar;
