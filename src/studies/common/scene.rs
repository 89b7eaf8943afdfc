//! The outlines of a mechanism at a few places of its motion, for drawings.

use super::motion::Motion;
use crate::geometry::{Pose, Space};
use crate::mechanism::{Measured, Mechanism, StretchOf};
use crate::numerics::continuous::Curve;
use crate::results::{Scene, SceneJoint};

/// Name of the drawing of a motion.
pub(crate) const MECHANISM: &str = "mechanism";

/// Positions that are drawn.
const POSES: usize = 6;
/// Places along each trace.
const TRACE: usize = 240;
/// Traces at most, so that a picture of a large mechanism stays readable.
const TRACES: usize = 8;

/// Outlines over a whole driven motion; positions that cannot be reached are left out.
#[must_use]
pub(crate) fn of_motion<G: Space<S = f64>>(motion: &mut Motion<'_, G>) -> Scene {
    let mechanism = motion.driven.dynamics.mechanism;
    let (ends, length) = (motion.ends, motion.clock.length);
    // the last position of a full turn is the first one again
    let whole_turn = (length - std::f64::consts::TAU).abs() < 1e-9;
    let mut nothing = vec![0.0; motion.columns()];
    scene(mechanism, ends, whole_turn, &mut |s| {
        let piece = motion.breaks.partition_point(|b| *b <= s).clamp(1, motion.breaks.len() - 1) - 1;
        motion.eval(s, piece, &mut nothing).ok()?;
        Some(motion.driven.dynamics.poses())
    })
}

/// Outlines of a mechanism at a few places between two `ends` of its motion, with `poses` of the bodies anywhere between them.
#[must_use]
pub(crate) fn scene<G: Space<S = f64>>(
    mechanism: &Mechanism<G>,
    [low, high]: [f64; 2],
    whole_turn: bool,
    poses: &mut dyn FnMut(f64) -> Option<Vec<Pose<G>>>,
) -> Scene {
    let divisions = if whole_turn { POSES } else { POSES - 1 };
    let drawn: Vec<Vec<Pose<G>>> = (0..POSES).filter_map(|i| poses(low + (high - low) * i as f64 / divisions as f64)).collect();
    let mut scene = of_poses(mechanism, &drawn);
    let traced = traced(mechanism);
    scene.traces = traced.iter().map(|(name, ..)| (name.clone(), vec![])).collect();
    let view = View::new::<G>(mechanism);
    for i in 0..=TRACE {
        let Some(poses) = poses(low + (high - low) * i as f64 / TRACE as f64) else { continue };
        for ((_, body, at), out) in traced.iter().zip(&mut scene.traces) {
            out.1.push(view.flat::<G>(poses[*body].point(*at)));
        }
    }
    scene
}

/// Outlines of a mechanism in given poses of its bodies, without traces; drawings show the first one strongly.
#[must_use]
pub(crate) fn of_poses<G: Space<S = f64>>(mechanism: &Mechanism<G>, poses: &[Vec<Pose<G>>]) -> Scene {
    let mut scene = Scene {
        bodies: mechanism.bodies.iter().skip(1).map(|b| (b.name.clone(), vec![])).collect(),
        joints: mechanism
            .joints
            .iter()
            .map(|j| SceneJoint {
                name: j.name.clone(),
                kind: j.kind.into(),
                grounded: j.a.0 == 0 || j.b.0 == 0,
                at: vec![],
                along: vec![],
            })
            .collect(),
        springs: vec![],
        traces: vec![],
    };
    let outlines: Vec<Vec<G::Vector>> = (1..mechanism.bodies.len()).map(|b| outline(mechanism, b)).collect();
    let pulled: Vec<usize> = mechanism
        .stretches
        .iter()
        .filter_map(|s| match s.of {
            StretchOf::Gauge(g) if matches!(mechanism.gauges[g].measured, Measured::Distance { .. }) => Some(g),
            _ => None,
        })
        .collect();
    scene.springs = pulled.iter().map(|_| (String::new(), vec![])).collect();
    let view = View::new::<G>(mechanism);
    for poses in poses {
        for (b, points) in outlines.iter().enumerate() {
            scene.bodies[b].1.push(points.iter().map(|p| view.flat::<G>(poses[b + 1].point(*p))).collect());
        }
        for (joint, out) in mechanism.joints.iter().zip(&mut scene.joints) {
            let (a, axis) = (poses[joint.a.0], G::vector(&joint.axis));
            let at =
                if joint.kind == "pin-in-slot" || joint.kind == "slider" { poses[joint.b.0].point(joint.b.1) } else { a.point(joint.a.1) };
            out.at.push(view.flat::<G>(at));
            let (p, q) = (view.flat::<G>(at), view.flat::<G>(at + G::rotate(a.r, axis)));
            out.along.push([q[0] - p[0], q[1] - p[1]]);
        }
        for (&g, out) in pulled.iter().zip(&mut scene.springs) {
            let gauge = &mechanism.gauges[g];
            if let Measured::Distance { pa, pb } = gauge.measured {
                out.1.push([view.flat::<G>(poses[gauge.a].point(pa)), view.flat::<G>(poses[gauge.b].point(pb))]);
            }
        }
    }
    scene_links(mechanism, poses, &view, &mut scene);
    scene
}

