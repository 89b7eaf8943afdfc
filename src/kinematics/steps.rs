//! One step of a path: predicted, corrected and trusted; or over a kink of a law, where velocities jump.

use super::driven::{Driven, NotReached};
use super::node::{PathPoint, SINGULAR};
use crate::geometry::Space;

/// A correction beyond this part of the move is not trusted.
const TRUSTED: f64 = 0.1;
/// Largest predicted move of one step, rad or sizes of the mechanism.
const FARTHEST: f64 = 0.3;
/// A correction of a position by round-off, rad or sizes.
const CORRECTED: f64 = 1e-9;
/// Halvings of a step, in which a law has a kink.
const HALVINGS: usize = 60;
/// What rows may miss by round-off beside a kink, rad or sizes.
const MET: f64 = 1e-10;
/// Units of round-off of a time between which a kink is located.
const LOCATED: f64 = 4.0;

/// One trusted step to time `t`.
///
/// # Errors
/// If the position there is not reached, or is not trusted to lie on the same branch.
pub(super) fn step<G: Space<S = f64>>(
    driven: &mut Driven<'_, G>,
    modes: &mut [i32],
    last: &PathPoint,
    t: f64,
    delta: &mut [f64],
) -> Result<PathPoint, NotReached> {
    let h = t - last.t;
    let size = follow(driven, modes, last, t, delta)?;
    if driven.correction > TRUSTED * size + CORRECTED {
        return Err(NotReached);
    }
    driven.rates(modes);
    // the velocity must go on smoothly: |v − (v₀ + h a₀)| against the velocities themselves
    for ((d, v), (v0, a0)) in delta.iter_mut().zip(&driven.v).zip(last.v.iter().zip(&last.a)) {
        *d = v - (v0 + h * a0);
    }
    let (jump, speed) = (driven.measure(delta), driven.measure(&last.v) + driven.measure(&driven.v));
    if jump.is_nan() || jump > 0.2 * speed + CORRECTED / h.abs() {
        return Err(NotReached);
    }
    Ok(driven.node(t, modes))
}

/// Predicts the position at time `t` by v h + ½ a h² and corrects it; how far that led, rad or sizes.
fn follow<G: Space<S = f64>>(
    driven: &mut Driven<'_, G>,
    modes: &mut [i32],
    last: &PathPoint,
    t: f64,
    delta: &mut [f64],
) -> Result<f64, NotReached> {
    let h = t - last.t;
    for (d, (v, a)) in delta.iter_mut().zip(last.v.iter().zip(&last.a)) {
        *d = h * (v + 0.5 * h * a);
    }
    let size = driven.measure(delta);
    if size.is_nan() || size > FARTHEST {
        return Err(NotReached);
    }
    driven.q.copy_from_slice(&last.q);
    driven.dynamics.mechanism.retract(&mut driven.q, delta);
    driven.wind(modes, &last.turns);
    driven.follow(t, modes)?;
    Ok(size)
}

/// The nodes just before and just behind the first kink of a law between a node and time `t`, if that is what a step there meets: laws
/// change their modes, and what they hold does not jump.
pub(super) fn over_kink<G: Space<S = f64>>(
    driven: &mut Driven<'_, G>,
    modes: &mut [i32],
    last: &PathPoint,
    t: f64,
    delta: &mut [f64],
) -> Option<[PathPoint; 2]> {
    let switches = driven.dynamics.mechanism.switches;
    follow(driven, modes, last, last.t, delta).ok()?;
    let before = modes[..switches].to_vec();
    // a step that is too long, or within one mode, fails for another reason
    let reached = follow(driven, modes, last, t, delta);
    if driven.measure(delta) > FARTHEST || reached.is_ok() && modes[..switches] == before[..] {
        return None;
    }
    let (mut near, mut far) = (last.t, t);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (near + far);
        if middle == near || middle == far {
            break;
        }
        let within = follow(driven, modes, last, middle, delta).is_ok() && modes[..switches] == before[..];
        *(if within { &mut near } else { &mut far }) = middle;
    }
    let near = if near == last.t { last.clone() } else { step(driven, modes, last, near, delta).ok()? };
    follow(driven, modes, &near, far, delta).ok()?;
    if driven.correction > CORRECTED || modes[..switches] == before[..] {
        return None;
    }
    let mut missed = driven.dynamics.work.phi.clone();
    if driven.condition() < SINGULAR {
        return None;
    }
    driven.rates(modes);
    let behind = driven.node(far, modes);
    // rows in the modes before, as far as they miss more than velocities make of the time between the nodes
    let mut same = modes.to_vec();
    same[..switches].copy_from_slice(&before);
    driven.dynamics.time(far, &same);
    driven.dynamics.position(&behind.q, &same);
    let rows = driven.dynamics.work.phi.iter().zip(driven.row_unit());
    missed.iter_mut().zip(rows).for_each(|(missed, (phi, unit))| *missed = (*missed - phi).abs() * unit);
    let located = LOCATED * f64::EPSILON * far.abs() * (driven.measure(&near.v) + driven.measure(&behind.v));
    missed.iter().all(|missed| *missed <= MET + located).then_some([near, behind])
}
