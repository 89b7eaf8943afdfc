//! Places in a model file, and points of bodies.

/// A path of keys in the model file, as `bodies.crank.bar.length` or `joints.O.revolute[1]`; the source place is looked up when a fault is shown.
pub type Place = String;

/// A point of a body: `points[point]` of `bodies[body]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PointRef {
    /// Index in [`Model::bodies`](super::whole::Model::bodies); 0 is the ground.
    pub body: usize,
    /// Index in [`Body::points`](super::bodies::Body::points).
    pub point: usize,
}
