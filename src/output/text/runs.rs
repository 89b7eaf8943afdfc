//! The runs of a sweep, columns aligned.

use crate::output::scalars::ten_digits;
use crate::results::{Column, Table};

/// A head and a line for each run, with the reason of those that are not whole.
pub(super) fn summary(table: &Table) -> String {
    let sizes: Vec<f64> = table.columns.iter().map(|column| column.shown().1).collect();
    let head = table.columns.iter().map(Column::heading);
    let mut lines: Vec<Vec<String>> = vec![head.collect()];
    for row in 0..table.rows() {
        let values = table.row(row).zip(&sizes).map(|(x, size)| x / size);
        lines.push(values.map(|x| if x.is_nan() { "-".into() } else { ten_digits(x) }).collect());
    }
    let widths: Vec<usize> = (0..table.columns.len()).map(|i| lines.iter().map(|l| l[i].chars().count()).max().unwrap_or(0)).collect();
    let mut out = String::new();
    for (i, line) in lines.iter().enumerate() {
        out.push(' ');
        for (cell, width) in line.iter().zip(&widths) {
            out.push_str(&format!(" {cell:>width$}"));
        }
        if let Some(reason) = i.checked_sub(1).and_then(|i| table.reasons.as_ref()?.get(i))
            && !reason.is_empty()
        {
            out.push_str(&format!("  {reason}"));
        }
        out.push('\n');
    }
    out
}
