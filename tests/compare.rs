//! `grashof compare` and `grashof run --verify`: what they write and say, and whether it is true.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A double pendulum: with a tolerance, with rows at every step, with steps far too long and good ones, swept, and for very long.
const MODEL: &str = "\
grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { mass: 1 kg }
bodies:
  rod: { bar: { length: 1 m, mass: mass } }
  lower: { bar: { length: 0.7 m, mass: 0.8 kg } }
joints:
  P: { revolute: [ground, rod.start] }
  Q: { revolute: [rod.end, lower.start] }
start: { P.angle: -20 deg, Q.angle: -30 deg, P.omega: 0, Q.omega: 1 rad/s }
measures: { below: sign(P.angle - 10 rad) }
studies:
  swing:
    dynamics: { until: 2 s, every: 50 ms, tolerance: 1e-8 }
    columns: [time, P.angle, Q.angle, P.omega, energy]
  all-steps:
    dynamics: { until: 1 s, integrator: bdf, tolerance: 1e-6 }
    columns: [time, P.angle]
  loose:
    dynamics: { until: 2 s, every: 50 ms, integrator: rk4, step: 0.2 s }
    columns: [time, Q.omega]
  silent:
    dynamics: { until: 2 s, every: 50 ms, integrator: rk4, step: 0.2 s }
    columns: [time]
  summed:
    dynamics: { until: 2 s, every: 50 ms, integrator: rk4, step: 0.2 s }
    columns: [time, below]
    scalars: { fast: max(Q.omega) }
  fixed:
    dynamics: { until: 1 s, integrator: rk4, step: 5 ms }
    columns: [time, P.angle, Q.angle]
  masses:
    dynamics: { until: 1 s, every: 0.1 s }
    sweep: { mass: [1 kg, 2 kg] }
    columns: [time, P.angle]
  wild:
    dynamics: { until: 200 s, every: 1 s, tolerance: 1e-6 }
    columns: [time, Q.omega]
";

/// A directory of its own, removed at the end.
struct Place(PathBuf);

/// A finished run.
struct Done {
    code: i32,
    stdout: String,
    stderr: String,
}

impl Place {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("grashof-compare-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("model.yaml"), MODEL).unwrap();
        Self(path)
    }

    fn run(&self, arguments: &[&str]) -> Done {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grashof"));
        let output = command.args(arguments).current_dir(&self.0).stdin(Stdio::null()).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Done { code: output.status.code().unwrap_or(-1), stdout: text(output.stdout), stderr: text(output.stderr) }
    }

    fn compare(&self, arguments: &[&str]) -> Done {
        self.run(&[&["compare", "model.yaml", "-o", "out"], arguments].concat())
    }

    fn verify(&self, study: &str, arguments: &[&str]) -> Done {
        self.run(&[&["run", "model.yaml", "-o", "out", "--no-plots", "--verify", "--study", study], arguments].concat())
    }

