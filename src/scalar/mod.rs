//! The number type that kinematics, dynamics and expressions are written in: `f64`, [`Dual`] numbers that carry derivatives, or an
//! [`Interval`] that holds all values.
//!
//! The trait is as small as the mechanics allows. No comparison is in it: a kernel that branched on a value would lose the
//! derivative's meaning at the switch, so switches are decided outside by modes.

mod dual;
mod interval;
mod operations;

pub use dual::Dual;
pub use interval::Interval;
pub use operations::Scalar;
