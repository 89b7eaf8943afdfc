//! What a model file says, decoded: names resolved to indices, every value an expression of the model's [`Pool`].
//!
//! Nothing here is evaluated: a value is a node [`Id`] whose leaves are parameters and [`Quantity`] inputs. The tables of
//! the mechanism are built from these entities by `mechanism::build`. All numbers are SI, angles in rad.

use super::contacts::{Friction, Limit, Stops};
use super::place::{Place, PointRef};
use super::vocabulary::Quantity;
use crate::expression::{Dimension, Id};
use crate::model::keys::words;

/// Whether bodies move in the x-y plane or in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimensions {
    /// x, y and one angle.
    Planar,
    /// x, y, z and rotations.
    Spatial,
}

/// A unit in which results of its dimension are shown.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayUnit {
    /// Its name: `mm`.
    pub name: String,
    /// Its size in SI.
    pub size: f64,
    /// Its dimension.
    pub dimension: Dimension,
}

/// A named number that can be set from outside.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its dimension, found from its expression.
    pub dimension: Dimension,
    /// Its value, an expression of other parameters; acyclic. Overrides (`set`, `--set`) have replaced it already.
    pub value: Id,
    /// The unit in which it is written, and the size of that in SI; none of an expression.
    pub unit: Option<(String, f64)>,
    /// Where it stands.
    pub place: Place,
}

/// A function given by points.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its name.
    pub name: String,
    /// Points as pairs of expressions of parameters.
    pub points: Vec<(Id, Id)>,
    /// Dimension of the argument.
    pub x: Dimension,
    /// Dimension of the value.
    pub y: Dimension,
    /// `between`.
    pub between: Between,
    /// `beyond`.
    pub beyond: Beyond,
    /// Where it stands.
    pub place: Place,
}
pub use crate::expression::{Between, Beyond};

/// A connection of two points.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// Its kind with what belongs to that kind alone.
    pub kind: JointKind,
    /// First-named point; its body carries the axis.
    pub a: PointRef,
    /// Second-named point.
    pub b: PointRef,
    /// `axis` in the first body's frame: 2 or 3 components, not yet of unit length. Spatial default z; planar default x.
    pub axis: Option<Vec<Id>>,
    /// `to`: the same axis in the second body's frame; default the numbers of `axis`.
    pub to: Option<Vec<Id>>,
    /// `rpy`: orientation of the second body in the first at 0, instead of `to`: roll, pitch, yaw, rad.
    pub rpy: Option<[Id; 3]>,
    /// `zero`: the angle or position that counts as the drawn one: coordinate = drawn coordinate + zero.
    pub zero: Option<Id>,
    /// `damping`, N m s/rad or N s/m.
    pub damping: Option<Id>,
    /// `limits` with a `stiffness`.
    pub limit: Option<Limit>,
    /// `friction`.
    pub friction: Option<Friction>,
    /// `limits` with a `restitution`.
    pub stops: Option<Stops>,
    /// `cut: true`: keep this joint off the spanning tree.
    pub cut: bool,
    /// Where it stands.
    pub place: Place,
}

impl Joint {
    /// Whether its way has ends.
    pub(crate) fn has_stops(&self) -> bool {
        self.limit.is_some() || self.stops.is_some()
    }
}

/// Kind of a joint.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum JointKind {
    /// Hinge.
    Revolute,
    /// Sliding along `axis` (alias `prismatic`).
    Slider,
    /// Planar: the second's point slides along `axis` in the first's slot.
    PinInSlot,
    /// All held.
    Fixed,
    /// Distance held; `length` m, or as drawn.
    Distance { length: Option<Id> },
    /// Spatial: hinge and slide about the same axis.
    Cylindrical,
    /// Spatial: the plane normal to `axis`.
    Planar,
    /// Spatial: hinge and slide coupled; m per turn.
    Screw { pitch: Id },
    /// Spatial: two crossed hinges, `axes: [first body's, second body's]`.
    Universal { axes: [Vec<Id>; 2] },
    /// Spatial: ball.
    Spherical,
    /// No constraint; carries the coordinates of a free body.
    Free,
    /// No constraint; carries the place of a point mass, which has no rotation.
    Particle,
}

