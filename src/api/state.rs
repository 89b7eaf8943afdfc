//! States of a mechanism that are given from outside.

use super::error::Error;
use grashof_solvers::{State, System};

/// Takes the modes of the switches from a state; `modes` is memory for as many.
pub(super) fn settle(system: &mut dyn System, state: &mut State, modes: &mut Vec<i32>) {
    // a function of positions may switch and feed others: twice settles what depends on it
    for _ in 0..2 {
        modes.copy_from_slice(&state.modes);
        system.modes(state.at(), modes);
        std::mem::swap(modes, &mut state.modes);
    }
}

pub(super) fn sized(what: &str, x: &[f64], size: usize) -> Result<(), Error> {
    if x.len() == size {
        return Ok(());
    }
    let message = format!("there are {} {what}, and the mechanism has {size}", x.len());
    Err(Error::Refused { message, help: "see `Mechanism::sizes` and `Mechanism::start`".into() })
}
