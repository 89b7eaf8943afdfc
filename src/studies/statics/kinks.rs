//! Equilibria in a kink of a law, as of a spring that is relaxed and holds one way only: each side has its own tangent stiffness.
//!
//! A side counts for the motions that lead into it. An equilibrium is stable if those of no side fall or are held by nothing; this is looked at
//! for the motion of each side that is held least.

use super::pose::Pose;
use super::rest::Rest;
use super::search::{Ended, Found};
use super::sinking::{Sinking, Stand};
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use crate::studies::common::sides::weights;
use nalgebra::DVector;

/// How far an equilibrium is left to see which sides it has, rad or sizes: farther than it is off.
const SHIFT: f64 = 1e-8;

/// What the stiffness of a side says, and whether the motion that it holds least leads into that side.
pub(super) struct Side {
    pub(super) negative: usize,
    pub(super) zero: usize,
    pub(super) is_entered: bool,
}

/// The side by which an equilibrium is judged: one whose motion falls, else one whose motion nothing holds, else one that holds all.
pub(super) fn decisive(sides: &[Side]) -> usize {
    let falls = sides.iter().position(|side| side.negative > 0 && side.is_entered);
    let open = || sides.iter().position(|side| side.negative == 0 && side.zero > 0 && side.is_entered);
    falls.or_else(open).or_else(|| sides.iter().position(|side| side.negative + side.zero == 0)).unwrap_or(0)
}

/// The numbers of the switches of all laws.
fn switches<G: Space>(mechanism: &Mechanism<G>) -> Vec<usize> {
    mechanism.programs().iter().flat_map(|staged| staged.program.switches().iter().map(|switch| *switch as usize)).collect()
}

/// `modes` with those of the laws' switches as they are in `there`.
fn with_laws(laws: &[usize], modes: &[i32], there: &[i32]) -> Vec<i32> {
    let mut modes = modes.to_vec();
    laws.iter().for_each(|&switch| modes[switch] = there[switch]);
    modes
}

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// A pose with its stability, whatever its balance; in a kink by its decisive side.
    pub(super) fn judged(&mut self, pose: Pose) -> Result<Found, Ended> {
        let own = self.judged_by_its_side(pose)?;
        let laws = switches(self.system.dynamics.mechanism);
        let mut sides: Vec<Vec<i32>> = Vec::new();
        if !laws.is_empty() {
            for y in weights(own.pose.basis.ncols()) {
                sides.extend(self.sides(&own.pose, &DVector::from_vec(y), &laws));
            }
        }
        sides.sort();
        sides.dedup();
        sides.retain(|modes| *modes != own.pose.position.modes);
        if sides.is_empty() {
            return Ok(own);
        }
        let mut all = vec![own];
        for modes in sides {
            let mut pose = all[0].pose.clone();
            pose.position.modes = modes;
            all.push(self.judged_by_its_side(pose)?);
        }
        let of = |found: &Found| Side {
            negative: found.stability.negative,
            zero: found.stability.zero,
            is_entered: self.sides(&found.pose, &found.stability.falls, &laws).contains(&found.pose.position.modes),
        };
        let chosen = decisive(&all.iter().map(of).collect::<Vec<_>>());
        Ok(all.swap_remove(chosen))
    }

    /// The sense of a motion (nv) that leads into the side of a pose: −1 where only the opposite one does.
    pub(super) fn sense(&mut self, pose: &Pose, motion: &DVector<f64>) -> f64 {
        let shift = SHIFT / self.measure(motion);
        let laws = switches(self.system.dynamics.mechanism);
        let mut enters = |shift: f64| {
            let there = self.moved(pose, (motion * shift).as_slice());
            there.is_ok_and(|there| with_laws(&laws, &pose.position.modes, &there.position.modes) == pose.position.modes)
        };
        if laws.is_empty() || enters(shift) || !enters(-shift) { 1.0 } else { -1.0 }
    }

    /// The modes on both sides of a pose along a motion in its basis.
    fn sides(&mut self, pose: &Pose, y: &DVector<f64>, laws: &[usize]) -> Vec<Vec<i32>> {
        let delta = &pose.basis * y;
        let shift = SHIFT / self.measure(&delta);
        let there = [shift, -shift].map(|shift| self.moved(pose, (&delta * shift).as_slice()).ok());
        there.into_iter().flatten().map(|there| with_laws(laws, &pose.position.modes, &there.position.modes)).collect()
    }
}

impl<G> Sinking<'_, G>
where
    G: Space<S = f64>,
{
    /// The modes of other sides of a stand.
    pub(super) fn other_sides(&mut self, stand: &Stand) -> Vec<Vec<i32>> {
        let laws = switches(self.rest.system.dynamics.mechanism);
        let mut sides: Vec<Vec<i32>> = Vec::new();
        if !laws.is_empty() {
            for y in weights(self.metric.len()) {
                let delta: Vec<f64> = y.iter().zip(&self.rest.unit).map(|(y, unit)| y * unit).collect();
                sides.extend(self.sides(stand, &delta, &laws));
            }
        }
        sides.sort();
        sides.dedup();
        sides.retain(|modes| *modes != stand.position.modes);
        sides
    }

    /// The sense of a motion (nv) that leads into the side of a stand: −1 where only the opposite one does.
    pub(super) fn sense(&mut self, stand: &Stand, motion: &[f64]) -> f64 {
        let shift = SHIFT / self.measure(motion);
        let laws = switches(self.rest.system.dynamics.mechanism);
        let mut enters = |shift: f64| {
            let there = self.moved(stand, &motion.iter().map(|x| x * shift).collect::<Vec<f64>>());
            there.is_ok_and(|there| with_laws(&laws, &stand.position.modes, &there.position.modes) == stand.position.modes)
        };
        if laws.is_empty() || enters(shift) || !enters(-shift) { 1.0 } else { -1.0 }
    }

    /// Whether a motion (nv) leads into the side of a stand.
    pub(super) fn enters(&mut self, stand: &Stand, motion: &[f64]) -> bool {
        let laws = switches(self.rest.system.dynamics.mechanism);
        self.sides(stand, motion, &laws).contains(&stand.position.modes)
    }

    /// The modes on both sides of a stand along a motion (nv).
    fn sides(&mut self, stand: &Stand, motion: &[f64], laws: &[usize]) -> Vec<Vec<i32>> {
        let shift = SHIFT / self.measure(motion);
        let there = [shift, -shift].map(|shift| self.moved(stand, &motion.iter().map(|x| x * shift).collect::<Vec<f64>>()).ok());
        there.into_iter().flatten().map(|there| with_laws(laws, &stand.position.modes, &there.position.modes)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_falls_counts_before_what_is_open_and_only_where_it_is_entered() {
        let side = |negative, zero, is_entered| Side { negative, zero, is_entered };
        assert_eq!(decisive(&[side(0, 0, true), side(0, 1, true), side(1, 0, true)]), 2);
        assert_eq!(decisive(&[side(0, 0, true), side(0, 1, true), side(1, 0, false)]), 1);
        // the middle of a law with three pieces, which is a point
        assert_eq!(decisive(&[side(0, 1, false), side(0, 0, true), side(0, 0, true)]), 1);
        assert_eq!(decisive(&[side(1, 0, false)]), 0);
    }
}
