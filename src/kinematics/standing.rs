//! Drivers that stand still where branches of the motion cross, and begin to move from there.
//!
//! Such a start has no velocity that a path could begin with; but along the branch positions are smooth in the place s of the
//! drivers, and known beside the change point on both sides (`assemble/branch.rs`): a polynomial in s(t) gives them.

use super::assemble::{Assembled, Branch};
use super::driven::Driven;
use super::node::{PathPoint, SINGULAR};
use crate::dynamics::Dynamics;
use crate::geometry::Space;

/// Part of the curve on which its polynomial counts.
const INNER: f64 = 0.8;

/// A motion that begins at rest in a change point.
#[derive(Clone, Debug)]
pub(crate) struct Standing {
    branch: Branch,
    q: Vec<f64>,
}

impl Standing {
    /// The start, if it is such a one.
    pub(crate) fn of(start: &Assembled) -> Option<Self> {
        let change = start.change.as_ref().filter(|change| change.rests)?;
        Some(Self { branch: change.branches.first()?.clone(), q: start.q.clone() })
    }

    /// How far along the branch the drivers have come at a time.
    fn place<G: Space<S = f64>>(&self, driven: &mut Driven<'_, G>, modes: &mut [i32], t: f64) -> f64 {
        place(&mut driven.dynamics, &self.q, &self.branch.ways[0], modes, t)
    }

    /// Coordinates at a time, while the drivers are near their start.
    pub(crate) fn coordinates<G: Space<S = f64>>(&self, driven: &mut Driven<'_, G>, modes: &mut [i32], t: f64) -> Option<Vec<f64>> {
        let s = self.place(driven, modes, t);
        (s.abs() <= INNER * self.branch.reach()).then(|| self.branch.at(s))
    }

    /// Nodes from which the path goes on, behind and ahead of the start: the start itself where the drivers do not come from anywhere.
    pub(crate) fn around<G: Space<S = f64>>(&self, driven: &mut Driven<'_, G>, modes: &mut [i32], to: f64) -> Option<[PathPoint; 2]> {
        let turns = driven.node(0.0, modes).turns;
        let mut beside = |to: f64| {
            let mut t = 1e-6 * to;
            while self.place(driven, modes, t).abs() < 0.3 * self.branch.reach() && t.abs() < to.abs() {
                t *= 1.2;
            }
            let q = self.coordinates(driven, modes, t)?;
            driven.q.copy_from_slice(&q);
            driven.wind(modes, &turns);
            driven.follow(t, modes).ok()?;
            if driven.condition() < SINGULAR {
                return None;
            }
            driven.rates(modes);
            Some(driven.node(t, modes))
        };
        let (ahead, behind) = (beside(to)?, beside(-to));
        let rest = || PathPoint {
            t: 0.0,
            q: self.q.clone(),
            v: vec![0.0; ahead.v.len()],
            a: vec![0.0; ahead.v.len()],
            turns: turns.clone(),
            regularity: 0.0,
            side: 0.0,
            narrow: false,
            crosses: false,
        };
        Some([behind.unwrap_or_else(rest), ahead])
    }
}

/// How far the drivers lead from a position along the velocity `way` until `t`: s of G way s = −ΔΦ in least squares.
pub(crate) fn place<G: Space<S = f64>>(d: &mut Dynamics<'_, G>, q: &[f64], way: &[f64], modes: &mut [i32], t: f64) -> f64 {
    let [before, now] = [0.0, t].map(|t| {
        d.follow_time(t, modes);
        d.position(q, modes);
        d.work.phi.clone()
    });
    let moved: Vec<f64> = before.iter().zip(&now).map(|(before, now)| before - now).collect();
    let speeds: Vec<f64> = d.work.g.lines().map(|row| row.dot(way)).collect();
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    sum(&speeds, &moved) / sum(&speeds, &speeds)
}
