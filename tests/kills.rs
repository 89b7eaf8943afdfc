//! Runs that are killed while they write: under each name stands at every instant the old file or the new one, the record tells
//! what is on the way, and the next run brings the set and clears what the dead one left.
//!
//! The number of kills is that of `GRASHOF_KILLS` (24 if silent), the seed of their instants that of `GRASHOF_SEED`:
//! `GRASHOF_KILLS=500 GRASHOF_SEED=7 cargo test --test all kills -- --nocapture`.

#![cfg(unix)]

use grashof::output::Staging;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

const MODEL: &str = "\
grashof: 1
name: four-bar
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { l1: 15 cm, l2: 1 m, l3: 55 cm, l4: 1 m }
ground: { O: [0, 0], C: [l4, 0] }
bodies:
  crank: { bar: { length: l1, mass: 3 kg } }
  coupler: { bar: { length: l2, mass: 6 kg } }
  rocker: { bar: { length: l3, mass: 6 kg } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: O, speed: 240 rpm } }
start: { O.angle: 90 deg, coupler.angle: ~25 deg, rocker.angle: ~90 deg }
measures: { phi3: rocker.angle }
studies:
  turn:
    kinematics: { over: 1 turn, samples: 90 }
    columns: [phi3]
    sweep: { l3: [50 cm, 51 cm, 52 cm, 53 cm, 54 cm, 55 cm, 56 cm, 57 cm] }
    plot: { phi3: [phi3] }
";
const RECORD: &str = ".grashof.json";

type Contents = BTreeMap<String, Vec<u8>>;

struct Place(PathBuf);

