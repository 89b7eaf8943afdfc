//! Why the map of a period has no derivative.

/// Why there is no derivative.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Rough {
    /// The mass matrix is singular, or a state cannot be evaluated, at this time, s.
    Singular(f64),
    /// A switch is only touched at this time, s.
    Touched(f64),
    /// What is met at this time, s, in words: neighbours that meet one after the other go on in another way. Whether blows are among it.
    Together { t: f64, met: Vec<String>, blows: bool },
    /// A joint rests on a rigid stop, or a contact sticks, in a part of the period.
    Rests,
}
