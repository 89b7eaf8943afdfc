//! Tables with the rows that a page needs, and no more digits than they are good for.

use super::axes::{ROUND_OFF, Seen};
use super::rows::{Allowed, Curves, Kept};
use crate::results::{Column, Results, Table, bends, largest};
use serde::Serialize;
use std::collections::{BTreeMap, HashMap};

/// Part of the range of an axis that curves over it may be off between the rows that are kept.
pub(super) const WITHIN: f64 = 1e-4;
/// Rows of a study at most, about.
const MOST_ROWS: usize = 4000;
/// Significant digits of a number at least, but for round-off.
const DIGITS: i32 = 6;
/// Parts of the range of a column's axis to which numbers are rounded at most: of a study, and of a run of a sweep.
pub(super) const OF_STUDY: f64 = 1e-6;
pub(super) const OF_RUN: f64 = 1e-5;
/// The same of the independent variable.
const PLACES: f64 = 1e-9;

/// What was left out of a table.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct RowsShown {
    /// Of each row that is kept by how many rows it stands behind the one before, among those that were at hand; of the first its number.
    steps: Vec<usize>,
    /// Rows that the study has.
    of: usize,
    /// Rows that were at hand, if these are not all.
    selected: Option<usize>,
    /// Part of the range of its axis by which a curve may be off between them.
    within: f64,
    /// Places among the kept rows behind which a new smooth piece begins.
    breaks: Vec<usize>,
    /// For each column that jumps or bends at a switch the places among the kept rows just before those where it does.
    bends: BTreeMap<String, Vec<usize>>,
}

/// A study's rows as a page has them.
#[derive(Default)]
pub(super) struct Thinned {
    pub(super) independent: Column,
    pub(super) table: Table,
    pub(super) curves: Vec<Column>,
    pub(super) shown: RowsShown,
}

impl Thinned {
    /// Of the columns that are `wanted`, with numbers rounded to a part of the range of their axis.
    pub(super) fn of(results: &Results, part: f64, wanted: &dyn Fn(&str) -> bool) -> Self {
        let x = &results.independent.values;
        let chosen = |columns: &'_ [Column]| -> Vec<usize> {
            (0..columns.len()).filter(|&i| wanted(&columns[i].name) && columns[i].values.len() == x.len()).collect()
        };
        let (table, curves) = (chosen(&results.table.columns), chosen(&results.curves));
        let columns: Vec<&Column> =
            table.iter().map(|&i| &results.table.columns[i]).chain(curves.iter().map(|&i| &results.curves[i])).collect();
        let seen: Vec<Seen> = columns.iter().map(|column| Seen::of(results, column)).collect();
        let all = Curves {
            x,
            columns: columns.iter().map(|c| c.values.as_slice()).collect(),
            allowed: allowed(&columns, &seen),
            switches: &results.table.switches,
        };
        let kept = all.kept(MOST_ROWS);
        // the variable among the columns is the same text again, which takes no room when it is compressed
        let own = |column: &Column| if column.name == results.independent.name { PLACES } else { part };
        let mut thin = columns.iter().zip(&seen).map(|(column, seen)| with_rows(column, &kept.rows, own(column), seen));
        let places = |rows: &[usize]| {
            let mut places: Vec<usize> = rows.iter().filter_map(|row| kept.rows.binary_search(row).ok()).collect();
            places.sort_unstable();
            places
        };
        let switches = places(&results.table.switches);
        let largest = largest(columns.iter().copied());
        let shows = |column: &&Column| places(&bends(x, column, &largest, &results.table.switches));
        let bends = columns.iter().map(|column| (column.name.clone(), shows(column)));
        let bends: BTreeMap<String, Vec<usize>> = bends.filter(|(_, places)| !places.is_empty()).collect();
        Self {
            independent: with_rows(&results.independent, &kept.rows, PLACES, &Seen::of(results, &results.independent)),
            table: Table {
                columns: thin.by_ref().take(table.len()).collect(),
                switches,
                selected_from: results.table.selected_from,
                reasons: results.table.reasons.clone(),
            },
            curves: thin.collect(),
            shown: RowsShown { bends, ..shown(kept, x.len(), results.table.selected_from) },
        }
    }

    /// Numbers that it holds.
    pub(super) fn count(&self) -> usize {
        self.independent.values.len() * (1 + self.table.columns.len() + self.curves.len())
    }
}

fn shown(kept: Kept, rows: usize, selected_from: Option<usize>) -> RowsShown {
    RowsShown {
        of: selected_from.unwrap_or(rows),
        selected: selected_from.map(|_| rows),
        within: WITHIN * kept.off.max(1.0),
        steps: std::iter::once(0).chain(kept.rows.iter().copied()).zip(&kept.rows).map(|(before, row)| row - before).collect(),
        breaks: kept.breaks,
        bends: BTreeMap::new(),
    }
}

/// What each column may be off; more than its own noise, which is told by the largest number of its unit.
fn allowed(columns: &[&Column], seen: &[Seen]) -> Vec<Allowed> {
    let mut largest: HashMap<&str, f64> = HashMap::new();
    for (column, seen) in columns.iter().zip(seen) {
        let entry = largest.entry(&column.unit).or_default();
        *entry = entry.max(seen.largest());
    }
    let of = |(column, seen): (&&Column, &Seen)| {
        let noise = ROUND_OFF * largest.get(column.unit.as_str()).copied().unwrap_or(0.0);
        Allowed { within: (WITHIN * seen.span()).max(noise).max(f64::MIN_POSITIVE), axis: seen.axis }
    };
    columns.iter().zip(seen).map(of).collect()
}

