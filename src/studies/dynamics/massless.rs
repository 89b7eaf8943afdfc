//! Motions without mass or inertia, whose accelerations are not determined.

use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::kinematics::assemble::{Assembled, units};
use crate::kinematics::thin::spinning;
use crate::mechanism::Mechanism;
use crate::results::Failure;

/// That bodies without mass or inertia leave the accelerations open.
pub(crate) fn massless<G: Space<S = f64>>(mechanism: &Mechanism<G>, start: &Assembled) -> Option<Failure> {
    if let Some(failure) = spins(mechanism, start) {
        return Some(failure);
    }
    if let Some((body, how)) = unresisted(mechanism, start) {
        let has_mass = mechanism.bodies.iter().any(|b| b.name == body && crate::scalar::Scalar::value(b.mass.mass) > 0.0);
        return Some(Failure::Study {
            code: "singular-mass",
            message: format!(
                "the accelerations at the start are not determined: body `{body}` can {how} and has no {}",
                if how == "turn" { "inertia" } else { "mass" }
            ),
            place: format!("bodies.{body}"),
            help: if how == "turn" && has_mass {
                "give it an inertia, as `{ mass: 1 kg, inertia: 0.01 kg m^2 }` or `ball: { radius: 1 cm, mass: 1 kg }`; a point mass, which \
                 needs none, is a body with `mass` alone on which nothing but forces, springs, `distance` joints and (in space `spherical`, \
                 in the plane `revolute`) joints at its origin act"
                    .into()
            } else {
                "give it a mass and an inertia, as `{ mass: 1 kg, inertia: 0.01 kg m^2 }` or `bar: { length: 1 m, mass: 1 kg }`".into()
            },
        });
    }
    let bare = |body: usize| crate::scalar::Scalar::value(mechanism.bodies[body].mass.mass) <= 0.0;
    let names: Vec<String> =
        mechanism.nodes.iter().filter(|n| bare(n.body)).map(|n| format!("`{}`", mechanism.bodies[n.body].name)).collect();
    let (verb, selves) = if names.len() == 1 { ("has", "itself") } else { ("have", "themselves") };
    (!names.is_empty()).then(|| Failure::Study {
        code: "singular-mass",
        message: format!("the accelerations at the start are not determined: {} {verb} no mass and can move by {selves}", names.join(", ")),
        place: "bodies".into(),
        help: "give every moving body a mass, as `bar: { length: 1 m, mass: 1 kg }`".into(),
    })
}

/// That a thin body can turn about its own axis, about which nothing has inertia.
pub(super) fn spins<G: Space<S = f64>>(mechanism: &Mechanism<G>, start: &Assembled) -> Option<Failure> {
    let body = &mechanism.bodies[spinning(mechanism, start)?].name;
    Some(Failure::Study {
        code: "singular-mass",
        message: format!(
            "the accelerations at the start are not determined: body `{body}` can turn about its own axis and has no inertia about it"
        ),
        place: format!("bodies.{body}"),
        help: "give it a thickness, as `bar: { length: 1 m, mass: 1 kg, width: 2 cm, height: 2 cm }`, or an inertia about three axes; or \
               hold the turn by a joint, as `universal` in the place of `spherical`"
            .into(),
    })
}

/// A body that can move along a coordinate without resistance of any mass, and how it moves.
fn unresisted<G: Space<S = f64>>(mechanism: &Mechanism<G>, start: &Assembled) -> Option<(String, &'static str)> {
    let mut dynamics = Dynamics::new(mechanism);
    dynamics.terms(0.0, &start.q, &start.v, &start.modes);
    let nv = mechanism.nv;
    let mass = |k: usize| dynamics.work.mass.at(k, k);
    let largest = (0..nv).fold(0.0, |m, k| f64::max(m, mass(k)));
    let k = (0..nv).find(|&k| mass(k) <= 1e-14 * largest)?;
    let node = mechanism.nodes.iter().find(|n| n.columns.contains(&k))?;
    let slides = units(mechanism)[k] != 0;
    Some((mechanism.bodies[node.body].name.clone(), if slides { "slide" } else { "turn" }))
}
