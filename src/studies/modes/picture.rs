//! A mode drawn: the mechanism at rest, and displaced both ways along its constraints.

use crate::dynamics::Dynamics;
use crate::geometry::{self, Space};
use crate::kinematics::held::Pose;
use crate::mechanism::{Mechanism, Step};
use crate::results::Scene;
use crate::studies::common::scene::of_poses;
use nalgebra::DVector;

/// Largest move of a drawn point, as part of the picture's size.
const MOVE: f64 = 0.08;
/// Largest turn of a coordinate, rad.
const TURN: f64 = 0.5;
/// Closed so far, m or rad.
const CLOSED: f64 = 1e-10;
/// Steps of closing, and halvings of a displacement that does not close.
const STEPS: usize = 60;
const HALVINGS: usize = 6;

/// Outlines at rest and displaced by ± a shape of all velocities (nv); `close` gives the displacement (nv) that closes gaps Φ (rows).
pub(super) fn picture<G: Space<S = f64>>(
    mechanism: &Mechanism<G>,
    pose: Pose<'_>,
    delta: &DVector<f64>,
    mut close: impl FnMut(&[f64]) -> Vec<f64>,
) -> Scene {
    let mut dynamics = Dynamics::without_mass(mechanism);
    dynamics.time(0.0, pose.modes);
    let mut at = |s: f64| displaced(&mut dynamics, pose, &(delta * s), &mut close);
    let Some(rest) = at(0.0) else { return Scene::default() };
    let largest = mechanism.steps.iter().fold(0.0, |m: f64, step| match *step {
        Step::Axis { turns: true, v, .. } => m.max(delta[v].abs()),
        Step::Ball { v, .. } => m.max(delta.rows(v, 3).norm()),
        Step::Axis { .. } => m,
    });
    let probe = 1e-6 / delta.amax().max(f64::MIN_POSITIVE);
    let (size, moved) = match at(probe) {
        Some(near) => extent(&of_poses(mechanism, &[rest.clone(), near])),
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
        if let (Some(ahead), Some(back)) = (at(s), at(-s)) {
            return of_poses(mechanism, &[rest, ahead, back]);
        }
        s *= 0.5;
    }
    of_poses(mechanism, &[rest])
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

/// Size of a picture, and the largest move of its points from its first pose to its second.
fn extent(scene: &Scene) -> (f64, f64) {
    let (mut low, mut high, mut moved) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2], 0.0_f64);
    let bodies = scene.bodies.iter().filter_map(|(_, poses)| Some((poses.first()?.clone(), poses.get(1)?.clone())));
    let joints = scene.joints.iter().map(|j| (j.at[..1].to_vec(), j.at[1..2].to_vec()));
    for (first, second) in bodies.chain(joints) {
        for (p, q) in first.iter().zip(&second) {
            moved = moved.max((p[0] - q[0]).hypot(p[1] - q[1]));
            for axis in 0..2 {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
        }
    }
    let size = (high[0] - low[0]).hypot(high[1] - low[1]);
    (if size > 0.0 && size.is_finite() { size } else { 1.0 }, moved)
}