impl JointKind {
    /// Whether a moment goes through it, of a mechanism in the plane or in space.
    #[must_use]
    pub fn transmits_moment(&self, planar: bool) -> bool {
        match self {
            Self::Slider | Self::Fixed => true,
            Self::PinInSlot | Self::Distance { .. } | Self::Spherical | Self::Free | Self::Particle => false,
            Self::Revolute | Self::Cylindrical | Self::Planar | Self::Screw { .. } | Self::Universal { .. } => !planar,
        }
    }
}

/// A relation between coordinates.
#[derive(Clone, Debug)]
pub struct Coupling {
    /// Its name.
    pub name: String,
    /// The relation.
    pub kind: CouplingKind,
    /// Dimension of the second coordinate, or of the expression.
    pub along: Dimension,
    /// Where it stands.
    pub place: Place,
}

impl Coupling {
    /// What its effort is called: `torque` or `force`.
    #[must_use]
    pub fn effort_word(&self) -> &'static str {
        if self.along == Dimension::ANGLE { "torque" } else { "force" }
    }
}

/// Kinds of couplings.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum CouplingKind {
    /// Joint `b` turns `ratio` times as far as joint `a` (from the start position).
    Gear { a: usize, b: usize, ratio: Id },
    /// `slide` moves `radius` times as far as `pinion` turns (from the start position), m; by teeth or by a `rope` on a drum.
    Rack { pinion: usize, slide: usize, radius: Id, rope: bool },
    /// An expression of position-level quantities that stays 0.
    Zero(Id),
}

/// A prescribed motion of a joint's coordinate.
#[derive(Clone, Debug)]
pub struct Driver {
    /// Its name.
    pub name: String,
    /// The driven joint.
    pub joint: usize,
    /// The motion.
    pub motion: Motion,
    /// Where it stands.
    pub place: Place,
}

/// Motion of a driver.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Motion {
    /// Constant speed from the start position, rad/s or m/s.
    Speed(Id),
    /// The coordinate as an expression of `t`.
    Position(Id),
    /// A rise from the start position: `by`, `during` seconds, then rest.
    Rise { by: Id, during: Id, law: Law },
}

words! {
    /// Law of a rise.
    pub enum Law {
        /// τ − sin(2πτ)/2π.
        Cycloidal = "cycloidal",
        /// 10τ³ − 15τ⁴ + 6τ⁵.
        Poly5 = "poly5",
    }
}

/// An applied force or torque.
#[derive(Clone, Debug)]
pub struct Load {
    /// Its name.
    pub name: String,
    /// What it acts on.
    pub on: LoadOn,
    /// Where it stands.
    pub place: Place,
}

/// What a load acts on.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum LoadOn {
    /// At a point of a body: force (2 or 3 components; empty if none) and torque (planar 1, spatial 3 components; empty if none), in the axes of the point `frame` (of body 0: those of the world).
    Point { at: PointRef, force: Vec<Id>, torque: Vec<Id>, frame: PointRef },
    /// On a joint's coordinate: on the second body, reaction on the first; N m or N.
    Joint { joint: usize, effort: Id },
}

/// A spring, damper or both.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Its name.
    pub name: String,
    /// What it stretches.
    pub on: SpringOn,
    /// Free length, rest angle or rest position; stretch = measured − rest. 0 if none.
    pub rest: Option<Id>,
    /// Law of the force by stretch.
    pub law: SpringLaw,
    /// Damping, force per rate of stretch. 0 if none.
    pub damping: Option<Id>,
    /// Constant added to the force. 0 if none.
    pub preload: Option<Id>,
    /// Where it stands.
    pub place: Place,
}

