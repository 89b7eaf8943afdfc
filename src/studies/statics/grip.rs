//! Where friction holds a mechanism at rest: at its start, and around a pose of a mechanism with one degree of freedom.

use super::pose::Pose;
use super::rest::Rest;
use crate::geometry::Space;
use crate::mechanism::Mechanism;

/// First step of the search for the end of a region, and how far it goes, in radians or sizes.
const STEP: f64 = 1e-3;
const FARTHEST: f64 = std::f64::consts::TAU;

/// The longest step of that search.
const LONGEST: f64 = 0.05;

/// A mechanism that friction holds.
pub(super) struct Gripped<G: Space<S = f64>> {
    /// With rows that hold the contacts that stick.
    pub(super) mechanism: Mechanism<G>,
    /// Where they stand, rad or m.
    pub(super) live: Vec<f64>,
    /// The pose.
    pub(super) pose: Pose,
    /// The senses of contacts that give all they can beside those.
    pub(super) senses: Vec<i32>,
    /// Contacts of which it is open how much they carry.
    pub(super) open: Vec<usize>,
}

/// The mechanism held by friction at a pose; none where it would move.
pub(super) fn gripped<G>(rest: &mut Rest<'_, G>, pose: Pose) -> Option<Gripped<G>>
where
    G: Space<S = f64>,
{
    if rest.system.dynamics.mechanism.contacts.is_empty() {
        return None;
    }
    let state = rest.state(&pose.position);
    let found = rest.system.gripped(&state)?;
    let live = rest.system.extents(&state);
    let mut mechanism = rest.system.dynamics.mechanism.clone();
    found.held.iter().for_each(|contact| mechanism.hold(*contact));
    (!found.held.is_empty()).then_some(Gripped { mechanism, live, pose, senses: found.senses, open: found.open })
}

/// The ends of the region around a pose, at which friction holds a mechanism with one degree of freedom; none at an end where it holds
/// on and on, and none at all where it does not hold at the pose, or there are more degrees of freedom.
pub(super) fn region<G>(rest: &mut Rest<'_, G>, pose: &Pose) -> Option<[Option<Pose>; 2]>
where
    G: Space<S = f64>,
{
    let frictionless = rest.system.dynamics.mechanism.contacts.is_empty();
    if frictionless || pose.basis.ncols() != 1 || !holds(rest, pose) {
        return None;
    }
    let mut ends = [-1.0, 1.0].map(|sense| end(rest, pose, sense));
    // the basis points one way or the other
    if let [Some(low), Some(high)] = &ends
        && low.position.q.iter().zip(&high.position.q).find(|(a, b)| a != b).is_some_and(|(a, b)| a > b)
    {
        ends.reverse();
    }
    Some(ends)
}

fn holds<G>(rest: &mut Rest<'_, G>, pose: &Pose) -> bool
where
    G: Space<S = f64>,
{
    let state = rest.state(&pose.position);
    rest.system.gripped(&state).is_some()
}

/// The last pose that is held in a sense, to the rounding of its coordinates.
fn end<G>(rest: &mut Rest<'_, G>, from: &Pose, sense: f64) -> Option<Pose>
where
    G: Space<S = f64>,
{
    let (mut here, mut step, mut gone) = (from.clone(), STEP, 0.0);
    let mut direction = &from.basis * nalgebra::DVector::from_element(1, sense);
    let mut halving = false;
    while gone < FARTHEST {
        let length = rest.measure(&direction);
        let delta = &direction * (step / length);
        let next = rest.moved(&here, delta.as_slice()).ok().filter(|next| next.basis.ncols() == 1);
        match next.filter(|next| holds(rest, next)) {
            Some(next) => {
                gone += step;
                // the same sense as before
                let along = &next.basis * nalgebra::DVector::from_element(1, 1.0);
                direction = if along.dot(&direction) < 0.0 { -along } else { along };
                here = next;
                if !halving {
                    step = (1.5 * step).min(LONGEST);
                }
            }
            None => {
                halving = true;
                step *= 0.5;
                if step < 1e-12 {
                    return Some(here);
                }
            }
        }
    }
    None
}
