//! Solvers of constrained mechanical systems: what they ask of a system, and the linear algebra below the integrators.
//!
//! ```text
//! M(q) a + Gᵀλ = f(t, q, v, z)         nv equations of motion
//! Φ(t, q) = 0,  G v = ν,  G a = γ      holonomic rows first, then velocity-level rows; −Φ_t and −Φ_tt live in ν and γ
//! q̇ = N(q) v                           nq ≥ nv
//! ż = g(t, q, v, z)                    first-order states
//! ```
//!
//! Nothing here knows a body or a joint. Numbers are `f64`, matrices are dense and row-major, and nothing allocates after
//! construction except [`rank`] and [`coloring`], which serve at assembly.

pub mod coloring;
pub mod kkt;
pub mod rank;
pub mod sparsity;
pub mod state;
pub mod system;

#[cfg(test)]
mod noise;

pub use coloring::Coloring;
pub use kkt::Kkt;
pub use kkt::dense::{Lu, Singular};
pub use sparsity::{Pattern, Sparsity};
pub use state::{At, Dims, State};
pub use system::{Effect, Stage, System, Tangent, Terms};
