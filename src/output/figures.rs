//! Figures that a study asks for, laid out from its results.

use super::units::pretty;
use super::{Axis, Curve, Figure, Scale, poles};
use crate::results::{Column, Family, Plot, PlotAxis, PlotBeside, Results, bends, largest};
use std::collections::BTreeSet;

/// Switches that are marked by lines in a figure, at most.
const MOST_MARKED: usize = 16;

/// How much steeper than beside it a curve of whole runs is where it jumps.
const STEEP: f64 = 8.0;

/// Figures of a study by name; of a sweep curves for each run, told apart by its label, and numbers of whole runs.
pub fn figures(results: &Results) -> Vec<(String, Figure)> {
    let runs: Vec<(Option<&str>, &Results)> = if results.table.reasons.is_none() {
        vec![(None, results)]
    } else {
        results.runs.iter().filter_map(|run| Some((Some(run.label.as_str()), run.results.as_deref()?))).collect()
    };
    let curves = results.plots.iter().filter(|plot| !plot.of_runs).map(|plot| (plot.name.clone(), of_columns(results, plot, &runs)));
    let numbers = results.plots.iter().filter(|plot| plot.of_runs && results.table.reasons.is_some());
    curves.chain(numbers.filter_map(|plot| Some((plot.name.clone(), of_runs(results, plot)?)))).collect()
}

/// Curves of columns.
fn of_columns(results: &Results, plot: &Plot, runs: &[(Option<&str>, &Results)]) -> Figure {
    let several = runs.len() > 1;
    let (left, right) = (&plot.show, plot.right.iter().flat_map(|right| &right.show).collect::<Vec<_>>());
    let mut curves = Vec::new();
    for (label, run) in runs {
        let x = plot.over.as_ref().map_or(Some(&run.independent), |over| column(run, over));
        let sides = left.iter().map(|name| (name, false)).chain(right.iter().map(|name| (*name, true)));
        for (y, on_right) in sides.filter_map(|(name, on_right)| Some((column(run, name)?, on_right))) {
            let name = match label {
                Some(label) if several && left.len() + right.len() > 1 => format!("{}, {}", y.name, pretty(label)),
                Some(label) if several => pretty(label),
                _ => y.name.clone(),
            };
            let points = joined(x.map_or(&[], |x| &x.values), &y.values, &run.table.switches, plot.over.is_some());
            // a dead point is where a motion ends, on one side or both
            let dead = plot.over.is_none() && run.findings.iter().any(|finding| finding.code == "dead-point");
            curves.push(Curve { poles: [dead; 2], ..curve(name, y, points, plot, on_right) });
        }
    }
    let first = runs.first().map(|(_, run)| *run);
    curves.extend(plot.beside.iter().filter_map(|beside| self::beside(beside, column(first?, &beside.of)?, plot)));
    let over = first.and_then(|run| plot.over.as_ref().map_or(Some(&run.independent), |over| column(run, over)));
    let (x, factor) = axis(plot, over);
    scale_x(&mut curves, factor);
    let breaks = match (&plot.over, runs) {
        (None, [(_, run)]) => marked(run, plot).into_iter().map(|row| run.independent.values[row] / factor).collect(),
        _ => vec![],
    };
    let shown: Vec<&Column> = first.map_or_else(Vec::new, |run| plot.show.iter().filter_map(|name| column(run, name)).collect());
    let alike = |column: &Column| unit(column, plot.y.as_ref()).0 == x.unit;
    let free = plot.right.is_none() && plot.y.as_ref().is_none_or(|y| y.range == [None; 2]) && plot.range == [None; 2];
    let same_plane = free && plot.path && shown.iter().copied().all(alike);
    let y = match shown[..] {
        [only] if (several || !plot.beside.is_empty()) && left.len() == 1 => {
            Axis { label: only.name.clone(), unit: unit(only, plot.y.as_ref()).0, ..Axis::default() }
        }
        _ => Axis::default(),
    };
    let right = plot.right.as_ref().and_then(|right| Some((right, column(first?, right.show.first()?)?)));
    Figure { x, y, curves, breaks, equal: same_plane, ..sides(results, plot, &shown, right.map(|(_, column)| column)) }
}

