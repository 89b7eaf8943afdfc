//! The spanning tree of the joint graph: every body gets one road to the ground, as short as can be; what is left over is cut.

use super::joint::{Axis, Shape};
use super::{Joint, Mechanism};
use crate::geometry::{Pose, Space};
use crate::scalar::Scalar;

/// A moving step of a tree joint, applied in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step<G: Space> {
    /// A unit axis: turns about `u`, moves along `d` per unit of its coordinate; both in the frame before the step.
    Axis {
        /// Axis of rotation, or 0.
        u: G::Spin,
        /// Direction of motion, or 0.
        d: G::Vector,
        /// True if u is not 0.
        turns: bool,
        /// True if d is not 0.
        slides: bool,
        /// Index in q.
        q: usize,
        /// Index in v.
        v: usize,
    },
    /// A quaternion (4 coordinates) whose 3 velocities are ω in the frame after the step; reversed: the inverse rotation.
    Ball {
        /// First index in q.
        q: usize,
        /// First index in v.
        v: usize,
        /// True if the child is the joint's first body.
        reversed: bool,
    },
}

impl<G: Space> Step<G> {
    /// The step of a joint axis.
    pub(super) fn new(axis: Axis, reversed: bool, q: usize, v: usize) -> Self {
        let sign = if reversed { -1.0 } else { 1.0 };
        let spin = |u: [f64; 3]| G::spin(u.map(|x| sign * x));
        let vector = |d: [f64; 3], k: f64| G::vector(&d.map(|x| sign * k * x));
        match axis {
            Axis::Hinge(u) => Self::Axis { u: spin(u), d: G::Vector::default(), turns: true, slides: false, q, v },
            Axis::Slide(d) => Self::Axis { u: G::Spin::default(), d: vector(d, 1.0), turns: false, slides: true, q, v },
            Axis::Screw(u, pitch) => Self::Axis { u: spin(u), d: vector(u, pitch), turns: true, slides: true, q, v },
            Axis::Ball => Self::Ball { q, v, reversed },
        }
    }

    pub(super) fn lift<D: Scalar>(&self) -> Step<G::Lift<D>> {
        match *self {
            Self::Axis { u, d, turns, slides, q, v } => {
                Step::Axis { u: G::lift_spin::<D>(u), d: G::lift_vector::<D>(d), turns, slides, q, v }
            }
            Self::Ball { q, v, reversed } => Step::Ball { q, v, reversed },
        }
    }
}

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
    let mut front = vec![0];
    loop {
        while !front.is_empty() {
            let mut found: Vec<(usize, usize, Branch)> = Vec::new();
            for (j, edge) in edges.iter().enumerate() {
                let Some(rank) = edge.rank else { continue };
                for (parent, body, reversed) in [(edge.a, edge.b, false), (edge.b, edge.a, true)] {
                    if front.contains(&parent) && !reached[body] {
                        found.push((body, rank, Branch { body, parent, joint: Some((j, reversed)) }));
                    }
                }
            }
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
        let Some(body) = reached.iter().position(|r| !r) else { break };
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

/// The loop that a cut joint closes, as a path of names: `ground -O- crank -A- coupler -B- rocker -C- ground`.
#[must_use]
pub fn describe_loop<G: Space>(mechanism: &Mechanism<G>, joint: &Joint<G>) -> String {
    let up = |mut body: usize| {
        let mut path = vec![(body, String::new())];
        while let Some(node) = mechanism.nodes.iter().find(|n| n.body == body) {
            let index = mechanism.nodes.iter().position(|n| n.body == body);
            let name = mechanism.joints.iter().find(|j| j.tree.map(|t| Some(t.0)) == Some(index)).map_or("free", |j| &j.name);
            body = node.parent;
            path.push((body, name.to_string()));
        }
        path
    };
    let (mut a, mut b) = (up(joint.a.0), up(joint.b.0));
    // the roads share their end; keep one copy of the last common body
    while a.len() > 1 && b.len() > 1 && a[a.len() - 2].0 == b[b.len() - 2].0 {
        a.pop();
        b.pop();
    }
    let name = |body: usize| mechanism.bodies[body].name.as_str();
    let mut text = String::new();
    for (i, (body, via)) in a.iter().enumerate().rev() {
        text.push_str(name(*body));
        if i > 0 {
            let via = if via.is_empty() { "free" } else { via };
            text.push_str(&format!(" -{via}- "));
        }
    }
    text.push_str(&format!(" -{}- ", joint.name));
    for (i, (body, _)) in b.iter().enumerate() {
        text.push_str(name(*body));
        if let Some((_, via)) = b.get(i + 1) {
            text.push_str(&format!(" -{via}- "));
        }
    }
    text
}
