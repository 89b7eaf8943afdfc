//! Sweeps over lists of points, and sweeps that other programs distribute.

use super::{FOUR_BAR, Place};
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

#[test]
fn points_are_runs_and_no_combinations() {
    let points = FOUR_BAR.replace(
        "sweep: { l3: { from: 50 cm, to: 60 cm, count: 3 } }",
        "sweep: { points: { l1: [10 cm, 15 cm], l3: [50 cm, 2*l1] }, speed: [60 rpm, 30 rpm] }",
    );
    let place = Place::new("points", &points);
    place.ends(0, &["run", "model.yaml", "--study", "lengths", "--no-plots", "-o", "file"]);
    let rows = place.rows("file/lengths.csv", 3);
    let turn = std::f64::consts::TAU;
    // values of a sweep see those of the file
    assert_eq!(rows, [[0.1, 0.5, turn], [0.1, 0.5, turn / 2.0], [0.15, 0.3, turn], [0.15, 0.3, turn / 2.0]]);
    let over = ["--over", "l1, l3=10 cm,50 cm; 15 cm, 2*l1;", "--over", "speed=60 rpm,30 rpm", "--no-plots"];
    place.ends(0, &[&["sweep", "model.yaml", "--study", "turn", "-o", "line"], &over[..]].concat());
    let name = "turn-over-l1+l3+speed.csv";
    assert_eq!(place.text(&format!("line/{name}")), place.text("file/lengths.csv"));
    for shard in ["1/2", "2/2"] {
        place.ends(0, &[&["sweep", "model.yaml", "--study", "turn", "--shard", shard, "-o", "shards"], &over[..]].concat());
    }
    place.ends(0, &[&["gather", "model.yaml", "--study", "turn", "-o", "shards"], &over[..]].concat());
    assert_eq!(place.contents("shards")[name], place.contents("line")[name]);
}

#[test]
#[cfg(unix)]
fn a_sweep_on_ray_is_handed_to_python() {
    use std::os::unix::fs::PermissionsExt;
    let place = Place::new("ray", FOUR_BAR);
    let with = |script: &str, code: i32| {
        let bin = place.0.join("bin");
        fs::create_dir_all(&bin).unwrap();
        fs::write(bin.join("python3"), format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(bin.join("python3"), fs::Permissions::from_mode(0o755)).unwrap();
        let arguments = ["sweep", "model.yaml", "--study", "turn", "--over", "l3=0.5,0.6", "--set", "speed=2", "--ray", "local", "-q"];
        let Output { status, stdout, stderr } = place.command(&arguments).env("PATH", &bin).output().unwrap();
        let texts = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert_eq!(status.code(), Some(code), "{texts:?}");
        texts
    };
    let [stdout, _] = with(r#"[ "$1" = -c ] || { echo "$@"; exit 3; }"#, 3);
    let words = "-m grashof sweep model.yaml --ray=local --study=turn --over=l3=0.5,0.6 --set=speed=2 --seed=1 --quiet -o results/model";
    assert_eq!(stdout.trim(), words);
    let missing = |words: &str| with(&format!("echo {words}"), 2)[1].clone();
    assert!(missing("ray").contains("pip install ray") && missing("grashof ray").contains("pip install ./python ray"));
    assert!(with("echo broken >&2; exit 1", 2)[1].contains("does not start: broken"));
    fs::remove_file(place.0.join("bin/python3")).unwrap();
    let arguments = ["sweep", "model.yaml", "--over", "l3=0.5,0.6", "--ray", "local"];
    let output = place.command(&arguments).env("PATH", place.0.join("bin")).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("`python3` cannot be run"));
}

/// The script of the page on SLURM, with a `grashof` and an `srun` of its own.
#[test]
#[cfg(unix)]
fn the_array_script_of_the_documentation_runs() {
    let page = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/slurm.md")).unwrap();
    let blocks: Vec<&str> = page.split("```bash\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let [array, gather] = [blocks[0], blocks[2]];
    let place = Place::new("slurm", FOUR_BAR);
    fs::rename(place.0.join("model.yaml"), place.0.join("linkage.yaml")).unwrap();
    fs::write(place.0.join("sweep.sh"), array).unwrap();
    fs::write(place.0.join("gather.sh"), gather).unwrap();
    let program = PathBuf::from(env!("CARGO_BIN_EXE_grashof"));
    let path = format!("{}:{}", program.parent().unwrap().display(), std::env::var("PATH").unwrap());
    let run = |script: &str, task: &str| {
        let shell = |command: &mut Command| command.current_dir(&place.0).env("PATH", &path).output().unwrap();
        let mut command = Command::new("bash");
        let variables = [("SLURM_ARRAY_TASK_ID", task), ("SLURM_CPUS_PER_TASK", "1")];
        let output = shell(command.arg(script).envs(variables));
        assert!(output.status.success(), "{script} {task}\n{}", String::from_utf8_lossy(&output.stderr));
    };
    ["1", "2", "3"].iter().for_each(|task| run("sweep.sh", task));
    run("gather.sh", "");
    place.ends(0, &["run", "linkage.yaml", "--study", "lengths", "-o", "whole"]);
    assert_eq!(place.contents("results")["lengths.csv"], place.contents("whole")["lengths.csv"]);
}
