//! What a start has come to, read from the assembled pose.

use super::explain::{short, unit};
use super::rotation;
use super::{AssemblyFault, Begun, Found};
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Asked, Mechanism, Orientation};
use nalgebra::{Unit, UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// Most by which an exact value may be missed, in parts of it and of 1.
const EXACT: f64 = 1e-7;

/// Asked and found values.
///
/// # Errors
/// If an exact value is not met.
pub(super) fn found<G: Space<S = f64>>(m: &Mechanism<G>, begun: &Begun) -> Result<Vec<Found>, AssemblyFault> {
    let Begun { q, v, modes, .. } = begun;
    let mut dynamics = Dynamics::new(m);
    dynamics.time(0.0, modes);
    dynamics.position(q, modes);
    dynamics.velocity(v, modes);
    dynamics.watch(q, v, modes);
    let w = &dynamics.work;
    let mut out = Vec::new();
    for start in &m.starts {
        let (found, tilt) = match start.asked {
            Asked::Gauge { gauge, order: 0 } => (w.readings[gauge].x, None),
            Asked::Gauge { gauge, .. } => (w.readings[gauge].rate, None),
            Asked::Spin { body, axis, own } => (G::spin_component(dynamics.in_axes(body, own, w.twists[body].w), axis), None),
            Asked::Orientation(k) => {
                let (angle, tilt) = orientation::<G>(&m.orientations[k], start.value, w.places[m.orientations[k].body].r);
                (angle, Some(tilt))
            }
        };
        let unit = unit(m, start.asked);
        let off = f64::max((found - start.value).abs(), tilt.unwrap_or(0.0));
        if !start.guess && off > EXACT * (1.0 + start.value.abs() + if unit.starts_with('m') { m.size() } else { 0.0 }) {
            return Err(AssemblyFault {
                code: "start-cannot-hold",
                message: format!("the exact start value {} = {} {unit} is missed by {} {unit}", start.name, short(start.value), short(off)),
                place: start.place.clone(),
                help: "put `~` before it, or remove it".into(),
            });
        }
        let mut add = |name: String, asked, found| out.push(Found { name, asked, found, guess: start.guess, unit });
        add(start.name.clone(), start.value, found);
        if let Some(tilt) = tilt {
            add(format!("{}, axis off by", start.name), 0.0, tilt);
        }
    }
    Ok(out)
}

/// A rotation seen from one that is asked for: its angle about the asked axis, as near to `angle` as whole turns allow, and by how much
/// it turns beside that axis, rad. The rotation is the asked one if they are `angle` and 0.
pub(super) fn orientation<G: Space<S = f64>>(asked: &Orientation, angle: f64, found: G::Rotation) -> (f64, f64) {
    let unit = rotation::quaternion(&rotation::matrix::<G>(found));
    let axis = Unit::new_unchecked(Vector3::from(asked.axis));
    let about = 2.0 * unit.imag().dot(&axis).atan2(unit.w);
    let beside = (UnitQuaternion::from_axis_angle(&axis, about).inverse() * unit).angle();
    (about + TAU * ((angle - about) / TAU).round(), beside)
}
