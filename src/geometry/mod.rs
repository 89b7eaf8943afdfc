//! Rigid-body geometry, once for the plane and for space.
//!
//! [`Space`] is SE(2) ([`Planar`]) or SE(3) ([`Spatial`]) together with its scalar; nothing above this module knows a
//! dimension. Twists and wrenches are Plücker vectors **in world axes at a reference point** that is fixed in the world and near the
//! bodies (`mechanism/group.rs`), places being measured from there: a [`Motion`] is (ω, velocity of the body-fixed point that passes
//! through it), a [`Force`] is (moment about it, force); an [`Inertia`] is about it too. Frames are named by monogram: `x_wb` is the pose of b in w, and neighbours match
//! in `x_wb * x_bc` (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, chapter 2).

mod planar;
mod quaternion;
mod space;
mod spatial;
mod twist;

pub use planar::{Planar, Turn};
pub use quaternion::Quaternion;
pub use space::{Linear, Space, basis};
pub use spatial::Spatial;
pub use twist::{Force, Inertia, MassProperties, Motion, Pose};
