//! Exit codes; several studies: the highest wins.

/// All done.
pub(crate) const DONE: u8 = 0;
/// An expectation is not met, `run --verify` finds no digit that stands, or `check --strict` has findings.
pub(crate) const UNMET: u8 = 1;
/// Usage, file or model.
pub(crate) const INPUT: u8 = 2;
/// A numerical failure.
pub(crate) const NUMERICAL: u8 = 3;
/// Interrupted.
pub(crate) const INTERRUPTED: u8 = 130;
