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
        let force = self.largest(false);
        // a moment may be the difference of forces times their arms
        let round_off = [force, self.largest(true).max(force * self.reach())].map(|most| ROUND_OFF * most);
        self.scene.arrows.iter().filter_map(move |arrow| {
            let force = self.force(arrow, [low, high], part)?;
            let none = force.size < round_off[usize::from(force.turning.is_some())];
            Some(if none { Force { along: [0.0; 2], size: 0.0, turning: force.turning.map(|_| 0.0), ..force } } else { force })
        })
    }

    /// The largest force that an arrow shows anywhere in the motion, N, or the largest that turns, N m.
    fn largest(&self, turns: bool) -> f64 {
        let forces = self.scene.arrows.iter().filter(|arrow| arrow.kind.turns() == turns);
        let sizes = forces.flat_map(|arrow| {
            let width = (arrow.values.len() / self.scene.frames.count().max(1)).max(1);
            arrow.values.chunks(width).map(|force| force.iter().map(|x| x * x).sum::<f64>().sqrt())
        });
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
    }

    /// How far joints are from the first one in the first position, m.
    fn reach(&self) -> f64 {
        let Some(poses) = self.frames.first() else { return 0.0 };
        let places: Vec<[f64; 2]> = self.scene.joints.iter().map(|joint| self.flat(poses, &joint.a)).collect();
        places.iter().fold(0.0, |far, p| f64::max(far, (p[0] - places[0][0]).hypot(p[1] - places[0][1])))
    }

    /// A force between two frames, on a straight line.
    fn force(&self, arrow: &Arrow, [low, high]: [usize; 2], part: f64) -> Option<Force> {
        let width = arrow.values.len() / self.scene.frames.count().max(1);
        let of = |frame: usize| arrow.values.get(frame * width..(frame + 1) * width).filter(|values| !values.is_empty());
        let (from, to) = (of(low)?, of(high)?);
        let values: Vec<f64> = from.iter().zip(to).map(|(from, to)| if part > 0.0 { from + part * (to - from) } else { *from }).collect();
        let at = self.flat(self.frames.first()?, &Place { body: arrow.body, at: arrow.at.clone() });
        let of_joint = matches!(arrow.kind, ArrowKind::Reaction | ArrowKind::Moment);
        let kind = if of_joint { ForceKind::Reaction } else { ForceKind::Load };
        let vector: [f64; 3] = match values[..] {
            [turning] => [0.0, 0.0, turning],
            _ => std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0)),
        };
        let vector = if vector.iter().all(|x| x.is_finite()) { vector } else { [0.0; 3] };
        let size = dot(vector, vector).sqrt();
        if !arrow.kind.turns() {
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