/// Some rows of a column, rounded to a part of the range of its axis, or to so many digits where that leaves fewer.
fn with_rows(column: &Column, rows: &[usize], part: f64, seen: &Seen) -> Column {
    let values = rows.iter().map(|&row| rounded(column.values[row], power(column.values[row], part, seen))).collect();
    Column {
        name: column.name.clone(),
        quantity: column.quantity.clone(),
        unit: column.unit.clone(),
        shown_in: column.shown_in.clone(),
        values,
    }
}

/// The power of ten of which a number of a column is told as a whole multiple.
fn power(x: f64, part: f64, seen: &Seen) -> i32 {
    let largest = seen.largest();
    let range = if seen.shows(x) { seen.span() } else { seen.whole[1] - seen.whole[0] };
    let unit = if seen.varies() { (part * range).max(1e-15 * largest) } else { seen.round_off() };
    let floor = |unit: f64| if unit > 0.0 { unit.log10().floor() as i32 } else { 0 };
    let of_digits = if x == 0.0 || !x.is_finite() { i32::MAX } else { floor(x.abs()) + 1 - DIGITS };
    floor(unit).min(of_digits.max(floor(seen.round_off())))
}

/// A number as a whole multiple of a power of ten.
pub(super) fn rounded(x: f64, power: i32) -> f64 {
    let size = 10f64.powi(power.abs());
    // a sum with zero has no negative zero
    (if power < 0 { (x * size).round() / size } else { (x / size).round() * size }) + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_the_digits_that_count() {
        assert_eq!(rounded(1234.56789, -2), 1234.57);
        assert_eq!(rounded(1234.56789, 2), 1200.0);
        assert!(rounded(-1e-9, -2).is_sign_positive() && rounded(f64::NAN, 3).is_nan());
        let of = |values: &[f64]| {
            let column = Column { values: values.to_vec(), ..Column::default() };
            let rows: Vec<usize> = (0..values.len()).collect();
            with_rows(&column, &rows, OF_STUDY, &Seen::of(&Results::default(), &column)).values
        };
        assert_eq!(of(&[0.1 + 0.2, 1.0, 1.0 / 3.0]), [0.3, 1.0, 0.333_333_3]);
        assert_eq!(of(&[1.0 / 3.0, 1.0 / 3.0 + 1e-16]), [0.333_333_333_333_3; 2]);
        // beside a large number, too, but no round-off
        assert_eq!(of(&[2.345_678_9e7, -10.734_567_8, 0.333_333_333, 1e-9]), [23_456_789.0 - 9.0 + 10.0, -10.7346, 0.333_33, 0.0]);
    }

    #[test]
    fn figures_are_right_to_a_part_of_an_axis_that_is_cut() {
        use crate::results::{Finding, Plot};
        // it grows without bound towards a dead point at the end
        let x: Vec<f64> = (0..=2000).map(|i| f64::from(i) / 2000.0).collect();
        let value = |x: f64| (9.0 * x).sin() + 1e-3 / (1.0 - x).powi(3);
        let y = x.iter().map(|x| if *x < 1.0 { value(*x) } else { f64::NAN }).collect();
        let column = |name: &str, values: Vec<f64>| Column { name: name.into(), values, ..Column::default() };
        let mut results = Results {
            independent: column("t", x),
            table: Table { columns: vec![column("f", y)], ..Table::default() },
            findings: vec![Finding { code: "dead-point".into(), message: String::new(), path: String::new() }],
            plots: vec![Plot { show: vec!["f".into()], ..Plot::default() }],
            ..Results::default()
        };
        let off = |results: &Results| {
            let thin = Thinned::of(results, OF_STUDY, &|_| true);
            let nodes = |k: usize| [0, 1, 2, 3].map(|i| k.saturating_sub(1).min(thin.shown.steps.len() - 5) + i);
            let (t, f) = (&thin.independent.values, &thin.table.columns[0].values);
            let curve = |x: f64| {
                let nodes = nodes(t.iter().rposition(|at| *at <= x).unwrap_or(0));
                let weight = |k: usize| nodes.iter().filter(|i| **i != k).map(|i| (x - t[*i]) / (t[k] - t[*i])).product::<f64>();
                nodes.iter().map(|k| weight(*k) * f[*k]).sum::<f64>()
            };
            (0..1500).map(|i| f64::from(i) / 2000.0).map(|x| (curve(x) - value(x)).abs()).fold(0.0, f64::max)
        };
        assert!(off(&results) < 1e-3, "{}", off(&results));
        results.findings.clear();
        assert!(off(&results) > 2e-3, "all of it is one axis then: {}", off(&results));
    }

    #[test]
    fn round_off_asks_for_no_rows() {
        let x: Vec<f64> = (0..1000).map(|i| f64::from(i) / 1000.0).collect();
        let noise: Vec<f64> = (0..1000).map(|i| f64::from(i * 7919 % 1000) * 1e-16).collect();
        let column = |name: &str, values: Vec<f64>| Column { name: name.into(), unit: "N".into(), values, ..Column::default() };
        let results = Results {
            independent: column("t", x.clone()),
            table: Table { columns: vec![column("f", x), column("residual", noise)], ..Table::default() },
            ..Results::default()
        };
        let thin = Thinned::of(&results, OF_STUDY, &|_| true);
        assert_eq!(thin.independent.values.len(), 17);
        assert_eq!((thin.shown.of, thin.count()), (1000, 17 * 3));
    }
}
