//! Runs the program and reads what it wrote.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

/// One run of the program into a directory of its own, which goes when this goes.
pub(crate) struct Run {
    pub(crate) directory: PathBuf,
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// A CSV file; an empty field is NaN.
pub(crate) struct Table {
    pub(crate) names: Vec<String>,
    pub(crate) rows: Vec<Vec<f64>>,
    /// The column `reason`, if there is one.
    pub(crate) reasons: Vec<String>,
}

/// The path of a shipped model.
pub(crate) fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(name)
}

/// A directory that nobody else has.
fn fresh() -> PathBuf {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let name = format!("grashof-reference-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    std::env::temp_dir().join(name)
}

/// `grashof run MODEL -o DIRECTORY ARGUMENTS`.
pub(crate) fn run(model: &Path, arguments: &[&str]) -> Run {
    let directory = fresh();
    let output = Command::new(env!("CARGO_BIN_EXE_grashof"))
        .arg("run")
        .arg(model)
        .arg("-o")
        .arg(&directory)
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .expect("the program starts");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
    Run { directory, code: output.status.code().unwrap_or(-1), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// The same for a model given as text.
pub(crate) fn run_text(text: &str, arguments: &[&str]) -> Run {
    let path = fresh().with_extension("yaml");
    fs::write(&path, text).unwrap();
    let run = run(&path, arguments);
    fs::remove_file(&path).unwrap();
    run
}

impl Run {
    /// The same, but only if it ended with exit code 0.
    pub(crate) fn succeeded(self) -> Self {
        assert_eq!(self.code, 0, "exit code {}\n{}\n{}", self.code, self.stdout, self.stderr);
        self
    }

    /// True if a file was written.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.directory.join(name).is_file()
    }

    /// Names of all files written but the report.
    pub(crate) fn files(&self) -> Vec<String> {
        let Ok(entries) = fs::read_dir(&self.directory) else { return Vec::new() };
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        // the record of what was written, and the report, which names the model's file
        names.retain(|name| name != ".grashof.json" && name != "report.html");
        names.sort();
        names
    }

    fn read(&self, name: &str) -> String {
        let path = self.directory.join(name);
        fs::read_to_string(&path).unwrap_or_else(|e| panic!("{name}: {e}; there are {:?}\n{}", self.files(), self.stderr))
    }

    /// `STUDY.json`.
    pub(crate) fn json(&self, study: &str) -> Value {
        serde_json::from_str(&self.read(&format!("{study}.json"))).expect("JSON")
    }

    /// `STUDY.csv`.
    pub(crate) fn table(&self, study: &str) -> Table {
        Table::parse(&self.read(&format!("{study}.csv")))
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        // it may never have been made
        let _ = fs::remove_dir_all(&self.directory);
    }
}

impl Table {
    fn parse(text: &str) -> Self {
        let mut lines = text.lines();
        let names: Vec<String> = lines.next().expect("a header").split(',').map(str::to_owned).collect();
        let words = names.last().is_some_and(|n| n == "reason");
        let numbers = names.len() - usize::from(words);
        let (mut rows, mut reasons) = (Vec::new(), Vec::new());
        for line in lines {
            let mut fields = line.splitn(numbers + 1, ',');
            let number = |field: &str| {
                if field.is_empty() { f64::NAN } else { field.parse().unwrap_or_else(|_| panic!("`{field}` is no number in `{line}`")) }
            };
            let row: Vec<f64> = fields.by_ref().take(numbers).map(number).collect();
            assert_eq!(row.len(), numbers, "{line}");
            match (words, fields.next()) {
                (true, Some(reason)) => reasons.push(reason.trim_matches('"').to_owned()),
                (false, None) => {}
                _ => panic!("too many or too few fields: {line}"),
            }
            rows.push(row);
        }
        Self { names, rows, reasons }
    }

    /// Where a column stands.
    pub(crate) fn index(&self, name: &str) -> usize {
        self.names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no column {name} among {:?}", self.names))
    }

    /// A whole column.
    pub(crate) fn column(&self, name: &str) -> Vec<f64> {
        let index = self.index(name);
        self.rows.iter().map(|row| row[index]).collect()
    }

    /// For each row, −1 if it is the first of two with bit-equal first columns, +1 if the second, else 0.
    pub(crate) fn sides(&self) -> Vec<i32> {
        let equal = |i: usize, j: usize| self.rows[i][0].to_bits() == self.rows[j][0].to_bits();
        let last = self.rows.len() - 1;
        (0..=last).map(|i| i32::from(i > 0 && equal(i, i - 1)) - i32::from(i < last && equal(i, i + 1))).collect()
    }

    /// The rows of the even grid `from`, `from + step`, …; the others must be pairs.
    pub(crate) fn on_grid(&self, from: f64, step: f64, count: usize) -> Vec<usize> {
        let mut found = Vec::new();
        for (i, side) in self.sides().into_iter().enumerate() {
            let k = found.len();
            let x = self.rows[i][0];
            if k <= count && (x - (from + step * k as f64)).abs() < 1e-12 {
                found.push(i);
            } else {
                assert_ne!(side, 0, "row {i} at {x} is neither on the grid nor one of two");
            }
        }
        assert_eq!(found.len(), count + 1, "rows on the grid");
        found
    }
}
