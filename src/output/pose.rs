//! What a drawing of a mechanism shows.

use crate::results::ShownIn;

/// A mechanism in the plane of its picture, all lengths in metres, y upwards.
///
/// Everything that moves has one entry for each position; the first position is drawn strongly, the others paler and paler.
/// Points that are not finite are left out.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// Above the picture; may be empty.
    pub title: String,
    /// The unit to show lengths in, if one is asked for.
    pub length: Option<ShownIn>,
    /// The same of forces and of torques.
    pub force: Option<ShownIn>,
    /// See `force`.
    pub torque: Option<ShownIn>,
    /// The bodies; the frame is shown by its joints.
    pub bodies: Vec<Outline>,
    /// The joints.
    pub joints: Vec<Symbol>,
    /// Springs and dampers.
    pub links: Vec<Link>,
    /// Pairs of gears.
    pub gears: Vec<Gear>,
    /// The paths of points.
    pub traces: Vec<Trace>,
    /// Forces in the first position; of a motion those of all its pictures, picture after picture.
    pub forces: Vec<Force>,
    /// What has moved from rest to the first position, if arrows are to tell it.
    pub moves: Vec<Move>,
    /// The three axes of space as they are seen, each of length 1 in space; none in the plane.
    pub axes: Option<[[f64; 2]; 3]>,
}

/// A body.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// Beside the body; may be empty.
    pub name: String,
    /// Its shapes in each position.
    pub poses: Vec<Vec<Form>>,
}

/// A shape in the picture.
#[derive(Clone, Debug)]
pub struct Form {
    /// What it is.
    pub kind: FormKind,
    /// What is nearer to the eye has more of it, and is drawn later.
    pub depth: f64,
    /// In space the flat pieces that it is made of, by which it is told what it hides; none of what is placed as a whole by its depth.
    pub facets: Vec<Facet>,
}

/// A line, or a flat convex area, in space: lengths to the right, upwards, and towards the eye.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facet {
    /// Around it, m.
    pub corners: Vec<[f64; 3]>,
    /// Which of its edges, each from a corner to the next, belong to the outline of the shape.
    pub edges: Vec<bool>,
}

impl Form {
    /// A shape that is placed as a whole.
    #[must_use]
    pub fn flat(kind: FormKind, depth: f64) -> Self {
        Self { kind, depth, facets: Vec::new() }
    }

    /// How a shape is shown in a pale position: wheels without their teeth, and those that stay in their place not at all, which would fill
    /// the gaps between the teeth of the `strong` position.
    pub(super) fn as_ghost(&self, strong: Option<&Self>) -> Option<Self> {
        let FormKind::Gear { center, radius, spoke, rim, .. } = &self.kind else { return Some(self.clone()) };
        let rests = |other: &Self| matches!(&other.kind, FormKind::Gear { center: at, .. } if (at[0] - center[0]).hypot(at[1] - center[1]) <= 1e-6 * radius);
        if strong.is_some_and(rests) {
            return None;
        }
        let kind = FormKind::Disc { center: *center, radius: rim.unwrap_or(*radius), spoke: *spoke };
        Some(Self::flat(kind, self.depth))
    }
}

/// Shapes.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum FormKind {
    /// A rounded bar.
    Bar { from: [f64; 2], to: [f64; 2], width: Width },
    /// A rounded plate around points.
    Plate { points: Vec<[f64; 2]> },
    /// A true outline, closed; `shade` 1 is full light, 0 none.
    Area { points: Vec<[f64; 2]>, shade: f64 },
    /// A round wheel in space: its outline, convex, and the circle of the end that is seen. What is behind it is seen through it.
    Wheel { outline: Vec<[f64; 2]>, face: Vec<[f64; 2]> },
    /// A circle with a spoke to `spoke` on its rim, which tells how it is turned.
    Disc { center: [f64; 2], radius: f64, spoke: Option<[f64; 2]> },
    /// A wheel with teeth: its pitch circle and outline, and a point on a line from its centre that tells how it is turned. A ring with inner
    /// teeth has a `rim` around them in its place.
    Gear { center: [f64; 2], radius: f64, teeth: usize, outline: Vec<[f64; 2]>, spoke: Option<[f64; 2]>, rim: Option<f64> },
    /// A point mass.
    Mass { center: [f64; 2], radius: f64 },
}

