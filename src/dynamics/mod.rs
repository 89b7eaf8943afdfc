//! Evaluators of one mechanism: kinematics, constraint rows, mass matrix, forces, energy, reactions. No joint type appears here.
//!
//! The stages go `time → position → velocity → forces → mass → accelerations`; each needs those before it and leaves its
//! results in the [`Workspace`]. The equations are
//!
//! ```text
//! M(q) a + Gᵀλ = f(t, q, v),    G v = ν,    G a = γ.
//! ```
//!
//! An evaluator is cheap to make, holds no state of its own between states, and allocates nothing once it is made.

mod energy;
mod forces;
mod friction;
mod kinematics;
mod reaction;
mod scale;
mod switches;
mod tangent;
mod undefined;
mod workspace;

pub use friction::{rubbed, slack};
pub use reaction::Reactions;
pub use tangent::{LANES, Linearizer, Point, RowTangent, pattern};
pub use workspace::Workspace;

use crate::geometry::Space;
use crate::mechanism::{Measured, Mechanism};
use crate::scalar::Scalar;

/// An evaluator with its scratch; one per thread.
#[derive(Clone, Debug)]
pub struct Dynamics<'m, G: Space> {
    /// The mechanism.
    pub mechanism: &'m Mechanism<G>,
    /// What the last evaluation left.
    pub work: Workspace<G>,
    /// Time of the last evaluation, s.
    pub t: G::S,
    /// Gauges that rows and forces need; the others are read by [`Dynamics::watch`].
    active: usize,
    /// Whether quaternions are among those.
    needs_quaternions: bool,
}

impl<'m, G: Space> Dynamics<'m, G> {
    /// An evaluator for a mechanism.
    #[must_use]
    pub fn new(mechanism: &'m Mechanism<G>) -> Self {
        let active = mechanism.active_gauges;
        let needs_quaternions = mechanism.gauges[..active].iter().any(|g| matches!(g.measured, Measured::Quaternion { .. }));
        Self { mechanism, work: Workspace::new(mechanism), t: G::S::constant(0.0), active, needs_quaternions }
    }

    /// All stages up to M, f, Φ, G, ν and γ.
    pub fn terms(&mut self, t: G::S, q: &[G::S], v: &[G::S], modes: &[i32]) {
        self.time(t, modes);
        self.position(q, modes);
        self.velocity(v, modes);
        self.forces(modes);
        self.mass();
    }
}
