//! Positions in which the constraints lose rank, or nearly: what is told of the start and of an equilibrium, and the branch of a change point
//! along which a mechanism sinks.
//!
//! In a change point P spans the motions of all branches together, and a step along P is one of no branch. With W the motions of a branch,
//! forces draw it along W y, (WᵀDW) y = Wᵀf, with the power fᵀW y; of the branches that the file leaves open the mechanism takes the one on
//! which this is largest (Gauss's principle of least constraint, in the metric D of the bath).

use super::rest::{Position, Rest};
use crate::geometry::Space;
use crate::kinematics::assemble::{Assembled, Branch};
use crate::kinematics::beside::{other_reactions, other_sinking};
use crate::kinematics::crossing::{begins_in_change_point, change_point};
use crate::mechanism::Mechanism;
use crate::numerics::least_squares::shortest;
use crate::results::Finding;
use grashof_solvers::{Span, Stage, System};
use nalgebra::{DMatrix, DVector};

/// The first step along a branch, rad or sizes.
const FIRST: f64 = 0.01;

/// Part of a coordinate, or of 1, by which a mechanism that stays may move.
const STAYS: f64 = 1e-9;

/// Part of the forces by which they must draw along a branch.
const DRAWS: f64 = 1e-9;

/// What a reader should know of a start from which a mechanism sinks into an equilibrium at `q` (nq).
pub(super) fn of_start<G: Space<S = f64>>(m: &Mechanism<G>, start: &Assembled, q: &[f64]) -> Vec<Finding> {
    // an equilibrium that is the start itself is told to be singular as such
    if q.iter().zip(&start.q).all(|(here, there)| (here - there).abs() < STAYS * (1.0 + there.abs())) {
        return start.not_as_meant().collect();
    }
    start.findings().chain(begins_in_change_point(m, start)).chain(other_sinking(m, start)).collect()
}

/// What a reader should know of an equilibrium.
pub(super) fn of_equilibrium<G: Space<S = f64>>(m: &Mechanism<G>, start: &Assembled, position: &Position, place: &str) -> Vec<Finding> {
    let Position { q, z, modes, .. } = position;
    let crossing = change_point(m, q, modes, (&start.metric, start.size), place);
    let singular = crossing.is_some();
    let other = || other_reactions(m, start, [q, z], modes, place);
    crossing.into_iter().chain((!singular).then(other).flatten()).collect()
}

impl<G> Rest<'_, G>
where
    G: Space<S = f64>,
{
    /// Coordinates (nq) a little along the branch on which forces draw the mechanism out of the position of a start; none where that is no
    /// change point, or they draw along no branch.
    pub(super) fn along_a_branch(&mut self, from: &Position, start: &Assembled) -> Option<Vec<f64>> {
        let change = start.change.as_ref()?;
        self.stand_at(from);
        self.evaluate(Stage::Dynamics);
        let open = if change.open { &change.branches[..] } else { change.branches.get(..1)? };
        let drawn = open.iter().filter_map(|branch| self.drawn_along(branch).map(|drawn| (branch, drawn)));
        let (branch, (way, _)) = drawn.max_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        if let [only] = &branch.ways[..] {
            // along a branch of one motion its own curve leads
            let side = way.iter().zip(only).map(|(w, b)| w * b).sum::<f64>().signum();
            let step = (FIRST / self.measure(&DVector::from_column_slice(only))).min(branch.reach());
            return Some(branch.at(side * step));
        }
        let mut q = from.q.clone();
        let step = FIRST / self.measure(&way);
        self.system.retract(Span::at(self.state.t), &mut q, (way * step).as_slice());
        Some(q)
    }

    /// The motion (nv) along which forces draw on a branch, and its power; none if they do not.
    fn drawn_along(&self, branch: &Branch) -> Option<(DVector<f64>, f64)> {
        let ways: Vec<DVector<f64>> = branch.ways.iter().map(|way| DVector::from_column_slice(way)).collect();
        let ways = DMatrix::from_columns(&ways);
        let metric = DMatrix::from_diagonal(&DVector::from_column_slice(&self.system.pattern().metric));
        let (resisted, force) = (ways.transpose() * metric * &ways, DVector::from_column_slice(&self.terms.force));
        let along = ways.transpose() * &force;
        let acting: f64 = force.iter().zip(&self.system.pattern().metric).map(|(f, d)| f * f / d).sum();
        let y = shortest(resisted.transpose().as_slice(), along.as_slice(), &vec![1.0; ways.ncols()], 0.0);
        let y = DVector::from_vec(y);
        let power = along.dot(&y);
        (power > DRAWS * DRAWS * acting).then(|| (ways * y, power))
    }
}
