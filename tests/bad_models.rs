//! Bad models and bad arguments, each with the exact text that a person gets to read.
//!
//! `tests/bad/NAME.yaml` is run by the real program, in that directory; what it says on stderr is `tests/bad/NAME.txt`.
//! After an intended change of a message: `GRASHOF_BLESS=1 cargo test --test all bad_models`, then read the difference.

mod lists;

use crate::attacks::dice;
use lists::{ARGUMENTS, FILES};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// How a bad model ends.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    /// The file is refused: exit code 2, and `check` says the same.
    Refused,
    /// The study cannot begin: exit code 2.
    NotBegun,
    /// A numerical reason before the first row: exit code 3.
    Numerical,
    /// A numerical reason on the way: exit code 3, rows are kept.
    Stopped,
}
use End::{NotBegun, Numerical, Refused, Stopped};

impl End {
    fn code(self) -> i32 {
        if matches!(self, Refused | NotBegun) { 2 } else { 3 }
    }
}

fn bad(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad").join(name)
}

/// A fresh path below the system's temporary directory, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("grashof-bad-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
        let _ = fs::remove_file(&self.0);
    }
}

/// Runs the program in `directory` with `OUT` standing for `out`: exit code and stderr, the path `out` as `OUT` again.
fn run(directory: &Path, arguments: &[&str], out: &Path) -> (i32, String) {
    let out = out.to_str().unwrap();
    let begun = Instant::now();
    let output = Command::new(env!("CARGO_BIN_EXE_grashof"))
        .args(arguments.iter().map(|a| a.replace("OUT", out)))
        .current_dir(directory)
        .env_remove("NO_COLOR")
        .env("RUST_BACKTRACE", "0")
        .stdin(Stdio::null())
        .output()
        .expect("the program starts");
    assert!(begun.elapsed() < Duration::from_secs(60), "{arguments:?} took {:?}", begun.elapsed());
    let stderr = String::from_utf8(output.stderr).expect("stderr is UTF-8").replace(out, "OUT");
    assert!(!stderr.contains("panicked") && !stderr.contains("RUST_BACKTRACE"), "{arguments:?}\n{stderr}");
    assert!(!stderr.contains('\x1b'), "{arguments:?}: colours without a terminal\n{stderr}");
    let code = output.status.code().unwrap_or_else(|| panic!("{arguments:?} was killed: {}\n{stderr}", output.status));
    // only a run of several studies may tell results beside an error
    if arguments.contains(&"--json") {
        let told: serde_json::Value = serde_json::from_slice(&output.stdout).expect("errors as JSON");
        assert!(code != 2 || told[0]["errors"][0]["message"].is_string(), "{arguments:?}: {told}");
    } else if code == 2 && !arguments.contains(&"--no-plots") {
        assert!(output.stdout.is_empty(), "{arguments:?}: stdout {}", String::from_utf8_lossy(&output.stdout));
    }
    (code, stderr)
}

/// Differences found so far; all are shown at once.
#[derive(Default)]
struct Verdict(Vec<String>);

impl Verdict {
    fn snapshot(&mut self, name: &str, text: &str) {
        let path = bad(&format!("{name}.txt"));
        if std::env::var_os("GRASHOF_BLESS").is_some() {
            fs::write(&path, text).unwrap();
            return;
        }
        let expected = fs::read_to_string(&path).unwrap_or_default();
        if expected != text {
            self.0.push(format!("{name}: said\n{text}\ninstead of\n{expected}"));
        }
    }

    fn demand(&mut self, met: bool, name: &str, what: &str) {
        if !met {
            self.0.push(format!("{name}: {what}"));
        }
    }

    fn give(self) {
        assert!(self.0.is_empty(), "{} findings\n\n{}", self.0.len(), self.0.join("\n\n"));
    }
}

#[test]
fn every_bad_file_gets_its_diagnostic() {
    let mut verdict = Verdict::default();
    for (end, names) in FILES {
        for name in *names {
            let out = Scratch::new(name);
            let file = format!("{name}.yaml");
            let study: &[&str] = if *end == Refused || *name == "no-studies" { &[] } else { &["--study", "turn"] };
            let (code, stderr) = run(&bad(""), &[&["run", &file, "-o", "OUT"], study].concat(), &out.0);
            verdict.demand(code == end.code(), name, &format!("exit code {code}"));
            verdict.demand(stderr.contains("error"), name, "no error is told");
            verdict.snapshot(name, &stderr);
            verdict.demand(out.0.exists() == (*end == Stopped), name, "files that must not be there, or are missing");
            if *end == Refused {
                let (code, told) = run(&bad(""), &["check", &file], &out.0);
                verdict.demand(code == 2 && told == stderr, name, &format!("`check` ends with {code} and says\n{told}\nnot\n{stderr}"));
            }
        }
    }
    verdict.give();
}

