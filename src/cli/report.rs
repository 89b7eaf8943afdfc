//! Outcomes as tables, JSON and summaries.

mod sweep;

pub(super) use sweep::{label, sweep_json, sweep_rows, sweep_summary};

use super::{linear, modes};
use grashof::model::{Kind, Model, Study, WORKS};
use grashof::numerics::extremum::Extremum;
use grashof::output;
use grashof::output::{Extrema, Extreme, Finding, Header, Report, Scalar, Table, json_number, json_numbers};
use grashof::results;
use grashof::results::Outcome;
use grashof::studies::solve::Solved;
use serde_json::Value;

/// The rows of one run, in the columns of the study.
pub(super) fn rows(study: &Study, outcome: &Outcome) -> Table {
    if let Kind::Modes(_) = study.kind {
        return modes::rows(outcome);
    }
    if let Some(table) = linear::rows(outcome) {
        return table;
    }
    let n = study.columns.len();
    Table {
        columns: study.columns.iter().map(|c| Header::new(c.name.clone(), c.dimension.si())).collect(),
        rows: outcome.rows.iter().map(|r| r[..n].to_vec()).collect(),
        switches: outcome.switches.clone(),
        reasons: None,
    }
}

/// Names, units and values of the results of the kind and of the scalars.
fn scalars(study: &Study, outcome: &Outcome) -> Vec<Scalar> {
    // a kind may name results that this mechanism does not have, as the frequency of a mode
    let present = study.results.iter().zip(&outcome.results).filter(|(_, value)| outcome.lists.is_empty() || !value.is_nan());
    let results = present.map(|(r, value)| Scalar { name: r.name.clone(), value: *value, unit: r.dimension.si() });
    let own =
        study.scalars.iter().zip(&outcome.scalars).map(|(s, value)| Scalar { name: s.name.clone(), value: *value, unit: s.dimension.si() });
    let taken = study.take.iter().map(|t| Scalar { name: t.name.clone(), value: t.value, unit: t.dimension.si() });
    taken.chain(results).chain(own).collect()
}

/// The table of scalars for stdout, or the number of rows where there is none.
pub(super) fn summary(study: &Study, outcome: &Outcome) -> String {
    let scalars = scalars(study, outcome);
    match study.kind {
        Kind::Statics => return super::statics::summary(outcome) + &output::summary(&scalars),
        Kind::Linearize(_) => return linear::summary(outcome) + &output::summary(&scalars),
        Kind::Modes(_) => {
            // its results stand in the table of modes
            let own: Vec<Scalar> = scalars.into_iter().filter(|s| study.results.iter().all(|r| r.name != s.name)).collect();
            return modes::summary(outcome) + &output::summary(&own);
        }
        _ => {}
    }
    let head = format!(
        "  {} rows over {} from {} to {}{}\n",
        outcome.rows.len(),
        outcome.independent,
        shown(outcome.places.first()),
        shown(outcome.places.last()),
        match outcome.switches.len() {
            0 => String::new(),
            1 => ", 1 switch".into(),
            n => format!(", {n} switches"),
        }
    );
    head + &march(outcome) + &notes(study, outcome) + &output::summary(&scalars)
}

/// What a reader should know of a motion, in a line each; all of it is in the JSON.
fn notes(study: &Study, outcome: &Outcome) -> String {
    const SHOWN: usize = 5;
    if !matches!(study.kind, Kind::Dynamics(_) | Kind::Kinematics(_) | Kind::Inverse(_)) {
        return String::new();
    }
    let shown = outcome.findings.iter().take(SHOWN).map(|f| format!("  note: {}\n", f.message)).collect::<String>();
    match outcome.findings.len().saturating_sub(SHOWN) {
        0 => shown,
        more => shown + &format!("  note: {more} more findings stand in `{}.json`\n", study.name),
    }
}

fn shown(x: Option<&f64>) -> String {
    x.map_or_else(String::new, |x| output::number((x * 1e6).round() / 1e6 + 0.0))
}

/// The JSON of one run.
pub(super) fn json(study: &Study, outcome: &Outcome, solved: Option<&Solved>) -> String {
    let extreme = |e: Extremum| Some(Extreme { value: e.value, at: e.at });
    let extrema = study
        .columns
        .iter()
        .zip(&outcome.extremes)
        .map(|(c, e)| (c.name.clone(), e.map_or_else(Extrema::default, |e| Extrema { min: extreme(e.min), max: extreme(e.max) })))
        .collect();
    let mut findings: Vec<Finding> = outcome.findings.iter().chain(solved.iter().flat_map(|s| &s.findings)).map(finding).collect();
    if let Some(reason) = &outcome.stopped {
        findings.insert(0, Finding { code: "stopped".into(), message: reason.clone(), path: study.place.clone() });
    }
    for e in outcome.expectations.iter().filter(|e| !e.met) {
        let message = format!("{} is {}, not {} within {}", e.text, e.found, e.wanted, e.tolerance);
        findings.push(Finding { code: "expectation".into(), message, path: e.place.clone() });
    }
    output::write_json(&Report {
        study: study.name.clone(),
        status: if outcome.stopped.is_some() { "failed" } else { "done" }.into(),
        parameters: outcome.parameters.clone(),
        scalars: (scalars(study, outcome).into_iter().map(|s| (s.name, json_number(s.value))))
            .chain(outcome.lists.iter().map(|list| (list.name.clone(), json_numbers(&list.values))))
            .chain(modes::shapes(outcome))
            .chain(linear::json(outcome))
            .collect(),
        extrema,
        certificate: certificate(outcome).into_iter().chain(solved.map(|s| ("solve".into(), certified(s)))).collect(),
        findings,
    })
}