/// Rows before switches at which a curve of a plot shows. Lines help at a few; many would cover the curves.
fn marked(run: &Results, plot: &Plot) -> Vec<usize> {
    let shown = plot.show.iter().chain(plot.right.iter().flat_map(|right| &right.show)).filter_map(|name| column(run, name));
    let shown: Vec<&Column> = shown.collect();
    let largest = largest(shown.iter().copied());
    let of = |column: &&Column| bends(&run.independent.values, column, &largest, &run.table.switches);
    let rows: BTreeSet<usize> = shown.iter().flat_map(of).collect();
    if rows.len() > MOST_MARKED { Vec::new() } else { rows.into_iter().collect() }
}

/// Title and vertical axes of a figure, of which `left` are columns of the axes on the left, and `right` is one of that on the right.
fn sides(results: &Results, plot: &Plot, left: &[&Column], right: Option<&Column>) -> Figure {
    let ends = |axis: &PlotAxis, size: f64| axis.range.map(|end| Some(end? / size));
    let range = plot.y.as_ref().and_then(|y| {
        let (unit, size) = unit(left.iter().find(|column| column.unit == y.si)?, Some(y));
        Some((unit, ends(y, size)))
    });
    let right = plot.right.as_ref().zip(right).map(|(right, column)| {
        let (unit, size) = unit(column, Some(&right.axis));
        let label = if right.show.len() == 1 { right.show[0].clone() } else { String::new() };
        Axis { label, unit, range: ends(&right.axis, size), ..Axis::default() }
    });
    Figure { title: title(results, plot), ranges: range.into_iter().collect(), right, ..Figure::default() }
}

/// A curve that does not come from the study, in the unit of the column whose quantity it is.
fn beside(beside: &PlotBeside, of: &Column, plot: &Plot) -> Option<Curve> {
    let on_right = plot.right.as_ref().is_some_and(|right| right.show.contains(&beside.of));
    let points = beside.x.iter().copied().zip(beside.y.iter().copied()).collect();
    Some(Curve { dots: beside.measured, ..curve(beside.label.clone(), of, points, plot, on_right) })
}

/// Numbers of whole runs over a swept parameter, or over another number.
fn of_runs(results: &Results, plot: &Plot) -> Option<Figure> {
    let over = match &plot.over {
        Some(over) => results.table.column(over)?,
        None => results.table.columns.first()?,
    };
    let (x, factor) = axis(plot, Some(over));
    let nowhere = vec![f64::NAN; results.table.rows()];
    let none = Column { values: nowhere, ..Column::default() };
    let right = plot.right.iter().flat_map(|right| &right.show);
    let names: Vec<&String> = plot.show.iter().chain(right.clone()).collect();
    let (families, dots) = results.families(plot.over.as_deref());
    let several = families.len() > 1;
    let shown = |name: &String, family: &Family| {
        let column = results.table.column(name).unwrap_or(&none);
        let on_right = plot.right.as_ref().is_some_and(|right| right.show.contains(name));
        let label = match (several, names.len()) {
            (true, 1) => pretty(&family.label),
            (true, _) => format!("{name}, {}", pretty(&family.label)),
            _ => name.clone(),
        };
        let points = broken(family.rows.iter().map(|row| (over.values[*row], column.values[*row])).collect());
        Curve { dots, runs: true, ..curve(label, column, points, plot, on_right) }
    };
    let mut curves: Vec<Curve> = families.iter().flat_map(|family| names.iter().map(|name| shown(name, family))).collect();
    curves.extend(plot.beside.iter().filter_map(|beside| self::beside(beside, results.table.column(&beside.of)?, plot)));
    scale_x(&mut curves, factor);
    let right = right.clone().next().and_then(|name| results.table.column(name));
    let left: Vec<&Column> = plot.show.iter().filter_map(|name| results.table.column(name)).collect();
    let y = match left[..] {
        [only] if several && names.len() == 1 => Axis { label: only.name.clone(), unit: unit(only, plot.y.as_ref()).0, ..Axis::default() },
        _ => Axis::default(),
    };
    Some(Figure { x, y, curves, ..sides(results, plot, &left, right) })
}

/// A column by its name, or a curve that only figures show.
fn column<'r>(results: &'r Results, name: &str) -> Option<&'r Column> {
    results.table.column(name).or_else(|| results.curves.iter().find(|column| column.name == name))
}