#[test]
fn every_bad_argument_gets_its_message() {
    let mut verdict = Verdict::default();
    for (name, arguments, right) in ARGUMENTS {
        let out = Scratch::new(name);
        let (code, stderr) = run(&bad(""), arguments, &out.0);
        verdict.demand(code == *right, name, &format!("exit code {code}"));
        verdict.snapshot(name, &stderr);
        verdict.demand(!out.0.exists(), name, "something was written");
    }
    verdict.give();
}

#[test]
fn an_output_directory_that_is_a_file_stays_one() {
    let mut verdict = Verdict::default();
    let out = Scratch::new("occupied");
    fs::write(&out.0, "mine").unwrap();
    for (name, directory) in [("output-is-a-file", "OUT"), ("output-below-a-file", "OUT/deeper")] {
        let (code, stderr) = run(&bad(""), &["run", "base.yaml", "--study", "turn", "-o", directory], &out.0);
        verdict.demand(code == 2, name, &format!("exit code {code}"));
        verdict.snapshot(name, &stderr);
        verdict.demand(fs::read_to_string(&out.0).unwrap() == "mine", name, "the file was touched");
    }
    // a directory lies where a file of the study belongs: nothing of the study is written
    let out = Scratch::new("in-the-way");
    fs::create_dir_all(out.0.join("turn.json")).unwrap();
    let (code, stderr) = run(&bad(""), &["run", "base.yaml", "--study", "turn", "-o", "OUT"], &out.0);
    verdict.demand(code == 2, "output-in-the-way", &format!("exit code {code}"));
    verdict.snapshot("output-in-the-way", &stderr);
    verdict.demand(fs::read_dir(&out.0).unwrap().count() == 1, "output-in-the-way", "half a result");
    verdict.give();
}

#[test]
fn generated_files_are_refused() {
    let mut verdict = Verdict::default();
    let here = Scratch::new("generated");
    fs::create_dir_all(&here.0).unwrap();
    let out = Scratch::new("generated-out");
    let deep = 100_000;
    let mut dice = dice::Dice(0xB17E5);
    let mut junk: Vec<u8> = (0..65536).map(|_| dice.next(256) as u8).collect();
    let base = fs::read(bad("base.yaml")).unwrap();
    let mut large = base.clone();
    large.extend(std::iter::repeat_n(*b"# filled up\n", 1 << 20).flatten());
    let mut zero = base.clone();
    zero[30] = 0;
    let wide = format!("grashof: 1\nname: {}\nspace: plane\n", "x".repeat(500_000));
    let files: Vec<(&str, Vec<u8>)> = vec![
        ("nested-lists", ["[".repeat(deep), "]".repeat(deep)].concat().into_bytes()),
        ("nested-lists-open", format!("bodies: {}", "[".repeat(deep)).into_bytes()),
        ("nested-maps", format!("bodies: {}1{}", "{ a: ".repeat(deep), "}".repeat(deep)).into_bytes()),
        ("nested-dashes", "- ".repeat(deep).into_bytes()),
        ("nested-parentheses", [&base[..], b"  deep: ", "(".repeat(deep).as_bytes(), b"1", ")".repeat(deep).as_bytes(), b"\n"].concat()),
        ("binary-junk", junk.clone()),
        ("zero-byte", zero),
        ("too-large", large),
        ("long-line", wide.into_bytes()),
        ("utf-16", "grashof: 1\n".encode_utf16().flat_map(u16::to_le_bytes).collect()),
    ];
    for (name, bytes) in files {
        let file = format!("{name}.yaml");
        fs::write(here.0.join(&file), bytes).unwrap();
        let (code, stderr) = run(&here.0, &["run", &file, "-o", "OUT"], &out.0);
        verdict.demand(code == 2, name, &format!("exit code {code}"));
        verdict.demand(stderr.len() < 6000, name, &format!("{} bytes of message", stderr.len()));
        verdict.snapshot(name, &stderr);
        verdict.demand(!out.0.exists(), name, "something was written");
    }
    // any junk at all: without NUL, and ASCII alone
    for (kept, round) in [(1..=255_u8, 0), (9..=126, 1)].into_iter().flat_map(|(kept, _)| (0..6).map(move |round| (kept.clone(), round))) {
        junk.iter_mut().for_each(|b| *b = kept.start() + dice.next(usize::from(kept.end() - kept.start()) + 1) as u8);
        fs::write(here.0.join("junk.yaml"), &junk).unwrap();
        let (code, _) = run(&here.0, &["check", "junk.yaml"], &out.0);
        verdict.demand(code == 2, "junk", &format!("exit code {code} in round {round}"));
    }
    verdict.give();
}

