//! `grashof modes`: eigenvalues and shapes of a model that has no study of them; and modes as a table, for every study of them.

use super::{Common, adhoc};
use clap::ValueEnum;
use grashof::output::{Header, Table, json_number, number};
use grashof::results::Outcome;
use serde_json::Value;
use std::f64::consts::TAU;

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    study: adhoc::Arguments,
    /// The pose: that of the start, or the equilibrium that is found from there
    #[arg(long, value_enum, default_value = "start")]
    at: At,
    /// Count damping: complex eigenvalues and damping ratios
    #[arg(long)]
    damped: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum At {
    Start,
    Statics,
}

/// Computes the modes.
pub(super) fn modes(arguments: &Arguments, common: &Common) -> u8 {
    let at = match arguments.at {
        At::Start => "start",
        At::Statics => "statics",
    };
    let methods = "methods: [library, jacobi, power]";
    adhoc::study(&arguments.study, "modes", &format!("modes: {{ at: {at}, damped: {}, {methods} }}", arguments.damped), common)
}

/// Coordinates that count in the printed shape, of the largest one.
const PART: f64 = 0.1;
/// Coordinates that are printed of a shape.
const PARTS: usize = 4;

/// The values of a list, none if there is no such list.
fn list<'a>(outcome: &'a Outcome, name: &str) -> Option<&'a [f64]> {
    outcome.lists.iter().find(|l| l.name == name).map(|l| l.values.as_slice())
}

/// Names and units of the numbers of each mode, with the lists that hold them.
fn numbers(outcome: &Outcome) -> Vec<(&'static str, &'static str, &[f64])> {
    let all = match list(outcome, "eigenvalues_real") {
        Some(real) => vec![
            ("eigenvalue_real", "1/s", Some(real)),
            ("eigenvalue_imaginary", "1/s", list(outcome, "eigenvalues_imaginary")),
            ("frequency", "rad/s", list(outcome, "frequencies")),
            ("damping_ratio", "", list(outcome, "damping_ratios")),
        ],
        None => vec![("eigenvalue", "1/s^2", list(outcome, "eigenvalues")), ("frequency", "rad/s", list(outcome, "frequencies"))],
    };
    all.into_iter().filter_map(|(name, unit, values)| Some((name, unit, values?))).collect()
}

/// One row a mode: its numbers, then its shape by coordinates.
pub(super) fn rows(outcome: &Outcome) -> Table {
    let numbers = numbers(outcome);
    let mut columns = vec![Header::new("mode", "")];
    columns.extend(numbers.iter().map(|(name, unit, _)| Header::new(*name, *unit)));
    let shape = outcome.shapes.first().into_iter().flatten();
    columns.extend(shape.map(|(name, _)| Header::new(name.clone(), if name.ends_with(".phase") { "rad" } else { "" })));
    let row = |(i, shape): (usize, &Vec<(String, f64)>)| {
        let own = numbers.iter().map(|(_, _, values)| values.get(i).copied().unwrap_or(f64::NAN));
        std::iter::once((i + 1) as f64).chain(own).chain(shape.iter().map(|(_, x)| *x)).collect()
    };
    Table { columns, rows: outcome.shapes.iter().enumerate().map(row).collect(), switches: vec![], reasons: None }
}

/// Shapes as a JSON list of objects by coordinate.
pub(super) fn shapes(outcome: &Outcome) -> Option<(String, Value)> {
    let shape = |shape: &Vec<(String, f64)>| Value::Object(shape.iter().map(|(name, x)| (name.clone(), json_number(*x))).collect());
    (!outcome.shapes.is_empty()).then(|| ("shapes".into(), outcome.shapes.iter().map(shape).collect()))
}

/// The table of modes for stdout, with what the methods have spent and what there is to say.
pub(super) fn summary(outcome: &Outcome) -> String {
    let numbers = numbers(outcome);
    let mut lines: Vec<Vec<String>> = vec![vec!["mode".into()]];
    lines[0].extend(numbers.iter().map(|(name, unit, _)| if unit.is_empty() { (*name).into() } else { format!("{name} [{unit}]") }));
    lines[0].extend(["[1/s]".into(), "period [s]".into()]);
    for i in 0..outcome.shapes.len() {
        let mut line = vec![format!("{}", i + 1)];
        line.extend(numbers.iter().map(|(_, _, values)| digits(values.get(i).copied().unwrap_or(f64::NAN), 10)));
        let frequency = list(outcome, "frequencies").and_then(|f| f.get(i).copied()).unwrap_or(f64::NAN);
        let swings = frequency > 0.0;
        line.extend([frequency / TAU, TAU / frequency].map(|x| if swings { digits(x, 6) } else { "-".into() }));
        lines.push(line);
    }
    let widths: Vec<usize> = (0..lines[0].len()).map(|c| lines.iter().map(|l| l[c].chars().count()).max().unwrap_or(0)).collect();
    let mut out = String::new();
    for (i, line) in lines.iter().enumerate() {
        let cells: Vec<String> = line.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
        let shape = i.checked_sub(1).map_or_else(|| "shape".into(), |i| parts(&outcome.shapes[i]));
        out.push_str(&format!("  {}  {shape}\n", cells.join("  ")));
    }
    out + &methods(outcome) + &outcome.findings.iter().map(|f| format!("  {}: {}\n", f.code, f.message)).collect::<String>()
}

/// What each method has spent, and how far it is from the first.
fn methods(outcome: &Outcome) -> String {
    let Some(first) = list(outcome, "eigenvalues") else { return String::new() };
    let size = first.iter().fold(f64::MIN_POSITIVE, |m: f64, x| m.max(x.abs()));
    let mut told = Vec::new();
    for (method, spent) in [("jacobi", "sweeps"), ("power", "steps")] {
        if let (Some(own), Some([count])) = (list(outcome, &format!("eigenvalues_{method}")), list(outcome, &format!("{spent}_{method}"))) {
            let off = first.iter().zip(own).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / size;
            told.push(format!("{method} {count} {spent}, within {off:.0e} of the largest"));
        }
    }
    if told.is_empty() { String::new() } else { format!("  {}\n", told.join("; ")) }
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
