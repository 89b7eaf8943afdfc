//! What a figure of curves shows.

use super::scene::curve_style;

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
    /// The x of switches at which curves show, in the unit of the axis: thin dashed lines, across which no curve is joined.
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

impl Figure {
    /// How each curve is drawn: its colour (red, green, blue), and lengths of dash, gap, dash...; empty for a solid line. No two are alike,
    /// but for curves of one name in panels of different units.
    #[must_use]
    pub fn styles(&self) -> Vec<([u8; 3], &'static [f64])> {
        let mut places: Vec<usize> = Vec::with_capacity(self.curves.len());
        let mut count = 0;
        for (index, curve) in self.curves.iter().enumerate() {
            let one = |other: &&Curve| !curve.label.is_empty() && other.label == curve.label;
            let known = self.curves[..index].iter().position(|other| one(&other) && other.unit != curve.unit);
            let taken = self.curves[..index].iter().any(|other| one(&other) && other.unit == curve.unit);
            places.push(known.filter(|_| !taken).map_or(count, |known| places[known]));
            count = count.max(places[index] + 1);
        }
        places.into_iter().map(|place| curve_style(place, count)).collect()
    }
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
    /// What it is of, as `force`: what an axis says whose curves have too many names. May be empty.
    pub quantity: String,
    /// Its points; NaN breaks the line, and so does a pair of equal x if x else runs one way.
    pub points: Vec<(f64, f64)>,
    /// Whether it is drawn over the axis on the right.
    pub right: bool,
    /// Whether it is shown by its points alone, as what was measured.
    pub dots: bool,
    /// Whether a dead point is where it begins, and where it ends: values that grow without bound towards it may leave the axis.
    pub poles: [bool; 2],
    /// Whether its points are numbers of whole runs: those without bound, and those near a pole between two runs, may leave the axis.
    pub runs: bool,
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

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(names: &[(&str, &str)]) -> Figure {
        let curve = |(label, unit): &(&str, &str)| Curve { label: (*label).into(), unit: Some((*unit).into()), ..Curve::default() };
        Figure { curves: names.iter().map(curve).collect(), ..Figure::default() }
    }

    #[test]
    fn curves_of_one_name_are_alike_in_panels_of_different_units_alone() {
        let styles = figure(&[("rk4", "s"), ("bdf", "s"), ("rk4", ""), ("bdf", ""), ("rk4", "")]).styles();
        assert_eq!((styles[0], styles[1]), (styles[2], styles[3]));
        assert!(styles[4] != styles[0] && styles[4] != styles[1] && styles[0] != styles[1]);
    }
}
