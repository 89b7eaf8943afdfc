//! From guesses and exact values to a position and velocity that satisfy every constraint.
//!
//! The start is completed in one and the same form whatever the coordinates of the run: on the tree of all joints, those that are
//! to be cut among them (`position.rs`, `velocity.rs`). Poses and twists are then carried over to the coordinates of the run
//! (`carry.rs`), so that neither these nor `cut` change a start, and a mechanism without loops is always assembled.
//!
//! Guesses (`~`) and exact values first pull the drawn position towards themselves, all alike, in the sense of least squares.
//! Then constraints and exact values are closed by Gauss-Newton steps that are the shortest, 1 rad counting as much as the size of
//! the mechanism (Levenberg's damping where a step does not help): once from there, once from where they close best with guesses
//! held as well, lest coordinates that nobody named push a guess to another branch. What comes nearest to the guesses counts. What
//! is left open after that is as near to the drawn pose as can be, in least squares over the coordinates of all joints
//! (`nearest.rs`). Next to a change point positions are moved into it (`sharpen.rs`). Velocities follow linearly, by the same order: constraints and exact values, guesses, rest; where branches cross,
//! on one of these (`cone.rs`, `branch.rs`).

mod branch;
mod carry;
mod close;
mod cone;
mod dead;
mod explain;
mod found;
mod nearest;
mod position;
mod rotation;
mod sharpen;
mod velocity;

use super::outcome::{Failure, Finding};
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Coordinates, Mechanism, Step, build, build_uncut, is_uncut};
use crate::model::Model;
pub use branch::{Branch, ChangePoint};
use grashof_solvers::kkt;

/// A consistent start.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembled {
    /// Coordinates (nq).
    pub q: Vec<f64>,
    /// Velocities (nv).
    pub v: Vec<f64>,
    /// Modes: switches of the expressions, then winding numbers.
    pub modes: Vec<i32>,
    /// Characteristic length of the mechanism, m.
    pub size: f64,
    /// Diagonal of the mass metric D as drawn (nv).
    pub metric: Vec<f64>,
    /// Asked and found values of `start`.
    pub found: Vec<Found>,
    /// What the position is if branches of the motion cross there.
    pub change: Option<ChangePoint>,
}

impl Assembled {
    /// What a reader should know of the start.
    pub(super) fn findings(&self) -> impl Iterator<Item = Finding> {
        self.change.iter().map(|change| Finding { code: "change-point", message: change.message(), path: "start".into() })
    }
}

/// An asked start value and what was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// As written.
    pub name: String,
    /// Asked value.
    pub asked: f64,
    /// Found value.
    pub found: f64,
    /// True if it was a guess.
    pub guess: bool,
    /// Unit of both values.
    pub unit: &'static str,
}

/// Why a mechanism cannot be assembled, in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AssemblyFault {
    /// Kebab-case kind: `not-assembled`, `start-cannot-hold`, `over-constrained`, `dead-point`.
    pub code: &'static str,
    /// What stays open.
    pub message: String,
    /// Path in the model file of what it concerns most.
    pub place: String,
    /// One remedy.
    pub help: String,
}

/// Coordinates, velocities and modes of a start.
struct Begun {
    q: Vec<f64>,
    v: Vec<f64>,
    modes: Vec<i32>,
    change: Option<ChangePoint>,
}

/// The mechanism of a model at given parameters (in file order) with its assembled start; the start fixes the anchors of its rows.
///
/// # Errors
/// If the model has no mechanism; the loops that stay open with their gaps, or the exact values that no assembly satisfies.
pub fn assemble<G: Space<S = f64>>(
    model: &Model,
    parameters: &[f64],
    coordinates: Coordinates,
) -> Result<(Mechanism<G>, Assembled), Failure> {
    let mut mechanism = build::<G>(model, parameters, coordinates).map_err(Failure::Model)?;
    let metric = drawn_metric(&mechanism);
    let begun = if is_uncut(model, coordinates) {
        begin(&mut mechanism)?
    } else {
        let mut uncut = build_uncut::<G>(model, parameters).map_err(Failure::Model)?;
        let begun = begin(&mut uncut)?;
        carry::carry(&uncut, &begun, &mut mechanism)
    };
    let size = mechanism.size();
    let found = found::found(&mechanism, &begun)?;
    let Begun { q, v, modes, change } = begun;
    Ok((mechanism, Assembled { q, v, modes, size, metric, found, change }))
}

/// Position and velocity on the tree at hand.
fn begin<G: Space<S = f64>>(mechanism: &mut Mechanism<G>) -> Result<Begun, AssemblyFault> {
    let (q, modes) = position::position(mechanism)?;
    anchor(mechanism, &q, &modes);
    let (v, change) = velocity::velocity(mechanism, &q, &modes)?;
    Ok(Begun { q, v, modes, change })
}

/// Anchors of drivers, gears, racks and distances without a length, from the found position.
fn anchor<G: Space<S = f64>>(mechanism: &mut Mechanism<G>, q: &[f64], modes: &[i32]) {
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    let offsets: Vec<f64> =
        mechanism.rows.iter().zip(&dynamics.work.phi).map(|(row, phi)| if row.anchored { row.offset + phi } else { row.offset }).collect();
    for (row, offset) in mechanism.rows.iter_mut().zip(offsets) {
        row.offset = offset;
    }
}

/// Kind of unit of each velocity column: 0 turns, 1 slides.
pub(crate) fn units<G: Space>(mechanism: &Mechanism<G>) -> Vec<u8> {
    let mut unit = vec![0; mechanism.nv];
    for step in &mechanism.steps {
        if let Step::Axis { turns: false, v, .. } = step {
            unit[*v] = 1;
        }
    }
    unit
}

/// Diagonal of the mass metric as drawn, free bodies at the orientation that is asked for.
fn drawn_metric<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Vec<f64> {
    let mut dynamics = Dynamics::new(mechanism);
    let (mut q, mut modes) = (mechanism.drawn(), mechanism.modes());
    position::orient(mechanism, &mut q);
    dynamics.follow_time(0.0, &mut modes);
    dynamics.terms(0.0, &q, &vec![0.0; mechanism.nv], &modes);
    kkt::metric(&dynamics.work.mass, &units(mechanism))
}

/// Diagonal of the metric of the search (nv): 1 rad counts as much as the size of the mechanism.
fn joint_metric<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Vec<f64> {
    mechanism.units().iter().map(|unit| 1.0 / (unit * unit)).collect()
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A fixed sequence in (−1, 1).
struct Shake(u64);

impl Shake {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