/// How wide a bar is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Width {
    /// As bars are drawn; thinner with each of so many cylinders that it slides in, so that these are seen around it.
    Drawn(u32),
    /// So wide.
    Given(f64),
}

/// A joint.
#[derive(Clone, Debug, Default)]
pub struct Symbol {
    /// Beside the joint; may be empty.
    pub name: String,
    /// What it looks like.
    pub kind: SymbolKind,
    /// The bodies that it joins; 0 is the frame.
    pub bodies: [usize; 2],
    /// One of its sides is the frame: hatched.
    pub grounded: bool,
    /// Of a slide: the way belongs to the frame.
    pub way_grounded: bool,
    /// Of a slide or slot: the body that the way belongs to.
    pub way_body: usize,
    /// Something drives it.
    pub driven: bool,
    /// What drives it turns about the axis, though it slides: a screw.
    pub turns: bool,
    /// It has viscous damping.
    pub damped: bool,
    /// It is of a rod in its cylinder, without a guide.
    pub telescopes: bool,
    /// Of a hinge of the frame: its bearing stands above it, as a rack is below.
    pub above: bool,
    /// Of a slide: what slides is seen by its box alone, in pale positions too.
    pub boxed: bool,
    /// Of a slide: its body can turn about the axis as well.
    pub rings: bool,
    /// Of a slide in the plane: areas of both bodies hide it.
    pub hidden: bool,
    /// Of a slot: the body that it is cut into has no area of its own around it.
    pub framed: bool,
    /// Where it is, for each position.
    pub poses: Vec<Placement>,
}

/// What a joint looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SymbolKind {
    /// A small circle.
    #[default]
    Hinge,
    /// A box on a way.
    Slide,
    /// A pin in a slot.
    Slot,
    /// Two circles, one in the other.
    Ball,
    /// Two crossed hinges: a circle with a cross of their axes.
    Cross,
    /// A small square: rigid.
    Weld,
    /// A piece of the plane in which two bodies slide on each other.
    Plane,
}

/// Where a joint is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// Its point.
    pub at: [f64; 2],
    /// The direction of a slide, a slot, a hinge in space or what is normal to a plane, of any length; none is seen of a hinge in the plane.
    pub along: [f64; 2],
    /// The ends of the way or slot, if they are known; else it is drawn a little longer than what is seen of the motion.
    pub way: Option<[[f64; 2]; 2]>,
    /// Of a slide the ends of the shape of the body that carries its way, if that has one along it, and whether they are round.
    pub carrier: Option<([[f64; 2]; 2], bool)>,
    /// Two directions at right angles in space, across the axis, counter-clockwise about it.
    pub across: [[f64; 2]; 2],
    /// Sense in which it is driven: 1 along or counter-clockwise about the axis, −1 the other way, 0 for both and for neither.
    pub sense: f64,
    /// Of a slide how far the body that slides reaches to the side of its guide, m.
    pub clear: f64,
    /// Of a slide: its guide is on the upper side of the way, or on the left of an upright one, not on the lower side.
    pub upper: bool,
    /// Of a slide the places where stops are, of a hinge the directions in which they are.
    pub stops: [Option<[f64; 2]>; 2],
    /// Of a hinge the directions a quarter turn on from its stops.
    pub quarter: [[f64; 2]; 2],
    /// Of a slide with stops how far the outlines of the body that slides reach from its point back and ahead along the way, m; else 0.
    pub beyond: [f64; 2],
    /// Of a slide with damping how far they reach back, m; else 0.
    pub back: f64,
    /// Of a hinge in the plane with two stops the angle between them, rad.
    pub swing: Option<f64>,
}

