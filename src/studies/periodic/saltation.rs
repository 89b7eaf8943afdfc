//! What becomes of neighbouring motions at a switch, an impact, or the end of a period: saltation matrices.
//!
//! A motion crosses g(t, x) = 0 where its rate changes from f⁻ to f⁺ and its state may jump, x⁺ = J(t, x⁻). A neighbour δ before it
//! crosses later by τ = −∇g·δ/ġ⁻ and is behind it
//!
//! ```text
//! S δ = DJ δ + (f⁺ − DJ f⁻) ∇g·δ/ġ⁻,    ġ⁻ = ∂g/∂t + ∇g·f⁻
//! ```
//!
//! (Aizerman & Gantmakher 1958; Leine & Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004, equation
//! 7.64). J is a blow, or the corner of a coupling. Where neither state nor rate jumps S is the identity, as at a kink of a force. At the end of a period that lies on a surface
//! g = 0 a neighbour is taken to the surface along the motion, δ − f ∇g·δ/ġ, which is Poincaré's map.
//!
//! ∇g·δ and DJ δ are differences of fourth order along δ, the modes held: their step of 1e-3 of a size leaves errors of about 1e-12
//! for expressions of every kind.

use crate::geometry::Space;
use crate::kinematics::linear::spin;
use crate::studies::dynamics::system::{Mechanical, Root};
use crate::studies::dynamics::trajectory::PhaseSystem;
use grashof_solvers::{Blow, Effect, Engine, Node, Span, State, System};
use nalgebra::{DMatrix, DVector};

/// Step of the differences, in sizes of the coordinates.
const STEP: f64 = 1e-3;

/// Part of the largest rate below which two rates are one.
const SAME: f64 = 1e-13;

/// Part of a velocity by which a blow changes it at least.
pub(super) const STRUCK: f64 = 1e-9;

/// Part of a period within which what is met is met at one instant; so many tolerances of the integration at least.
const INSTANT: f64 = 1e-9;
const TOLERANCES: f64 = 10.0;

/// Part of ∇g's largest change in a typical time below which a surface is only touched.
pub(super) const GRAZING: f64 = 1e-9;

/// Time within which what is met in a period is met at one instant.
pub(super) fn instant(period: f64, tolerance: f64) -> f64 {
    period * INSTANT.max(TOLERANCES * tolerance)
}

/// A neighbouring state: δt, then (δq, δv, δz) with δq along velocities.
struct Neighbour<'a> {
    time: f64,
    x: &'a [f64],
}

/// A system with its engine, and scratch for neighbours of a node.
pub(super) struct Side<'a, 'm, G: Space<S = f64>> {
    pub(super) system: &'a mut Mechanical<'m, G>,
    pub(super) engine: &'a mut Engine,
}

impl<'a, 'm, G: Space<S = f64>> From<&'a mut PhaseSystem<'m, G>> for Side<'a, 'm, G> {
    fn from(phase: &'a mut PhaseSystem<'m, G>) -> Self {
        Self { system: &mut phase.system, engine: &mut phase.engine }
    }
}

/// The rate (v, a, ż) of a node: that of q along velocities.
pub(super) fn rate(node: &Node) -> DVector<f64> {
    DVector::from_vec([&node.state.v[..], &node.a, &node.zdot].concat())
}

impl<G: Space<S = f64>> Side<'_, '_, G> {
    /// The size of coordinate `i` of (δq, δv, δz) at a node.
    pub(super) fn unit(&self, node: &Node, i: usize) -> f64 {
        let (nv, sizes) = (node.state.v.len(), &self.engine.size_v);
        match i {
            _ if i < nv => sizes[i],
            _ if i < 2 * nv => sizes[i - nv] + node.state.v[i - nv].abs(),
            _ => 1.0,
        }
    }

    /// The largest of (δq, δv, δz) at a node, in sizes of the coordinates.
    pub(super) fn size(&self, node: &Node, x: &[f64]) -> f64 {
        x.iter().enumerate().fold(0.0, |m, (i, x)| f64::max(m, x.abs() / self.unit(node, i)))
    }

    /// The derivative at a node along a neighbour of what `read` finds in a state, by differences of fourth order.
    fn along(
        &mut self,
        node: &Node,
        neighbour: &Neighbour<'_>,
        mut read: impl FnMut(&mut Self, &mut Node) -> Option<Vec<f64>>,
    ) -> Option<Vec<f64>> {
        let size = self.size(node, neighbour.x);
        if size == 0.0 {
            return read(self, &mut node.clone()).map(|x| vec![0.0; x.len()]);
        }
        let step = STEP / size;
        let mut sum: Vec<f64> = Vec::new();
        for (part, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
            let mut moved = self.moved(node, neighbour, part * step);
            let found = read(self, &mut moved)?;
            sum.resize(found.len(), 0.0);
            sum.iter_mut().zip(&found).for_each(|(s, x)| *s += weight * x / (12.0 * step));
        }
        Some(sum)
    }

