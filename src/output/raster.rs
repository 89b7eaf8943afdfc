//! A display list as PNG: drawn three times as large by plotters' bitmap, then averaged down.
//!
//! At its own size the bitmap's lines are jagged; nine samples a pixel make them as smooth as those of other plotting programs.

use super::font;
use super::scene::{Anchor, Color, Item, Scene, Stroke, Text, WHITE};
use super::thin::Point;
use plotters::backend::{BitMapBackend, DrawingBackend};
use plotters::style::{Color as _, RGBAColor, RGBColor};
use std::fmt;

/// Samples a pixel in each direction.
const FINE: usize = 3;

/// Samples by which a disc may be off its circle.
const OFF: f64 = 0.2;

/// Pixels in a row that are averaged together, and samples of those on which nothing is drawn.
const CELL: usize = 16;
const PAPER: u8 = 255;
const BLANK: [u8; CELL * FINE * 3] = [PAPER; CELL * FINE * 3];

/// A picture that could not be made; with pictures held in memory this is no user's fault.
#[derive(Debug)]
pub struct RenderError(pub(super) String);

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot make the picture: {}", self.0)
    }
}

impl std::error::Error for RenderError {}

/// The bytes of a PNG file.
pub(super) fn write_png(scene: &Scene) -> Result<Vec<u8>, RenderError> {
    let (width, height) = (scene.width.ceil() as usize, scene.height.ceil() as usize);
    let mut fine = vec![PAPER; width * height * FINE * FINE * 3];
    {
        let backend = BitMapBackend::with_buffer(&mut fine, ((width * FINE) as u32, (height * FINE) as u32));
        let mut painter = Painter { backend, scale: FINE as f64 };
        for item in &scene.items {
            painter.item(item)?;
        }
    }
    encode(&averaged(&fine, width, height), width, height)
}

/// The bytes of a PNG file of pixels: red, green, blue of each, row by row.
pub(super) fn encode(pixels: &[u8], width: usize, height: usize) -> Result<Vec<u8>, RenderError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    // half as large again as the best, in an eighth of its time
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(pixels).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// The mean of each block of `FINE` times `FINE` samples.
fn averaged(fine: &[u8], width: usize, height: usize) -> Vec<u8> {
    let row = width * FINE * 3;
    let mut coarse = Vec::with_capacity(width * height * 3);
    for block in fine.chunks_exact(row * FINE) {
        for from in (0..row).step_by(CELL * FINE * 3) {
            let cell = from..row.min(from + CELL * FINE * 3);
            let lines = block.chunks_exact(row).map(|line| &line[cell.clone()]);
            // most of a picture is paper
            if lines.clone().all(|line| *line == BLANK[..line.len()]) {
                coarse.resize(coarse.len() + cell.len() / FINE, PAPER);
                continue;
            }
            let mut sums = [[0u16; 3]; CELL];
            for line in lines {
                for (sum, pixel) in sums.iter_mut().zip(line.chunks_exact(FINE * 3)) {
                    for sample in pixel.chunks_exact(3) {
                        (0..3).for_each(|k| sum[k] += u16::from(sample[k]));
                    }
                }
            }
            let count = (FINE * FINE) as u16;
            coarse.extend(sums.as_flattened()[..cell.len() / FINE].iter().map(|sum| ((sum + count / 2) / count) as u8));
        }
    }
    coarse
}

struct Painter<'a> {
    backend: BitMapBackend<'a>,
    scale: f64,
}

fn failed(error: impl fmt::Display) -> RenderError {
    RenderError(error.to_string())
}

