//! The colours of a GIF: at most 256 for all of its pictures.

use crate::output::scene::Color;
use std::collections::HashMap;

/// Colours at most; one index is left for what stays as it was.
const MOST: usize = 255;
/// Bits of a channel by which mixed colours are counted.
const BITS: u32 = 5;

/// Colours by index.
#[derive(Clone, Debug)]
pub(super) struct Palette {
    pub(super) colors: Vec<Color>,
}

impl Palette {
    /// The colours that are drawn with, and of the mixed ones at the edges of shapes those that are most frequent in some pictures.
    pub(super) fn of(drawn: &[Color], pictures: &[Vec<u8>]) -> Self {
        let mut colors: Vec<Color> = drawn.iter().copied().take(MOST).collect();
        // of each cell of the colour space: how many pixels, and the sums of their channels
        let mut cells: HashMap<u32, (u64, [u64; 3])> = HashMap::new();
        for pixel in pictures.iter().flat_map(|picture| picture.chunks_exact(3)) {
            let color = [pixel[0], pixel[1], pixel[2]];
            if !colors.contains(&color) {
                let (count, sums) = cells.entry(cell(color)).or_default();
                *count += 1;
                sums.iter_mut().zip(color).for_each(|(sum, x)| *sum += u64::from(x));
            }
        }
        let mut cells: Vec<_> = cells.into_iter().collect();
        cells.sort_unstable_by_key(|(cell, (count, _))| (u64::MAX - count, *cell));
        let room = MOST - colors.len();
        colors.extend(cells.iter().take(room).map(|(_, (count, sums))| sums.map(|sum| (sum / count) as u8)));
        Self { colors }
    }

    /// The index that stands for "as it was".
    pub(super) fn same(&self) -> u8 {
        self.colors.len() as u8
    }

    /// The colours one after the other, with one for the index of what stays.
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.colors.iter().flatten().copied().chain([0; 3]).collect()
    }

    /// The indices of the nearest colours of all pixels.
    pub(super) fn indices(&self, pixels: &[u8]) -> Vec<u8> {
        let mut known: HashMap<Color, u8> = self.colors.iter().copied().zip(0..=u8::MAX).collect();
        let mut last = ([0; 3], self.nearest([0; 3]));
        let index = |pixel: &[u8]| {
            let color = [pixel[0], pixel[1], pixel[2]];
            if last.0 != color {
                last = (color, *known.entry(color).or_insert_with(|| self.nearest(color)));
            }
            last.1
        };
        pixels.chunks_exact(3).map(index).collect()
    }

    fn nearest(&self, color: Color) -> u8 {
        let far = |other: &Color| (0..3).map(|i| (i32::from(other[i]) - i32::from(color[i])).pow(2)).sum::<i32>();
        (0..=u8::MAX).zip(&self.colors).min_by_key(|(_, other)| far(other)).map_or(0, |(index, _)| index)
    }
}

fn cell(color: Color) -> u32 {
    color.iter().fold(0, |cell, x| cell << BITS | u32::from(*x) >> (8 - BITS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawn_colours_are_exact_and_mixed_ones_near() {
        let drawn = [[255; 3], [10, 20, 30]];
        let picture: Vec<u8> = [[255; 3], [10, 20, 30], [132, 138, 142], [133, 138, 142]].concat();
        let palette = Palette::of(&drawn, std::slice::from_ref(&picture));
        let indices = palette.indices(&picture);
        let colors: Vec<Color> = indices.iter().map(|i| palette.colors[usize::from(*i)]).collect();
        assert_eq!(colors[..2], drawn);
        assert!((0..3).all(|i| colors[2][i].abs_diff([132, 138, 142][i]) <= 1), "{colors:?}");
        assert_eq!(palette.bytes().len(), 3 * (usize::from(palette.same()) + 1));
    }

    #[test]
    fn there_are_never_too_many() {
        let picture: Vec<u8> = (0..40_000u32).flat_map(|k| [(k % 251) as u8, (k / 7 % 253) as u8, (k / 91 % 255) as u8]).collect();
        assert_eq!(Palette::of(&[[255; 3]], &[picture]).same(), 255);
    }
}
