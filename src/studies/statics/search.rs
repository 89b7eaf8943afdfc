//! The searches: down the slope of the energy, and Newton's method for balance of any kind.
//!
//! Descent follows D ẏ = h, the motion of a mechanism without inertia in a viscous bath, by implicit steps
//!
//! ```text
//! (H + σ) y = h,      q ← q ⊕ P y,      σ ≥ 0 so that H + σ is positive and y is no longer than a radius
//! ```
//!
//! (pseudo-transient continuation, Kelley & Keyes, SIAM J. Numer. Anal. 35 (1998) 508-523; with an energy it is the
//! Levenberg-Marquardt form of a trust region). A step counts if the work ½ (h₀ + h₁)·y of the forces on it agrees with the model,
//! h·y − ½ yᵀHy; no energy need exist. Where σ = 0 suffices it is Newton's method. It ends in stable equilibria, or exactly on a
//! ridge between them.
//!
//! Newton's method with damping, min |H y − h|² + μ|y|², makes |h| smaller and ends in equilibria of any kind.

use super::pose::Pose;
use super::rest::{Lost, Rest};
use super::stability::Stability;
use crate::geometry::Space;
use crate::numerics::least_squares::shortest;
use grashof_solvers::svd::Svd;
use nalgebra::{DMatrix, DVector};

/// Steps of a search.
pub(super) const STEPS: usize = 400;
/// Longest step, rad; slides may become faster.
pub(super) const LONGEST: f64 = 0.3;
/// A Newton step (rad or sizes) after which only round-off is left to remove.
pub(super) const CLOSE: f64 = 1e-9;
/// A step after which the search may be on a ridge.
pub(super) const NEAR: f64 = 1e-6;
/// Part of the acting forces that is round-off.
pub(super) const ROUND_OFF: f64 = 1e-14;
/// Part of the acting stiffness that is always added, so that motions that nothing holds stay where they are.
pub(super) const FLOOR: f64 = 1e-11;
/// Part of the largest stiffness below which a motion is not held by any, in the last steps, and how far these go, rad or sizes.
const SINGULAR: f64 = 1e-14;
const FARTHEST: f64 = 0.1;
/// Sizes beyond which a mechanism has run away.
pub(super) const AWAY: f64 = 1e6;

/// Why a search ends without equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ended {
    /// Some forces do not end as the mechanism moves on.
    Away,
    /// The forces jump where the search wants to stay.
    Jump,
    /// No progress.
    Stuck,
    /// A pose could not be evaluated.
    Lost(Lost),
    /// Interrupted.
    Stopped,
}

impl From<Lost> for Ended {
    fn from(lost: Lost) -> Self {
        Self::Lost(lost)
    }
}

