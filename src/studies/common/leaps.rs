//! Laws of couplings that jump by so little that the path of a driven motion has leapt over them: it ends just before.

use super::motion::{Lost, Motion};
use crate::geometry::Space;
use crate::kinematics::driven::NotReached;
use crate::kinematics::laws::{Jump, across};

/// Halvings of a piece, at the end of which a law may jump.
const HALVINGS: usize = 60;

/// Part of the range to which the place of a switch is known, and part of a piece over which the slope beside it is taken.
const PLACE: f64 = 1e-12;
const BESIDE: f64 = 1e-3;

impl<G: Space<S = f64>> Motion<'_, G> {
    /// Lets a resolved motion end just before the first coupling that jumps, ahead or, where it has been followed backwards, behind; whether
    /// there is one.
    ///
    /// # Errors
    /// The place, if one jumps at the start itself.
    pub(crate) fn end_before_leaps(&mut self) -> Result<bool, Lost> {
        let inside = 1..self.pieces.len();
        let (behind, ahead): (Vec<usize>, Vec<usize>) = inside.partition(|piece| self.breaks[*piece] <= 0.0);
        for (side, inwards, pieces) in [(1, -1, ahead), (0, 1, behind.into_iter().rev().collect())] {
            let Some((before, jump)) = pieces.into_iter().find_map(|piece| self.leap(piece, inwards)) else { continue };
            if before == 0.0 {
                return Err(Lost { at: self.clock.value(before), gap: None });
            }
            self.end_at(before);
            if side == 1 {
                self.path.jump = Some(jump);
            }
            return Ok(true);
        }
        Ok(false)
    }

    /// The coupling that jumps where a piece begins, and a place just before it: on the side of the start, which is that of the piece before
    /// (`inwards` −1) or of the piece itself (1).
    fn leap(&mut self, piece: usize, inwards: i32) -> Option<(f64, Jump)> {
        let (near, far) = if inwards < 0 { (piece - 1, piece) } else { (piece, piece - 1) };
        let [near_modes, far_modes] = [near, far].map(|piece| self.pieces[piece].clone());
        let switches = self.driven.dynamics.mechanism.position_program.program.switches();
        let differs = |switch: &&u32| near_modes[**switch as usize] != far_modes[**switch as usize];
        let changed: Vec<usize> = switches.iter().filter(differs).map(|switch| *switch as usize).collect();
        if changed.is_empty() {
            return None;
        }
        let jump = |motion: &mut Self, s: f64| -> Result<Option<Jump>, NotReached> {
            motion.reach(s, Some(near)).map_err(|_| NotReached)?;
            Ok(across(&mut motion.driven, &motion.modes, &far_modes))
        };
        let place = self.breaks[piece];
        jump(self, place).ok()??;
        // a place that is located beside the switch sees a slope as a step: nearer
        let middle = 0.5 * (place + self.breaks[if inwards < 0 { piece - 1 } else { piece + 1 }]);
        let (mut good, mut bad) = (middle, place);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (good + bad);
            let there = self.reach(middle, None).is_ok() && changed.iter().all(|k| self.modes[*k] == near_modes[*k]);
            *(if there { &mut good } else { &mut bad }) = middle;
        }
        let found = jump(self, good).ok()??;
        let beside = good + BESIDE * (middle - good);
        let height = jump(self, beside).ok()?.map_or(0.0, |jump| jump.height());
        let slope = (height - found.height()) / (beside - good);
        let by_slope = (slope * PLACE * self.clock.length).abs();
        (found.height().abs() > by_slope || by_slope.is_nan()).then_some((good, found))
    }
}
