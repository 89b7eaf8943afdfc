//! Cases of `external/cases.json`: each is run by the real program and compared with its published result.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, OnceLock};

/// A table of numbers with names; an empty field is NaN.
pub(crate) struct Table {
    pub(crate) names: Vec<String>,
    pub(crate) rows: Vec<Vec<f64>>,
    /// The text of a first line that begins with `#`.
    pub(crate) comment: String,
}

/// The reference's column beside one of the program's, turned into its unit and sign.
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) ours: String,
    pub(crate) factor: f64,
    pub(crate) offset: f64,
}

/// One entry of the manifest.
pub(crate) struct Case {
    pub(crate) id: String,
    pub(crate) suite: String,
    pub(crate) what: String,
    pub(crate) study: String,
    pub(crate) model: PathBuf,
    pub(crate) reference: PathBuf,
    /// An integration of hand-written equations, where the published result is loose.
    pub(crate) hand: Option<PathBuf>,
    pub(crate) columns: Vec<Column>,
    /// Digits that must agree.
    pub(crate) expect: f64,
    /// What is known of the reference's own digits.
    pub(crate) digits: String,
    /// The last key that is compared.
    pub(crate) until: f64,
    pub(crate) note: String,
}

/// A case and what came of it.
pub(crate) struct Comparison {
    pub(crate) case: Case,
    /// Rows compared.
    pub(crate) rows: usize,
    /// Digits of the worst column.
    pub(crate) digits: f64,
    /// Digits by the integration of hand-written equations.
    pub(crate) by_hand: Option<f64>,
    /// Digits of the published result by the same integration.
    pub(crate) reference_by_hand: Option<f64>,
    /// The worst column and the largest difference, with the largest value of the column's vector.
    pub(crate) worst: usize,
    pub(crate) off: f64,
    pub(crate) size: f64,
    /// Key, our value and the right one of the worst column, a quaternion with the reference's sign.
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) ours: Table,
    pub(crate) right: Table,
}

pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// The manifest.
pub(crate) fn manifest() -> Value {
    let path = root().join("tests/external/cases.json");
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

pub(crate) fn cases() -> Vec<Case> {
    let here = root().join("tests/external");
    let read = |entry: &Value| {
        let id = text(&entry["id"]);
        let table = |name: &str| here.join(format!("refs/{name}.csv"));
        let column = |(name, ours): (&String, &Value)| {
            let number = |k: usize, other: f64| ours.get(k).and_then(Value::as_f64).unwrap_or(other);
            let (factor, offset) = (number(1, 1.0), number(2, 0.0));
            let ours = text(if ours.is_array() { &ours[0] } else { ours });
            Column { name: name.clone(), ours, factor, offset }
        };
        let hand = table(&format!("{id}.hand"));
        Case {
            suite: text(&entry["suite"]),
            what: text(&entry["what"]),
            study: text(&entry["study"]),
            model: entry["model"].as_str().map_or_else(|| here.join(format!("models/{id}.yaml")), |path| root().join(path)),
            reference: table(entry["ref"].as_str().unwrap_or(&id)),
            hand: hand.is_file().then_some(hand),
            columns: entry["map"].as_object().unwrap().iter().map(column).collect(),
            expect: entry["expect"].as_f64().unwrap(),
            digits: text(&entry["reference"]),
            until: entry["until"].as_f64().unwrap_or(f64::INFINITY),
            note: text(&entry["note"]),
            id,
        }
    };
    manifest()["cases"].as_array().unwrap().iter().map(read).collect()
}

impl Table {
    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let comment = text.lines().next().and_then(|l| l.strip_prefix('#')).unwrap_or_default().trim().to_owned();
        let mut lines = text.lines().filter(|l| !l.starts_with('#'));
        let names: Vec<String> = lines.next().expect("a header").split(',').map(str::to_owned).collect();
        let number = |field: &str| if field.is_empty() { f64::NAN } else { field.parse().unwrap_or(f64::NAN) };
        Self { rows: lines.map(|line| line.split(',').take(names.len()).map(number).collect()).collect(), names, comment }
    }

    pub(crate) fn index(&self, name: &str) -> usize {
        self.names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no column {name} among {:?}", self.names))
    }

    /// The first row of each key.
    fn by_key(&self) -> BTreeMap<i64, &Vec<f64>> {
        let mut map = BTreeMap::new();
        for row in &self.rows {
            map.entry(key(row)).or_insert(row);
        }
        map
    }
}

/// The first field of a row, to nine decimals: references print their times rounded.
fn key(row: &[f64]) -> i64 {
    (row[0] * 1e9).round() as i64
}

/// `pose.Q[2]` belongs to `pose.Q`: differences are measured by the largest value of the whole vector.
fn vector(name: &str) -> &str {
    name.rfind('[').filter(|_| name.ends_with(']')).map_or(name, |at| &name[..at])
}

/// Digits of a difference that is relative to the size of what is compared.
fn digits(relative: f64) -> f64 {
    if relative.is_nan() { 0.0 } else { (-relative.log10()).min(16.0) }
}

/// What a comparison of two tables finds: the largest difference of each column, and the size of its vector.
struct Differences {
    /// For each column the points that are compared: key, found, right.
    points: Vec<Vec<[f64; 3]>>,
    columns: Vec<(f64, f64)>,
}

impl Differences {
    /// Differences relative to the sizes; those of columns that are zero everywhere stay absolute.
    fn relative(&self) -> Vec<f64> {
        self.columns.iter().map(|&(off, size)| if size > 1e-9 { off / size } else { off }).collect()
    }