/// An equilibrium.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub(super) pose: Pose,
    pub(super) stability: Stability,
}

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// A pose with its stability, whatever its balance, by its modes.
    pub(super) fn judged_by_its_side(&mut self, pose: Pose) -> Result<Found, Ended> {
        let h = self.tangent(&pose)?;
        let mut stability = Stability::new(&pose, &h);
        for (value, motion) in std::mem::take(&mut stability.weak) {
            if self.is_followed(&pose, value, &motion) {
                stability.take_weak(value);
            }
        }
        Ok(Found { stability, pose })
    }

    /// The way to the equilibrium of the linearised forces is within round-off of the position.
    pub(super) fn is_balanced(&mut self, pose: &Pose) -> Result<bool, Ended> {
        if pose.force.norm() <= ROUND_OFF * pose.grain {
            return Ok(true);
        }
        let h = self.tangent(pose)?;
        let step = newton_step(&h, &pose.force, 0.0);
        let left = (&h * &step - &pose.force).norm();
        Ok(left <= 1e-6 * pose.force.norm() && self.measure(&(&pose.basis * step)) <= CLOSE)
    }

    /// Where the mechanism settles from a pose.
    pub(super) fn descend(&mut self, from: &Pose, stop: &dyn Fn() -> bool) -> Result<Found, Ended> {
        let mut pose = from.clone();
        let (mut radius, mut way) = (0.1, 0.0);
        for _ in 0..STEPS {
            if stop() {
                return Err(Ended::Stopped);
            }
            let h = self.tangent(&pose)?;
            let stability = Stability::new(&pose, &h);
            if pose.force.norm() <= ROUND_OFF * pose.grain {
                let pose = self.polish(pose)?;
                return self.judged(pose);
            }
            let (y, sigma) = self.step(&pose, &h, &stability, radius)?;
            let floor = FLOOR * stability.scale;
            let length = self.measure(&(&pose.basis * &y));
            // on a ridge σ stays above 0, and the steps become short slowly
            if length <= CLOSE && sigma <= floor || length <= NEAR && self.is_balanced(&pose)? {
                let pose = self.polish(pose)?;
                return self.judged(pose);
            }
            let tried = self.tried(&pose, &h, &y);
            let delta = &pose.basis * &y;
            match tried.filter(|(next, _)| self.stays(&pose, delta.as_slice(), next)) {
                Some((next, ratio)) if ratio > 0.1 => {
                    way += length;
                    if way > AWAY {
                        return Err(Ended::Away);
                    }
                    pose = next;
                    if ratio < 0.25 {
                        radius = 0.5 * length;
                    } else if ratio > 0.75 && sigma > floor {
                        radius = radius.max(2.0 * length);
                    }
                }
                _ => radius = 0.25 * length.min(radius),
            }
            if radius < 1e-13 {
                return Err(Ended::Jump);
            }
        }
        Err(if way > 0.25 * LONGEST * STEPS as f64 { Ended::Away } else { Ended::Stuck })
    }

    /// The implicit step within a radius, and its σ.
    fn step(&self, pose: &Pose, h: &DMatrix<f64>, stability: &Stability, radius: f64) -> Result<(DVector<f64>, f64), Ended> {
        let floor = FLOOR * stability.scale;
        let lowest = stability.lowest();
        let mut sigma = if lowest > floor { floor } else { floor - 1.5 * lowest.min(0.0) };
        // without stiffness the step is h/σ: below this σ it is far too long
        let least = 1e-6 * self.measure(&(&pose.basis * &pose.force)) / radius;
        for _ in 0..120 {
            let shifted = h + DMatrix::identity(h.nrows(), h.nrows()) * sigma;
            if let Some(y) = shifted.lu().solve(&pose.force)
                && y.iter().all(|x| x.is_finite())
                && self.reach(pose, &y, radius) <= 1.0
            {
                return Ok((y, sigma));
            }
            sigma = (3.0 * sigma).max(least);
        }
        Err(Ended::Stuck)
    }

    /// Length of a step by the radius; turns never more than a part of a radian, so that no branch is jumped over.
    fn reach(&self, pose: &Pose, y: &DVector<f64>, radius: f64) -> f64 {
        let delta = &pose.basis * y;
        let turns = |k: usize| self.unit[k] == 1.0;
        (0..delta.len()).fold(0.0, |m, k| {
            let longest = if turns(k) { radius.min(LONGEST) } else { radius };
            f64::max(m, delta[k].abs() / (self.unit[k] * longest))
        })
    }

    /// The pose behind a step, and the work of the forces on it by that of the model.
    fn tried(&mut self, pose: &Pose, h: &DMatrix<f64>, y: &DVector<f64>) -> Option<(Pose, f64)> {
        let delta = &pose.basis * y;
        let next = self.moved(pose, delta.as_slice()).ok()?;
        // h₁ belongs to another basis: y₁ = P₁ᵀ D δ are the parts of the way in it
        let metric = &grashof_solvers::System::pattern(&self.system).metric;
        let weighted = DVector::from_fn(delta.len(), |k, _| metric[k] * delta[k]);
        let behind = next.force.dot(&(next.basis.transpose() * weighted));
        let work = 0.5 * (pose.force.dot(y) + behind);
        let expected = pose.force.dot(y) - 0.5 * y.dot(&(h * y));
        Some((next, work / expected))
    }

    /// Newton steps as long as they halve what is unbalanced.
    pub(super) fn polish(&mut self, mut pose: Pose) -> Result<Pose, Ended> {
        for _ in 0..8 {
            if pose.force.norm() == 0.0 {
                break;
            }
            let svd = Svd::new(&self.tangent(&pose)?);
            let least = SINGULAR * svd.largest();
            let y = svd.solve(pose.force.as_slice(), |s| if s > least { s.recip() } else { 0.0 });
            let delta = &pose.basis * DVector::from_vec(y);
            if self.measure(&delta) > FARTHEST {
                break;
            }
            let Ok(next) = self.moved(&pose, delta.as_slice()) else { break };
            if next.force.norm() > 0.5 * pose.force.norm() {
                break;
            }
            pose = next;
        }
        Ok(pose)
    }

    /// An equilibrium of any kind near a pose; else the pose where least is unbalanced.
    pub(super) fn newton(&mut self, from: &Pose, stop: &dyn Fn() -> bool) -> Result<Result<Found, Pose>, Ended> {
        let mut pose = from.clone();
        let mut damping = 1e-12;
        for _ in 0..STEPS {
            if stop() {
                return Err(Ended::Stopped);
            }
            if self.is_balanced(&pose)? {
                let pose = self.polish(pose)?;
                return Ok(Ok(self.judged(pose)?));
            }
            let h = self.tangent(&pose)?;
            let mut y = newton_step(&h, &pose.force, damping);
            let long = self.reach(&pose, &y, LONGEST);
            if long > 1.0 {
                y /= long;
            }
            let delta = &pose.basis * &y;
            match self.moved(&pose, delta.as_slice()) {
                Ok(next) if next.force.norm() < pose.force.norm() && self.stays(&pose, delta.as_slice(), &next) => {
                    let gained = 1.0 - next.force.norm() / pose.force.norm();
                    pose = next;
                    damping = (damping * 0.1).max(1e-12);
                    if gained < 1e-7 {
                        break;
                    }
                }
                _ => damping = damping.max(1e-6) * 10.0,
            }
            if damping > 1e8 {
                break;
            }
        }
        Ok(Err(pose))
    }
}

/// min |H y − h|² + μ (largest singular value)² |y|².
fn newton_step(h: &DMatrix<f64>, force: &DVector<f64>, damping: f64) -> DVector<f64> {
    let n = force.len();
    let rows: Vec<f64> = h.transpose().as_slice().to_vec();
    DVector::from_vec(shortest(&rows, force.as_slice(), &vec![1.0; n], damping))
}
