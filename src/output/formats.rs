//! The files of results: the formats of their tables, and [`FORMATS`], the list of all others.

use super::write_error::WriteError;
use super::{matrices, write_csv, write_json};
use crate::results::{Results, Table};

/// In which formats tables are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formats {
    /// `.csv`.
    pub csv: bool,
    /// `.parquet`, which a build with the feature `parquet` has.
    pub parquet: bool,
}

impl Default for Formats {
    fn default() -> Self {
        Self { csv: true, parquet: false }
    }
}

impl Formats {
    /// Ends of the names of files.
    #[must_use]
    pub fn ends(self) -> Vec<&'static str> {
        [(self.csv, "csv"), (self.parquet, "parquet")].into_iter().filter_map(|(asked, end)| asked.then_some(end)).collect()
    }

    /// Whether this build writes all of them.
    #[must_use]
    pub fn are_built(self) -> bool {
        !self.parquet || cfg!(feature = "parquet")
    }
}

/// A format: of the results of a study, and of those of a run of a sweep, the ends of the names of files and what they hold.
type Format = fn(&Results, Part) -> Vec<(String, Vec<u8>)>;

/// Whose results are written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    /// A study.
    Study,
    /// A run of a sweep.
    Run,
}

/// All formats but those of tables.
const FORMATS: [Format; 2] = [
    // the JSON of a sweep holds its runs
    |results, part| if part == Part::Study { vec![(".json".into(), write_json(results).into_bytes())] } else { Vec::new() },
    |results, _| matrices(results),
];

/// The files of a table, whose names begin with `stem`.
///
/// # Errors
/// What an encoder says.
pub fn tables(stem: &str, table: &Table, formats: Formats) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let mut files = Vec::new();
    if formats.csv {
        files.push((format!("{stem}.csv"), write_csv(table).into_bytes()));
    }
    #[cfg(feature = "parquet")]
    if formats.parquet {
        let name = format!("{stem}.parquet");
        let bytes = super::write_parquet(table).map_err(|cause| WriteError { path: name.clone().into(), cause })?;
        files.push((name, bytes));
    }
    Ok(files)
}

/// The files of a study beside its table and its pictures: names that begin with `stem`, and what they hold.
pub fn files(stem: &str, results: &Results) -> Vec<(String, Vec<u8>)> {
    of(stem, results, Part::Study)
}

/// The files of a run of a sweep, by its number from 1, with its table.
///
/// # Errors
/// As those of [`tables`].
pub fn run_files(stem: &str, number: usize, results: &Results, formats: Formats) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let stem = format!("{stem}-{number:03}");
    let mut files = tables(&stem, &results.table, formats)?;
    files.extend(of(&stem, results, Part::Run));
    Ok(files)
}

fn of(stem: &str, results: &Results, part: Part) -> Vec<(String, Vec<u8>)> {
    let ends = FORMATS.iter().flat_map(|format| format(results, part));
    ends.map(|(end, bytes)| (format!("{stem}{end}"), bytes)).collect()
}
