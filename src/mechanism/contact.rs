//! Exact friction and one-way clutches: what holds a coordinate until it is let go.

use super::StretchOf;

/// A coordinate that sticks and slides. While it sticks, a row holds it where it came to rest ([`super::Mechanism::hold`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// What it is, in words: "friction of joint `A`".
    pub name: String,
    /// Path of keys in the model file.
    pub place: String,
    /// The coordinate.
    pub along: StretchOf,
    /// Whether the coordinate is an angle.
    pub angular: bool,
    /// Mode that holds the sense in which it slides, −1 or 1; 0 while it sticks.
    pub mode: usize,
    /// Switches of the model that are the sign of the same rate, as in its `abs`: they stand as it does.
    pub follow: Vec<usize>,
    /// What holds it.
    pub law: ContactLaw,
}

/// What holds a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactLaw {
    /// Dry friction.
    Friction {
        /// The effort by which it slides.
        effort: usize,
        /// Output of the force program: the largest force or torque that holds, or that per newton of the normal force.
        holds: usize,
        /// What makes the normal force, among `Mechanism::pressings`.
        pressing: Option<usize>,
    },
    /// The rate does not become negative.
    OneWay {
        /// An effort of no size, which stands for it.
        effort: usize,
    },
}

impl Contact {
    /// Whether it is a one-way clutch.
    #[must_use]
    pub fn is_one_way(&self) -> bool {
        matches!(self.law, ContactLaw::OneWay { .. })
    }

    /// The largest of what holds it, if that is friction: an output of the force program and what it is multiplied by.
    #[must_use]
    pub fn friction(&self) -> Option<(usize, Option<usize>)> {
        match self.law {
            ContactLaw::Friction { holds, pressing, .. } => Some((holds, pressing)),
            ContactLaw::OneWay { .. } => None,
        }
    }

    /// What counts as a whole way of it: 1 rad, or the size, m.
    #[must_use]
    pub fn unit(&self, size: f64) -> f64 {
        if self.angular { 1.0 } else { size }
    }
}
