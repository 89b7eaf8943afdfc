//! Sweeps as tables, JSON and summaries.

use super::{certified, finding, significant};
use crate::cli::{linear, modes};
use grashof::model::{Model, Study};
use grashof::output;
use grashof::output::{Finding, Header, Report, Table, json_number, json_numbers};
use grashof::results::Outcome;
use grashof::studies::common::case::parameters;
use grashof::studies::sweep::Run;
use serde_json::Value;

/// One row a run: swept parameters, the one that was solved for, results, scalars, reason.
pub(in crate::cli) fn sweep_rows(model: &Model, study: &Study, runs: &[Run]) -> Table {
    let varied = study.sweep.iter().map(|s| s.parameter).chain(study.solve.iter().map(|s| s.parameter));
    let mut columns: Vec<Header> = varied.map(|p| &model.parameters[p]).map(|p| Header::new(p.name.clone(), p.dimension.si())).collect();
    let present = present(study, runs);
    columns.extend(present.iter().map(|&i| &study.results[i]).map(|r| Header::new(r.name.clone(), r.dimension.si())));
    columns.extend(study.scalars.iter().map(|s| Header::new(s.name.clone(), s.dimension.si())));
    let mut rows = Vec::new();
    let mut reasons = Vec::new();
    for run in runs {
        let mut row = run.at.clone();
        row.extend(study.solve.iter().map(|_| run.solved.as_ref().map_or(f64::NAN, |solved| solved.value)));
        match &run.result {
            Ok(outcome) => {
                row.extend(present.iter().map(|&i| outcome.results.get(i).copied().unwrap_or(f64::NAN)));
                row.extend(&outcome.scalars);
                reasons.push(outcome.stopped.clone().unwrap_or_default());
            }
            Err(failure) => {
                // a range that could not be begun is not a full turn
                row.extend(present.iter().map(|&i| if study.results[i].name == "turns_fully" { 0.0 } else { f64::NAN }));
                reasons.push(failure.reason());
            }
        }
        row.resize(columns.len(), f64::NAN);
        rows.push(row);
    }
    Table { columns, rows, switches: vec![], reasons: Some(reasons) }
}

/// Results of the kind, but for those that no run has although its kind gives lists, as the frequency of a mode that is not there.
fn present(study: &Study, runs: &[Run]) -> Vec<usize> {
    let outcomes: Vec<&Outcome> = runs.iter().filter_map(|r| r.result.as_ref().ok()).collect();
    let lists = outcomes.iter().any(|o| !o.lists.is_empty());
    let has = |i: usize| outcomes.iter().any(|o| o.results.get(i).is_some_and(|x| !x.is_nan()));
    (0..study.results.len()).filter(|&i| !lists || has(i)).collect()
}

/// The JSON of a sweep: lists over its runs.
pub(in crate::cli) fn sweep_json(model: &Model, study: &Study, runs: &[Run]) -> String {
    let table = sweep_rows(model, study, runs);
    let mut scalars: Vec<(String, Value)> =
        (0..table.columns.len()).map(|i| (table.columns[i].name.clone(), json_numbers(&table.column(i).collect::<Vec<f64>>()))).collect();
    scalars.extend(lists(runs));
    let mut findings = Vec::new();
    for (i, (run, reason)) in runs.iter().zip(table.reasons.iter().flatten()).enumerate() {
        let of = |message: &str| format!("run {} ({}): {message}", i + 1, label(model, study, &run.at));
        if !reason.is_empty() {
            findings.push(Finding { code: "run-stopped".into(), message: of(reason), path: study.place.clone() });
        }
        findings.extend(run.solved.iter().flat_map(|s| &s.findings).map(|f| Finding { message: of(&f.message), ..finding(f) }));
    }
    let parameters = parameters(model);
    let whole = runs.iter().any(|r| r.result.as_ref().is_ok_and(|o| o.stopped.is_none()));
    let solved = runs.iter().map(|r| r.solved.as_ref().map_or(Value::Null, certified));
    let solved = study.solve.iter().map(|_| ("solve".to_string(), Value::Array(solved.clone().collect())));
    output::write_json(&Report {
        study: study.name.clone(),
        status: if whole { "done" } else { "failed" }.into(),
        parameters: model.parameters.iter().zip(parameters).map(|(p, x)| (p.name.clone(), x)).collect(),
        scalars,
        extrema: vec![],
        certificate: std::iter::once(("runs".into(), json_number(runs.len() as f64))).chain(solved).collect(),
        findings,
    })
}

/// What the kind gives beside numbers, as lists: one entry of each run, `null` where there is none.
fn lists(runs: &[Run]) -> Vec<(String, Value)> {
    let of = |run: &Run| -> Vec<(String, Value)> {
        let Ok(outcome) = &run.result else { return Vec::new() };
        let lists = outcome.lists.iter().map(|list| (list.name.clone(), json_numbers(&list.values)));
        lists.chain(modes::shapes(outcome)).chain(linear::json(outcome)).collect()
    };
    let all: Vec<Vec<(String, Value)>> = runs.iter().map(of).collect();
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in all.iter().flatten() {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let entry =
        |own: &Vec<(String, Value)>, name: &str| own.iter().find(|(known, _)| known == name).map_or(Value::Null, |(_, v)| v.clone());
    names.iter().map(|name| ((*name).to_string(), all.iter().map(|own| entry(own, name)).collect())).collect()
}

/// The swept values of a run, as a label: `l3 = 0.3 m`.
pub(in crate::cli) fn label(model: &Model, study: &Study, at: &[f64]) -> String {
    study
        .sweep
        .iter()
        .zip(at)
        .map(|(s, x)| {
            let p = &model.parameters[s.parameter];
            format!("{} = {} {}", p.name, output::number(*x), p.dimension.si()).trim_end().to_string()
        })
        .collect::<Vec<_>>()
        .join(", ")
}

/// A sweep's table for stdout, columns aligned.
pub(in crate::cli) fn sweep_summary(table: &Table) -> String {
    let head = table.columns.iter().map(|c| if c.unit.is_empty() { c.name.clone() } else { format!("{} [{}]", c.name, c.unit) });
    let mut lines: Vec<Vec<String>> = vec![head.collect()];
    for row in &table.rows {
        lines.push(row.iter().map(|x| if x.is_nan() { "-".into() } else { significant(*x) }).collect());
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