impl Place {
    fn new() -> Self {
        let path = std::env::temp_dir().join(format!("grashof-kills-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("model.yaml"), MODEL).unwrap();
        Self(path)
    }

    /// A run of one of two kinds, whose sets of files differ in names and contents.
    fn command(&self, kind: usize, directory: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_grashof"));
        command
            .args(["run", "model.yaml", "-q", "--no-report", "-o", directory])
            .args([&["--set", "l4=1.01 m"][..], &["--no-plots"]][kind]);
        command.current_dir(&self.0).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    fn whole(&self, kind: usize, directory: &str) -> Duration {
        let begun = Instant::now();
        let output = self.command(kind, directory).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        begun.elapsed()
    }

    fn contents(&self, directory: &str) -> Contents {
        contents(&self.0.join(directory))
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// All files; those that go between the listing and the reading are left out.
fn contents(directory: &Path) -> Contents {
    let entries = fs::read_dir(directory).unwrap().map(|e| e.unwrap());
    entries.filter_map(|e| Some((e.file_name().into_string().unwrap(), fs::read(e.path()).ok()?))).collect()
}

/// Numbers between 0 and 1 (xorshift64*, Vigna 2016).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn asked(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// Whether a set is being written, by the record.
fn writing(directory: &Path) -> Option<Value> {
    let record: Value = serde_json::from_slice(&fs::read(directory.join(RECORD)).ok()?).expect("a whole record");
    record.get("writing").cloned()
}

/// What must hold at every instant: results are old or new ones, the user's files are as they were, what is hidden is recorded.
fn holds(out: &Path, sets: &[Contents; 2], own: &Contents) {
    let found = contents(out);
    let suffix = writing(out).map(|w| w["suffix"].as_str().unwrap().to_owned());
    for (name, bytes) in &found {
        if own.contains_key(name) {
            assert_eq!(bytes, &own[name], "{name} is the user's");
        } else if name.starts_with('.') {
            let temporary = suffix.as_ref().is_some_and(|suffix| name.ends_with(suffix));
            assert!(temporary || name == RECORD || name == ".grashof.json.new", "{name} is recorded nowhere");
        } else if name.ends_with(".partial") {
            // finished runs, for the next run of the sweep
            assert!(bytes.starts_with(&b"grashof1"[..bytes.len().min(8)]));
        } else {
            assert!(sets.iter().any(|set| set.get(name) == Some(bytes)), "{name} is neither the old nor the new one");
        }
    }
    assert!(own.keys().all(|name| found.contains_key(name)));
}

#[test]
fn every_file_is_old_or_new_and_the_next_run_mends() {
    let place = Place::new();
    let took = [place.whole(0, "first"), place.whole(1, "second")];
    let sets = ["first", "second"].map(|directory| {
        let mut set = place.contents(directory);
        set.remove(RECORD);
        set
    });
    assert!(sets[0].len() > sets[1].len() && sets[1].len() == 10, "{:?}", sets[1].keys());
    let own: Contents = ["turn-photo.png", "turn-009.csv", "turn-2024.csv"].map(|name| (name.to_string(), name.into())).into();
    let out = place.0.join("out");
    fs::create_dir(&out).unwrap();
    own.iter().for_each(|(name, bytes)| fs::write(out.join(name), bytes).unwrap());
    place.whole(0, "out");

    let (kills, mut noise) = (asked("GRASHOF_KILLS", 24), Noise(asked("GRASHOF_SEED", 20_240_229).max(1)));
    let (mut while_writing, mut mixed, mut before) = (0, 0, [sets[0].clone(), sets[1].clone()]);
    before.iter_mut().for_each(|set| set.retain(|name, _| sets.iter().all(|set| set.contains_key(name))));
    let over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        // somebody who reads all the time
        scope.spawn(|| {
            while !over.load(Ordering::Relaxed) {
                for name in before[0].keys() {
                    let bytes = fs::read(out.join(name)).expect("a name of both sets is always there");
                    assert!(sets.iter().any(|set| set[name] == bytes), "{name} is neither the old nor the new one");
                }
            }
        });
        for k in 0..kills {
            let kind = usize::from(noise.next() < 0.5);
            let mut child = place.command(kind, "out").spawn().unwrap();
            let begun = Instant::now();
            // half of the kills at any time of a run, half from the beginning of the writing on
            if k % 2 == 0 {
                std::thread::sleep(took[kind].mul_f64(noise.next()));
            } else {
                while writing(&out).is_none() && child.try_wait().unwrap().is_none() && begun.elapsed() < Duration::from_secs(30) {}
                std::thread::sleep(Duration::from_millis(12).mul_f64(noise.next()));
            }
            let _ = child.kill();
            let _ = child.wait();
            holds(&out, &sets, &own);
            if writing(&out).is_some() {
                while_writing += 1;
                let found = place.contents("out");
                let fits: BTreeSet<bool> = before[0].keys().map(|name| found[name] == sets[0][name]).collect();
                mixed += usize::from(fits.len() > 1);
            }
            // sometimes several die before one gets through
            if noise.next() < 0.6 {
                let kind = usize::from(noise.next() < 0.5);
                place.whole(kind, "out");
                let mut found = place.contents("out");
                found.remove(RECORD).expect("a record");
                own.keys().for_each(|name| _ = found.remove(name));
                assert!(found == sets[kind], "{:?} is not {:?}", found.keys(), sets[kind].keys());
                assert!(writing(&out).is_none());
            }
        }
        over.store(true, Ordering::Relaxed);
    });
    println!("{kills} kills, {while_writing} of them while a set was written, {mixed} of these between two of its files");
    assert!(while_writing > 0, "no kill has hit the writing");
}

/// Runs that write into one directory at the same time leave the set of one of them.
#[test]
fn runs_at_the_same_time_leave_whole_sets() {
    let directory = std::env::temp_dir().join(format!("grashof-together-{}", std::process::id()));
    let _ = fs::remove_dir_all(&directory);
    std::thread::scope(|scope| {
        for worker in 0..4 {
            let directory = &directory;
            scope.spawn(move || {
                for round in 0..10 {
                    let mut staging = Staging::new();
                    // each makes a figure that others do not
                    for name in ["a.csv".to_string(), "a.json".into(), format!("a-{worker}.svg")] {
                        staging.add(name, format!("{worker} {round}"));
                    }
                    staging.commit(directory, "a", false).unwrap();
                }
            });
        }
    });
    let found = contents(&directory);
    let (last, names) = (&found["a.csv"], found.keys().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(&found["a.json"], last);
    assert_eq!(names, [RECORD, &format!("a-{}.svg", last[0] as char), "a.csv", "a.json"]);
    fs::remove_dir_all(directory).unwrap();
}
