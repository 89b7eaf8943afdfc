//! Analyses of a mechanism: assembly, mobility, driven motion over a range, inverse dynamics, balancing, sweeps.
//!
//! A kinematic study is a [`Curve`](continuous::Curve): columns that can be evaluated at any place of the range. Its grid is
//! only where rows are written; extremes, integrals and switches are found on the curve itself.

pub mod assemble;
mod balance;
pub mod chebyshev;
pub mod clock;
mod complementarity;
mod contact;
pub mod continuous;
pub mod coordinates;
pub mod driven;
pub mod eigenvalues;
pub mod extremum;
mod fold;
pub mod forward;
mod functional;
pub mod hermite;
mod hills;
mod least_squares;
pub mod linear;
mod linearize;
pub mod mobility;
pub mod modes;
pub mod motion;
mod numbers;
pub mod observe;
pub mod outcome;
mod panel;
pub mod partition;
pub mod path;
mod periodic;
mod pieces;
pub mod quadrature;
pub mod rehearsal;
mod resolve;
pub mod root;
pub mod run;
mod scene;
pub mod solve;
mod standing;
mod statics;
pub mod survey;
pub mod sweep;
pub mod switching;
pub mod undefined;
