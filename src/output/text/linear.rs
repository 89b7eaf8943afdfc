//! A linearised motion in a few lines.

use crate::results::{Results, six_digits};

/// States, inputs, outputs and poles.
pub(super) fn summary(results: &Results) -> String {
    let Some(system) = &results.linear else { return String::new() };
    let mut out = String::new();
    for (name, list) in system.names().into_iter().skip(1) {
        out.push_str(&format!("  {name} ({}): {}\n", list.len(), list.join(", ")));
    }
    let list = |name: &str| results.list(name).unwrap_or_default().iter().copied();
    let poles: Vec<(f64, f64)> = list("poles_real").zip(list("poles_imaginary")).collect();
    let fastest = poles.iter().fold(0.0, |m, (re, im)| f64::max(m, re.hypot(*im)));
    let poles: Vec<String> = poles.into_iter().filter(|(_, im)| *im >= 0.0).map(|pole| shown(pole, fastest)).collect();
    out.push_str(&format!("  poles [1/s]: {}\n", poles.join(", ")));
    out + &results.findings.iter().map(|f| format!("  {}: {}\n", f.code, f.message)).collect::<String>()
}

/// A pole to six digits, without parts that are round-off beside the other or beside the fastest pole.
fn shown((re, im): (f64, f64), fastest: f64) -> String {
    let part = |x: f64, other: f64| {
        let beside = f64::max(1e-9 * other.abs(), 1e-14 * fastest);
        if x.abs() < beside { 0.0 } else { x }
    };
    let (re, im) = (part(re, im), part(im, re));
    if im > 0.0 { format!("{} ± {} i", six_digits(re), six_digits(im)) } else { six_digits(re) }
}
