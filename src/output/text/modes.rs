//! Modes in a table, with what the methods have spent and what there is to say.

use crate::results::{Column, Results, number};
use std::f64::consts::TAU;

/// Coordinates that count in the printed shape, of the largest one.
const PART: f64 = 0.1;
/// Coordinates that are printed of a shape.
const PARTS: usize = 4;
/// Columns of the table that are numbers of a mode.
const NUMBERS: [&str; 5] = ["eigenvalue_real", "eigenvalue_imaginary", "eigenvalue", "frequency", "damping_ratio"];

/// The table of modes.
pub(super) fn summary(results: &Results) -> String {
    let numbers: Vec<&Column> = results.table.columns.iter().filter(|c| NUMBERS.contains(&c.name.as_str())).collect();
    let mut lines: Vec<Vec<String>> = vec![vec!["mode".into()]];
    lines[0].extend(numbers.iter().map(|column| column.heading()));
    lines[0].extend(["[1/s]".into(), "period [s]".into()]);
    for i in 0..results.shapes.len() {
        let mut line = vec![format!("{}", i + 1)];
        line.extend(numbers.iter().map(|c| digits(c.values.get(i).copied().unwrap_or(f64::NAN) / c.shown().1, 10)));
        let frequency = results.list("frequencies").and_then(|f| f.get(i).copied()).unwrap_or(f64::NAN);
        let swings = frequency > 0.0;
        line.extend([frequency / TAU, TAU / frequency].map(|x| if swings { digits(x, 6) } else { "-".into() }));
        lines.push(line);
    }
    let widths: Vec<usize> = (0..lines[0].len()).map(|c| lines.iter().map(|l| l[c].chars().count()).max().unwrap_or(0)).collect();
    let mut out = String::new();
    for (i, line) in lines.iter().enumerate() {
        let cells: Vec<String> = line.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
        let shape = i.checked_sub(1).map_or_else(|| "shape".into(), |i| parts(&results.shapes[i]));
        out.push_str(&format!("  {}  {shape}\n", cells.join("  ")));
    }
    out + &methods(results) + &results.findings.iter().map(|f| format!("  {}: {}\n", f.code, f.message)).collect::<String>()
}

/// What each method has spent, and how far it is from the first.
fn methods(results: &Results) -> String {
    let Some(first) = results.list("eigenvalues") else { return String::new() };
    let size = first.iter().fold(f64::MIN_POSITIVE, |m: f64, x| m.max(x.abs()));
    let mut lines = Vec::new();
    for (method, spent) in [("jacobi", "sweeps"), ("power", "steps")] {
        let own = results.list(&format!("eigenvalues_{method}"));
        if let (Some(own), Some([count])) = (own, results.list(&format!("{spent}_{method}"))) {
            let off = first.iter().zip(own).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / size;
            lines.push(format!("{method} {count} {spent}, within {off:.0e} of the largest"));
        }
    }
    if lines.is_empty() { String::new() } else { format!("  {}\n", lines.join("; ")) }
}

/// The coordinates that move most in a shape, the largest first; of the largest one 1.
fn parts(shape: &[(String, f64)]) -> String {
    let mut parts: Vec<&(String, f64)> = shape.iter().filter(|(name, _)| !name.ends_with(".phase")).collect();
    parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let Some(largest) = parts.first().map(|p| p.1) else { return String::new() };
    let shown = parts.iter().filter(|p| p.1.abs() >= PART * largest.abs()).take(PARTS);
    shown.map(|(name, x)| format!("{name} {}", digits(x / largest, 3))).collect::<Vec<_>>().join(", ")
}

/// Significant digits, without trailing zeros; `-` for what is no number.
fn digits(x: f64, count: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", count - 1).parse().unwrap_or(x);
    if rounded.is_finite() { number(rounded) } else { "-".into() }
}