/// What a spring measures.
#[derive(Clone, Debug)]
pub enum SpringOn {
    /// The distance of two points.
    Between(PointRef, PointRef),
    /// A joint's coordinate.
    Joint(usize),
    /// Any position-level expression.
    Stretch(Id),
}

/// Force of a spring by its stretch (positive pulls together).
#[derive(Clone, Debug)]
pub enum SpringLaw {
    /// No elastic force.
    None,
    /// Proportional.
    Stiffness(Id),
    /// Any expression of the spring's own `stretch` (the input `Quantity::Spring { item: Stretch }`).
    Force(Id),
}

/// A motor with a torque-speed curve.
#[derive(Clone, Debug)]
pub struct Motor {
    /// Its name.
    pub name: String,
    /// The driven joint.
    pub joint: usize,
    /// Torque at the joint: gear · curve(gear · omega), an expression of the joint's rate, N m. None if only a rotor inertia.
    pub torque: Option<Id>,
    /// Gear ratio: motor turns per turn of the joint; 1 if none.
    pub gear: Option<Id>,
    /// Rotor inertia before the gear, kg m²; gear² · inertia acts on the joint's coordinate.
    pub inertia: Option<Id>,
    /// Where it stands.
    pub place: Place,
}

/// A named expression.
#[derive(Clone, Debug)]
pub struct Measure {
    /// Its name.
    pub name: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Its value.
    pub value: Id,
    /// Where it stands.
    pub place: Place,
}

/// A first-order state x with x' = rate: a current, a temperature, a signal behind a filter.
#[derive(Clone, Debug)]
pub struct FirstOrder {
    /// Its name.
    pub name: String,
    /// Its dimension, that of `start`.
    pub dimension: Dimension,
    /// Its value at t = 0, of parameters and tables; 0 if omitted.
    pub start: Id,
    /// Its time rate, of positions, velocities, t, springs and states.
    pub rate: Id,
    /// Where it stands.
    pub place: Place,
}

/// What happens where an expression crosses zero.
#[derive(Clone, Debug)]
pub struct Event {
    /// Its name.
    pub name: String,
    /// What crosses zero.
    pub when: Id,
    /// In which direction it counts.
    pub crossing: Crossing,
    /// `action: stop`: the run ends there.
    pub stop: bool,
    /// Parameters that change there, by index in [`Model::parameters`](super::whole::Model::parameters), and their new values. All are taken from the state
    /// and the parameters before the event.
    pub set: Vec<(usize, Id)>,
    /// An impact in a joint.
    pub restitution: Option<Restitution>,
    /// Where it stands.
    pub place: Place,
}

words! {
    /// Direction in which an event's expression crosses zero.
    pub enum Crossing {
        /// Either way.
        Both = "both",
        /// From negative to positive.
        Rising = "rising",
        /// From positive to negative.
        Falling = "falling",
    }
}

/// An impact: the rate of a joint's coordinate after it is −e times the rate before.
#[derive(Clone, Copy, Debug)]
pub struct Restitution {
    /// The joint; it has one coordinate.
    pub joint: usize,
    /// Coefficient of restitution, of what is known before the impact.
    pub e: Id,
}

/// One entry of `start`.
#[derive(Clone, Debug)]
pub struct Start {
    /// As written: `O.angle`.
    pub name: String,
    /// The quantity, position or velocity level (`O.angle`, `body.x`, `body.wx`).
    pub quantity: Quantity,
    /// What it is set to.
    pub value: StartValue,
    /// `~` in front: where the search begins; else exact.
    pub guess: bool,
    /// Where it stands.
    pub place: Place,
}

/// Value of a start entry.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum StartValue {
    /// A number.
    Number(Id),
    /// Spatial orientation of a body: axis (world) and angle.
    Rotation { axis: Vec<Id>, angle: Id },
    /// The same by roll, pitch and yaw about the axes of the world.
    RollPitchYaw([Id; 3]),
}
