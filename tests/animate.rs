//! `grashof animate` and `grashof export`: pictures and numbers of what they write, beside the motion that was computed.

use crate::common;
use grashof::model::Model;
use grashof::output::{Pace, Shot, ShotOptions};
use grashof::results::{Results, Scene};
use grashof::studies::sweep::{Drawn, Settings, at, single};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

mod exports;
mod faults;
mod moving_svg;
mod pictures;

/// A crank that turns clockwise and a rod, with a block on a slide and the path of a point.
const SLIDER_CRANK: &str = "grashof: 1
name: slider-crank
space: planar
gravity: none
parameters: { r: 0.3 m }
ground: { O: [0, 0], W: [0, 0.1 m] }
bodies:
  crank: { bar: { length: r } }
  rod: { bar: { length: 1 m }, points: { P: [0.4 m, 0.2 m] } }
  block: {}
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, rod.start] }
  B: { revolute: [rod.end, block.origin] }
  W: { slider: [ground.W, block.origin], axis: [1, 0] }
springs: { coil: { between: [ground.O, block.origin], stiffness: 1 N/m, length: 0.5 m } }
drivers: { drive: { joint: O, speed: -2 rad/s } }
start: { O.angle: 20 deg, rod.angle: ~0 deg }
studies:
  turn: { kinematics: { over: 1 turn, samples: 97 }, columns: [time, rod.P] }
  part: { kinematics: { over: 0.25 turn, samples: 10 } }
  cranks: { kinematics: { over: 1 turn, samples: 20 }, sweep: { r: [0.2 m, 0.3 m] } }
  rest: { statics: { from: start } }
";

/// A pendulum, which comes back nearly.
const PENDULUM: &str = "grashof: 1
name: pendulum
space: planar
gravity: [0, -9.81 m/s^2]
bodies: { rod: { bar: { length: 1 m, mass: 1 kg } } }
joints: { P: { revolute: [ground, rod.start] } }
start: { P.angle: 200 deg }
studies:
  swing: { dynamics: { until: 1 s, every: 10 ms } }
  small: { modes: { at: statics } }
";

/// A fresh directory with a model, removed at the end.
struct Place(PathBuf);

impl Place {
    fn new(name: &str, text: &str) -> Self {
        let path = std::env::temp_dir().join(format!("grashof-animate-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        fs::write(path.join("m.yaml"), text).unwrap();
        Self(path)
    }

    /// A command on the model, run in the directory.
    fn command(&self, words: &str) -> Command {
        let mut words = words.split_whitespace();
        let mut command = Command::new(env!("CARGO_BIN_EXE_grashof"));
        command.current_dir(&self.0).arg(words.next().unwrap()).arg("m.yaml").args(words);
        command
    }

    fn run(&self, words: &str) -> Output {
        self.command(words).output().unwrap()
    }

    /// Runs a command that must succeed, and reads the file that it writes.
    fn made(&self, words: &str, file: &str) -> Vec<u8> {
        let output = self.run(words);
        assert!(output.status.success(), "{words}: {}", String::from_utf8_lossy(&output.stderr));
        fs::read(self.0.join(file)).unwrap()
    }

    /// Runs a command that must fail as one that cannot be begun, and writes nothing; gives what it says.
    fn refused(&self, words: &str) -> String {
        self.refused_by(self.command(words))
    }

    fn refused_by(&self, mut command: Command) -> String {
        let before = names(&self.0);
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert_eq!(names(&self.0), before, "{said}");
        assert!(said.contains("help"), "no remedy: {said}");
        said
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// The results of a study of a text.
fn results(text: &str, study: &str) -> Results {
    let model: Model = common::model(text, Some(study));
    let study = model.study.as_ref().unwrap();
    let run = at(&model, study, Vec::new(), Settings { threads: 1, drawn: Drawn::All, stop: &|| false }, None, &|_, _| {});
    single(&model, study, run).unwrap_or_else(|failure| panic!("{failure:?}"))
}

/// The motion of a study of a text, and the shot of it at `rate` pictures a second.
fn shot(text: &str, study: &str, pace: Pace, rate: f64, repeats: bool) -> (Scene, Shot) {
    let results = results(text, study);
    let scene = results.scenes[0].1.clone();
    let shot = Shot::of(&results, &scene, &ShotOptions { rate, pace, repeats }).unwrap();
    (scene, shot)
}
