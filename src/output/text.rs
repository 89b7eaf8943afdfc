//! What a study has come to, for the terminal.

use super::scalars::{self, ten_digits};
use crate::results::{By, Finding, Results, Scalar, number};

mod linear;
pub(super) mod modes;
mod runs;

/// Findings of a motion that are shown.
const FINDINGS: usize = 5;
/// Events that are shown.
const EVENTS: usize = 6;

/// The summary of a study: what was found, how far it is to be trusted, its scalars; of a sweep a line for each run.
pub fn summary(results: &Results) -> String {
    if results.table.reasons.is_some() {
        let table = if results.statistics.is_empty() { runs::summary(&results.table) } else { runs::distributed(results) };
        return variants(results) + &table + &notes(results);
    }
    let of_kind = match results.kind.as_str() {
        "statics" => equilibria(results),
        "linearize" => linear::summary(results),
        "modes" => modes::summary(results),
        _ => range(results) + &march(results) + &notes(results),
    };
    // the results of modes stand in their table
    let listed = |s: &&Scalar| results.kind != "modes" || s.by != By::Kind;
    let listed: Vec<&Scalar> = results.scalars.iter().filter(listed).collect();
    variants(results) + &solution(results) + &of_kind + &scalars::table(&listed)
}

/// Which variants of the model it is of; empty for the model itself.
fn variants(results: &Results) -> String {
    match &results.variants[..] {
        [] => String::new(),
        [one] => format!("  variant: {one}\n"),
        several => format!("  variants: {}\n", several.join(", ")),
    }
}

/// `solved: I_f = 279.25 kg m^2 (12 runs), delta = 0.01`; empty where nothing is solved.
fn solution(results: &Results) -> String {
    let Some(solved) = &results.solution else { return String::new() };
    let (value, unit) = solved.parameter.shown();
    let value = format!("{} {unit}", ten_digits(value));
    let of = results.scalars.iter().find(|scalar| scalar.name == solved.of);
    let found = of.map_or_else(
        || ten_digits(solved.found),
        |scalar| {
            let scalar = Scalar { value: solved.found, ..scalar.clone() };
            let (value, unit) = scalar.shown();
            format!("{} {unit}", ten_digits(value))
        },
    );
    format!("  solved: {} = {} ({} runs), {} = {}\n", solved.parameter.name, value.trim_end(), solved.runs, solved.of, found.trim_end())
}

/// How many rows there are, and over what.
fn range(results: &Results) -> String {
    let places = &results.independent.values;
    let switches = match results.table.switches.len() {
        0 => String::new(),
        1 => ", 1 switch".into(),
        n => format!(", {n} switches"),
    };
    if results.independent.name.is_empty() {
        return String::new();
    }
    let (unit, size) = results.independent.shown();
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let end = |x: Option<&f64>| place(x.map(|x| x / size).as_ref());
    let (from, to) = (end(places.first()), end(places.last()));
    let count = results.table.selected_from.unwrap_or(places.len());
    format!("  {count} rows over {} from {from} to {to}{unit}{switches}\n", results.independent.name)
}

fn place(x: Option<&f64>) -> String {
    x.map_or_else(String::new, |x| number((x * 1e6).round() / 1e6 + 0.0))
}

/// Where a mechanism rests, and where else it could.
fn equilibria(results: &Results) -> String {
    let line = |code: &str| match code {
        "equilibrium" => "at rest",
        "further-equilibrium" => "also in balance",
        _ => "note",
    };
    results.findings.iter().map(|f| format!("  {}: {}\n", line(&f.code), f.message)).collect()
}

