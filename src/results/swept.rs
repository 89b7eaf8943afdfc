//! What a sweep varies, and which of its runs belong to one curve.

use super::{Column, ShownIn, Table, number};
use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};

/// Digits of values in names of curves, and all that a number has.
const IN_NAMES: usize = 6;
const ALL: usize = 17;

/// How the parameter of a sweep gets its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SweptBy {
    /// From a list or a span, in all combinations with the others.
    Grid,
    /// From a list of points, side by side with others.
    Points,
    /// From a distribution.
    Drawn,
}

/// A parameter of a sweep. Those of all parameters are the first columns of the table, in one order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Swept {
    /// How it gets its values.
    pub by: SweptBy,
    /// The unit in which the first of them is written, if it is.
    pub written_in: Option<ShownIn>,
}

/// Runs that make one curve of numbers of whole runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    /// The values of the parameters that tell it from others, `speed = 600 rpm`; empty if there is no other.
    pub label: String,
    /// Its rows in the table.
    pub rows: Vec<usize>,
}

/// The runs of a sweep as curves over a column of its table, by default the first parameter: one for each combination of the other
/// parameters. With them, whether there are points alone and no lines between them, since values are drawn or come from a list of points.
pub(super) fn families(table: &Table, swept: &[Swept], over: Option<&str>) -> (Vec<Family>, bool) {
    let along = table.columns.iter().take(swept.len()).position(|column| Some(column.name.as_str()) == over).unwrap_or(0);
    let is = |k: usize, by: SweptBy| swept.get(k).is_some_and(|swept| swept.by == by);
    let on_grid = is(along, SweptBy::Grid);
    // the values of points stand beside each other and tell each other apart only where the curve runs along something else
    let tells = |k: &usize| *k != along && (is(*k, SweptBy::Grid) || on_grid && is(*k, SweptBy::Points));
    let others: Vec<(&Column, &Swept)> = (0..swept.len()).filter(tells).map(|k| (&table.columns[k], &swept[k])).collect();
    let drawn = swept.iter().any(|swept| swept.by == SweptBy::Drawn);
    (by_values(table.rows(), &others), drawn || !swept.is_empty() && !on_grid)
}

/// Rows with the same values of some parameters, in the order in which these come first.
fn by_values(count: usize, others: &[(&Column, &Swept)]) -> Vec<Family> {
    let mut rows: Vec<Vec<usize>> = Vec::new();
    let mut places: HashMap<Vec<u64>, usize> = HashMap::new();
    for row in 0..count {
        let key = others.iter().map(|(column, _)| column.values[row].to_bits()).collect();
        let place = *places.entry(key).or_insert(rows.len());
        if place == rows.len() {
            rows.push(Vec::new());
        }
        rows[place].push(row);
    }
    let label = |rows: &Vec<usize>, digits: usize| {
        let value = |(column, swept): &(&Column, &Swept)| valued(column, swept, column.values[rows[0]], digits);
        others.iter().map(value).collect::<Vec<_>>().join(", ")
    };
    let labels = |digits: usize| rows.iter().map(|rows| label(rows, digits)).collect::<Vec<_>>();
    let short = labels(IN_NAMES);
    let distinct = short.iter().collect::<HashSet<_>>().len() == short.len();
    let labels = if distinct { short } else { labels(ALL) };
    labels.into_iter().zip(rows).map(|(label, rows)| Family { label, rows }).collect()
}

/// A parameter with a value in the unit that the model asks for, else in that in which its values are written: `speed = 600 rpm`.
fn valued(column: &Column, swept: &Swept, value: f64, digits: usize) -> String {
    let (unit, size) = match (&column.shown_in, &swept.written_in) {
        (None, Some(written)) => (written.unit.as_str(), written.size),
        _ => plainly(column),
    };
    let value = value / size;
    let value = if digits < ALL { format!("{value:.*e}", digits - 1).parse().unwrap_or(value) } else { value };
    format!("{} = {} {unit}", column.name, number(value)).trim_end().to_string()
}

/// The unit to show a column in, degrees for radians, and its size in SI.
fn plainly(column: &Column) -> (&str, f64) {
    match column.shown() {
        ("rad", _) if column.shown_in.is_none() => ("deg", 1f64.to_radians()),
        shown => shown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of parameters alone, and how they are swept.
    fn sweep(swept: &[(&str, SweptBy, &[f64])]) -> (Table, Vec<Swept>) {
        let column =
            |(name, _, values): &(&str, SweptBy, &[f64])| Column { name: (*name).into(), values: values.to_vec(), ..Column::default() };
        let by = |(_, by, _): &(&str, SweptBy, &[f64])| Swept { by: *by, written_in: None };
        (Table { columns: swept.iter().map(column).collect(), ..Table::default() }, swept.iter().map(by).collect())
    }

    fn told((table, swept): &(Table, Vec<Swept>), over: Option<&str>) -> (Vec<(String, Vec<usize>)>, bool) {
        let (families, dots) = families(table, swept, over);
        (families.into_iter().map(|family| (family.label, family.rows)).collect(), dots)
    }

    #[test]
    fn each_combination_of_the_other_parameters_is_a_curve() {
        let mut grid = sweep(&[("l", SweptBy::Grid, &[1.0, 1.0, 2.0, 2.0]), ("speed", SweptBy::Grid, &[6.0, 9.0, 6.0, 9.0])]);
        grid.1[1].written_in = Some(ShownIn { unit: "rpm".into(), size: 0.01 });
        let speeds = vec![("speed = 600 rpm".into(), vec![0, 2]), ("speed = 900 rpm".into(), vec![1, 3])];
        assert_eq!(told(&grid, None), (speeds.clone(), false));
        assert_eq!(told(&grid, Some("peak")), (speeds, false));
        assert_eq!(told(&grid, Some("speed")), (vec![("l = 1".into(), vec![0, 1]), ("l = 2".into(), vec![2, 3])], false));
        let one = sweep(&[("l", SweptBy::Grid, &[1.0, 2.0])]);
        assert_eq!(told(&one, None), (vec![(String::new(), vec![0, 1])], false));
    }

    #[test]
    fn drawn_values_and_lists_of_points_are_not_joined() {
        let drawn = sweep(&[("l", SweptBy::Drawn, &[1.0, 2.0, 1.0, 2.0]), ("m", SweptBy::Grid, &[1.0, 1.0, 3.0, 3.0])]);
        assert_eq!(told(&drawn, None), (vec![("m = 1".into(), vec![0, 1]), ("m = 3".into(), vec![2, 3])], true));
        assert_eq!(told(&drawn, Some("m")), (vec![(String::new(), vec![0, 1, 2, 3])], true));
        let points = sweep(&[("l", SweptBy::Points, &[1.0, 2.0]), ("m", SweptBy::Points, &[5.0, 4.0])]);
        assert_eq!(told(&points, None), (vec![(String::new(), vec![0, 1])], true));
    }

    #[test]
    fn names_have_as_many_digits_as_tell_them_apart() {
        let near = sweep(&[("l", SweptBy::Grid, &[1.0, 1.0]), ("m", SweptBy::Grid, &[1.000_000_1, 1.000_000_2])]);
        assert_eq!(told(&near, None).0[1].0, "m = 1.0000002");
    }
}
