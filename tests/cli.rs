//! The program as a person meets it: every command and flag, what it prints where, what it writes, and its exit code.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

mod codes;
mod doubts;
mod others;
mod shown;
#[cfg(unix)]
mod signals;
mod start;
mod streams;

/// A small four-bar with two studies and a sweep; `{}` stands for further lines of the study `turn`.
const MODEL: &str = "\
grashof: 1
name: four-bar
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { l1: 15 cm, l2: 1 m, l3: 55 cm, speed: 240 rpm }
ground: { O: [0, 0], C: [1 m, 0] }
bodies:
  crank: { bar: { length: l1, mass: 3 kg } }
  coupler: { bar: { length: l2, mass: 6 kg } }
  rocker: { bar: { length: l3, mass: 6 kg } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: O, speed: speed } }
start: { O.angle: 90 deg, coupler.angle: ~25 deg, rocker.angle: ~90 deg }
measures: { theta: crank.angle, phi3: rocker.angle }
variants:
  slow: { parameters: { speed: 60 rpm } }
studies:
  turn:
    inverse: { over: 1 turn, samples: 24 }
    columns: [theta, time, phi3, drive, det]
    undefined: [det]
    scalars: { swing: max(phi3) - min(phi3), mean_power: mean(drive.power) }
    plot: { angles: [phi3], torque: [drive.torque] }
  turn-again:
    undefined: [det]
    kinematics: { over: 1 turn, samples: 12 }
  lengths:
    kinematics: { over: 1 turn, samples: 12 }
    sweep: { l3: [10 cm, 50 cm, 55 cm, 5 m] }
    columns: [theta, phi3]
    scalars: { swing: max(phi3) - min(phi3) }
    plot: { phi3: [phi3] }
";

fn model() -> String {
    // undefined for part of the turn: empty fields
    MODEL.replace("phi3: rocker.angle }", "phi3: rocker.angle, det: sqrt(sin(theta)) }")
}

/// A fresh directory below the system's temporary one, removed at the end.
struct Place(PathBuf);

/// A finished run of the program.
struct Done {
    code: i32,
    stdout: String,
    stderr: String,
}

