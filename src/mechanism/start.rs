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
    /// A component of a body's angular velocity in world axes.
    Spin {
        /// The body.
        body: usize,
        /// 0 x, 1 y, 2 z.
        axis: usize,
    },
}
