//! Constraint rows: a gauge at a target, a gauge that follows a driver, two gauges in a ratio, an expression that stays 0.
//!
//! | row | Φ | ν (G v = ν) | γ (G a = γ) |
//! |---|---|---|---|
//! | gauge | x − target | 0 | −c |
//! | driver | x − anchor − f(t) | f' | f'' − c |
//! | ratio | x₂ − anchor − ratio x₁ | 0 | −(c₂ − ratio c₁) |
//! | function | e(x, t) | −e_t | −(Σ e_i c_i + Σ e_ik ẋ_i ẋ_k + 2 Σ e_it ẋ_i + e_tt) |
//!
//! A row that holds a contact has its target in the state, not in the mechanism: it is where the contact came to rest.

use crate::geometry::Space;
use crate::scalar::Scalar;

/// One scalar constraint.
#[derive(Clone, Debug)]
pub struct Row<G: Space> {
    /// What it asks.
    pub kind: RowKind,
    /// What it belongs to.
    pub owner: RowOwner,
    /// Which of its owner's rows: "x", "axis"; the name of a coupling.
    pub label: String,
    /// Target, or the anchor that a start fixes (drivers with a speed or a rise, gears, racks).
    pub offset: G::S,
    /// True if the start fixes the offset, so that the row asks nothing of the start itself.
    pub anchored: bool,
    /// True if the row is an angle or a cosine, false if a length.
    pub angular: bool,
}

impl<G: Space> Row<G> {
    /// Whether it holds a joint on a rigid stop or what sticks; such rows stand behind all others.
    pub fn holds(&self) -> bool {
        matches!(self.owner, RowOwner::Stop(_) | RowOwner::Contact(_))
    }

    /// Its target, with where contacts are `held`.
    #[inline(always)]
    pub fn target(&self, held: &[G::S]) -> G::S {
        if let RowOwner::Contact(contact) = self.owner { held[contact] } else { self.offset }
    }
}

/// What a row asks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowKind {
    /// Gauge at the offset.
    Gauge(usize),
    /// Gauge at offset + f(t) of a driver.
    Driver {
        /// The gauge.
        gauge: usize,
        /// The driver.
        driver: usize,
    },
    /// `second` at offset + ratio · `first`.
    Ratio {
        /// Gauge whose multiple is taken.
        first: usize,
        /// Gauge that follows.
        second: usize,
        /// The ratio.
        ratio: f64,
    },
    /// A function at 0.
    Function(usize),
}

/// What a row belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowOwner {
    /// A joint cut off the tree.
    Joint(usize),
    /// A driver.
    Driver(usize),
    /// A coupling; the row's label is its name.
    Coupling,
    /// A rigid stop on which its joint rests.
    Stop(usize),
    /// A contact that sticks, where the state says.
    Contact(usize),
}

/// An expression e of gauges and time, with its derivatives as outputs of the position and velocity programs.
#[derive(Clone, Debug)]
pub struct Function {
    /// The gauges it depends on.
    pub gauges: Vec<usize>,
    /// Output of the position program that is e; the partial derivatives by the gauges follow it.
    pub value: usize,
    /// Output of the position program that is e_t, the derivative by time at fixed gauges; none if time is not in it.
    pub by_time: Option<usize>,
    /// Output of the velocity program that is ë at a = 0, with the terms of time: Σ e_i c_i + Σ e_ik ẋ_i ẋ_k + 2 Σ e_it ẋ_i + e_tt.
    pub drift: usize,
}

impl<G: Space> Row<G> {
    pub(super) fn lift<D: Scalar>(&self, constant: impl Fn(G::S) -> D) -> Row<G::Lift<D>> {
        Row {
            kind: self.kind,
            owner: self.owner,
            label: String::new(),
            offset: constant(self.offset),
            anchored: self.anchored,
            angular: self.angular,
        }
    }
}
