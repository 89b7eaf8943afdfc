//! Rows of a driven motion on a grid.

use super::motion::{Lost, Motion};
use super::recorder::Recorder;
use crate::geometry::Space;
use crate::numerics::continuous::Curve;

impl<G: Space<S = f64>> Motion<'_, G> {
    /// Rows on the grid of `samples` equal intervals of the whole range, with both sides of every switch.
    ///
    /// # Errors
    /// If a place cannot be reached.
    pub(crate) fn rows(&mut self, samples: usize, recorder: &mut Recorder<'_>) -> Result<(), Lost> {
        let spacing = self.clock.length / samples as f64;
        let at = |k: i64| if k == samples as i64 { self.clock.length } else { k as f64 * spacing };
        // a switch that stands on the grid but for rounding is written there
        let written = |s: f64| {
            let near = at((s / spacing).round() as i64);
            if (near - s).abs() < 1e-9 * spacing { near } else { s }
        };
        let (breaks, [low, high]) = (self.breaks.clone(), self.ends);
        let mut places = Vec::new();
        for (piece, ends) in breaks.windows(2).enumerate() {
            let [from, to] = [ends[0], ends[1]].map(|s| if s == low || s == high { s } else { written(s) });
            let inside = (from / spacing).floor() as i64..=(to / spacing).ceil() as i64;
            let near = 1e-9 * spacing;
            let grid = inside.map(at).filter(|s| *s > from + near && *s < to - near);
            places.extend(std::iter::once(from).chain(grid).chain([to]).map(|s| (s, piece)));
        }
        let mut out = vec![0.0; self.columns()];
        for (s, piece) in places {
            self.row(s, piece, &mut out)?;
            recorder.row(s, piece, &out);
        }
        Ok(())
    }
}
