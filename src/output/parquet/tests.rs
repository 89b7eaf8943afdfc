//! Bytes, and what is read back from them.

use super::encode::GROUP;
use super::*;
use arrow_array::Array;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::fs::File;
use std::io::{Cursor, Write};

fn reader(bytes: &[u8]) -> ParquetRecordBatchReaderBuilder<File> {
    let mut file = tempfile::tempfile().unwrap();
    file.write_all(bytes).unwrap();
    ParquetRecordBatchReaderBuilder::try_new(file).unwrap()
}

/// Names, units, numbers (NaN for null) and row groups of a file.
type Contents = (Vec<String>, Vec<Option<String>>, Vec<Vec<f64>>, usize);

/// What is in a file.
fn read(bytes: &[u8]) -> Contents {
    let builder = reader(bytes);
    let fields: Vec<_> = builder.schema().fields().iter().cloned().collect();
    let groups = builder.metadata().num_row_groups();
    let mut columns = vec![Vec::new(); fields.len()];
    for batch in builder.build().unwrap() {
        for (out, array) in columns.iter_mut().zip(batch.unwrap().columns()) {
            if let Some(numbers) = array.as_any().downcast_ref::<Float64Array>() {
                out.extend(numbers.iter().map(|x| x.unwrap_or(f64::NAN)));
            }
        }
    }
    let units = fields.iter().map(|field| field.metadata().get("unit").cloned()).collect();
    (fields.iter().map(|field| field.name().clone()).collect(), units, columns, groups)
}

fn column(name: &str, unit: &str, values: Vec<f64>) -> Column {
    Column { name: name.into(), unit: unit.into(), values, ..Column::default() }
}

#[test]
fn a_table_reads_back_bit_for_bit_and_rows_give_the_same_bytes() {
    let n = GROUP + BATCH + 3;
    let t: Vec<f64> = (0..n).map(|i| i as f64 / 3.0).collect();
    let x: Vec<f64> = (0..n).map(|i| if i % 1000 == 7 { f64::NAN } else { (i as f64).sin() }).collect();
    let table = Table { columns: vec![column("time", "s", t.clone()), column("a, b", "", x.clone())], ..Table::default() };
    let bytes = write_parquet(&table).unwrap();
    let (names, units, columns, groups) = read(&bytes);
    assert_eq!((names, units, groups), (vec!["time".into(), "a, b".into()], vec![Some("s".into()), None], 2));
    let same =
        |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan());
    assert!(same(&columns[0], &t) && same(&columns[1], &x));

    let mut rows = Box::new(ParquetRows::new(Cursor::new(Vec::new())));
    // rows that begin anew do not count
    for _ in 0..2 {
        rows.begin(&table.columns).unwrap();
        (0..n).for_each(|i| rows.row(&[t[i], x[i]]).unwrap());
    }
    assert!(rows.end().unwrap().into_inner() == bytes, "other bytes");
}

#[test]
fn a_sweep_has_its_reasons_last() {
    let table = Table {
        columns: vec![column("l3", "m", vec![0.1, 0.2])],
        reasons: Some(vec![String::new(), "no turn".into()]),
        ..Table::default()
    };
    let builder = reader(&write_parquet(&table).unwrap());
    let batch = builder.build().unwrap().next().unwrap().unwrap();
    let reasons = batch.column_by_name("reason").unwrap().as_any().downcast_ref::<StringArray>().unwrap().clone();
    assert_eq!((reasons.value(0), reasons.value(1), reasons.null_count()), ("", "no turn", 0));
}

#[test]
fn parts_gather_to_the_bytes_of_the_whole() {
    let n = GROUP + 2 * BATCH + 11;
    let x: Vec<f64> = (0..n).map(|i| i as f64 / 7.0).collect();
    let y: Vec<f64> = (0..n).map(|i| if i < 40_000 { f64::NAN } else { (i as f64).cos() }).collect();
    let reasons: Vec<String> = (0..n).map(|i| if i % 997 == 3 { format!("run {i} has no turn") } else { String::new() }).collect();
    let of = |rows: std::ops::Range<usize>| Table {
        columns: vec![column("x", "m", x[rows.clone()].to_vec()), column("y", "", y[rows.clone()].to_vec())],
        reasons: Some(reasons[rows].to_vec()),
        ..Table::default()
    };
    let whole = write_parquet(&of(0..n)).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let known = [column("x", "m", vec![]), column("y", "", vec![]), column("z", "", vec![])];
    for ends in [vec![n], vec![1, 40_000, n], vec![7, 9000, 9001, 30_000, 100_000, n]] {
        let mut paths = Vec::new();
        let mut begin = 0;
        for end in ends {
            let mut table = of(begin..end);
            // what no run of a part has is left out of it
            if end <= 40_000 {
                table.columns.pop();
            }
            paths.push(directory.path().join(format!("{begin}.parquet")));
            std::fs::write(paths.last().unwrap(), write_parquet(&table).unwrap()).unwrap();
            begin = end;
        }
        let mut gathered = Vec::new();
        gather_parquet(&known, &paths, &mut gathered).unwrap();
        assert!(gathered == whole, "other bytes");
    }
    let table = ParquetTable::open(&directory.path().join("1.parquet")).unwrap();
    assert_eq!((table.rows(), table.columns()), (39_999, &known[..1]));
    assert_eq!(table.column("x").unwrap(), &x[1..40_000]);
    assert_eq!(table.reasons().unwrap(), &reasons[1..40_000]);
    assert!(table.column("y").is_err() && ParquetTable::open(&directory.path().join("none")).is_err());
}
