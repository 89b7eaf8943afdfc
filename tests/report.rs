//! The report page: what `run` writes, that it is whole, and that the same run gives the same bytes. Browsers are in `tests/browser`.

use flate2::read::GzDecoder;
use serde_json::Value;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A fresh directory below the system's temporary one, removed at the end.
struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("grashof-report-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Runs a model of `models/` into the directory.
    fn run(&self, model: &str, more: &[&str]) -> Output {
        let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(model);
        let mut command = Command::new(env!("CARGO_BIN_EXE_grashof"));
        command.arg("run").arg(model).args(["--no-plots", "-q", "-o"]).arg(&self.0).args(more);
        command.output().unwrap()
    }

    fn page(&self) -> Option<String> {
        fs::read_to_string(self.0.join("report.html")).ok()
    }

    fn data(&self) -> Value {
        data(&self.page().unwrap())
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The data of a page.
fn data(page: &str) -> Value {
    let text = page.split_once("id=\"data\">").unwrap().1.split_once('<').unwrap().0;
    let mut json = String::new();
    GzDecoder::new(&bytes(text)[..]).read_to_string(&mut json).unwrap();
    serde_json::from_str(&json).unwrap()
}

/// The bytes of base64 text.
fn bytes(text: &str) -> Vec<u8> {
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let value = |c: &u8| letters.iter().position(|letter| letter == c).unwrap() as u32;
    let mut out = Vec::new();
    for group in text.trim_end_matches('=').as_bytes().chunks(4) {
        let bits = group.iter().fold(0, |bits, c| bits << 6 | value(c)) << (6 * (4 - group.len()));
        out.extend(&bits.to_be_bytes()[1..group.len()]);
    }
    out
}

/// The numbers of frames from their differences, as the page reads them.
fn summed(coded: &Value) -> Vec<f64> {
    let list = |key: &str| coded[key].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<_>>();
    let (unit, values) = (list("unit"), list("values"));
    let count = values.len() / unit.len();
    let mut out = vec![0.0; values.len()];
    for (k, unit) in unit.iter().enumerate() {
        let mut own = values[k * count..(k + 1) * count].to_vec();
        for _ in 0..coded["order"].as_u64().unwrap() {
            (1..count).for_each(|i| own[i] += own[i - 1]);
        }
        own.iter().enumerate().for_each(|(i, x)| out[i * values.len() / count + k] = x * unit);
    }
    out
}

#[test]
fn the_crank_rocker_fits_into_a_megabyte_twice_the_same() {
    let [first, second] = ["first", "second"].map(|name| {
        let place = Place::new(name);
        assert!(place.run("crank_rocker.yaml", &["-j", if name == "first" { "1" } else { "4" }]).status.success());
        place
    });
    let page = first.page().unwrap();
    assert!(page.len() <= 1_000_000, "{} bytes", page.len());
    assert!(Some(page) == second.page(), "two runs differ");
    let data = first.data();
    let studies = data["studies"].as_array().unwrap();
    assert_eq!((studies.len(), &data["model"]["name"]), (23, &Value::from("crank-rocker")));
    assert_eq!(studies[0]["about"], "One turn at constant speed, with the load.");
    assert!(data["overview"].as_array().unwrap().iter().any(|entry| entry["label"] == "degrees of freedom" && entry["value"] == "1"));
    assert_eq!(data["made"], Value::Null);
}

#[test]
fn a_page_asks_for_nothing() {
    let place = Place::new("asks");
    place.run("four_bar_spatial.yaml", &[]);
    let page = place.page().unwrap();
    // the name of an XML vocabulary is no address
    let rest = page.replace("http://www.w3.org/2000/svg", "");
    for word in ["http://", "https://", "src=\"", "@import", "fetch(", "XMLHttpRequest", "WebSocket", "importScripts"] {
        assert!(!rest.contains(word), "{word}");
    }
    assert!(rest.contains("default-src 'none'; script-src 'sha256-"), "no policy");
    assert_eq!(page.matches("<script>").count(), 2, "a mechanism in space brings its own script");
}

#[test]
fn rows_that_are_left_out_lie_on_the_curves() {
    let place = Place::new("rows");
    place.run("crank_rocker.yaml", &["--study", "one-turn"]);
    let csv = fs::read_to_string(place.0.join("one-turn.csv")).unwrap();
    let mut lines = csv.lines();
    let column = lines.next().unwrap().split(',').position(|name| name == "drive.torque").unwrap();
    let all: Vec<[f64; 2]> =
        lines.map(|line| line.split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()).map(|row| [row[0], row[column]]).collect();
    let study = &place.data()["studies"][0];
    let list = |value: &Value| value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<_>>();
    let (steps, breaks) = (list(&study["rows"]["steps"]), list(&study["rows"]["breaks"]));
    let kept: Vec<f64> = steps
        .iter()
        .scan(0.0, |row, step| {
            *row += step;
            Some(*row)
        })
        .collect();
    assert!(kept.len() < all.len() / 10 && study["rows"]["of"] == all.len(), "{} rows", kept.len());
    let range = all.iter().map(|row| row[1]).fold(f64::MIN, f64::max) - all.iter().map(|row| row[1]).fold(f64::MAX, f64::min);
    let ends: Vec<usize> = breaks.iter().map(|k| *k as usize + 1).chain([kept.len()]).collect();
    let mut from = 0;
    for end in ends {
        let nodes: Vec<[f64; 2]> = kept[from..end].iter().map(|row| all[*row as usize]).collect();
        for row in &all[kept[from] as usize..=kept[end - 1] as usize] {
            let behind = nodes.partition_point(|node| node[0] <= row[0]);
            let first = behind.saturating_sub(2).min(nodes.len().saturating_sub(4));
            let near = &nodes[first..(first + 4).min(nodes.len())];
            let weight = |k: usize| {
                near.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, n)| (row[0] - n[0]) / (near[k][0] - n[0])).product::<f64>()
            };
            let value: f64 = (0..near.len()).map(|k| weight(k) * near[k][1]).sum();
            assert!((value - row[1]).abs() < 1.1e-4 * range, "at {}: {value}, not {}", row[0], row[1]);
        }
        from = end;
    }
}

