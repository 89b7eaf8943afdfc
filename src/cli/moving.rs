//! A study computed for its motion alone: nothing of it is written.

use super::interrupt::{self, interrupted, watch_interrupts};
use super::{Common, code, files, print_error, print_note, run};
use grashof::model::Selection;
use grashof::output::{Pace, Shot, ShotOptions};
use grashof::results::{Results, Scene};
use grashof::studies::loader::Loader;
use grashof::studies::sweep::{Drawn, Settings, at, grid, single};

/// Which motion is meant.
#[derive(clap::Args)]
pub(super) struct Chosen {
    /// Model file, or `-` for stdin
    model: String,
    /// The study whose motion it is; may be left out if the file has one study
    #[arg(long, value_name = "S")]
    study: Option<String>,
    /// Of a sweep: the run, counted from 1
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    run: u32,
    /// Of vibrations: the mode, counted from 1
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    mode: u32,
}

/// How fast the motion is shown.
#[derive(clap::Args)]
pub(super) struct Fast {
    /// Pictures a second
    #[arg(long, value_name = "R", default_value_t = 30.0, value_parser = rate)]
    pub(super) rate: f64,
    /// Speed as a multiple of the real one; a motion without time takes 4 s at speed 1
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = positive)]
    speed: f64,
    /// Show all of it in so many seconds, whatever its speed
    #[arg(long, value_name = "SECONDS", value_parser = positive, conflicts_with = "speed")]
    duration: Option<f64>,
}

fn positive(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0).ok_or_else(|| "a number above 0".into())
}

fn rate(text: &str) -> Result<f64, String> {
    positive(text).ok().filter(|x| (0.1..=240.0).contains(x)).ok_or_else(|| "a number from 0.1 to 240".into())
}

/// From where a motion is seen.
#[derive(clap::Args)]
pub(super) struct Seen {
    /// Of a mechanism in space: from where it is seen: `front`, `top`, `side`, or azimuth and elevation in degrees, as `30,20`
    #[arg(long, value_name = "VIEW", value_parser = view, allow_hyphen_values = true)]
    view: Option<[f64; 2]>,
}

impl Seen {
    /// Whether it is said.
    pub(super) fn is_asked(&self) -> bool {
        self.view.is_some()
    }
}

/// Azimuth and elevation of the eye, rad.
fn view(text: &str) -> Result<[f64; 2], String> {
    let degrees = match text {
        "front" => Some([-90.0, 0.0]),
        "top" => Some([-90.0, 90.0]),
        "side" => Some([0.0, 0.0]),
        other => {
            other.split_once(',').and_then(|(azimuth, elevation)| Some([azimuth.trim().parse().ok()?, elevation.trim().parse().ok()?]))
        }
    };
    let known = degrees.filter(|d: &[f64; 2]| d[0].is_finite() && d[1].abs() <= 90.0);
    known.map(|d| d.map(f64::to_radians)).ok_or_else(|| "front, top, side, or azimuth and elevation in degrees as `30,20`".into())
}

/// A motion that was computed.
pub(super) struct Moving {
    pub(super) results: Results,
    /// Which of its drawings is meant.
    index: usize,
}

impl Moving {
    /// Name of the drawing.
    pub(super) fn name(&self) -> &str {
        &self.results.scenes[self.index].0
    }

    /// The mechanism with its motion.
    pub(super) fn scene(&self) -> &Scene {
        &self.results.scenes[self.index].1
    }

    /// Lets the mechanism be seen from where it is asked; what is wrong was reported.
    pub(super) fn look(&mut self, seen: &Seen) -> Result<(), u8> {
        if seen.view.is_none() {
            return Ok(());
        }
        if self.scene().dimensions == 2 {
            print_error("`--view` is for mechanisms in space, and this one is planar", "leave `--view` out");
            return Err(code::INPUT);
        }
        self.results.scenes[self.index].1.view = seen.view;
        Ok(())
    }

    /// When pictures are taken; what is wrong was reported.
    pub(super) fn shot(&self, fast: &Fast, repeats: bool, common: &Common) -> Result<Shot, u8> {
        let pace = fast.duration.map_or(Pace::Speed(fast.speed), Pace::Duration);
        let options = ShotOptions { rate: fast.rate, pace, repeats };
        let shot = Shot::of(&self.results, self.scene(), &options).map_err(|message| {
            print_error(&message, "show it faster with `--speed`, as a whole with `--duration 10`, or with fewer pictures by `--rate`");
            code::INPUT
        })?;
        if !shot.is_timed() && self.results.kind != "modes" && fast.duration.is_none() && !common.quiet {
            print_note(&format!(
                "note: `time` is no column of study `{}`, so that its motion is shown evenly in {:.3} s; list `time` in `columns` for its own speed, or give `--duration`",
                self.results.study, shot.exact
            ));
        }
        Ok(shot)
    }
}

