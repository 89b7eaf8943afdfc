//! The frozen mechanism: bodies on a spanning tree, gauges, constraint rows and forces, all indexed, nothing named twice.
//!
//! [`build`](mod@build) makes it from a model; afterwards indices are valid, parents come before children and masses are
//! not negative, so that `dynamics` holds no checks. It is immutable and shared by threads.

pub mod build;
mod contact;
mod force;
mod gauge;
mod group;
mod grouping;
mod inertia;
mod joint;
mod loops;
mod outline;
mod parts;
mod row;
mod sets;
mod size;
mod start;
mod step;
mod translation;
mod tree;

pub use build::{BuildFault, Coordinates, build, build_beside, build_uncut, is_uncut};
pub use contact::{Contact, ContactLaw};
pub use force::{
    Buffer, Drive, Effort, EffortLaw, Leaf, PointLoad, Pressed, Pressing, Rotor, StagedProgram, Stop, Stretch, StretchOf, Undefined,
};
pub use gauge::{Along, Gauge, Measured, Placed, Reading, Relative};
pub use group::Group;
pub use joint::{Joint, axis_rotation};
pub use loops::describe_loop;
pub use outline::{Outline, Solid, SolidForm};
pub use parts::{Attached, Body, Mechanism, TreeNode};
pub use row::{Function, Row, RowKind, RowOwner};
pub(crate) use sets::Sets;
pub use start::{Asked, Orientation, Start};
pub use step::Step;
