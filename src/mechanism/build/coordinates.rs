//! Choices of coordinates.

/// A choice of spanning tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coordinates {
    /// Minimum depth; joints off the tree are cut.
    #[default]
    Joint,
    /// Every body free in the ground frame, every joint cut.
    Cartesian,
}
