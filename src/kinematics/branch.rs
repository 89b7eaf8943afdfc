//! Whether a path has stayed on its branch where two branches come near each other.
//!
//! Where links are almost as long as those of a mechanism with a change point, two branches that would cross come as near as a distance g and
//! turn away from each other, as the two arms of a hyperbola. A longer step leads from one arm straight on to the other, and all that is
//! smooth along it seems right. There det G changes its sign, or from two nodes points to zero within the step. Such a step is followed again
//! by parts of the way at whose end det G would vanish: on a line through two nodes that way is at least g beside another branch, and ever
//! shorter before a change point. As short as [`ACROSS`], and velocities as before, it is that of a change point, which is passed; where it
//! grows again, the path is that of the short steps. Velocities grow before a dead point, where det G vanishes as well. Of redundant rows
//! there is no determinant: σ takes its place, their smallest singular value, which is known less well.

use super::driven::Driven;
use super::node::PathPoint;
use super::steps::step;
use crate::geometry::Space;

/// A way to a singular position, rad or sizes, from which on it is that of a change point: behind it branches are not told apart. Nearer to one,
/// rates lose their digits.
const ACROSS: f64 = 2e-5;
/// The same of redundant rows, whose solver has a regularisation.
const ACROSS_REDUNDANT: f64 = 5e-3;
/// By how much velocities may have grown there: before a dead point they grow as det G falls.
const FASTER: f64 = 3.0;
/// Part of the way to a singular position that a step goes, and of redundant rows.
const PART: f64 = 0.6;
const PART_REDUNDANT: f64 = 0.2;
/// Part of det G below which a line through two nodes points at the end of a step that may hold a singular position.
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
    let (to, begun) = (node.t, driven.measure(&last.v));
    let (across, part) = if last.side == 0.0 { (ACROSS_REDUNDANT, PART_REDUNDANT) } else { (ACROSS, PART) };
    let mut own: Vec<PathPoint> = Vec::new();
    // the time in which det G vanishes, by the signed values at both ends, or by the nodes before
    let mut left = match before.last() {
        _ if last.side * node.side < 0.0 => (to - last.t).abs() / (1.0 + (node.regularity - last.regularity).exp()),
        Some(before) => vanishes(before, last),
        None => f64::INFINITY,
    };
    let mut h = to - last.t;
    for _ in 0..STEPS {
        let from = own.last().unwrap_or(last);
        let speed = driven.measure(&from.v);
        if left * speed < across && speed < FASTER * begun {
            return Branch::Same(PathPoint { crosses: true, ..node });
        }
        h = h.signum() * h.abs().min(part * left);
        let t = if h.abs() >= (to - from.t).abs() { to } else { from.t + h };
        match step(driven, modes, from, t, delta) {
            Ok(next) if from.side * next.side >= 0.0 => {
                left = vanishes(from, &next);
                own.push(PathPoint { narrow: true, ..next });
                if t == to {
                    return Branch::Other(own, h);
                }
                h *= GROWS;
            }
            _ => h = 0.5 * (t - from.t),
        }
        if h.abs() * speed < SHORTEST {
            break;
        }
    }
    // where velocities have not grown there is no dead point: rates have been lost before the way was as short as that
    let slow = own.last().map_or(last.side == 0.0, |from| driven.measure(&from.v) < FASTER * begun);
    if slow { Branch::Same(PathPoint { crosses: true, ..node }) } else { Branch::Other(own, h) }
}

/// The time, s, in which det G vanishes on a line through two nodes, behind the second one; without end where it does not fall.
fn vanishes(before: &PathPoint, last: &PathPoint) -> f64 {
    let falls = (before.regularity - last.regularity).exp() - 1.0;
    if falls > 0.0 { (last.t - before.t).abs() / falls } else { f64::INFINITY }
}

/// Whether there may be a singular position between the last two of three nodes.
fn is_suspect(before: Option<&PathPoint>, last: &PathPoint, node: &PathPoint) -> bool {
    if last.side * node.side < 0.0 {
        return true;
    }
    // what is small at the end is met by the next step, unless it may lie beyond: there is no sign of σ
    let small = last.side != 0.0 && node.regularity < last.regularity + POINTS.ln();
    // and from what lies behind a change point nothing points ahead
    let Some(before) = before.filter(|_| !last.crosses && !small) else { return false };
    (node.t - last.t).abs() > (1.0 - POINTS) * vanishes(before, last)
}
