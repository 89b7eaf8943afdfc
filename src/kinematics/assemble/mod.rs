//! From guesses and exact values to a position and velocity that satisfy every constraint.
//!
//! The start is completed in one and the same form whatever the coordinates of the run: on the tree of all joints, those that are
//! to be cut among them (`position.rs`, `velocity.rs`). Poses and twists are then carried over to the coordinates of the run
//! (`carry.rs`), so that neither these nor `cut` change a start, and a mechanism without loops is always assembled.
//!
//! Guesses (`~`) and exact values first pull the drawn position towards themselves, all alike, in the sense of least squares.
//! Then constraints and exact values are closed by Gauss-Newton steps that are the shortest, 1 rad counting as much as the size of
//! the mechanism (Levenberg's damping where a step does not help): once from there, once from where they close best with guesses
//! held as well, lest coordinates that nobody named push a guess to another branch. What comes nearest to the guesses counts; bodies in
//! space whose orientation nobody named are not turned farther than they need (`turned.rs`). What is left open after that is as near to the drawn pose as can be, in least squares over the coordinates of all joints
//! (`nearest.rs`). Next to a change point positions are moved into it (`sharpen.rs`). Velocities follow linearly, by the same order: constraints and exact values, guesses, rest; where branches cross,
//! on one of these (`cone.rs`, `branch.rs`).

mod balls;
mod begun;
mod branch;
mod carry;
mod close;
mod cone;
mod dead;
mod explain;
mod fault;
mod found;
mod metric;
mod named;
mod nearest;
mod position;
mod rotation;
mod shake;
mod sharpen;
mod turned;
mod velocity;

use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Coordinates, Mechanism, build, build_uncut, is_uncut};
use crate::model::Model;
use crate::results::{Failure, Finding};
use begun::{Begun, anchor};
pub use branch::{Branch, ChangePoint};
pub use fault::AssemblyFault;
pub use found::Found;
use grashof_solvers::kkt;
pub(crate) use metric::units;
use std::sync::OnceLock;

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
    /// Bodies that nobody has turned and that stand far from how they are drawn, with the angle, rad.
    pub turned: Vec<(String, f64)>,
    /// Sizes of the first-order states (nz) in which their errors count, once a motion in time has asked for them.
    pub(crate) state_sizes: OnceLock<Vec<f64>>,
}

impl Assembled {
    /// The same start with contacts that slide in these senses; 0 where one sticks.
    pub(crate) fn sliding<G: Space>(&self, mechanism: &Mechanism<G>, senses: &[i32]) -> Self {
        let mut start = self.clone();
        mechanism.slide(senses, &mut start.modes);
        start
    }

    /// What a reader should know of the start.
    pub(crate) fn findings(&self) -> impl Iterator<Item = Finding> {
        self.change.iter().map(|change| of_start("change-point", change.message())).chain(self.not_as_meant())
    }

    /// Where it may be another one than was meant.
    pub(crate) fn not_as_meant(&self) -> impl Iterator<Item = Finding> {
        let missed = self.found.iter().filter(|found| found.guess && found.is_far(self.size));
        let turned = self.turned.iter().map(|(body, angle)| of_start("turned-start", turned::message(body, *angle)));
        missed.map(|found| of_start("guess-missed", found.missed())).chain(turned)
    }
}

fn of_start(code: &'static str, message: String) -> Finding {
    Finding { code: code.into(), message, path: "start".into() }
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
    let Begun { q, v, modes, change, turned } = begun;
    let turned = turned.into_iter().map(|(body, angle)| (mechanism.bodies[body].name.clone(), angle)).collect();
    Ok((mechanism, Assembled { q, v, modes, size, metric, found, change, turned, state_sizes: OnceLock::new() }))
}

/// Position and velocity on the tree at hand.
fn begin<G: Space<S = f64>>(mechanism: &mut Mechanism<G>) -> Result<Begun, AssemblyFault> {
    let (q, modes) = position::position(mechanism)?;
    let turned = turned::far(mechanism, &q, &modes);
    anchor(mechanism, &q, &modes);
    let (v, change) = velocity::velocity(mechanism, &q, &modes)?;
    Ok(Begun { q, v, modes, change, turned })
}

/// Diagonal of the mass metric as drawn, free bodies at the orientation that is asked for.
fn drawn_metric<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Vec<f64> {
    let mut dynamics = Dynamics::new(mechanism);
    let (mut q, mut modes) = (mechanism.drawn(), mechanism.modes());
    position::orient(mechanism, &mut q);
    dynamics.follow_time(0.0, &mut modes);
    dynamics.terms(0.0, &q, &vec![0.0; mechanism.nv], &modes);
    kkt::metric((0..mechanism.nv).map(|k| dynamics.work.mass.at(k, k)), &mechanism.kinds(mechanism.start_size()))
}
