//! Tables with the rows that a page needs, and no more digits than they are good for.

use super::rows::{Curves, Kept};
use crate::results::{Column, Results, Table};
use serde::Serialize;
use std::collections::HashMap;

/// Part of a column's range that curves may be off between the rows that are kept.
pub(super) const WITHIN: f64 = 1e-4;
/// Rows of a study at most, about.
const MOST_ROWS: usize = 4000;
/// Part of the largest number of a unit below which a column is round-off.
const ROUND_OFF: f64 = 1e-12;
/// Parts of a column's range to which numbers are rounded: of a study, and of a run of a sweep.
pub(super) const OF_STUDY: f64 = 1e-6;
pub(super) const OF_RUN: f64 = 1e-5;
/// The same of the independent variable.
const PLACES: f64 = 1e-9;

/// What was left out of a table.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct RowsShown {
    /// Numbers of the rows that are kept, among those that were at hand.
    kept: Vec<usize>,
    /// Rows that the study has.
    of: usize,
    /// Rows that were at hand, if these are not all.
    selected: Option<usize>,
    /// Part of its range by which a curve may be off between them.
    within: f64,
    /// Places in `kept` behind which a new smooth piece begins.
    breaks: Vec<usize>,
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
    /// Of the columns that are `wanted`, with numbers rounded to a part of their column's range.
    pub(super) fn of(results: &Results, part: f64, wanted: &dyn Fn(&str) -> bool) -> Self {
        let x = &results.independent.values;
        let chosen = |columns: &'_ [Column]| -> Vec<usize> {
            (0..columns.len()).filter(|&i| wanted(&columns[i].name) && columns[i].values.len() == x.len()).collect()
        };
        let (table, curves) = (chosen(&results.table.columns), chosen(&results.curves));
        let columns: Vec<&Column> =
            table.iter().map(|&i| &results.table.columns[i]).chain(curves.iter().map(|&i| &results.curves[i])).collect();
        let all = Curves {
            x,
            columns: columns.iter().map(|c| c.values.as_slice()).collect(),
            allowed: allowed(&columns),
            switches: &results.table.switches,
        };
        let kept = all.kept(MOST_ROWS);
        // the variable among the columns is the same text again, which takes no room when it is compressed
        let own = |column: &Column| if column.name == results.independent.name { PLACES } else { part };
        let mut thin = columns.iter().map(|column| with_rows(column, &kept.rows, own(column)));
        let mut switches: Vec<usize> = results.table.switches.iter().filter_map(|row| kept.rows.binary_search(row).ok()).collect();
        switches.sort_unstable();
        Self {
            independent: with_rows(&results.independent, &kept.rows, PLACES),
            table: Table {
                columns: thin.by_ref().take(table.len()).collect(),
                switches,
                selected_from: results.table.selected_from,
                reasons: results.table.reasons.clone(),
            },
            curves: thin.collect(),
            shown: shown(kept, x.len(), results.table.selected_from),
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
        kept: kept.rows,
        breaks: kept.breaks,
    }
}

/// What each column may be off; more than its own noise, which is told by the largest number of its unit.
fn allowed(columns: &[&Column]) -> Vec<f64> {
    let mut largest: HashMap<&str, f64> = HashMap::new();
    for column in columns {
        let entry = largest.entry(&column.unit).or_default();
        *entry = entry.max(extent(&column.values).1);
    }
    columns
        .iter()
        .map(|column| {
            let noise = ROUND_OFF * largest.get(column.unit.as_str()).copied().unwrap_or(0.0);
            (WITHIN * extent(&column.values).0).max(noise).max(f64::MIN_POSITIVE)
        })
        .collect()
}

/// The range of finite numbers and the largest of their magnitudes.
fn extent(values: &[f64]) -> (f64, f64) {
    let finite = values.iter().copied().filter(|x| x.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    if low > high { (0.0, 0.0) } else { (high - low, low.abs().max(high.abs())) }
}

/// Some rows of a column, rounded to a part of its range.
fn with_rows(column: &Column, rows: &[usize], part: f64) -> Column {
    let (range, largest) = extent(&column.values);
    let varies = range > ROUND_OFF * largest;
    let unit = if varies { (part * range).max(1e-15 * largest) } else { ROUND_OFF * largest };
    let power = if unit > 0.0 { unit.log10().floor() as i32 } else { 0 };
    let values = rows.iter().map(|&row| rounded(column.values[row], power)).collect();
    Column {
        name: column.name.clone(),
        quantity: column.quantity.clone(),
        unit: column.unit.clone(),
        shown_in: column.shown_in.clone(),
        values,
    }
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
        let column = Column { values: vec![0.1 + 0.2, 1.0, 1.0 / 3.0], ..Column::default() };
        assert_eq!(with_rows(&column, &[0, 2], OF_STUDY).values, [0.3, 0.333_333_3]);
        let constant = Column { values: vec![1.0 / 3.0, 1.0 / 3.0 + 1e-16], ..Column::default() };
        assert_eq!(with_rows(&constant, &[0, 1], OF_STUDY).values, [0.333_333_333_333_3; 2]);
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