/// Massless links of the joints of the kind `distance`: each looks like a body between two pins.
fn scene_links<G: Space<S = f64>>(mechanism: &Mechanism<G>, poses: &[Vec<Pose<G>>], view: &View, scene: &mut Scene) {
    for joint in mechanism.joints.iter().filter(|j| j.kind == "distance") {
        let places = |(body, at): (usize, G::Vector)| poses.iter().map(|x| view.flat::<G>(x[body].point(at))).collect::<Vec<_>>();
        let (from, to) = (places(joint.a), places(joint.b));
        scene.bodies.push((joint.name.clone(), from.iter().zip(&to).map(|(a, b)| vec![*a, *b]).collect()));
        for (at, (body, _)) in [(from, joint.a), (to, joint.b)] {
            let along = vec![[1.0, 0.0]; at.len()];
            scene.joints.push(SceneJoint { name: String::new(), kind: "revolute".into(), grounded: body == 0, at, along });
        }
    }
}

/// Points that outline a body: joint points, ends of its bar, the user's points and those of `drawn`.
fn outline<G: Space<S = f64>>(mechanism: &Mechanism<G>, body: usize) -> Vec<G::Vector> {
    let mut points: Vec<G::Vector> = Vec::new();
    let mut add = |p: G::Vector| {
        if points.iter().all(|x| G::dot(*x - p, *x - p) > 1e-18) {
            points.push(p);
        }
    };
    for joint in &mechanism.joints {
        for (b, p) in [joint.a, joint.b] {
            if b == body {
                add(p);
            }
        }
    }
    for (name, p) in &mechanism.bodies[body].points {
        if name != "origin" && name != "com" {
            add(*p);
        }
    }
    mechanism.bodies[body].drawn.iter().for_each(|p| add(*p));
    points
}

/// Points whose traces are drawn: the user's points first, then joints between moving bodies.
fn traced<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Vec<(String, usize, G::Vector)> {
    let mut out: Vec<(String, usize, G::Vector)> = Vec::new();
    for (b, body) in mechanism.bodies.iter().enumerate().skip(1) {
        for (name, p) in &body.points {
            let at_joint = mechanism.joints.iter().any(|j| [j.a, j.b].iter().any(|(k, x)| *k == b && G::dot(*x - *p, *x - *p) < 1e-18));
            if !["origin", "com", "start", "end"].contains(&name.as_str()) && !at_joint {
                out.push((format!("{}.{name}", body.name), b, *p));
            }
        }
    }
    for joint in &mechanism.joints {
        if joint.a.0 != 0 && joint.b.0 != 0 {
            out.push((joint.name.clone(), joint.b.0, joint.b.1));
        }
    }
    out.truncate(TRACES);
    out
}

/// The plane of the drawing: x-y, or for space an isometric view with what gravity points away from upwards.
struct View {
    u: [f64; 3],
    v: [f64; 3],
}

impl View {
    fn new<G: Space<S = f64>>(mechanism: &Mechanism<G>) -> Self {
        if G::VECTOR == 2 {
            return Self { u: [1.0, 0.0, 0.0], v: [0.0, 1.0, 0.0] };
        }
        let g: Vec<f64> = (0..3).map(|i| G::component(mechanism.gravity, i).abs()).collect();
        let up = if g[1] > g[2] { 1 } else { 2 };
        let (x, y) = if up == 1 { (2, 0) } else { (0, 1) };
        let (c, s) = (0.75_f64.sqrt(), 0.5);
        let (mut u, mut v) = ([0.0; 3], [0.0; 3]);
        (u[x], u[y]) = (-c, c);
        (v[x], v[y], v[up]) = (-s, -s, 1.0);
        Self { u, v }
    }

    fn flat<G: Space<S = f64>>(&self, p: G::Vector) -> [f64; 2] {
        let along = |d: &[f64; 3]| (0..G::VECTOR).map(|i| d[i] * G::component(p, i)).sum();
        [along(&self.u), along(&self.v)]
    }
}