/// What a reader should know of a motion, or of the runs of a sweep, in a line each, warnings first; all of it is in the JSON.
fn notes(results: &Results) -> String {
    // why runs are not whole stands in their lines
    let mut findings: Vec<&Finding> = results.findings.iter().filter(|f| f.code != "run-stopped").collect();
    findings.sort_by_key(|f| !f.is_warning());
    let word = |f: &Finding| if f.is_warning() { "warning" } else { "note" };
    let shown = findings.iter().take(FINDINGS).map(|f| format!("  {}: {}\n", word(f), f.message)).collect::<String>();
    match findings.len().saturating_sub(FINDINGS) {
        0 => shown,
        1 => shown + "  note: one more finding is in the JSON file\n",
        more => shown + &format!("  note: {more} more findings are in the JSON file\n"),
    }
}

/// A work with its sign: six decimals, or digits behind a point where it is very small or large.
fn signed(x: f64) -> String {
    if (1e-3..1e7).contains(&x.abs()) { format!("{x:+.6}") } else { format!("{x:+.6e}") }
}

/// The certificate of a motion in time in three lines: energy, constraints, work.
fn march(results: &Results) -> String {
    let Some(m) = &results.certificate.march else { return String::new() };
    let (c, k) = (&results.certificate, &m.counts);
    let works = m.works().into_iter().filter(|(_, x)| x.abs() > 1e-12 * m.energy_scale);
    let works: Vec<String> = works.map(|(name, x)| format!("{} {} J", name.trim_start_matches("work_"), signed(x))).collect();
    let works = if works.is_empty() { String::new() } else { format!("; {}", works.join(", ")) };
    let relative = if m.energy_scale > 0.0 { m.energy_drift / m.energy_scale } else { 0.0 };
    let control = m.tolerance.map_or("fixed step".to_string(), |t| format!("tolerance {t:.0e}"));
    let bridges = if k.bridges > 0 { format!(", {} bridges over singular positions", k.bridges) } else { String::new() };
    let over = if k.stepped_over > 0 { format!(", {} switches stepped over", k.stepped_over) } else { String::new() };
    let gap = if m.widest_gap > 0.0 {
        format!("  conditions: resolved, with looks at most {:.1e} s apart\n", m.widest_gap)
    } else {
        String::new()
    };
    format!(
        "  energy: balanced to {:.1e} J, {relative:.1e} of {:.3e} J{works}\n  constraints: positions {:.1e}, velocities {:.1e}\n  work: {}, {control}, {} steps ({} rejected), {} evaluations, {} factorisations, {} events{bridges}{over}\n{gap}",
        m.energy_drift, m.energy_scale, c.constraint, m.velocity, m.schemes, k.steps, k.rejected, k.evaluations, k.factorisations, k.events
    ) + &happened(results)
}

/// The first events of the model, in a line.
fn happened(results: &Results) -> String {
    if results.events.is_empty() {
        return String::new();
    }
    let size = results.independent.shown().1;
    let shown: Vec<String> = results.events.iter().take(EVENTS).map(|e| format!("{} at {}", e.name, place(Some(&(e.at / size))))).collect();
    let more = results.events.len().saturating_sub(EVENTS);
    let more = if more > 0 { format!(", and {more} more") } else { String::new() };
    format!("  happened: {}{more}\n", shown.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variants_are_named() {
        let told = |names: &[&str]| summary(&Results { variants: names.iter().map(|name| (*name).into()).collect(), ..Results::default() });
        assert!(!told(&[]).contains("variant"));
        assert!(told(&["motor"]).starts_with("  variant: motor\n") && told(&["motor", "soft"]).starts_with("  variants: motor, soft\n"));
    }

    #[test]
    fn warnings_come_first() {
        let finding = |code: &'static str| Finding { code: code.into(), message: code.into(), path: String::new() };
        let mut findings: Vec<Finding> = (0..FINDINGS).map(|_| finding("undefined-scalar")).collect();
        findings.extend([finding("run-stopped"), finding("energy")]);
        let told = notes(&Results { findings, ..Results::default() });
        let lines: Vec<&str> = told.lines().collect();
        assert_eq!(lines.len(), FINDINGS + 1);
        assert_eq!(
            [lines[0], lines[1], lines[FINDINGS]],
            ["  warning: energy", "  note: undefined-scalar", "  note: one more finding is in the JSON file"]
        );
    }
}
