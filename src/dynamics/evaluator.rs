//! The evaluator over one workspace.

use super::workspace::Workspace;
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
    pub(super) active: usize,
    /// Whether quaternions are among those.
    pub(super) needs_quaternions: bool,
}

impl<'m, G: Space> Dynamics<'m, G> {
    /// An evaluator for a mechanism.
    #[must_use]
    pub fn new(mechanism: &'m Mechanism<G>) -> Self {
        Self::over(mechanism, Workspace::new(mechanism))
    }

    /// One without a mass matrix, for all but [`Dynamics::mass`] and what follows from it: over many bodies that matrix is large.
    #[must_use]
    pub fn without_mass(mechanism: &'m Mechanism<G>) -> Self {
        Self::over(mechanism, Workspace::without_mass(mechanism))
    }

    fn over(mechanism: &'m Mechanism<G>, work: Workspace<G>) -> Self {
        let active = mechanism.active_gauges;
        let needs_quaternions = mechanism.gauges[..active].iter().any(|g| matches!(g.measured, Measured::Quaternion { .. }));
        Self { mechanism, work, t: G::S::constant(0.0), active, needs_quaternions }
    }

    /// All stages up to M, f, Φ, G, ν and γ.
    pub fn terms(&mut self, t: G::S, q: &[G::S], v: &[G::S], modes: &[i32]) {
        self.terms_without_mass(t, q, v, modes);
        self.mass();
    }

    /// All stages up to f, Φ, G, ν and γ.
    pub fn terms_without_mass(&mut self, t: G::S, q: &[G::S], v: &[G::S], modes: &[i32]) {
        self.time(t, modes);
        self.position(q, modes);
        self.velocity(v, modes);
        self.forces(modes);
    }
}