#[test]
fn frames_hold_the_loop_together() {
    let place = Place::new("frames");
    place.run("crank_rocker.yaml", &["--study", "one-turn"]);
    let data = place.data();
    let scene = &data["studies"][0]["scenes"][0][1];
    let (at, poses) = (summed(&scene["frames"]["at"]), summed(&scene["frames"]["poses"]));
    assert!((at[at.len() - 1] - std::f64::consts::TAU).abs() < 1e-9);
    // the end of the coupler, 1 m from its beginning, is 0.55 m from the rocker's beginning
    for frame in poses.chunks_exact(9) {
        let end = [frame[3] + frame[5].cos(), frame[4] + frame[5].sin()];
        let length = (end[0] - frame[6]).hypot(end[1] - frame[7]);
        assert!((length - 0.55).abs() < 1e-7, "{length}");
    }
}

#[test]
fn a_report_is_of_what_ran_and_goes_when_it_is_not_wanted() {
    let place = Place::new("goes");
    place.run("crank_rocker.yaml", &["--study", "balanced", "--study", "stiffness"]);
    let names: Vec<String> = place.data()["studies"].as_array().unwrap().iter().map(|s| s["study"].as_str().unwrap().into()).collect();
    assert_eq!(names, ["balanced", "stiffness"]);
    assert!(place.run("crank_rocker.yaml", &["--study", "balanced", "--no-report"]).status.success());
    assert!(place.page().is_none(), "a report of other numbers beside new files");
}

#[test]
fn a_study_without_results_is_listed_with_the_reason_and_changed_values_are_told() {
    let place = Place::new("failed");
    let model = place.0.join("arm.yaml");
    let text = "
grashof: 1
name: arm
space: planar
gravity: none
parameters: { l: 1 m, speed: 60 rpm }
bodies: { arm: { bar: { length: l, mass: 1 kg } } }
joints: { O: { revolute: [ground, arm.start] } }
drivers: { drive: { joint: O, speed: speed } }
start: { O.angle: 0 deg }
studies:
  far:
    about: It does not reach so far.
    kinematics: { over: 1 turn, samples: 12 }
    scalars: { reach: max(arm.end.x) }
    solve: { vary: l, between: [1 m, 2 m], target: { reach: 5 m } }
  turn: { kinematics: { over: 1 turn, samples: 12 }, columns: [O.angle] }
";
    fs::write(&model, text).unwrap();
    let run = |more: &[&str]| place.run(model.to_str().unwrap(), more);
    assert_eq!(run(&["--set", "speed=90 rpm"]).status.code(), Some(3));
    let data = place.data();
    assert!(data["overview"].as_array().unwrap().contains(&serde_json::json!({ "label": "set", "value": "speed = 90 rpm" })));
    let studies = data["studies"].as_array().unwrap();
    assert_eq!((studies.len(), &studies[1]["study"]), (2, &Value::from("turn")));
    assert_eq!((&studies[0]["study"], &studies[0]["about"]), (&Value::from("far"), &Value::from("It does not reach so far.")));
    let fault = &studies[0]["faults"][0];
    assert!(fault["message"].as_str().unwrap().contains("does not meet its target 5 m"), "{fault}");
    assert_eq!((&fault["place"], fault["help"].as_str().unwrap().is_empty()), (&Value::from("studies.far.solve"), false));
    // one that is left out since its parameter is set is listed, too
    assert!(run(&["--set", "l=2 m"]).status.success());
    let data = place.data();
    assert!(data["studies"][0]["faults"][0]["message"].as_str().unwrap().contains("varies `l`, which `--set` fixes"));
    // of a run without any result nothing is written
    fs::remove_file(place.0.join("report.html")).unwrap();
    assert_eq!(run(&["--study", "far"]).status.code(), Some(3));
    assert!(place.page().is_none());
}

#[test]
fn somebodys_page_is_not_replaced() {
    let place = Place::new("somebody");
    fs::write(place.0.join("report.html"), "mine").unwrap();
    let done = place.run("crank_rocker.yaml", &["--study", "stiffness"]);
    assert_eq!(done.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&done.stderr).contains("report.html"), "{}", String::from_utf8_lossy(&done.stderr));
    assert_eq!(place.page().as_deref(), Some("mine"));
    assert!(!place.0.join("stiffness.csv").exists(), "computed although it could not be written");
    assert!(place.run("crank_rocker.yaml", &["--study", "stiffness", "--force"]).status.success());
    assert!(place.page().is_some_and(|page| page.len() > 10_000));
}