impl Painter<'_> {
    fn item(&mut self, item: &Item) -> Result<(), RenderError> {
        match item {
            Item::Path { points, closed, fill, stroke } => {
                let mut points = points.clone();
                if let Some(color) = fill {
                    self.fill(&points, *color, 1.0)?;
                }
                if *closed {
                    points.extend(points.first().copied());
                }
                stroke.map_or(Ok(()), |stroke| self.stroke(&points, stroke))
            }
            Item::Circle { at, radius, fill, stroke } => {
                if let Some(stroke) = stroke {
                    self.disc(*at, radius + stroke.width / 2.0, stroke.color)?;
                    // The inside of an open circle is the paper's.
                    self.disc(*at, radius - stroke.width / 2.0, fill.unwrap_or(WHITE))?;
                } else if let Some(color) = fill {
                    self.disc(*at, *radius, *color)?;
                }
                Ok(())
            }
            Item::Veil { points, color, opacity } => self.fill(points, *color, *opacity),
            Item::Text(text) => self.text(text),
        }
    }

    /// The nearest sample; far outside the paper it is cut off, where the backend's whole numbers would overflow.
    fn sample(&self, [x, y]: Point) -> (i32, i32) {
        let nearest = |x: f64| (x * self.scale).round().clamp(-30_000.0, 30_000.0) as i32;
        (nearest(x), nearest(y))
    }

    fn fill(&mut self, points: &[Point], color: Color, opacity: f64) -> Result<(), RenderError> {
        let points: Vec<_> = points.iter().map(|point| self.sample(*point)).collect();
        if points.len() < 3 {
            return Ok(());
        }
        let [r, g, b] = color;
        self.backend.fill_polygon(points, &RGBColor(r, g, b).mix(opacity)).map_err(failed)
    }

    fn disc(&mut self, at: Point, radius: f64, color: Color) -> Result<(), RenderError> {
        if radius <= 0.0 {
            return Ok(());
        }
        // edges of n corners are off the circle by r (π/n)²/2
        let corners = (std::f64::consts::PI * (0.5 * radius * self.scale / OFF).sqrt()).clamp(48.0, 720.0).ceil();
        let around = |k: i32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / corners).sin_cos();
            [at[0] + radius * cos, at[1] + radius * sin]
        };
        self.fill(&(0..corners as i32).map(around).collect::<Vec<_>>(), color, 1.0)
    }

    /// A line of quadrilaterals, with discs where they meet: the backend's own thick lines have mitres that stick out of peaks.
    fn stroke(&mut self, points: &[Point], stroke: Stroke) -> Result<(), RenderError> {
        let solid = stroke.dash.is_empty();
        for dash in dashes(points, stroke.dash) {
            for ends in dash.windows(2) {
                let [a, b] = [ends[0], ends[1]];
                let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                if length > 0.0 {
                    let normal = [(a[1] - b[1]) / length * stroke.width / 2.0, (b[0] - a[0]) / length * stroke.width / 2.0];
                    let off = |p: Point, side: f64| [p[0] + side * normal[0], p[1] + side * normal[1]];
                    self.fill(&[off(a, 1.0), off(b, 1.0), off(b, -1.0), off(a, -1.0)], stroke.color, 1.0)?;
                }
            }
            let inner = 1..dash.len().saturating_sub(1);
            let joints = if solid { &dash[..] } else { dash.get(inner).unwrap_or_default() };
            if stroke.width > 1.5 {
                joints.iter().try_for_each(|joint| self.disc(*joint, stroke.width / 2.0, stroke.color))?;
            }
        }
        Ok(())
    }

    fn text(&mut self, text: &Text) -> Result<(), RenderError> {
        let size = text.size * self.scale;
        let width = font::width(&text.text, size);
        let back = match text.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => width / 2.0,
            Anchor::End => width,
        };
        let (x, y) = self.sample(text.at);
        let origin = if text.upright { (x, y + back.round() as i32) } else { (x - back.round() as i32, y) };
        let mut pixels = Vec::new();
        font::paint(&text.text, size, |x, y, coverage| {
            if coverage > 0.0 {
                pixels.push((if text.upright { (y, -x) } else { (x, y) }, coverage));
            }
        });
        if text.halo {
            let radius = size * 0.14;
            for step in 0..24 {
                let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 24.0).sin_cos();
                let shift = ((radius * cos).round() as i32, (radius * sin).round() as i32);
                self.pixels(&pixels, (origin.0 + shift.0, origin.1 + shift.1), WHITE)?;
            }
        }
        self.pixels(&pixels, origin, text.color)
    }

    fn pixels(&mut self, pixels: &[((i32, i32), f32)], (x, y): (i32, i32), [r, g, b]: Color) -> Result<(), RenderError> {
        for ((dx, dy), coverage) in pixels {
            let color = RGBAColor(r, g, b, f64::from(*coverage));
            self.backend.draw_pixel((x + dx, y + dy), color.to_backend_color()).map_err(failed)?;
        }
        Ok(())
    }
}

/// The dashes of a line through `points`, each a line of its own.
pub(super) fn dashes(points: &[Point], dash: &[f64]) -> Vec<Vec<Point>> {
    let whole: f64 = dash.iter().sum();
    if !(whole > 0.0 && whole.is_finite()) {
        return vec![points.to_vec()];
    }
    let (mut out, mut current) = (Vec::new(), points.first().map(|point| vec![*point]).unwrap_or_default());
    let (mut index, mut left) = (0, dash[0]);
    for ends in points.windows(2) {
        let [mut a, b] = [ends[0], ends[1]];
        loop {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if length <= left {
                left -= length;
                current.push(b);
                break;
            }
            let s = left / length;
            a = [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])];
            current.push(a);
            // Even entries are dashes, odd ones gaps.
            if index % 2 == 0 {
                out.push(std::mem::take(&mut current));
            }
            current = vec![a];
            index = (index + 1) % dash.len();
            left = dash[index].max(0.01);
        }
    }
    if index % 2 == 0 && current.len() > 1 {
        out.push(current);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_follow_the_corners_of_the_line() {
        let pieces = dashes(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]], &[8.0, 4.0]);
        assert_eq!(pieces, [vec![[0.0, 0.0], [8.0, 0.0]], vec![[10.0, 2.0], [10.0, 10.0]]]);
        assert!(dashes(&[], &[1.0, 1.0]).is_empty());
    }

    /// The pixels of a picture with one item in its right half.
    fn painted(item: impl Fn(&mut Scene, Vec<Point>)) -> Vec<u8> {
        let mut scene = Scene { width: 8.0, height: 4.0, ..Scene::default() };
        item(&mut scene, vec![[4.0, -1.0], [9.0, -1.0], [9.0, 5.0], [4.0, 5.0]]);
        let bytes = write_png(&scene).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        pixels
    }

    #[test]
    fn a_filled_half_is_black_in_the_picture() {
        let pixels = painted(|scene, square| scene.shape(square, Some([0, 0, 0]), None));
        assert_eq!(pixels[..3], [255, 255, 255]);
        assert_eq!(pixels[21..24], [0, 0, 0]);
    }

    #[test]
    fn what_is_behind_a_veil_is_seen() {
        let pixels = painted(|scene, square| scene.veil(square, [0, 0, 0], 0.4));
        assert_eq!(pixels[..3], [255, 255, 255]);
        assert!(pixels[21..24].iter().all(|x| x.abs_diff(153) <= 2), "{:?}", &pixels[21..24]);
    }
}
