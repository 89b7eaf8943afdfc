//! Forces in the picture, in the first position.

use super::Posed;
use crate::output::pose::{Force, ForceKind};
use crate::results::scene::{Arrow, ArrowKind, Place};

impl Posed<'_> {
    /// Forces whose values are known.
    pub(super) fn forces(&self) -> impl Iterator<Item = Force> {
        let frames = &self.scene.frames;
        let first = frames.shown.first().copied().filter(|first| *first < frames.count());
        self.scene.arrows.iter().filter_map(move |arrow| self.force(first?, arrow))
    }

    fn force(&self, frame: usize, arrow: &Arrow) -> Option<Force> {
        let width = arrow.values.len() / self.scene.frames.count();
        let values = arrow.values.get(frame * width..(frame + 1) * width).filter(|values| !values.is_empty())?;
        let at = self.flat(self.scene.frame(frame), &Place { body: arrow.body, at: arrow.at.clone() });
        let kind = if arrow.kind == ArrowKind::Reaction { ForceKind::Reaction } else { ForceKind::Load };
        let vector: [f64; 3] = match *values {
            [turning] => [0.0, 0.0, turning],
            _ => std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0)),
        };
        if !vector.iter().all(|x| x.is_finite()) {
            return None;
        }
        let (along, turning) =
            if arrow.kind == ArrowKind::Torque { ([0.0; 2], self.view.depth(vector)) } else { (self.view.flat(vector), 0.0) };
        Some(Force { kind, at, along, turning, scale: arrow.scale })
    }
}
