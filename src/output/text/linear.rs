//! A linearised motion in a few lines.

use crate::results::Results;

/// States, inputs, outputs and poles.
pub(super) fn summary(results: &Results) -> String {
    let Some(system) = &results.linear else { return String::new() };
    let mut out = String::new();
    for (name, list) in system.names().into_iter().skip(1) {
        out.push_str(&format!("  {name} ({}): {}\n", list.len(), list.join(", ")));
    }
    let list = |name: &str| results.list(name).unwrap_or_default().iter().copied();
    let poles: Vec<String> = list("poles_real")
        .zip(list("poles_imaginary"))
        .filter(|(_, im)| *im >= 0.0)
        .map(|(re, im)| ((re * 1e6).round() / 1e6 + 0.0, im))
        .map(|(re, im)| if im > 0.0 { format!("{re:.6} ± {im:.6} i") } else { format!("{re:.6}") })
        .collect();
    out.push_str(&format!("  poles [1/s]: {}\n", poles.join(", ")));
    out + &results.findings.iter().map(|f| format!("  {}: {}\n", f.code, f.message)).collect::<String>()
}
