//! Springs, dampers and massless rods.

use super::places::place;
use crate::geometry::Space;
use crate::mechanism::{Measured, Mechanism, StretchOf};
use crate::model::{self, Model, SpringLaw, SpringOn};
use crate::results::scene::{Link, LinkKind};

/// The massless elements of a mechanism; a spring over an expression has no place.
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

/// What a spring is by its law.
fn kind(spring: &model::Spring) -> LinkKind {
    match (&spring.law, spring.damping) {
        (SpringLaw::None, _) => LinkKind::Damper,
        (_, None) => LinkKind::Spring,
        (_, Some(_)) => LinkKind::SpringDamper,
    }
}
