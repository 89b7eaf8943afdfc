//! Arrows that tell how a mechanism has moved from rest: a shape of its vibrations.

use super::forces::{arrow, turned};
use super::lettering::{Lettering, Obstacle};
use super::pose::{Drawing, Move};
use super::scene::{Color, Scene};
use super::sheet::{Sheet, is_usable};
use super::symbols::{Signs, direction};

/// None of bodies, springs, drives, paths and forces is near it.
const COLOR: Color = [168, 0, 112];
/// Radius of an arrow around what turns, pixels.
const AROUND: f64 = 42.0;
/// Shorter arrows are not seen, pixels.
const SEEN: f64 = 6.0;

/// Draws the arrows of a drawing, of which names keep clear.
pub(super) fn draw(drawing: &Drawing, sheet: &Sheet, signs: Signs, scene: &mut Scene, letters: &mut Lettering) {
    let thin = Signs { size: 0.75 * signs.size };
    for moved in &drawing.moves {
        let outline = match moved {
            Move::Shift { from, to } if is_usable(from) && is_usable(to) => {
                let ends = [sheet.point(*from), sheet.point(*to)];
                if direction(ends[0], ends[1]).1 < SEEN {
                    continue;
                }
                letters.avoid_line(&ends, Obstacle::Body);
                arrow(thin, ends)
            }
            Move::Turn { at, across } if is_usable(at) => {
                let at = sheet.point(*at);
                letters.avoid(at, [AROUND * signs.size + 6.0; 2], [0.0; 2]);
                turned(thin, at, across.map(|[x, y]| [x, -y]), AROUND * signs.size, 1.0)
            }
            _ => continue,
        };
        scene.shape(outline, Some(COLOR), None);
    }
}
