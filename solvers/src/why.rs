//! Why a step, or a whole run, cannot go on.

use std::fmt;

/// Why a step, or a whole run, cannot go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Why {
    /// The local error is too large by this factor.
    Error(f64),
    /// Newton's iteration did not converge.
    Newton,
    /// A matrix is singular: mass is missing, or the position is singular.
    Singular,
    /// A number is not finite; the index of the velocity whose equation it is in.
    NotFinite(usize),
    /// Constraints cannot be closed: the row with the largest residual, and that residual.
    Constraints {
        /// Row of Φ or of G.
        row: usize,
        /// What remains.
        residual: f64,
    },
    /// Friction by reactions has no accelerations that obey its law (Painlevé's paradox).
    Friction,
    /// The step has become too small to change the time.
    StepSize,
    /// Events pile up; the root that crossed last.
    Zeno(usize),
    /// A root of time alone whose sign cannot be bounded.
    Unresolved(usize),
    /// A blow against what drivers or other rows hold: the root of the contact.
    Blocked(usize),
    /// The step is too long for values that are followed from their last ones.
    Lost,
    /// More steps than are allowed.
    TooManySteps,
    /// This build does not have the scheme (see [`available`](crate::schemes::available)).
    Unavailable,
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Error(factor) => write!(f, "the local error is {factor:.1e} times too large"),
            Self::Newton => write!(f, "Newton's iteration does not converge"),
            Self::Singular => write!(f, "a matrix is singular: mass is missing, or the position is singular"),
            Self::NotFinite(index) => write!(f, "the equation of velocity {index} is not finite"),
            Self::Constraints { row, residual } => write!(f, "constraint row {row} cannot be closed: {residual:.1e} remains"),
            Self::Friction => write!(f, "friction by reactions has no accelerations that obey its law"),
            Self::StepSize => write!(f, "the step has become too small to change the time"),
            Self::Zeno(root) => write!(f, "events of root {root} pile up without end"),
            Self::Unresolved(root) => write!(f, "the sign of root {root} cannot be bounded"),
            Self::Blocked(root) => write!(f, "a blow at root {root} is against what other rows hold"),
            Self::Lost => write!(f, "the step is too long to count the turns of angles"),
            Self::TooManySteps => write!(f, "more steps than are allowed"),
            Self::Unavailable => write!(f, "this build does not have the scheme"),
        }
    }
}

impl std::error::Error for Why {}

/// Longest step that is tried after a rejected one, in lengths of that one.
pub(crate) const LONGEST_RETRY: f64 = 0.9;

/// A trial that failed, and the step to try next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rejected {
    /// The reason.
    pub why: Why,
    /// Step to try next, s; at most 0.9 of this one is taken.
    pub retry: f64,
}
