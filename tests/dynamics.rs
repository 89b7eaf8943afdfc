//! Motion in time by the program: reference values, reduced equations, agreement of coordinates, energies, events, faults.

mod agreement;
mod beyond;
mod corners;
mod crank_rocker;
mod events;
mod faults;
mod hits;
mod observed;
mod resting;
mod switches;

use crate::reference::program::{Run, Table};

/// A scalar of a study.
fn scalar(run: &Run, study: &str, name: &str) -> f64 {
    run.json(study)["scalars"][name].as_f64().unwrap_or(f64::NAN)
}

/// A figure of the certificate of a study.
fn certified(run: &Run, study: &str, name: &str) -> f64 {
    run.json(study)["certificate"][name].as_f64().unwrap_or(f64::NAN)
}

/// Independent variable of the rows that stand twice: before and after a switch or an event.
fn doubled(table: &Table) -> Vec<f64> {
    let sides = table.sides();
    table.rows.iter().zip(sides).filter(|(_, side)| *side < 0).map(|(row, _)| row[0]).collect()
}
