//! `grashof animate`: a mechanism in motion, as GIF, SVG, film or pictures.

use super::interrupt::{interrupted, uncut};
use super::moving::{Chosen, Fast, Moving, Seen, moving};
use super::progress::Progress;
use super::{Common, code, files, interrupt, print_error, print_note, video};
use grashof::output::{Film, Projector, RenderError, Shot, Staging, moving_svg, write_gif};
use grashof::par;
use std::path::{Path, PathBuf};

/// Pictures a second that a GIF can have: browsers slow down what is faster.
const MOST_OF_GIF: f64 = 50.0;
/// Pictures that are held at a time.
const HELD: usize = 64;
/// Shown in less than this, a motion is hardly seen, s.
const SHORT: f64 = 0.8;

#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    chosen: Chosen,
    #[command(flatten)]
    fast: Fast,
    /// Width, pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 800, value_parser = clap::value_parser!(u16).range(64..=4096))]
    size: u16,
    /// Begin again at the end, as GIF and SVG do unless told otherwise
    #[arg(long = "loop", conflicts_with = "once")]
    again: bool,
    /// Stop at the end
    #[arg(long)]
    once: bool,
    #[command(flatten)]
    seen: Seen,
}

/// What is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Gif,
    Svg,
    Video(video::Codec),
    Frames,
}

/// Shows the motion of a study.
pub(super) fn animate(arguments: &Arguments, common: &Common) -> u8 {
    match animated(arguments, common) {
        Ok(()) => code::DONE,
        Err(code) => code,
    }
}

fn animated(arguments: &Arguments, common: &Common) -> Result<(), u8> {
    let Some(file) = &common.output else {
        print_error(
            "it is not said where the animation goes",
            "add `-o out.gif`, `-o out.svg`, `-o out.mp4`, `-o out.webm`, or `-o frames/` for single pictures",
        );
        return Err(code::INPUT);
    };
    let kind = kind(file)?;
    ready(kind, file, arguments, common)?;
    let mut moving = moving(&arguments.chosen, common)?;
    moving.look(&arguments.seen)?;
    let repeats = !arguments.once && (arguments.again || !matches!(kind, Kind::Video(_)));
    let shot = moving.shot(&arguments.fast, repeats, common)?;
    if shot.seconds < SHORT && !common.quiet {
        print_note(&format!("note: the motion is shown in {:.3} s; `--speed 0.1` or `--duration 4` shows it more slowly", shot.seconds));
    }
    interrupt::begins(format!("interrupted: `{}` is not written", file.display()), false);
    made(kind, file, &moving, &shot, arguments, common)
}

/// What a path asks for by its ending; what is wrong was reported.
fn kind(file: &Path) -> Result<Kind, u8> {
    if file.as_os_str().to_string_lossy().ends_with(['/', std::path::MAIN_SEPARATOR]) || file.is_dir() {
        return Ok(Kind::Frames);
    }
    let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    match ending.as_deref() {
        Some("gif") => Ok(Kind::Gif),
        Some("svg") => Ok(Kind::Svg),
        Some("mp4") => Ok(Kind::Video(video::Codec::H264)),
        Some("webm") => Ok(Kind::Video(video::Codec::Vp9)),
        _ => {
            print_error(
                &format!("the ending of `{}` is not known", file.display()),
                "name a file that ends in .gif, .svg, .mp4 or .webm, or a directory that ends in `/` for single pictures",
            );
            Err(code::INPUT)
        }
    }
}

/// Looks, before anything is computed, whether it can be made and written; what is wrong was reported.
fn ready(kind: Kind, file: &Path, arguments: &Arguments, common: &Common) -> Result<(), u8> {
    if kind == Kind::Gif && arguments.fast.rate > MOST_OF_GIF {
        print_error(&format!("a GIF shows at most {MOST_OF_GIF} pictures a second"), "give a lower `--rate`, or write .mp4 or .webm");
        return Err(code::INPUT);
    }
    if let Kind::Video(_) = kind {
        video::there()?;
    }
    if kind == Kind::Frames { files::prepare(file, &[], common) } else { files::may_write(file, common) }
}

fn made(kind: Kind, file: &Path, moving: &Moving, shot: &Shot, arguments: &Arguments, common: &Common) -> Result<(), u8> {
    let results = &moving.results;
    let film = Film::new(&results.model, &results.study, moving.name(), moving.scene(), shot);
    let width = usize::from(arguments.size);
    let progress = Progress::new(&results.study, film.count(), common.quiet);
    let step = || progress.step();
    match kind {
        Kind::Svg => put(file, moving_svg(&film, width).as_bytes(), common),
        Kind::Gif => {
            let mut bytes = Vec::new();
            write_gif(&Projector::new(&film, width), common.threads(), &mut bytes, &interrupted, &step).map_err(|error| unmade(&error))?;
            put(file, &bytes, common)
        }
        Kind::Video(codec) => {
            let projector = Projector::new(&film, width);
            let temporary = files::unfinished(file);
            uncut(|| {
                let encoded = video::encoded(codec, &projector, shot.rate, &temporary, common, &step);
                let placed = encoded.and_then(|()| files::place(&temporary, file, common));
                if placed.is_err() {
                    let _ = std::fs::remove_file(&temporary);
                }
                placed
            })
        }
        Kind::Frames => pictures(file, &Projector::new(&film, width), film.count(), common, &step),
    }
}

/// A PNG file for each picture, all of them or none.
fn pictures(directory: &Path, projector: &Projector<'_>, count: usize, common: &Common, step: &(dyn Fn() + Sync)) -> Result<(), u8> {
    let digits = count.to_string().len().max(4);
    let mut staging = Staging::new();
    for first in (0..count).step_by(HELD) {
        let made = par::map(HELD.min(count - first), common.threads(), |i| projector.png(first + i), step);
        stopped()?;
        for (i, bytes) in made.into_iter().enumerate() {
            staging.add(format!("{:0digits$}.png", first + i + 1), bytes.map_err(|error| unmade(&error))?);
        }
    }
    let directory: PathBuf = directory.components().collect();
    files::commit(&staging, &directory, "frames", common)
}

/// Writes a file, unless it is interrupted.
fn put(file: &Path, bytes: &[u8], common: &Common) -> Result<(), u8> {
    stopped()?;
    if files::write_new(file, bytes, common) { Ok(()) } else { Err(code::INPUT) }
}

/// An error if a signal has come.
fn stopped() -> Result<(), u8> {
    if interrupted() {
        interrupt::print_end("interrupted: nothing is written");
        return Err(code::INTERRUPTED);
    }
    Ok(())
}

fn unmade(error: &RenderError) -> u8 {
    print_error(&error.to_string(), "make it smaller with `--size`");
    code::INPUT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_say_what_is_made() {
        assert_eq!(kind(Path::new("a.GIF")), Ok(Kind::Gif));
        assert_eq!(kind(Path::new("no/such/place/")), Ok(Kind::Frames));
        assert_eq!(kind(Path::new("a.avi")), Err(code::INPUT));
    }
}
