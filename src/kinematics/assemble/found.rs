//! What a start has come to, read from the assembled pose.

use super::begun::Begun;
use super::explain::{ROUND_OFF, short, unit};
use super::fault::AssemblyFault;
use super::rotation::orientation;
use crate::dynamics::Dynamics;
use crate::geometry::Space;
use crate::mechanism::{Asked, Mechanism};
use std::f64::consts::PI;

/// Most by which an exact value may be missed, in parts of it and of 1.
const EXACT: f64 = 1e-7;

/// An asked start value and what was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// As written.
    pub name: String,
    /// Asked value.
    pub asked: f64,
    /// Found value.
    pub found: f64,
    /// True if it was a guess.
    pub guess: bool,
    /// Unit of both values.
    pub unit: &'static str,
}

impl Found {
    /// Whether a position is so far from its guess that another assembly may be meant: a sixth of a turn, or half of the size, m.
    pub(super) fn is_far(&self, size: f64) -> bool {
        let off = self.found - self.asked;
        match self.unit {
            "rad" => off.sin().atan2(off.cos()).abs() > PI / 3.0,
            "m" => off.abs() > 0.5 * size,
            _ => false,
        }
    }

    /// That it is far from its guess.
    pub(super) fn missed(&self) -> String {
        let (factor, unit) = if self.unit == "rad" { (180.0 / PI, "deg") } else { (1.0, self.unit) };
        let [asked, found] = [self.asked, self.found].map(|x| short(factor * x));
        format!(
            "`{}` was guessed at {asked} {unit} and is {found} {unit} in the assembly that is nearest: another one may be meant",
            self.name
        )
    }
}

/// Asked and found values.
///
/// # Errors
/// If an exact value is not met.
pub(super) fn found<G: Space<S = f64>>(m: &Mechanism<G>, begun: &Begun) -> Result<Vec<Found>, AssemblyFault> {
    let Begun { q, v, modes, .. } = begun;
    let mut dynamics = Dynamics::without_mass(m);
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
        if !start.guess && off > EXACT * (1.0 + start.value.abs() + if unit.starts_with('m') { m.start_size() } else { 0.0 }) {
            return Err(AssemblyFault {
                code: "start-cannot-hold",
                message: format!("the exact start value {} = {} {unit} is missed by {} {unit}", start.name, short(start.value), short(off)),
                place: start.place.clone(),
                help: "put `~` before it, or remove it".into(),
            });
        }
        // round-off of what is zero
        let least = ROUND_OFF * if unit.starts_with('m') { m.start_size() } else { 1.0 };
        let clean = |asked: f64, found: f64| if found.abs() < least && found != asked { 0.0 } else { found };
        let mut add = |name: String, asked, found| out.push(Found { name, asked, found: clean(asked, found), guess: start.guess, unit });
        add(start.name.clone(), start.value, found);
        if let Some(tilt) = tilt {
            add(format!("{}, axis off by", start.name), 0.0, tilt);
        }
    }
    Ok(out)
}
