//! The motion of a driven mechanism over a range of time, by predictor-corrector continuation with step control.
//!
//! From one node to the next the position is predicted by v h + ½ a h² and corrected by Newton. A step counts only if the
//! correction is small against the move and the new velocity is near the predicted one: another branch, or the far side of
//! a dead point, fails both and the step is cut; where branches come near each other, `branch` tells them apart. Where steps shrink to nothing the driver cannot go on (a dead point); a
//! change point, where two branches cross at an angle, is stepped over on the smooth branch.

use super::branch::{Branch, behind};
use super::driven::{Driven, NotReached};
use super::fold::fold;
use super::laws::{Jump, first_jump, jump_beside};
pub use super::node::{PathPoint, SINGULAR};
use super::standing::Standing;
use super::steps::{over_kink, step};
use super::undefined::Gap;
use crate::geometry::Space;
use crate::mechanism::Step;
use crate::numerics::hermite::Hermite;

/// The path from the earliest to the latest node.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Nodes, t rising.
    pub nodes: Vec<PathPoint>,
    /// Dead points at the two ends, if the range was not reached there: time and coordinates.
    pub dead: [Option<DeadPoint>; 2],
    /// A row that cannot be met with the others behind the end of the path, if that is why it ends.
    pub open: Option<usize>,
    /// What is undefined behind the end of the path, if that is why it ends.
    pub gap: Option<Gap>,
    /// The law that jumps there, if that is why it ends.
    pub jump: Option<Jump>,
    /// Time at which the way back from the start ends other than at a dead point, if that way was asked for and does.
    pub back: Option<f64>,
}

/// Time and coordinates of a dead point.
pub type DeadPoint = (f64, Vec<f64>);

/// Why there is no path.
#[derive(Clone, Debug, PartialEq)]
pub enum NoPath {
    /// The start is a singular position, where velocities are not determined.
    SingularStart,
    /// The range asks for more steps than [`MOST_NODES`].
    TooLong,
    /// Something has no value at the start.
    Undefined(Gap),
    /// A law jumps just behind the start.
    Jump(Jump),
}

/// Steps of a path at most: some 50 000 turns of a crank.
pub const MOST_NODES: usize = 2_000_000;

/// Steps below this part of the range mean that the path has ended.
const SHORTEST: f64 = 1e-13;
/// Part of the range, and move in rad or sizes, at which a path begins beside a start in a change point.
const AROUND: f64 = 4e-3;
/// See [`AROUND`].
const AROUND_MOVE: f64 = 0.03;

impl Path {
    /// Follows the path from t = 0 to `to` (which may be negative), and back as far if it ends at a dead point.
    ///
    /// # Errors
    /// If the start is a singular position, or the range is endless.
    pub(crate) fn trace<G: Space<S = f64>>(
        driven: &mut Driven<'_, G>,
        modes: &mut [i32],
        to: f64,
        standing: Option<&Standing>,
    ) -> Result<Self, NoPath> {
        let (q, v) = (driven.q.clone(), driven.v.clone());
        let reached = driven.follow(0.0, modes).is_ok();
        if !reached && let Some(law) = driven.dynamics.undefined(modes) {
            return Err(NoPath::Undefined(Gap::Law(law)));
        }
        let ends = if reached && driven.condition() >= SINGULAR {
            driven.rates(modes);
            let start = driven.node(0.0, modes);
            [start.clone(), start]
        } else {
            match standing {
                Some(standing) => standing.around(driven, modes, to),
                None => around(driven, modes, [&q, &v], to),
            }
            .ok_or(NoPath::SingularStart)?
        };
        let [behind, ahead] = ends;
        let (mut nodes, end) = match march(driven, modes, &ahead, to)? {
            (nodes, End::Jump(law)) => (nodes, End::Jump(law)),
            (nodes, end) => leapt(driven, modes, nodes, end),
        };
        if behind.t != ahead.t {
            nodes.insert(0, behind.clone());
        }
        let (mut dead, mut open, mut gap, mut jump, mut way_back) = ([None, None], None, None, None, None);
        match end {
            End::Reached => {}
            End::Dead(point) => dead[1] = Some(point),
            End::Open(row, point) => (dead[1], open) = (Some(point), Some(row)),
            End::Undefined(what) => gap = Some(what),
            End::Jump(law) if nodes.len() < 2 => return Err(NoPath::Jump(law)),
            End::Jump(law) => jump = Some(law),
        }
        if dead[1].is_some() {
            let (back, end) = march(driven, modes, &behind, -to)?;
            match end {
                End::Reached => {}
                End::Dead(point) | End::Open(_, point) => dead[0] = Some(point),
                // what lies behind the start is of no interest
                End::Undefined(_) | End::Jump(_) => way_back = back.last().map(|node| node.t),
            }
            nodes = back.into_iter().skip(1).rev().chain(nodes).collect();
            if to < 0.0 {
                nodes.reverse();
                dead.reverse();
            }
        } else if to < 0.0 {
            nodes.reverse();
        }
        Ok(Self { nodes, dead, open, gap, jump, back: way_back })
    }

