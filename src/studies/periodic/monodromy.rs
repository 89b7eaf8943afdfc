//! The map of a period and its derivative.
//!
//! Neighbours of a periodic motion obey Ψ' = A(t) Ψ with A of [`Linear::state_matrix`] on all coordinates, which keeps them on the
//! tangent space of the constraints. They begin as the motions of the independent coordinates, velocities and states (P and W of
//! [`Reduced`](crate::kinematics::linear::Reduced)), go through every switch by its saltation matrix, and are read off the same
//! coordinates at the end: the monodromy matrix, chart-free between. Where forces depend on the reactions A is found by differences.

use super::collocation::{Gauss, STAGES};
use super::instant::pass;
use super::lap::{Lap, Search, Section, tools};
use super::rough::Rough;
use super::saltation::{Side, rate};
use crate::dynamics::{Linearizer, Point};
use crate::geometry::Space;
use crate::kinematics::linear::{Linear, Singular};
use crate::kinematics::partition::preferred;
use crate::studies::dynamics::phases::Phases;
use grashof_solvers::{Node, System};
use nalgebra::{DMatrix, DVector};

/// How neighbours of a lap come out of it.
pub(super) struct Map {
    /// Which velocities are independent (n).
    pub(super) independent: Vec<usize>,
    /// Neighbours at the start (2nv + nz × 2n + nz): the motions of the independent coordinates, velocities and states.
    pub(super) basis: DMatrix<f64>,
    /// Derivative of the map of a period (2n + nz square); of Poincaré's map where the period ends on a surface.
    pub(super) derivative: DMatrix<f64>,
    /// The surface on which the period begins; none where it ends by time.
    pub(super) surface: Option<Surface>,
}

/// The surface on which a period begins.
pub(super) struct Surface {
    /// Its gradient at the start (2n + nz).
    pub(super) normal: DVector<f64>,
    /// The value that it keeps, there.
    pub(super) value: f64,
    /// The rate of this value along the motion, there.
    pub(super) pace: f64,
}

impl<G: Space<S = f64>> Lap<'_, G> {
    /// The derivative of its map.
    pub(super) fn map(&mut self, search: &Search<'_>, phases: &Phases<G>) -> Result<Map, Rough> {
        if self.trajectory.phases.len() > 1 {
            return Err(Rough::Rests);
        }
        let by_reactions = tools(&mut self.trajectory).system.pattern().r_lambda.entries() > 0;
        let mut flow = Flow { phases, linearizer: Linearizer::new(&phases.mechanism), gauss: Gauss::new(), by_reactions };
        let t = self.start.state.t;
        let reduced = flow.linear(&self.start).and_then(|l| l.reduce(&preferred(&phases.mechanism))).map_err(|_| Rough::Singular(t))?;
        let (independent, p, w) = (reduced.partition.independent, reduced.partition.p, reduced.w);
        let (nv, n, nz) = (p.nrows(), p.ncols(), self.start.state.z.len());
        let mut basis = DMatrix::zeros(2 * nv + nz, 2 * n + nz);
        basis.view_mut((0, 0), (nv, n)).copy_from(&p);
        basis.view_mut((nv, 0), (nv, n)).copy_from(&w);
        basis.view_mut((nv, n), (nv, n)).copy_from(&p);
        basis.view_mut((2 * nv, 2 * n), (nz, nz)).fill_with_identity();
        let mut psi = self.transport(search, &mut flow, basis.clone())?;
        let mut surface = None;
        if !matches!(search.section, Section::Time(_)) {
            let (start, end) = (self.start.clone(), self.end.clone());
            let mut side = Side::<G>::from(tools(&mut self.trajectory));
            let found = (|| {
                let late = side.slope(search.mark, &end, &psi)? / side.pace(search.mark, &end)?;
                let normal = side.slope(search.mark, &start, &basis)?;
                let (value, pace) = (side.value(search.mark, &start)?, side.pace(search.mark, &start)?);
                Some((Surface { normal, value, pace }, rate(&end) * late.transpose()))
            })();
            let (at_start, moved) = found.ok_or(Rough::Singular(end.state.t))?;
            psi -= moved;
            surface = Some(at_start);
        }
        let rows: Vec<usize> = independent.iter().copied().chain(independent.iter().map(|i| nv + i)).chain(2 * nv..2 * nv + nz).collect();
        Ok(Map { independent, basis, derivative: psi.select_rows(&rows), surface })
    }

    /// Neighbours at the end of the lap.
    fn transport(&mut self, search: &Search<'_>, flow: &mut Flow<'_, G>, mut psi: DMatrix<f64>) -> Result<DMatrix<f64>, Rough> {
        let breaks = self.trajectory.breaks();
        for piece in 0..breaks.len() - 1 {
            for ends in self.trajectory.ends_of(piece).windows(2) {
                let h = ends[1] - ends[0];
                if h > 0.0 {
                    let a = flow.gauss.nodes.map(|c| flow_matrix(flow, self, ends[0] + c * h, piece));
                    let [a0, a1, a2, a3]: [Result<_, _>; STAGES] = a;
                    let next = flow.gauss.step(h, &[a0?, a1?, a2?, a3?], &psi);
                    psi = next.ok_or(Rough::Singular(ends[0]))?;
                }
            }
            if piece + 2 < breaks.len() {
                psi = pass(self, search, piece, &psi)?;
            }
        }
        if let Some((met, before)) = &self.corner {
            let behind = Side::<G>::from(tools(&mut self.trajectory)).cross(met, [before, &self.end], &psi);
            psi = behind.ok_or(Rough::Touched(before.state.t))?;
        }
        Ok(psi)
    }
}

/// What linearises.
struct Flow<'e, G: Space<S = f64>> {
    phases: &'e Phases<G>,
    linearizer: Linearizer<'e, G>,
    gauss: Gauss,
    /// Whether forces depend on the reactions: their tangents are differences.
    by_reactions: bool,
}

impl<G: Space<S = f64>> Flow<'_, G> {
    /// The motion near a node.
    fn linear(&mut self, node: &Node) -> Result<Linear, Singular> {
        let m = &self.phases.mechanism;
        let s = &node.state;
        let modes = &s.modes[..m.switches + m.windings];
        let at = Point { t: s.t, q: &s.q, v: &s.v, z: &s.z, a: &node.a, lambda: &node.lambda, modes };
        Linear::new(m, &mut self.linearizer, &at, &self.phases.start.metric)
    }
}

/// A at a time of a lap.
fn flow_matrix<G: Space<S = f64>>(flow: &mut Flow<'_, G>, lap: &mut Lap<'_, G>, t: f64, piece: usize) -> Result<DMatrix<f64>, Rough> {
    lap.trajectory.go(t, piece).map_err(|_| Rough::Singular(t))?;
    if flow.by_reactions {
        let node = lap.trajectory.node.clone();
        return Side::<G>::from(tools(&mut lap.trajectory)).state_matrix(&node).ok_or(Rough::Singular(t));
    }
    let mut linear = flow.linear(&lap.trajectory.node).map_err(|_| Rough::Singular(t))?;
    Ok(linear.state_matrix())
}