    fn files(&self) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.0.join("out")) else { return Vec::new() };
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        // the record of what was written, and the report, which has tests of its own
        names.retain(|name| name != ".grashof.json" && name != "report.html");
        names.sort();
        names
    }

    /// Header and rows of the comparison that has been written.
    fn rows(&self) -> (Vec<String>, Vec<Vec<String>>) {
        let name = self.files().into_iter().find(|name| name.ends_with("-compare.csv")).unwrap();
        let text = fs::read_to_string(self.0.join("out").join(name)).unwrap();
        let mut lines = text.lines().map(|l| l.split(',').map(String::from).collect::<Vec<_>>());
        (lines.next().unwrap(), lines.collect())
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

impl Done {
    #[track_caller]
    fn refused(&self, parts: &[&str]) {
        assert_eq!(self.code, 2, "{}\n{}", self.stdout, self.stderr);
        assert_eq!(self.stdout, "");
        parts.iter().for_each(|part| assert!(self.stderr.contains(part), "{part} is not in\n{}", self.stderr));
        assert!(self.stderr.contains("help: "), "{}", self.stderr);
    }

    /// Digits of the line of `--verify`, in its order.
    #[track_caller]
    fn digits(&self) -> Vec<f64> {
        let line = self.stdout.lines().find(|l| l.contains("verify:")).unwrap_or_else(|| panic!("{}\n{}", self.stdout, self.stderr));
        line.split("verify:").nth(1).unwrap().split(';').map(|p| p.split_whitespace().next().unwrap().parse().unwrap()).collect()
    }
}

#[test]
fn errors_follow_the_tolerance_for_every_scheme() {
    let place = Place::new("errors");
    let done = place.compare(&["--study", "swing", "--integrators", "dop853,radau5,bdf,rk4", "--tolerances", "1e-4..1e-8"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert_eq!(place.files(), ["swing-compare.csv", "swing-compare.png", "swing-compare.svg"]);
    let (head, rows) = place.rows();
    let wanted =
        "integrator,tolerance,time,evaluations,steps,rejected,factorisations,error,energy_drift,constraint_drift,velocity_drift,reason";
    assert_eq!(head.join(","), wanted);
    assert_eq!(rows.len(), 20);
    for row in &rows {
        let [tolerance, time, evaluations, steps, error, drift] = [1, 2, 3, 4, 7, 8].map(|i| row[i].parse::<f64>().unwrap());
        assert!(time > 0.0 && evaluations >= steps && steps > 3.0, "{row:?}");
        assert!(error <= 1000.0 * tolerance && error > 0.0, "{row:?}");
        assert!(drift <= 3000.0 * tolerance, "{row:?}");
        assert_eq!(row[11], "");
    }
    for scheme in rows.chunks(5) {
        let error = |k: usize| scheme[k][7].parse::<f64>().unwrap();
        assert!(error(4) < 0.01 * error(0), "{scheme:?}");
    }
    for word in ["dop853", "radau5", "bdf", "rk4", "tolerance", "agree to", "evaluations"] {
        assert!(done.stdout.contains(word), "{word}: {}", done.stdout);
    }
    let svg = fs::read_to_string(place.0.join("out/swing-compare.svg")).unwrap();
    for word in [">error<", ">time in ", ">evaluations<", ">radau5<"] {
        assert!(svg.contains(word), "{word}");
    }
}

#[test]
fn comparisons_of_two_studies_stand_side_by_side() {
    let place = Place::new("beside");
    for (study, size) in [("swing", "--tolerances"), ("fixed", "--steps")] {
        let done = place.compare(&["--study", study, "--integrators", "rk4", size, "1e-3"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
    }
    let ends = ["csv", "png", "svg"];
    let names: Vec<String> = ["fixed", "swing"].iter().flat_map(|study| ends.map(|end| format!("{study}-compare.{end}"))).collect();
    assert_eq!(place.files(), names);
    // one curve has no legend: the title names it
    let svg = fs::read_to_string(place.0.join("out/swing-compare.svg")).unwrap();
    assert!(svg.contains("swing by rk4: work over error"), "{svg}");
}

#[test]
fn fixed_steps_show_the_order() {
    let place = Place::new("steps");
    let list = "0.01,0.005,0.0025";
    let done =
        place.compare(&["--study", "fixed", "--integrators", "rk4,newmark,central-difference", "--steps", list, "--json", "--no-plots"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert_eq!(place.files(), ["fixed-compare.csv"]);
    let json: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(json["study"], "fixed");
    assert!(json["references_agree"].as_f64().unwrap() < 1e-8);
    let runs = json["runs"].as_array().unwrap();
    assert_eq!(runs.len(), 9);
    for (scheme, order) in runs.chunks(3).zip([4.0, 2.0, 2.0]) {
        let error = |k: usize| scheme[k]["error"].as_f64().unwrap();
        let found = (error(1) / error(2)).log2();
        assert!((found - order).abs() < 0.4, "{order}: {found}, {scheme:?}");
        assert_eq!(scheme[2]["step"].as_f64(), Some(0.0025));
        assert_eq!(scheme[2]["steps"].as_f64(), Some(400.0));
    }
    // the end of a range is compared, also within a decade
    let done = place.compare(&["--study", "fixed", "--integrators", "rk4", "--steps", "2e-2..5e-3", "--json", "--no-plots"]);
    let json: Value = serde_json::from_str(&done.stdout).unwrap();
    let steps: Vec<f64> = json["runs"].as_array().unwrap().iter().filter_map(|run| run["step"].as_f64()).collect();
    assert_eq!(steps, [0.02, 0.005]);
}

#[test]
fn what_cannot_be_compared_is_refused_before_anything_runs() {
    let place = Place::new("refused");
    place.compare(&["--study", "nope"]).refused(&["unknown study `nope`", "known: `swing`"]);
    place.compare(&["--study", "swing", "--integrators", "rk5"]).refused(&["no integrator `rk5`", "`radau5`", "`ida`"]);
    place.compare(&["--study", "masses"]).refused(&["study `masses` has many runs", "--set"]);
    place.compare(&["--study", "swing", "--tolerances", "1e-3..0"]).refused(&["--tolerances 1e-3..0", "`0` cannot be used"]);
    place.compare(&["--study", "swing", "--tolerances", "0.5"]).refused(&["at most 0.1"]);
    place.compare(&["--study", "swing", "--steps", "1e-300..1"]).refused(&["more than 40"]);
    place.compare(&["--study", "swing", "--integrators", "central-difference"]).refused(&["takes fixed steps", "--steps"]);
    if !cfg!(feature = "sundials") {
        place.compare(&["--study", "swing", "--integrators", "ida"]).refused(&["SUNDIALS", "cargo build --release --features sundials"]);
    }
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/crank_rocker.yaml");
    let done = place.run(&["compare", shipped.to_str().unwrap(), "--study", "one-turn", "-o", "out"]);
    done.refused(&["study `one-turn` is no motion in time", "`dynamics`"]);
    let both = place.compare(&["--study", "swing", "--steps", "1e-3", "--tolerances", "1e-3"]);
    assert_eq!(both.code, 2, "{}", both.stderr);
    assert!(place.files().is_empty());
}

#[test]
fn a_run_that_fails_is_a_row_with_its_reason() {
    let place = Place::new("reason");
    let done = place.compare(&["--study", "fixed", "--integrators", "radau5", "--steps", "0.005,0.9", "--no-plots"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let (_, rows) = place.rows();
    assert_eq!(rows.len(), 2);
    assert_eq!(rows[0][11], "");
    assert!(rows[1][2..11].iter().all(String::is_empty) && rows[1][11..].join(",").contains("Newton"), "{rows:?}");
    let done = place.compare(&["--study", "fixed", "--integrators", "radau5", "--steps", "0.9", "--no-plots"]);
    assert_eq!(done.code, 3, "{}", done.stderr);
    assert!(done.stderr.contains("no integrator finished study `fixed`"), "{}", done.stderr);
}

#[test]
fn chaos_has_no_reference() {
    let place = Place::new("chaos");
    let text = fs::read_to_string(place.0.join("model.yaml")).unwrap();
    let wild = text.replace("P.angle: -20 deg, Q.angle: -30 deg", "P.angle: 80 deg, Q.angle: 20 deg");
    fs::write(place.0.join("model.yaml"), wild).unwrap();
    let done = place.compare(&["--study", "wild", "--tolerances", "1e-4"]);
    assert_eq!(done.code, 3, "{}\n{}", done.stdout, done.stderr);
    assert!(done.stderr.contains("differ by") && done.stderr.contains("shorter motion"), "{}", done.stderr);
    assert!(place.files().is_empty());
    let done = place.verify("wild", &[]);
    assert_eq!(done.code, 1, "{}\n{}", done.stdout, done.stderr);
    assert!(done.stdout.contains("0 digits, because `Q.omega` is "), "{}", done.stdout);
    assert_eq!(done.digits(), [0.0, 0.0]);
}

#[test]
fn verified_digits_are_those_of_the_error() {
    let place = Place::new("verify");
    for (study, from, to) in [("swing", 6.5, 11.0), ("all-steps", 3.5, 8.0), ("fixed", 6.0, 11.0)] {
        let done = place.verify(study, &[]);
        assert_eq!(done.code, 0, "{}\n{}", done.stdout, done.stderr);
        let digits = done.digits();
        assert_eq!(digits.len(), 2, "{}", done.stdout);
        assert!(digits.iter().all(|d| (from..to).contains(d)), "{study}: {}", done.stdout);
        // both ways see the error of the same run
        assert!((digits[0] - digits[1]).abs() < 1.5, "{study}: {}", done.stdout);
    }
    let done = place.verify("swing", &[]);
    assert!(done.stdout.contains("against tolerance 1e-9; ") && done.stdout.contains("against radau5"), "{}", done.stdout);
    let done = place.verify("all-steps", &[]);
    assert!(done.stdout.contains("against dop853"), "{}", done.stdout);
    let done = place.verify("masses", &[]);
    assert!(done.stdout.contains("(the worst of 2 runs)"), "{}", done.stdout);
}

#[test]
fn steps_that_are_far_too_long_are_found_out() {
    let place = Place::new("loose");
    let done = place.verify("loose", &[]);
    assert_eq!(done.code, 1, "{}\n{}", done.stdout, done.stderr);
    assert!(done.stdout.contains("0 digits, because `Q.omega` is "), "{}", done.stdout);
    assert_eq!(place.files(), ["loose.csv", "loose.json"]);
}

#[test]
fn json_stays_json() {
    let place = Place::new("json");
    let done = place.verify("swing", &["--json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let json: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(json[0]["study"], "swing");
    assert!(done.stderr.contains("swing: verify: "), "{}", done.stderr);
}

/// Moments about a ball joint are zero but for rounding: they have no digits to lose beside the forces of the mechanism.
#[test]
fn what_is_zero_in_a_motion_is_no_disagreement() {
    let place = Place::new("zero");
    let text = "grashof: 1
name: ball joint
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: { P: [1.0, 2.0, 3.0] }
bodies:
  pend: { mass: 1 kg, inertia: [0.1, 0.04, 0.1], points: { J: [0.0, -2.0, 0.0] } }
  link: { points: { e: [2.0, 0.0, 0.0] } }
joints: { R: { revolute: [ground.P, link.origin], axis: [0, 1, 1] }, J: { spherical: [link.e, pend.J] } }
start: { pend.x: 3 m, pend.y: 4 m, pend.z: 3 m, R.angle: 0 }
studies: { run: { dynamics: { until: 2 s, every: 0.1 s, tolerance: 1e-10 }, columns: [time, pend.x, pend.wx, J] } }
";
    fs::write(place.0.join("model.yaml"), text).unwrap();
    let done = place.verify("run", &[]);
    assert_eq!(done.code, 0, "{}\n{}", done.stdout, done.stderr);
    assert!(done.digits().iter().all(|d| *d > 5.0), "{}", done.stdout);
}

/// The only motion in time of one run is compared without being named; sweeps and other kinds do not count.
#[test]
fn the_only_motion_in_time_need_not_be_named() {
    let place = Place::new("only");
    let done = place.compare(&["--no-plots"]);
    done.refused(&["the model has 7 motions in time", "name one with `--study`", "`swing`, `all-steps`"]);
    let (head, _) = MODEL.split_once("  all-steps:").unwrap();
    let (_, masses) = MODEL.split_once("  masses:").unwrap();
    let (masses, _) = masses.split_once("  wild:").unwrap();
    let rests = "  rests: { statics: { from: start } }\n";
    let only = format!("{head}  masses:{masses}{rests}");
    fs::write(place.0.join("model.yaml"), &only).unwrap();
    let arguments = ["--integrators", "dop853,bdf", "--tolerances", "1e-5,1e-7", "--no-plots"];
    let done = place.compare(&arguments);
    assert_eq!(done.code, 0, "{}\n{}", done.stdout, done.stderr);
    let (_, rows) = place.rows();
    assert_eq!(rows.len(), 4);
    // its errors are those of the study that it is
    let named = place.compare(&[&["--study", "swing"][..], &arguments].concat());
    let errors = |rows: &[Vec<String>], header: &[String]| -> Vec<String> {
        let column = header.iter().position(|name| name.starts_with("error")).unwrap();
        rows.iter().map(|row| row[column].clone()).collect()
    };
    let (header, again) = place.rows();
    assert_eq!((named.code, errors(&rows, &header)), (0, errors(&again, &header)));
    fs::write(place.0.join("model.yaml"), format!("{}studies:\n{rests}", MODEL.split_once("studies:").unwrap().0)).unwrap();
    place.compare(&[]).refused(&["no motion in time of one run"]);
}

#[test]
fn a_motion_is_judged_where_columns_do_not_show_it() {
    let place = Place::new("silent");
    let done = place.verify("silent", &[]);
    assert!(done.code == 1 && done.stdout.contains("0 digits, because `"), "{}", done.stdout);
    let done = place.verify("summed", &[]);
    assert!(done.stdout.contains(" digits against ") && !done.stdout.contains("16.0 digits"), "{}", done.stdout);
    let done = place.compare(&["--study", "silent", "--no-plots", "--steps", "0.2,1e-3", "--integrators", "rk4", "--json"]);
    let json: Value = serde_json::from_str(&done.stdout).unwrap();
    assert!(json["runs"][0]["error"].as_f64().unwrap() > 1e-3, "{json}");
}
