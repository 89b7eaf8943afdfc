//! A solution on the path of a driven motion.

/// A solution on the path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathPoint {
    /// Time, s.
    pub t: f64,
    /// Coordinates (nq).
    pub q: Vec<f64>,
    /// Velocities (nv).
    pub v: Vec<f64>,
    /// Accelerations (nv).
    pub a: Vec<f64>,
    /// Unwrapped angles of cut hinges, by winding number.
    pub turns: Vec<f64>,
    /// How regular the constraints are: [`Driven::regularity`](super::driven::Driven::regularity).
    pub regularity: f64,
}

/// Pivot ratio below which a position counts as singular: rates would keep fewer than half of their digits.
pub const SINGULAR: f64 = 1e-7;
