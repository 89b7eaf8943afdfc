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

mod acting;
mod energy;
mod evaluator;
mod external;
mod forces;
mod friction;
mod kinematics;
mod patterns;
mod reaction;
mod scale;
mod switches;
mod tangent;
mod undefined;
mod workspace;

pub use evaluator::Dynamics;
pub use friction::slack;
pub use patterns::{depths, friction_pattern, mass_pattern, row_pattern, tangent_pattern};
pub use reaction::Reactions;
pub use tangent::{Differentiable, LANES, Linearizer, Point, RowTangent};
pub use workspace::Workspace;
