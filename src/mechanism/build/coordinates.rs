//! Choices of coordinates.

/// A choice of spanning tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coordinates {
    /// Minimum depth; joints off the tree are cut.
    #[default]
    Joint,
    /// Every body free in the ground frame, every joint cut.
    Cartesian,
    /// The tree of [`Coordinates::Joint`] with free bodies where a road from the ground or from a free body has this many joints: the
    /// joints that led to them are cut.
    Bounded(usize),
}
