//! Sweeps: `grashof sweep`, sweeps of every kind of study, any number of threads, and runs that are kept over an interrupt.

mod elsewhere;
mod findings;

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A four-bar with a study of one run and sweeps of the same.
const FOUR_BAR: &str = "\
grashof: 1
name: four-bar
space: planar
gravity: none
parameters: { l1: 15 cm, l3: 55 cm, speed: 60 rpm }
ground: { O: [0, 0], C: [1 m, 0] }
bodies:
  crank: { bar: { length: l1 } }
  coupler: { bar: { length: 1 m } }
  rocker: { bar: { length: l3 } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: O, speed: speed } }
start: { O.angle: 90 deg, coupler.angle: ~25 deg, rocker.angle: ~90 deg }
measures: { phi3: rocker.angle }
studies:
  turn:
    kinematics: { over: 1 turn, samples: 24 }
    columns: [crank.angle, phi3]
    scalars: { swing: max(phi3) - min(phi3), fastest: max(rocker.omega) }
    expect: { swing: { is: 32.86316737556072 deg, within: 1e-9 } }
    plot: { phi3: [phi3] }
  lengths:
    kinematics: { over: 1 turn, samples: 24 }
    sweep: { l3: { from: 50 cm, to: 60 cm, count: 3 } }
    columns: [crank.angle, phi3]
    scalars: { swing: max(phi3) - min(phi3), fastest: max(rocker.omega) }
    plot: { phi3: [phi3] }
  speeds:
    kinematics: { over: 1 turn, samples: 24 }
    sweep: { speed: [60 rpm, 120 rpm] }
    columns: [crank.angle, phi3]
    scalars: { swing: max(phi3) - min(phi3), fastest: max(rocker.omega) }
    plot: { fastest: { show: [fastest], over: speed, in: rpm } }
";

/// A double pendulum that takes its time.
const PENDULUM: &str = "\
grashof: 1
name: double pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { mass: 1 kg, until: 20 s }
bodies:
  upper: { bar: { length: 1 m, mass: mass } }
  lower: { bar: { length: 0.7 m, mass: 0.8 kg } }
joints:
  P: { revolute: [ground, upper.start] }
  Q: { revolute: [upper.end, lower.start] }
start: { P.angle: 60 deg, Q.angle: -30 deg, P.omega: 0, Q.omega: 1 rad/s }
measures: { angle: P.angle, odd: sqrt(P.angle) }
studies:
  swings:
    dynamics: { until: until, every: until/50, tolerance: 1e-11 }
    sweep: { mass: [1 kg, 1.1 kg, -1 kg, 1.2 kg, 1.3 kg, 1.4 kg] }
    columns: [time, angle, odd, energy]
    undefined: [odd]
    scalars: { widest: max(abs(angle)), never: first(angle > 100 rad) }
    plot: { angle: [angle], widest: { show: [widest], over: mass } }
";

/// A fresh directory below the system's temporary one, removed at the end.
struct Place(PathBuf);

