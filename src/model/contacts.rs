//! What happens in a joint where its bodies touch: dry friction, rigid stops.

use super::vocabulary::Quantity;
use crate::expression::Id;

/// Dry friction of a joint, against the motion of its one coordinate x.
///
/// With g = coulomb + (static − coulomb) exp(−(x'/stribeck_speed)²), or coulomb alone: exact friction resists by g · sign(x') while
/// the joint slides, and by what holds it, g at most, while it sticks; with a `stick_speed` it resists by
/// g · clamp(x'/stick_speed, −1, 1), bristles by their deflection (Canudas de Wit, Olsson, Åström & Lischinsky, IEEE Trans. Autom.
/// Control 40 (1995) 419-425, equations 1 to 4).
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// On the second body along the coordinate, N or N m; by a coefficient that per newton of the normal force: 1 or m.
    pub effort: Id,
    /// What makes the normal force, if the friction is by a coefficient.
    pub pressed: Option<Pressure>,
    /// How it sticks, if it is exact.
    pub sticking: Option<Sticking>,
    /// The deflection of bristles, if the friction has them.
    pub bristle: Option<Bristle>,
}

impl Friction {
    /// The quantity of a joint that a name means, `friction` or `bristle`, and the unit that it counts in.
    pub(crate) fn quantity(&self, joint: usize, name: &str) -> Option<(Quantity, Option<Id>)> {
        match (name, self.bristle) {
            ("friction", _) => Some((Quantity::Friction { joint }, None)),
            ("bristle", Some(bristle)) => Some((Quantity::Bristle { joint }, Some(bristle.deflection))),
            _ => None,
        }
    }
}

/// Exact friction: it slides against the sign of a rate, or holds that rate at 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sticking {
    /// The switch that is the sense in which the bodies slide on each other; 0 while they stick.
    pub sense: u32,
    /// g, in the unit of [`Friction::effort`]: at most so much holds.
    pub holds: Id,
}

/// A clutch or brake: what may hold one joint, or two joints to each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Clutch {
    /// Its name.
    pub name: String,
    /// It acts on the coordinate of the second joint less that of the first; twice the same is that joint alone.
    pub joints: [usize; 2],
    /// The coordinate.
    pub slipped: Id,
    /// How it holds.
    pub law: ClutchLaw,
    /// Path in the model file.
    pub place: String,
}

/// How a clutch holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClutchLaw {
    /// Friction, with its force or torque on what belongs to the second joint while it slips; exact unless it has a `stick_speed`.
    Friction {
        /// While it slips, N or N m.
        effort: Id,
        /// How it sticks.
        sticking: Option<Sticking>,
    },
    /// Its rate does not become negative.
    OneWay,
}

/// What bears the normal force of a joint with friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pressure {
    /// A pin: all of the reaction force.
    Pin,
    /// A guide: the force across the axis, at one place or, with a length (m), at the two ends of the guide.
    Guide {
        /// `length`.
        length: Option<Id>,
    },
}

/// Bristles between the bodies of a joint, as a first-order state in parts of what the Coulomb friction bends them, coulomb/stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bristle {
    /// Rate of the state, 1/s.
    pub rate: Id,
    /// coulomb/stiffness, rad or m.
    pub deflection: Id,
}

/// End stops that give way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limit {
    /// Force or torque on the second body along the coordinate, by coordinate and rate; N or N m.
    ///
    /// Below `from`: max(0, stiffness · (from − x) − damping · x'); above `to`: min(0, stiffness · (to − x) − damping · x').
    /// A stop pushes and never pulls.
    pub force: Id,
    /// `from`, rad or m.
    pub from: Option<Id>,
    /// `to`, rad or m.
    pub to: Option<Id>,
    /// `stiffness`, N m/rad or N/m.
    pub stiffness: Id,
}

/// Rigid stops of a joint: its coordinate is thrown back from them, and comes to rest on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stops {
    /// `from`, rad or m.
    pub from: Option<Id>,
    /// `to`, rad or m.
    pub to: Option<Id>,
    /// `restitution`: rate behind the blow by rate before it, from 0 to 1.
    pub restitution: Id,
    /// `rest_speed`, rad/s or m/s: a rebound with a lower speed counts as rest.
    pub rest_speed: Id,
}
