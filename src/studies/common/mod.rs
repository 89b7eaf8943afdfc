//! What studies of several kinds share: the motion as a curve, what is watched of it, and the numbers that are taken from it.

pub mod case;
pub mod clock;
pub(crate) mod energies;
pub(crate) mod functional;
pub(crate) mod grain;
pub(crate) mod indeterminate;
mod leaps;
pub mod motion;
pub mod named;
pub(crate) mod numbers;
pub mod observe;
pub mod outcome;
mod passage;
mod passing;
pub(crate) mod pieces;
pub mod reach;
pub(crate) mod recorder;
mod rows;
pub(crate) mod scene;
mod selection;
pub mod settings;
pub(crate) mod sides;
pub(crate) mod stops;
pub mod switching;
pub mod watched;