/// A massless element between two points.
#[derive(Clone, Debug, Default)]
pub struct Link {
    /// Beside it; may be empty.
    pub name: String,
    /// What it looks like.
    pub kind: LinkKind,
    /// Whether each end is on the frame.
    pub grounded: [bool; 2],
    /// Its ends, for each position; only the first is drawn, but for rods.
    pub poses: Vec<[[f64; 2]; 2]>,
    /// Of what turns: angles of the two bodies, rad, for each position.
    pub turned: Vec<[f64; 2]>,
    /// Of an actuator: length of its cylinder as part of what is between its ends, for each position.
    pub cylinder: Vec<f64>,
    /// Of an actuator how many tubes slide in each other.
    pub stages: usize,
}

/// What a massless element looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinkKind {
    /// A zigzag.
    #[default]
    Spring,
    /// A piston in a cylinder.
    Damper,
    /// Both side by side.
    SpringDamper,
    /// A bar between two pins.
    Rod,
    /// A cylinder with its rod.
    Actuator,
    /// A spiral.
    Torsion,
    /// A line with a spiral in its middle.
    Shaft,
    /// Two plates that face each other, on a line between two places or around one.
    Clutch,
    /// Shoes on both sides of a hinge, or above what slides.
    Brake,
}

impl LinkKind {
    /// Whether it acts on turning alone, so that the ground at its ends is that of the joints.
    #[must_use]
    pub fn turns(self) -> bool {
        matches!(self, Self::Torsion | Self::Shaft | Self::Clutch | Self::Brake)
    }
}

/// Gears, a pinion and its rack, wheels under a belt, or a rope on its drum, in the first position.
#[derive(Clone, Debug, Default)]
pub struct Gear {
    /// Pitch circles, as closed lines.
    pub circles: Vec<Vec<[f64; 2]>>,
    /// Rims around inner teeth, as closed lines.
    pub rims: Vec<Vec<[f64; 2]>>,
    /// Pitch line of a rack.
    pub line: Option<[[f64; 2]; 2]>,
    /// Where they touch.
    pub mesh: Option<[f64; 2]>,
    /// A belt around both, or what of a rope lies on its drum, as a closed line.
    pub belt: Vec<[f64; 2]>,
    /// A rope from where it leaves its drum to its end.
    pub rope: Option<[[f64; 2]; 2]>,
}

/// A force or torque in the first position.
#[derive(Clone, Debug, Default)]
pub struct Force {
    /// What it is.
    pub kind: ForceKind,
    /// Where it acts.
    pub at: [f64; 2],
    /// As it is seen, N; of a torque nothing.
    pub along: [f64; 2],
    /// How large it is in space, N or N m.
    pub size: f64,
    /// Of a torque its size, N m, less than 0 in the plane for one that turns clockwise; none of a force.
    pub turning: Option<f64>,
    /// Of a torque two directions at right angles in space as they are seen, across its axis, counter-clockwise about it.
    pub across: [[f64; 2]; 2],
    /// Force per length of its arrow, N/m; none for one that suits the picture.
    pub scale: Option<f64>,
}

/// What a force is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ForceKind {
    /// A load.
    #[default]
    Load,
    /// What a joint transmits.
    Reaction,
}

/// How a point has moved from rest, or a body has turned about one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the line above each variant names its fields")]
pub enum Move {
    /// A point has gone from a place to another.
    Shift { from: [f64; 2], to: [f64; 2] },
    /// A body has turned about a place, from the first of two directions across its axis towards the second, of length 1 in space.
    Turn { at: [f64; 2], across: [[f64; 2]; 2] },
}

/// The path of a point.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Beside the path; may be empty.
    pub name: String,
    /// Its points; one that is not finite breaks it.
    pub points: Vec<[f64; 2]>,
}
