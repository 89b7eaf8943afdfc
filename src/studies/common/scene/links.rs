//! Springs, dampers and massless rods.

use super::places::{place, same};
use crate::expression::Id;
use crate::geometry::Space;
use crate::mechanism::{Measured, Mechanism, StretchOf};
use crate::model::{self, Model, PointRef, Quantity, SpringLaw, SpringOn};
use crate::results::scene::{Link, LinkKind};

/// The massless elements of a mechanism; a spring over an expression has a place where that is of two points, or of the angles of two
/// bodies about one hinge.
pub(super) fn links<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>) -> Vec<Link> {
    let springs = mechanism.stretches.iter().zip(&model.springs).filter_map(|(stretch, spring)| {
        let rest = (stretch.moving.is_none() && spring.rest.is_some()).then_some(stretch.rest);
        let (kind, [a, b], rest) = match (&spring.on, stretch.of) {
            (&SpringOn::Joint(joint), _) => {
                let joint = &mechanism.joints[joint];
                let kind = if joint.kind == "slider" { kind(spring) } else { LinkKind::Torsion };
                (kind, [joint.a, joint.b], rest.map(|rest| rest - joint.zero))
            }
            (SpringOn::Between(..), StretchOf::Gauge(gauge)) => {
                let gauge = &mechanism.gauges[gauge];
                let Measured::Distance { pa, pb } = gauge.measured else { return None };
                (kind(spring), [(gauge.a, pa), (gauge.b, pb)], rest)
            }
            (&SpringOn::Stretch(id), _) => {
                let (kind_of, ends) = stretched(model, mechanism, id)?;
                (if kind_of == LinkKind::Torsion { LinkKind::Torsion } else { kind(spring) }, ends, None)
            }
            _ => return None,
        };
        Some(Link { name: spring.name.clone(), kind, a: place::<G>(a), b: place::<G>(b), rest })
    });
    let rods = mechanism.joints.iter().filter(|joint| joint.kind == "distance").map(|joint| Link {
        name: joint.name.clone(),
        kind: LinkKind::Rod,
        a: place::<G>(joint.a),
        b: place::<G>(joint.b),
        rest: None,
    });
    springs.chain(rods).collect()
}

/// Two bodies with a place on each.
type Ends<G> = [(usize, <G as Space>::Vector); 2];

/// The two places between which an expression measures, if its coordinates are those of two points, or of a point and the ground; or
/// the hinge about which it measures the angle between two bodies.
fn stretched<G: Space<S = f64>>(model: &Model, mechanism: &Mechanism<G>, id: Id) -> Option<(LinkKind, Ends<G>)> {
    let mut points: Vec<PointRef> = Vec::new();
    let mut turned: Vec<usize> = Vec::new();
    for input in model.pool.inputs_of(&[id]) {
        match model.inputs[input as usize] {
            Quantity::Point { at, order: 0, .. } if !points.contains(&at) => points.push(at),
            Quantity::Point { order: 0, .. } => {}
            Quantity::Angle { body, order: 0 } => turned.push(body),
            _ => return None,
        }
    }
    match (&points[..], &turned[..]) {
        (&[a, b], []) => Some((LinkKind::Spring, [a, b].map(|p| (p.body, mechanism.bodies[p.body].points[p.point].1)))),
        ([], &[a, b]) => hinge(mechanism, a, b).map(|ends| (LinkKind::Torsion, ends)),
        _ => None,
    }
}

/// Where two bodies turn about one point: a hinge between them, or one of each on a third body.
fn hinge<G: Space<S = f64>>(mechanism: &Mechanism<G>, a: usize, b: usize) -> Option<Ends<G>> {
    let hinges = || mechanism.joints.iter().filter(|joint| joint.kind == "revolute");
    // the side of a body at a hinge, and the other side
    let sides = |body: usize| hinges().flat_map(|joint| [(joint.a, joint.b), (joint.b, joint.a)]).filter(move |(own, _)| own.0 == body);
    for (own, other) in sides(a) {
        if other.0 == b {
            return Some([own, other]);
        }
        if let Some((second, _)) = sides(b).find(|(_, of)| of.0 == other.0 && same::<G>(of.1, other.1)) {
            return Some([own, second]);
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
