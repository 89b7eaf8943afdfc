//! Modes in a table, with what the methods have spent and what there is to say.

use crate::results::{Column, Results, number};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// Coordinates that count in the printed shape, of the largest one.
const PART: f64 = 0.1;
/// Coordinates that are printed of a shape.
const PARTS: usize = 4;
/// Sine of a phase that is rounding.
const REAL: f64 = 1e-6;
/// Parts of a shape, of the largest one, that are rounding.
const ROUND_OFF: f64 = 1e-9;
/// Columns of the table that are numbers of a mode.
const NUMBERS: [&str; 5] = ["eigenvalue_real", "eigenvalue_imaginary", "eigenvalue", "frequency", "damping_ratio"];

/// The table of modes.
pub(super) fn summary(results: &Results) -> String {
    let numbers: Vec<&Column> = results.table.columns.iter().filter(|c| NUMBERS.contains(&c.name.as_str())).collect();
    let mut lines: Vec<Vec<String>> = vec![vec!["mode".into()]];
    lines[0].extend(numbers.iter().map(|column| column.heading()));
    lines[0].extend(["cycles [1/s]".into(), "period [s]".into()]);
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

/// The coordinates that move most in a shape, the largest first.
fn parts(shape: &[(String, f64)]) -> String {
    let of = told(shape);
    let most = of.iter().take(PARTS).take_while(|part| part.size >= PART);
    most.map(|part| part.text.clone()).collect::<Vec<_>>().join(", ")
}

/// A coordinate in a shape.
struct Part {
    /// Beside the largest one, without sign.
    size: f64,
    text: String,
}

/// All coordinates of a shape in words.
pub(in crate::output) fn words(shape: &[(String, f64)]) -> Vec<String> {
    told(shape).into_iter().map(|part| part.text).collect()
}

/// The coordinates of a shape, the largest first, as parts of it: with a sign where all that count are in phase or opposite, else with the
/// angle, in degrees, by which each is ahead of the largest.
fn told(shape: &[(String, f64)]) -> Vec<Part> {
    let mut parts: Vec<&(String, f64)> = shape.iter().filter(|(name, _)| !name.ends_with(".phase")).collect();
    parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let Some((first, largest)) = parts.first().copied() else { return Vec::new() };
    let largest = if *largest == 0.0 { 1.0 } else { *largest };
    let phases: HashMap<&str, f64> = shape.iter().filter_map(|(name, phase)| Some((name.strip_suffix(".phase")?, *phase))).collect();
    let phase = |of: &str| phases.get(of).copied().unwrap_or(0.0);
    let shown: Vec<(&str, f64, f64)> = parts.iter().map(|(name, x)| (name.as_str(), x / largest, phase(name) - phase(first))).collect();
    let real = shown.iter().all(|(_, x, ahead)| x.abs() < PART || ahead.sin().abs() < REAL);
    let in_line = |x: f64, ahead: f64| real && (x.abs() < ROUND_OFF || ahead.sin().abs() < REAL);
    let text = |i: usize, name: &str, x: f64, ahead: f64| match in_line(x, ahead) {
        true => format!("{name} {}", digits(x * ahead.cos().signum(), 3)),
        false if i == 0 || x == 0.0 => format!("{name} {}", digits(x, 3)),
        false => format!("{name} {} at {} deg", digits(x, 3), digits(degrees(ahead), 3)),
    };
    shown.into_iter().enumerate().map(|(i, (name, x, ahead))| Part { size: x.abs(), text: text(i, name, x, ahead) }).collect()
}

/// An angle from −180° (not itself) to 180°; round-off of zero is zero.
fn degrees(angle: f64) -> f64 {
    let degrees = (PI - (PI - angle).rem_euclid(TAU)).to_degrees();
    if degrees.abs() < REAL.to_degrees() { 0.0 } else { degrees }
}

/// Significant digits, without trailing zeros; `-` for what is no number.
fn digits(x: f64, count: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", count - 1).parse().unwrap_or(x);
    if rounded.is_finite() { number(rounded) } else { "-".into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn shape(of: &[(&str, f64, Option<f64>)]) -> Vec<(String, f64)> {
        let own = |(name, x, phase): &(&str, f64, Option<f64>)| {
            let phase = phase.map(|phase| (format!("{name}.phase"), phase));
            [Some(((*name).to_owned(), *x)), phase].into_iter().flatten().collect::<Vec<_>>()
        };
        of.iter().flat_map(own).collect()
    }

    #[test]
    fn parts_of_a_shape_have_their_sign_or_their_phase() {
        let undamped = [("a", 0.5, None), ("b", -1.0, None), ("c", 0.01, None)];
        assert_eq!(parts(&shape(&undamped)), "b 1, a -0.5");
        // in phase or opposite, whatever the phase of the largest
        let real = [("a", 0.5, Some(PI - 0.3)), ("b", 1.0, Some(-0.3)), ("c", 0.25, Some(TAU - 0.3))];
        assert_eq!(parts(&shape(&real)), "b 1, a -0.5, c 0.25");
        let damped = [("a", 0.5, Some(FRAC_PI_2)), ("b", 1.0, Some(0.0)), ("c", 0.25, Some(-3.0)), ("d", 0.2, Some(PI))];
        assert_eq!(parts(&shape(&damped)), "b 1, a 0.5 at 90 deg, c 0.25 at -172 deg, d 0.2 at 180 deg");
        let beyond = [("a", 0.5, Some(3.0)), ("b", 1.0, Some(-3.0))];
        assert_eq!(parts(&shape(&beyond)), "b 1, a 0.5 at -16.2 deg");
        // what is told of all coordinates has the same scale and phases
        assert_eq!(words(&shape(&damped)), ["b 1", "a 0.5 at 90 deg", "c 0.25 at -172 deg", "d 0.2 at 180 deg"]);
        assert_eq!(words(&shape(&undamped)), ["b 1", "a -0.5", "c -0.01"]);
        let little = [("a", 0.05, Some(1.0)), ("b", 1.0, Some(0.0)), ("c", 1e-12, Some(1.0))];
        assert_eq!(words(&shape(&little)), ["b 1", "a 0.05 at 57.3 deg", "c 1e-12"]);
        assert_eq!(words(&shape(&[("a", 0.0, None)])), ["a 0"]);
        let rounded = [("a", 0.5, Some(-4.4e-16)), ("b", 1.0, Some(0.0)), ("c", 0.3, Some(1.0))];
        assert_eq!(parts(&shape(&rounded)), "b 1, a 0.5 at 0 deg, c 0.3 at 57.3 deg");
    }
}
