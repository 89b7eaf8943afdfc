//! Bodies without inertia about an axis, as thin bars in space, that may turn about it.
//!
//! Where nothing holds that turn, M is singular on the motions that rows leave. Turned against its axes such a body has round-off in its
//! place, which no factorisation tells from an inertia; the signs of the pivots of [M − εM₀, Gᵀ; G, −E] do, M₀ the diagonal of M, or the
//! body's largest inertia where that is larger.

use super::assemble::Assembled;
use super::saddle::Saddle;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Mechanism, Step, TreeNode};
use nalgebra::Matrix3;

/// ε: part of an inertia that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// The first body that can turn about an axis about which nothing has inertia, in the start of a mechanism; none if there is no such body.
pub(crate) fn spinning<G: Space<S = f64>>(mechanism: &Mechanism<G>, start: &Assembled) -> Option<usize> {
    let thin: Vec<(&TreeNode<G>, f64)> = mechanism.nodes.iter().filter_map(|node| Some((node, across(mechanism, node)?))).collect();
    if thin.is_empty() {
        return None;
    }
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.terms(0.0, &start.q, &start.v, &start.modes);
    let row_scale = dynamics.row_scale(&start.q, &start.modes, &start.metric);
    let scale: Vec<f64> = start.metric.iter().chain(&row_scale).map(|x| x.sqrt().recip()).collect();
    let mass = &dynamics.work.mass;
    // motions without inertia, where the turns of a body are given some
    let free = |given: Option<&TreeNode<G>>| {
        let all = mass.lines().enumerate().flat_map(|(i, line)| line.entries().map(move |(j, m)| (i, j, m)).collect::<Vec<_>>());
        let part = |i: usize| if given.is_some_and(|node| node.columns.contains(&i)) { -1.0 } else { ROUND_OFF };
        // about an axis of the coordinates there is nothing at all
        let size = |i: usize| thin.iter().filter(|(node, _)| node.columns.contains(&i)).fold(mass.at(i, i), |m, (_, size)| m.max(*size));
        let less = (0..mechanism.nv).map(|i| (i, i, -part(i) * size(i)));
        Saddle::new(all.chain(less), &dynamics.work.g, &scale).map_or(0, |found| found.below)
    };
    let all = free(None);
    (all > 0).then(|| thin.iter().find(|(node, _)| free(Some(*node)) < all).or(thin.first()).map(|(node, _)| node.body))?
}

/// The largest inertia of a body that turns about all axes and has none about one of them; none of another body.
fn across<G: Space<S = f64>>(mechanism: &Mechanism<G>, node: &TreeNode<G>) -> Option<f64> {
    mechanism.steps[node.steps.clone()].iter().find(|step| matches!(step, Step::Ball { .. }))?;
    let inertia = mechanism.bodies[node.body].mass.inertia;
    let about = |axis: usize| G::apply(inertia, G::spin([0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 })));
    let tensor = Matrix3::from_fn(|i, j| G::spin_component(about(i), j));
    let found = tensor.symmetric_eigenvalues();
    (found.max() > 0.0 && found.min() <= ROUND_OFF * found.max()).then_some(found.max())
}
