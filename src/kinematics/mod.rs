//! What a mechanism can do by its constraints: assembly, mobility, driven motion along a path, the linear motion about a pose.

pub mod assemble;
pub mod bounded;
pub mod coordinates;
pub mod driven;
mod fold;
mod freedom;
pub mod held;
pub(crate) mod indeterminate;
pub mod laws;
pub mod linear;
pub mod lowest;
pub mod lowest_damped;
pub mod mobility;
mod node;
mod orthonormal;
pub(crate) mod pair;
pub mod partition;
pub mod path;
pub mod pencil;
mod remaining;
pub(crate) mod saddle;
mod square;
pub(crate) mod standing;
mod steps;
pub mod survey;
pub(crate) mod thin;
pub mod undefined;
