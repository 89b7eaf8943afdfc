//! The true shape of a body, as the model gives it: for drawings, no mechanics depends on it.

/// A shape in the frame of its body, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// A straight bar; thin if its width and height are 0.
    Bar {
        /// One end.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
        /// Width across, along y of a bar along x.
        width: f64,
        /// Height, along z of a bar along x; of others both are turned with it by the smallest rotation. 0 in the plane.
        height: f64,
    },
    /// A disc.
    Disc {
        /// Centre.
        center: [f64; 3],
        /// What it is round about, of length 1; z in the plane.
        axis: [f64; 3],
        /// Radius.
        radius: f64,
        /// Thickness; thin if 0.
        thickness: f64,
    },
    /// A plate (planar: two sizes) or box, centred at the origin.
    Block {
        /// Sizes along the axes of the body.
        size: [f64; 3],
    },
    /// A ball centred at the origin.
    Ball {
        /// Radius.
        radius: f64,
    },
}