    /// The state beside a node, h along a neighbour.
    fn moved(&self, node: &Node, neighbour: &Neighbour<'_>, h: f64) -> Node {
        let mut moved = node.clone();
        let (nv, state) = (node.state.v.len(), &mut moved.state);
        let scaled: Vec<f64> = neighbour.x.iter().map(|x| h * x).collect();
        state.t += h * neighbour.time;
        self.system.retract(Span::at(state.t), &mut state.q, &scaled[..nv]);
        state.v.iter_mut().zip(&scaled[nv..]).for_each(|(v, d)| *v += d);
        state.z.iter_mut().zip(&scaled[2 * nv..]).for_each(|(z, d)| *z += d);
        moved
    }

    /// The state matrix of (δq, δv, δz) at a node by differences, for forces that depend on the reactions.
    pub(super) fn state_matrix(&mut self, node: &Node) -> Option<DMatrix<f64>> {
        let (nv, nz) = (node.state.v.len(), node.state.z.len());
        let n = 2 * nv + nz;
        let mut matrix = DMatrix::zeros(n, n);
        matrix.view_mut((0, 0), (nv, nv)).copy_from(&-spin(self.system.dynamics.mechanism, &node.state.v));
        matrix.view_mut((0, nv), (nv, nv)).fill_with_identity();
        let mut unit = vec![0.0; n];
        for j in 0..n {
            unit[j] = 1.0;
            let column = self.along(node, &Neighbour { time: 0.0, x: &unit }, |side, node| {
                side.engine.accelerate(side.system, node).ok()?;
                Some([&node.a[..], &node.zdot].concat())
            })?;
            matrix.view_mut((nv, j), (nv + nz, 1)).copy_from_slice(&column);
            unit[j] = 0.0;
        }
        Some(matrix)
    }

    /// A root of the system in a state whose modes stand.
    pub(super) fn root(&mut self, root: usize, node: &mut Node) -> Option<Vec<f64>> {
        if self.system.pattern().roots_by_reactions {
            self.engine.accelerate(self.system, node).ok()?;
        }
        let mut roots = vec![0.0; self.system.dims().roots];
        self.system.roots(node.state.at(), &node.a, &node.lambda, &mut roots);
        Some(vec![roots[root]])
    }

    /// Place of the mode that a root leaves.
    pub(super) fn mode(&self, root: usize) -> Option<usize> {
        let m = self.system.dynamics.mechanism;
        match self.system.roots[root] {
            Root::Force { program, k } => Some(m.programs()[program].program.switches()[k] as usize),
            Root::Slides(contact) => Some(m.contacts[contact].mode),
            _ => None,
        }
    }

    /// Whether the motion meets a root within a time before or behind a node.
    pub(super) fn is_near(&mut self, root: usize, node: &Node, within: f64) -> bool {
        let Some(g) = self.root(root, &mut node.clone()) else { return false };
        self.pace_of_root(root, node).is_some_and(|pace| pace < 0.0 && g[0].abs() <= -within * pace)
    }

    /// Whether velocities differ by more than a part.
    pub(super) fn jumps(&self, [before, after]: [&Node; 2], part: f64) -> bool {
        let sizes = self.engine.size_v.iter().zip(&before.state.v).map(|(s, v)| s + v.abs());
        let mut changes = before.state.v.iter().zip(&after.state.v).zip(sizes);
        changes.any(|((a, b), size)| (a - b).abs() > part * size)
    }

    /// The switches that a motion meets within a time of a node, and the node behind them, if its velocities jump there.
    pub(super) fn beyond(&mut self, node: &Node, within: f64) -> Option<(Vec<usize>, Node)> {
        let all = 0..self.system.roots.len();
        let met: Vec<usize> = all.filter(|root| self.mode(*root).is_some() && self.is_near(*root, node, within)).collect();
        if met.is_empty() {
            return None;
        }
        let mut behind = node.clone();
        self.crossed(&met, &mut behind.state)?;
        self.engine.settle(self.system, &mut behind).ok()?;
        self.engine.accelerate(self.system, &mut behind).ok()?;
        self.jumps([node, &behind], STRUCK).then_some((met, behind))
    }

