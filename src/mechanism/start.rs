//! What a start asks for.

/// One asked start value.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// As written: `O.angle`.
    pub name: String,
    /// What is asked for.
    pub asked: Asked,
    /// Its value.
    pub value: f64,
    /// True if it only guides the search.
    pub guess: bool,
    /// Path in the model file.
    pub place: String,
}

/// The quantity that a start value is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// A gauge's value (order 0) or rate (order 1).
    Gauge {
        /// The gauge.
        gauge: usize,
        /// 0 or 1.
        order: usize,
    },
    /// A component of a body's angular velocity.
    Spin {
        /// The body.
        body: usize,
        /// 0 x, 1 y, 2 z.
        axis: usize,
        /// In the axes of the body instead of the world's.
        own: bool,
    },
    /// The orientation of a body; the value of the start is its angle.
    Orientation(usize),
}

/// An orientation that a start asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    /// The body.
    pub body: usize,
    /// Unit axis in the world.
    pub axis: [f64; 3],
    /// Rotation of the body in the world, a 3×3 matrix.
    pub matrix: [[f64; 3]; 3],
}
