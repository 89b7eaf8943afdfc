//! What an expression needs to be known.

use super::vocabulary::{Known, Quantity};

/// What an expression needs to be known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Needs {
    /// The highest level of a name in it.
    pub(crate) level: Known,
    /// Whether reactions are in it.
    pub(crate) reactions: bool,
    /// Whether springs are in it.
    pub(crate) springs: bool,
    /// Whether first-order states are in it.
    pub(crate) states: bool,
}

impl Needs {
    /// Of a number.
    pub(crate) const CONSTANT: Self = Self { level: Known::Constant, reactions: false, springs: false, states: false };

    /// Of a leaf.
    pub(crate) fn of(quantity: Quantity) -> Self {
        let states = matches!(quantity, Quantity::State(_) | Quantity::Bristle { .. });
        Self { level: quantity.level(), reactions: quantity.is_reaction(), springs: quantity.needs_springs(), states }
    }

    /// Of an expression of both.
    pub(crate) fn join(self, other: Self) -> Self {
        Self {
            level: self.level.max(other.level),
            reactions: self.reactions || other.reactions,
            springs: self.springs || other.springs,
            states: self.states || other.states,
        }
    }
}
