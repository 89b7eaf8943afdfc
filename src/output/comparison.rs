//! What a comparison of integrators has come to: as CSV, figure, table and JSON.

use super::{Axis, Curve, Figure, Scale, json_number, number};
use crate::results::{Compared, ComparedRun};
use serde_json::{Value, json};

const NAMES: [&str; 9] =
    ["time", "evaluations", "steps", "rejected", "factorisations", "error", "energy_drift", "constraint_drift", "velocity_drift"];

/// The numbers of a row in the order of `NAMES`.
fn numbers(row: &ComparedRun) -> [f64; 9] {
    let [steps, rejected, evaluations, factorisations] = row.counts;
    [row.time, evaluations, steps, rejected, factorisations, row.error, row.energy, row.residuals[0], row.residuals[1]]
}

/// The rows as CSV.
pub fn csv(compared: &Compared) -> String {
    let mut text = format!("integrator,{},{},reason\n", compared.size(), NAMES.join(","));
    for row in &compared.rows {
        let values: Vec<String> = numbers(row).iter().map(|x| number(*x)).collect();
        let reason =
            if row.reason.contains([',', '"', '\n']) { format!("\"{}\"", row.reason.replace('"', "\"\"")) } else { row.reason.clone() };
        text.push_str(&format!("{},{},{},{reason}\n", row.integrator, number(row.size), values.join(",")));
    }
    text
}

/// Time and evaluations over the error: one panel above the other, one line for each integrator.
pub fn figure(compared: &Compared) -> Figure {
    let mut curves = Vec::new();
    for (unit, of) in [("s", 0), ("", 1)] {
        for name in compared.integrators() {
            let rows = compared.rows.iter().filter(|r| r.integrator == name && r.error > 0.0);
            let points = rows.map(|r| (r.error, numbers(r)[of])).collect();
            curves.push(Curve { label: name.into(), unit: Some(unit.into()), points, ..Curve::default() });
        }
    }
    let axis = |label: &str| Axis { label: label.into(), scale: Scale::Log, ..Axis::default() };
    let quantities = vec![("s".into(), "time".into()), (String::new(), "evaluations".into())];
    // one curve has no legend
    let by = match compared.integrators()[..] {
        [one] => format!(" by {one}"),
        _ => String::new(),
    };
    let title = format!("{}{by}: work over error at the end", compared.study);
    Figure { title, x: axis("error"), y: axis(""), curves, quantities, ..Figure::default() }
}

/// The table for stdout, columns aligned.
pub fn table(compared: &Compared) -> String {
    let heads = ["integrator", compared.size(), "time [s]", "evaluations", "steps", "rejected", "factorisations", "error"];
    let heads = heads.into_iter().chain(["energy [J]", "positions", "velocities"]);
    let mut lines: Vec<Vec<String>> = vec![heads.map(String::from).collect()];
    for row in &compared.rows {
        let shown = |(i, x): (usize, &f64)| match i {
            _ if x.is_nan() => "-".into(),
            1..=4 => number(*x),
            0 => format!("{x:.2e}"),
            _ => format!("{x:.1e}"),
        };
        let values = numbers(row);
        lines.push(
            [row.integrator.to_string(), format!("{:e}", row.size)].into_iter().chain(values.iter().enumerate().map(shown)).collect(),
        );
    }
    let width = |i: usize| lines.iter().map(|l| l[i].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..lines[0].len()).map(width).collect();
    let mut text = format!("{}\n  {}\n", compared.study, compared.sentence());
    for (i, line) in lines.iter().enumerate() {
        let (first, rest) = (&line[0], &line[1..]);
        text.push_str(&format!("  {first:<width$}", width = widths[0]));
        rest.iter().zip(&widths[1..]).for_each(|(cell, width)| text.push_str(&format!(" {cell:>width$}")));
        let reason = i.checked_sub(1).map_or("", |i| &compared.rows[i].reason);
        text.push_str(if reason.is_empty() { "" } else { "  " });
        text.push_str(reason);
        text.push('\n');
    }
    text
}

/// The same as JSON.
pub fn json(compared: &Compared) -> String {
    let rows = compared.rows.iter().map(|row| {
        let mut object = serde_json::Map::new();
        object.insert("integrator".into(), row.integrator.clone().into());
        object.insert(compared.size().into(), json_number(row.size));
        object.extend(NAMES.iter().zip(numbers(row)).map(|(name, x)| ((*name).to_string(), json_number(x))));
        object.insert("reason".into(), row.reason.clone().into());
        Value::Object(object)
    });
    let references: Vec<Value> =
        compared.references.of.iter().map(|(by, tolerance)| json!({ "integrator": by, "tolerance": json_number(*tolerance) })).collect();
    let all = json!({
        "study": compared.study,
        "references": references,
        "references_agree": compared.references.agree.map_or(Value::Null, json_number),
        "runs": rows.collect::<Vec<_>>(),
    });
    serde_json::to_string_pretty(&all).unwrap_or_default()
}
