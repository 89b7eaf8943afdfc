//! Integrators of constrained mechanical systems, and the linear algebra below them.
//!
//! ```text
//! M(q) a + Gᵀλ = f(t, q, v, z)         nv equations of motion
//! Φ(t, q) = 0,  G v = ν,  G a = γ      holonomic rows first, then velocity-level rows; −Φ_t and −Φ_tt live in ν and γ
//! q̇ = N(q) v                           nq ≥ nv
//! ż = g(t, q, v, z)                    first-order states
//! ```
//!
//! Nothing here knows a body or a joint. [`Integration`] drives a [`Scheme`] over a [`System`]: steps, events, singular positions.
//! The blocks of a system have fixed patterns: full and row-major where that is faster, else sparse, and so are factors. Nothing
//! allocates after construction except [`rank`], [`elimination`] and [`coloring`], which serve at assembly, and sparse factors that need new pivots.

pub mod block;
pub mod coloring;
pub mod dense_output;
pub mod elimination;
pub mod engine;
pub mod friction;
pub mod halt;
pub mod indefinite;
pub mod integration;
pub mod kkt;
pub mod loaded;
pub mod matrix;
pub mod method;
pub mod minimal;
pub mod newton;
pub mod pattern;
pub mod rank;
pub mod scheme;
pub mod schemes;
pub mod settings;
pub mod sigma;
pub mod sparsity;
pub mod state;
pub mod svd;
pub mod system;
pub mod weakest;
pub mod why;

#[cfg(test)]
mod noise;

pub use block::{Block, Line};
pub use coloring::Coloring;
pub use dense_output::Dense;
pub use elimination::Elimination;
pub use engine::blows::Blow;
pub use engine::{Control, Counts, Engine, Node};
pub use friction::Friction;
pub use halt::Halt;
pub use integration::{Integration, Progress, Zeno};
pub use kkt::Kkt;
pub use kkt::dense::{Lu, Singular};
pub use kkt::factor::Factor;
pub use kkt::number::Number;
pub use kkt::sparse::SparseLu;
pub use loaded::{Force, Loaded};
pub use method::Method;
pub use minimal::Minimal;
pub use pattern::{Common, Pattern, Power};
pub use scheme::{Level, Scheme};
pub use settings::Settings;
pub use sigma::Sigma;
pub use sparsity::Sparsity;
pub use state::{At, Dims, Span, State};
pub use system::{Ahead, Effect, Position, Stage, System, Tangent, Terms};
pub use why::{Rejected, Why};
