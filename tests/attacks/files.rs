//! Damages model files and URDF at random and runs what is left of them, in this process.

use super::dice::Dice;
use super::{cases, seeded, setting, tell};
use grashof::kinematics::survey::survey;
use grashof::model::{Document, Import, Kind, Over, Selection, import};
use grashof::studies::common::case::Case;
use grashof::studies::common::case::{parameters, parameters_with};
use grashof::studies::run::run;
use grashof::studies::sweep;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc;
use std::time::{Duration, Instant};

const PIECES: [&str; 28] = [
    "{", "}", "[", "]", ": ", ",", "- ", "*", "&a ", "!t ", "|", "'", "\"", "~", "null", "\n", "\n  ", "1e400", ".nan", "ü", "(", ")",
    "rate(", "abs(", "-", "^", "ground", "/",
];

/// Numbers that a person might write by mistake: these get through the reader more often than broken signs do.
const NUMBERS: [&str; 16] =
    ["0", "1", "-1", "2", "1e-9", "1e9", "1e-300", "1e300", "0.5", "90", "180", "3.141592653589793", "-0.15", "100", "7", "0.1"];

/// A damaged text.
fn damaged(text: &str, dice: &mut Dice) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..=dice.next(2) {
        let at = dice.next(bytes.len());
        match dice.next(12) {
            0 => bytes[at] = dice.next(256) as u8,
            1 => {
                bytes.remove(at);
            }
            2 => {
                bytes.splice(at..at, PIECES[dice.next(PIECES.len())].bytes());
            }
            // a line removed, doubled, or exchanged with another
            kind @ 3..=5 => {
                let mut lines: Vec<&[u8]> = bytes.split(|c| *c == b'\n').collect();
                let (i, j) = (dice.next(lines.len()), dice.next(lines.len()));
                match kind {
                    3 => {
                        lines.remove(i);
                    }
                    4 => lines.insert(j, lines[i]),
                    _ => lines.swap(i, j),
                }
                bytes = lines.join(&b'\n');
            }
            // a word replaced by another of the file
            6 | 7 => {
                let words: Vec<&str> = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|w| !w.is_empty()).collect();
                let (from, to) = (words[dice.next(words.len())], words[dice.next(words.len())]);
                bytes = String::from_utf8_lossy(&bytes).replacen(from, to, 1 + dice.next(3)).into_bytes();
            }
            // another number
            _ => {
                let now = String::from_utf8_lossy(&bytes).into_owned();
                let starts: Vec<usize> = now
                    .match_indices(|c: char| c.is_ascii_digit())
                    .map(|(i, _)| i)
                    .filter(|&i| i > 0 && b" [-~(*/+".contains(&now.as_bytes()[i - 1]))
                    .collect();
                if let Some(&from) = starts.get(dice.next(starts.len())) {
                    let length = now[from..].find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(1);
                    bytes = [&now[..from], NUMBERS[dice.next(NUMBERS.len())], &now[from + length..]].concat().into_bytes();
                }
            }
        }
        if bytes.is_empty() {
            break;
        }
    }
    bytes
}

/// What came of a damaged model.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fate {
    Refused,
    Failed,
    Ran,
}

/// Reads a model as `check` does and runs one of its studies as `run` does, with few samples.
fn live(bytes: &[u8], choice: usize) -> Fate {
    let Ok(document) = Document::from_bytes(bytes, "damaged.yaml") else { return Fate::Refused };
    let report = document.check_all(&Selection::default());
    assert!(!report.render(false).contains('\0'));
    let names = document.study_names();
    if report.failed() || names.is_empty() {
        return Fate::Refused;
    }
    let selection = Selection { study: Some(&names[choice % names.len()]), ..Selection::default() };
    let mut model =
        document.model(&selection).unwrap_or_else(|report| panic!("`check` finds nothing, `run` does: {}", report.render(false)));
    let Some(mut study) = model.study.take() else { return Fate::Refused };
    match &mut study.kind {
        Kind::Kinematics(range) | Kind::Inverse(range) | Kind::Balance { range, .. } => {
            let (Over::Driver(id) | Over::Time(id)) = range.over;
            // a long range is long work and no hang
            if model.pool.value(id, &parameters(&model)).abs() > 1e3 {
                return Fate::Refused;
            }
            range.samples = 12;
        }
        Kind::Statics | Kind::Modes(_) | Kind::Linearize(_) | Kind::Dynamics(_) => {}
        // asks `stop` between its integrations only
        Kind::Periodic(_) => return Fate::Refused,
    }
    let _ = survey(&model, &parameters(&model));
    let grid = sweep::grid(&model, &study);
    let set: Vec<(usize, f64)> =
        study.sweep.iter().map(|s| s.parameter).zip(grid.get(choice % grid.len().max(1)).cloned().unwrap_or_default()).collect();
    // motions in time may be long without a hang: they have to hear that they shall stop
    let begun = Instant::now();
    let stop = || begun.elapsed() > Duration::from_millis(500);
    match run(Case::new(&model, &study, &parameters_with(&model, &set)), &stop) {
        Ok(outcome) => {
            assert!(outcome.places.iter().all(|x| x.is_finite()), "places {:?}", outcome.places);
            if outcome.stopped.is_some() { Fate::Failed } else { Fate::Ran }
        }
        Err(failure) => {
            assert!(!failure.reason().is_empty());
            Fate::Failed
        }
    }
}