    /// Time of the node that is farthest from 0.
    pub fn last(&self) -> Option<f64> {
        [self.nodes.first(), self.nodes.last()].into_iter().flatten().map(|n| n.t).max_by(|a, b| a.abs().total_cmp(&b.abs()))
    }

    /// A guess of the coordinates at `t`: quintic Hermite in axes, cubic in quaternions; and the node nearest before it.
    pub fn guess<G: Space<S = f64>>(&self, driven: &Driven<'_, G>, t: f64, q: &mut [f64]) -> usize {
        let m = driven.dynamics.mechanism;
        let after = self.nodes.partition_point(|n| n.t < t).clamp(1, self.nodes.len().max(2) - 1);
        let first = &self.nodes[after - 1];
        let Some(second) = self.nodes.get(after) else {
            q.copy_from_slice(&first.q);
            return after - 1;
        };
        let h = second.t - first.t;
        let past = t - first.t;
        for step in &m.steps {
            match *step {
                Step::Axis { q: i, v: k, .. } => {
                    let end = |n: &PathPoint| [n.q[i], n.v[k], n.a[k]];
                    q[i] = Hermite::quintic(h, end(first), end(second)).at(past)[0];
                }
                Step::Ball { q: i, .. } => {
                    let near = if past < 0.5 * h { first } else { second };
                    let mut delta = vec![0.0; m.nv];
                    let dt = t - near.t;
                    for (d, (v, a)) in delta.iter_mut().zip(near.v.iter().zip(&near.a)) {
                        *d = dt * (v + 0.5 * dt * a);
                    }
                    let mut moved = near.q.clone();
                    m.retract(&mut moved, &delta);
                    q[i..i + 4].copy_from_slice(&moved[i..i + 4]);
                }
            }
        }
        if past < 0.5 * h { after - 1 } else { after }
    }
}

/// Regular nodes on both sides of a start [q, v] in a change point, on the branch of its velocity; none if there is no motion through it.
fn around<G: Space<S = f64>>(driven: &mut Driven<'_, G>, modes: &mut [i32], [q, v]: [&[f64]; 2], to: f64) -> Option<[PathPoint; 2]> {
    let reach = around_reach(driven, v, to);
    let turns = driven.node(0.0, modes).turns;
    let mut beside = |t: f64| {
        driven.q.copy_from_slice(q);
        driven.dynamics.mechanism.retract(&mut driven.q, &v.iter().map(|v| v * t).collect::<Vec<_>>());
        driven.wind(modes, &turns);
        driven.follow(t, modes).ok()?;
        if driven.condition() < SINGULAR {
            return None;
        }
        driven.rates(modes);
        let off: Vec<f64> = driven.v.iter().zip(v).map(|(x, v)| x - v).collect();
        (driven.measure(&off) < 0.2 * driven.measure(v)).then(|| driven.node(t, modes))
    };
    Some([beside(-reach)?, beside(reach)?])
}

