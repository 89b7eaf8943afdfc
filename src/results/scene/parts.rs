//! The parts of a scene: bodies, joints, links, gears, arrows, traces.

use super::shape::Shape;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A place on a body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// The body; 0 is the ground.
    pub body: usize,
    /// In its frame, 2 or 3 numbers, m.
    pub at: Vec<f64>,
}

/// A body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Its name; `ground` for the first.
    pub name: String,
    /// What it looks like, in its own frame.
    #[serde(with = "super::named")]
    pub shapes: Vec<Shape>,
}

/// A joint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// Its kind as in the model file: `revolute`.
    pub kind: Cow<'static, str>,
    /// Its point in the first body, which is the ground if one of the two is, unless the joint is a slot or has two axes; of a cylinder and
    /// its rod, the rod. Of a slide it is a point of the guide, which in space stands beside what is solid.
    pub a: Place,
    /// Its point in the second body.
    pub b: Place,
    /// Whether the model names the ground second, so that the columns of its force are those on the ground.
    #[serde(default)]
    pub on_ground: bool,
    /// Unit direction of its axis or slide in the first body.
    pub axis: Vec<f64>,
    /// Of a universal joint: unit direction of its other axis, which is in the second body; else empty.
    #[serde(default)]
    pub second: Vec<f64>,
    /// Of a slide: its positions along the axis over the whole motion, widened to its stops, m.
    pub stroke: Option<[f64; 2]>,
    /// Ends of its coordinate where it has stops, measured as the place of b from a along the axis, m, or as drawn, rad.
    pub stops: [Option<f64>; 2],
    /// Of a hinge in space with stops: how the second body stands in the first as drawn, a rotation by rows; else empty.
    #[serde(default)]
    pub drawn: Vec<f64>,
    /// Whether it is kept off the tree.
    pub cut: bool,
    /// Whether a driver or motor moves it.
    pub driven: bool,
    /// The sense in which that moves it over the whole motion: 1 along or counter-clockwise about its axis, −1 the other way, 0 for both
    /// and for neither.
    #[serde(default)]
    pub sense: f64,
    /// Whether it has viscous damping.
    pub damped: bool,
    /// Of a slide: whether it is of a rod in its cylinder, which needs no guide beside them.
    #[serde(default)]
    pub telescopes: bool,
}

/// A massless element between two places.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Link {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: LinkKind,
    /// Its first end.
    pub a: Place,
    /// Its second end.
    pub b: Place,
    /// Free length of a spring, m, or rest angle of a torsion spring, rad, if it does not change; shortest length of an actuator, m.
    pub rest: Option<f64>,
    /// Of an actuator how many tubes slide in each other, the rod with them: each is shorter than the shortest length. 0 for others.
    #[serde(default)]
    pub stages: usize,
    /// Unit direction in the axes of the world along which alone it acts: its first end, on the ground, goes along beside the second one.
    /// Empty for a link between two places.
    #[serde(default)]
    pub along: Vec<f64>,
}

/// What a massless element is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LinkKind {
    /// A spring.
    Spring,
    /// A damper.
    Damper,
    /// Both in one.
    SpringDamper,
    /// A distance that is held.
    Rod,
    /// A distance that is prescribed: a cylinder with its rod.
    Actuator,
    /// A spring that turns about a hinge.
    Torsion,
    /// A spring or damper between the turning of two hinges that stand apart.
    Shaft,
    /// What may hold two joints to each other.
    Clutch,
    /// What may hold a joint: both ends at its hinge, or from its first body to what slides.
    Brake,
}

/// Two bodies that move each other by teeth, a belt or a rope.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gear {
    /// Name of the coupling.
    pub name: String,
    /// What joins them.
    pub kind: GearKind,
    /// The first gear; of a rack its pinion, of a rope its drum.
    pub a: Wheel,
    /// The second gear, a rack, or the end of a rope.
    pub b: Wheel,
}

/// What joins two wheels, or a wheel and what slides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GearKind {
    /// Teeth of two wheels.
    Teeth,
    /// Teeth of a pinion and a rack.
    Rack,
    /// A belt around two wheels that do not touch.
    Belt,
    /// A rope that winds on a drum.
    Rope,
}

/// A pitch circle, the pitch line of a rack, or the end of a rope.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wheel {
    /// Its body.
    pub body: usize,
    /// Its centre in the body, m; of a rack the point of the pitch line that touches the pinion in the first frame.
    pub at: Vec<f64>,
    /// Radius, m; negative for a gear with inner teeth; 0 for a rack or the end of a rope.
    pub radius: f64,
    /// Unit axis in the body, 3 numbers in space and none in the plane; of a rack the direction of its pitch line, of a rope that in which
    /// its end goes when the drum turns counter-clockwise.
    pub axis: Vec<f64>,
}

/// A force or torque.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arrow {
    /// Name of the load or joint.
    pub name: String,
    /// What it is.
    pub kind: ArrowKind,
    /// The body on which it acts.
    pub body: usize,
    /// Where it acts, m.
    pub at: Vec<f64>,
    /// Names of the columns with its world components, if the table has them.
    pub columns: Vec<String>,
    /// Whether it is minus these columns, which are those on the ground that the model names as the second body.
    #[serde(default)]
    pub minus: bool,
    /// World components for each frame, flat, N or N m; of a torque in the plane the third one alone; may be empty.
    pub values: Vec<f64>,
    /// The body in whose axes the force is given; 0 is the world.
    pub frame: usize,
    /// Unit directions in that body of the components that are given.
    pub axes: Vec<Vec<f64>>,
    /// Of a force along a line the place from which it points away where it is positive; it has one component then, and no axes.
    #[serde(default)]
    pub from: Option<Place>,
    /// Force per length with which it is drawn, N/m, if the study says so.
    pub scale: Option<f64>,
}

/// What an arrow means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ArrowKind {
    /// A load.
    Load,
    /// The force in a joint.
    Reaction,
    /// A torque about the place, of a load.
    Torque,
    /// The moment in a joint.
    Moment,
}

impl ArrowKind {
    /// Whether it turns about its place.
    #[must_use]
    pub fn turns(self) -> bool {
        matches!(self, Self::Torque | Self::Moment)
    }
}

/// A point whose path is drawn.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Trace {
    /// Its name: `coupler.P`.
    pub name: String,
    /// Its body.
    pub body: usize,
    /// Where in the body, m.
    pub at: Vec<f64>,
}
