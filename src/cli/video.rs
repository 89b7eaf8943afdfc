//! Films by `ffmpeg`, where it is installed: pixels go to it through a pipe.

use super::interrupt::interrupted;
use super::{Common, code, interrupt, print_error};
use grashof::output::Projector;
use grashof::par;
use std::ffi::OsStr;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// Pictures that are held at a time.
const HELD: usize = 32;

/// How a film is coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Codec {
    /// In .mp4.
    H264,
    /// In .webm.
    Vp9,
}

impl Codec {
    fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::H264 => &["-c:v", "libx264", "-crf", "20", "-movflags", "+faststart", "-f", "mp4"],
            Self::Vp9 => &["-c:v", "libvpx-vp9", "-crf", "30", "-b:v", "0", "-row-mt", "1", "-f", "webm"],
        }
    }
}

/// Looks whether there is an `ffmpeg`; that there is none was reported.
pub(super) fn there() -> Result<(), u8> {
    let found = Command::new("ffmpeg").arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    if found.is_ok_and(|status| status.success()) {
        return Ok(());
    }
    print_error(
        "films are made by the program `ffmpeg`, which is not found",
        "install it (`apt-get install ffmpeg`, `brew install ffmpeg`), or write .gif, .svg or single pictures (`-o frames/`)",
    );
    Err(code::INPUT)
}

/// Makes a film of all pictures; what is wrong was reported.
pub(super) fn encoded(
    codec: Codec,
    projector: &Projector<'_>,
    rate: f64,
    file: &Path,
    common: &Common,
    step: &(dyn Fn() + Sync),
) -> Result<(), u8> {
    let [width, height] = projector.size();
    let (size, rate) = (format!("{width}x{height}"), rate.to_string());
    let input = ["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size, "-r", &rate, "-i", "-"];
    // players want even sides
    let shape = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p"];
    let all = input.iter().chain(&shape).chain(codec.arguments()).map(OsStr::new).chain([file.as_os_str()]);
    let child = Command::new("ffmpeg").args(all).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
    let mut child = child.map_err(|error| failed(&error.to_string()))?;
    let said = child.stderr.take().map(|mut from| {
        std::thread::spawn(move || {
            let mut text = String::new();
            let _ = from.read_to_string(&mut text);
            text
        })
    });
    let fed = feed(&mut child, projector, common, step);
    if interrupted() {
        let _ = child.kill();
        let _ = child.wait();
        interrupt::print_end("interrupted: nothing is written");
        return Err(code::INTERRUPTED);
    }
    let status = child.wait();
    let said = said.and_then(|thread| thread.join().ok()).unwrap_or_default();
    match (status, fed) {
        (Ok(status), Ok(())) if status.success() => Ok(()),
        (Err(error), _) | (Ok(_), Err(error)) if said.trim().is_empty() => Err(failed(&error.to_string())),
        _ => Err(failed(said.trim())),
    }
}

/// Gives all pictures to ffmpeg.
fn feed(child: &mut Child, projector: &Projector<'_>, common: &Common, step: &(dyn Fn() + Sync)) -> std::io::Result<()> {
    let Some(mut pipe) = child.stdin.take() else { return Ok(()) };
    let count = projector.count();
    // who has heard a signal makes no more pictures
    let picture = |index: usize| if interrupted() { Vec::new() } else { projector.rgb(index) };
    for first in (0..count).step_by(HELD) {
        let pictures = par::map(HELD.min(count - first), common.threads(), |i| picture(first + i), step);
        if interrupted() {
            break;
        }
        pictures.iter().try_for_each(|picture| pipe.write_all(picture))?;
    }
    Ok(())
}

fn failed(why: &str) -> u8 {
    let why = if why.is_empty() { "it ended with an error" } else { why };
    print_error(
        &format!("`ffmpeg` cannot make the film: {why}"),
        "look at its message, or write .gif, .svg or single pictures (`-o frames/`)",
    );
    code::INPUT
}
