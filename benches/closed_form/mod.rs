//! The crank-rocker and the quick return solved by hand: the yardstick of the benchmarks, and a second road to every number.
//!
//! Nothing here knows the program: the loops are solved by the intersection of circles, rates follow from the loop equations,
//! and the forces from Newton's and Euler's laws, link by link. SI units, radians.

#![allow(dead_code, reason = "each bench and each test uses its own part")]

pub(crate) mod crank_rocker;
pub(crate) mod plane;
pub(crate) mod quick_return;
