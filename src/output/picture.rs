//! A picture as text and as pixels.

use super::raster::{self, RenderError};
use super::scene::Scene;
use super::svg;

/// One picture in both of its forms.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The text of an SVG file.
    pub svg: String,
    /// The bytes of a PNG file.
    pub png: Vec<u8>,
}

impl Picture {
    /// Both forms of one display list.
    pub(super) fn of(scene: &Scene) -> Result<Self, RenderError> {
        Ok(Self { svg: svg::write_svg(scene), png: raster::write_png(scene)? })
    }
}
