//! Kills and full disks while results are written: what stands under the name of a result is whole.

use super::{cases, seeded, share, tell};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const MODEL: &str = "models/slider_crank.yaml";

fn command(program: &str, out: &Path) -> Command {
    let mut command = Command::new(program);
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(["run", MODEL, "--study", "driven", "-o"]).arg(out);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn start(out: &Path) -> Child {
    command(env!("CARGO_BIN_EXE_grashof"), out).spawn().expect("the program starts")
}

/// A directory of its own.
fn fresh(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("grashof-kills-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&path);
    path
}

/// Files under names of results; what begins with a dot is not one.
fn results(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let Ok(entries) = fs::read_dir(directory) else { return BTreeMap::new() };
    let file = |entry: std::io::Result<fs::DirEntry>| {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        (!name.starts_with('.')).then(|| (name, fs::read(entry.path()).unwrap()))
    };
    entries.filter_map(file).collect()
}

/// Names of all entries of a directory.
fn names(directory: &Path) -> BTreeSet<std::ffi::OsString> {
    fs::read_dir(directory).map(|entries| entries.filter_map(|e| Some(e.ok()?.file_name())).collect()).unwrap_or_default()
}

/// Whether a file ends as its kind does and is not cut short.
fn whole(name: &str, bytes: &[u8]) -> bool {
    let kind = name.rsplit('.').next().unwrap_or_default();
    match kind {
        "csv" => {
            let text = String::from_utf8_lossy(bytes);
            let width = |line: &str| line.matches(',').count();
            let first = text.lines().next().map_or(0, width);
            text.ends_with('\n') && text.lines().all(|line| width(line) == first)
        }
        "json" => serde_json::from_slice::<serde_json::Value>(bytes).is_ok(),
        "svg" => bytes.trim_ascii_end().ends_with(b"</svg>"),
        "png" => bytes.ends_with(&[b'I', b'E', b'N', b'D', 0xAE, 0x42, 0x60, 0x82]),
        _ => true,
    }
}

/// A run that is killed at any time leaves whole files, and the next run all of them.
#[test]
fn a_killed_run_leaves_whole_files() {
    let wanted = cases(12);
    let mut dice = seeded(0x0000_51F7);
    let clean = fresh("clean");
    let begun = Instant::now();
    assert!(start(&clean).wait().unwrap().success());
    let takes = begun.elapsed();
    let right = results(&clean);
    assert!(right.len() >= 5, "{:?}", right.keys());
    let (mut ended, mut dead) = (0, 0);
    let out = fresh("killed");
    for case in 0..wanted {
        if case % 3 == 0 {
            let _ = fs::remove_dir_all(&out);
        }
        let before = names(&out);
        let mut child = start(&out);
        if case % 4 == 0 {
            // at any time
            std::thread::sleep(takes.mul_f64(share(&mut dice)));
        } else {
            // while files are written: shortly after the first change in the directory
            while names(&out) == before && child.try_wait().unwrap().is_none() {
                std::thread::sleep(Duration::from_micros(50));
            }
            std::thread::sleep(Duration::from_micros(dice.next(1000) as u64));
        }
        child.kill().unwrap();
        if child.wait().unwrap().success() {
            ended += 1
        } else {
            dead += 1
        }
        for (name, bytes) in results(&out) {
            assert!(whole(&name, &bytes), "case {case}: {name} of {} bytes is cut short", bytes.len());
        }
    }
    assert!(start(&out).wait().unwrap().success(), "the next run after a kill");
    let (found, csv) = (results(&out), |name: &str| name.ends_with(".csv"));
    for (name, bytes) in &right {
        let same = found.get(name).is_some_and(|f| !csv(name) || f == bytes);
        assert!(same, "{name} is missing or differs after the next run");
    }
    let _ = (fs::remove_dir_all(&clean), fs::remove_dir_all(&out));
    tell(&format!("kills: {wanted} cases: {dead} killed, {ended} had ended; 0 findings"));
}

/// A disk that is full while a result is written: an error, and no half file; what stood there before stays.
#[cfg(unix)]
#[test]
fn a_full_disk_is_an_error_and_leaves_no_half_file() {
    let out = fresh("full");
    assert!(start(&out).wait().unwrap().success());
    let before = results(&out);
    // a limit of the size of files, whose signal is ignored, fails writes as a full disk does; in blocks of 512 bytes
    for blocks in [0, 1, 4, 16, 40, 1000] {
        for directory in [out.clone(), fresh("full-new")] {
            let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
            let status = Command::new("sh")
                .args(["-c", &script, env!("CARGO_BIN_EXE_grashof"), "run", MODEL, "--study", "driven", "-o"])
                .arg(&directory)
                .current_dir(env!("CARGO_MANIFEST_DIR"))
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .status()
                .unwrap();
            let now = results(&directory);
            if directory == out {
                assert!(now.iter().all(|(name, bytes)| whole(name, bytes)), "{blocks} blocks: a half file");
                assert_eq!(now.keys().collect::<Vec<_>>(), before.keys().collect::<Vec<_>>(), "{blocks} blocks");
            }
            let largest = before.values().map(Vec::len).max().unwrap();
            assert!(status.success() == (largest <= 512 * blocks), "{blocks} blocks: {status}");
            assert!(now.iter().all(|(name, bytes)| whole(name, bytes)), "{blocks} blocks: a half file");
            let _ = (directory != out).then(|| fs::remove_dir_all(&directory));
        }
    }
    let _ = fs::remove_dir_all(&out);
}
