//! Matrices of a linearised motion: as JSON, as files, and in a few lines.

use grashof::model::{Kind, Study};
use grashof::output::{Header, MatValue, Table, json_numbers, write_csv, write_mat};
use grashof::results::{LinearSystem, Outcome};
use serde_json::{Map, Value};

/// Names of the columns of a matrix.
fn columns<'a>(system: &'a LinearSystem, matrix: &str) -> &'a [String] {
    match matrix {
        "A" | "C" => &system.states,
        "B" | "D" => &system.inputs,
        _ => &system.coordinates,
    }
}

/// What `values` are of.
const VALUES: [&str; 4] = ["x", "rates", "u", "y"];

/// Names, values and matrices as an object.
pub(super) fn json(outcome: &Outcome) -> Option<(String, Value)> {
    let system = outcome.linear.as_ref()?;
    let names = |names: &[String]| Value::from(names.to_vec());
    let mut object = Map::new();
    for (name, list) in lists(system) {
        object.insert(name.into(), names(list));
    }
    for (name, values) in VALUES.iter().zip(&system.values) {
        object.insert((*name).into(), json_numbers(values));
    }
    for (name, rows) in &system.matrices {
        object.insert(name.clone(), rows.iter().map(|row| json_numbers(row)).collect());
    }
    Some(("linear".into(), Value::Object(object)))
}

fn lists(system: &LinearSystem) -> [(&'static str, &[String]); 4] {
    [("coordinates", &system.coordinates), ("states", &system.states), ("inputs", &system.inputs), ("outputs", &system.outputs)]
}

/// The files that a study asks for beside its CSV and JSON.
pub(super) fn files(study: &Study, outcome: &Outcome) -> Vec<(String, Vec<u8>)> {
    let (Kind::Linearize(asked), Some(system)) = (&study.kind, &outcome.linear) else { return Vec::new() };
    let mut files = Vec::new();
    if asked.csv {
        for (name, rows) in &system.matrices {
            let head = columns(system, name).iter().map(|column| Header::new(column.clone(), "")).collect();
            let table = Table { columns: head, rows: rows.clone(), switches: vec![], reasons: None };
            files.push((format!("{}-{name}.csv", study.name), write_csv(&table).into_bytes()));
        }
    }
    if asked.mat {
        let matrices =
            system.matrices.iter().map(|(name, rows)| (name.clone(), MatValue::Matrix(columns(system, name).len(), rows.clone())));
        let values = VALUES.iter().zip(&system.values);
        let values = values.map(|(name, values)| ((*name).to_string(), MatValue::Matrix(1, values.iter().map(|x| vec![*x]).collect())));
        let names = lists(system).into_iter().map(|(name, list)| (name.to_string(), MatValue::Text(list.to_vec())));
        files.push((format!("{}.mat", study.name), write_mat(&matrices.chain(values).chain(names).collect::<Vec<_>>())));
    }
    files
}

/// The outputs in the state, one row.
pub(super) fn rows(outcome: &Outcome) -> Option<Table> {
    let system = outcome.linear.as_ref()?;
    let columns = system.outputs.iter().map(|name| Header::new(name.clone(), "")).collect();
    Some(Table { columns, rows: vec![system.values[3].clone()], switches: vec![], reasons: None })
}

/// States, inputs, outputs and poles for stdout.
pub(super) fn summary(outcome: &Outcome) -> String {
    let Some(system) = &outcome.linear else { return String::new() };
    let mut out = String::new();
    for (name, list) in lists(system).into_iter().skip(1) {
        out.push_str(&format!("  {name} ({}): {}\n", list.len(), list.join(", ")));
    }
    let list = |name: &str| outcome.lists.iter().find(|l| l.name == name).map(|l| l.values.clone()).unwrap_or_default();
    let poles: Vec<String> = list("poles_real")
        .iter()
        .zip(list("poles_imaginary"))
        .filter(|(_, im)| *im >= 0.0)
        .map(|(re, im)| ((re * 1e6).round() / 1e6 + 0.0, im))
        .map(|(re, im)| if im > 0.0 { format!("{re:.6} ± {im:.6} i") } else { format!("{re:.6}") })
        .collect();
    out.push_str(&format!("  poles [1/s]: {}\n", poles.join(", ")));
    out + &outcome.findings.iter().map(|f| format!("  {}: {}\n", f.code, f.message)).collect::<String>()
}
