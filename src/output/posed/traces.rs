//! Paths of points in the picture, with as many places as their arcs ask for.

use super::Posed;
use crate::output::pose::Trace;
use crate::output::view::{cross, dot};
use crate::results::Scene;
use crate::results::scene::{self, Place};

/// Places along a path at least.
const ALONG: usize = 240;
/// The body of a point turns by this at most from one place to the next, rad: chords of a circle as wide as a picture are then a tenth of a
/// pixel off.
const ARC: f64 = 0.05;
/// Places along a path at most, some 200 turns: a longer one fills the picture, and is left away.
pub(in crate::output) const MOST: usize = 25_000;
/// A path is left away, too, where frames leave out more than this part of what is seen of the motion.
const FAIR: f64 = 0.02;

impl Posed<'_> {
    /// A path through the frames, with places between them; none if it cannot be drawn as it is.
    pub(super) fn trace(&self, trace: &scene::Trace) -> Option<Trace> {
        let place = Place { body: trace.body, at: trace.at.clone() };
        let at = |x: f64| self.flat(&self.scene.frames.at(x, self.scene.dimensions), &place);
        Some(Trace { name: trace.name.clone(), points: places(self.scene, trace)?.into_iter().map(at).collect() })
    }
}

/// Values of the independent variable along a path, rising; none if it is longer than can be seen, or not known from the frames.
pub(in crate::output) fn places(scene: &Scene, trace: &scene::Trace) -> Option<Vec<f64>> {
    let frames = &scene.frames;
    let between = ALONG.div_ceil(frames.count().max(2) - 1) as f64;
    let steps: Vec<f64> = (1..frames.count()).map(|k| (turn(scene, trace.body, k) / ARC).ceil().max(between)).collect();
    if steps.iter().sum::<f64>() > MOST as f64 || frames.error > FAIR * size(scene) {
        return None;
    }
    let mut places = Vec::new();
    for (pair, steps) in frames.at.windows(2).zip(steps) {
        let within = (0..steps as usize).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / steps);
        places.extend(within);
    }
    places.extend(frames.at.last());
    Some(places)
}

/// By how much a body turns between a frame and the one before, rad; in space half a turn at most. 0 where that is not known.
fn turn(scene: &Scene, body: usize, frame: usize) -> f64 {
    let pose = |index: usize| body.checked_sub(1).and_then(|k| scene.frame(index).get(k * scene.stride()..(k + 1) * scene.stride()));
    let (Some(before), Some(after)) = (pose(frame - 1), pose(frame)) else { return 0.0 };
    turned(before, after)
}

/// By how much a body turns from one pose to another, rad; in space half a turn at most. 0 where that is not known.
pub(in crate::output) fn turned(before: &[f64], after: &[f64]) -> f64 {
    let turn = rotation(before, after);
    let size = dot(turn, turn).sqrt();
    if size.is_finite() { size } else { 0.0 }
}

/// The turn of a body from one pose to another along its axis, rad; in space half a turn at most.
pub(super) fn rotation(before: &[f64], after: &[f64]) -> [f64; 3] {
    match (before, after) {
        (&[_, _, from], &[_, _, to]) => [0.0, 0.0, to - from],
        (&[_, _, _, w, a, b, c], &[_, _, _, v, x, y, z]) => {
            // the vector part and the scalar of the quaternion after times the conjugate of the one before
            let (from, to) = ([a, b, c], [x, y, z]);
            let across = cross(from, to);
            let part: [f64; 3] = std::array::from_fn(|i| w * to[i] - v * from[i] + across[i]);
            let (sine, cosine) = (dot(part, part).sqrt(), w * v + dot(from, to));
            let angle = 2.0 * sine.atan2(cosine.abs()) * cosine.signum();
            if sine > 0.0 { part.map(|x| x * angle / sine) } else { [0.0; 3] }
        }
        _ => [0.0; 3],
    }
}

/// Size of what is seen of joints and paths over the motion, m.
pub(super) fn size(scene: &Scene) -> f64 {
    let of_traces = scene.traces.iter().map(|trace| Place { body: trace.body, at: trace.at.clone() });
    let places: Vec<Place> = scene.joints.iter().flat_map(|joint| [&joint.a, &joint.b]).cloned().chain(of_traces).collect();
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for at in (0..scene.frames.count()).flat_map(|k| places.iter().map(move |place| scene.world(scene.frame(k), place))) {
        (0..3).for_each(|i| (low[i], high[i]) = (low[i].min(at[i]), high[i].max(at[i])));
    }
    let d: [f64; 3] = std::array::from_fn(|i| (high[i] - low[i]).max(0.0));
    dot(d, d).sqrt()
}
