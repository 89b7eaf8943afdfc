//! What an integrator is to the loop that drives it.

use crate::System;
use crate::dense_output::Dense;
use crate::engine::{Engine, Node, Rejected, Why};

/// Which constraint rows an implicit scheme imposes: this choice is the reduction of the index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Level {
    /// Φ = 0 and G v = ν, with a second multiplier in the rates of the coordinates (Gear, Gupta & Leimkuhler 1985): index 2.
    #[default]
    Stabilized,
    /// Φ = 0: index 3.
    Position,
    /// G v = ν: index 2, the position drifts.
    Velocity,
    /// G a = γ, then projection of q and v: index 1.
    Acceleration,
}

/// A time integration scheme: it tries steps, and keeps the history that it needs for the next.
///
/// The loop calls `restart` once, then for each step `attempt` until it succeeds, then completes `to` (a, λ and ż from one KKT
/// solve), calls `accept`, and `dense` if somebody looks inside of the step. Nothing allocates but construction.
pub trait Scheme {
    /// Forgets the past and begins at a consistent node; `h` is the loop's guess of the first step (s).
    ///
    /// # Errors
    /// If the system cannot be evaluated near the node.
    fn restart(&mut self, system: &mut dyn System, engine: &mut Engine, node: &Node, h: f64) -> Result<(), Why>;

    /// Tries the step of size `h` (s) from `from`, which is the node accepted last.
    ///
    /// `to` receives t, q, v and z at the end of the step (modes, live and work are those of `from`); a, λ and ż in it are
    /// scratch.
    ///
    /// # Errors
    /// If the error is too large or Newton's method fails: nothing has changed but scratch, and a smaller step is proposed.
    fn attempt(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, h: f64, to: &mut Node) -> Result<(), Rejected>;

    /// Whether `attempt` leaves a, λ and ż of the KKT system at the end of the step in `to`, so that the loop need not.
    fn completes(&self) -> bool {
        false
    }

    /// Whether the scheme chooses its steps itself: `h` of `attempt` is then the most that it may go, and `to.state.t` says how far
    /// it went.
    fn chooses_steps(&self) -> bool {
        false
    }

    /// Takes the step tried last into the history; returns the size proposed for the next (s).
    fn accept(&mut self, engine: &mut Engine, from: &Node, to: &Node) -> f64;

    /// The continuous solution over the step accepted last.
    ///
    /// # Errors
    /// If the system cannot be evaluated inside of the step.
    fn dense(&mut self, system: &mut dyn System, engine: &mut Engine, from: &Node, to: &Node, out: &mut Dense) -> Result<(), Why>;

    /// Adds ∫ power dt over the step accepted last, which was `step` long (s), by the weights of the scheme, to `out`, and tells the largest
    /// error of a work and the size of what was added up, J. None where the scheme does not integrate it:
    /// then the loop does, along the continuous solution.
    fn work(&self, _step: f64, _out: &mut [f64]) -> Option<[f64; 2]> {
        None
    }

    /// Whether Newton's method solves its steps, on a matrix that is singular where the position is: the loop then crosses such
    /// positions by explicit steps.
    fn is_implicit(&self) -> bool {
        false
    }

    /// Is told that there is no singular position until `t` (s), whatever is seen of rows that come near one.
    fn regular_until(&mut self, _t: f64) {}

    /// Order of convergence of q and v at present.
    fn order(&self) -> usize;

    /// The name of the scheme at work, as `dop853`; schemes that are made of others name the one that steps.
    fn name(&self) -> &'static str;
}