fn finding(f: &results::Finding) -> Finding {
    Finding { code: f.code.into(), message: f.message.clone(), path: f.path.clone() }
}

/// `solved: I_f = 279.25 kg m^2 (12 runs), delta = 0.01`; empty where nothing is solved.
pub(super) fn solution(model: &Model, study: &Study, solved: Option<&Solved>) -> String {
    let (Some(solved), Some(solve)) = (solved, &study.solve) else { return String::new() };
    let p = &model.parameters[solve.parameter];
    let value = format!("{} {}", significant(solved.value), p.dimension.si());
    format!("  solved: {} = {} ({} runs), {} = {}\n", p.name, value.trim_end(), solved.runs, solve.target.0, significant(solved.found))
}

/// What certifies a solution.
fn certified(solved: &Solved) -> Value {
    serde_json::json!({
        "runs": solved.runs,
        "bracket": json_numbers(&solved.bracket),
        "target": json_number(solved.target),
        "residual": json_number(solved.found - solved.target),
    })
}

fn certificate(outcome: &Outcome) -> Vec<(String, Value)> {
    let c = &outcome.certificate;
    let number = |name: &str, x: f64| (name.to_string(), json_number(x));
    let count = |name: &str, n: usize| (name.to_string(), json_number(n as f64));
    let mut all = vec![count("rows", c.evaluations), count("switches", c.switches), number("constraint_residual", c.constraint)];
    if let Some(r) = &c.resolved {
        all.extend([number("resolved_to", r.width), count("unresolved", r.open), count("looks", r.evaluations)]);
    }
    let Some(m) = &c.march else {
        all.push(number("power_balance", c.power_balance));
        return all;
    };
    all.push(number("velocity_residual", m.velocity));
    all.push(("integrator".into(), Value::String(m.schemes.clone())));
    let happened = outcome.events.iter().map(|e| serde_json::json!({ "name": e.name, "at": json_number(e.at) }));
    all.push(("happened".into(), Value::Array(happened.collect())));
    all.extend([number("energy_drift", m.energy_drift), number("energy_scale", m.energy_scale)]);
    all.extend(WORKS.iter().zip(m.works()).map(|(name, work)| number(name, work)));
    all.extend([
        number("widest_gap", m.widest_gap),
        count("steps", m.counts.steps),
        count("rejected", m.counts.rejected),
        count("evaluations", m.counts.evaluations),
        count("tangents", m.counts.tangents),
        count("factorisations", m.counts.factorisations),
        count("events", m.counts.events),
        count("bridges", m.counts.bridges),
        count("stepped_over", m.counts.stepped_over),
        count("unresolved", m.counts.unresolved),
    ]);
    all
}

/// The certificate of a motion in time in three lines: energy, constraints, work.
fn march(outcome: &Outcome) -> String {
    let Some(m) = &outcome.certificate.march else { return String::new() };
    let (c, k) = (&outcome.certificate, &m.counts);
    let works = WORKS.iter().zip(m.works()).filter(|(_, x)| x.abs() > 1e-12 * m.energy_scale);
    let works: Vec<String> = works.map(|(name, x)| format!("{} {x:+.6} J", name.trim_start_matches("work_"))).collect();
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
    ) + &happened(outcome)
}

/// The first events of the model, in a line.
fn happened(outcome: &Outcome) -> String {
    const SHOWN: usize = 6;
    if outcome.events.is_empty() {
        return String::new();
    }
    let shown: Vec<String> = outcome.events.iter().take(SHOWN).map(|e| format!("{} at {}", e.name, shown(Some(&e.at)))).collect();
    let more = outcome.events.len().saturating_sub(SHOWN);
    let more = if more > 0 { format!(", and {more} more") } else { String::new() };
    format!("  happened: {}{more}\n", shown.join(", "))
}

/// Ten significant digits, without trailing zeros.
pub(super) fn significant(x: f64) -> String {
    let rounded: f64 = format!("{x:.9e}").parse().unwrap_or(x);
    output::number(rounded)
}
