//! Positions in which branches of the motion cross: there rows lose rank that they have beside them.

use super::assemble::Assembled;
use super::freedom::rows;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::Mechanism;
use crate::results::Finding;
use grashof_solvers::rank::{RANK_TOLERANCE, Rank};
use grashof_solvers::{Kkt, Sparsity};
use std::fmt;

/// How far beside a position rows are looked at, rad or sizes of the mechanism.
const BESIDE: f64 = 0.02;

/// Steps of Newton's method onto the constraints, and Φ and the last step, rad or sizes, with which it has come there. Where nothing can move
/// it leads back to the position itself, by steps that only halve.
const STEPS: usize = 16;
const CLOSED: f64 = 1e-11;
const SETTLED: f64 = 1e-8;

/// Directions of motions, in no special relation to each other.
const PHASES: [f64; 3] = [0.3, 1.7, 2.9];

/// That a position at rest is a change point, where the linear motion about it is that of no branch; `metric` is D (nv), `size` that of the
/// mechanism, m.
pub(crate) fn change_point<G>(m: &Mechanism<G>, q: &[f64], modes: &[i32], (metric, size): (&[f64], f64), place: &str) -> Option<Finding>
where
    G: Space<S = f64>,
{
    let crossing = crossing(m, q, modes, metric, size)?;
    Some(Finding {
        code: "in-change-point".into(),
        message: format!(
            "the position is a change point, where branches of the motion cross: {crossing}. Stiffnesses, eigenvalues and stability are told for all of them together, which is the motion of no branch; those of a branch are found a little beside, from `start` with an exact value of 0.01 rad or more off"
        ),
        path: place.into(),
    })
}

/// That a motion begins in a change point whose branches are not told one by one.
pub(crate) fn begins_in_change_point<G: Space<S = f64>>(m: &Mechanism<G>, start: &Assembled) -> Option<Finding> {
    let crossing = at_start(m, start)?;
    Some(Finding {
        code: "change-point".into(),
        message: format!(
            "the start is a change point, where branches of the motion cross: {crossing}. Which one the motion takes is left to round-off; a little beside, with an exact value of 0.01 rad or more off, it begins on that branch"
        ),
        path: "start".into(),
    })
}

/// What a start loses in a change point whose branches are not told one by one.
pub(super) fn at_start<G: Space<S = f64>>(m: &Mechanism<G>, start: &Assembled) -> Option<Crossing> {
    if start.change.is_some() { None } else { crossing(m, &start.q, &start.modes, &start.metric, start.size) }
}

/// The degrees of freedom in a change point and beside it, where coordinates (nq) are those of one such place.
pub(super) struct Crossing {
    here: usize,
    beside: usize,
    pub(super) q: Vec<f64>,
}

impl fmt::Display for Crossing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = |n: usize| if n == 1 { "1 motion".to_string() } else { format!("{n} motions") };
        write!(f, "the constraints leave {} in it, but {} beside it", word(self.here), word(self.beside))
    }
}

/// The degrees of freedom at a closed position and beside it, if there they are fewer.
fn crossing<G: Space<S = f64>>(m: &Mechanism<G>, q: &[f64], modes: &[i32], metric: &[f64], size: f64) -> Option<Crossing> {
    if m.rows.is_empty() {
        return None;
    }
    let (g, scale) = rows(m, q, modes, metric);
    let rank = Rank::new(&g, metric, &scale, RANK_TOLERANCE);
    if rank.dependent.is_empty() || rank.mobility == 0 {
        return None;
    }
    let diagonal = Sparsity::new(m.nv, m.nv, (0..m.nv).map(|i| (i, i)));
    let mut kkt = Kkt::of_blocks(&diagonal, g.pattern());
    kkt.set_scale(metric, &scale);
    let mut dynamics = Dynamics::without_mass(m);
    dynamics.time(0.0, modes);
    let units = m.units(size);
    let row_unit: Vec<f64> = m.rows.iter().map(|row| if row.angular { 1.0 } else { size.recip() }).collect();
    let farthest = |v: &[f64]| v.iter().zip(&units).fold(0.0, |most, (v, unit)| f64::max(most, v.abs() / unit));
    let (zeros, mut delta, mut mu) = (vec![0.0; m.nv], vec![0.0; m.nv], vec![0.0; m.rows.len()]);
    let mut least = (rank.mobility, Vec::new());
    for phase in PHASES {
        let parts: Vec<f64> = (0..rank.mobility).map(|k| (2.4 * k as f64 + phase).cos()).collect();
        let way = rank.motion(&parts);
        let most = farthest(&way);
        let way: Vec<f64> = way.iter().map(|v| BESIDE * v / most).collect();
        let mut there = q.to_vec();
        m.retract(&mut there, &way);
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            dynamics.position(&there, modes);
            let open = dynamics.work.phi.iter().zip(&row_unit).fold(0.0, |most, (phi, unit)| f64::max(most, phi.abs() * unit));
            if open <= CLOSED && last <= SETTLED {
                let scale = dynamics.row_scale(&there, modes, metric);
                let mobility = Rank::new(&dynamics.work.g, metric, &scale, RANK_TOLERANCE).mobility;
                if mobility < least.0 {
                    least = (mobility, there);
                }
                break;
            }
            if kkt.factor(metric, dynamics.work.g.values()).is_err() {
                break;
            }
            let gamma: Vec<f64> = dynamics.work.phi.iter().map(|phi| -phi).collect();
            kkt.solve(&zeros, &gamma, &mut delta, &mut mu);
            m.retract(&mut there, &delta);
            last = farthest(&delta);
        }
    }
    let (beside, q) = least;
    (beside < rank.mobility).then_some(Crossing { here: rank.mobility, beside, q })
}