impl Place {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("grashof-cli-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// With the model in `model.yaml`.
    fn with_model(name: &str) -> Self {
        let place = Self::new(name);
        place.put("model.yaml", &model());
        place
    }

    fn put(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn files(&self, directory: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.0.join(directory)) else { return Vec::new() };
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        // the record of what was written, and the report, which has tests of its own
        names.retain(|name| name != ".grashof.json" && name != "report.html");
        names.sort();
        names
    }

    fn contents(&self, directory: &str) -> BTreeMap<String, Vec<u8>> {
        self.files(directory).into_iter().map(|name| (name.clone(), fs::read(self.0.join(directory).join(name)).unwrap())).collect()
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grashof"));
        command.args(arguments).current_dir(&self.0).env_remove("NO_COLOR").stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> Done {
        Done::of(self.command(arguments).output().unwrap())
    }

    fn run_with_input(&self, arguments: &[&str], input: &str) -> Done {
        let mut child = self.command(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
        Done::of(child.wait_with_output().unwrap())
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

impl Done {
    fn of(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
        let done = Self { code: output.status.code().unwrap_or(-1), stdout: text(output.stdout), stderr: text(output.stderr) };
        assert!(!done.stderr.contains("panicked"), "{}", done.stderr);
        done
    }

    #[track_caller]
    fn ends(self, code: i32) -> Self {
        assert_eq!(self.code, code, "stdout\n{}\nstderr\n{}", self.stdout, self.stderr);
        self
    }

    #[track_caller]
    fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {}", self.stdout))
    }
}

/// Header and fields of a CSV file whose fields hold no commas but for the last.
fn csv(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut lines = text.lines().map(|line| {
        let mut fields = vec![String::new()];
        let mut quoted = false;
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ',' if !quoted => fields.push(String::new()),
                c => fields.last_mut().unwrap().push(c),
            }
        }
        fields
    });
    (lines.next().unwrap(), lines.collect())
}

#[test]
fn help_shows_two_examples_of_each_command() {
    let place = Place::new("help");
    let whole = place.run(&["--help"]).ends(0);
    for word in ["run", "check", "new", "schema", "completions", "Exit codes", "130"] {
        assert!(whole.stdout.contains(word), "{word}\n{}", whole.stdout);
    }
    assert!(whole.stderr.is_empty());
    for command in ["run", "check", "new", "schema", "completions"] {
        for flag in ["--help", "-h"] {
            let help = place.run(&[command, flag]).ends(0);
            let examples = help.stdout.split("Examples:").nth(1).unwrap_or_else(|| panic!("{command}: no examples"));
            assert_eq!(examples.matches(&format!("  grashof {command}")).count(), 2, "{command}{examples}");
            assert!(help.stderr.is_empty());
        }
    }
    let flags = place.run(&["run", "--help"]).ends(0).stdout;
    for flag in
        ["--study", "--json", "--units", "--no-plots", "--output", "--set", "--variant", "--threads", "--quiet", "--verbose", "--color"]
    {
        assert!(flags.contains(flag), "{flag}\n{flags}");
    }
}

#[test]
fn version_and_no_command() {
    let place = Place::new("version");
    assert_eq!(place.run(&["--version"]).ends(0).stdout, format!("grashof {}\n", env!("CARGO_PKG_VERSION")));
    let nothing = place.run(&[]).ends(2);
    assert!(nothing.stdout.is_empty() && nothing.stderr.contains("Usage"), "{}", nothing.stderr);
}

#[test]
fn run_writes_whole_results() {
    let place = Place::with_model("whole");
    let done = place.run(&["run", "model.yaml", "-o", "out/deep"]).ends(0);
    assert!(done.stderr.is_empty(), "{}", done.stderr);
    for study in ["turn", "turn-again", "lengths"] {
        assert!(done.stdout.lines().any(|line| line == study), "{study}\n{}", done.stdout);
    }
    let expected = [
        "lengths-002.csv",
        "lengths-003.csv",
        "lengths-mechanism.png",
        "lengths-mechanism.svg",
        "lengths-phi3.png",
        "lengths-phi3.svg",
        "lengths.csv",
        "lengths.json",
        "turn-again-mechanism.png",
        "turn-again-mechanism.svg",
        "turn-again.csv",
        "turn-again.json",
        "turn-angles.png",
        "turn-angles.svg",
        "turn-mechanism.png",
        "turn-mechanism.svg",
        "turn-torque.png",
        "turn-torque.svg",
        "turn.csv",
        "turn.json",
    ];
    let found: Vec<String> = place.files("out/deep").into_iter().filter(|name| name != "lengths-001.csv").collect();
    assert_eq!(found, expected);
    for name in place.files("out/deep") {
        let bytes = fs::read(place.0.join("out/deep").join(&name)).unwrap();
        if name.ends_with(".png") {
            assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n", "{name}");
        } else if name.ends_with(".svg") {
            let text = String::from_utf8(bytes).unwrap();
            assert!(text.starts_with("<svg") || text.starts_with("<?xml"), "{name}");
            assert!(text.trim_end().ends_with("</svg>"), "{name}");
        }
    }
}

#[test]
fn tables_hold_numbers_alone() {
    let place = Place::with_model("numbers");
    place.run(&["run", "model.yaml", "-o", "out", "--no-plots"]).ends(0);
    let (names, rows) = csv(&place.text("out/turn.csv"));
    assert_eq!(names, ["theta", "time", "phi3", "drive.torque", "drive.power", "det"]);
    assert!(rows.len() >= 25, "{}", rows.len());
    let det: Vec<&str> = rows.iter().map(|row| row[5].as_str()).collect();
    assert!(det.contains(&"") && det.iter().any(|x| !x.is_empty()), "{det:?}");
    for row in &rows {
        assert_eq!(row.len(), names.len());
        for (name, field) in names.iter().zip(row) {
            let number = field.parse::<f64>().is_ok_and(f64::is_finite);
            assert!(number || field.is_empty() && name == "det", "{name}: {field:?}");
        }
    }
    assert_eq!(rows[0][0].parse::<f64>().unwrap(), std::f64::consts::FRAC_PI_2);
    let (names, rows) = csv(&place.text("out/lengths.csv"));
    assert_eq!(names, ["l3", "turns_fully", "swing", "reason"]);
    assert_eq!(rows.len(), 4);
    assert_eq!(rows.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), ["0.1", "0.5", "0.55", "5"]);
    for (row, turns) in rows.iter().zip([false, true, true, false]) {
        assert_eq!(row[1], if turns { "1" } else { "0" }, "{row:?}");
        assert_eq!(row[3].is_empty(), turns, "{row:?}");
        assert_eq!(turns, row[2].parse::<f64>().is_ok() && row[3].is_empty());
    }
}

#[test]
fn reports_have_the_promised_keys() {
    let place = Place::with_model("keys");
    place.run(&["run", "model.yaml", "-o", "out", "--no-plots"]).ends(0);
    for study in ["turn", "turn-again", "lengths"] {
        let report = place.json(&format!("out/{study}.json"));
        let keys: Vec<&str> = report.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(keys, ["study", "status", "parameters", "scalars", "extrema", "certificate", "findings"], "{study}");
        assert_eq!(report["study"], study);
        assert_eq!(report["status"], "done", "{study}");
        assert_eq!(report["parameters"]["l1"], 0.15);
        for finding in report["findings"].as_array().unwrap() {
            assert!(finding["code"].is_string() && finding["message"].is_string() && finding["path"].is_string(), "{finding}");
        }
    }
    let turn = place.json("out/turn.json");
    assert!(turn["scalars"]["swing"].is_f64() && turn["scalars"]["mean_power"].is_number());
    for column in ["phi3", "drive.torque"] {
        for end in ["min", "max"] {
            assert!(turn["extrema"][column][end]["value"].is_number() && turn["extrema"][column][end]["at"].is_number());
        }
    }
    let lengths = place.json("out/lengths.json");
    assert_eq!(lengths["scalars"]["turns_fully"], serde_json::json!([0, 1, 1, 0]));
    assert!(lengths["scalars"]["swing"][3].is_null(), "what is no number is null");
}

#[test]
fn the_default_directory_is_named_as_the_model() {
    let place = Place::with_model("default");
    fs::create_dir(place.0.join("sub")).unwrap();
    fs::copy(place.0.join("model.yaml"), place.0.join("sub/other.name.yaml")).unwrap();
    place.run(&["run", "model.yaml", "--study", "turn", "--no-plots"]).ends(0);
    assert_eq!(place.files("results/model"), ["turn.csv", "turn.json"]);
    place.run(&["run", "sub/other.name.yaml", "--study", "turn", "--no-plots"]).ends(0);
    assert_eq!(place.files("results/other.name"), ["turn.csv", "turn.json"]);
}

#[test]
fn stdin_is_a_model_too() {
    let place = Place::with_model("stdin");
    place.run(&["run", "model.yaml", "--study", "turn", "--no-plots", "-o", "file"]).ends(0);
    place.run_with_input(&["run", "-", "--study", "turn", "--no-plots", "-o", "out"], &model()).ends(0);
    assert_eq!(place.contents("out"), place.contents("file"));
    let check = place.run_with_input(&["check", "-"], &model()).ends(0);
    assert!(check.stdout.contains("four-bar"));
    let bad = place.run_with_input(&["check", "-"], "grashof: 1\nspce: planar\n").ends(2);
    assert!(bad.stderr.contains("<stdin>:2:1"), "{}", bad.stderr);
    place.run_with_input(&["run", "-", "--study", "turn", "--no-plots"], &model()).ends(0);
    assert_eq!(place.files("results/stdin"), ["turn.csv", "turn.json"]);
}

#[test]
fn studies_can_be_chosen() {
    let place = Place::with_model("chosen");
    let done = place.run(&["run", "model.yaml", "--study", "lengths", "--study", "turn", "--no-plots", "-o", "out"]).ends(0);
    let heads: Vec<&str> = done.stdout.lines().filter(|line| !line.starts_with(' ') && !line.is_empty()).collect();
    assert_eq!(heads, ["lengths", "turn"]);
    assert!(!place.files("out").iter().any(|name| name.starts_with("turn-again")));
    // one that is named twice runs once
    let done = place.run(&["run", "model.yaml", "--study", "turn", "--study", "turn", "--no-plots", "-o", "once"]).ends(0);
    assert_eq!(done.stdout.lines().filter(|line| *line == "turn").count(), 1, "{}", done.stdout);
    // an unknown one does not keep the known one from running
    let done = place.run(&["run", "model.yaml", "--study", "turns", "--study", "turn", "--no-plots", "-o", "two"]).ends(2);
    assert!(done.stderr.contains("turns") && done.stderr.contains("did you mean `turn`"), "{}", done.stderr);
    assert_eq!(place.files("two"), ["turn.csv", "turn.json"]);
}

#[test]
fn json_on_stdout_is_all_that_is_there() {
    let place = Place::with_model("json");
    let done = place.run(&["run", "model.yaml", "--json", "--no-plots", "-o", "out", "-v"]).ends(0);
    let reports = done.json();
    let names: Vec<&str> = reports.as_array().unwrap().iter().map(|r| r["study"].as_str().unwrap()).collect();
    assert_eq!(names, ["turn", "turn-again", "lengths"]);
    // digit by digit what stands in the files
    let stdout = done.stdout.replace("\n  ", "\n");
    for name in names {
        assert!(stdout.contains(place.text(&format!("out/{name}.json")).trim_end()), "{name}\n{stdout}");
    }
    // with an error, too
    let done = place.run(&["run", "model.yaml", "--json", "--study", "turns", "-o", "out"]).ends(2);
    let error = &done.json()[0];
    assert_eq!((error["study"].as_str(), error["status"].as_str()), (Some("turns"), Some("failed")));
    assert_eq!(error["errors"][0]["help"], "did you mean `turn`?");
    let check = place.run(&["check", "model.yaml", "--json"]).ends(0);
    let report = check.json();
    assert_eq!(report["name"], "four-bar");
    assert_eq!(report["degrees_of_freedom"], 1);
    assert_eq!(report["left_by_drivers"], 0);
    assert_eq!(report["bodies"].as_array().unwrap().len(), 3);
    assert_eq!(report["joints"].as_array().unwrap().len(), 4);
    assert_eq!(report["start"][0]["name"], "O.angle");
    assert!(report["findings"].is_array());
}

#[test]
fn units_quiet_verbose() {
    let place = Place::with_model("units");
    let base = ["run", "model.yaml", "--study", "turn", "--no-plots", "-o", "out"];
    let plain = place.run(&base).ends(0);
    assert!(plain.stderr.is_empty() && plain.stdout.contains("swing") && plain.stdout.contains("mean_power"), "{}", plain.stdout);
    assert!(plain.stdout.lines().any(|line| line.contains("mean_power") && line.ends_with('W')), "{}", plain.stdout);
    let units = place.run(&[&base[..], &["--units"]].concat()).ends(0);
    for line in ["theta [rad]", "time [s]", "phi3 [rad]", "drive.torque [N m]", "drive.power [W]", "det [1]"] {
        assert!(units.stdout.lines().any(|l| l.trim() == line), "{line}\n{}", units.stdout);
        assert!(!plain.stdout.contains(line));
    }
    let verbose = place.run(&[&base[..], &["-v"]].concat()).ends(0);
    assert!(verbose.stderr.contains("turn.csv") && verbose.stderr.contains("turn.json"), "{}", verbose.stderr);
    assert_eq!(verbose.stdout, plain.stdout);
    let quiet = place.run(&[&base[..], &["-q"]].concat()).ends(0);
    assert!(quiet.stderr.is_empty());
    assert_eq!(quiet.stdout, plain.stdout);
    // errors are told all the same
    let quiet = place.run(&["run", "model.yaml", "-q", "--set", "l9=1"]).ends(2);
    assert!(quiet.stderr.contains("l9"));
}

#[test]
fn colours_as_asked() {
    let place = Place::new("colour");
    place.put("bad.yaml", "grashof: 1\nspce: planar\n");
    let colored = |arguments: &[&str], no_color: Option<&str>| {
        let mut command = place.command(&[&["check", "bad.yaml"], arguments].concat());
        if let Some(value) = no_color {
            command.env("NO_COLOR", value);
        }
        Done::of(command.output().unwrap()).ends(2).stderr.contains('\x1b')
    };
    assert!(colored(&["--color", "always"], None));
    assert!(colored(&["--color", "always"], Some("1")), "what is asked for wins over the environment");
    for (arguments, no_color) in
        [(&["--color", "never"][..], None), (&["--color", "auto"], None), (&[], None), (&["--color", "auto"], Some("1"))]
    {
        assert!(!colored(arguments, no_color), "{arguments:?}: colours in a pipe");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_files() {
    let place = Place::with_model("threads");
    for (threads, out) in [("1", "one"), ("2", "two"), ("7", "seven")] {
        place.run(&["run", "model.yaml", "-j", threads, "-o", out]).ends(0);
    }
    let one = place.contents("one");
    assert!(one.len() > 15);
    for other in ["two", "seven"] {
        let found = place.contents(other);
        assert_eq!(one.keys().collect::<Vec<_>>(), found.keys().collect::<Vec<_>>());
        assert!(one.iter().all(|(name, bytes)| found[name] == *bytes), "files differ");
    }
}

impl Place {
    fn contents_of_files(&self, directory: &str) -> BTreeMap<String, Vec<u8>> {
        let path = self.0.join(directory);
        self.files(directory)
            .into_iter()
            .filter(|name| path.join(name).is_file())
            .map(|name| (name.clone(), fs::read(path.join(name)).unwrap()))
            .collect()
    }
}
