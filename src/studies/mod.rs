//! Studies: what is computed of a mechanism, a module to a kind, and runs of them over values of parameters.
//!
//! A kinematic study is a [`Curve`](crate::numerics::continuous::Curve): columns that can be evaluated at any place of the range.
//! Its grid is only where rows are written; extremes, integrals and switches are found on the curve itself.

mod balance;
pub mod common;
pub mod compare;
mod compared;
pub(crate) mod driven;
pub mod dynamics;
mod full_turn;
pub mod grid;
pub mod integrators;
mod linearize;
pub mod loader;
pub mod modes;
mod periodic;
pub mod rehearsal;
pub mod run;
pub mod solve;
mod statics;
pub mod sweep;
pub mod verify;
