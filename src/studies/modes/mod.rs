//! Vibrations about a held pose: the study kind `modes`.
//!
//! Of few bodies, `kinematics/held.rs` makes M, C and K of a pose; `eigen`, `jacobi` and `power` solve K x = λ M x, `damped` the state
//! matrix, from which `free` takes what nothing drives back, and `few` compares them. Of many, `many` finds the lowest modes from the sparse
//! matrices of `kinematics/pencil.rs` by `kinematics/lowest.rs`.
//! `report` says what is found, `picture` draws it.

pub mod damped;
pub mod eigen;
mod few;
mod free;
pub mod jacobi;
pub mod lanczos;
mod many;
mod picture;
pub mod power;
mod report;
mod rest;
mod round_off;

use super::common::case::Case;
use crate::geometry::Space;
use crate::model::Modes;
use crate::results::Failure;
use crate::studies::common::outcome::Outcome;

/// Runs a study of modes.
///
/// # Errors
/// If the mechanism cannot be assembled, has no equilibrium, or moves without mass.
pub(crate) fn run<G>(case: Case<'_>, asked: &Modes, stop: &dyn Fn() -> bool) -> Result<Outcome, Failure>
where
    G: Space<S = f64>,
{
    if many::is_asked(case.model, asked)
        && let Some(outcome) = many::run::<G>(case, asked, stop)?
    {
        return Ok(outcome);
    }
    few::run::<G>(case, asked, stop)
}