/// Points of a curve; where a path in the plane jumps at a switch, the line is broken.
fn joined(x: &[f64], y: &[f64], switches: &[usize], path: bool) -> Vec<(f64, f64)> {
    let mut points = Vec::with_capacity(x.len());
    for (i, (x, y)) in x.iter().zip(y).enumerate() {
        points.push((*x, *y));
        if path && switches.contains(&i) {
            points.push((f64::NAN, f64::NAN));
        }
    }
    points
}

/// Points of whole runs with a gap where a quantity jumps from one run to the next, as where a mechanism is assembled otherwise from
/// there on: where its slope is [`STEEP`] times those on both sides, over more than a tenth of its range; and with one at a pole. Lines
/// lead to values without bound.
fn broken(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let slope = |k: usize| ((points[k + 1].1 - points[k].1) / (points[k + 1].0 - points[k].0)).abs();
    let bound = poles::bound(&points);
    let values = points.iter().map(|point| point.1).filter(|y| y.abs() < bound);
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
    let jumps = |k: usize| {
        let far = (points[k + 1].1 - points[k].1).abs() > 0.1 * (high - low);
        let bounded = [k, k + 1].iter().all(|k| points[*k].1.abs() < bound);
        far && bounded && k > 0 && k + 2 < points.len() && slope(k) > STEEP * slope(k - 1).max(slope(k + 1))
    };
    let mut out = Vec::with_capacity(points.len());
    for (k, point) in points.iter().enumerate() {
        out.push(*point);
        if k + 1 < points.len() && (jumps(k) || poles::is_pole(&points, k)) {
            out.push((point.0, f64::NAN));
        }
    }
    out
}

fn title(results: &Results, plot: &Plot) -> String {
    format!("{}, {}: {}", results.model, results.study, plot.name.replace('_', " "))
}

/// The horizontal axis and the factor that its values are divided by.
fn axis(plot: &Plot, over: Option<&Column>) -> (Axis, f64) {
    let label = over.map_or_else(String::new, |column| column.name.clone());
    let (unit, size) = plot.unit.clone().or_else(|| over.map(|over| unit(over, None))).unwrap_or_else(|| (String::new(), 1.0));
    (Axis { label, unit, scale: Scale::Linear, range: plot.range.map(|end| Some(end? / size)) }, size)
}

/// A curve in the unit in which its column is shown; `points` are SI.
fn curve(label: String, column: &Column, mut points: Vec<(f64, f64)>, plot: &Plot, right: bool) -> Curve {
    let axis = if right { plot.right.as_ref().map(|right| &right.axis) } else { plot.y.as_ref() };
    let (unit, size) = unit(column, axis);
    points.iter_mut().for_each(|point| point.1 /= size);
    Curve { label, unit: Some(unit), quantity: column.quantity.clone(), points, right, ..Curve::default() }
}

/// The unit in which figures show a column, and its size in SI: that of an axis for its quantity, else that of the model, else degrees
/// for radians.
fn unit(column: &Column, axis: Option<&PlotAxis>) -> (String, f64) {
    if let Some(unit) = axis.filter(|axis| axis.si == column.unit).and_then(|axis| axis.unit.clone()) {
        return unit;
    }
    match column.shown() {
        ("rad", size) if column.shown_in.is_none() => ("deg".into(), size.to_radians()),
        (unit, size) => (unit.into(), size),
    }
}

