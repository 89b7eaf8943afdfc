//! Further equilibria: searches from places all over the motion of the mechanism.
//!
//! Each place is reached from the equilibrium at hand by a walk along the constraints in a direction of its own, so that nothing is
//! taken apart on the way. Directions are a fixed sequence: the same model gives the same list.

use super::pose::Pose;
use super::rest::Rest;
use super::search::{Ended, Found};
use crate::geometry::Space;
use crate::mechanism::Step;
use grashof_solvers::System;
use nalgebra::DVector;
use std::f64::consts::{PI, TAU};

/// Places where searches begin; fewer for more than [`FREEDOM`] degrees of freedom, and far fewer for more than [`DENSE`], where a step
/// costs the cube of them, so that the work stays bounded.
const PLACES: usize = 32;
const FREEDOM: usize = 8;
const DENSE: usize = 64;
/// Longest walk, rad or sizes, and its steps.
const WALK: f64 = 1.2 * PI;
const STRIDE: f64 = 0.25;
/// Steps of a walk are not halved below this.
const SHORTEST: f64 = 1e-4;
/// Equilibria nearer than this to each other are the same.
const SAME: f64 = 1e-5;

/// Number of places where searches of a mechanism with `freedom` degrees of freedom begin.
pub(super) fn number_of_places(freedom: usize) -> usize {
    if freedom == 0 {
        return 0;
    }
    PLACES * FREEDOM * DENSE.pow(2) / (freedom.max(FREEDOM) * freedom.max(DENSE).pow(2))
}

/// Whether two signatures are of the same equilibrium.
fn is_same(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(x, y)| (x - y).abs() <= SAME)
}

/// A fixed sequence in (−1, 1).
struct Sequence(u64);

impl Sequence {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// Equilibria that a mechanism can reach from a pose, apart from those `known`; of a continuum none. Angles are counted from `near`.
    pub(super) fn others(&mut self, from: &Pose, near: &Pose, known: &[&Pose], stop: &dyn Fn() -> bool) -> Result<Vec<Found>, Ended> {
        let mut signatures: Vec<Vec<f64>> = known.iter().map(|pose| self.signature(&pose.position)).collect();
        let mut found: Vec<Found> = Vec::new();
        for place in self.places(from) {
            for falling in [false, true] {
                let end =
                    if falling { self.descend(&place, stop) } else { self.newton(&place, stop).and_then(|f| f.map_err(|_| Ended::Stuck)) };
                let new = match end {
                    Ok(new) => new,
                    Err(Ended::Stopped) => return Err(Ended::Stopped),
                    Err(_) => continue,
                };
                let signature = self.signature(&new.pose.position);
                if new.stability.zero == 0 && signatures.iter().all(|s| !is_same(s, &signature)) {
                    found.push(self.unwound(new, near, &signature)?);
                    signatures.push(signature);
                }
            }
        }
        Ok(found)
    }

    /// The same equilibrium with its angles within half a turn of another pose, where that makes no difference to anything.
    fn unwound(&mut self, found: Found, from: &Pose, signature: &[f64]) -> Result<Found, Ended> {
        let mut q = found.pose.position.q.clone();
        for step in &self.system.dynamics.mechanism.steps {
            if let Step::Axis { q: i, turns: true, slides: false, .. } = *step {
                q[i] -= TAU * ((q[i] - from.position.q[i]) / TAU).round();
            }
        }
        let Ok(pose) = self.at(&q, &found.pose.position.z, &found.pose.position.modes) else { return Ok(found) };
        if is_same(&self.signature(&pose.position), signature) && self.is_balanced(&pose)? {
            return self.judged(pose);
        }
        Ok(found)
    }

    /// An equilibrium of any kind by Newton's method from places all over the motion; the first that is found.
    pub(super) fn anywhere(&mut self, from: &Pose, stop: &dyn Fn() -> bool) -> Result<Option<Found>, Ended> {
        for place in self.places(from) {
            match self.newton(&place, stop) {
                Ok(Ok(found)) => return Ok(Some(found)),
                Err(Ended::Stopped) => return Err(Ended::Stopped),
                _ => {}
            }
        }
        Ok(None)
    }

    /// Where walks from a pose end.
    fn places(&mut self, from: &Pose) -> Vec<Pose> {
        let count = number_of_places(from.basis.ncols());
        let mut sequence = Sequence(20_240_229);
        (0..count)
            .map(|i| {
                // lengths are spread evenly
                let length = WALK * (i as f64 + 1.0) / count as f64;
                let direction = DVector::from_fn(self.unit.len(), |k, _| sequence.next() * self.unit[k]);
                self.walk(from, direction, length)
            })
            .collect()
    }

    /// The end of a walk along the part of a direction (nv) that the constraints leave.
    fn walk(&mut self, from: &Pose, direction: DVector<f64>, length: f64) -> Pose {
        let weighted = DVector::from_fn(direction.len(), |k, _| self.system.pattern().metric[k] * direction[k]);
        let mut pose = from.clone();
        let mut left = length;
        while left > 0.0 {
            let mut delta = &pose.basis * (pose.basis.transpose() * &weighted);
            let size = self.measure(&delta);
            if size <= 0.0 {
                break;
            }
            delta /= size;
            let mut stride = left.min(STRIDE);
            let next = loop {
                let way = &delta * stride;
                match self.moved(&pose, way.as_slice()) {
                    // another branch may be reached across a change point alone
                    Ok(next) if stride > SHORTEST && !self.stays(&pose, way.as_slice(), &next) => stride *= 0.5,
                    next => break next,
                }
            };
            let Ok(next) = next else { break };
            pose = next;
            left -= stride;
        }
        pose
    }
}
