//! A mode drawn: the mechanism at rest, and displaced both ways along its constraints.

use crate::dynamics::Dynamics;
use crate::geometry::{self, Space};
use crate::kinematics::held::Pose;
use crate::mechanism::{Mechanism, Step};
use crate::results::Scene;
use crate::studies::common::case::Case;
use crate::studies::common::scene::{Span, Subject, extent};
use nalgebra::DVector;
use std::f64::consts::TAU;

/// Largest move of a drawn point, as part of the picture's size.
const MOVE: f64 = 0.08;
/// Largest turn of a coordinate, rad.
const TURN: f64 = 0.5;
/// Closed so far, m or rad.
const CLOSED: f64 = 1e-10;
/// Cells of the frames of a swing: at least, so that both sides are there, and at most.
const QUARTERS: usize = 4;
const CELLS: usize = 128;
/// A mechanism of more velocities has the fewest frames: closing it takes time.
const LARGE: usize = 200;
/// Steps of closing, and halvings of a displacement that does not close.
const STEPS: usize = 60;
const HALVINGS: usize = 6;

/// One swing of a shape of all velocities (nv), from rest over both sides back to rest, over its phase, rad; `close` gives the
/// displacement (nv) that closes gaps Φ (rows).
pub(super) fn picture<G: Space<S = f64>>(
    case: Case<'_>,
    mechanism: &Mechanism<G>,
    pose: Pose<'_>,
    delta: &DVector<f64>,
    mut close: impl FnMut(&[f64]) -> Vec<f64>,
) -> Scene {
    let mut dynamics = Dynamics::without_mass(mechanism);
    dynamics.time(0.0, pose.modes);
    let mut at = |s: f64| displaced(&mut dynamics, pose, &(delta * s), &mut close);
    let subject = Subject { case, mechanism };
    let Some(rest) = at(0.0) else { return Scene::default() };
    let largest = mechanism.steps.iter().fold(0.0, |m: f64, step| match *step {
        Step::Axis { turns: true, v, .. } => m.max(delta[v].abs()),
        Step::Ball { v, .. } => m.max(delta.rows(v, 3).norm()),
        Step::Axis { .. } => m,
    });
    let probe = 1e-6 / delta.amax().max(f64::MIN_POSITIVE);
    let (size, moved) = match at(probe) {
        Some(near) => extent(mechanism, &rest, &near),
        None => (1.0, 0.0),
    };
    // limits of points and of turns; a shape that moves nothing seen keeps the latter
    let by_points = if moved > 0.0 { MOVE * size * probe / moved } else { f64::INFINITY };
    let by_turns = if largest > 0.0 { TURN / largest } else { f64::INFINITY };
    let mut s = by_points.min(by_turns);
    if !s.is_finite() {
        s = 0.0;
    }
    for _ in 0..HALVINGS {
        if at(s).is_some() && at(-s).is_some() {
            let most = if mechanism.nv > LARGE { QUARTERS } else { CELLS };
            let span = Span { ends: [0.0, TAU], turns: true, first: QUARTERS, most, ..Span::default() };
            let mut scene = subject.over(span, &mut |phase| Some((phase, at(s * phase.sin())?)));
            let last = scene.frames.count() - 1;
            scene.frames.shown = vec![last / 4, 0, last - last / 4];
            scene.frames.rest = Some(0);
            return scene;
        }
        s *= 0.5;
    }
    subject.of_poses(&[rest])
}

/// Poses of the bodies after a displacement (nv), the constraints closed; none if they do not close.
fn displaced<G: Space<S = f64>>(
    dynamics: &mut Dynamics<'_, G>,
    pose: Pose<'_>,
    delta: &DVector<f64>,
    close: &mut dyn FnMut(&[f64]) -> Vec<f64>,
) -> Option<Vec<geometry::Pose<G>>> {
    let mechanism = dynamics.mechanism;
    let mut q = pose.q.to_vec();
    mechanism.retract(&mut q, delta.as_slice());
    for _ in 0..STEPS {
        dynamics.position(&q, pose.modes);
        if dynamics.work.phi.iter().all(|x| x.abs() <= CLOSED) {
            return Some(dynamics.poses());
        }
        mechanism.retract(&mut q, &close(&dynamics.work.phi));
    }
    None
}