fn scale_x(curves: &mut [Curve], factor: f64) {
    for point in curves.iter_mut().flat_map(|c| &mut c.points) {
        point.0 /= factor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{ShownIn, Swept, SweptBy, Table};

    #[test]
    fn numbers_of_a_grid_are_a_curve_for_each_value_of_the_other_parameter() {
        let column = |name: &str, values: &[f64]| Column { name: name.into(), values: values.to_vec(), ..Column::default() };
        let columns =
            vec![column("l", &[1.0, 1.0, 2.0, 2.0]), column("speed", &[6.0, 9.0, 6.0, 9.0]), column("peak", &[10.0, 20.0, 30.0, 40.0])];
        let table = Table { columns, reasons: Some(vec![String::new(); 4]), ..Table::default() };
        let swept = |by| vec![Swept { by, written_in: None }, Swept { by: SweptBy::Grid, written_in: None }];
        let plot = Plot { name: "peak".into(), show: vec!["peak".into()], of_runs: true, ..Plot::default() };
        let sweep = Results { table, swept: swept(SweptBy::Grid), plots: vec![plot], ..Results::default() };
        let figure = figures(&sweep).remove(0).1;
        let curves: Vec<_> = figure.curves.iter().map(|curve| (curve.label.as_str(), curve.points.clone())).collect();
        assert_eq!(curves, [("speed = 6", vec![(1.0, 10.0), (2.0, 30.0)]), ("speed = 9", vec![(1.0, 20.0), (2.0, 40.0)])]);
        assert_eq!((figure.y.label.as_str(), figure.curves[0].dots), ("peak", false));
        let drawn = Results { swept: swept(SweptBy::Drawn), ..sweep };
        assert!(figures(&drawn).remove(0).1.curves.iter().all(|curve| curve.dots));
    }

    #[test]
    fn curves_of_runs_break_where_they_jump() {
        let over = |y: &[f64]| y.iter().enumerate().map(|(k, y)| (k as f64, *y)).collect::<Vec<_>>();
        let gaps = |y: &[f64]| broken(over(y)).iter().enumerate().filter(|(_, point)| point.1.is_nan()).map(|(k, _)| k).collect::<Vec<_>>();
        // a truss that falls through, and a count
        assert_eq!(gaps(&[0.49, 0.47, 0.45, 0.43, 0.39, -0.79, -0.795, -0.8]), [5]);
        assert_eq!(gaps(&[1.0, 1.0, 0.0, 0.0]), [2]);
        // a peak between two runs, a steep rise, and ends of which nothing is known beyond
        assert!(gaps(&[0.0, 0.1, 5.0, 0.1, 0.0]).is_empty());
        assert!(gaps(&[0.0, 0.1, 0.5, 2.0, 5.0, 6.0]).is_empty() && gaps(&[0.0, 5.0, 5.1]).is_empty());
    }

    #[test]
    fn lines_stand_at_the_switches_at_which_a_curve_shows() {
        let x: Vec<f64> = (0..=10).chain(10..=20).map(f64::from).collect();
        let column =
            |name: &str, y: fn(f64) -> f64| Column { name: name.into(), values: x.iter().map(|x| y(*x)).collect(), ..Column::default() };
        let columns = vec![column("bent", |x| (x - 10.0).max(0.0)), column("straight", |x| 2.0 * x)];
        let breaks = |show: &[&str]| {
            let plot = Plot { name: "f".into(), show: show.iter().map(|name| (*name).into()).collect(), ..Plot::default() };
            let table = Table { columns: columns.clone(), switches: vec![10], ..Table::default() };
            let independent = Column { name: "t".into(), values: x.clone(), ..Column::default() };
            figures(&Results { table, independent, plots: vec![plot], ..Results::default() }).remove(0).1.breaks
        };
        assert_eq!(breaks(&["straight", "bent"]), [10.0]);
        assert!(breaks(&["straight"]).is_empty());
    }

    #[test]
    fn axes_of_different_places_fill_their_ranges() {
        let column = |name: &str| Column { name: name.into(), unit: "m".into(), values: vec![0.0, 1.0], ..Column::default() };
        let of = |path: bool| {
            let plot = Plot { name: "f".into(), show: vec!["y".into()], over: Some("x".into()), path, ..Plot::default() };
            let table = Table { columns: vec![column("x"), column("y")], ..Table::default() };
            figures(&Results { table, plots: vec![plot], ..Results::default() }).remove(0).1.equal
        };
        assert!(of(true) && !of(false));
    }

    #[test]
    fn columns_are_in_the_units_that_are_asked_for_and_angles_else_in_degrees() {
        let asked = |unit: &str, size| Some(ShownIn { unit: unit.into(), size });
        let shown = |si: &str, asked: Option<ShownIn>| {
            let column = Column { unit: si.into(), shown_in: asked, ..Column::default() };
            let curve = curve("a".into(), &column, vec![(0.0, 6.0)], &Plot::default(), false);
            (curve.unit.unwrap_or_default(), curve.points[0].1)
        };
        assert_eq!(shown("m", asked("mm", 1e-3)), ("mm".into(), 6000.0));
        assert_eq!(shown("m", None), ("m".into(), 6.0));
        assert_eq!(shown("rad", None), ("deg".into(), 6.0_f64.to_degrees()));
        assert_eq!(shown("rad", asked("rad", 1.0)), ("rad".into(), 6.0));
        assert_eq!(shown("rad/s", None), ("rad/s".into(), 6.0));
    }
}