    fn worst(&self) -> usize {
        let relative = self.relative();
        let weight = |i: &usize| if relative[*i].is_nan() { f64::INFINITY } else { relative[*i] };
        (0..relative.len()).max_by(|a, b| weight(a).total_cmp(&weight(b))).expect("a column")
    }
}

/// Compares columns of `found` with columns of `right` of the same keys. `of` gives where a column stands in `found`, its factor
/// and its offset, and where it stands in `right`.
fn differences(case: &Case, found: &Table, right: &Table, of: &[(usize, f64, f64, usize)]) -> Differences {
    let at = found.by_key();
    let pairs: Vec<(&Vec<f64>, &Vec<f64>)> =
        right.rows.iter().filter(|r| r[0] <= case.until).filter_map(|r| Some((*at.get(&key(r))?, r))).collect();
    // a quaternion and its negative are the same turn: one sign for each row
    let quaternion: Vec<usize> = (0..of.len()).filter(|&i| vector(&case.columns[i].name).ends_with(".Q")).collect();
    let sign = |name: &str, (f, r): (&[f64], &[f64])| {
        let same = |i: &&usize| vector(&case.columns[**i].name) == name;
        let product: f64 = quaternion.iter().filter(same).map(|&i| f[of[i].0] * r[of[i].3]).sum();
        if product < 0.0 { -1.0 } else { 1.0 }
    };
    let points = |i: usize| -> Vec<[f64; 3]> {
        let (a, factor, offset, b) = of[i];
        let name = vector(&case.columns[i].name);
        pairs.iter().map(|(f, r)| [r[0], f[a] * factor * sign(name, (f, r)) + offset, r[b]]).collect()
    };
    let points: Vec<_> = (0..of.len()).map(points).collect();
    let column = |i: usize| {
        let largest = |m: f64, x: f64| if x <= m { m } else { x };
        let same = |k: &usize| vector(&case.columns[*k].name) == vector(&case.columns[i].name);
        let sizes = (0..of.len()).filter(same).flat_map(|k| points[k].iter().map(|p| p[2].abs()));
        (points[i].iter().map(|p| (p[1] - p[2]).abs()).fold(0.0, largest), sizes.fold(0.0, f64::max))
    };
    Differences { columns: (0..of.len()).map(column).collect(), points }
}

/// `grashof run MODEL --study STUDY` in a directory of its own, and the table that it wrote.
fn run(case: &Case) -> Result<Table, String> {
    let directory = std::env::temp_dir().join(format!("grashof-external-{}-{}", std::process::id(), case.id));
    let output = Command::new(env!("CARGO_BIN_EXE_grashof"))
        .args(["run", "--no-plots", "--study", &case.study, "-o"])
        .arg(&directory)
        .arg(&case.model)
        .stdin(Stdio::null())
        .output()
        .expect("the program starts");
    let table = match output.status.code() {
        Some(0) => Ok(Table::read(&directory.join(format!("{}.csv", case.study)))),
        code => Err(format!("{}: exit code {code:?}\n{}", case.id, String::from_utf8_lossy(&output.stderr))),
    };
    let _ = fs::remove_dir_all(&directory);
    table
}

/// Runs a case and compares it.
fn compared(case: Case) -> Result<Comparison, String> {
    let ours = run(&case)?;
    let right = Table::read(&case.reference);
    let of = |table: &Table| -> Vec<_> {
        case.columns.iter().map(|c| (ours.index(&c.ours), c.factor, c.offset, table.index(&c.name))).collect()
    };
    let mut found = differences(&case, &ours, &right, &of(&right));
    if found.points[0].is_empty() {
        return Err(format!("{}: no row has a key of the reference", case.id));
    }
    let worst = found.worst();
    let (off, size) = found.columns[worst];
    let hand = case.hand.as_deref().map(Table::read);
    let all = |d: &Differences| digits(d.relative()[d.worst()]);
    let by_hand = hand.as_ref().map(|hand| all(&differences(&case, &ours, hand, &of(hand))));
    let reference_by_hand = hand.as_ref().map(|hand| {
        let of: Vec<_> = case.columns.iter().map(|c| (right.index(&c.name), 1.0, 0.0, hand.index(&c.name))).collect();
        all(&differences(&case, &right, hand, &of))
    });
    let digits = all(&found);
    let points = found.points.swap_remove(worst);
    Ok(Comparison { rows: points.len(), digits, by_hand, reference_by_hand, worst, off, size, points, ours, right, case })
}

/// All cases, run once for all tests of this binary, in the order of the manifest.
pub(crate) fn comparisons() -> &'static [Result<Comparison, String>] {
    static ALL: OnceLock<Vec<Result<Comparison, String>>> = OnceLock::new();
    ALL.get_or_init(|| {
        let queue = Mutex::new(cases().into_iter().enumerate());
        let done = Mutex::new(Vec::new());
        let threads = std::thread::available_parallelism().map_or(2, usize::from);
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    loop {
                        let next = queue.lock().unwrap().next();
                        let Some((place, case)) = next else { break };
                        let outcome = compared(case);
                        done.lock().unwrap().push((place, outcome));
                    }
                });
            }
        });
        let mut done = done.into_inner().unwrap();
        done.sort_by_key(|(place, _)| *place);
        done.into_iter().map(|(_, outcome)| outcome).collect()
    })
}