impl Place {
    fn new(name: &str, model: &str) -> Self {
        let path = std::env::temp_dir().join(format!("grashof-sweep-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("model.yaml"), model).unwrap();
        Self(path)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grashof"));
        command.args(arguments).current_dir(&self.0).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Runs the program, which must end with a code: stdout and stderr.
    fn ends(&self, code: i32, arguments: &[&str]) -> [String; 2] {
        let Output { status, stdout, stderr } = self.command(arguments).output().unwrap();
        let texts = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert_eq!(status.code(), Some(code), "{arguments:?}\n{}\n{}", texts[0], texts[1]);
        texts
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// The numbers of the columns of a CSV.
    fn rows(&self, name: &str, columns: usize) -> Vec<Vec<f64>> {
        let number = |field: &str| field.parse().unwrap_or(f64::NAN);
        self.text(name).lines().skip(1).map(|line| line.split(',').take(columns).map(number).collect()).collect()
    }

    /// All files of a directory but the record of what was written and the report, which has tests of its own.
    fn contents(&self, directory: &str) -> BTreeMap<String, Vec<u8>> {
        let Ok(entries) = fs::read_dir(self.0.join(directory)) else { return BTreeMap::new() };
        let entries = entries.map(|e| e.unwrap()).filter(|e| e.file_name() != ".grashof.json" && e.file_name() != "report.html");
        entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap())).collect()
    }

    fn names(&self, directory: &str) -> Vec<String> {
        self.contents(directory).into_keys().collect()
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn the_command_line_sweeps_as_the_file_does() {
    let place = Place::new("same", FOUR_BAR);
    place.ends(0, &["run", "model.yaml", "--study", "lengths", "-o", "file"]);
    let [stdout, stderr] = place.ends(0, &["sweep", "model.yaml", "--study", "turn", "--over", "l3=0.5..0.6:3", "-o", "line"]);
    assert!(stdout.starts_with("turn-over-l3\n"), "{stdout}");
    assert!(stderr.lines().count() == 1 && stderr.starts_with("note: what the file expects of its own values is not judged"), "{stderr}");
    let beginning = |names: Vec<String>, from: &str| names.into_iter().map(|n| n.replace(from, "*")).collect::<Vec<_>>();
    let mut file = beginning(place.names("file"), "lengths");
    // the drawn numbers of whole runs that the file does not ask for
    file.extend(["*-scalars.png".to_string(), "*-scalars.svg".to_string()]);
    file.sort();
    assert_eq!(beginning(place.names("line"), "turn-over-l3"), file);
    for part in [".csv", "-001.csv", "-002.csv", "-003.csv"] {
        assert_eq!(place.text(&format!("file/lengths{part}")), place.text(&format!("line/turn-over-l3{part}")));
    }
    assert_eq!(place.json("file/lengths.json")["scalars"], place.json("line/turn-over-l3.json")["scalars"]);
    // the study's own files and those of its sweeps do not get into each other's way
    place.ends(0, &["run", "model.yaml", "--study", "turn", "-o", "line"]);
    place.ends(0, &["sweep", "model.yaml", "--study", "turn", "--over", "l3=0.5,0.6", "-o", "line", "--no-plots"]);
    let names = place.names("line");
    assert!(names.contains(&"turn.csv".to_string()) && names.contains(&"turn-phi3.svg".to_string()), "{names:?}");
    assert!(!names.contains(&"turn-over-l3-003.csv".to_string()) && !names.contains(&"turn-over-l3-phi3.svg".to_string()), "{names:?}");
}

#[test]
fn every_form_of_values() {
    let place = Place::new("forms", FOUR_BAR);
    let swept = |over: &[&str], columns: usize| {
        let mut arguments = vec!["sweep", "model.yaml", "--study", "turn", "--no-plots", "-o", "out"];
        over.iter().for_each(|over| arguments.extend(["--over", over]));
        place.ends(0, &arguments);
        let stem = over.iter().map(|over| over.split('=').next().unwrap().trim()).collect::<Vec<_>>().join("+");
        place.rows(&format!("out/turn-over-{stem}.csv"), columns)
    };
    let close = |found: Vec<Vec<f64>>, right: &[&[f64]]| {
        assert_eq!(found.len(), right.len(), "{found:?}");
        for (found, right) in found.iter().flatten().zip(right.iter().copied().flatten()) {
            assert!((found - right).abs() <= 1e-15 * right.abs(), "{found} is not {right}");
        }
    };
    close(swept(&["l3=0.5..0.6:3"], 1), &[&[0.5], &[0.55], &[0.6]]);
    close(swept(&["l3=50cm..60cm:3"], 1), &[&[0.5], &[0.55], &[0.6]]);
    close(swept(&["l3 = 60 cm .. 50 cm : 2 : linear"], 1), &[&[0.6], &[0.5]]);
    close(swept(&["l3=0.3,40 cm,0.5"], 1), &[&[0.3], &[0.4], &[0.5]]);
    close(swept(&["l3=max(0.3 m, 2*l1)..4*l1:2"], 1), &[&[0.3], &[0.6]]);
    close(swept(&["l3=max(0.2 m, 3*l1),0.5"], 1), &[&[0.45], &[0.5]]);
    close(swept(&["l3=0.5"], 1), &[&[0.5]]);
    close(swept(&["l3=0.5..0.9:1"], 1), &[&[0.5]]);
    close(swept(&["speed=1..100:3:log"], 1), &[&[1.0], &[10.0], &[100.0]]);
    let grid: &[&[f64]] = &[&[0.5, 1.0], &[0.5, 2.0], &[0.6, 1.0], &[0.6, 2.0]];
    close(swept(&["l3=0.5,0.6", "speed=1,2"], 2), grid);
}

#[test]
fn what_runs_of_a_sweep_do_not_meet_is_told_with_the_run() {
    let lengths = "sweep: { l3: { from: 50 cm, to: 60 cm, count: 3 } }";
    let text = |l3: &str| {
        let expect = format!("sweep: {{ l3: [{l3}] }}\n    expect: {{ swing: {{ is: 32.86316737556072 deg, within: 1e-9 }} }}");
        FOUR_BAR.replace(lengths, &expect)
    };
    let place = Place::new("missed", &text("50 cm, 55 cm, 60 cm"));
    let [_, stderr] = place.ends(1, &["run", "model.yaml", "--study", "lengths", "-o", "out", "--no-plots"]);
    assert_eq!(stderr.matches("error[expectation]").count(), 1, "{stderr}");
    assert!(stderr.contains("in 2 of 3 runs, the first of them run 1 (l3 = 50 cm): `swing` is"), "{stderr}");
    fs::write(place.0.join("model.yaml"), text("55 cm, 5 m")).unwrap();
    let [_, stderr] = place.ends(0, &["run", "model.yaml", "--study", "lengths", "-o", "out", "--no-plots"]);
    assert!(stderr.contains("1 of the 2 runs of study `lengths` failed; what the file expects is not judged there"), "{stderr}");
}

#[test]
fn a_sweep_does_not_take_the_name_of_another_study() {
    let place = Place::new("name", &FOUR_BAR.replace("  lengths:\n", "  turn-over-l3:\n"));
    let [_, stderr] = place.ends(2, &["sweep", "model.yaml", "--study", "turn", "--over", "l3=0.5,0.6", "-o", "out"]);
    assert!(stderr.contains("would be named `turn-over-l3`, as a study of the file is"), "{stderr}");
    assert!(!place.0.join("out").exists());
}

#[test]
fn a_sweep_takes_the_place_of_the_study_s_own() {
    let place = Place::new("instead", FOUR_BAR);
    place.ends(0, &["sweep", "model.yaml", "--study", "speeds", "--over", "l3=0.5..0.6:3", "-o", "out"]);
    assert!(place.text("out/speeds-over-l3.csv").starts_with("l3,turns_fully,swing,fastest,reason\n"));
    assert_eq!(place.json("out/speeds-over-l3.json")["parameters"]["speed"].as_f64(), Some(std::f64::consts::TAU));
    // its figure over the speed is one over the length, in its unit
    let figure = place.text("out/speeds-over-l3-fastest.svg");
    assert!(figure.contains("l3") && !figure.contains("rpm"));
    // the same parameter keeps the axis
    place.ends(0, &["sweep", "model.yaml", "--study", "speeds", "--over", "speed=1..100:3:log", "-o", "out"]);
    assert!(place.text("out/speeds-over-speed-fastest.svg").contains("rpm"));
    // the only study need not be named
    let only = FOUR_BAR.split("  lengths:\n").next().unwrap();
    fs::write(place.0.join("only.yaml"), only).unwrap();
    place.ends(0, &["sweep", "only.yaml", "--over", "l3=0.5,0.6", "-o", "only", "--no-plots"]);
    let [stdout, _] = place.ends(0, &["sweep", "only.yaml", "--over", "l3=0.5,0.6", "-o", "only", "--no-plots", "--json"]);
    assert_eq!(serde_json::from_str::<Value>(&stdout).unwrap(), place.json("only/turn-over-l3.json"));
    let [_, stderr] = place.ends(2, &["sweep", "only.yaml"]);
    assert!(stderr.contains("--over <NAME=VALUES>"), "{stderr}");
    // other parameters come from outside
    place.ends(0, &["sweep", "only.yaml", "--over", "l3=0.5,0.6", "--set", "l1=0.1", "-o", "set", "--no-plots"]);
    assert_eq!(place.json("set/turn-over-l3.json")["parameters"]["l1"], 0.1);
}

/// A mass on a spring: natural frequency √(k/m), rest at −m g/k.
#[test]
fn lists_of_a_kind_are_lists_of_lists() {
    let model = "\
grashof: 1
name: mass on a spring
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { k: 100 N/m }
ground: { A: [0, 0] }
bodies: { mass: { mass: 2 kg } }
joints: { A: { slider: [ground.A, mass.origin], axis: [0, 1] } }
springs: { spring: { joint: A, stiffness: k, rest: 0 } }
start: { A.position: 0 }
studies:
  modes: { modes: { at: start }, sweep: { k: [50 N/m, 200 N/m] } }
  rest:
    statics: { from: start }
    sweep: { k: [50 N/m, 200 N/m] }
    columns: [A.position]
    scalars: { down: last(A.position) }
";
    let place = Place::new("lists", model);
    place.ends(0, &["run", "model.yaml", "-o", "out"]);
    let json = place.json("out/modes.json");
    for (k, stiffness) in [50.0, 200.0].into_iter().enumerate() {
        let list = json["scalars"]["eigenvalues"][k].as_array().unwrap();
        assert!(list.len() == 1 && (list[0].as_f64().unwrap() / (stiffness / 2.0) - 1.0).abs() < 1e-10, "{list:?}");
        let down = place.json("out/rest.json")["scalars"]["down"][k].as_f64().unwrap();
        assert!((down + 2.0 * 9.81 / stiffness).abs() < 1e-9, "{down}");
    }
    // of the results those that a mass alone has
    assert_eq!(place.text("out/modes.csv").lines().next(), Some("k,frequency_1,reason"));
    assert_eq!(json["scalars"].as_object().unwrap().keys().filter(|name| name.starts_with("frequency_")).count(), 1);
}

/// A pendulum whose every number with a range is a parameter.
const RANGES: &str = "\
grashof: 1
name: ranges
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { m1: 1 kg, i1: 0.1 kg m^2, r1: 10 cm, c1: 1 N m, s1: 1e-3 rad/s, e1: 0.5, k1: 100 N m/rad, d1: 1 N m s/rad, rho: 0.8, h1: 1 ms }
bodies:
  bob: { bar: { length: 1 m, mass: m1 }, attached: { rotor: { inertia: i1 } } }
  wheel: { disc: { radius: r1, mass: 1 kg } }
joints:
  P: { revolute: [ground, bob.start], friction: { coulomb: c1, stick_speed: s1 }, limits: { from: -80 deg, restitution: e1 } }
  Q: { revolute: [bob.end, wheel.origin], limits: { from: -1 turn, stiffness: k1, damping: d1 } }
start: { P.angle: -60 deg }
studies:
  swing: { dynamics: { until: 0.1 s, every: 0.05 s, integrator: generalized-alpha, rho: rho, step: h1 }, columns: [time, energy] }
";

#[test]
fn what_is_out_of_its_range_is_a_row_with_its_reason() {
    let place = Place::new("ranges", RANGES);
    for (parameter, good, bad, reason) in [
        ("m1", "1", "-1", "`bodies.bob.bar.mass`: the mass is -1"),
        ("i1", "0", "-1", "`bodies.bob.attached.rotor.inertia`: the inertia is -1"),
        ("r1", "0.1", "-1", "`bodies.wheel.disc.radius`: the radius is -1"),
        ("c1", "0", "-1", "`joints.P.friction.coulomb`: the friction is -1"),
        ("s1", "1", "0", "`joints.P.friction.stick_speed`: the speed is 0"),
        ("e1", "1", "2", "`joints.P.limits.restitution`: the restitution is 2"),
        ("k1", "1", "-100", "`joints.Q.limits.stiffness`: the stiffness is -100"),
        ("d1", "0", "-1", "`joints.Q.limits.damping`: the damping is -1"),
        ("rho", "1", "2", "`studies.swing.dynamics.rho`: rho is 2"),
        ("h1", "0.01", "0", "`studies.swing.dynamics.step`: the step is 0"),
    ] {
        let [_, refused] = place.ends(2, &["check", "model.yaml", "--set", &format!("{parameter}={bad}")]);
        assert!(reason.ends_with(refused.lines().next().unwrap().split("]: ").nth(1).unwrap()), "{refused}");
        place.ends(0, &["sweep", "model.yaml", "--over", &format!("{parameter}={good},{bad}"), "-o", "out", "--no-plots"]);
        let rows = place.text(&format!("out/swing-over-{parameter}.csv"));
        let rows: Vec<&str> = rows.lines().skip(1).map(|row| row.split_once(',').unwrap().1).collect();
        assert_eq!(rows, ["", reason], "{parameter}");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let place = Place::new("threads", PENDULUM);
    for threads in ["1", "2", "3"] {
        let set = ["--set", "until=2 s", "-j", threads, "-o", threads];
        place.ends(0, &[&["run", "model.yaml"], &set[..]].concat());
    }
    assert!(place.contents("1").len() > 10);
    assert!(place.contents("1") == place.contents("2") && place.contents("1") == place.contents("3"));
    let reasons: Vec<bool> = place.text("1/swings.csv").lines().skip(1).map(|line| !line.ends_with(',')).collect();
    assert_eq!(reasons, [false, false, true, false, false, false]);
}

#[test]
fn shards_together_are_the_whole() {
    let place = Place::new("shards", PENDULUM);
    let set = ["--set", "until=2 s"];
    let run = |code: i32, arguments: &[&str]| place.ends(code, &[arguments, &["model.yaml"], &set].concat());
    run(0, &["run", "-o", "whole"]);
    let [stdout, stderr] = run(0, &["run", "--shard", "1/3", "-o", "one"]);
    assert_eq!(stdout, "");
    assert!(stderr.contains("shard 1/3: 2 of 6 runs are in one/swings.1-of-3.partial; `grashof gather` writes"), "{stderr}");
    run(0, &["run", "--shard", "3/3", "-o", "three", "-j", "1"]);
    assert_eq!(place.names("three"), ["swings.3-of-3.partial"]);

    // a shard that is not there, or not finished, is missed; its runs are named and nothing is written
    let gather = ["gather", "--from", "one", "--from", "three", "-o", "all", "-j", "3"];
    let [_, stderr] = run(2, &gather);
    assert!(stderr.contains("study `swings` lacks 2 of its 6 runs: 2, 5"), "{stderr}");
    assert!(place.names("all").is_empty());
    run(0, &["run", "--shard", "2/3", "-o", "all", "-j", "1"]);
    let path = place.0.join("all/swings.2-of-3.partial");
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() - 17]).unwrap();
    let [_, stderr] = run(2, &gather);
    assert!(stderr.contains("study `swings` lacks 1 of its 6 runs: 5"), "{stderr}");
    let [_, stderr] = run(0, &["run", "--shard", "2/3", "-o", "all", "-j", "1"]);
    assert!(stderr.contains("resumed: 1 of 2 runs were there"), "{stderr}");
    assert_eq!(fs::read(&path).unwrap(), bytes, "a shard that went on is that of one run");

    // one that never began, for its reason, is in no file; what lies in another directory stays there
    let [_, stderr] = run(0, &gather);
    assert!(!stderr.contains("lacks"), "{stderr}");
    assert!(place.contents("all") == place.contents("whole"), "{:?}", place.names("all"));
    assert_eq!(place.names("one"), ["swings.1-of-3.partial"]);
}

#[test]
fn shards_of_the_command_line_and_of_other_models() {
    let place = Place::new("shards-line", FOUR_BAR);
    let sweep = ["sweep", "model.yaml", "--study", "turn", "--over", "l3=0.5..0.6:4"];
    place.ends(0, &[&sweep[..], &["-o", "whole"]].concat());
    for shard in ["1/2", "2/2"] {
        place.ends(0, &[&sweep[..], &["-o", "parts", "--shard", shard]].concat());
    }
    place.ends(0, &[&["gather"], &sweep[1..], &["-o", "parts"]].concat());
    assert!(place.contents("parts") == place.contents("whole"), "{:?}", place.names("parts"));

    // without a study, all sweeps of the file; a file of another model is named, not used and not removed
    place.ends(0, &["run", "model.yaml", "--shard", "1/1", "-o", "old"]);
    assert_eq!(place.names("old"), ["lengths.1-of-1.partial", "speeds.1-of-1.partial"]);
    fs::write(place.0.join("model.yaml"), FOUR_BAR.replace("15 cm", "16 cm")).unwrap();
    let [_, stderr] = place.ends(2, &["gather", "model.yaml", "--study", "lengths", "-o", "old"]);
    assert!(stderr.contains("lengths.1-of-1.partial is of another model, study or version, or broken: it is not used"), "{stderr}");
    assert!(stderr.contains("study `lengths` lacks 3 of its 3 runs: 1, 2, 3"), "{stderr}");
    assert!(place.names("old").contains(&"lengths.1-of-1.partial".to_owned()));

    let [_, stderr] = place.ends(2, &["run", "model.yaml", "--study", "turn", "--shard", "1/2"]);
    assert!(stderr.contains("study `turn` is no sweep, which could be cut"), "{stderr}");
    let [_, stderr] = place.ends(2, &["run", "model.yaml", "--shard", "3/2"]);
    assert!(stderr.contains("3/2") && stderr.contains("`2/8`"), "{stderr}");
}

#[cfg(unix)]
mod interrupted {
    use super::*;
    use std::process::Child;
    use std::time::Duration;

    /// Ends of the records of a file of finished runs, whole ones alone.
    fn records(bytes: &[u8]) -> Vec<usize> {
        let mut ends = Vec::new();
        let mut at = 16;
        while let Some(head) = bytes.get(at..at + 8) {
            at += 16 + u64::from_le_bytes(head.try_into().unwrap()) as usize;
            if at > bytes.len() {
                break;
            }
            ends.push(at);
        }
        ends
    }

    /// Begins a sweep and waits until two of its runs are kept; none if it was faster than that.
    fn begun(place: &Place, directory: &str, until: &str) -> Option<Child> {
        let arguments = ["run", "model.yaml", "-o", directory, "-j", "1", "--set", until];
        let mut child = place.command(&arguments).spawn().unwrap();
        let path = place.0.join(directory).join("swings.partial");
        while fs::read(&path).map_or(0, |bytes| records(&bytes).len()) < 2 {
            if child.try_wait().unwrap().is_some() {
                return None;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        Some(child)
    }

    /// A sweep that was interrupted by a signal when some of its runs were kept, and its length. It is made longer until the
    /// signal comes in time.
    fn cut(place: &Place, signal: &str) -> (String, Option<i32>, String) {
        for until in ["until=5", "until=50", "until=500", "until=5000"] {
            let _ = fs::remove_dir_all(place.0.join("cut"));
            let Some(child) = begun(place, "cut", until) else { continue };
            assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
            let output = child.wait_with_output().unwrap();
            if output.status.code() != Some(0) {
                return (until.into(), output.status.code(), String::from_utf8(output.stderr).unwrap());
            }
        }
        panic!("no sweep was long enough");
    }

    #[test]
    fn the_same_command_goes_on_where_it_was_interrupted() {
        let place = Place::new("interrupt", PENDULUM);
        let (until, code, stderr) = cut(&place, "-INT");
        assert_eq!(code, Some(130), "{stderr}");
        assert_eq!(place.names("cut"), ["swings.partial"]);
        let partial = place.contents("cut").remove("swings.partial").unwrap();
        let ends = records(&partial);
        let told = format!("kept: {} of 6 runs, from which the same command goes on", ends.len());
        assert!(stderr.contains(&told) && stderr.contains("interrupted: study `swings` is not written"), "{stderr}");

        let again = |directory: &str, bytes: &[u8], set: &[&str]| {
            fs::create_dir_all(place.0.join(directory)).unwrap();
            fs::write(place.0.join(directory).join("swings.partial"), bytes).unwrap();
            let [_, stderr] = place.ends(0, &[&["run", "model.yaml", "-o", directory, "--set", &until], set].concat());
            stderr
        };
        place.ends(0, &["run", "model.yaml", "-o", "whole", "--set", &until]);
        let whole = place.contents("whole");
        let resumed = |n: usize| format!("resumed: {n} of 6 runs were there");

        // figures and curves too, with another number of threads
        let stderr = again("again", &partial, &["-j", "2"]);
        assert!(stderr.contains(&resumed(ends.len())), "{stderr}");
        assert!(place.contents("again") == whole, "{:?} is not {:?}", place.names("again"), whole.keys());
        // the last record is torn; a byte of the second one is another
        let stderr = again("torn", &partial[..ends[ends.len() - 1] - 3], &[]);
        assert!(stderr.contains(&resumed(ends.len() - 1)), "{stderr}");
        assert!(place.contents("torn") == whole);
        let mut damaged = partial.clone();
        damaged[ends[0] + 40] ^= 1;
        let stderr = again("damaged", &damaged, &[]);
        assert!(stderr.contains(&resumed(1)), "{stderr}");
        assert!(place.contents("damaged") == whole);
        // no head, and another model
        let note = "swings.partial is of another model, study or version, or broken: it is not used";
        assert!(again("short", &partial[..9], &[]).contains(note));
        assert!(place.contents("short") == whole);
        fs::write(place.0.join("model.yaml"), PENDULUM.replace("0.7 m", "0.6 m")).unwrap();
        let stderr = again("other", &partial, &[]);
        assert!(stderr.contains(note) && !stderr.contains("resumed"), "{stderr}");
        assert!(place.contents("other").len() == whole.len() && place.contents("other") != whole);
        // a comment decides nothing
        fs::write(place.0.join("model.yaml"), PENDULUM.replace("studies:", "# what is computed\nstudies:")).unwrap();
        assert!(again("comment", &partial, &["--no-plots"]).contains(&resumed(ends.len())));
    }

    #[test]
    fn a_kill_leaves_what_was_finished() {
        let place = Place::new("kill", PENDULUM);
        let (until, code, _) = cut(&place, "-KILL");
        assert_eq!(code, None);
        assert_eq!(place.names("cut"), ["swings.partial"]);
        let [_, stderr] = place.ends(0, &["run", "model.yaml", "-o", "cut", "--set", &until, "--no-plots"]);
        assert!(stderr.contains("resumed: ") && stderr.contains(" of 6 runs were there"), "{stderr}");
        place.ends(0, &["run", "model.yaml", "-o", "whole", "--set", &until, "--no-plots"]);
        assert!(place.contents("cut") == place.contents("whole"));
    }
}
