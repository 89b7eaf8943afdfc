//! The face of the library: a model file, its studies with settings, and its mechanism to evaluate by hand.

mod error;
mod evaluator;
mod files;
mod force;
mod mechanism;
mod model;
mod page;
mod simulation;
mod sources;
mod state;
mod stepper;
mod study;
mod sweep;

pub use crate::model::ExternalFunction;
pub use error::{Error, explained};
pub use evaluator::Evaluator;
pub use files::{MOST_INCLUDED, beside, why};
pub use force::{PointMotion, Wrench};
pub use mechanism::{Mechanism, Placement, Terms};
pub use model::Model;
pub use page::told;
pub use simulation::Simulation;
pub use stepper::{Reached, Stepper, Stepping};
pub use study::Study;
pub use sweep::PreparedSweep;
