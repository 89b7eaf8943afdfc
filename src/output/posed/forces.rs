//! Forces in the picture.

use super::Posed;
use crate::output::pose::{Force, ForceKind};
use crate::output::view::dot;
use crate::results::scene::{Arrow, ArrowKind, Place};
use std::f64::consts::TAU;

/// Part of the largest force of a motion below which one is round-off.
const ROUND_OFF: f64 = 1e-9;

impl Posed<'_> {
    /// The forces whose values are known, in the first position, at a place of the independent variable; one that is not finite is 0.
    pub(super) fn forces(&self, at: f64) -> impl Iterator<Item = Force> {
        let frames = &self.scene.frames.at;
        let above = frames.partition_point(|place| *place <= at);
        let (low, high) = (above.saturating_sub(1), above.min(frames.len().saturating_sub(1)));
        let between = |from: &f64, to: &f64| if to > from { ((at - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        let part = frames.get(low).zip(frames.get(high)).map_or(0.0, |(from, to)| between(from, to));
        let round_off = ROUND_OFF * self.largest();
        self.scene.arrows.iter().filter_map(move |arrow| {
            let force = self.force(arrow, [low, high], part)?;
            let none = force.turning.is_none() && force.size < round_off;
            Some(if none { Force { along: [0.0; 2], size: 0.0, ..force } } else { force })
        })
    }

    /// The largest force that an arrow shows anywhere in the motion, N.
    fn largest(&self) -> f64 {
        let forces = self.scene.arrows.iter().filter(|arrow| arrow.kind != ArrowKind::Torque);
        let sizes = forces.flat_map(|arrow| {
            let width = (arrow.values.len() / self.scene.frames.count().max(1)).max(1);
            arrow.values.chunks(width).map(|force| force.iter().map(|x| x * x).sum::<f64>().sqrt())
        });
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
    }

    /// A force between two frames, on a straight line.
    fn force(&self, arrow: &Arrow, [low, high]: [usize; 2], part: f64) -> Option<Force> {
        let width = arrow.values.len() / self.scene.frames.count().max(1);
        let of = |frame: usize| arrow.values.get(frame * width..(frame + 1) * width).filter(|values| !values.is_empty());
        let (from, to) = (of(low)?, of(high)?);
        let values: Vec<f64> = from.iter().zip(to).map(|(from, to)| if part > 0.0 { from + part * (to - from) } else { *from }).collect();
        let at = self.flat(self.frames.first()?, &Place { body: arrow.body, at: arrow.at.clone() });
        let kind = if arrow.kind == ArrowKind::Reaction { ForceKind::Reaction } else { ForceKind::Load };
        let vector: [f64; 3] = match values[..] {
            [turning] => [0.0, 0.0, turning],
            _ => std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0)),
        };
        let vector = if vector.iter().all(|x| x.is_finite()) { vector } else { [0.0; 3] };
        let size = dot(vector, vector).sqrt();
        if arrow.kind != ArrowKind::Torque {
            return Some(Force { kind, at, along: self.view.flat(vector), size, scale: arrow.scale, ..Force::default() });
        }
        let (turning, across) = match values[..] {
            [turning] => (if turning.is_finite() { turning } else { 0.0 }, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
            _ => (size, self.view.facing(vector, 0.75 * TAU)),
        };
        Some(Force {
            kind,
            at,
            turning: Some(turning),
            across: across.map(|e| self.view.flat(e)),
            size,
            scale: arrow.scale,
            ..Force::default()
        })
    }
}
