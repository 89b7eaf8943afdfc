//! Measured data: tables from files that figures name, which the caller reads as it reads what a model includes.

use super::files::Files;
use serde_yaml::{Mapping, Value};
use std::collections::BTreeMap;

/// Numbers of a table at most.
const MOST: usize = 4_000_000;

/// A table: names of its columns, and rows of as many numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Table {
    pub(crate) names: Vec<String>,
    pub(crate) rows: Vec<Vec<f64>>,
}

/// Why there is no table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NoTable {
    /// The file cannot be read.
    Unread(String),
    /// What it says is none.
    Wrong(String),
}

/// Tables by the paths under which a model names them, or why there is none.
#[derive(Clone, Debug, Default)]
pub(crate) struct DataFiles(BTreeMap<String, Result<Table, NoTable>>);

impl DataFiles {
    /// Reads all that the figures of a model name.
    pub(super) fn read(root: &Mapping, files: &Files<'_>) -> Self {
        let map = |value: &Value, key: &str| value.get(key).and_then(Value::as_mapping).cloned().unwrap_or_default();
        let mut found = BTreeMap::new();
        for study in root.get("studies").and_then(Value::as_mapping).into_iter().flat_map(Mapping::values) {
            for plot in map(study, "plot").values() {
                for data in map(plot, "data").values() {
                    let Some(path) = data.get("file").and_then(Value::as_str) else { continue };
                    let read = || files(path).map_err(NoTable::Unread).and_then(|(_, bytes)| table(&bytes).map_err(NoTable::Wrong));
                    found.entry(path.to_owned()).or_insert_with(read);
                }
            }
        }
        Self(found)
    }

    /// The table of a path.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn table(&self, path: &str) -> Result<&Table, NoTable> {
        let unread = || Err(NoTable::Unread("no files are read here".to_owned()));
        self.0.get(path).map_or_else(unread, |found| found.as_ref().map_err(Clone::clone))
    }
}

/// A table with commas, semicolons or tabs; an empty field, and one that says `NaN`, is a number that is not there.
fn table(bytes: &[u8]) -> Result<Table, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it is no text (UTF-8)".to_owned())?;
    // some programs end lines by a carriage return alone
    let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n").replace('\r', "\n");
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let (_, head) = lines.next().ok_or("it is empty")?;
    let mark = ['\t', ';', ','].into_iter().find(|mark| head.contains(*mark)).unwrap_or(',');
    let names: Vec<String> = head.split(mark).map(|name| name.trim().trim_matches('"').trim().to_owned()).collect();
    if names.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err("its first line has numbers: the names of the columns are expected there, as `t,x`".to_owned());
    }
    if let Some(twice) = names.iter().enumerate().find_map(|(i, name)| (!name.is_empty() && names[..i].contains(name)).then_some(name)) {
        return Err(format!("two of its columns are named `{twice}`: each needs its own name"));
    }
    let mut rows = Vec::new();
    for (number, line) in lines {
        let fields: Vec<&str> = line.split(mark).map(str::trim).collect();
        let row: Option<Vec<f64>> = fields.iter().map(|field| if field.is_empty() { Some(f64::NAN) } else { field.parse().ok() }).collect();
        let row = row.filter(|row| row.len() == names.len()).ok_or_else(|| {
            format!("line {}: {} numbers with a decimal point are expected, as the first line has names", number + 1, names.len())
        })?;
        if let Some(k) = row.iter().position(|x| x.is_infinite()) {
            return Err(format!("line {}: `{}` is beyond all numbers; leave the field empty if there is none", number + 1, fields[k]));
        }
        rows.push(row);
        if rows.len() * names.len() > MOST {
            return Err(format!("it has more than {MOST} numbers"));
        }
    }
    if rows.is_empty() { Err("it has a line of names and no numbers".to_owned()) } else { Ok(Table { names, rows }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_with_any_mark() {
        let read = |text: &str| table(text.as_bytes());
        let wanted = Table { names: vec!["t".into(), "x".into()], rows: vec![vec![0.0, 1.5], vec![1.0, -2e-3]] };
        for text in ["t,x\n0,1.5\n1,-2e-3\n", "\u{feff}\"t\"; x\r\n0;1.5\r\n\r\n1;-2e-3", "# by hand\nt\tx\n0\t1.5\n1\t-2e-3\n"] {
            assert_eq!(read(text), Ok(wanted.clone()), "{text}");
        }
        assert!(read("t,x\n0,\n").is_ok_and(|table| table.rows[0][1].is_nan()));
        assert!(read("t;x\n0;1,5\n").is_err_and(|why| why.starts_with("line 2: 2 numbers")));
        // lines that end in a carriage return, no names, no numbers, a name twice, a number without bound
        assert_eq!(read("t,x\r0,1.5\r1,-2e-3\r"), Ok(wanted));
        for (text, words) in [("0,1\n2,3\n", "names"), ("t,x\n", "no numbers"), ("t,t\n0,1\n", "`t`"), ("t,x\n0,inf\n", "line 2: `inf`")] {
            assert!(read(text).is_err_and(|why| why.contains(words)), "{text}");
        }
        // marks behind the last name, as spreadsheets write them
        assert!(read("t,x,,\n0,1,,\n").is_ok_and(|table| table.rows[0][..2] == [0.0, 1.0]));
        assert!(read("t,x\n0\n").is_err() && read("").is_err() && table(&[0xff, 0xfe]).is_err());
    }
}
