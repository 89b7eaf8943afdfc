//! A film as GIF: one palette, and of each picture the rectangle that has changed.

use super::film::Projector;
use super::palette::Palette;
use crate::output::raster::RenderError;
use crate::par;
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use std::borrow::Cow;
use std::io::Write;

/// Pictures from which the palette is taken.
const SAMPLES: usize = 9;
/// Pictures that are held at a time.
const HELD: usize = 64;

/// Writes a film as GIF. Pictures are made by so many threads; `done` is called after each, from any thread, and the writing ends
/// without an error where `stop` says so.
///
/// # Errors
/// If it is larger than a GIF may be, or what takes the bytes fails.
pub fn write_gif(
    projector: &Projector<'_>,
    threads: usize,
    out: impl Write,
    stop: &(dyn Fn() -> bool + Sync),
    done: &(dyn Fn() + Sync),
) -> Result<(), RenderError> {
    let (film, [width, height]) = (projector.film, projector.size());
    let sides = u16::try_from(width).ok().zip(u16::try_from(height).ok());
    let (w, h) = sides.ok_or_else(|| RenderError("a GIF has at most 65535 pixels in each direction".into()))?;
    let count = film.count();
    let samples = par::map(SAMPLES.min(count), threads, |i| projector.rgb(i * count / SAMPLES.min(count)), || {});
    let palette = Palette::of(&projector.colors(), &samples);
    let mut encoder = Encoder::new(out, w, h, &palette.bytes()).map_err(failed)?;
    if film.shot().repeats {
        encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    }
    // the last picture of what was written before, none at the beginning
    let mut before: Option<Vec<u8>> = None;
    for first in (0..count).step_by(HELD) {
        let pictures = par::map(HELD.min(count - first), threads, |i| palette.indices(&projector.rgb(first + i)), done);
        if stop() {
            return Ok(());
        }
        let frames = par::map(
            pictures.len(),
            threads,
            |i| {
                let below = i.checked_sub(1).map_or(before.as_deref(), |i| Some(&pictures[i]));
                let mut frame = changed(below, &pictures[i], width, palette.same());
                frame.delay = delay(first + i, film.shot().rate);
                frame.make_lzw_pre_encoded();
                frame
            },
            || {},
        );
        frames.iter().try_for_each(|frame| encoder.write_lzw_pre_encoded_frame(frame)).map_err(failed)?;
        before = pictures.into_iter().next_back();
    }
    Ok(())
}

fn failed(error: impl std::fmt::Display) -> RenderError {
    RenderError(error.to_string())
}

/// How long a picture stays, in hundredths of a second: whole ones, so that their sum never is off by more than half of one.
fn delay(index: usize, rate: f64) -> u16 {
    let at = |index: usize| (100.0 * index as f64 / rate).round();
    (at(index + 1) - at(index)).clamp(0.0, f64::from(u16::MAX)) as u16
}

/// The smallest rectangle of a picture with all that differs from the one below it; the same pixels in it have the index `same`.
fn changed(below: Option<&[u8]>, picture: &[u8], width: usize, same: u8) -> Frame<'static> {
    let frame = |[left, top]: [usize; 2], [wide, high]: [usize; 2], buffer: Vec<u8>| Frame {
        left: left as u16,
        top: top as u16,
        width: wide as u16,
        height: high as u16,
        dispose: DisposalMethod::Keep,
        transparent: Some(same),
        buffer: Cow::Owned(buffer),
        ..Frame::default()
    };
    let Some(below) = below else { return frame([0, 0], [width, picture.len() / width], picture.to_vec()) };
    let rows = || picture.chunks_exact(width).zip(below.chunks_exact(width)).enumerate().filter(|(_, (new, old))| new != old);
    let (Some((top, _)), Some((bottom, _))) = (rows().next(), rows().next_back()) else { return frame([0, 0], [1, 1], vec![same]) };
    let mut range = [width, 0];
    for (_, (new, old)) in rows() {
        let differs = |(new, old): (&u8, &u8)| new != old;
        range[0] = new.iter().zip(old).position(differs).unwrap_or(width).min(range[0]);
        range[1] = new.iter().zip(old).rposition(differs).unwrap_or(0).max(range[1]);
    }
    let wide = range[1] + 1 - range[0];
    let cut = |row: usize| row * width + range[0]..row * width + range[0] + wide;
    let pixels = (top..=bottom).flat_map(|row| picture[cut(row)].iter().zip(&below[cut(row)]));
    let buffer = pixels.map(|(new, old)| if new == old { same } else { *new }).collect();
    frame([range[0], top], [wide, bottom + 1 - top], buffer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_changed_rectangle_is_the_smallest() {
        let below = [0; 12];
        let mut picture = below;
        picture[5] = 1;
        picture[10] = 2;
        let frame = changed(Some(&below), &picture, 4, 9);
        assert_eq!((frame.left, frame.top, frame.width, frame.height), (1, 1, 2, 2));
        assert_eq!(*frame.buffer, [1, 9, 9, 2]);
        let still = changed(Some(&below), &below, 4, 9);
        assert_eq!((still.width, still.height, &*still.buffer), (1, 1, &[9][..]));
    }

    #[test]
    fn delays_add_up() {
        assert_eq!((0..6).map(|k| delay(k, 30.0)).collect::<Vec<_>>(), [3, 4, 3, 3, 4, 3]);
        assert_eq!((0..300).map(|k| u32::from(delay(k, 30.0))).sum::<u32>(), 1000);
    }
}