/// Translates a URDF; what comes out is a model that is read without a fault.
fn translated(bytes: &[u8], _: usize) -> Fate {
    let Ok(imported) = import(bytes, "damaged.urdf", &Import::default()) else { return Fate::Refused };
    let report = Document::from_bytes(imported.text.as_bytes(), "imported.yaml").map(|d| d.check_all(&Selection::default()));
    let report = report.unwrap_or_else(|report| report);
    assert!(!report.failed(), "`import` writes what `check` refuses:\n{}\n{}", report.render(false), imported.text);
    Fate::Ran
}

/// Files with an ending, below directories of the project: name and text.
fn texts(directories: &[&str], ending: &str) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found: Vec<(String, String)> = directories
        .iter()
        .flat_map(|folder| fs::read_dir(root.join(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == ending))
        .map(|path| (path.file_stem().unwrap().to_string_lossy().into_owned(), fs::read_to_string(path).unwrap()))
        .collect();
    found.sort();
    found
}

/// Damages texts, each case from another of them, and lives with them on a thread of their own.
fn attack(kind: &str, texts: &[(String, String)], short: u64, live: fn(&[u8], usize) -> Fate) {
    let rounds = cases(short);
    let patience = Duration::from_secs(setting("GRASHOF_PATIENCE", 60));
    let mut dice = seeded(0x0DD5_EED5);
    let (mut fates, mut faults, mut slowest) = ([0; 3], Vec::new(), (Duration::ZERO, 0));
    for round in 0..rounds {
        let (name, text) = &texts[dice.next(texts.len())];
        let (bytes, choice) = (damaged(text, &mut dice), dice.next(1000));
        let mut keep = |what: &str| {
            let path = std::env::temp_dir().join(format!("grashof-damaged-{what}-{round}.{kind}"));
            fs::write(&path, &bytes).unwrap();
            faults.push(format!("{what}: round {round}, from {name}, study {choice}: {}", path.display()));
        };
        let (told, tells) = mpsc::channel();
        let (mutant, begun) = (bytes.clone(), Instant::now());
        std::thread::spawn(move || {
            let fate = catch_unwind(AssertUnwindSafe(|| live(&mutant, choice)));
            let _ = told.send(fate.ok());
        });
        match tells.recv_timeout(patience) {
            Ok(Some(fate)) => fates[fate as usize] += 1,
            Ok(None) => keep("panic"),
            Err(_) => keep("hang"),
        }
        if begun.elapsed() > slowest.0 {
            slowest = (begun.elapsed(), round);
        }
    }
    let [refused, failed, ran] = fates;
    let slow = format!("slowest {:.1?} in round {}", slowest.0, slowest.1);
    tell(&format!(
        "{kind}: {rounds} cases: {refused} refused, {failed} failed with a reason, {ran} ran; {slow}; {} findings",
        faults.len()
    ));
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(ran * 8 > rounds, "too few still run: {ran}");
}

/// Damaged models are refused with a diagnostic, fail with a reason, or run; what `check` lets pass begins to run.
#[test]
fn damaged_models_never_panic_or_hang() {
    let mut texts = texts(&["models", "src/cli/templates", "tests/external/models"], "yaml");
    // what takes seconds by itself would hide what hangs
    texts.retain(|(name, _)| name != "iftomm_a02_four_bar_40");
    attack("yaml", &texts, 300, live);
}

/// A damaged URDF is refused, or becomes a model without faults.
#[test]
fn damaged_robots_are_refused_or_become_models() {
    attack("urdf", &texts(&["models", "tests/urdf", "tests/external/models/urdf"], "urdf"), 1000, translated);
}