/// Time, with the sign of `to`, in which the velocity v leads from a change point to where positions are regular.
fn around_reach<G: Space<S = f64>>(driven: &Driven<'_, G>, v: &[f64], to: f64) -> f64 {
    (AROUND * to.abs()).min(AROUND_MOVE / driven.measure(v)) * to.signum()
}

/// Where a path ends.
enum End {
    Reached,
    Dead(DeadPoint),
    Open(usize, DeadPoint),
    Undefined(Gap),
    Jump(Jump),
}

/// Nodes from `start` to time `to`, and what ends them.
fn march<G: Space<S = f64>>(
    driven: &mut Driven<'_, G>,
    modes: &mut [i32],
    start: &PathPoint,
    to: f64,
) -> Result<(Vec<PathPoint>, End), NoPath> {
    let mut nodes = vec![start.clone()];
    let longest = to / 48.0;
    let mut h = longest;
    let mut delta = vec![0.0; start.v.len()];
    while let Some(last) = nodes.last() {
        if nodes.len() > MOST_NODES {
            return Err(NoPath::TooLong);
        }
        let left = to - last.t;
        if left.abs() <= 1e-14 * to.abs() {
            return Ok((nodes, End::Reached));
        }
        if h.abs() >= left.abs() * (1.0 - 1e-12) {
            h = left;
        }
        let t = if h == left { to } else { last.t + h };
        let reached = step(driven, modes, last, t, &mut delta).map(|node| behind(driven, modes, &nodes, node, &mut delta));
        match reached {
            Ok(Branch::Same(node)) => {
                nodes.push(node);
                h = if (1.6 * h).abs() < longest.abs() { 1.6 * h } else { longest };
            }
            Ok(Branch::Other(own, next)) if !own.is_empty() => {
                nodes.extend(own);
                h = next;
            }
            Ok(Branch::Other(..)) | Err(NotReached) => {
                if let Some([before, behind]) = over_kink(driven, modes, last, t, &mut delta) {
                    nodes.extend((before.t != last.t).then_some(before).into_iter().chain([behind]));
                    continue;
                }
                // a range that ends in a change point is followed to beyond it
                if h == left
                    && let Ok(node) = step(driven, modes, last, to + around_reach(driven, &last.v, to), &mut delta)
                    && let Branch::Same(node) = behind(driven, modes, &nodes, node, &mut delta)
                {
                    nodes.push(node);
                    return Ok((nodes, End::Reached));
                }
                h *= 0.6;
                if h.abs() < SHORTEST * to.abs() {
                    if let Some(law) = driven.dynamics.undefined(modes) {
                        return Ok((nodes, End::Undefined(Gap::Law(law))));
                    }
                    let row = driven.open;
                    if let Some(law) = jump_beside(driven, modes, last, to) {
                        return Ok((nodes, End::Jump(law)));
                    }
                    if let Some(row) = row {
                        let end = End::Open(row, (last.t, last.q.clone()));
                        return Ok((nodes, end));
                    }
                    let end = fold(driven, modes, last, to.signum()).unwrap_or_else(|| (last.t, last.q.clone()));
                    return Ok((nodes, End::Dead(end)));
                }
            }
        }
    }
    Ok((nodes, End::Reached))
}

/// The path up to the first law that jumps by so little that a step has leapt over it, if one does; else as it is.
fn leapt<G: Space<S = f64>>(driven: &mut Driven<'_, G>, modes: &mut [i32], mut nodes: Vec<PathPoint>, end: End) -> (Vec<PathPoint>, End) {
    let times: Vec<f64> = nodes.iter().map(|node| node.t).collect();
    let Some((before, law)) = first_jump(&mut driven.dynamics, modes, &times) else { return (nodes, end) };
    nodes.retain(|node| node.t.abs() <= before.abs());
    if let Some(last) = nodes.last().filter(|last| last.t != before).cloned()
        && let Ok(node) = step(driven, modes, &last, before, &mut vec![0.0; last.v.len()])
    {
        nodes.push(node);
    }
    (nodes, End::Jump(law))
}
