//! Grashof: mechanisms from a text file to motion, forces and pictures.

pub mod dynamics;
pub mod expression;
pub mod geometry;
pub mod kinematics;
pub mod mechanism;
pub mod model;
pub mod numerics;
pub mod output;
pub mod par;
pub mod results;
pub mod scalar;
pub mod studies;
