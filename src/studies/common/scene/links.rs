//! Springs, dampers, massless rods, clutches and brakes.

use super::anchors::{distance, to_ground};
use super::places::{place, same};
use crate::expression::Id;
use crate::geometry::Space;
use crate::mechanism::{Joint, Measured, Mechanism, StretchOf};
use crate::model::{self, CouplingKind, PointRef, Quantity, SpringLaw, SpringOn};
use crate::results::Scene;
use crate::results::scene::{Link, LinkKind, Place};
use crate::studies::common::case::Case;

/// Hinges that are nearer are one, as part of the size of the mechanism.
const NEAR: f64 = 1e-9;

/// Longest tube of an actuator, as part of its shortest length, and most tubes.
const TUBE: f64 = 0.85;
const STAGES: f64 = 6.0;

/// Shortest spring along a slide, as part of the size of the mechanism.
const SHORTEST: f64 = 0.1;

/// The massless elements of a mechanism. The frames of the scene are there.
///
/// A spring over an expression has a place where that is of the coordinates of one point or two, of one joint, or of the angles of one
/// body or two about one hinge, or of two hinges.
pub(super) fn links<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, scene: &Scene, held: &[Held]) -> Vec<Link> {
    let springs = mechanism.stretches.iter().zip(&case.model.springs).filter_map(|(stretch, spring)| {
        let rest = (stretch.moving.is_none() && spring.rest.is_some()).then_some(stretch.rest);
        let mut along = Vec::new();
        let (turning, [a, b], rest) = match (&spring.on, stretch.of) {
            (&SpringOn::Joint(joint), _) => {
                let joint = &mechanism.joints[joint];
                // what only damps a hinge is the dashpot of the hinge
                if joint.kind != "slider" && matches!(spring.law, SpringLaw::None) {
                    return None;
                }
                let (turning, ends) = at_joint(mechanism, scene, joint, joint.kind != "slider");
                (turning, ends, rest.map(|rest| rest - joint.zero))
            }
            (SpringOn::Between(..), StretchOf::Gauge(gauge)) => {
                let gauge = &mechanism.gauges[gauge];
                let Measured::Distance { pa, pb } = gauge.measured else { return None };
                (None, [place::<G>((gauge.a, pa)), place::<G>((gauge.b, pb))], rest)
            }
            (&SpringOn::Stretch(id), _) => {
                let (turning, ends, direction) = stretched(case, mechanism, scene, id)?;
                along = direction;
                (turning, ends, None)
            }
            _ => return None,
        };
        Some(Link { name: spring.name.clone(), kind: turning.unwrap_or(kind(spring)), a, b, rest, stages: 0, along })
    });
    let rods = mechanism.joints.iter().filter(|joint| joint.kind == "distance").map(|joint| Link {
        name: joint.name.clone(),
        kind: LinkKind::Rod,
        a: place::<G>(joint.a),
        b: place::<G>(joint.b),
        rest: None,
        stages: 0,
        along: Vec::new(),
    });
    let clutches = case.model.clutches.iter().map(|clutch| {
        let [first, second] = clutch.joints.map(|joint| &mechanism.joints[joint]);
        let (kind, [a, b]) = if clutch.joints[0] == clutch.joints[1] {
            (LinkKind::Brake, at_joint(mechanism, scene, first, first.kind != "slider").1)
        } else {
            (LinkKind::Clutch, [first, second].map(moved))
        };
        Link { name: clutch.name.clone(), kind, a, b, rest: None, stages: 0, along: Vec::new() }
    });
    springs.chain(rods).chain(clutches).chain(held.iter().map(|held| held.link.clone())).collect()
}

/// A coupling that holds two points at a distance, or prescribes it over time.
pub(super) struct Held {
    /// Its index in the model.
    pub(super) coupling: usize,
    pub(super) link: Link,
    /// 1 where its force pushes the ends apart while it is positive, else −1.
    pub(super) sense: f64,
}

/// The couplings that hold two points at a distance, or prescribe it over time. The frames of the scene are there.
pub(super) fn held<G: Space<S = f64>>(case: Case<'_>, mechanism: &Mechanism<G>, scene: &Scene) -> Vec<Held> {
    if scene.frames.count() == 0 {
        return Vec::new();
    }
    let of = |(index, coupling): (usize, &model::Coupling)| {
        let CouplingKind::Zero(id) = coupling.kind else { return None };
        let (mut points, mut moves): (Vec<PointRef>, bool) = (Vec::new(), false);
        for input in case.model.pool.inputs_of(&[id]) {
            match case.model.inputs[input as usize] {
                Quantity::Point { at, order: 0, .. } if !points.contains(&at) => points.push(at),
                Quantity::Point { order: 0, .. } => {}
                Quantity::Time => moves = true,
                _ => return None,
            }
        }
        // what moves last
        points.sort_by_key(|point| point.body != 0);
        let ([a, b], sense) = distance(case, mechanism, scene, id, &points)?;
        let length = |index: usize| {
            let [a, b] = [&a, &b].map(|end| scene.world(scene.frame(index), end));
            (0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt()
        };
        let lengths = (0..scene.frames.count()).map(length).filter(|x| x.is_finite());
        let [shortest, longest] = lengths.fold([f64::INFINITY, 0.0], |[low, high], x| [f64::min(low, x), f64::max(high, x)]);
        let name = coupling.name.clone();
        let stages = (longest / (TUBE * shortest)).ceil().clamp(2.0, STAGES) as usize;
        let (kind, rest, stages) = if moves { (LinkKind::Actuator, Some(shortest), stages) } else { (LinkKind::Rod, None, 0) };
        Some(Held { coupling: index, link: Link { name, kind, a, b, rest, stages, along: Vec::new() }, sense })
    };
    case.model.couplings.iter().enumerate().filter_map(of).collect()
}

/// What a spring about hinges is, none for one along its ends, and the places of its ends.
type Ends = (Option<LinkKind>, [Place; 2]);

/// Where a joint is on the body that it moves.
fn moved<G: Space<S = f64>>(joint: &Joint<G>) -> Place {
    place::<G>(if joint.b.0 == 0 { joint.a } else { joint.b })
}

/// A spring over the coordinate of a joint: about its point, or from the first body to what slides.
fn at_joint<G: Space<S = f64>>(mechanism: &Mechanism<G>, scene: &Scene, joint: &Joint<G>, turns: bool) -> Ends {
    let [a, b] = [place::<G>(joint.a), place::<G>(joint.b)];
    if turns {
        return (Some(LinkKind::Torsion), [a, b]);
    }
    let along = G::vector(&joint.axis);
    let way = |poses: &[f64]| {
        let (from, to) = (scene.world(poses, &a), scene.world(poses, &b));
        let axis = scene.direction(poses, a.body, &joint.axis);
        (0..3).map(|i| axis[i] * (to[i] - from[i])).sum::<f64>()
    };
    let ways: Vec<f64> = (0..scene.frames.count()).map(|i| way(scene.frame(i))).filter(|way| way.is_finite()).collect();
    let ends = ways.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], way| [low.min(*way), high.max(*way)]);
    let shortest = SHORTEST * mechanism.size();
    if ways.is_empty() || ends[0] > shortest || ends[1] < -shortest {
        return (None, [a, b]);
    }
    // what slides over the point of the first body is held from beyond its way
    let beyond = joint.a.1 + along * (ends[0] - 2.0 * shortest);
    (None, [place::<G>((joint.a.0, beyond)), b])
}

