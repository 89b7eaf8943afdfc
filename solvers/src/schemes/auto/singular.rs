//! When implicit steps must give way in a singular position; the same limits as in the bridges of the loop.

use crate::engine::Engine;
use crate::{Dims, Sigma};

/// Explicit steps that are taken at least.
const HELD: usize = 10;

/// σ, the distance from a singular position, and how long explicit steps are held.
#[derive(Clone, Debug)]
pub(super) struct Singular {
    rows: bool,
    weakest: Sigma,
    sigma: f64,
    /// σ that must be exceeded before implicit steps return.
    enough: f64,
    held: usize,
}

impl Singular {
    /// Room for a system.
    pub(super) fn new(dims: Dims) -> Self {
        Self { rows: dims.holonomic > 0, weakest: Sigma::new(dims.rows()), sigma: 1.0, enough: 0.0, held: 0 }
    }

    /// Looks at the node whose KKT matrix was factored last.
    pub(super) fn begin(&mut self, engine: &mut Engine) {
        if self.rows {
            self.weakest.restart(engine);
            self.sigma = self.weakest.follow(engine, 1);
        }
    }

    /// Whether the node factored last lies where implicit steps are no longer trusted.
    pub(super) fn entered(&mut self, engine: &mut Engine) -> bool {
        self.look(engine);
        self.rows && self.sigma < limit(engine)
    }

    /// Whether a failure of Newton's method may come from a singular position.
    pub(super) fn near(&self) -> bool {
        self.rows && self.sigma < 0.2
    }

    /// Begins to hold explicit steps.
    pub(super) fn hold(&mut self) {
        (self.held, self.enough) = (HELD, (2.0 * self.sigma).clamp(1e-3, 0.2));
    }

    /// Whether explicit steps are still to be held behind the node factored last.
    pub(super) fn holds(&mut self, engine: &mut Engine) -> bool {
        if self.enough == 0.0 {
            return false;
        }
        self.look(engine);
        self.held = self.held.saturating_sub(1);
        let holds = self.held > 0 || (self.rows && self.sigma < self.enough.max(limit(engine)));
        if !holds {
            self.enough = 0.0;
        }
        holds
    }

    fn look(&mut self, engine: &mut Engine) {
        if self.rows {
            self.sigma = self.weakest.follow(engine, 1);
        }
    }
}

/// σ below which noise ε of the constraints becomes a noise εω/σ² in the velocities that counts.
fn limit(engine: &Engine) -> f64 {
    (1e-6 / engine.tolerance().sqrt()).clamp(1e-3, 0.1)
}
