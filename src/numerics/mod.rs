//! Numerical methods without mechanics: curves and their resolution, roots, extremes, quadrature, least squares, eigenvalues, slopes.

pub mod chebyshev;
pub(crate) mod complementarity;
pub mod continuous;
pub mod eigenvalues;
pub mod extremum;
pub mod hermite;
pub(crate) mod least_squares;
pub(crate) mod panel;
mod peaks;
pub mod quadrature;
pub mod resolve;
pub mod root;
pub mod samples;
pub(crate) mod sampling;
pub(crate) mod slope;