/// Computes the motion of a study; what is wrong was reported.
pub(super) fn moving(chosen: &Chosen, common: &Common) -> Result<Moving, u8> {
    watch_interrupts();
    let (document, selection, told) = files::sound_for(&chosen.model, common, chosen.study.as_slice()).ok_or(code::INPUT)?;
    files::print_notes(&document, common);
    let known = document.study_names();
    let name = named(chosen.study.as_deref(), &known).ok_or(code::INPUT)?;
    interrupt::begins(format!("interrupted: study `{name}` is not shown"), false);
    let selection = Selection { study: Some(name), ..selection };
    let model = match run::load(&mut Loader::new(&document, common.threads()), &document, common, &selection, &told) {
        Err(_) if interrupted() => return Err(ended(name)),
        loaded => loaded?,
    };
    if let Some(parameter) = model.set_and_varied() {
        return Err(run::refused(parameter, name));
    }
    let study = model.study.as_ref().ok_or(code::INPUT)?;
    let mut points = grid(&model, study);
    if chosen.run as usize > points.len() {
        let (message, help) = match study.sweep.is_empty() {
            true => (format!("study `{name}` is no sweep and has one run"), "leave `--run` out".to_string()),
            false => {
                (format!("study `{name}` has {} runs", points.len()), format!("name one of them: `--run 1` to `--run {}`", points.len()))
            }
        };
        print_error(&message, &help);
        return Err(code::INPUT);
    }
    let point = points.swap_remove(chosen.run as usize - 1);
    let run = at(&model, study, point, Settings { threads: common.threads(), drawn: Drawn::First, stop: &interrupted }, None, &|_, _| {});
    let results = match single(&model, study, run) {
        Err(_) if interrupted() => return Err(ended(name)),
        Err(failure) => return Err(files::explain(&document, &failure, name, common)),
        Ok(results) => results,
    };
    if let (Some(reason), false) = (&results.stopped, common.quiet) {
        print_note(&format!("note: study `{name}` stopped on its way, and is shown up to there: {reason}"));
    }
    found(results, name, chosen)
}

fn ended(study: &str) -> u8 {
    interrupt::print_end(&format!("interrupted: study `{study}` is not shown"));
    code::INTERRUPTED
}

/// The study that is named, or the only one; what is wrong was reported.
fn named<'a>(asked: Option<&'a str>, known: &'a [String]) -> Option<&'a str> {
    match (asked, known) {
        // of one that is not there the loader says which there are
        (Some(study), _) => Some(study),
        (None, [only]) => Some(only),
        (None, []) => {
            print_error(
                "the model has no studies, so there is no motion",
                "add one, as `studies: { turn: { kinematics: { over: 1 turn, samples: 72 } } }`",
            );
            None
        }
        (None, several) => {
            let help = format!("name one of them with `--study`: {}", several.join(", "));
            print_error(&format!("the model has {} studies", several.len()), &help);
            None
        }
    }
}

/// The drawing that moves.
fn found(results: Results, name: &str, chosen: &Chosen) -> Result<Moving, u8> {
    let moving = results.moving();
    if moving.is_empty() {
        print_error(
            &format!("study `{name}` has no motion to show"),
            "name a study of a motion, as `kinematics`, `inverse`, `dynamics`, `periodic` or `modes`",
        );
        return Err(code::INPUT);
    }
    match moving.get(chosen.mode as usize - 1) {
        Some(index) => Ok(Moving { index: *index, results }),
        None => {
            let (message, help) = if results.kind == "modes" {
                (
                    format!("study `{name}` draws {} modes", moving.len()),
                    format!("name one of them: `--mode 1` to `--mode {}`", moving.len()),
                )
            } else {
                (format!("study `{name}` has no modes"), "leave `--mode` out".to_string())
            };
            print_error(&message, &help);
            Err(code::INPUT)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_have_names_or_two_angles() {
        assert_eq!(view("top").map(|v| v.map(f64::to_degrees)), Ok([-90.0, 90.0]));
        assert!(view("30, -20").is_ok_and(|v| (v[1].to_degrees() + 20.0).abs() < 1e-9));
        assert!(view("30,100").is_err() && view("above").is_err() && view("nan,0").is_err());
    }
}
