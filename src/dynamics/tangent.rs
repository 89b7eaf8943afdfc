//! Exact tangents K = ∂r/∂q and C = ∂r/∂v of the residual r = M a + Gᵀλ − f, by dual numbers.
//!
//! K is the derivative along q ⊕ εδ, δ in the frame of v. Columns whose entries never meet in a row share a direction
//! (Curtis, Powell & Reid 1974), so the cost is the number of colours, not of columns; [`LANES`] directions go in one pass.

use super::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Gauge, Leaf, Mechanism, Step, StretchOf};
use crate::scalar::{Dual, Scalar};
use grashof_solvers::{Coloring, Sparsity};

/// Directions carried in one pass.
pub const LANES: usize = 4;

/// Dense tangents, row by row (nv × nv).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tangents {
    /// K = ∂r/∂q.
    pub k: Vec<f64>,
    /// C = ∂r/∂v.
    pub c: Vec<f64>,
}

/// A state with accelerations and multipliers.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Time, s.
    pub t: f64,
    /// Coordinates (nq).
    pub q: &'a [f64],
    /// Velocities (nv).
    pub v: &'a [f64],
    /// Accelerations (nv).
    pub a: &'a [f64],
    /// Multipliers (rows).
    pub lambda: &'a [f64],
    /// Modes.
    pub modes: &'a [i32],
}

/// Entries that K or C may have: columns i and k meet if one body's path, one gauge or one force law knows both.
#[must_use]
pub fn pattern<G: Space>(m: &Mechanism<G>) -> Sparsity {
    let mut groups: Vec<Vec<usize>> = m.bodies.iter().map(|b| b.path.clone()).collect();
    let of_gauge = |g: &Gauge<G>| [m.bodies[g.a].path.clone(), m.bodies[g.b].path.clone()].concat();
    groups.extend(m.gauges[..m.active_gauges].iter().map(of_gauge));
    for f in &m.functions {
        groups.push(f.gauges.iter().flat_map(|&g| of_gauge(&m.gauges[g])).collect());
    }
    let of_stretch = |of: StretchOf| match of {
        StretchOf::Gauge(g) => of_gauge(&m.gauges[g]),
        StretchOf::Function(f) => m.functions[f].gauges.iter().flat_map(|&g| of_gauge(&m.gauges[g])).collect(),
    };
    // a force given by a program may depend on every input of it and acts on its bodies
    let mut law: Vec<usize> = Vec::new();
    for &(_, leaf) in &m.force_program.fills {
        match leaf {
            Leaf::Time => {}
            Leaf::Gauge { gauge, .. } => law.extend(of_gauge(&m.gauges[gauge])),
            Leaf::Stretch { spring, .. } => law.extend(of_stretch(m.stretches[spring].of)),
            Leaf::Spin { body, .. } => law.extend(&m.bodies[body].path),
        }
    }
    if m.force_program.outputs > 0 {
        for pull in &m.pulls {
            groups.push([law.clone(), m.bodies[pull.body].path.clone(), m.bodies[pull.frame].path.clone()].concat());
        }
        for effort in &m.efforts {
            groups.push([law.clone(), of_stretch(effort.along)].concat());
        }
    }
    Sparsity::new(m.nv, m.nv, groups.iter().flat_map(|g| g.iter().flat_map(move |&i| g.iter().map(move |&k| (i, k)))))
}

/// K and C at a point, by an evaluator of the lifted mechanism; `coloring` is of [`pattern`].
pub fn tangents<G, D>(lifted: &mut Dynamics<'_, D>, coloring: &Coloring, pattern: &Sparsity, at: &Point<'_>, out: &mut Tangents)
where
    G: Space<Lift<Dual<LANES>> = D>,
    D: Space<S = Dual<LANES>>,
{
    let nv = lifted.mechanism.nv;
    out.k.clear();
    out.k.resize(nv * nv, 0.0);
    out.c.clear();
    out.c.resize(nv * nv, 0.0);
    let constant = |x: &[f64]| x.iter().map(|x| Dual::constant(*x)).collect::<Vec<Dual<LANES>>>();
    let (a, lambda) = (constant(at.a), constant(at.lambda));
    let mut r = vec![Dual::constant(0.0); nv];
    for first in (0..coloring.count).step_by(LANES) {
        let lane = |k: usize| coloring.color[k].checked_sub(first).filter(|l| *l < LANES);
        for velocity in [false, true] {
            let (mut q, mut v) = (constant(at.q), constant(at.v));
            if velocity {
                for (k, v) in v.iter_mut().enumerate() {
                    if let Some(l) = lane(k) {
                        v.d[l] = 1.0;
                    }
                }
            } else {
                seed(lifted.mechanism, &mut q, lane);
            }
            lifted.terms(Dual::constant(at.t), &q, &v, at.modes);
            lifted.residual(&a, &lambda, &mut r);
            let target = if velocity { &mut out.c } else { &mut out.k };
            for k in 0..nv {
                if let Some(l) = lane(k) {
                    for &i in pattern.column(k) {
                        target[i * nv + k] = r[i].d[l];
                    }
                }
            }
        }
    }
}

/// Derivatives of q ⊕ ε e_k in the lanes of the columns: 1 for an axis, ½ q∘(0, e) for a quaternion.
fn seed<D: Space<S = Dual<LANES>>>(mechanism: &Mechanism<D>, q: &mut [Dual<LANES>], lane: impl Fn(usize) -> Option<usize>) {
    let mut qdot = vec![0.0; mechanism.nq];
    let plain: Vec<f64> = q.iter().map(|x| x.x).collect();
    for step in &mechanism.steps {
        let (first, columns) = match *step {
            Step::Axis { v, .. } => (v, 1),
            Step::Ball { v, .. } => (v, 3),
        };
        for k in first..first + columns {
            let Some(l) = lane(k) else { continue };
            let mut e = vec![0.0; mechanism.nv];
            e[k] = 1.0;
            mechanism.rate(&plain, &e, &mut qdot);
            for (q, d) in q.iter_mut().zip(&qdot) {
                if *d != 0.0 {
                    q.d[l] = *d;
                }
            }
        }
    }
}
