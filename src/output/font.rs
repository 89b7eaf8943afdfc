//! The embedded font: DejaVu Sans, cut to Latin, Greek, superscripts, subscripts and mathematics (licence in `assets/`).
//!
//! Measured by the same code for both kinds of picture, so that a layout holds in SVG as in PNG.

use ab_glyph::{Font, FontRef, Glyph, PxScale, point};
use std::sync::OnceLock;

const BYTES: &[u8] = include_bytes!("../../assets/DejaVuSans.ttf");

/// The height of a capital letter for font size 1.
pub(super) const CAPITAL: f64 = 0.73;

fn font() -> Option<&'static FontRef<'static>> {
    static FONT: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    // A test below holds that the embedded bytes are a font; without one, pictures would merely lack their text.
    FONT.get_or_init(|| FontRef::try_from_slice(BYTES).ok()).as_ref()
}

/// The glyphs of `text` from the origin, and the width of the line, for the CSS font size `size` in pixels.
fn set(font: &FontRef<'static>, text: &str, size: f64) -> (Vec<Glyph>, f64) {
    let units = f64::from(font.units_per_em().unwrap_or(1000.0));
    // ab_glyph scales by the height of a line, CSS by the em.
    let scale = PxScale::from((size * f64::from(font.height_unscaled()) / units) as f32);
    let mut x = 0.0;
    let glyphs = text.chars().map(|c| {
        let id = font.glyph_id(c);
        let glyph = id.with_scale_and_position(scale, point(x as f32, 0.0));
        x += f64::from(font.h_advance_unscaled(id)) * size / units;
        glyph
    });
    let glyphs = glyphs.collect();
    (glyphs, x)
}

/// The width of `text` at the font size `size`.
pub(super) fn width(text: &str, size: f64) -> f64 {
    font().map_or(0.0, |font| set(font, text, size).1)
}

/// Calls `paint(x, y, coverage)` for every pixel of `text` set from the origin, base line at y = 0.
pub(super) fn paint(text: &str, size: f64, mut paint: impl FnMut(i32, i32, f32)) {
    let Some(font) = font() else { return };
    for outline in set(font, text, size).0.into_iter().filter_map(|glyph| font.outline_glyph(glyph)) {
        let bounds = outline.px_bounds();
        outline.draw(|x, y, coverage| paint(x as i32 + bounds.min.x as i32, y as i32 + bounds.min.y as i32, coverage));
    }
}

/// `text` shortened with an ellipsis until it is no wider than `room`.
pub(super) fn fitted(text: &str, size: f64, room: f64) -> String {
    if width(text, size) <= room {
        return text.to_owned();
    }
    let mut short: Vec<char> = text.chars().collect();
    while short.pop().is_some() {
        let candidate = short.iter().collect::<String>().trim_end().to_owned() + "…";
        if width(&candidate, size) <= room {
            return candidate;
        }
    }
    String::new()
}

/// `text` shortened in its middle: names of runs and of figures differ at their ends.
pub(super) fn fitted_between(text: &str, size: f64, room: f64) -> String {
    let letters: Vec<char> = text.chars().collect();
    let cut = |kept: usize| {
        let (head, tail) = (kept.div_ceil(2), kept / 2);
        letters[..head].iter().collect::<String>() + "…" + &letters[letters.len() - tail..].iter().collect::<String>()
    };
    let fits = |text: &String| width(text, size) <= room;
    if width(text, size) <= room { text.to_owned() } else { (0..letters.len()).rev().map(cut).find(fits).unwrap_or_default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_is_embedded_and_has_the_letters_of_the_field() {
        let font = font().expect("a font");
        for c in "AZaz09äßé θφψωλΦ ²³⁻⁶₁₂ −·×≤∂√ …".chars().filter(|c| !c.is_whitespace()) {
            assert_ne!(font.glyph_id(c).0, 0, "{c}");
        }
        // The advance of "H" in DejaVu Sans is 1540 of 2048.
        assert!((width("HH", 20.0) - 2.0 * 20.0 * 1540.0 / 2048.0).abs() < 1e-6);
    }

    #[test]
    fn long_text_is_shortened() {
        let text = fitted("a label that is far too long", 20.0, 120.0);
        assert!(text.ends_with('…') && width(&text, 20.0) <= 120.0);
        assert_eq!(fitted("short", 20.0, 120.0), "short");
        assert_eq!(fitted("short", 20.0, 1.0), "");
        let text = fitted_between("run with I_f = 120", 20.0, 120.0);
        assert!(text.starts_with("run") && text.ends_with("120") && text.contains('…'), "{text}");
    }
}
