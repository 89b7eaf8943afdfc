//! Bodies as a model file gives them: shapes or figures, points with their frames, what is attached, and their gravity in a field.

use super::place::Place;
use crate::expression::Id;
use std::borrow::Cow;

/// Gravity of a body in a field: expressions of the coordinates of its centre of mass.
#[derive(Clone, Debug)]
pub struct Attraction {
    /// The body.
    pub body: usize,
    /// The law at its centre of mass.
    pub law: AttractionLaw,
}

/// A field of gravity at one place.
#[derive(Clone, Debug)]
pub enum AttractionLaw {
    /// Acceleration, 2 or 3 components, m/s².
    Field(Vec<Id>),
    /// Potential, J/kg; the acceleration is minus its gradient.
    Potential(Id),
}

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name; `ground` for the first.
    pub name: String,
    /// The one shape, if any.
    pub shape: Option<Shape>,
    /// Explicit mass, kg.
    pub mass: Option<Id>,
    /// Explicit inertia about `com` in body axes, kg m²: 1 figure (planar, or a sphere), 3 (Ixx, Iyy, Izz) or 6 (Ixx, Iyy, Izz, Ixy, Ixz, Iyz).
    pub inertia: Vec<Id>,
    /// Explicit centre of mass, body frame, m.
    pub com: Option<Vec<Id>>,
    /// `fictitious: true`: an inertia that no real body has is allowed.
    pub fictitious: bool,
    /// Points that outline the body in drawings beside its joints and points, body frame, m.
    pub drawn: Vec<Vec<Id>>,
    /// The circle that it is drawn as.
    pub circle: Option<Circle>,
    /// Spatial: the solids that it is drawn as.
    pub solids: Vec<Solid>,
    /// Points: 0 `origin`, 1 `com`, then those of the shape (`start`, `end` of a bar), then the user's.
    pub points: Vec<Point>,
    /// Point masses and rotors.
    pub attached: Vec<Attached>,
    /// Where it stands.
    pub place: Place,
}

impl Body {
    /// Whether the model file says anything of its mass, if only that it is 0.
    #[must_use]
    pub fn mass_is_said(&self) -> bool {
        let of_shape = match &self.shape {
            Some(
                Shape::Bar { mass, .. }
                | Shape::BarBetween { mass, .. }
                | Shape::Disc { mass, .. }
                | Shape::Plate { mass, .. }
                | Shape::Ball { mass, .. },
            ) => mass.is_some(),
            None => false,
        };
        of_shape || self.mass.is_some() || !self.inertia.is_empty() || !self.attached.is_empty()
    }
}

/// A circle that a body is drawn as.
#[derive(Clone, Debug, PartialEq)]
pub struct Circle {
    /// Radius, m.
    pub radius: Id,
    /// Centre, body frame, m; the origin if it has no components.
    pub at: Vec<Id>,
    /// Spatial: what it is round about, body frame; z if it has no components.
    pub axis: Vec<Id>,
}

/// A solid that a body in space is drawn as.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// What it is.
    pub form: SolidForm,
    /// Its middle, body frame, m; the origin if it has no components.
    pub at: Vec<Id>,
    /// How its own axes stand in the body frame: roll, pitch, yaw, rad; as those of the body if omitted.
    pub rpy: Option<[Id; 3]>,
}

/// Solids with their sizes, m.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum SolidForm {
    /// A box with sizes along its own axes.
    Box { size: [Id; 3] },
    /// A cylinder about its own z axis.
    Cylinder { radius: Id, length: Id },
    /// A ball.
    Ball { radius: Id },
}

/// A shape with its sizes, m, and mass, kg.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Shape {
    /// Uniform straight bar from the body's origin along x; `width` (y) and `height` (z) 0 when thin.
    Bar { length: Id, mass: Option<Id>, width: Option<Id>, height: Option<Id> },
    /// Uniform straight bar drawn in place between two points of the world; the body frame is the world frame at the drawn position.
    BarBetween { from: Vec<Id>, to: Vec<Id>, mass: Option<Id>, width: Option<Id>, height: Option<Id> },
    /// Uniform disc about z through the origin.
    Disc { radius: Id, mass: Option<Id>, thickness: Option<Id> },
    /// Uniform plate (planar: two sizes) or box (three sizes) centred at the origin.
    Plate { size: Vec<Id>, mass: Option<Id> },
    /// Uniform ball centred at the origin.
    Ball { radius: Id, mass: Option<Id> },
}

/// A named point fixed in a body.
#[derive(Clone, Debug)]
pub struct Point {
    /// Its name.
    pub name: Cow<'static, str>,
    /// Its position in the body frame, m.
    pub at: PointAt,
    /// How its own axes stand in the body frame: roll, pitch, yaw, rad; as those of the body if omitted.
    pub rpy: Option<[Id; 3]>,
}

impl Point {
    /// A point that a body has by itself.
    pub(crate) fn of_shape(name: &'static str, at: PointAt) -> Self {
        Self { name: name.into(), at, rpy: None }
    }
}

/// Where a point of a body lies.
#[derive(Clone, Debug)]
pub enum PointAt {
    /// The body's origin.
    Origin,
    /// The centre of mass of the body with all that is attached.
    Com,
    /// The start of the bar.
    Start,
    /// The end of the bar.
    End,
    /// 2 or 3 coordinates in the body frame, m.
    Given(Vec<Id>),
}

/// A point mass or rotor on a body.
#[derive(Clone, Debug)]
pub struct Attached {
    /// Its name.
    pub name: String,
    /// The point of the body where it sits (0, the origin, if not given).
    pub at: usize,
    /// Its mass, kg.
    pub mass: Option<Id>,
    /// Its inertia about its own centre, kg m²: empty, 1, 3 or 6 figures as in [`Body::inertia`].
    pub inertia: Vec<Id>,
    /// Where it stands.
    pub place: Place,
}
