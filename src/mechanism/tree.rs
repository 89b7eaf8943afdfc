//! The spanning tree of the joint graph: every body gets one road to the ground, as short as can be; what is left over is cut.

use super::joint::{Axis, Shape};
use crate::geometry::{Pose, Space};

/// One branch of the tree: a body, its parent and the joint between them (none: a free joint of its own from the ground).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Branch {
    pub(super) body: usize,
    pub(super) parent: usize,
    /// Joint, and whether its first body is the child.
    pub(super) joint: Option<(usize, bool)>,
}

/// An edge of the joint graph.
pub(super) struct Edge {
    pub(super) a: usize,
    pub(super) b: usize,
    /// Smaller is better on the tree; none: never on the tree.
    pub(super) rank: Option<usize>,
}

/// The minimum-depth spanning tree by breadth-first search from the ground; where several joints lead to a body at the same
/// depth the one of lowest rank is taken. Bodies that no road reaches become free, the first of each group in file order.
pub(super) fn span(bodies: usize, edges: &[Edge]) -> Vec<Branch> {
    let mut reached = vec![false; bodies];
    reached[0] = true;
    let mut branches: Vec<Branch> = Vec::with_capacity(bodies.saturating_sub(1));
    // ways from each body, with their rank
    let mut ways: Vec<Vec<(usize, Branch)>> = vec![Vec::new(); bodies];
    for (j, edge) in edges.iter().enumerate() {
        let Some(rank) = edge.rank else { continue };
        for (parent, body, reversed) in [(edge.a, edge.b, false), (edge.b, edge.a, true)] {
            ways[parent].push((rank, Branch { body, parent, joint: Some((j, reversed)) }));
        }
    }
    let mut front = vec![0];
    let mut unreached = 0;
    loop {
        while !front.is_empty() {
            let ahead = front.iter().flat_map(|&parent: &usize| &ways[parent]).filter(|(_, way)| !reached[way.body]);
            let mut found: Vec<(usize, usize, Branch)> = ahead.map(|&(rank, way)| (way.body, rank, way)).collect();
            found.sort_by_key(|&(body, rank, branch)| (body, rank, branch.joint));
            front.clear();
            for (body, _, branch) in found {
                if !reached[body] {
                    reached[body] = true;
                    front.push(body);
                    branches.push(branch);
                }
            }
        }
        // bodies before it are reached
        let Some(body) = reached[unreached..].iter().position(|r| !r).map(|k| unreached + k) else { break };
        unreached = body;
        reached[body] = true;
        branches.push(Branch { body, parent: 0, joint: None });
        front.push(body);
    }
    branches
}

/// The star tree of cartesian coordinates: every body free in the ground frame.
pub(super) fn star(bodies: usize) -> Vec<Branch> {
    (1..bodies).map(|body| Branch { body, parent: 0, joint: None }).collect()
}

/// A tree of branches, parents first, in which no road from the ground or from a free body has more than `depth` joints: a body farther
/// away is free, and its joint cut.
pub(super) fn bounded(bodies: usize, branches: &[Branch], depth: usize) -> Vec<Branch> {
    let mut joints = vec![0; bodies];
    let bound = |branch: &Branch| {
        let count = if branch.joint.is_some() { joints[branch.parent] + 1 } else { 0 };
        let free = count > depth;
        joints[branch.body] = if free { 0 } else { count };
        if free { Branch { parent: 0, joint: None, ..*branch } } else { *branch }
    };
    branches.iter().map(bound).collect()
}

/// Fixed poses and steps of a branch's joint: joint frame in the parent, axes in the order of motion, child frame after them.
pub(super) fn placed<G: Space>(shape: &Shape, reversed: bool, planar: bool) -> (Pose<G>, Vec<Axis>, Pose<G>) {
    let before = Pose::translation(G::vector(&shape.pa));
    let after = shape.after::<G>(planar);
    let mut axes = shape.axes(planar);
    if reversed {
        axes.reverse();
        (after.inverse(), axes, before.inverse())
    } else {
        (before, axes, after)
    }
}
