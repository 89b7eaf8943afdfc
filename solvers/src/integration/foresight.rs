//! What is known ahead of switches of time alone.

/// How far ahead the roots of time alone are known to be positive, and the first that is not.
#[derive(Clone, Debug)]
pub(super) struct Foresight {
    /// Roots of time alone that are looked for.
    pub(super) roots: Vec<usize>,
    /// Modes for which this was found.
    pub(super) modes: Vec<i32>,
    /// None leaves its positive side before this time, s.
    pub(super) until: f64,
    /// The first that does: when, and its number.
    pub(super) next: Option<(f64, usize)>,
    /// Whether the bounds could not tell what is behind `until`.
    pub(super) unknown: bool,
}

impl Foresight {
    pub(super) fn new(roots: Vec<usize>, modes: usize) -> Self {
        Self { roots, modes: vec![0; modes], until: f64::NEG_INFINITY, next: None, unknown: false }
    }
}

/// A step that is too short to be made at `t` on the way to `until`, s.
pub(super) fn shortest(t: f64, until: f64) -> f64 {
    4.0 * f64::EPSILON * t.abs().max(until.abs() * 1e-3)
}
