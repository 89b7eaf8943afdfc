//! What a figure of curves shows.

/// Curves over an axis.
#[derive(Clone, Debug, Default)]
pub struct Figure {
    /// Above the picture; may be empty.
    pub title: String,
    /// The common axis.
    pub x: Axis,
    /// The other axis. Its `unit` counts for curves that have none of their own; curves of different units stand in panels of
    /// their own, up to three, one above the other. An empty `label` is made from the names of the curves.
    pub y: Axis,
    /// What is shown.
    pub curves: Vec<Curve>,
    /// The x of switches, in the unit of the axis: thin dashed lines, across which no curve is joined.
    pub breaks: Vec<f64>,
    /// Points of interest.
    pub marks: Vec<Mark>,
    /// One unit of x is as long as one of y: for paths in the plane.
    pub equal: bool,
    /// Unit and quantity of panels whose curves are not named after their quantity.
    pub quantities: Vec<(String, String)>,
    /// Ends of the vertical axis of the curves of a unit, where they are given.
    pub ranges: Vec<(String, [Option<f64>; 2])>,
    /// A second vertical axis on the right of the first panel, for the curves that are drawn over it.
    pub right: Option<Axis>,
}

/// What an axis says and how it runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// The quantity, without its unit.
    pub label: String,
    /// The unit as text, `N m`; empty for a pure number. Where numbers would be long it is shown with a prefix or a power of ten.
    pub unit: String,
    /// Even or logarithmic.
    pub scale: Scale,
    /// Its ends in this unit, where they are given.
    pub range: [Option<f64>; 2],
}

/// How an axis runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By powers of ten; values not above zero are left out.
    Log,
}

/// One curve, in the units of its axes.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    /// Its name in the legend.
    pub label: String,
    /// Its unit, if it is not the axis' own.
    pub unit: Option<String>,
    /// Its points; NaN breaks the line, and so does a pair of equal x if x else runs one way.
    pub points: Vec<(f64, f64)>,
    /// Whether it is drawn over the axis on the right.
    pub right: bool,
    /// Whether it is shown by its points alone, as what was measured.
    pub dots: bool,
}

/// A point of interest on a curve.
#[derive(Clone, Debug, Default)]
pub struct Mark {
    /// The text beside it.
    pub label: String,
    /// The index of the curve it belongs to.
    pub curve: usize,
    /// Where, in SI units.
    pub at: (f64, f64),
}
