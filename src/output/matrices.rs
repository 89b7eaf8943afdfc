//! The files of a linearised motion beside its CSV and JSON: a matrix in each CSV, or all in one MAT file.

use super::{MatValue, write_csv, write_mat};
use crate::results::{Column, LinearSystem, Results, Table};

/// Ends of the names of the files that the study asks for, and what they hold.
pub fn matrices(results: &Results) -> Vec<(String, Vec<u8>)> {
    let Some(system) = &results.linear else { return Vec::new() };
    let mut files = Vec::new();
    if system.csv {
        files.extend(
            system.matrices.iter().map(|(name, rows)| (format!("-{name}.csv"), write_csv(&table(system, name, rows)).into_bytes())),
        );
    }
    if system.mat {
        let matrices =
            system.matrices.iter().map(|(name, rows)| (name.clone(), MatValue::Matrix(system.columns(name).len(), rows.clone())));
        let values = LinearSystem::VALUES.iter().zip(&system.values);
        let values = values.map(|(name, values)| ((*name).to_string(), MatValue::Matrix(1, values.iter().map(|x| vec![*x]).collect())));
        let names = system.names().into_iter().map(|(name, list)| (name.to_string(), MatValue::Text(list.to_vec())));
        files.push((".mat".into(), write_mat(&matrices.chain(values).chain(names).collect::<Vec<_>>())));
    }
    files
}

fn table(system: &LinearSystem, matrix: &str, rows: &[Vec<f64>]) -> Table {
    let column = |(k, name): (usize, &String)| Column {
        name: name.clone(),
        values: rows.iter().map(|row| row.get(k).copied().unwrap_or(f64::NAN)).collect(),
        ..Column::default()
    };
    Table { columns: system.columns(matrix).iter().enumerate().map(column).collect(), ..Table::default() }
}
