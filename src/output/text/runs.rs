//! The runs of a sweep, columns aligned.

use crate::output::scalars::{six_digits, ten_digits};
use crate::results::{Column, PERCENTAGES, Part, Results, Statistics, Table, number};

/// Shares of the variance from here on are told.
const LEAST_SHARE: f64 = 5e-4;

/// A head and a line for each run, with the reason of those that are not whole.
pub(super) fn summary(table: &Table) -> String {
    let sizes: Vec<f64> = table.columns.iter().map(|column| column.shown().1).collect();
    let head = table.columns.iter().map(Column::heading);
    let mut lines: Vec<Vec<String>> = vec![head.collect()];
    for row in 0..table.rows() {
        let values = table.row(row).zip(&sizes).map(|(x, size)| x / size);
        lines.push(values.map(|x| if x.is_nan() { "-".into() } else { ten_digits(x) }).collect());
    }
    let reason = |i: usize| table.reasons.as_ref()?.get(i.checked_sub(1)?).filter(|reason| !reason.is_empty());
    let ends = |i: usize| reason(i).map_or_else(String::new, |reason| format!("  {reason}"));
    aligned(&lines).into_iter().enumerate().map(|(i, line)| line + &ends(i) + "\n").collect()
}

/// How the numbers of runs whose values are drawn are distributed, a line for each number.
pub(super) fn distributed(results: &Results) -> String {
    let of = |s: &Statistics| {
        let (unit, size) = s.shown();
        let values = [s.mean, s.deviation].into_iter().chain(s.percentiles).chain(s.range);
        let name = if unit.is_empty() { s.name.clone() } else { format!("{} [{unit}]", s.name) };
        std::iter::once(name).chain(values.map(|x| if x.is_nan() { "-".into() } else { six_digits(x / size) })).collect()
    };
    let percentages = PERCENTAGES.map(|p| format!("{p} %"));
    let head = ["", "mean", "deviation"].map(String::from).into_iter().chain(percentages).chain(["least", "most"].map(String::from));
    let lines: Vec<Vec<String>> = std::iter::once(head.collect()).chain(results.statistics.iter().map(of)).collect();
    let (all, least) = (results.runs.len(), results.statistics.iter().map(|s| s.runs).min().unwrap_or(0));
    let lost = if least < all { format!("; {} of them lack a number", all - least) } else { String::new() };
    let table: String = aligned(&lines).into_iter().map(|line| line + "\n").collect();
    format!("  {all} runs{lost}\n{table}") + &results.statistics.iter().map(shares).collect::<String>()
}

/// `variance of far: rod 97.1 %, crank 2.9 %`.
fn shares(of: &Statistics) -> String {
    let percent = |share: f64| format!("{} %", number((1000.0 * share).round() / 10.0));
    let mut parts: Vec<&Part> = of.parts.iter().filter(|part| part.share >= LEAST_SHARE).collect();
    parts.sort_by(|a, b| b.share.total_cmp(&a.share));
    let shown: Vec<String> = parts.iter().map(|part| format!("{} {}", part.parameter, percent(part.share))).collect();
    let rest = 1.0 - of.parts.iter().map(|part| part.share).sum::<f64>();
    let rest = if rest >= LEAST_SHARE { format!(", not linear {}", percent(rest)) } else { String::new() };
    if shown.is_empty() { String::new() } else { format!("  variance of {}: {}{rest}\n", of.name, shown.join(", ")) }
}

/// Lines of cells, in columns that end together.
fn aligned(lines: &[Vec<String>]) -> Vec<String> {
    let columns = lines.first().map_or(0, Vec::len);
    let widths: Vec<usize> = (0..columns).map(|i| lines.iter().map(|l| l[i].chars().count()).max().unwrap_or(0)).collect();
    let cells = |line: &Vec<String>| line.iter().zip(&widths).map(|(cell, width)| format!(" {cell:>width$}")).collect::<String>();
    lines.iter().map(|line| format!(" {}", cells(line))).collect()
}
