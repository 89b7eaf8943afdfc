//! Damages models at random and runs what is left of them, in this process.

use grashof::analysis::run::run;
use grashof::analysis::survey::survey;
use grashof::analysis::sweep;
use grashof::mechanism::Coordinates;
use grashof::model::{Document, Kind, Over, Selection};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// xorshift64*: small, the same everywhere.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn next(&mut self, below: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % below.max(1)
    }
}

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

/// Reads a model and runs one of its studies with few samples.
fn live(bytes: &[u8], choice: usize) -> Fate {
    let Ok(document) = Document::from_bytes(bytes, "damaged.yaml") else { return Fate::Refused };
    let report = document.check_all(&Selection::default());
    assert!(!report.render(false).contains('\0'));
    let names = document.study_names();
    if report.failed() || names.is_empty() {
        return Fate::Refused;
    }
    let selection = Selection { study: Some(&names[choice % names.len()]), ..Selection::default() };
    let Ok(mut model) = document.model(&selection) else { return Fate::Refused };
    let Some(mut study) = model.study.take() else { return Fate::Refused };
    match &mut study.kind {
        Kind::Kinematics(range) | Kind::Inverse(range) | Kind::Balance { range, .. } => {
            let (Over::Driver(id) | Over::Time(id)) = range.over;
            // a long range is long work and no hang
            if model.pool.value(id, &sweep::parameters(&model)).abs() > 1e3 {
                return Fate::Refused;
            }
            range.samples = 12;
        }
        Kind::Statics | Kind::Modes(_) | Kind::Linearize(_) => {}
        // motions in time may be long without a hang
        Kind::Dynamics(_) | Kind::Periodic(_) => return Fate::Refused,
    }
    let _ = survey(&model, &sweep::parameters(&model));
    let grid = sweep::grid(&model, &study);
    let set: Vec<(usize, f64)> =
        study.sweep.iter().map(|s| s.parameter).zip(grid.get(choice % grid.len().max(1)).cloned().unwrap_or_default()).collect();
    match run(&model, &study, &sweep::parameters_with(&model, &set), Coordinates::Joint, &|| false) {
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

fn models() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found: Vec<(String, String)> = ["models", "src/cli/templates"]
        .iter()
        .flat_map(|folder| fs::read_dir(root.join(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "yaml"))
        .map(|path| (path.file_stem().unwrap().to_string_lossy().into_owned(), fs::read_to_string(path).unwrap()))
        .collect();
    found.sort();
    found
}

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(otherwise)
}

#[expect(clippy::print_stderr, reason = "a count for who tries many by hand")]
pub(crate) fn models_never_panic_or_hang() {
    let models = models();
    let rounds = setting("GRASHOF_MUTATIONS", 300);
    let mut dice = Dice(0x0DD5_EED5 ^ setting("GRASHOF_SEED", 0).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let (mut fates, mut faults, mut slowest) = ([0; 3], Vec::new(), (Duration::ZERO, 0));
    for round in 0..rounds {
        let (name, text) = &models[dice.next(models.len())];
        let (bytes, choice) = (damaged(text, &mut dice), dice.next(1000));
        let mut keep = |what: &str| {
            let path = std::env::temp_dir().join(format!("grashof-damaged-{what}-{round}.yaml"));
            fs::write(&path, &bytes).unwrap();
            faults.push(format!("{what}: round {round}, from {name}, study {choice}: {}", path.display()));
        };
        let (told, tells) = mpsc::channel();
        let (mutant, begun) = (bytes.clone(), Instant::now());
        std::thread::spawn(move || {
            let fate = catch_unwind(AssertUnwindSafe(|| live(&mutant, choice)));
            let _ = told.send(fate.ok());
        });
        match tells.recv_timeout(Duration::from_secs(setting("GRASHOF_PATIENCE", 60))) {
            Ok(Some(fate)) => fates[fate as usize] += 1,
            Ok(None) => keep("panic"),
            Err(_) => keep("hang"),
        }
        if begun.elapsed() > slowest.0 {
            slowest = (begun.elapsed(), round);
        }
    }
    let [refused, failed, ran] = fates;
    eprintln!("{refused} refused, {failed} failed, {ran} ran; slowest {:?} in round {}", slowest.0, slowest.1);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(ran * 8 > rounds, "too few still run: {ran}");
}
