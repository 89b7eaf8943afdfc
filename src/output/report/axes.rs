//! The narrowest axis that shows a column: what its figures are to be right by.

use crate::output::Curve;
use crate::output::poles::bounded;
use crate::results::{Column, Plot, PlotAxis, Results};

/// Part of the largest number of a column below which its range is round-off.
pub(super) const ROUND_OFF: f64 = 1e-12;

/// Where the values of a column are, and the ends of the narrowest axis over which a figure draws it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    pub(super) whole: [f64; 2],
    pub(super) axis: [f64; 2],
}

impl Seen {
    /// Of a column among results.
    pub(super) fn of(results: &Results, column: &Column) -> Self {
        let x = &results.independent;
        let whole = extent(&column.values);
        let mut seen = Self { whole, axis: whole };
        // a reader may draw any column, and an axis leaves out what grows without bound towards a dead point
        if results.findings.iter().any(|finding| finding.code == "dead-point") {
            let points = x.values.iter().copied().zip(column.values.iter().copied()).collect();
            let curve = Curve { points, poles: [true; 2], ..Curve::default() };
            seen.narrow(bounded(std::iter::once(&curve)).unwrap_or(whole));
        }
        for plot in results.plots.iter().filter(|plot| !plot.of_runs) {
            for axis in axes(results, plot, column, whole) {
                seen.narrow(axis);
            }
        }
        seen
    }

    /// Takes an axis if it is narrower, and more than a point.
    fn narrow(&mut self, [low, high]: [f64; 2]) {
        let span = high - low;
        if span > ROUND_OFF * low.abs().max(high.abs()) && span < self.span() {
            self.axis = [low, high];
        }
    }

    /// Length of the axis.
    pub(super) fn span(&self) -> f64 {
        self.axis[1] - self.axis[0]
    }

    /// The largest number on the axis.
    pub(super) fn largest(&self) -> f64 {
        self.axis[0].abs().max(self.axis[1].abs())
    }

    /// What is nothing beside the numbers on the axis.
    pub(super) fn round_off(&self) -> f64 {
        ROUND_OFF * self.largest()
    }

    /// Whether the values are more than one number and its round-off.
    pub(super) fn varies(&self) -> bool {
        self.whole[1] - self.whole[0] > ROUND_OFF * self.whole[0].abs().max(self.whole[1].abs())
    }

    /// Whether the axis shows a value.
    pub(super) fn shows(&self, y: f64) -> bool {
        (self.axis[0]..=self.axis[1]).contains(&y)
    }
}

/// The axes of a figure that show a column.
fn axes(results: &Results, plot: &Plot, column: &Column, whole: [f64; 2]) -> Vec<[f64; 2]> {
    let over = plot.over.as_ref().map_or(Some(&results.independent), |over| results.table.column(over));
    let shown = |names: &[String]| names.contains(&column.name);
    let upright = |axis: Option<&PlotAxis>| {
        let within = over.filter(|_| plot.range != [None; 2]).map_or(whole, |over| {
            let inside = |x: f64| plot.range[0].is_none_or(|low| x >= low) && plot.range[1].is_none_or(|high| x <= high);
            extent_of(over.values.iter().zip(&column.values).filter(|(x, _)| inside(**x)).map(|(_, y)| *y))
        });
        let given = axis.filter(|axis| axis.si == column.unit).map_or([None; 2], |axis| axis.range);
        ends(given, within)
    };
    let left = shown(&plot.show).then(|| upright(plot.y.as_ref()));
    let right = plot.right.as_ref().filter(|right| shown(&right.show)).map(|right| upright(Some(&right.axis)));
    let across = plot.over.as_ref().filter(|over| **over == column.name).map(|_| ends(plot.range, whole));
    [left, right, across].into_iter().flatten().collect()
}

/// The ends of an axis: those that are given, else those of the values.
fn ends(given: [Option<f64>; 2], [low, high]: [f64; 2]) -> [f64; 2] {
    let [a, b] = [given[0].unwrap_or(low), given[1].unwrap_or(high)];
    [a.min(b), a.max(b)]
}

/// The least and the greatest of finite numbers; zeros of none.
pub(super) fn extent(values: &[f64]) -> [f64; 2] {
    extent_of(values.iter().copied())
}

fn extent_of(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let finite = values.filter(|x| x.is_finite());
    let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
    if low > high { [0.0; 2] } else { [low, high] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Finding;

    fn results(findings: &[&str], plots: Vec<Plot>) -> (Results, Column) {
        let x: Vec<f64> = (0..=200).map(|k| 0.005 * f64::from(k)).collect();
        let y = Column { name: "f".into(), unit: "N".into(), values: x.iter().map(|x| 1.0 / (1.0 - x)).collect(), ..Column::default() };
        let y = Column { values: y.values.iter().map(|y| if y.is_finite() { *y } else { f64::NAN }).collect(), ..y };
        let findings =
            findings.iter().map(|code| Finding { code: (*code).to_string().into(), message: String::new(), path: String::new() }).collect();
        let independent = Column { name: "t".into(), values: x, ..Column::default() };
        (Results { independent, findings, plots, ..Results::default() }, y)
    }

    #[test]
    fn what_grows_towards_a_dead_point_is_beyond_the_axis() {
        let (plain, y) = results(&[], Vec::new());
        assert_eq!(Seen::of(&plain, &y).axis, Seen::of(&plain, &y).whole);
        let (dead, y) = results(&["dead-point"], Vec::new());
        let seen = Seen::of(&dead, &y);
        assert!(seen.whole[1] > 199.0 && seen.axis[1] < 30.0, "{seen:?}");
    }

    #[test]
    fn the_ends_that_a_figure_gives_count() {
        let y = PlotAxis { si: "N".into(), range: [Some(0.0), Some(4.0)], ..PlotAxis::default() };
        let plot = Plot { show: vec!["f".into()], y: Some(y), ..Plot::default() };
        let early = Plot { show: vec!["f".into()], range: [None, Some(0.5)], ..Plot::default() };
        let (given, column) = results(&[], vec![plot]);
        assert_eq!(Seen::of(&given, &column).axis, [0.0, 4.0]);
        let (given, column) = results(&[], vec![early]);
        assert_eq!(Seen::of(&given, &column).axis, [1.0, 2.0]);
    }
}
