//! Whether a path has stayed on its branch where two branches come near each other.
//!
//! Where links are almost as long as those of a mechanism with a change point, two branches that would cross come as near as a distance g and
//! turn away from each other, as the two arms of a hyperbola. A longer step leads from one arm straight on to the other, and all that is
//! smooth along it seems right. But on a branch det G keeps its sign, up to a singular position: behind a step that changes it the branch is
//! followed again by steps that do not. Where these come to a step as short as [`ACROSS`], there is a change point, which is passed; where
//! they turn away, the path is theirs. Redundant rows have no determinant: there steps are a part of the distance from singular positions,
//! which σ tells, the smallest singular value of the scaled rows.

use super::driven::Driven;
use super::node::PathPoint;
use super::steps::step;
use crate::geometry::Space;

/// A step that leads across a singular position, rad or sizes, behind which branches are not told apart.
const ACROSS: f64 = 2e-5;
/// The same by σ.
const WEAK: f64 = 3e-4;
/// Part of σ of a step beside a singular position, rad or sizes.
const PART: f64 = 0.2;
/// σ below which, and part of it below which a line through it points, a singular position may be in a step.
const NEAR: f64 = 0.3;
const POINTS: f64 = 0.25;
/// Steps at most, by how much they grow, and the shortest, rad or sizes.
const STEPS: usize = 400;
const GROWS: f64 = 1.5;
const SHORTEST: f64 = 1e-9;

/// Where a step has led.
pub(super) enum Branch {
    /// On along the branch, to this node.
    Same(PathPoint),
    /// To another branch: nodes on the own one instead, as far as they could be found or to the end of the step; and the step to take next, s.
    Other(Vec<PathPoint>, f64),
}

/// Where a step from the last of some nodes to another one has led.
pub(super) fn behind<G: Space<S = f64>>(
    driven: &mut Driven<'_, G>,
    modes: &mut [i32],
    nodes: &[PathPoint],
    node: PathPoint,
    delta: &mut [f64],
) -> Branch {
    let [before @ .., last] = nodes else { return Branch::Same(node) };
    if !is_suspect(before.last(), last, &node) {
        return Branch::Same(node);
    }
    let to = node.t;
    let mut own: Vec<PathPoint> = Vec::new();
    let mut h = 0.5 * (to - last.t);
    for _ in 0..STEPS {
        let from = own.last().unwrap_or(last);
        let speed = driven.measure(&from.v);
        if from.side == 0.0 {
            let sigma = from.regularity.exp();
            if sigma < WEAK {
                return Branch::Same(PathPoint { crosses: true, ..node });
            }
            h = h.signum() * h.abs().min(PART * sigma / speed);
        }
        let left = to - from.t;
        let t = if h.abs() >= left.abs() { to } else { from.t + h };
        match step(driven, modes, from, t, delta) {
            Ok(next) if from.side * next.side < 0.0 => {
                if (t - from.t).abs() * speed <= ACROSS {
                    return Branch::Same(PathPoint { crosses: true, ..node });
                }
                h = 0.5 * (t - from.t);
            }
            Ok(next) => {
                own.push(PathPoint { narrow: true, ..next });
                if t == to {
                    return Branch::Other(own, h);
                }
                h *= GROWS;
            }
            Err(_) => h = 0.5 * (t - from.t),
        }
        if h.abs() * speed < SHORTEST {
            break;
        }
    }
    Branch::Other(own, h)
}

/// Whether there may be a singular position between the last two of three nodes.
fn is_suspect(before: Option<&PathPoint>, last: &PathPoint, node: &PathPoint) -> bool {
    if last.side != 0.0 || node.side != 0.0 {
        return last.side * node.side < 0.0;
    }
    let Some(before) = before.filter(|_| last.regularity < NEAR.ln()) else { return false };
    let slope = (1.0 - (before.regularity - last.regularity).exp()) / (last.t - before.t);
    1.0 + slope * (node.t - last.t) < POINTS
}
