//! Bodies without inertia about an axis, as thin bars in space, that may turn about it.
//!
//! Where nothing holds that turn, M is singular on the motions that rows leave. Turned against its axes such a body has round-off in its
//! place, which no factorisation tells from an inertia; the signs of the pivots of [M − εM₀, Gᵀ; G, −E] do, M₀ the diagonal of M, or the
//! body's largest inertia where that is larger. Whether it is a thin body that they tell of is seen by giving these an inertia.

use super::assemble::{Assembled, units};
use super::saddle::Saddle;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, TreeNode};
use nalgebra::Matrix3;

/// ε: part of an inertia that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// A body that turns and has no inertia about one of its axes, and how much it has across it: 0 if it has none about any.
struct Thin<'m, G: Space> {
    node: &'m TreeNode<G>,
    across: f64,
}

/// The first body that can turn about an axis about which nothing has inertia, in the start of a mechanism; none if there is no such body.
pub(crate) fn spinning<G: Space<S = f64>>(mechanism: &Mechanism<G>, start: &Assembled) -> Option<usize> {
    if G::SPIN < 3 {
        return None;
    }
    let turns: Vec<bool> = units(mechanism).into_iter().map(|unit| unit == 0).collect();
    let mut thin = thin_bodies(mechanism, &turns);
    if thin.is_empty() {
        return None;
    }
    // a body without any inertia turns as one with what counts as little
    for body in thin.iter_mut().filter(|body| body.across == 0.0) {
        body.across = body.node.columns.clone().filter(|k| turns[*k]).map(|k| start.metric[k]).fold(0.0, f64::max);
    }
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.terms(0.0, &start.q, &start.v, &start.modes);
    let row_scale = dynamics.row_scale(&start.q, &start.modes, &start.metric);
    let scale: Vec<f64> = start.metric.iter().chain(&row_scale).map(|x| x.sqrt().recip()).collect();
    let mass = &dynamics.work.mass;
    // about an axis of the coordinates there is nothing at all
    let mut size: Vec<f64> = (0..mechanism.nv).map(|i| mass.at(i, i)).collect();
    raise(&thin, &turns, &mut size);
    // motions without inertia, where the turns of some bodies are given some
    let free = |given: &[Thin<'_, G>]| {
        let mut added: Vec<f64> = size.iter().map(|size| -ROUND_OFF * size).collect();
        for k in given.iter().flat_map(|body| body.node.columns.clone()).filter(|k| turns[*k]) {
            added[k] = size[k];
        }
        Some(Saddle::of_mass(mass, added.into_iter(), &dynamics.work.g, &scale)?.below)
    };
    let before = free(&[])?;
    if before == 0 || free(&thin)? >= before {
        return None;
    }
    // of the shortest list of first bodies that has to be given some it is the last: by halving
    let (mut low, mut high) = (0, thin.len());
    while high - low > 1 {
        let middle = low.midpoint(high);
        if free(&thin[..middle])? < before { high = middle } else { low = middle }
    }
    Some(thin[low].node.body)
}

/// Inertias (nv), of which those of the turns of thin bodies are at least what these bodies have across.
pub(crate) fn with_those_across<G: Space<S = f64>>(mechanism: &Mechanism<G>, inertias: &[f64]) -> Vec<f64> {
    let mut size = inertias.to_vec();
    if G::SPIN == 3 {
        let turns: Vec<bool> = units(mechanism).into_iter().map(|unit| unit == 0).collect();
        raise(&thin_bodies(mechanism, &turns), &turns, &mut size);
    }
    size
}

/// The bodies that turn, by which velocities do (nv), and have no inertia about one of their axes.
fn thin_bodies<'m, G: Space<S = f64>>(mechanism: &'m Mechanism<G>, turns: &[bool]) -> Vec<Thin<'m, G>> {
    mechanism.nodes.iter().filter_map(|node| Thin::of(mechanism, node, turns)).collect()
}

/// Raises the inertias (nv) of the turns of thin bodies to what these have across.
fn raise<G: Space>(thin: &[Thin<'_, G>], turns: &[bool], size: &mut [f64]) {
    for (body, k) in thin.iter().flat_map(|body| body.node.columns.clone().map(move |k| (body, k))).filter(|(_, k)| turns[*k]) {
        size[k] = size[k].max(body.across);
    }
}

impl<'m, G: Space<S = f64>> Thin<'m, G> {
    /// A body by its place in the tree, and which velocities turn (nv); none if it does not turn or has inertia about all axes.
    fn of(mechanism: &Mechanism<G>, node: &'m TreeNode<G>, turns: &[bool]) -> Option<Self> {
        node.columns.clone().find(|k| turns[*k])?;
        let inertia = mechanism.bodies[node.body].mass.inertia;
        let about = |axis: usize| G::apply(inertia, G::spin([0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 })));
        let tensor = Matrix3::from_fn(|i, j| G::spin_component(about(i), j));
        let found = tensor.symmetric_eigenvalues();
        (found.min() <= ROUND_OFF * found.max()).then(|| Self { node, across: found.max() })
    }
}
