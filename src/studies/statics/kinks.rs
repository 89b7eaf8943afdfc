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

/// A mechanism at rest that can be left a little.
pub(super) trait Leaving {
    /// Where it rests.
    type Place;

    /// The numbers of the switches of all laws.
    fn laws(&self) -> Vec<usize>;

    /// The length of a motion (nv), in rad or sizes.
    fn length(&self, motion: &[f64]) -> f64;

    /// The modes at a place.
    fn modes(place: &Self::Place) -> &[i32];

    /// The modes behind a motion (nv) from a place; none if it leads nowhere.
    fn modes_behind(&mut self, place: &Self::Place, motion: &[f64]) -> Option<Vec<i32>>;

    /// The modes on both sides of a place along a motion (nv): first ahead, then back.
    fn sides(&mut self, place: &Self::Place, motion: &[f64]) -> [Option<Vec<i32>>; 2] {
        let (laws, length) = (self.laws(), self.length(motion));
        [SHIFT, -SHIFT].map(|shift| {
            let shift = if length > 0.0 { shift / length } else { return None };
            let there = self.modes_behind(place, &motion.iter().map(|x| x * shift).collect::<Vec<f64>>())?;
            let mut modes = Self::modes(place).to_vec();
            laws.iter().for_each(|&switch| modes[switch] = there[switch]);
            Some(modes)
        })
    }

    /// Whether a motion (nv), or the opposite one, leads into the side that a place is taken to be on.
    fn enters(&mut self, place: &Self::Place, motion: &[f64]) -> bool {
        self.sides(place, motion).iter().any(|side| side.as_deref() == Some(Self::modes(place)))
    }

    /// The sense of a motion (nv) that leads into that side: −1 where only the opposite one does.
    fn sense(&mut self, place: &Self::Place, motion: &[f64]) -> f64 {
        if self.laws().is_empty() {
            return 1.0;
        }
        let [ahead, back] = self.sides(place, motion).map(|side| side.as_deref() == Some(Self::modes(place)));
        if back && !ahead { -1.0 } else { 1.0 }
    }

    /// The modes of the other sides of a place along motions (nv each), each set once.
    fn other_sides(&mut self, place: &Self::Place, motions: impl IntoIterator<Item = Vec<f64>>) -> Vec<Vec<i32>> {
        if self.laws().is_empty() {
            return Vec::new();
        }
        let mut sides: Vec<Vec<i32>> = motions.into_iter().flat_map(|motion| self.sides(place, &motion)).flatten().collect();
        sides.sort();
        sides.dedup();
        sides.retain(|modes| modes != Self::modes(place));
        sides
    }
}

fn laws<G: Space>(mechanism: &Mechanism<G>) -> Vec<usize> {
    mechanism.programs().iter().flat_map(|staged| staged.program.switches().iter().map(|switch| *switch as usize)).collect()
}

impl<G: Space<S = f64>> Leaving for Rest<'_, G> {
    type Place = Pose;

    fn laws(&self) -> Vec<usize> {
        laws(self.system.dynamics.mechanism)
    }

    fn length(&self, motion: &[f64]) -> f64 {
        self.measure(&DVector::from_column_slice(motion))
    }

    fn modes(place: &Pose) -> &[i32] {
        &place.position.modes
    }

    fn modes_behind(&mut self, place: &Pose, motion: &[f64]) -> Option<Vec<i32>> {
        Some(self.moved(place, motion).ok()?.position.modes)
    }
}

impl<G: Space<S = f64>> Leaving for Sinking<'_, G> {
    type Place = Stand;

    fn laws(&self) -> Vec<usize> {
        laws(self.rest.system.dynamics.mechanism)
    }

    fn length(&self, motion: &[f64]) -> f64 {
        self.measure(motion)
    }

    fn modes(place: &Stand) -> &[i32] {
        &place.position.modes
    }

    fn modes_behind(&mut self, place: &Stand, motion: &[f64]) -> Option<Vec<i32>> {
        Some(self.moved(place, motion).ok()?.position.modes)
    }
}

impl<G: Space<S = f64>> Rest<'_, G> {
    /// A pose with its stability, whatever its balance; in a kink by its decisive side.
    pub(super) fn judged(&mut self, pose: Pose) -> Result<Found, Ended> {
        let mut all = vec![self.judged_by_its_side(pose)?];
        let basis = all[0].pose.basis.clone();
        let motions = weights(basis.ncols()).map(|y| (&basis * DVector::from_vec(y)).as_slice().to_vec());
        for modes in self.other_sides(&all[0].pose, motions) {
            let mut pose = all[0].pose.clone();
            pose.position.modes = modes;
            all.push(self.judged_by_its_side(pose)?);
        }
        if all.len() == 1 {
            return Ok(all.remove(0));
        }
        let of = |found: &Found| Side {
            negative: found.stability.negative,
            zero: found.stability.zero,
            is_entered: self.enters(&found.pose, (&found.pose.basis * &found.stability.falls).as_slice()),
        };
        let chosen = decisive(&all.iter().map(of).collect::<Vec<_>>());
        Ok(all.swap_remove(chosen))
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