/// A bad study does not keep the others from running: the highest code wins.
#[test]
fn the_other_studies_still_run() {
    for (file, kept) in [("statics-without-equilibrium", false), ("dead-point-on-the-way", true)] {
        let out = Scratch::new(&format!("others-{file}"));
        let (found, stderr) = run(&bad(""), &["run", &format!("{file}.yaml"), "-o", "OUT", "--no-plots"], &out.0);
        assert_eq!(found, 3, "{file}\n{stderr}");
        assert!(out.0.join("lengths.csv").is_file(), "{file}\n{stderr}");
        assert_eq!(out.0.join("turn.csv").is_file(), kept, "{file}");
    }
}

/// A warning alone stops nothing, and `-q` leaves it out.
#[test]
fn warnings_are_told() {
    let mut verdict = Verdict::default();
    let out = Scratch::new("warning");
    let (code, stderr) = run(&bad(""), &["run", "angle-in-degrees.yaml", "--study", "turn", "--no-plots", "-o", "OUT"], &out.0);
    verdict.demand(code == 0, "angle-in-degrees", &format!("exit code {code}"));
    verdict.snapshot("angle-in-degrees", &stderr);
    let (_, stderr) = run(&bad(""), &["run", "angle-in-degrees.yaml", "--study", "turn", "--no-plots", "-o", "OUT", "-q"], &out.0);
    verdict.demand(stderr.is_empty(), "angle-in-degrees", &format!("-q says {stderr}"));
    let (code, _) = run(&bad(""), &["check", "angle-in-degrees.yaml", "--strict"], &out.0);
    verdict.demand(code == 1, "angle-in-degrees", &format!("check --strict ends with {code}"));
    verdict.give();
}

/// Every message about a model says what to do.
#[test]
fn every_diagnostic_has_a_remedy() {
    let mut verdict = Verdict::default();
    for entry in fs::read_dir(bad("")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "txt") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let begins = |block: &&str| block.starts_with("error[") || block.starts_with("warning[");
        for block in text.split("\n\n").filter(begins) {
            verdict.demand(block.contains("= help: "), &path.display().to_string(), &format!("no remedy in\n{block}"));
        }
    }
    verdict.give();
}

/// Each file of the directory belongs to a test, so that no snapshot is forgotten.
#[test]
fn no_file_is_left_over() {
    let mut known: BTreeSet<String> =
        ["base.yaml", "compare.yaml", "solve.yaml", "angle-in-degrees.yaml", "angle-in-degrees.txt"].map(String::from).into();
    for name in FILES.iter().flat_map(|(_, names)| *names) {
        known.extend([format!("{name}.yaml"), format!("{name}.txt")]);
    }
    let generated = [
        "nested-lists",
        "nested-lists-open",
        "nested-maps",
        "nested-dashes",
        "nested-parentheses",
        "binary-junk",
        "zero-byte",
        "too-large",
        "long-line",
        "utf-16",
        "output-is-a-file",
        "output-below-a-file",
        "output-in-the-way",
    ];
    known.extend(ARGUMENTS.iter().map(|a| a.0).chain(generated).map(|name| format!("{name}.txt")));
    let found: BTreeSet<String> = fs::read_dir(bad("")).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(found.difference(&known).collect::<Vec<_>>(), Vec::<&String>::new(), "files without a test");
    if std::env::var_os("GRASHOF_BLESS").is_none() {
        assert_eq!(known.difference(&found).collect::<Vec<_>>(), Vec::<&String>::new(), "missing files");
    }
}