    /// A column in a state.
    fn column(&mut self, column: usize, node: &mut Node) -> Option<Vec<f64>> {
        self.engine.accelerate(self.system, node).ok()?;
        self.system.observe(&node.state.at(), &node.a, &node.lambda);
        let mut out = vec![0.0; self.system.observer.program().outputs()];
        self.system.columns(&node.state.modes, &mut out);
        Some(vec![out[column]])
    }

    /// The state behind roots that are crossed together, and whether its velocities jump.
    pub(super) fn crossed(&mut self, roots: &[usize], state: &mut State) -> Option<bool> {
        let (mut blows, before) = (Vec::new(), state.v.clone());
        for &root in roots {
            let mut row = vec![0.0; state.v.len()];
            if let Effect::Impulse { restitution, .. } | Effect::Bounce { restitution, .. } =
                self.system.cross_beside(root, state, &mut row)
            {
                blows.push(Blow { root, row, restitution, closing: None });
            }
        }
        // of a neighbour, not of the motion
        self.system.take_corner();
        if !blows.is_empty() {
            self.engine.impulses(self.system, state, &blows).ok()?;
        }
        Some(!blows.is_empty() || state.v != before)
    }

    /// The slope of a column at a node along neighbours (columns of `psi`).
    pub(super) fn slope(&mut self, column: usize, node: &Node, psi: &DMatrix<f64>) -> Option<DVector<f64>> {
        self.slopes(node, psi, &mut |side, node| side.column(column, node))
    }

    fn slopes(
        &mut self,
        node: &Node,
        psi: &DMatrix<f64>,
        read: &mut dyn FnMut(&mut Self, &mut Node) -> Option<Vec<f64>>,
    ) -> Option<DVector<f64>> {
        let mut out = DVector::zeros(psi.ncols());
        for (j, x) in psi.column_iter().enumerate() {
            out[j] = self.along(node, &Neighbour { time: 0.0, x: x.clone_owned().as_slice() }, &mut *read)?[0];
        }
        Some(out)
    }

    /// A column at a node.
    pub(super) fn value(&mut self, column: usize, node: &Node) -> Option<f64> {
        Some(self.column(column, &mut node.clone())?[0])
    }

    /// The slope of a root at a node along neighbours (columns of `psi`), and its rate along the motion.
    pub(super) fn approach(&mut self, root: usize, node: &Node, psi: &DMatrix<f64>) -> Option<(DVector<f64>, f64)> {
        let along = self.slopes(node, psi, &mut |side, node| side.root(root, node))?;
        Some((along, self.pace_of_root(root, node)?))
    }

    /// The rate of a root along the motion at a node.
    pub(super) fn pace_of_root(&mut self, root: usize, node: &Node) -> Option<f64> {
        let flow = rate(node);
        Some(self.along(node, &Neighbour { time: 1.0, x: flow.as_slice() }, |side, node| side.root(root, node))?[0])
    }

    /// The rate of a column along the motion at a node.
    pub(super) fn pace(&mut self, column: usize, node: &Node) -> Option<f64> {
        let flow = rate(node);
        Some(self.along(node, &Neighbour { time: 1.0, x: flow.as_slice() }, |side, node| side.column(column, node))?[0])
    }

    /// Neighbours behind a surface on which `roots` are crossed together: S Ψ, from the nodes before and after it; none where the motion only
    /// touches it.
    pub(super) fn cross(&mut self, roots: &[usize], [before, after]: [&Node; 2], psi: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let (flow, next) = (rate(before), rate(after));
        let jumps = self.crossed(roots, &mut before.state.clone())?;
        let size = flow.amax().max(next.amax());
        if !jumps && (&next - &flow).amax() <= SAME * size {
            return Some(psi.clone());
        }
        let (mut behind, mut carried) = (psi.clone(), flow.clone());
        if jumps {
            let nv = before.state.v.len();
            let mut read = |side: &mut Self, node: &mut Node| {
                side.crossed(roots, &mut node.state)?;
                Some(node.state.v.clone())
            };
            for j in 0..psi.ncols() {
                let x = psi.column(j).clone_owned();
                let v = self.along(before, &Neighbour { time: 0.0, x: x.as_slice() }, &mut read)?;
                behind.view_mut((nv, j), (nv, 1)).copy_from_slice(&v);
            }
            let v = self.along(before, &Neighbour { time: 1.0, x: flow.as_slice() }, &mut read)?;
            carried.rows_mut(nv, nv).copy_from_slice(&v);
        }
        let (along, pace) = self.approach(*roots.first()?, before, psi)?;
        if pace.abs() <= GRAZING * along.amax() || !pace.is_finite() {
            return None;
        }
        Some(behind + (next - carried) * (along / pace).transpose())
    }
}