/// The spring of an expression of positions, if it has a place, and the direction along which alone it acts, if there is one.
fn stretched<G: Space<S = f64>>(
    case: Case<'_>,
    mechanism: &Mechanism<G>,
    scene: &Scene,
    id: Id,
) -> Option<(Option<LinkKind>, [Place; 2], Vec<f64>)> {
    let (model, mut points) = (case.model, Vec::<PointRef>::new());
    let (mut turned, mut joints): (Vec<usize>, Vec<(usize, usize)>) = (Vec::new(), Vec::new());
    for input in model.pool.inputs_of(&[id]) {
        match model.inputs[input as usize] {
            Quantity::Point { at, order: 0, .. } => {
                if !points.contains(&at) {
                    points.push(at);
                }
            }
            Quantity::Angle { body, order: 0 } => turned.push(body),
            Quantity::Joint { joint, slot, order: 0 } => joints.push((joint, slot)),
            Quantity::Time => {}
            _ => return None,
        }
    }
    let on = |p: PointRef| (p.body, mechanism.bodies[p.body].points[p.point].1);
    let (kind, ends): Ends = match (&points[..], &turned[..], &joints[..]) {
        (&[a, b], [], []) => (None, [a, b].map(|p| place::<G>(on(p)))),
        (&[a], [], []) => {
            let (ends, along) = to_ground(case, mechanism, scene, id, a)?;
            return Some((None, ends, along));
        }
        ([], &[a, b], []) => (Some(LinkKind::Torsion), hinge(mechanism, a, b)?),
        ([], &[a], []) => (Some(LinkKind::Torsion), hinge(mechanism, 0, a)?),
        ([], [], &[(joint, slot)]) => {
            let joint = &mechanism.joints[joint];
            let turns = match (joint.kind, slot) {
                ("revolute", _) | ("cylindrical", 0) => true,
                ("slider", _) | ("cylindrical", _) => false,
                _ => return None,
            };
            at_joint(mechanism, scene, joint, turns)
        }
        ([], [], &[(first, 0), (second, 0)]) => {
            let joints = [first, second].map(|joint| &mechanism.joints[joint]);
            if scene.frames.count() == 0 || joints.iter().any(|joint| !matches!(joint.kind, "revolute" | "cylindrical")) {
                return None;
            }
            let ends = joints.map(moved);
            let [a, b] = [&ends[0], &ends[1]].map(|end| scene.world(scene.frame(0), end));
            let apart = (0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt() > NEAR * mechanism.size();
            (Some(if apart { LinkKind::Shaft } else { LinkKind::Torsion }), ends)
        }
        _ => return None,
    };
    Some((kind, ends, Vec::new()))
}

/// Where two bodies turn about one point: a hinge between them, or one of each on a third body.
fn hinge<G: Space<S = f64>>(mechanism: &Mechanism<G>, a: usize, b: usize) -> Option<[Place; 2]> {
    let hinges = || mechanism.joints.iter().filter(|joint| joint.kind == "revolute");
    // the side of a body at a hinge, and the other side
    let sides = |body: usize| hinges().flat_map(|joint| [(joint.a, joint.b), (joint.b, joint.a)]).filter(move |(own, _)| own.0 == body);
    if let Some((own, other)) = sides(a).find(|(_, other)| other.0 == b) {
        return Some([place::<G>(own), place::<G>(other)]);
    }
    for (own, other) in sides(a).filter(|_| a != 0) {
        if let Some((second, _)) = sides(b).find(|(_, of)| of.0 == other.0 && same::<G>(of.1, other.1)) {
            return Some([place::<G>(own), place::<G>(second)]);
        }
    }
    None
}

/// What a spring is by its law.
fn kind(spring: &model::Spring) -> LinkKind {
    match (&spring.law, spring.damping) {
        (SpringLaw::None, _) => LinkKind::Damper,
        (_, None) => LinkKind::Spring,
        (_, Some(_)) => LinkKind::SpringDamper,
    }
}
