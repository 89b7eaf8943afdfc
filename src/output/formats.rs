//! The files of results: [`FORMATS`] is the list of the formats.

use super::{matrices, write_csv, write_json};
use crate::results::Results;

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

/// All formats.
const FORMATS: [Format; 3] = [
    |results, _| vec![(".csv".into(), write_csv(&results.table).into_bytes())],
    // the JSON of a sweep holds its runs
    |results, part| if part == Part::Study { vec![(".json".into(), write_json(results).into_bytes())] } else { Vec::new() },
    |results, _| matrices(results),
];

/// The files of a study beside its pictures: names that begin with `stem`, and what they hold.
pub fn files(stem: &str, results: &Results) -> Vec<(String, Vec<u8>)> {
    of(stem, results, Part::Study)
}

/// The files of a run of a sweep, by its number from 1.
pub fn run_files(stem: &str, number: usize, results: &Results) -> Vec<(String, Vec<u8>)> {
    of(&format!("{stem}-{number:03}"), results, Part::Run)
}

fn of(stem: &str, results: &Results, part: Part) -> Vec<(String, Vec<u8>)> {
    let ends = FORMATS.iter().flat_map(|format| format(results, part));
    ends.map(|(end, bytes)| (format!("{stem}{end}"), bytes)).collect()
}
